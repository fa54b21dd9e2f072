//! The iterative kernels of the bi-potential papers, for one contact with the others held.

use crate::cone::{self, Region};
use crate::law::{natural_map, predictor};
use crate::local::{Matrix, Vector, solve_small, tangential_norm};

/// Predictor-corrector steps a visit, and the relative change \[-\] that ends them: the neighbours change anyway.
const CORRECTIONS: usize = 10;
const CORRECTED: f64 = 1e-3;
/// Newton steps of Joli and Feng a visit, and the relative residual \[-\] that ends them.
const NEWTON_STEPS: usize = 15;
const SOLVED: f64 = 1e-14;

/// Predictor `r* = r - rho (x + mu |x_t| n)` and corrector `Proj(r*)` [Hu2022, eq. 30-32], a few times.
pub(crate) fn predict_correct<const D: usize>(
    w: &Matrix<D>,
    scale: f64,
    b: &Vector<D>,
    mu: f64,
    start: &Vector<D>,
) -> Vector<D> {
    let rho = safe_step(w, scale, mu);
    let mut r = *start;
    for _ in 0..CORRECTIONS {
        let f = natural_map(mu, rho, &(w * r + b), &r);
        r -= f;
        if f.amax() <= CORRECTED * r.amax() {
            break;
        }
    }
    r
}

/// A step below two over the largest row sum of `W`, less for the slope `mu` of `x_n + mu |x_t|`.
fn safe_step<const D: usize>(w: &Matrix<D>, scale: f64, mu: f64) -> f64 {
    let row = |i: usize| (0..D).map(|j| w[(i, j)].abs()).sum::<f64>();
    let largest = (0..D).map(row).fold(0.0, f64::max);
    1.0 / ((1.0 + 0.5 * mu) * largest.max(scale * f64::EPSILON))
}

/// Newton on `Z(r) = r - Proj(r*)` with its exact derivative \[Joli2008\]. It converges in about three steps, or not at
/// all (some three in a hundred random contacts): then the best point met is returned, projected.
pub(crate) fn joli_feng<const D: usize>(
    w: &Matrix<D>,
    scale: f64,
    b: &Vector<D>,
    mu: f64,
    start: &Vector<D>,
) -> Vector<D> {
    let rho = 1.0 / scale;
    let mut r = *start;
    let mut best = (f64::MAX, r);
    for _ in 0..NEWTON_STEPS {
        let u = w * r + b;
        let z = natural_map(mu, rho, &u, &r);
        let size = z.amax();
        if size < best.0 {
            best = (size, r);
        }
        if size <= SOLVED * r.amax() {
            break;
        }
        let Some(step) = solve_small(&derivative(w, rho, mu, &u, &r), &z) else {
            break;
        };
        r -= step;
    }
    cone::project(mu, &best.1)
}

/// `dZ/dr = I - P (I - rho G W)` with `P` the derivative of the projection and `G` that of `x + mu |x_t| n`.
fn derivative<const D: usize>(
    w: &Matrix<D>,
    rho: f64,
    mu: f64,
    u: &Vector<D>,
    r: &Vector<D>,
) -> Matrix<D> {
    let slip = tangential_norm(u);
    let p = projection_derivative(mu, &predictor(mu, rho, u, r));
    let mut modified = *w;
    if slip > 0.0 {
        for j in 0..D {
            let tangential: f64 = (0..D - 1).map(|i| u[i] * w[(i, j)]).sum();
            modified[(D - 1, j)] += mu * tangential / slip;
        }
    }
    Matrix::identity() - p * (Matrix::identity() - modified * rho)
}

fn projection_derivative<const D: usize>(mu: f64, z: &Vector<D>) -> Matrix<D> {
    match cone::region(mu, z) {
        Region::Polar => Matrix::zeros(),
        Region::Inside => Matrix::identity(),
        Region::Surface => {
            let (n, t) = (D - 1, tangential_norm(z));
            let height = (z[n] + mu * t) / (1.0 + mu * mu);
            let turn = mu * height / t;
            let mut p = Matrix::zeros();
            p[(n, n)] = 1.0 / (1.0 + mu * mu);
            for i in 0..n {
                let e = z[i] / t;
                p[(n, i)] = mu * e * p[(n, n)];
                p[(i, n)] = p[(n, i)];
                for j in 0..n {
                    let f = z[j] / t;
                    let across = turn * (f64::from(u8::from(i == j)) - e * f);
                    p[(i, j)] = mu * mu * e * f * p[(n, n)] + across;
                }
            }
            p
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{Matrix3, Vector3};
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn derivative_is_that_of_the_natural_map(
            r in prop::array::uniform3(-1.0..1.0_f64), b in prop::array::uniform3(-1.0..1.0_f64), mu in 0.05..1.5_f64
        ) {
            let w = Matrix3::new(1.0, 0.2, -0.1, 0.2, 1.4, 0.3, -0.1, 0.3, 0.8);
            let (r, b) = (Vector3::from(r), Vector3::from(b));
            let rho = 0.9;
            let u = w * r + b;
            let exact = derivative(&w, rho, mu, &u, &r);
            let h = 1e-6;
            for j in 0..3 {
                let (mut plus, mut minus) = (r, r);
                plus[j] += h;
                minus[j] -= h;
                let at = |r: &Vector<3>| natural_map(mu, rho, &(w * r + b), r);
                let region = |r: &Vector<3>| cone::region(mu, &predictor(mu, rho, &(w * r + b), r));
                prop_assume!(region(&plus) == region(&minus) && tangential_norm(&u) > 1e-2);
                let slope = (at(&plus) - at(&minus)) / (2.0 * h);
                prop_assert!((slope - exact.column(j)).amax() < 1e-5, "{j} {slope} {exact}");
            }
        }
    }
}
