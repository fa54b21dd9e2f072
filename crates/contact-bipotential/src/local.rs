//! Vectors and matrices of one contact.
//!
//! A local vector holds the tangential components first and the normal component **last**: `(n)`, `(t, n)` or
//! `(t1, t2, n)`.

use nalgebra::{SMatrix, SVector, Vector3};

/// A vector of one contact, normal component last.
pub type Vector<const D: usize> = SVector<f64, D>;
/// A matrix of one contact, normal row and column last; need not be symmetric.
pub type Matrix<const D: usize> = SMatrix<f64, D, D>;

/// Which of `(t1, t2, n)` the entries of a local vector of so many entries are.
#[inline(always)]
pub(crate) const fn local_axes(entries: usize) -> &'static [usize] {
    match entries {
        1 => &[2],
        2 => &[0, 2],
        _ => &[0, 1, 2],
    }
}

/// The vector in `(t1, t2, n)`; tangents that it does not have are zero.
#[inline(always)]
pub(crate) fn spatial<const D: usize>(v: &Vector<D>) -> Vector3<f64> {
    let mut x = Vector3::zeros();
    for (v, axis) in v.iter().zip(local_axes(D)) {
        x[*axis] = *v;
    }
    x
}

/// The entries of a vector in `(t1, t2, n)` that a local vector has.
#[inline(always)]
pub(crate) fn from_spatial<const D: usize>(x: &Vector3<f64>) -> Vector<D> {
    let mut v = Vector::<D>::zeros();
    for (v, axis) in v.iter_mut().zip(local_axes(D)) {
        *v = x[*axis];
    }
    v
}

/// Scalar product of the tangential parts.
#[inline(always)]
pub(crate) fn tangential_dot<const D: usize>(a: &Vector<D>, b: &Vector<D>) -> f64 {
    let mut sum = 0.0;
    for i in 0..D - 1 {
        sum += a[i] * b[i];
    }
    sum
}

/// Length of the tangential part.
#[inline(always)]
pub(crate) fn tangential_norm<const D: usize>(v: &Vector<D>) -> f64 {
    match D {
        1 => 0.0,
        2 => v[0].abs(),
        _ => tangential_dot(v, v).sqrt(),
    }
}

/// Solves `A x = b` by elimination with partial pivoting; `None` when a pivot vanishes.
///
/// The LU of nalgebra pivots too, but its bounds (`DimMin`) would stand at every function that is generic in `D`.
#[inline]
pub(crate) fn solve_small<const D: usize>(a: &Matrix<D>, b: &Vector<D>) -> Option<Vector<D>> {
    let (mut a, mut b) = (*a, *b);
    for k in 0..D {
        let p = pivot_row(&a, k)?;
        a.swap_rows(k, p);
        b.swap_rows(k, p);
        let inv = 1.0 / a[(k, k)];
        for i in k + 1..D {
            let l = a[(i, k)] * inv;
            for j in k + 1..D {
                a[(i, j)] -= l * a[(k, j)];
            }
            b[i] -= l * b[k];
        }
    }
    for k in (0..D).rev() {
        for j in k + 1..D {
            b[k] -= a[(k, j)] * b[j];
        }
        b[k] /= a[(k, k)];
    }
    b.iter().all(|x| x.is_finite()).then_some(b)
}

/// Inverse by elimination with partial pivoting; `None` when singular.
///
/// `try_inverse` of nalgebra takes cofactors: it loses the digits of ill-conditioned blocks and, where entries are
/// below 1e-103 or above 1e102, the determinant under- or overflows (a test below shows both).
#[inline]
pub(crate) fn inverse<const D: usize>(a: &Matrix<D>) -> Option<Matrix<D>> {
    let (mut a, mut x) = (*a, Matrix::<D>::identity());
    for k in 0..D {
        let p = pivot_row(&a, k)?;
        a.swap_rows(k, p);
        x.swap_rows(k, p);
        let inv = 1.0 / a[(k, k)];
        for i in 0..D {
            if i == k {
                continue;
            }
            let l = a[(i, k)] * inv;
            for j in 0..D {
                a[(i, j)] -= l * a[(k, j)];
                x[(i, j)] -= l * x[(k, j)];
            }
        }
        for j in 0..D {
            a[(k, j)] *= inv;
            x[(k, j)] *= inv;
        }
    }
    x.sum().is_finite().then_some(x)
}

