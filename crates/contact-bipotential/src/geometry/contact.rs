//! One contact: a slave node, what it moves against, and its frame.

use nalgebra::{Matrix3, Vector3};

/// What a contact is called from one search to the next: a slave node of an interface.
///
/// In the order of the contacts of a [`ContactMap`](crate::ContactMap): by interface, then by slave node.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct ContactKey {
    /// Index of the interface.
    pub interface: usize,
    /// Position of the slave node in [`Interface::slave`](crate::Interface::slave).
    pub slave_index: usize,
}

impl ContactKey {
    /// The key of a slave node of an interface.
    #[must_use]
    pub const fn new(interface: usize, slave_index: usize) -> Self {
        Self {
            interface,
            slave_index,
        }
    }
}

/// Nodes and weights whose combination is the motion of a slave node relative to its master.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stencil {
    nodes: [u32; 5],
    weights: [f64; 5],
    count: u8,
}

impl Stencil {
    /// The stencil of a node against a rigid obstacle.
    #[must_use]
    pub fn rigid(slave: u32) -> Self {
        Self {
            nodes: [slave, 0, 0, 0, 0],
            weights: [1.0, 0.0, 0.0, 0.0, 0.0],
            count: 1,
        }
    }

    /// The stencil of a node against up to 4 master nodes with shape functions `weights` \[-\], which sum to 1.
    ///
    /// Nodes beyond the fourth are ignored, as are weights that are exactly zero (edges and vertices).
    #[must_use]
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
    #[must_use]
    pub fn nodes(&self) -> &[u32] {
        &self.nodes[..self.count as usize]
    }

    /// Weights \[-\], in the order of the nodes.
    #[must_use]
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
#[non_exhaustive]
pub struct Contact {
    /// Index of the interface.
    pub interface: usize,
    /// Slave node.
    pub slave: u32,
    /// Position of the slave node in [`Interface::slave`](crate::Interface::slave).
    pub slave_index: usize,
    /// Relative motion of slave and master.
    pub stencil: Stencil,
    /// Columns `t1`, `t2`, `n`: orthonormal, right-handed, `n` out of the master towards the slave.
    pub frame: Matrix3<f64>,
    /// Signed distance to the master \[m\], negative where the slave is inside.
    pub gap: f64,
    /// Facet of the master surface; `None` for an obstacle.
    pub facet: Option<u32>,
    /// Displacement over the step of the obstacle's material point under the contact \[m\], global axes; zero for
    /// a deformable master, whose motion the stencil holds.
    pub obstacle_motion: Vector3<f64>,
}

impl Contact {
    /// A contact of the slave node with which `stencil` starts, in the frame with the columns `t1`, `t2`, `n`; `gap`
    /// \[m\] is negative where the slave is inside.
    #[must_use]
    pub fn new(key: ContactKey, stencil: Stencil, frame: Matrix3<f64>, gap: f64) -> Self {
        Self {
            interface: key.interface,
            slave: stencil.nodes[0],
            slave_index: key.slave_index,
            stencil,
            frame,
            gap,
            facet: None,
            obstacle_motion: Vector3::zeros(),
        }
    }

    /// The same contact on a facet of a deformable master.
    pub(crate) fn on_facet(self, facet: u32) -> Self {
        Self {
            facet: Some(facet),
            ..self
        }
    }

    /// The same contact on an obstacle whose material point under it moves by `motion` \[m\] over the step, in global
    /// axes.
    pub(crate) fn on_moving_obstacle(self, motion: Vector3<f64>) -> Self {
        Self {
            obstacle_motion: motion,
            ..self
        }
    }

    /// What the contact is called from one search to the next.
    #[must_use]
    pub fn key(&self) -> ContactKey {
        ContactKey::new(self.interface, self.slave_index)
    }

    /// The unit normal.
    #[must_use]
    pub fn normal(&self) -> Vector3<f64> {
        self.frame.column(2).into()
    }
}
