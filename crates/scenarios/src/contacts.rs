//! What contacts and bonds do at the nodes.

use nalgebra::Vector3;
use nscd::{ContactState, ContactStatus, Model, State};

use crate::output::Bonds;

/// Contacts of a slave node together; a node of several interfaces has the sum of their forces.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct NodeContact {
    /// Smallest gap \[m\]; NaN where no contact is near.
    pub gap: f64,
    /// Largest intensity of adhesion \[-\].
    pub beta: f64,
    /// Force of the bonds on the node in global axes \[N\].
    pub bond_force: Vector3<f64>,
    /// Pull of the bonds along the normal \[N\].
    pub bond_normal: f64,
    /// Norm of the tangential force of the bonds \[N\].
    pub bond_tangential: f64,
    /// Normal force without the bonds \[N\]; pressure is positive.
    pub normal: f64,
    /// Norm of the friction without the bonds \[N\].
    pub tangential: f64,
}

impl NodeContact {
    const NONE: NodeContact = NodeContact {
        gap: f64::NAN,
        beta: 0.0,
        bond_force: Vector3::new(0.0, 0.0, 0.0),
        bond_normal: 0.0,
        bond_tangential: 0.0,
        normal: 0.0,
        tangential: 0.0,
    };

    /// All nodes of a state.
    #[must_use]
    pub fn all(model: &Model, state: &State) -> Vec<NodeContact> {
        let mut nodes = vec![NodeContact::NONE; model.solid.node_count()];
        for contact in &state.contacts {
            nodes[contact.node as usize].add(contact);
        }
        for (interface, bonds) in model.interfaces.iter().zip(&state.bonds) {
            for (&node, bond) in interface.slave.iter().zip(bonds) {
                let beta = &mut nodes[node as usize].beta;
                *beta = beta.max(bond.intensity);
            }
        }
        nodes
    }

    /// One node of a state.
    #[must_use]
    pub fn of(model: &Model, state: &State, node: u32) -> NodeContact {
        let mut found = NodeContact::NONE;
        let here = state.contacts.iter().filter(|c| c.node == node);
        here.for_each(|contact| found.add(contact));
        for (interface, bonds) in model.interfaces.iter().zip(&state.bonds) {
            let bonds = interface.slave.iter().zip(bonds);
            for (_, bond) in bonds.filter(|(slave, _)| **slave == node) {
                found.beta = found.beta.max(bond.intensity);
            }
        }
        found
    }

    fn add(&mut self, contact: &ContactState) {
        self.gap = self.gap.min(contact.gap);
        let bond = contact.bond.map_or(Vector3::zeros(), |bond| bond.force);
        // The difference of an open contact is round-off.
        if contact.status != ContactStatus::Open {
            let dry = contact.force - bond;
            self.normal += dry[2];
            self.tangential += dry[0].hypot(dry[1]);
        }
        self.bond_normal -= bond[2];
        self.bond_tangential += bond[0].hypot(bond[1]);
        for (component, axis) in bond.iter().zip(contact.frame.column_iter()) {
            self.bond_force += *component * axis;
        }
    }
}

/// The bonds of every interface with adhesion, in the order of the model.
pub(crate) fn bonds(model: &Model, state: &State) -> Vec<Bonds> {
    let interfaces = model.interfaces.iter().zip(&state.bonds);
    let adhesive = interfaces.filter_map(|(interface, bonds)| {
        let law = interface.adhesion.as_ref()?;
        let (mut sum, mut area) = (0.0, 0.0);
        for (bond, share) in bonds.iter().zip(&interface.area) {
            sum += share * bond.intensity;
            area += share;
        }
        let intensities = || bonds.iter().map(|bond| bond.intensity);
        Some(Bonds {
            largest: intensities().fold(0.0, f64::max),
            mean: if area > 0.0 { sum / area } else { 0.0 },
            bonded: intensities().filter(|beta| *beta > law.threshold).count(),
        })
    });
    adhesive.collect()
}
