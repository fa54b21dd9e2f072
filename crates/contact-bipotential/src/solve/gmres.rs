//! GMRES with a preconditioner on the right \[Saad1986\].

use crate::flat::{dot, norm};

/// Solves `A x = rhs` to the residual `tolerance |rhs|`: the solution and the iterations it took, `None` if `steps` do
/// not suffice or a number fails. `apply(v, out)` writes `A v`, `precondition` overwrites a vector with an approximate
/// solution.
pub(crate) fn gmres(
    apply: impl Fn(&[f64], &mut [f64]),
    precondition: impl Fn(&mut [f64]),
    rhs: &[f64],
    tolerance: f64,
    steps: usize,
) -> Option<(Vec<f64>, usize)> {
    let size = norm(rhs);
    if size == 0.0 || !size.is_finite() {
        return None;
    }
    let mut basis = vec![rhs.iter().map(|x| x / size).collect::<Vec<f64>>()];
    let mut reduced = Hessenberg::new(size);
    for k in 0..steps {
        let mut direction = basis[k].clone();
        precondition(&mut direction);
        let mut image = vec![0.0; direction.len()];
        apply(&direction, &mut image);
        let mut column = Vec::with_capacity(k + 2);
        for q in &basis {
            let h = dot(q, &image);
            image.iter_mut().zip(q).for_each(|(x, q)| *x -= h * q);
            column.push(h);
        }
        let rest = norm(&image);
        column.push(rest);
        let residual = reduced.push(column);
        if !residual.is_finite() {
            return None;
        }
        if residual <= tolerance * size || rest == 0.0 {
            let weights = reduced.solve();
            let mut sum = vec![0.0; rhs.len()];
            for (q, y) in basis.iter().zip(&weights) {
                sum.iter_mut().zip(q).for_each(|(s, q)| *s += y * q);
            }
            precondition(&mut sum);
            return sum.iter().all(|x| x.is_finite()).then_some((sum, k + 1));
        }
        basis.push(image.iter().map(|x| x / rest).collect());
    }
    None
}

/// The small least-squares problem of GMRES, triangular by Givens rotations.
struct Hessenberg {
    columns: Vec<Vec<f64>>,
    rotations: Vec<(f64, f64)>,
    right: Vec<f64>,
}

impl Hessenberg {
    fn new(norm: f64) -> Self {
        Hessenberg {
            columns: Vec::new(),
            rotations: Vec::new(),
            right: vec![norm],
        }
    }

    /// Adds a column and returns the norm of the residual.
    fn push(&mut self, mut column: Vec<f64>) -> f64 {
        let k = self.columns.len();
        for (i, (c, s)) in self.rotations.iter().enumerate() {
            (column[i], column[i + 1]) = (
                c * column[i] + s * column[i + 1],
                c * column[i + 1] - s * column[i],
            );
        }
        let size = column[k].hypot(column[k + 1]);
        let (c, s) = if size > 0.0 {
            (column[k] / size, column[k + 1] / size)
        } else {
            (1.0, 0.0)
        };
        column[k] = size;
        column.truncate(k + 1);
        let last = self.right[k];
        self.right[k] = c * last;
        self.right.push(-s * last);
        self.rotations.push((c, s));
        self.columns.push(column);
        self.right[k + 1].abs()
    }

    fn solve(&self) -> Vec<f64> {
        let n = self.columns.len();
        let mut y = self.right[..n].to_vec();
        for k in (0..n).rev() {
            y[k] /= self.columns[k][k];
            for i in 0..k {
                y[i] -= self.columns[k][i] * y[k];
            }
        }
        y
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// An unsymmetric tridiagonal matrix, preconditioned by its diagonal.
    #[test]
    fn the_residual_is_as_small_as_asked() {
        let n = 30_usize;
        let apply = |x: &[f64], out: &mut [f64]| {
            for i in 0..n {
                let (left, right) = (i.checked_sub(1), x.get(i + 1));
                out[i] = 4.0 * x[i] - left.map_or(0.0, |k| x[k]) - 2.0 * right.unwrap_or(&0.0);
            }
        };
        let precondition = |x: &mut [f64]| x.iter_mut().for_each(|x| *x *= 0.25);
        let rhs: Vec<f64> = (0..n).map(|i| (i % 5) as f64 - 1.5).collect();
        let (x, steps) = gmres(apply, precondition, &rhs, 1e-8, 40).unwrap();
        let mut image = vec![0.0; n];
        apply(&x, &mut image);
        image.iter_mut().zip(&rhs).for_each(|(a, b)| *a -= b);
        assert!(norm(&image) < 2e-8 * norm(&rhs) && steps > 3);
        assert!(gmres(apply, precondition, &rhs, 1e-8, 3).is_none());
    }
}
