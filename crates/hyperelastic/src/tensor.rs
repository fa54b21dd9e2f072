//! Symmetric 3x3 tensors as six components 11 22 33 12 13 23, and what a law needs of them.
//!
//! Shear components are tensor components, not doubled.

use crate::material::Inverted;
use crate::real::Real;

/// The unit tensor.
pub const IDENTITY: [f64; 6] = [1.0, 1.0, 1.0, 0.0, 0.0, 0.0];

/// `tr A`.
#[inline]
pub fn trace<T: Real>(a: &[T; 6]) -> T {
    a[0] + a[1] + a[2]
}

/// `A : A = tr(A^2)`.
#[inline]
pub fn norm_squared<T: Real>(a: &[T; 6]) -> T {
    a[0] * a[0] + a[1] * a[1] + a[2] * a[2] + (a[3] * a[3] + a[4] * a[4] + a[5] * a[5]) * 2.0
}

/// Cofactors of `A`: `adj A = det(A) A^-1`, but they exist for a singular `A` too.
#[inline]
pub fn cofactors<T: Real>(a: &[T; 6]) -> [T; 6] {
    [
        a[1] * a[2] - a[5] * a[5],
        a[0] * a[2] - a[4] * a[4],
        a[0] * a[1] - a[3] * a[3],
        a[4] * a[5] - a[3] * a[2],
        a[3] * a[5] - a[4] * a[1],
        a[3] * a[4] - a[5] * a[0],
    ]
}

/// `det A`.
#[inline]
pub fn determinant<T: Real>(a: &[T; 6]) -> T {
    let cofactor = cofactors(a);
    a[0] * cofactor[0] + a[3] * cofactor[3] + a[4] * cofactor[4]
}

/// `A^2`.
#[inline]
pub fn square<T: Real>(a: &[T; 6]) -> [T; 6] {
    [
        a[0] * a[0] + a[3] * a[3] + a[4] * a[4],
        a[3] * a[3] + a[1] * a[1] + a[5] * a[5],
        a[4] * a[4] + a[5] * a[5] + a[2] * a[2],
        (a[0] + a[1]) * a[3] + a[4] * a[5],
        (a[0] + a[2]) * a[4] + a[3] * a[5],
        (a[1] + a[2]) * a[5] + a[3] * a[4],
    ]
}

/// `E = (C - I)/2`, Green-Lagrange strain.
#[inline]
pub fn green_lagrange<T: Real>(c: &[T; 6]) -> [T; 6] {
    [
        (c[0] - 1.0) * 0.5,
        (c[1] - 1.0) * 0.5,
        (c[2] - 1.0) * 0.5,
        c[3] * 0.5,
        c[4] * 0.5,
        c[5] * 0.5,
    ]
}

/// `A (.) B + B (.) A` with `(A (.) B)_ijkl = (A_ik B_jl + A_il B_jk)/2` \[Feng2007, eq. 23\], symmetric to the last bit.
///
/// It maps a symmetric `X` to `A X B + B X A`: with `A = B = C^-1`, to minus twice the change of `C^-1` when `C` changes by `X`.
#[inline]
pub fn symmetric_product(a: &[f64; 6], b: &[f64; 6]) -> [[f64; 6]; 6] {
    let m03 = a[0] * b[3] + a[3] * b[0];
    let m04 = a[0] * b[4] + a[4] * b[0];
    let m05 = a[3] * b[4] + a[4] * b[3];
    let m13 = a[3] * b[1] + a[1] * b[3];
    let m14 = a[3] * b[5] + a[5] * b[3];
    let m15 = a[1] * b[5] + a[5] * b[1];
    let m23 = a[4] * b[5] + a[5] * b[4];
    let m24 = a[4] * b[2] + a[2] * b[4];
    let m25 = a[5] * b[2] + a[2] * b[5];
    let (d3, d4, d5) = (a[3] * b[3], a[4] * b[4], a[5] * b[5]);
    let m34 = 0.5 * (a[0] * b[5] + a[5] * b[0] + m05);
    let m35 = 0.5 * (m14 + a[4] * b[1] + a[1] * b[4]);
    let m45 = 0.5 * (a[3] * b[2] + a[2] * b[3] + m23);
    let m33 = 0.5 * (a[0] * b[1] + a[1] * b[0]) + d3;
    let m44 = 0.5 * (a[0] * b[2] + a[2] * b[0]) + d4;
    let m55 = 0.5 * (a[1] * b[2] + a[2] * b[1]) + d5;
    let (m01, m02, m12) = (2.0 * d3, 2.0 * d4, 2.0 * d5);
    [
        [2.0 * a[0] * b[0], m01, m02, m03, m04, m05],
        [m01, 2.0 * a[1] * b[1], m12, m13, m14, m15],
        [m02, m12, 2.0 * a[2] * b[2], m23, m24, m25],
        [m03, m13, m23, m33, m34, m35],
        [m04, m14, m24, m34, m44, m45],
        [m05, m15, m25, m35, m45, m55],
    ]
}

