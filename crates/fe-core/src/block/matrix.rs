//! Matrices of the kernels: rows in arrays, of which the compiler keeps the entries in registers. At the border to the law
//! they become `nalgebra`'s, which costs nothing: the layouts are the same.

use hyperelastic::Symmetric;
use hyperelastic::tensor::COMPONENTS;

/// Rows.
pub(super) type Matrix = [[f64; 3]; 3];

#[inline(always)]
pub(super) fn determinant(m: &Matrix) -> f64 {
    m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1])
        - m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0])
        + m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0])
}

/// `C = F^T F` \[-\], see [`hyperelastic::right_cauchy_green`].
#[inline(always)]
pub(super) fn right_cauchy_green(f: &Matrix) -> Symmetric {
    let entry = |(i, j): (usize, usize)| f[0][i] * f[0][j] + f[1][i] * f[1][j] + f[2][i] * f[2][j];
    Symmetric::from(COMPONENTS.map(entry))
}
