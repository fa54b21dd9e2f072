//! The predictor-corrector of the bi-potential papers on all contacts at once.

use crate::cone;
use crate::local::{load, store};
use crate::problem::ContactProblem;
use crate::solve::iterate::{Iterate, Work};
use crate::solve::mixing::Mixer;
use crate::truth::Truth;

/// `r <- Proj(r - rho_c (u + mu |u_t| n))` for every contact together, `rho_c = rho / w_c`.
///
/// It needs nothing but products with `W`. `rho` starts at one over the largest eigenvalue of the scaled `W` and is halved
/// where the error explodes. Linear convergence, slow where `W` is ill-conditioned; `mixed` extrapolates the sequence.
pub(crate) fn uzawa<const D: usize>(
    problem: &ContactProblem,
    truth: &Truth<'_>,
    best: &mut Iterate,
    tolerance: f64,
    budget: usize,
    mixed: bool,
    work: &mut Work,
) {
    let mut rho = 1.0 / largest_eigenvalue::<D>(problem, truth).max(f64::MIN_POSITIVE);
    let mut x = best.clone();
    let mut mixer = Mixer::new(truth);
    for _ in 0..budget {
        if best.is_within(tolerance) {
            return;
        }
        work.projections += 1;
        let before = x.clone();
        correct::<D>(problem, truth, rho, &mut x);
        x.refresh(truth);
        let mut improved = best.keep_better(&x);
        if x.errors.scale_free > 100.0 * best.errors.scale_free {
            rho *= 0.5;
            x = best.clone();
            mixer.forget();
            continue;
        }
        if !mixed {
            continue;
        }
        let plain = x.errors.scale_free;
        if let Some(r) = mixer.mix(&before.r, &x.r) {
            let swept = std::mem::replace(&mut x.r, r);
            x.refresh(truth);
            improved |= best.keep_better(&x);
            if x.errors.scale_free > 2.0 * plain {
                x.r = swept;
                x.refresh(truth);
                mixer.forget();
            }
        }
        mixer.note(improved);
    }
}

fn correct<const D: usize>(problem: &ContactProblem, truth: &Truth<'_>, rho: f64, x: &mut Iterate) {
    for (c, (&mu, scale)) in problem.mu.iter().zip(truth.scales()).enumerate() {
        let (mut z, v) = (
            load::<D>(&x.r, c),
            cone::modified_velocity(mu, &load::<D>(&x.u, c)),
        );
        for i in 0..D {
            z[i] -= rho / scale * v[i];
        }
        store(&mut x.r, c, &cone::project(mu, &z));
    }
}

/// Largest eigenvalue of `W` scaled by `1 / sqrt(w_c)` on both sides, by power iteration, with a margin.
fn largest_eigenvalue<const D: usize>(problem: &ContactProblem, truth: &Truth<'_>) -> f64 {
    let n = problem.q.len();
    let roots: Vec<f64> = truth.scales().iter().map(|w| w.sqrt()).collect();
    let mut x: Vec<f64> = (0..n)
        .map(|i| 1.0 + 0.5 * ((i % 7) as f64 - 3.0) / 7.0)
        .collect();
    let mut y = vec![0.0; n];
    let mut value = 1.0;
    for _ in 0..20 {
        let norm = x.iter().map(|a| a * a).sum::<f64>().sqrt();
        if !(norm > 0.0 && norm.is_finite()) {
            break;
        }
        for i in 0..n {
            x[i] /= norm * roots[i / D];
        }
        problem.w.times(&x, &mut y);
        for i in 0..n {
            x[i] = y[i] / roots[i / D];
        }
        value = x.iter().map(|a| a * a).sum::<f64>().sqrt();
    }
    1.1 * value
}
