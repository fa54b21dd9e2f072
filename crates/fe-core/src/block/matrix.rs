//! Matrices of the kernels: rows in arrays, of which the compiler keeps the entries in registers. At the border to the
//! law they become `nalgebra`'s, which costs nothing: the layouts are the same.

use hyperelastic::Symmetric;

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
    let entry = |i: usize, j: usize| f[0][i] * f[0][j] + f[1][i] * f[1][j] + f[2][i] * f[2][j];
    // Written out: `map` over an array of pairs is not inlined here.
    Symmetric::new(
        entry(0, 0),
        entry(1, 1),
        entry(2, 2),
        entry(0, 1),
        entry(0, 2),
        entry(1, 2),
    )
}
