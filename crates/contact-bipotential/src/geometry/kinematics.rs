//! Contacts as rows of `H`: `x = H u` takes nodal vectors to local ones, `H^T` takes reactions back.
//!
//! Local vectors are flat, `cone` entries a contact, normal last: `(n)`, `(t, n)` or `(t1, t2, n)`; see [`Cone`].
//! `x = F sum_i w_i u_i` with the frame `F` and the stencil: +1 on the slave node, minus the shape functions
//! of the master's facet on its nodes, nothing for a rigid obstacle, whose motion enters as an offset.

mod condense;
mod frame_rule;

use crate::cone::Cone;
use crate::geometry::vec3::{Vec3, axpy, dot, node_vector};

pub use condense::CompliancePart;
pub use frame_rule::FrameRule;

/// Nodes and weights whose combination is the motion of a slave node relative to its master.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stencil {
    nodes: [u32; 5],
    weights: [f64; 5],
    count: u8,
}

impl Stencil {
    /// The stencil of a node against a rigid obstacle.
    pub fn rigid(slave: u32) -> Self {
        Self {
            nodes: [slave, 0, 0, 0, 0],
            weights: [1.0, 0.0, 0.0, 0.0, 0.0],
            count: 1,
        }
    }

    /// The stencil of a node against up to 4 master nodes with shape functions `weights` [-], which sum to 1.
    ///
    /// Nodes beyond the fourth are ignored, as are weights that are exactly zero (edges and vertices).
    pub fn deformable(slave: u32, nodes: &[u32], weights: &[f64]) -> Self {
        let mut stencil = Self::rigid(slave);
        for (node, w) in nodes
            .iter()
            .zip(weights)
            .take(4)
            .filter(|(_, w)| **w != 0.0)
        {
            let k = stencil.count as usize;
            stencil.nodes[k] = *node;
            stencil.weights[k] = -w;
            stencil.count += 1;
        }
        stencil
    }

    /// Nodes, the slave first.
    pub fn nodes(&self) -> &[u32] {
        &self.nodes[..self.count as usize]
    }

    /// Weights [-], in the order of the nodes.
    pub fn weights(&self) -> &[f64] {
        &self.weights[..self.count as usize]
    }

    /// Pairs of node and weight.
    pub fn iter(&self) -> impl Iterator<Item = (u32, f64)> + '_ {
        self.nodes()
            .iter()
            .copied()
            .zip(self.weights().iter().copied())
    }
}

/// A slave node near its master, open or closed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Contact {
    /// Index of the interface.
    pub interface: usize,
    /// Slave node.
    pub slave: u32,
    /// Position of the slave node in [`Interface::slave`](crate::geometry::interface::Interface::slave).
    pub slave_index: usize,
    /// Relative motion of slave and master.
    pub stencil: Stencil,
    /// Rows `t1`, `t2`, `n`: orthonormal, right-handed, `n` out of the master towards the slave.
    pub frame: [[f64; 3]; 3],
    /// Signed distance to the master \[m\], negative where the slave is inside.
    pub gap: f64,
    /// Facet of the master surface; `None` for an obstacle.
    pub facet: Option<u32>,
    /// Displacement over the step of the obstacle's material point under the contact \[m\], global axes; zero for
    /// a deformable master, whose motion the stencil holds.
    pub obstacle_motion: [f64; 3],
}

impl Contact {
    /// The unit normal.
    pub fn normal(&self) -> [f64; 3] {
        self.frame[2]
    }
}

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
    pub fn new(contacts: Vec<Contact>, dim: usize, cone: Cone) -> Self {
        Self {
            contacts,
            dim,
            cone,
        }
    }

    /// Number of contacts.
    pub fn len(&self) -> usize {
        self.contacts.len()
    }

    /// True without contacts.
    pub fn is_empty(&self) -> bool {
        self.contacts.is_empty()
    }

    /// Components of a contact.
    pub fn cone(&self) -> Cone {
        self.cone
    }

    /// Unknowns a node.
    pub fn dim(&self) -> usize {
        self.dim
    }

    /// Length of a local vector: contacts times entries a contact.
    pub fn row_count(&self) -> usize {
        self.len() * self.cone.dim()
    }

    /// The rows of a contact's frame that its cone has, in the order of the local vector.
    fn rows(&self, contact: &Contact) -> [Vec3; 3] {
        let [t1, t2, n] = contact.frame;
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
            let relative = contact.stencil.iter().fold([0.0; 3], |sum, (node, w)| {
                axpy(sum, w, node_vector(u, self.dim, node))
            });
            let rows = self.rows(contact);
            for (x, row) in x.iter_mut().zip(rows) {
                *x = dot(row, relative);
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
                .zip(self.rows(contact))
                .fold([0.0; 3], |sum, (r, row)| axpy(sum, *r, row));
            for (node, w) in contact.stencil.iter() {
                let start = self.dim * node as usize;
                for i in 0..self.dim {
                    f[start + i] += w * force[i];
                }
            }
        }
    }

    /// Signed gaps \[m\], one a contact.
    pub fn gaps(&self) -> Vec<f64> {
        self.contacts.iter().map(|contact| contact.gap).collect()
    }

    /// What the obstacles' motion adds to the relative motion over the step, in local frames \[m\]:
    /// slip = `H (u1 - u0) + offset`. Writes [`row_count`](Self::row_count) entries.
    pub fn slip_offsets(&self, offset: &mut [f64]) {
        let cone = self.cone.dim();
        for (contact, offset) in self.contacts.iter().zip(offset.chunks_exact_mut(cone)) {
            for (x, row) in offset.iter_mut().zip(self.rows(contact)) {
                *x = -dot(row, contact.obstacle_motion);
            }
        }
    }

    /// Nodes of all stencils, sorted, without repetition: where `H^T` can push.
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
