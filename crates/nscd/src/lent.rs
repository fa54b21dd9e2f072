//! Contacts that cannot slip one way because both sides are held, as on a plane of symmetry.

use faer::Mat;

/// Tangential compliance below which, relative to the normal one, a contact counts as held [-].
const HELD: f64 = 1e-12;

/// Compliance that a contact problem holds for the time of its solution.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Lent {
    row: usize,
    tangents: usize,
    before: [[f64; 2]; 2],
}

impl Lent {
    /// Puts the operator back as it was.
    pub(crate) fn take_back(&self, w: &mut Mat<f64>) {
        for i in 0..self.tangents {
            for j in 0..self.tangents {
                w[(self.row + i, self.row + j)] = self.before[i][j];
            }
        }
    }
}

/// Gives each tangential direction without compliance, along which nothing slips either, the compliance of the normal.
///
/// Friction along such a direction does no work, and the law leaves it open between the bounds of the cone. A solver
/// would leave it anywhere there, where it uses up the friction that the other tangent needs; with a compliance it is zero.
pub(crate) fn lend(w: &mut Mat<f64>, q: &[f64], cone: usize) -> Vec<Lent> {
    let tangents = cone - 1;
    let mut lent = Vec::new();
    if tangents == 0 {
        return lent;
    }
    let longest = q.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
    for (k, x) in q.chunks_exact(cone).enumerate() {
        let row = cone * k;
        let normal = w[(row + tangents, row + tangents)];
        let mut before = [[0.0; 2]; 2];
        for i in 0..tangents {
            for j in 0..tangents {
                before[i][j] = w[(row + i, row + j)];
            }
        }
        let (smallest, along) = softest(before, tangents);
        let slips = (0..tangents).map(|i| along[i] * x[i]).sum::<f64>();
        if smallest > HELD * normal || slips.abs() > HELD * longest {
            continue;
        }
        for i in 0..tangents {
            for j in 0..tangents {
                w[(row + i, row + j)] += normal * along[i] * along[j];
            }
        }
        lent.push(Lent {
            row,
            tangents,
            before,
        });
    }
    lent
}

/// Smallest eigenvalue of a symmetric matrix of one or two rows, and its direction.
fn softest(w: [[f64; 2]; 2], rows: usize) -> (f64, [f64; 2]) {
    let [[a, b], [_, c]] = w;
    if rows == 1 {
        return (a, [1.0, 0.0]);
    }
    let largest = 0.5 * (a + c) + (0.5 * (a - c)).hypot(b);
    if largest == 0.0 {
        return (0.0, [1.0, 0.0]);
    }
    // Of the two ways to the direction of the largest, the one that does not cancel.
    let stiff = if a >= c {
        [largest - c, b]
    } else {
        [b, largest - a]
    };
    let length = stiff[0].hypot(stiff[1]);
    if length == 0.0 {
        return (largest, [1.0, 0.0]);
    }
    (
        (a * c - b * b) / largest,
        [-stiff[1] / length, stiff[0] / length],
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn the_softest_direction_is_an_eigenvector(a in -1.0..1.0_f64, b in -1.0..1.0_f64, c in -1.0..1.0_f64, d in -1.0..1.0_f64) {
            // L L^T is symmetric and not negative.
            let w = [[a * a + b * b, a * c + b * d], [a * c + b * d, c * c + d * d]];
            let (smallest, v) = softest(w, 2);
            for i in 0..2 {
                let product = w[i][0] * v[0] + w[i][1] * v[1];
                prop_assert!((product - smallest * v[i]).abs() < 1e-12);
            }
            prop_assert!(smallest <= 0.5 * (w[0][0] + w[1][1]) + 1e-12);
        }

        #[test]
        fn only_a_held_direction_is_lent_to_and_all_is_given_back(angle in 0.0..3.2_f64, soft in 0.1..2.0_f64, slip in -1.0..1.0_f64) {
            let (s, c) = angle.sin_cos();
            // Compliance along (c, s) only; the second contact is soft both ways.
            let mut w = Mat::<f64>::zeros(6, 6);
            for (i, x) in [c, s].iter().enumerate() {
                for (j, y) in [c, s].iter().enumerate() {
                    w[(i, j)] = soft * x * y;
                }
                w[(3 + i, 3 + i)] = soft;
            }
            (w[(2, 2)], w[(5, 5)]) = (0.5, 0.5);
            let whole = w.clone();
            let q = [slip * c, slip * s, -1.0, 0.3, 0.0, -1.0];
            let lent = lend(&mut w, &q, 3);
            prop_assert_eq!(lent.len(), 1);
            let held = s * s * w[(0, 0)] - 2.0 * s * c * w[(0, 1)] + c * c * w[(1, 1)];
            prop_assert!((held - 0.5).abs() < 1e-12);
            prop_assert_eq!(w[(3, 3)], soft);
            lent.iter().for_each(|l| l.take_back(&mut w));
            prop_assert_eq!(&w, &whole);
            // Where both sides are driven along each other, friction works and stays what it is.
            let driven = [-0.2 * s, 0.2 * c, -1.0, 0.3, 0.0, -1.0];
            prop_assert!(lend(&mut w, &driven, 3).is_empty());
        }
    }
}
