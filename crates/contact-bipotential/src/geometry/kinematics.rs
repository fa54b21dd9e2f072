//! Contacts as rows of `H`: `x = H u` takes nodal vectors to local ones, `H^T` takes reactions back.
//!
//! Local vectors are flat, `cone` entries a contact, normal last: `(n)`, `(t, n)` or `(t1, t2, n)`; see [`Cone`].
//! `x = F sum_i w_i u_i` with the frame `F` and the stencil: +1 on the slave node, minus the shape functions
//! of the master's facet on its nodes, nothing for a rigid obstacle, whose motion enters as an offset.

mod condense;
mod frame_rule;

use nalgebra::Vector3;

use crate::cone::Cone;
use crate::geometry::contact::{Contact, ContactKey};
use crate::geometry::vector::at_node;

pub use condense::CompliancePart;
pub use frame_rule::FrameRule;

/// The contacts of one configuration, in the order of interfaces and slave nodes, with the operations of `H`.
#[derive(Clone, Debug, PartialEq)]
pub struct ContactMap {
    /// The contacts.
    pub contacts: Vec<Contact>,
    dim: usize,
    cone: Cone,
}

impl ContactMap {
    /// A map over contacts of a mesh with `dim` (2 or 3) unknowns a node.
    #[must_use]
    pub fn new(contacts: Vec<Contact>, dim: usize, cone: Cone) -> Self {
        Self {
            contacts,
            dim,
            cone,
        }
    }

    /// Position of the contact with that key, if there is one.
    ///
    /// A binary search: the contacts are in the order of their keys, as a [`Detector`](crate::Detector) leaves them.
    #[must_use]
    pub fn find(&self, key: ContactKey) -> Option<usize> {
        self.contacts.binary_search_by_key(&key, Contact::key).ok()
    }

    /// Number of contacts.
    #[must_use]
    pub fn len(&self) -> usize {
        self.contacts.len()
    }

    /// True without contacts.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.contacts.is_empty()
    }

    /// Components of a contact.
    #[must_use]
    pub fn cone(&self) -> Cone {
        self.cone
    }

    /// Unknowns a node.
    #[must_use]
    pub fn dim(&self) -> usize {
        self.dim
    }

    /// Length of a local vector: contacts times entries a contact.
    #[must_use]
    pub fn row_count(&self) -> usize {
        self.len() * self.cone.dim()
    }

    /// The axes of a contact's frame that its cone has, in the order of the local vector.
    fn axes(&self, contact: &Contact) -> [Vector3<f64>; 3] {
        let [t1, t2, n] = [0, 1, 2].map(|i| contact.frame.column(i).into_owned());
        match self.cone {
            Cone::Frictionless => [n, n, n],
            Cone::Planar => [t1, n, n],
            Cone::Spatial => [t1, t2, n],
        }
    }

    /// `x = H u`: relative motion in local frames.
    ///
    /// `u` is flat, `dim * node + component`; `x` has [`row_count`](Self::row_count) entries, in the unit of `u`.
    pub fn apply(&self, u: &[f64], x: &mut [f64]) {
        let cone = self.cone.dim();
        for (contact, x) in self.contacts.iter().zip(x.chunks_exact_mut(cone)) {
            let relative = contact
                .stencil
                .iter()
                .fold(Vector3::zeros(), |sum, (node, w)| {
                    sum + w * at_node(u, self.dim, node)
                });
            let axes = self.axes(contact);
            for (x, axis) in x.iter_mut().zip(axes) {
                *x = axis.dot(&relative);
            }
        }
    }

    /// `f += H^T r`: nodal forces of local reactions, action on the slave and reaction on the master.
    ///
    /// `r` has [`row_count`](Self::row_count) entries \[N\]; `f` is flat, `dim * node + component` \[N\].
    pub fn apply_transpose(&self, r: &[f64], f: &mut [f64]) {
        let cone = self.cone.dim();
        for (contact, r) in self.contacts.iter().zip(r.chunks_exact(cone)) {
            let force = r
                .iter()
                .zip(self.axes(contact))
                .fold(Vector3::zeros(), |sum, (r, row)| sum + *r * row);
            for (node, w) in contact.stencil.iter() {
                let start = self.dim * node as usize;
                for i in 0..self.dim {
                    f[start + i] += w * force[i];
                }
            }
        }
    }

    /// Signed gaps \[m\], one a contact.
    #[must_use]
    pub fn gaps(&self) -> Vec<f64> {
        self.contacts.iter().map(|contact| contact.gap).collect()
    }

    /// What the obstacles' motion adds to the relative motion over the step, in local frames \[m\]:
    /// slip = `H (u1 - u0) + offset`. Writes [`row_count`](Self::row_count) entries.
    pub fn slip_offsets(&self, offset: &mut [f64]) {
        let cone = self.cone.dim();
        for (contact, offset) in self.contacts.iter().zip(offset.chunks_exact_mut(cone)) {
            for (x, row) in offset.iter_mut().zip(self.axes(contact)) {
                *x = -row.dot(&contact.obstacle_motion);
            }
        }
    }

    /// Nodes of all stencils, sorted, without repetition: where `H^T` can push.
    #[must_use]
    pub fn nodes(&self) -> Vec<u32> {
        let mut nodes: Vec<u32> = self
            .contacts
            .iter()
            .flat_map(|contact| contact.stencil.nodes().iter().copied())
            .collect();
        nodes.sort_unstable();
        nodes.dedup();
        nodes
    }
}

#[cfg(test)]
mod tests;