/// `I (.) B + B (.) I`: the derivative of `X^2` at `X = B`, with the zeros of `I` known beforehand.
#[inline]
pub fn derivative_of_square(b: &[f64; 6]) -> [[f64; 6]; 6] {
    let [b11, b22, b33, b12, b13, b23] = *b;
    let (h12, h13, h23) = (0.5 * b12, 0.5 * b13, 0.5 * b23);
    [
        [2.0 * b11, 0.0, 0.0, b12, b13, 0.0],
        [0.0, 2.0 * b22, 0.0, b12, 0.0, b23],
        [0.0, 0.0, 2.0 * b33, 0.0, b13, b23],
        [b12, b12, 0.0, 0.5 * (b11 + b22), h23, h13],
        [b13, 0.0, b13, h23, 0.5 * (b11 + b33), h12],
        [0.0, b23, b23, h13, h12, 0.5 * (b22 + b33)],
    ]
}

/// `D += s A (x) A`, keeping `D` symmetric to the last bit.
#[inline]
pub fn add_dyad(d: &mut [[f64; 6]; 6], s: f64, a: &[f64; 6]) {
    for i in 0..6 {
        for j in 0..6 {
            d[i][j] += s * (a[i] * a[j]);
        }
    }
}

/// The tensor of isotropic elasticity `lambda I (x) I + 2G I4`.
#[inline]
pub fn isotropic(lambda: f64, shear: f64) -> [[f64; 6]; 6] {
    let mut d = [[0.0; 6]; 6];
    for i in 0..3 {
        for j in 0..3 {
            d[i][j] = lambda;
        }
        d[i][i] = lambda + 2.0 * shear;
        d[i + 3][i + 3] = shear;
    }
    d
}

/// Beyond this `|C_ij|` (a stretch of 1e12), a state is a numerical blow-up.
const LARGEST_C: f64 = 1e24;
/// Below this `det C` (`J = 1e-12`), matter is flat. With `LARGEST_C` it keeps every intermediate result finite.
const SMALLEST_DET_C: f64 = 1e-24;

/// Refuses what is not finite, for laws that are defined for any finite `C`.
///
/// # Errors
/// [`Inverted`] if a component is NaN, infinite, or beyond any deformation (1e24).
#[inline]
pub fn require_finite<T: Real>(c: &[T; 6]) -> Result<(), Inverted> {
    let within = c
        .iter()
        .fold(true, |within, x| within & (x.re().abs() <= LARGEST_C));
    if within {
        Ok(())
    } else {
        Err(Inverted {
            det_c: determinant(c).re(),
        })
    }
}

/// What the laws of `J` need: cofactors and determinant of `C`, and the invariants of `C - I`.
///
/// Energies near the reference are differences of numbers that cancel: `I_1 - 3 - 2 ln J` computed as it is
/// written is wrong by 1e-16, which is all of it at a strain of 1e-8, and `(W1 - W0)/|E1 - E0|`, which
/// energy-conserving schemes use, is then noise long before. From the invariants of `A = C - I` nothing of first
/// order in the strain has to cancel: `I_1 = 3 + A_1`, `I_2 = 3 + 2 A_1 + A_2`, `I_3 = 1 + A_1 + A_2 + A_3`.
#[derive(Clone, Copy, Debug)]
pub struct StretchInvariants<T> {
    /// `det(C) C^-1`.
    pub cofactors: [T; 6],
    /// `I_3 = det C = J^2`.
    pub det_c: T,
    /// `A_1, A_2, A_3`: invariants of `A = C - I`.
    pub excess: [T; 3],
    /// `J = sqrt(det C)`.
    pub j: T,
    /// `J - 1`, exact to round-off of `C` for small strains.
    pub j_minus_1: T,
}

impl<T: Real> StretchInvariants<T> {
    /// Invariants of `C` (11 22 33 12 13 23).
    ///
    /// # Errors
    /// [`Inverted`] unless `C` is finite, positive definite and neither collapsed (`J < 1e-12`) nor blown up.
    #[inline]
    pub fn new(c: &[T; 6]) -> Result<Self, Inverted> {
        let cofactors = cofactors(c);
        let det_c = c[0] * cofactors[0] + c[3] * cofactors[3] + c[4] * cofactors[4];
        // Sylvester's criterion. Comparisons are written so that NaN fails.
        let positive =
            (c[0].re() > 0.0) & (cofactors[2].re() > 0.0) & (det_c.re() >= SMALLEST_DET_C);
        if !(positive & (trace(c).re() <= LARGEST_C)) {
            return Err(Inverted { det_c: det_c.re() });
        }
        let a = [c[0] - 1.0, c[1] - 1.0, c[2] - 1.0, c[3], c[4], c[5]];
        let a2 =
            a[0] * a[1] + a[0] * a[2] + a[1] * a[2] - (a[3] * a[3] + a[4] * a[4] + a[5] * a[5]);
        let excess = [trace(&a), a2, determinant(&a)];
        let j = det_c.sqrt();
        let j_minus_1 = (excess[0] + excess[1] + excess[2]) / (j + 1.0);
        Ok(Self {
            cofactors,
            det_c,
            excess,
            j,
            j_minus_1,
        })
    }

