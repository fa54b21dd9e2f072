//! Proximal points with an inner semismooth Newton method: the engine of accuracy.
//!
//! Each outer step solves the problem with `W + alpha diag(w_c)` instead of `W` and `q - alpha w_c r_k` instead of `q`,
//! which has the same solutions at its fixed points, is never rank-deficient and, for large `alpha`, contractive enough
//! for a plain Newton method. `alpha` is what a Newton step can stand: it falls fast while the inner iteration is easy,
//! slowly while it works hard, and rises when it fails.

use crate::error_measure::ErrorMeasure;
use crate::solve::iterate::Iterate;
use crate::solve::newton::NewtonSystem;
use crate::solve::outcome::Work;

/// The regularisation `alpha` \[-\] of a hyperstatic problem after a few sweeps.
pub(crate) const MODERATE: f64 = 1e-3;
/// Below this the rounding of `u`, magnified by `1 / alpha` in the null space of `W`, would flip contacts at random
/// \[-\].
const SMALLEST: f64 = 1e-7;
/// Above this an outer step moves nothing \[-\].
const LARGEST: f64 = 1e4;
/// `alpha` after a first guess that failed \[-\].
const SECOND_GUESS: f64 = 10.0 * MODERATE;
/// Inner residual over outer error that ends the inner iteration \[-\].
const INNER_SHARE: f64 = 0.1;
/// Error over that of the step before: below it a step is a gain though its inner problem is not solved \[-\].
const GAIN: f64 = 0.5;
/// Below it, in so few Newton steps, the outer iteration is superlinear \[-\].
const SUPERLINEAR: f64 = 0.1;
const SUPERLINEAR_STEPS: usize = 2;
/// Newton steps of an inner iteration up to which it was easy, or took some work, and the factor on `alpha` after such
/// a one \[-\]: the easier it was, the closer to the problem itself the next one may come.
const EASY: (usize, f64) = (2, 0.1);
const FAIR: (usize, f64) = (4, 0.3);
/// The factor after an inner iteration that took more steps \[-\].
const HARD_FALL: f64 = 0.7;
/// Inner residual over the last one above which a Newton step counts as a failure, and how many a guess may have \[-\].
const STALLED: f64 = 0.7;
const STALLS: usize = 2;
/// Inner residual that no Newton step comes back from \[-\].
const DIVERGED: f64 = 1e6;

/// How to run the proximal method.
#[derive(Debug, Clone, Copy)]
pub(crate) struct ProximalPlan {
    /// The first regularisation \[-\].
    pub(crate) alpha: f64,
    /// Newton steps of an inner iteration at most.
    pub(crate) inner_steps: usize,
    /// Factor on `alpha` after a failure \[-\].
    pub(crate) rise: f64,
}

/// Improves `best` until it is within `tolerance` or the budget of Newton steps is spent.
pub(crate) fn proximal<const D: usize>(
    measure: &ErrorMeasure<'_>,
    system: &mut NewtonSystem<'_, D>,
    best: &mut Iterate,
    tolerance: f64,
    plan: &ProximalPlan,
    budget: usize,
    work: &mut Work,
) {
    let mut alpha = plan.alpha;
    let mut centre = best.clone();
    let mut spent = 0;
    let mut settled = false;
    while !best.is_within(tolerance) && spent < budget && alpha <= LARGEST {
        let inner = Inner {
            measure,
            centre: &centre,
            alpha,
            tolerance,
            hasty: !settled,
        };
        let (next, steps, solved) = inner.run(system, plan.inner_steps.min(budget - spent));
        spent += steps.max(1);
        let gain = next.errors.scale_free / centre.errors.scale_free;
        best.keep_better(&next);
        if solved || gain < GAIN {
            // Already superlinear: a smaller alpha could only cost precision.
            if gain > SUPERLINEAR || steps > SUPERLINEAR_STEPS {
                alpha = (alpha * fall(steps)).max(SMALLEST.min(plan.alpha));
            }
            centre = next;
        } else if settled || alpha >= MODERATE {
            alpha *= plan.rise;
        } else {
            alpha = SECOND_GUESS;
        }
        settled = true;
    }
    work.newton_steps += spent;
}

/// Factor on `alpha` after an inner iteration of so many steps.
fn fall(steps: usize) -> f64 {
    let known = [EASY, FAIR].into_iter().find(|(most, _)| steps <= *most);
    known.map_or(HARD_FALL, |(_, factor)| factor)
}

/// One proximal subproblem.
struct Inner<'a> {
    measure: &'a ErrorMeasure<'a>,
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
        let scales = self.measure.scales();
        let mut x = self.centre.clone();
        let mut v = x.u.clone();
        let mut dr = vec![0.0; v.len()];
        let target = (INNER_SHARE * x.errors.scale_free).max(INNER_SHARE * self.tolerance);
        let (mut last, mut rises) = (x.errors.scale_free, 0);
        for step in 1..=steps {
            system.classify(&x.r, &v, self.alpha);
            if !system.step(&x.r, &v, self.alpha, &mut dr) {
                return (self.centre.clone(), step, false);
            }
            for (r, dr) in x.r.iter_mut().zip(&dr) {
                *r += dr;
            }
            self.measure.velocity(&x.r, &mut x.u);
            for i in 0..v.len() {
                v[i] = x.u[i] + self.alpha * scales[i / D] * (x.r[i] - self.centre.r[i]);
            }
            let residual = self.measure.errors(&x.r, &v).scale_free;
            rises += usize::from(residual > STALLED * last);
            last = residual;
            let solved = residual <= target;
            if solved || step == steps || (self.hasty && rises >= STALLS) || residual > DIVERGED {
                x.errors = self.measure.errors(&x.r, &x.u);
                return (x, step, solved);
            }
        }
        (x, 0, false)
    }
}
