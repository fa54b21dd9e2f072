//! Vectors and matrices of one contact.
//!
//! A local vector holds the tangential components first and the normal component **last**: `(n)`, `(t, n)` or
//! `(t1, t2, n)`. Matrices are stored by rows.

/// A vector of one contact, normal component last.
pub type Vector<const D: usize> = [f64; D];
/// A matrix of one contact, by rows, normal row and column last.
pub type Matrix<const D: usize> = [[f64; D]; D];

/// Which of `(t1, t2, n)` the entries of a local vector of so many entries are.
#[inline(always)]
pub const fn local_axes(entries: usize) -> &'static [usize] {
    match entries {
        1 => &[2],
        2 => &[0, 2],
        _ => &[0, 1, 2],
    }
}

/// The vector in `(t1, t2, n)`; tangents that it does not have are zero.
#[inline(always)]
pub fn spatial<const D: usize>(v: &Vector<D>) -> [f64; 3] {
    let mut x = [0.0; 3];
    for (v, axis) in v.iter().zip(local_axes(D)) {
        x[*axis] = *v;
    }
    x
}

/// Scalar product.
#[inline(always)]
pub fn dot<const D: usize>(a: &Vector<D>, b: &Vector<D>) -> f64 {
    let mut sum = 0.0;
    for i in 0..D {
        sum += a[i] * b[i];
    }
    sum
}

/// Scalar product of the tangential parts.
#[inline(always)]
pub fn tangential_dot<const D: usize>(a: &Vector<D>, b: &Vector<D>) -> f64 {
    let mut sum = 0.0;
    for i in 0..D - 1 {
        sum += a[i] * b[i];
    }
    sum
}

/// Length of the tangential part.
#[inline(always)]
pub fn tangential_norm<const D: usize>(v: &Vector<D>) -> f64 {
    match D {
        1 => 0.0,
        2 => v[0].abs(),
        _ => tangential_dot(v, v).sqrt(),
    }
}

/// Largest absolute component.
#[inline(always)]
pub fn max_abs<const D: usize>(v: &Vector<D>) -> f64 {
    let mut m = 0.0_f64;
    for x in v {
        m = m.max(x.abs());
    }
    m
}

/// `A x`.
#[inline(always)]
pub fn times<const D: usize>(a: &Matrix<D>, x: &Vector<D>) -> Vector<D> {
    let mut y = [0.0; D];
    for i in 0..D {
        y[i] = dot(&a[i], x);
    }
    y
}

/// `A x + b`.
#[inline(always)]
pub fn affine<const D: usize>(a: &Matrix<D>, x: &Vector<D>, b: &Vector<D>) -> Vector<D> {
    let mut y = *b;
    for i in 0..D {
        y[i] += dot(&a[i], x);
    }
    y
}

/// `a - b`.
#[inline(always)]
pub fn difference<const D: usize>(a: &Vector<D>, b: &Vector<D>) -> Vector<D> {
    let mut y = *a;
    for i in 0..D {
        y[i] -= b[i];
    }
    y
}

/// Sum of the diagonal.
#[inline(always)]
pub fn trace<const D: usize>(a: &Matrix<D>) -> f64 {
    let mut sum = 0.0;
    for i in 0..D {
        sum += a[i][i];
    }
    sum
}

/// Solves `A x = b` by elimination with partial pivoting; `None` when a pivot vanishes.
#[inline]
pub fn solve_small<const D: usize>(a: &Matrix<D>, b: &Vector<D>) -> Option<Vector<D>> {
    let (mut a, mut b) = (*a, *b);
    for k in 0..D {
        let mut p = k;
        for i in k + 1..D {
            if a[i][k].abs() > a[p][k].abs() {
                p = i;
            }
        }
        if a[p][k] == 0.0 || !a[p][k].is_finite() {
            return None;
        }
        a.swap(k, p);
        b.swap(k, p);
        let inv = 1.0 / a[k][k];
        for i in k + 1..D {
            let l = a[i][k] * inv;
            for j in k + 1..D {
                a[i][j] -= l * a[k][j];
            }
            b[i] -= l * b[k];
        }
    }
    for k in (0..D).rev() {
        for j in k + 1..D {
            b[k] -= a[k][j] * b[j];
        }
        b[k] /= a[k][k];
    }
    b.iter().all(|x| x.is_finite()).then_some(b)
}

/// Inverse by elimination with partial pivoting; `None` when singular.
#[inline]
pub fn inverse<const D: usize>(a: &Matrix<D>) -> Option<Matrix<D>> {
    let (mut a, mut x) = (*a, [[0.0; D]; D]);
    for i in 0..D {
        x[i][i] = 1.0;
    }
    for k in 0..D {
        let mut p = k;
        for i in k + 1..D {
            if a[i][k].abs() > a[p][k].abs() {
                p = i;
            }
        }
        if a[p][k] == 0.0 || !a[p][k].is_finite() {
            return None;
        }
        a.swap(k, p);
        x.swap(k, p);
        let inv = 1.0 / a[k][k];
        for i in 0..D {
            if i == k {
                continue;
            }
            let l = a[i][k] * inv;
            for j in 0..D {
                a[i][j] -= l * a[k][j];
                x[i][j] -= l * x[k][j];
            }
        }
        for j in 0..D {
            a[k][j] *= inv;
            x[k][j] *= inv;
        }
    }
    let sum: f64 = x.iter().flatten().sum();
    sum.is_finite().then_some(x)
}

/// The `D` entries of contact `c` in a flat vector.
#[inline(always)]
pub fn load<const D: usize>(flat: &[f64], c: usize) -> Vector<D> {
    let mut v = [0.0; D];
    v.copy_from_slice(&flat[c * D..c * D + D]);
    v
}

/// Writes the `D` entries of contact `c` into a flat vector.
#[inline(always)]
pub fn store<const D: usize>(flat: &mut [f64], c: usize, v: &Vector<D>) {
    flat[c * D..c * D + D].copy_from_slice(v);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn elimination_pivots_and_inverts() {
        let a = [[0.0, 2.0, 1.0], [1.0, 0.0, 3.0], [4.0, 1.0, 0.0]];
        let x = [1.0, -2.0, 0.5];
        let found = solve_small(&a, &times(&a, &x)).unwrap();
        let inv = inverse(&a).unwrap();
        for i in 0..3 {
            assert!((found[i] - x[i]).abs() < 1e-14);
            for j in 0..3 {
                let mut s = 0.0;
                for k in 0..3 {
                    s += a[i][k] * inv[k][j];
                }
                assert!((s - f64::from(u8::from(i == j))).abs() < 1e-14);
            }
        }
        assert!(solve_small(&[[1.0, 2.0], [2.0, 4.0]], &[1.0, 1.0]).is_none());
    }
}
