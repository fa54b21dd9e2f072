//! What contacts do at a node.

use nscd::ContactState;

/// Contacts of a slave node together; a node of several interfaces has the sum of their forces.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NodeContact {
    /// Smallest gap \[m\]; NaN where no contact is near.
    pub gap: f64,
    /// Largest intensity of adhesion \[-\].
    pub beta: f64,
    /// Force of the bonds on the node in global axes \[N\].
    pub bond_force: [f64; 3],
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
    /// No contact near.
    pub const NONE: NodeContact = NodeContact {
        gap: f64::NAN,
        beta: 0.0,
        bond_force: [0.0; 3],
        bond_normal: 0.0,
        bond_tangential: 0.0,
        normal: 0.0,
        tangential: 0.0,
    };

    /// The contacts of one node.
    pub fn of(contacts: &[ContactState], node: u32) -> NodeContact {
        let mut all = NodeContact::NONE;
        contacts
            .iter()
            .filter(|c| c.node == node)
            .for_each(|c| all.add(c));
        all
    }

    /// Adds a contact of the node.
    pub fn add(&mut self, contact: &ContactState) {
        self.gap = self.gap.min(contact.gap);
        let [t1, t2, n] = contact.force;
        self.normal += n;
        self.tangential += t1.hypot(t2);
    }
}
