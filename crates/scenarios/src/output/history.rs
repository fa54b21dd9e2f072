//! Columns and rows of `history.csv`.

use std::io;
use std::path::Path;

use super::OutputError;
use crate::output::EnergySummary;
use crate::spec::{Quantity, Scene};

/// Columns between the time and the forces, in the order of the file.
pub const ENERGY_COLUMNS: [&str; 9] = [
    "energy.kinetic",
    "energy.strain",
    "energy.adhesive",
    "work.load",
    "dissipation.friction",
    "dissipation.bond",
    "dissipation.damping",
    "dissipation.impact",
    "error.integration",
];

/// Last words of the columns of an interface with adhesion.
const BOND_COLUMNS: [&str; 3] = ["beta_max", "beta_mean", "bonded"];

/// Energies at a time; works, dissipations and errors are sums since the start \[J\].
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Energies {
    /// Kinetic energy \[J\].
    pub kinetic: f64,
    /// Strain energy \[J\].
    pub strain: f64,
    /// Energy of the adhesive bonds \[J\].
    pub adhesive: f64,
    /// Work done on the bodies by loads and prescribed motions \[J\].
    pub load_work: f64,
    /// Dissipated by friction \[J\].
    pub friction_dissipation: f64,
    /// Dissipated by bonds that break or heal \[J\].
    pub bond_dissipation: f64,
    /// Dissipated by damping \[J\].
    pub damping_dissipation: f64,
    /// Lost by contacts that close \[J\].
    pub impact_loss: f64,
    /// Energy that the time integration loses (positive) or gains (negative) \[J\].
    pub integration_error: f64,
}

impl Energies {
    /// In the order of [`ENERGY_COLUMNS`] \[J\].
    pub fn values(&self) -> [f64; 9] {
        [
            self.kinetic,
            self.strain,
            self.adhesive,
            self.load_work,
            self.friction_dissipation,
            self.bond_dissipation,
            self.damping_dissipation,
            self.impact_loss,
            self.integration_error,
        ]
    }

    /// Kinetic, strain and adhesive energy together \[J\].
    pub fn total(&self) -> f64 {
        self.kinetic + self.strain + self.adhesive
    }
}

impl From<&EnergySummary> for Energies {
    fn from(end: &EnergySummary) -> Energies {
        Energies {
            kinetic: end.kinetic,
            strain: end.strain,
            adhesive: end.adhesive,
            load_work: end.load_work,
            friction_dissipation: end.friction_dissipation,
            bond_dissipation: end.bond_dissipation,
            damping_dissipation: end.damping_dissipation,
            impact_loss: end.impact_loss,
            integration_error: end.integration_error,
        }
    }
}

/// Resultant on an interface or a driven boundary.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Force {
    /// Force \[N\].
    pub force: [f64; 3],
    /// Moment \[N m\].
    pub moment: [f64; 3],
}

/// Bonds of an interface with adhesion.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Bonds {
    /// Largest intensity \[-\].
    pub largest: f64,
    /// Mean intensity over the slave surface \[-\].
    pub mean: f64,
    /// Slave nodes whose intensity is above the threshold of their interface.
    pub bonded: usize,
}

/// One accepted step.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Row {
    /// Time \[s\].
    pub time: f64,
    /// Energies \[J\].
    pub energies: Energies,
    /// Closed contacts.
    pub contacts: usize,
    /// Deepest penetration \[m\].
    pub penetration: f64,
    /// Error of the contact law relative to the largest contact force \[-\].
    pub contact_error: f64,
    /// One per name of the [`Layout`].
    pub forces: Vec<Force>,
    /// One per bonded interface of the [`Layout`].
    pub bonds: Vec<Bonds>,
    /// Probe values, probe after probe, quantity after quantity, component after component.
    pub probes: Vec<f64>,
}

/// Which columns a run has.
#[derive(Clone, Debug, Default, PartialEq)]
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
pub struct ProbeColumns {
    /// Name of the probe.
    pub name: String,
    /// What it writes.
    pub quantities: Vec<Quantity>,
}

impl Layout {
    /// The columns of a scene.
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
    pub fn header(&self) -> Vec<String> {
        let mut header = vec!["t".to_owned()];
        header.extend(ENERGY_COLUMNS.map(str::to_owned));
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

    /// Numbers of a row in the order of the header. A row with too few forces, bonds or probe values is filled with
    /// NaN, one with too many cut.
    pub fn numbers(&self, row: &Row) -> Vec<f64> {
        let mut numbers = vec![row.time];
        numbers.extend(row.energies.values());
        numbers.extend([row.contacts as f64, row.penetration, row.contact_error]);
        for i in 0..self.forces.len() {
            let unknown = Force {
                force: [f64::NAN; 3],
                moment: [f64::NAN; 3],
            };
            let Force { force, moment } = row.forces.get(i).copied().unwrap_or(unknown);
            numbers.extend(force);
            numbers.extend(moment);
        }
        for i in 0..self.bonds.len() {
            let bonds = row
                .bonds
                .get(i)
                .map(|b| [b.largest, b.mean, b.bonded as f64]);
            numbers.extend(bonds.unwrap_or([f64::NAN; 3]));
        }
        let count: usize = self
            .probes
            .iter()
            .flat_map(|p| &p.quantities)
            .map(|q| q.components())
            .sum();
        numbers.extend((0..count).map(|i| row.probes.get(i).copied().unwrap_or(f64::NAN)));
        numbers
    }
}

/// All rows of a run, column-wise readable for plots.
#[derive(Clone, Debug, Default)]
pub struct History {
    header: Vec<String>,
    rows: Vec<Vec<f64>>,
}

impl History {
    /// No rows yet.
    pub fn new(header: Vec<String>) -> History {
        History {
            header,
            rows: Vec::new(),
        }
    }

    /// Reads a `history.csv`.
    ///
    /// # Errors
    /// [`OutputError::Unread`] for a file that cannot be read or holds something else than numbers.
    pub fn read(path: &Path) -> Result<History, OutputError> {
        let read = || -> io::Result<History> {
            let mut reader = csv::Reader::from_path(path)?;
            let mut history = History::new(reader.headers()?.iter().map(str::to_owned).collect());
            for record in reader.records() {
                let record = record?;
                let numbers = record.iter().map(str::parse::<f64>);
                let numbers: Result<Vec<f64>, _> = numbers.collect();
                history.push(numbers.map_err(io::Error::other)?);
            }
            Ok(history)
        };
        read().map_err(|source| OutputError::Unread {
            path: path.to_owned(),
            source,
        })
    }

    /// Adds the numbers of a row.
    pub fn push(&mut self, numbers: Vec<f64>) {
        self.rows.push(numbers);
    }

    /// Number of rows.
    pub fn len(&self) -> usize {
        self.rows.len()
    }

    /// True without rows.
    pub fn is_empty(&self) -> bool {
        self.rows.is_empty()
    }

    /// Names of the columns.
    pub fn header(&self) -> &[String] {
        &self.header
    }

    /// Values of a column over the rows.
    pub fn column(&self, name: &str) -> Option<Vec<f64>> {
        let index = self.header.iter().position(|column| column == name)?;
        Some(
            self.rows
                .iter()
                .filter_map(|row| row.get(index).copied())
                .collect(),
        )
    }
}
