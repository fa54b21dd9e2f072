//! Symmetric 3x3 tensors as six components 11 22 33 12 13 23, and what a law needs of them.
//!
//! Shear components are tensor components, not doubled.

use nalgebra::{Matrix3, SMatrix, SVector};

use crate::real::Real;

/// A symmetric second-order tensor: tensor components 11 22 33 12 13 23, shear not doubled.
pub type Symmetric<T = f64> = SVector<T, 6>;

/// A fourth-order tensor that maps symmetric tensors: tensor components `D_ijkl`, row `ij` and column `kl` in the order
/// 11 22 33 12 13 23. Its product with a strain takes engineering shear.
pub type Tangent = SMatrix<f64, 6, 6>;

/// Row and column in the full matrix of each of the six components.
pub const COMPONENTS: [(usize, usize); 6] = [(0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)];

/// Which of the six components stands in row `i` and column `j` of the full matrix.
pub const INDEX: [[usize; 3]; 3] = [[0, 3, 4], [3, 1, 5], [4, 5, 2]];

/// The unit tensor.
pub const IDENTITY: Symmetric = Symmetric::new(1.0, 1.0, 1.0, 0.0, 0.0, 0.0);

/// The full matrix.
#[must_use]
#[inline]
pub fn to_matrix(a: &Symmetric) -> Matrix3<f64> {
    Matrix3::new(a[0], a[3], a[4], a[3], a[1], a[5], a[4], a[5], a[2])
}

/// The six components of a matrix that is symmetric; the upper triangle is read.
#[must_use]
#[inline]
pub(crate) fn from_matrix(m: &Matrix3<f64>) -> Symmetric {
    Symmetric::from(COMPONENTS.map(|ij| m[ij]))
}

/// `tr A`.
#[must_use]
#[inline]
pub fn trace<T: Real>(a: &Symmetric<T>) -> T {
    a[0] + a[1] + a[2]
}

/// `A : A = tr(A^2)`.
#[must_use]
#[inline]
pub fn norm_squared<T: Real>(a: &Symmetric<T>) -> T {
    a[0] * a[0] + a[1] * a[1] + a[2] * a[2] + (a[3] * a[3] + a[4] * a[4] + a[5] * a[5]) * 2.0
}

/// Cofactors of `A`: `adj A = det(A) A^-1`, but they exist for a singular `A` too.
#[must_use]
#[inline]
pub fn cofactors<T: Real>(a: &Symmetric<T>) -> Symmetric<T> {
    Symmetric::new(
        a[1] * a[2] - a[5] * a[5],
        a[0] * a[2] - a[4] * a[4],
        a[0] * a[1] - a[3] * a[3],
        a[4] * a[5] - a[3] * a[2],
        a[3] * a[5] - a[4] * a[1],
        a[3] * a[4] - a[5] * a[0],
    )
}

/// `det A`.
#[must_use]
#[inline]
pub fn determinant<T: Real>(a: &Symmetric<T>) -> T {
    let cofactor = cofactors(a);
    a[0] * cofactor[0] + a[3] * cofactor[3] + a[4] * cofactor[4]
}

/// `A^2`.
#[must_use]
#[inline]
pub fn square<T: Real>(a: &Symmetric<T>) -> Symmetric<T> {
    Symmetric::new(
        a[0] * a[0] + a[3] * a[3] + a[4] * a[4],
        a[3] * a[3] + a[1] * a[1] + a[5] * a[5],
        a[4] * a[4] + a[5] * a[5] + a[2] * a[2],
        (a[0] + a[1]) * a[3] + a[4] * a[5],
        (a[0] + a[2]) * a[4] + a[3] * a[5],
        (a[1] + a[2]) * a[5] + a[3] * a[4],
    )
}

/// `E = (C - I)/2`, Green-Lagrange strain \[-\].
#[must_use]
#[inline]
pub fn green_lagrange<T: Real>(c: &Symmetric<T>) -> Symmetric<T> {
    Symmetric::new(
        (c[0] - 1.0) * 0.5,
        (c[1] - 1.0) * 0.5,
        (c[2] - 1.0) * 0.5,
        c[3] * 0.5,
        c[4] * 0.5,
        c[5] * 0.5,
    )
}

/// Engineering components, which a [`Tangent`] multiplies: shear doubled.
#[must_use]
#[inline]
pub fn engineering(e: &Symmetric) -> Symmetric {
    Symmetric::new(e[0], e[1], e[2], 2.0 * e[3], 2.0 * e[4], 2.0 * e[5])
}

/// A tensor given component by component. Loops over arrays become vector instructions everywhere; chains of
/// `nalgebra`'s operators do not always.
#[inline(always)]
pub(crate) fn by_component(entry: impl Fn(usize) -> f64) -> Symmetric {
    let mut a = [0.0; 6];
    for i in 0..6 {
        a[i] = entry(i);
    }
    Symmetric::from(a)
}

