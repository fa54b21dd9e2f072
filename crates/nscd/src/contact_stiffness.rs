//! The stiffness of closed contacts, added to a tangent that is not definite without it: the augmentation of augmented
//! Lagrangians.
//!
//! A pressed surface is held by what it touches; its tangent alone may well be indefinite, because the stress under it
//! would make it buckle if nothing were there. A stiffness along the normal of a closed contact changes nothing of the
//! solution: there the normal motion is known beforehand, it closes what gap is left.

use contact_bipotential::{Contact, ContactKey, ContactMap};
use nalgebra::Vector3;

use crate::flat::equations;
use crate::linear::LowerPattern;
use crate::newton_iterate::NewtonIterate;

/// Stiffness of a contact over the largest diagonal entry of its node \[-\].
const STIFFNESS: f64 = 10.0;

/// A stiffness along the normal of a contact.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct ContactStiffness {
    key: ContactKey,
    /// Slave node.
    node: u32,
    normal: Vector3<f64>,
    /// Zero until it is in a matrix \[N/m\].
    stiffness: f64,
}

/// The pressed contacts with rigid masters. A deformable master would couple the matrices of two bodies.
pub(crate) fn contact_stiffness(iterate: &NewtonIterate) -> Vec<ContactStiffness> {
    let contacts = iterate.map.contacts.iter().enumerate();
    let pressed = contacts.filter(|(k, c)| iterate.is_pressed(*k) && c.stencil.nodes().len() == 1);
    let along_normal = |(_, c): (usize, &Contact)| ContactStiffness {
        key: c.key(),
        node: c.slave,
        normal: c.normal(),
        stiffness: 0.0,
    };
    pressed.map(along_normal).collect()
}

/// Puts the stiffness of those contacts into a matrix that belong to its unknowns, `dofs` in the order of the
/// equations with `dim` a node, and returns them. `diagonal` gives the entry of an equation as it was \[N/m\].
pub(crate) fn augment(
    contacts: &[ContactStiffness],
    dim: usize,
    dofs: &[u32],
    diagonal: impl Fn(usize) -> f64,
    pattern: LowerPattern<'_>,
    values: &mut [f64],
) -> Vec<ContactStiffness> {
    let count = dofs.iter().map(|&d| d as usize + 1).max();
    let equation = equations(dofs, count.unwrap_or(0));
    let known = |d: usize| {
        let equation = equation.get(d).filter(|&&e| e != u32::MAX);
        equation.map(|&e| e as usize)
    };
    let entered = contacts.iter().map(|contact| {
        let mut contact = *contact;
        let at = |d: usize| known(d).map_or(0.0, &diagonal);
        contact.enter(dim, at, |i, j, value| {
            let (Some(i), Some(j)) = (known(i), known(j)) else {
                return;
            };
            let column = pattern.pointers[i.min(j)]..pattern.pointers[i.min(j) + 1];
            if let Ok(k) = pattern.rows[column.clone()].binary_search(&i.max(j)) {
                values[column.start + k] += value;
            }
        });
        contact
    });
    entered.collect()
}

impl ContactStiffness {
    /// Adds the stiffness to a matrix: `diagonal(i)` is its entry of dof `i`, zero where that is no unknown, and
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

    /// What the stiffness does while the gap closes, for the right-hand side \[N\]; nothing once the contact has no
    /// force.
    pub(crate) fn load(&self, map: &ContactMap, x: &[f64], r: &[f64], rhs: &mut [f64]) {
        let Some(k) = map.find(self.key) else {
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

#[cfg(test)]
mod tests {
    use super::*;
    use contact_bipotential::{Cone, Stencil};
    use nalgebra::Matrix3;

    /// Node 1 of a mesh of two in the plane, pressed along a slanted normal.
    fn pressed(gap: f64) -> (ContactMap, [f64; 2]) {
        let (s, c) = 0.4_f64.sin_cos();
        let axes = [
            Vector3::z(),
            Vector3::new(c, -s, 0.0),
            Vector3::new(s, c, 0.0),
        ];
        let frame = Matrix3::from_columns(&axes);
        let contact = Contact::new(ContactKey::new(0, 3), Stencil::rigid(1), frame, gap);
        (
            ContactMap::new(vec![contact], 2, Cone::Frictionless),
            [s, c],
        )
    }

    fn solve(a: [[f64; 2]; 2], b: [f64; 2]) -> [f64; 2] {
        let det = a[0][0] * a[1][1] - a[0][1] * a[1][0];
        [
            (b[0] * a[1][1] - b[1] * a[0][1]) / det,
            (b[1] * a[0][0] - b[0] * a[1][0]) / det,
        ]
    }

    #[test]
    fn contact_stiffness_makes_the_matrix_definite_and_leaves_the_solution() {
        let gap = 0.03;
        let (map, n) = pressed(gap);
        // Indefinite, but not along the surface.
        let tangent = [[1.0, -2.0], [-2.0, -0.5]];
        let mut matrix = tangent;
        let mut stiffness = ContactStiffness {
            key: ContactKey::new(0, 3),
            node: 1,
            normal: map.contacts[0].normal(),
            stiffness: 0.0,
        };
        stiffness.enter(
            2,
            |d| tangent[d - 2][d - 2],
            |i, j, value| {
                matrix[i - 2][j - 2] += value;
                if i != j {
                    matrix[j - 2][i - 2] += value;
                }
            },
        );
        let det = |a: [[f64; 2]; 2]| a[0][0] * a[1][1] - a[0][1] * a[1][0];
        assert!(det(tangent) < 0.0 && det(matrix) > 0.0 && matrix[0][0] > 0.0);
        let load = [0.7, -0.2];
        let mut rhs = [0.0, 0.0, load[0], load[1]];
        stiffness.load(&map, &[gap], &[5.0], &mut rhs);
        // Correction and force with n . du = -gap, with and without the stiffness.
        let constrained = |a: [[f64; 2]; 2], b: [f64; 2]| {
            let (free, unit) = (solve(a, b), solve(a, n));
            let along = |x: [f64; 2]| n[0] * x[0] + n[1] * x[1];
            let force = (-gap - along(free)) / along(unit);
            [free[0] + force * unit[0], free[1] + force * unit[1], force]
        };
        let (with, without) = (
            constrained(matrix, [rhs[2], rhs[3]]),
            constrained(tangent, load),
        );
        for (a, b) in with.iter().zip(without) {
            assert!((a - b).abs() < 1e-12, "{with:?} {without:?}");
        }
    }

    #[test]
    fn a_contact_without_force_has_no_stiffness_in_the_load() {
        let (map, _) = pressed(0.1);
        let stiffness = ContactStiffness {
            key: ContactKey::new(0, 3),
            node: 1,
            normal: map.contacts[0].normal(),
            stiffness: 1.0,
        };
        let mut rhs = [0.0; 4];
        stiffness.load(&map, &[0.1], &[0.0], &mut rhs);
        stiffness.load(
            &ContactMap::new(Vec::new(), 2, Cone::Frictionless),
            &[],
            &[],
            &mut rhs,
        );
        assert_eq!(rhs, [0.0; 4]);
    }
}
