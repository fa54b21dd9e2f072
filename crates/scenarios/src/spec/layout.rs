//! Columns of `history.csv`.

use super::{Quantity, Scene};
use crate::energies::ENERGY_TERMS;

/// Last words of the columns of an interface with adhesion.
const BOND_COLUMNS: [&str; 3] = ["beta_max", "beta_mean", "bonded"];

/// Which columns a run has.
#[derive(Clone, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct Layout {
    /// Interfaces, then motions, in the order of the scene.
    pub forces: Vec<String>,
    /// Interfaces with adhesion in the order of the scene.
    pub bonds: Vec<String>,
    /// Probes in the order of the scene.
    pub probes: Vec<ProbeColumns>,
}

/// Columns of one probe.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct ProbeColumns {
    /// Name of the probe.
    pub name: String,
    /// What it writes.
    pub quantities: Vec<Quantity>,
}

impl Layout {
    /// The columns of a scene.
    #[must_use]
    pub fn of(scene: &Scene) -> Layout {
        let probes = scene.output.probes.iter();
        Layout {
            forces: scene
                .interfaces
                .keys()
                .chain(scene.motions.keys())
                .cloned()
                .collect(),
            bonds: scene
                .interfaces
                .iter()
                .filter(|(_, interface)| interface.adhesion.is_some())
                .map(|(name, _)| name.clone())
                .collect(),
            probes: probes
                .map(|(name, probe)| ProbeColumns {
                    name: name.clone(),
                    quantities: probe.quantities.clone(),
                })
                .collect(),
        }
    }

    /// Header of `history.csv`.
    #[must_use]
    pub fn header(&self) -> Vec<String> {
        let mut header = vec!["t".to_owned()];
        header.extend(ENERGY_TERMS.map(|term| term.column.to_owned()));
        header
            .extend(["contact.closed", "contact.penetration", "contact.error"].map(str::to_owned));
        for name in &self.forces {
            for kind in ["force", "moment"] {
                header.extend(["x", "y", "z"].map(|axis| format!("{kind}.{name}.{axis}")));
            }
        }
        for name in &self.bonds {
            header.extend(BOND_COLUMNS.map(|kind| format!("bond.{name}.{kind}")));
        }
        for probe in &self.probes {
            for quantity in &probe.quantities {
                let column = format!("probe.{}.{}", probe.name, quantity.name());
                if quantity.components() == 1 {
                    header.push(column);
                } else {
                    header.extend(["x", "y", "z"].map(|axis| format!("{column}.{axis}")));
                }
            }
        }
        header
    }

    /// Number of the columns of all probes.
    pub(crate) fn probe_columns(&self) -> usize {
        let quantities = self.probes.iter().flat_map(|probe| &probe.quantities);
        quantities.map(|quantity| quantity.components()).sum()
    }
}
