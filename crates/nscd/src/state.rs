//! What a time step starts from and ends with.

use contact_bipotential::{Bond, ContactKey};
use nalgebra::{Matrix3, Vector3};

/// State at the end of an accepted step. Flat vectors are `dim * node + component`.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct State {
    /// Time \[s\].
    pub time: f64,
    /// Displacement \[m\].
    pub u: Vec<f64>,
    /// Velocity \[m/s\].
    pub v: Vec<f64>,
    /// Internal force `F_int(u)` \[N\].
    pub internal_force: Vec<f64>,
    /// External force \[N\].
    pub external_force: Vec<f64>,
    /// Strain energy \[J\].
    pub strain_energy: f64,
    /// Kinetic energy \[J\].
    pub kinetic_energy: f64,
    /// Forces of the supports and driven boundaries in the last step \[N\], zero on free unknowns.
    pub support_force: Vec<f64>,
    /// Contact force on the nodes in the last step, `H^T r` \[N\].
    pub contact_force: Vec<f64>,
    /// State of each contact in the last step, in the order (interface, slave node).
    pub contacts: Vec<ContactState>,
    /// Bond of each slave node of each interface; empty for an interface without adhesion.
    pub bonds: Vec<Vec<NodeBond>>,
    /// Free energy of all bonds \[J\].
    pub adhesive_energy: f64,
    /// Length of the step that led here \[s\]; `None` at the start.
    pub last_dt: Option<f64>,
    /// Displacement at the start of the last step \[m\]; equals `u` at the start.
    pub u_before: Vec<f64>,
}

impl State {
    /// What a slave node did at the end of the last step, if it was a candidate then.
    pub(crate) fn contact(&self, key: ContactKey) -> Option<&ContactState> {
        let found = self.contacts.binary_search_by_key(&key, ContactState::key);
        found.ok().map(|i| &self.contacts[i])
    }
}

/// One candidate contact at the end of a step.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct ContactState {
    /// Index of the interface.
    pub interface: usize,
    /// Index of the slave node in its interface.
    pub slave_index: usize,
    /// Mesh node.
    pub node: u32,
    /// Gap at the end of the step \[m\]; negative is penetration.
    pub gap: f64,
    /// Slip of the step in the local frame (t1, t2) \[m\].
    pub slip: [f64; 2],
    /// Normal velocity of slave against master at the end of the step \[m/s\]; positive when they part.
    pub normal_velocity: f64,
    /// Force on the slave in the local frame (t1, t2, n) \[N\].
    pub force: Vector3<f64>,
    /// The local frame: columns t1, t2, n.
    pub frame: Matrix3<f64>,
    /// What the contact does, apart from its bond.
    pub status: ContactStatus,
    /// Its bond; `None` on an interface without adhesion.
    pub bond: Option<BondState>,
}

impl ContactState {
    /// What the contact is called from one step to the next.
    pub(crate) fn key(&self) -> ContactKey {
        ContactKey::new(self.interface, self.slave_index)
    }

    /// Force on the slave in global axes \[N\].
    pub(crate) fn global_force(&self) -> Vector3<f64> {
        self.frame * self.force
    }
}

/// The bond of a contact at the end of a step.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct BondState {
    /// Intensity `beta` \[-\]: 0 broken, 1 intact.
    pub intensity: f64,
    /// Tangential separation since bonding along (t1, t2) \[m\].
    pub separation: [f64; 2],
    /// The part of [`ContactState::force`] that the bond makes \[N\].
    pub force: Vector3<f64>,
}

/// What a slave node remembers of its bond from step to step.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
#[non_exhaustive]
pub struct NodeBond {
    /// Intensity `beta` \[-\].
    pub intensity: f64,
    /// Gap, not negative \[m\].
    pub gap: f64,
    /// Tangential separation since bonding \[m\]: along the tangents of the contact's frame on an obstacle, of the
    /// facet's own axes on a deformable master. Both turn with the master's material.
    pub separation: [f64; 2],
    /// Facet of the master to which those axes belong; `None` for an obstacle.
    pub facet: Option<u32>,
}

impl NodeBond {
    /// The bond with its separation in other axes.
    pub(crate) fn with(&self, separation: [f64; 2]) -> Bond {
        Bond::new(self.intensity, self.gap, separation)
    }
}

/// What a contact does.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum ContactStatus {
    /// No force.
    Open,
    /// Pressed together without slip.
    Stick,
    /// Pressed together and sliding.
    Slip,
}