/// `A += s I`.
#[inline]
pub(crate) fn add_spherical(a: &mut Symmetric, s: f64) {
    a[0] += s;
    a[1] += s;
    a[2] += s;
}

/// `A (.) B + B (.) A` with `(A (.) B)_ijkl = (A_ik B_jl + A_il B_jk)/2` \[Feng2007, eq. 23\], symmetric to the last
/// bit.
///
/// It maps a symmetric `X` to `A X B + B X A`: with `A = B = C^-1`, to minus twice the change of `C^-1` when `C`
/// changes by `X`.
#[must_use]
#[inline]
pub fn symmetric_product(a: &Symmetric, b: &Symmetric) -> Tangent {
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
    Tangent::from([
        [2.0 * a[0] * b[0], m01, m02, m03, m04, m05],
        [m01, 2.0 * a[1] * b[1], m12, m13, m14, m15],
        [m02, m12, 2.0 * a[2] * b[2], m23, m24, m25],
        [m03, m13, m23, m33, m34, m35],
        [m04, m14, m24, m34, m44, m45],
        [m05, m15, m25, m35, m45, m55],
    ])
}

/// `I (.) B + B (.) I`: the derivative of `X^2` at `X = B`, with the zeros of `I` known beforehand.
#[must_use]
#[inline]
pub(crate) fn derivative_of_square(b: &Symmetric) -> Tangent {
    let [b11, b22, b33, b12, b13, b23] = (*b).into();
    let (h12, h13, h23) = (0.5 * b12, 0.5 * b13, 0.5 * b23);
    Tangent::from([
        [2.0 * b11, 0.0, 0.0, b12, b13, 0.0],
        [0.0, 2.0 * b22, 0.0, b12, 0.0, b23],
        [0.0, 0.0, 2.0 * b33, 0.0, b13, b23],
        [b12, b12, 0.0, 0.5 * (b11 + b22), h23, h13],
        [b13, 0.0, b13, h23, 0.5 * (b11 + b33), h12],
        [0.0, b23, b23, h13, h12, 0.5 * (b22 + b33)],
    ])
}

/// `D += s A (x) A`, keeping `D` symmetric to the last bit.
#[inline]
pub fn add_dyad(d: &mut Tangent, s: f64, a: &Symmetric) {
    let (columns, [a]) = (&mut d.data.0, &a.data.0);
    for j in 0..6 {
        for i in 0..6 {
            columns[j][i] += s * (a[i] * a[j]);
        }
    }
}

/// The tensor of isotropic elasticity `lambda I (x) I + 2G I4` \[Pa\].
#[must_use]
#[inline]
pub fn isotropic(lambda: f64, shear: f64) -> Tangent {
    let mut d = [[0.0; 6]; 6];
    for i in 0..3 {
        for j in 0..3 {
            d[i][j] = lambda;
        }
        d[i][i] = lambda + 2.0 * shear;
        d[i + 3][i + 3] = shear;
    }
    Tangent::from(d)
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn any_tensor() -> impl Strategy<Value = Symmetric> {
        prop::array::uniform6(-2.0..2.0).prop_map(Symmetric::from)
    }

    proptest! {
        #[test]
        fn products_follow_their_index_formula(a in any_tensor(), b in any_tensor()) {
            let (product, m, n) = (symmetric_product(&a, &b), to_matrix(&a), to_matrix(&b));
            for (row, (i, j)) in COMPONENTS.into_iter().enumerate() {
                for (column, (k, l)) in COMPONENTS.into_iter().enumerate() {
                    let half = |p: &Matrix3<f64>, q: &Matrix3<f64>| 0.5 * (p[(i, k)] * q[(j, l)] + p[(i, l)] * q[(j, k)]);
                    prop_assert!((product[(row, column)] - half(&m, &n) - half(&n, &m)).abs() < 1e-13);
                    prop_assert_eq!(product[(row, column)], product[(column, row)]);
                }
            }
            prop_assert_eq!(derivative_of_square(&b), symmetric_product(&IDENTITY, &b));
        }

        #[test]
        fn square_cofactors_and_determinant_belong_together(a in any_tensor()) {
            let (m, squared, adjugate, det) = (to_matrix(&a), to_matrix(&square(&a)), to_matrix(&cofactors(&a)), determinant(&a));
            for i in 0..3 {
                for j in 0..3 {
                    let times = |p: &Matrix3<f64>| (0..3).map(|k| m[(i, k)] * p[(k, j)]).sum::<f64>();
                    prop_assert!((squared[(i, j)] - times(&m)).abs() < 1e-13);
                    let expected = if i == j { det } else { 0.0 };
                    prop_assert!((times(&adjugate) - expected).abs() < 1e-12);
                }
            }
            prop_assert!((norm_squared(&a) - trace(&square(&a))).abs() < 1e-12);
        }
    }
}
