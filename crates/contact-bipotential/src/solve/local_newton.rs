//! The iterative kernels of the bi-potential papers, for one contact with the others held.

use crate::cone::{self, Region};
use crate::law::natural_map;
use crate::local::{Matrix, Vector, affine, dot, max_abs, solve_small, tangential_norm};

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
    for _ in 0..10 {
        let f = natural_map(mu, rho, &affine(w, &r, b), &r);
        for i in 0..D {
            r[i] -= f[i];
        }
        if max_abs(&f) <= 1e-3 * max_abs(&r) {
            break;
        }
    }
    r
}

/// A step below two over the largest row sum of `W`, less for the slope `mu` of `x_n + mu |x_t|`.
fn safe_step<const D: usize>(w: &Matrix<D>, scale: f64, mu: f64) -> f64 {
    let row = |r: &Vector<D>| r.iter().map(|x| x.abs()).sum::<f64>();
    let largest = w.iter().map(row).fold(0.0, f64::max);
    1.0 / ((1.0 + 0.5 * mu) * largest.max(scale * f64::EPSILON))
}

/// Newton on `Z(r) = r - Proj(r*)` with its exact derivative \[Joli2008\]. It converges in about three steps, or not at all
/// (some three in a hundred random contacts): then the best point met is returned, projected.
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
    for _ in 0..15 {
        let u = affine(w, &r, b);
        let z = natural_map(mu, rho, &u, &r);
        let size = max_abs(&z);
        if size < best.0 {
            best = (size, r);
        }
        if size <= 1e-14 * max_abs(&r) {
            break;
        }
        let Some(step) = solve_small(&derivative(w, rho, mu, &u, &r), &z) else {
            break;
        };
        for i in 0..D {
            r[i] -= step[i];
        }
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
    let v = cone::modified_velocity(mu, u);
    let slip = tangential_norm(u);
    let mut z = *r;
    for i in 0..D {
        z[i] -= rho * v[i];
    }
    let p = projection_derivative(mu, &z);
    let mut a = [[0.0; D]; D];
    for j in 0..D {
        let mut column = [0.0; D];
        for i in 0..D {
            column[i] = w[i][j];
        }
        let tangential: f64 = (0..D - 1).map(|i| u[i] * column[i]).sum();
        if slip > 0.0 {
            column[D - 1] += mu * tangential / slip;
        }
        for i in 0..D {
            column[i] = f64::from(u8::from(i == j)) - rho * column[i];
        }
        for i in 0..D {
            a[i][j] = f64::from(u8::from(i == j)) - dot(&p[i], &column);
        }
    }
    a
}

fn projection_derivative<const D: usize>(mu: f64, z: &Vector<D>) -> Matrix<D> {
    let mut p = [[0.0; D]; D];
    match cone::region(mu, z) {
        Region::Polar => {}
        Region::Inside => {
            for i in 0..D {
                p[i][i] = 1.0;
            }
        }
        Region::Surface => {
            let (n, t) = (D - 1, tangential_norm(z));
            let height = (z[n] + mu * t) / (1.0 + mu * mu);
            let turn = mu * height / t;
            p[n][n] = 1.0 / (1.0 + mu * mu);
            for i in 0..n {
                let e = z[i] / t;
                p[n][i] = mu * e * p[n][n];
                p[i][n] = p[n][i];
                for j in 0..n {
                    let f = z[j] / t;
                    p[i][j] =
                        mu * mu * e * f * p[n][n] + turn * (f64::from(u8::from(i == j)) - e * f);
                }
            }
        }
    }
    p
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn derivative_is_that_of_the_natural_map(
            r in prop::array::uniform3(-1.0..1.0_f64), b in prop::array::uniform3(-1.0..1.0_f64), mu in 0.05..1.5_f64
        ) {
            let w = [[1.0, 0.2, -0.1], [0.2, 1.4, 0.3], [-0.1, 0.3, 0.8]];
            let rho = 0.9;
            let u = affine(&w, &r, &b);
            let exact = derivative(&w, rho, mu, &u, &r);
            let h = 1e-6;
            for j in 0..3 {
                let (mut plus, mut minus) = (r, r);
                plus[j] += h;
                minus[j] -= h;
                let fp = natural_map(mu, rho, &affine(&w, &plus, &b), &plus);
                let fm = natural_map(mu, rho, &affine(&w, &minus, &b), &minus);
                let region = |r: &Vector<3>| {
                    let mut z = *r;
                    let v = cone::modified_velocity(mu, &affine(&w, r, &b));
                    for i in 0..3 {
                        z[i] -= rho * v[i];
                    }
                    cone::region(mu, &z)
                };
                prop_assume!(region(&plus) == region(&minus) && tangential_norm(&u) > 1e-2);
                for i in 0..3 {
                    let slope = (fp[i] - fm[i]) / (2.0 * h);
                    prop_assert!((slope - exact[i][j]).abs() < 1e-5, "{i} {j} {slope} {}", exact[i][j]);
                }
            }
        }
    }
}
