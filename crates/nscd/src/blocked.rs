//! Contacts that cannot slip one way because both sides are blocked, as on a plane of symmetry.

use contact_bipotential::Cone;
use faer::Mat;

/// Compliance of a contact along its stiffest direction over that along the others, below which it is blocked \[-\].
const BLOCKED: f64 = 1e-11;
/// Largest part of that direction along the normal: beyond it is the gap that is blocked, not the slip \[-\].
const UPRIGHT: f64 = 0.1;

/// A contact and the tangential direction in which nothing gives and nothing slips.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct BlockedDirection {
    row: usize,
    along: [f64; 2],
}

/// The blocked directions of a contact problem, at most one a contact. On a curved surface the normal at a plane of
/// symmetry may lean out of the plane, so that the direction that is blocked is only nearly a tangent.
pub(crate) fn blocked_directions(w: &Mat<f64>, q: &[f64], cone: Cone) -> Vec<BlockedDirection> {
    let cone = cone.dim();
    let longest = q.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
    let found = q.chunks_exact(cone).enumerate().filter_map(|(k, x)| {
        let row = cone * k;
        let at = |i: usize, j: usize| w[(row + i, row + j)];
        let stiff = match cone {
            2 => stiffest_of_two(at),
            3 => stiffest_of_three(at),
            _ => None,
        }?;
        let moves: f64 = (0..cone).map(|i| stiff[i] * x[i]).sum();
        let size = stiff[0].hypot(if cone == 3 { stiff[1] } else { 0.0 });
        if stiff[cone - 1].abs() > UPRIGHT || moves.abs() > BLOCKED * longest {
            return None;
        }
        let second = if cone == 3 { stiff[1] / size } else { 0.0 };
        Some(BlockedDirection {
            row,
            along: [stiff[0] / size, second],
        })
    });
    found.collect()
}

/// Takes the blocked directions out of a contact problem: no force along them, no slip.
///
/// Friction there does no work, and the law leaves it open between the bounds of the cone. A solver would leave it
/// anywhere, where it uses up the friction that the other tangent needs.
pub(crate) fn take_out(blocked: &[BlockedDirection], w: &mut Mat<f64>, q: &mut [f64], cone: Cone) {
    let tangents = cone.dim() - 1;
    for BlockedDirection { row, along } in blocked {
        let (row, along) = (*row, &along[..tangents]);
        let normal = w[(row + tangents, row + tangents)];
        for j in 0..w.ncols() {
            let part: f64 = (0..tangents).map(|i| along[i] * w[(row + i, j)]).sum();
            (0..tangents).for_each(|i| w[(row + i, j)] -= part * along[i]);
        }
        for j in 0..w.nrows() {
            let part: f64 = (0..tangents).map(|i| along[i] * w[(j, row + i)]).sum();
            (0..tangents).for_each(|i| w[(j, row + i)] -= part * along[i]);
        }
        for i in 0..tangents {
            (0..tangents).for_each(|j| w[(row + i, row + j)] += normal * along[i] * along[j]);
        }
        let slip: f64 = (0..tangents).map(|i| along[i] * q[row + i]).sum();
        (0..tangents).for_each(|i| q[row + i] -= slip * along[i]);
    }
}

fn stiffest_of_two(w: impl Fn(usize, usize) -> f64) -> Option<[f64; 3]> {
    let (a, b, c) = (w(0, 0), w(0, 1), w(1, 1));
    let size = a + c;
    let rest = [[c, -b], [-b, a]];
    let best = usize::from(rest[1][1] > rest[0][0]);
    let length = rest[best][0].hypot(rest[best][1]);
    (length > 0.0 && a * c - b * b <= BLOCKED * size * size)
        .then(|| [rest[best][0] / length, rest[best][1] / length, 0.0])
}