    /// `ln det C = 2 ln J`, exact to round-off of `C` for small strains.
    #[inline]
    pub fn ln_det_c(&self) -> T {
        let excess = self.excess[0] + self.excess[1] + self.excess[2];
        // Far from the reference det C itself has the better digits.
        if excess.re().abs() < 0.5 {
            excess.ln_1p()
        } else {
            self.det_c.ln()
        }
    }

    /// `C^-1`.
    #[inline]
    pub fn inverse(&self) -> [T; 6] {
        let scale = self.det_c.recip();
        self.cofactors.map(|x| x * scale)
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn full(a: &[f64; 6]) -> [[f64; 3]; 3] {
        [[a[0], a[3], a[4]], [a[3], a[1], a[5]], [a[4], a[5], a[2]]]
    }

    const PAIRS: [(usize, usize); 6] = [(0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)];

    fn any_tensor() -> [std::ops::Range<f64>; 6] {
        [
            -2.0..2.0,
            -2.0..2.0,
            -2.0..2.0,
            -2.0..2.0,
            -2.0..2.0,
            -2.0..2.0,
        ]
    }

    proptest! {
        #[test]
        fn products_follow_their_index_formula(a in any_tensor(), b in any_tensor()) {
            let (product, m, n) = (symmetric_product(&a, &b), full(&a), full(&b));
            for (row, (i, j)) in PAIRS.into_iter().enumerate() {
                for (column, (k, l)) in PAIRS.into_iter().enumerate() {
                    let half = |p: &[[f64; 3]; 3], q: &[[f64; 3]; 3]| 0.5 * (p[i][k] * q[j][l] + p[i][l] * q[j][k]);
                    prop_assert!((product[row][column] - half(&m, &n) - half(&n, &m)).abs() < 1e-13);
                    prop_assert_eq!(product[row][column], product[column][row]);
                }
            }
            prop_assert_eq!(derivative_of_square(&b), symmetric_product(&IDENTITY, &b));
        }

        #[test]
        fn square_cofactors_and_determinant_belong_together(a in any_tensor()) {
            let (m, squared, adjugate, det) = (full(&a), full(&square(&a)), full(&cofactors(&a)), determinant(&a));
            for i in 0..3 {
                for j in 0..3 {
                    let times = |p: &[[f64; 3]; 3]| (0..3).map(|k| m[i][k] * p[k][j]).sum::<f64>();
                    prop_assert!((squared[i][j] - times(&m)).abs() < 1e-13);
                    let expected = if i == j { det } else { 0.0 };
                    prop_assert!((times(&adjugate) - expected).abs() < 1e-12);
                }
            }
            prop_assert!((norm_squared(&a) - trace(&square(&a))).abs() < 1e-12);
        }

        #[test]
        fn stretch_invariants_are_those_of_c(l in [0.3..3.0, 0.3..3.0, 0.3..3.0]) {
            let c = [l[0] * l[0], l[1] * l[1], l[2] * l[2], 0.0, 0.0, 0.0];
            let invariants = StretchInvariants::new(&c).unwrap();
            let j: f64 = l.iter().product();
            prop_assert!((invariants.j - j).abs() < 1e-14 * j);
            prop_assert!((invariants.j_minus_1 - (j - 1.0)).abs() < 1e-12 * (1.0 + j));
            prop_assert!((invariants.ln_det_c() - 2.0 * j.ln()).abs() < 1e-12);
            prop_assert!((invariants.inverse()[1] - 1.0 / c[1]).abs() < 1e-13 / c[1]);
        }
    }

    #[test]
    fn change_of_volume_is_exact_for_small_strain() {
        // 2^-30 and its small multiples are exact in binary, so that J of this simple extension is known exactly.
        let change = 2.0_f64.powi(-30);
        let invariants = StretchInvariants::new(&[1.0 + change, 1.0, 1.0, 0.0, 0.0, 0.0]).unwrap();
        let expected = change / 2.0 - change * change / 8.0;
        assert!((invariants.j_minus_1 / expected - 1.0).abs() < 1e-15);
        assert!((invariants.ln_det_c() / change.ln_1p() - 1.0).abs() < 1e-15);
    }
}
