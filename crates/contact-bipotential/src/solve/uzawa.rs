//! The predictor-corrector of the bi-potential papers on all contacts at once.

use crate::cone;
use crate::error_measure::ErrorMeasure;
use crate::flat::norm;
use crate::law::predictor;
use crate::local::{load, store};
use crate::problem::ContactProblem;
use crate::solve::acceleration::Acceleration;
use crate::solve::iterate::Iterate;
use crate::solve::outcome::Work;

/// Error over the best one met \[-\] that says that `rho` is too long.
const EXPLODED: f64 = 100.0;
/// Steps of the power iteration, and the factor \[-\] by which its value may fall short.
const POWER_STEPS: usize = 20;
const MARGIN: f64 = 1.1;
/// The start of the power iteration, `1 + SPREAD (k - 3) / 7` with `k` from 0 to 6 and again: alike in no symmetry of a
/// mesh, so that it is orthogonal to no eigenvector by accident.
const PERIOD: usize = 7;
const SPREAD: f64 = 0.5;

/// `r <- Proj(r - rho_c (u + mu |u_t| n))` for every contact together, `rho_c = rho / w_c`.
///
/// It needs nothing but products with `W`. `rho` starts at one over the largest eigenvalue of the scaled `W` and is
/// halved where the error explodes. Linear convergence, slow where `W` is ill-conditioned; `accelerated` extrapolates
/// the sequence.
pub(crate) fn uzawa<const D: usize>(
    problem: &ContactProblem,
    measure: &ErrorMeasure<'_>,
    best: &mut Iterate,
    tolerance: f64,
    budget: usize,
    accelerated: bool,
    work: &mut Work,
) {
    let mut rho = 1.0 / largest_eigenvalue::<D>(problem, measure).max(f64::MIN_POSITIVE);
    let mut x = best.clone();
    let mut acceleration = Acceleration::new();
    for _ in 0..budget {
        if best.is_within(tolerance) {
            return;
        }
        work.projections += 1;
        let before = x.r.clone();
        correct::<D>(problem, measure, rho, &mut x);
        x.refresh(measure);
        let improved = best.keep_better(&x);
        if x.errors.scale_free > EXPLODED * best.errors.scale_free {
            rho *= 0.5;
            x = best.clone();
            acceleration.forget();
            continue;
        }
        if accelerated {
            acceleration.accelerate(measure, &before, &mut x, best, improved);
        }
    }
}

fn correct<const D: usize>(
    problem: &ContactProblem,
    measure: &ErrorMeasure<'_>,
    rho: f64,
    x: &mut Iterate,
) {
    for (c, (&mu, scale)) in problem.mu.iter().zip(measure.scales()).enumerate() {
        let z = predictor::<D>(mu, rho / scale, &load(&x.u, c), &load(&x.r, c));
        store(&mut x.r, c, &cone::project(mu, &z));
    }
}

/// Largest eigenvalue of `W` scaled by `1 / sqrt(w_c)` on both sides, by power iteration, with a margin.
fn largest_eigenvalue<const D: usize>(problem: &ContactProblem, measure: &ErrorMeasure<'_>) -> f64 {
    let n = problem.q.len();
    let roots = measure.roots();
    let mut x: Vec<f64> = (0..n)
        .map(|i| 1.0 + SPREAD * ((i % PERIOD) as f64 - (PERIOD / 2) as f64) / PERIOD as f64)
        .collect();
    let mut y = vec![0.0; n];
    let mut value = 1.0;
    for _ in 0..POWER_STEPS {
        let size = norm(&x);
        if !(size > 0.0 && size.is_finite()) {
            break;
        }
        for i in 0..n {
            x[i] /= size * roots[i / D];
        }
        problem.w.times(&x, &mut y);
        for i in 0..n {
            x[i] = y[i] / roots[i / D];
        }
        value = norm(&x);
    }
    MARGIN * value
}