/// Of a matrix of rank two the cofactors are a multiple of `e e^T`, `e` its null direction.
fn stiffest_of_three(w: impl Fn(usize, usize) -> f64) -> Option<[f64; 3]> {
    let cofactor = |i: usize, j: usize| {
        let (i1, i2, j1, j2) = ((i + 1) % 3, (i + 2) % 3, (j + 1) % 3, (j + 2) % 3);
        w(i1, j1) * w(i2, j2) - w(i1, j2) * w(i2, j1)
    };
    let size = w(0, 0) + w(1, 1) + w(2, 2);
    let minors = cofactor(0, 0) + cofactor(1, 1) + cofactor(2, 2);
    let determinant: f64 = (0..3).map(|j| w(0, j) * cofactor(0, j)).sum();
    let larger = |a: usize, b: usize| {
        if cofactor(b, b) > cofactor(a, a) {
            b
        } else {
            a
        }
    };
    let best = larger(larger(0, 1), 2);
    let column = [0, 1, 2].map(|i| cofactor(i, best));
    let length = column.iter().map(|x| x * x).sum::<f64>().sqrt();
    // Two blocked directions leave no cofactors to tell them by.
    let one = minors > BLOCKED * size * size && determinant <= BLOCKED * size * minors;
    one.then(|| column.map(|x| x / length))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        /// Two contacts; the first is blocked along `e`, which leans out of its tangent plane a little.
        #[test]
        fn only_the_blocked_direction_is_taken_out(
            angle in 0.0..6.2_f64, lean in -0.05..0.05_f64, slip in -1.0..1.0_f64,
            root in prop::collection::vec(-1.0..1.0_f64, 36),
        ) {
            let e = [angle.cos() * lean.cos(), angle.sin() * lean.cos(), lean.sin()];
            let root = Mat::from_fn(6, 6, |i, j| root[6 * i + j] + if i == j { 3.0 } else { 0.0 });
            let free = Mat::from_fn(6, 6, |i, j| {
                let one = if i == j { 1.0 } else { 0.0 };
                if i < 3 && j < 3 { one - e[i] * e[j] } else { one }
            });
            let half = &free * &root;
            let whole = &half * half.transpose();
            let (mut w, mut q) = (whole.clone(), vec![0.3, -0.1, slip, 0.2, 0.1, -0.4]);
            let moves: f64 = (0..3).map(|i| e[i] * q[i]).sum();
            (0..3).for_each(|i| q[i] -= moves * e[i]);
            let found = blocked_directions(&w, &q, Cone::Spatial);
            prop_assert_eq!(found.len(), 1);
            prop_assert_eq!(found[0].row, 0);
            let along = found[0].along;
            prop_assert!((along[0] * e[1] - along[1] * e[0]).abs() < 1e-6);
            let before = q.clone();
            take_out(&found, &mut w, &mut q, Cone::Spatial);
            let push = [along[0], along[1], 0.0, 0.0, 0.0, 0.0];
            for i in 0..6 {
                // A force along it moves that one slip alone.
                let moved: f64 = (0..6).map(|j| w[(i, j)] * push[j]).sum();
                prop_assert!((moved - whole[(2, 2)] * push[i]).abs() < 1e-9);
                prop_assert!((w[(i, 2)] - w[(2, i)]).abs() < 1e-12);
            }
            prop_assert_eq!(w[(5, 4)], whole[(5, 4)]);
            prop_assert_eq!(w[(2, 2)], whole[(2, 2)]);
            prop_assert!((along[0] * q[0] + along[1] * q[1]).abs() < 1e-12);
            prop_assert_eq!(&q[2..], &before[2..]);
            // Both sides driven along each other: there is slip, and friction works.
            let driven: Vec<f64> = before.iter().zip(e.iter().chain(&[0.0; 3])).map(|(q, e)| q + 0.1 * e).collect();
            prop_assert!(blocked_directions(&whole, &driven, Cone::Spatial).is_empty());
        }

        #[test]
        fn soft_contacts_are_left_alone(root in prop::collection::vec(-1.0..1.0_f64, 9)) {
            let root = Mat::from_fn(3, 3, |i, j| root[3 * i + j] + if i == j { 3.0 } else { 0.0 });
            let w = &root * root.transpose();
            prop_assert!(blocked_directions(&w, &[0.0, 0.0, -1.0], Cone::Spatial).is_empty());
        }
    }

    #[test]
    fn in_the_plane_the_tangent_is_blocked_or_not() {
        let w = |tangent: f64| {
            let mut w = Mat::<f64>::identity(2, 2);
            w[(0, 0)] = tangent;
            w
        };
        let found = blocked_directions(&w(0.0), &[0.0, -1.0], Cone::Planar);
        assert_eq!(
            found,
            [BlockedDirection {
                row: 0,
                along: [1.0, 0.0]
            }]
        );
        assert!(blocked_directions(&w(0.01), &[0.0, -1.0], Cone::Planar).is_empty());
        assert!(blocked_directions(&w(0.0), &[0.5, -1.0], Cone::Planar).is_empty());
    }
}
