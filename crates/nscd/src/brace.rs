//! Closed contacts as springs, lent to a tangent that is not definite without them.
//!
//! A pressed surface is held by what it touches; its tangent alone may well be indefinite, because the stress under it would make
//! it buckle if nothing were there. A spring along the normal of a closed contact changes nothing of the solution: there the
//! normal motion is known beforehand, it closes what gap is left.

use contact_bipotential::{Contact, ContactMap};

use crate::trial::Trial;

/// Stiffness of a spring over the largest diagonal entry of its node [-].
const STIFFNESS: f64 = 10.0;

/// A spring along the normal of a contact.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Brace {
    /// Interface and position among its slaves.
    key: (usize, usize),
    /// Slave node.
    node: u32,
    normal: [f64; 3],
    /// Zero until it is in a matrix [N/m].
    stiffness: f64,
}

/// The pressed contacts with rigid masters. A deformable master would couple the matrices of two bodies.
pub(crate) fn braces(trial: &Trial, cone: usize) -> Vec<Brace> {
    let forces = trial.r.chunks_exact(cone);
    let pressed = trial.map.contacts.iter().zip(forces);
    let pressed = pressed.filter(|(c, r)| r[cone - 1] > 0.0 && c.stencil.nodes().len() == 1);
    let brace = |(c, _): (&Contact, &[f64])| Brace {
        key: (c.interface, c.slave_index),
        node: c.slave,
        normal: c.normal(),
        stiffness: 0.0,
    };
    pressed.map(brace).collect()
}

impl Brace {
    /// Adds the spring to a matrix: `diagonal(i)` is its entry of dof `i`, zero where that is no unknown, and
    /// `add(i, j, value)` adds to one with `i >= j` among unknowns.
    pub(crate) fn enter(
        &mut self,
        dim: usize,
        diagonal: impl Fn(usize) -> f64,
        mut add: impl FnMut(usize, usize, f64),
    ) {
        let first = dim * self.node as usize;
        let largest = (first..first + dim).fold(0.0_f64, |m, i| m.max(diagonal(i).abs()));
        self.stiffness = STIFFNESS * largest;
        for i in 0..dim {
            for j in 0..=i {
                let value = self.stiffness * self.normal[i] * self.normal[j];
                add(first + i, first + j, value);
            }
        }
    }

    /// What the spring does while the gap closes, for the right-hand side \[N\]; nothing once the contact has no force.
    pub(crate) fn load(&self, map: &ContactMap, x: &[f64], r: &[f64], rhs: &mut [f64]) {
        let found = |c: &Contact| (c.interface, c.slave_index);
        let Ok(k) = map.contacts.binary_search_by_key(&self.key, found) else {
            return;
        };
        let (dim, normal) = (map.dim(), (k + 1) * map.cone().dim() - 1);
        if r[normal] > 0.0 {
            for i in 0..dim {
                rhs[dim * self.node as usize + i] -= self.stiffness * x[normal] * self.normal[i];
            }
        }
    }
}
