//! Proximal points with an inner semismooth Newton method: the engine of accuracy.
//!
//! Each outer step solves the problem with `W + alpha diag(w_c)` instead of `W` and `q - alpha w_c r_k` instead of `q`, which
//! has the same solutions at its fixed points, is never rank-deficient and, for large `alpha`, contractive enough for a
//! plain Newton method. `alpha` is what a Newton step can stand: it falls fast while the inner
//! iteration is easy, slowly while it works hard, and rises when it fails.

use crate::solve::iterate::{Iterate, Work};
use crate::solve::newton::NewtonSystem;
use crate::truth::Truth;

/// The regularisation of a hyperstatic problem after a few sweeps.
pub(crate) const MODERATE: f64 = 1e-3;
/// Below this the rounding of `u`, magnified by `1 / alpha` in the null space of `W`, would flip contacts at random.
const SMALLEST: f64 = 1e-7;
const LARGEST: f64 = 1e4;
/// Inner residual over outer error that ends the inner iteration.
const INNER_SHARE: f64 = 0.1;

/// How to run the proximal method.
#[derive(Debug, Clone, Copy)]
pub(crate) struct ProximalPlan {
    pub(crate) alpha: f64,
    pub(crate) inner_steps: usize,
    pub(crate) budget: usize,
    /// Factor on `alpha` after a failure.
    pub(crate) rise: f64,
}

impl Default for ProximalPlan {
    fn default() -> Self {
        ProximalPlan {
            alpha: MODERATE,
            inner_steps: 6,
            budget: 1000,
            rise: 4.0,
        }
    }
}

/// Improves `best` until it is within `tolerance` or the budget of Newton steps is spent.
pub(crate) fn proximal<const D: usize>(
    truth: &Truth<'_>,
    system: &mut NewtonSystem<'_, D>,
    best: &mut Iterate,
    tolerance: f64,
    plan: &ProximalPlan,
    work: &mut Work,
) {
    let mut alpha = plan.alpha;
    let mut centre = best.clone();
    let mut spent = 0;
    let mut settled = false;
    while !best.is_within(tolerance) && spent < plan.budget && alpha <= LARGEST {
        let inner = Inner {
            truth,
            centre: &centre,
            alpha,
            tolerance,
            hasty: !settled,
        };
        let (next, steps, solved) = inner.run(system, plan.inner_steps.min(plan.budget - spent));
        spent += steps.max(1);
        let gain = next.errors.scale_free / centre.errors.scale_free;
        best.keep_better(&next);
        if solved || gain < 0.5 {
            // Already superlinear: a smaller alpha could only cost precision.
            if gain > 0.1 || steps > 2 {
                alpha = (alpha * fall(steps)).max(SMALLEST.min(plan.alpha));
            }
            centre = next;
        } else if settled || alpha >= MODERATE {
            alpha *= plan.rise;
        } else {
            alpha = 10.0 * MODERATE;
        }
        settled = true;
    }
    work.newton_steps += spent;
}

/// Factor on `alpha` after an inner iteration of so many steps.
fn fall(steps: usize) -> f64 {
    match steps {
        0..=2 => 0.1,
        3..=4 => 0.3,
        _ => 0.7,
    }
}

/// One proximal subproblem.
struct Inner<'a> {
    truth: &'a Truth<'a>,
    centre: &'a Iterate,
    alpha: f64,
    tolerance: f64,
    /// Give up early: the first, small `alpha` was only a guess.
    hasty: bool,
}

impl Inner<'_> {
    /// Full Newton steps. Returns the last point, the steps taken and whether the subproblem counts as solved.
    fn run<const D: usize>(
        &self,
        system: &mut NewtonSystem<'_, D>,
        steps: usize,
    ) -> (Iterate, usize, bool) {
        let scales = self.truth.scales();
        let mut x = self.centre.clone();
        let mut v = x.u.clone();
        let mut dr = vec![0.0; v.len()];
        let target = (INNER_SHARE * x.errors.scale_free).max(0.1 * self.tolerance);
        let (mut last, mut rises) = (x.errors.scale_free, 0);
        for step in 1..=steps {
            system.classify(&x.r, &v, self.alpha);
            if !system.step(&x.r, &v, self.alpha, &mut dr) {
                return (self.centre.clone(), step, false);
            }
            for (r, dr) in x.r.iter_mut().zip(&dr) {
                *r += dr;
            }
            self.truth.velocity(&x.r, &mut x.u);
            for i in 0..v.len() {
                v[i] = x.u[i] + self.alpha * scales[i / D] * (x.r[i] - self.centre.r[i]);
            }
            let residual = self.truth.measure(&x.r, &v).scale_free;
            rises += usize::from(residual > 0.7 * last);
            last = residual;
            let solved = residual <= target;
            if solved || step == steps || (self.hasty && rises >= 2) || residual > 1e6 {
                x.errors = self.truth.measure(&x.r, &x.u);
                return (x, step, solved);
            }
        }
        (x, 0, false)
    }
}