/// The row from `k` on with the largest entry in column `k`; `None` where that is no pivot.
#[inline(always)]
fn pivot_row<const D: usize>(a: &Matrix<D>, k: usize) -> Option<usize> {
    let mut p = k;
    for i in k + 1..D {
        if a[(i, k)].abs() > a[(p, k)].abs() {
            p = i;
        }
    }
    let pivot = a[(p, k)];
    (pivot != 0.0 && pivot.is_finite()).then_some(p)
}

/// The `D` entries of contact `c` in a flat vector.
#[inline(always)]
pub(crate) fn load<const D: usize>(flat: &[f64], c: usize) -> Vector<D> {
    let mut v = [0.0; D];
    v.copy_from_slice(&flat[c * D..c * D + D]);
    Vector::from(v)
}

/// Writes the `D` entries of contact `c` into a flat vector.
#[inline(always)]
pub(crate) fn store<const D: usize>(flat: &mut [f64], c: usize, v: &Vector<D>) {
    flat[c * D..c * D + D].copy_from_slice(v.as_slice());
}

/// The block whose entries stand in `values` by rows.
#[inline(always)]
pub(crate) fn load_block<const D: usize>(values: &[f64]) -> Matrix<D> {
    let values = &values[..D * D];
    let mut block = Matrix::zeros();
    for i in 0..D {
        for j in 0..D {
            block[(i, j)] = values[i * D + j];
        }
    }
    block
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{Matrix2, Matrix3, Vector2};

    #[test]
    fn elimination_pivots_and_inverts() {
        let a = Matrix3::new(0.0, 2.0, 1.0, 1.0, 0.0, 3.0, 4.0, 1.0, 0.0);
        let x = Vector3::new(1.0, -2.0, 0.5);
        let found = solve_small(&a, &(a * x)).unwrap();
        assert!((found - x).amax() < 1e-14);
        assert!((a * inverse(&a).unwrap() - Matrix3::identity()).amax() < 1e-14);
        let singular = Matrix2::new(1.0, 2.0, 2.0, 4.0);
        assert!(solve_small(&singular, &Vector2::new(1.0, 1.0)).is_none());
    }

    /// Why pivoted elimination stays: cofactors lose what it keeps.
    #[test]
    fn elimination_keeps_digits_and_range_that_cofactors_lose() {
        // Rows of very different size, as blocks of stiff and soft directions are.
        let graded = Matrix3::new(1.0, 1.0, 1.0, 1.0, 1.0 + 1e-9, 1.0, 1.0, 1.0, 1.0 + 1e-9);
        let error = |x: &Matrix3<f64>| (x * graded - Matrix3::identity()).amax();
        let ours = error(&inverse(&graded).unwrap());
        let cofactors = graded.try_inverse().map_or(f64::MAX, |x| error(&x));
        assert!(ours < 0.1 * cofactors, "{ours:e} {cofactors:e}");
        for size in [1e-120, 1e120] {
            let a = Matrix3::new(2.0, 0.1, 0.2, 0.1, 1.5, -0.1, 0.2, -0.1, 1.0) * size;
            let ours = inverse(&a).unwrap();
            assert!((a * ours - Matrix3::identity()).amax() < 1e-14);
            let cofactors = a
                .try_inverse()
                .filter(|x| x.iter().all(|x| x.is_finite() && *x != 0.0));
            assert!(cofactors.is_none_or(|x| (a * x - Matrix3::identity()).amax() > 1e-3));
        }
    }
}
