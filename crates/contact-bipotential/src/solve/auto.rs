//! The method that chooses and falls back.

use crate::cone;
use crate::delassus::Delassus;
use crate::error_measure::ErrorMeasure;
use crate::local::{Vector, store};
use crate::problem::ContactProblem;
use crate::solve::gauss_seidel::{Kernel, Sweeper};
use crate::solve::iterate::Iterate;
use crate::solve::newton::{NewtonSystem, newton};
use crate::solve::outcome::{Method, SolveSettings, Work};
use crate::solve::proximal::{MODERATE, ProximalPlan, proximal};
use crate::solve::uzawa::uzawa;

/// A start with reactions and a smaller error \[-\] is warm: no sweeps before Newton.
const WARM: f64 = 0.1;
/// Sweeps of a cold start at most, and the error over that of the sweeps before \[-\] up to which more of them pay:
/// where each symmetric sweep gains a factor of five, sweeping is all it takes.
const MOST: usize = 200;
const PAYS: f64 = 0.2;
/// Part of the budget that each later attempt with sweeps may take at most: one over this.
const SWEEPS_PART: usize = 3;
/// Newton steps for one iteration of [`SolveSettings::max_iterations`]: a step costs some ten sweeps.
const NEWTON_PART: usize = 10;

/// Rows up to which other starts are tried in the end, with a part of the Newton steps of the budget: one over this.
const RESTART_ROWS: usize = 150;
const RESTART_PART: usize = 2;
/// Sizes of the reactions of the other starts over what `q` asks for \[-\]: of the solutions the small ones are wanted.
const RESTART_SIZES: [f64; 8] = [0.1, 1.0, 0.01, 1.0, 3.0, 1.0, 10.0, 1.0];
/// Steps of Newton's method and of the proximal one from each.
const RESTART_NEWTON: usize = 20;
const RESTART_STEPS: usize = 120;
const RESTART_PLAN: ProximalPlan = plan(1.0, 6, 4.0);
/// Fractions of their multiples fill a cube evenly: powers of the inverse of the real root of `x^4 = x + 1`.
const SPREAD: [f64; 3] = [
    0.819_172_513_396_164_4,
    0.671_043_606_703_789_2,
    0.549_700_477_901_970_3,
];

/// One attempt: what is tried, when, with how much of the budget.
struct Attempt {
    what: What,
    when: When,
}

enum What {
    /// So many sweeps to find out who touches, and more while they pay.
    FirstSweeps(usize),
    /// Semismooth Newton on the problem itself, so many steps.
    Newton(usize),
    /// So many sweeps, at most the budget over [`SWEEPS_PART`].
    Sweeps(usize),
    /// Proximal Newton, with the Newton steps of the budget over this number.
    Proximal(ProximalPlan, usize),
}

/// On which problems.
#[derive(PartialEq)]
enum When {
    Always,
    /// `W` is dense, likely of full rank: elastic bodies.
    Dense,
    /// The start is cold and `W` dense.
    ColdDense,
    /// The start is cold and `W` block-sparse, likely hyperstatic: rigid bodies.
    ColdSparse,
}

/// The attempts in their order, each from the best point of those before, until the errors are within the tolerance.
/// The numbers are those that solved the FCLib collection and the walls and half-spaces of the benches in the least
/// time.
const ATTEMPTS: [Attempt; 8] = [
    Attempt {
        what: What::FirstSweeps(6),
        when: When::ColdDense,
    },
    Attempt {
        what: What::FirstSweeps(20),
        when: When::ColdSparse,
    },
    // A dense problem that takes longer counts as hyperstatic.
    Attempt {
        what: What::Newton(15),
        when: When::Dense,
    },
    Attempt {
        what: What::Proximal(plan(MODERATE, 6, 4.0), 2),
        when: When::Always,
    },
    Attempt {
        what: What::Sweeps(500),
        when: When::Always,
    },
    Attempt {
        what: What::Proximal(plan(1e-2, 10, 3.0), 4),
        when: When::Always,
    },
    Attempt {
        what: What::Sweeps(1000),
        when: When::Always,
    },
    Attempt {
        what: What::Proximal(plan(1.0, 20, 2.0), 4),
        when: When::Always,
    },
];

const fn plan(alpha: f64, inner_steps: usize, rise: f64) -> ProximalPlan {
    ProximalPlan {
        alpha,
        inner_steps,
        rise,
    }
}

impl When {
    fn holds(&self, dense: bool, cold: bool) -> bool {
        match self {
            When::Always => true,
            When::Dense => dense,
            When::ColdDense => dense && cold,
            When::ColdSparse => !dense && cold,
        }
    }
}

/// A few sweeps to find out who touches, then Newton; where that is spent, more sweeps and a more careful Newton.
pub(crate) fn auto<const D: usize>(
    problem: &ContactProblem,
    measure: &ErrorMeasure<'_>,
    best: &mut Iterate,
    settings: &SolveSettings,
    work: &mut Work,
) -> Method {
    let (tolerance, budget) = (settings.tolerance, settings.max_iterations);
    if best.is_within(tolerance) {
        return Method::GaussSeidel;
    }
    if let Delassus::Operator(_) = problem.w {
        uzawa::<D>(problem, measure, best, tolerance, budget, true, work);
        return Method::UzawaAnderson;
    }
    attempts::<D>(problem, measure, best, settings, work);
    if work.newton_steps > 0 {
        Method::Proximal
    } else {
        Method::GaussSeidel
    }
}

/// Everything that needs entries of `W`, until the errors are within the tolerance.
fn attempts<const D: usize>(
    problem: &ContactProblem,
    measure: &ErrorMeasure<'_>,
    best: &mut Iterate,
    settings: &SolveSettings,
    work: &mut Work,
) {
    let (tolerance, budget) = (settings.tolerance, settings.max_iterations);
    let dense = matches!(problem.w, Delassus::Dense(_));
    let cold = best.errors.scale_free > WARM || best.r.iter().all(|x| *x == 0.0);
    let sweeper = Sweeper::<D>::new(problem, Kernel::Exact);
    let prepare = || NewtonSystem::<D>::new(problem, measure.scales());
    let mut system = None;
    for attempt in ATTEMPTS.iter().filter(|a| a.when.holds(dense, cold)) {
        if best.is_within(tolerance) {
            break;
        }
        match &attempt.what {
            What::FirstSweeps(few) => {
                first_sweeps(measure, &sweeper, best, tolerance, *few, work);
            }
            What::Newton(steps) => newton(
                measure,
                system.get_or_insert_with(prepare),
                best,
                tolerance,
                *steps,
                work,
            ),
            What::Sweeps(sweeps) => {
                let sweeps = (*sweeps).min(budget / SWEEPS_PART);
                sweeper.run(measure, best, tolerance, sweeps, work);
            }
            What::Proximal(plan, part) => {
                let steps = budget / NEWTON_PART / part;
                proximal::<D>(
                    measure,
                    system.get_or_insert_with(prepare),
                    best,
                    tolerance,
                    plan,
                    steps,
                    work,
                );
            }
        }
    }
    if !best.is_within(tolerance) && problem.q.len() <= RESTART_ROWS {
        let system = system.get_or_insert_with(prepare);
        restarts(problem, measure, system, best, settings, work);
    }
}

/// Tries again from other points: the errors of a hyperstatic problem have local minima, which no patience leaves.
fn restarts<const D: usize>(
    problem: &ContactProblem,
    measure: &ErrorMeasure<'_>,
    system: &mut NewtonSystem<'_, D>,
    best: &mut Iterate,
    settings: &SolveSettings,
    work: &mut Work,
) {
    let tolerance = settings.tolerance;
    let most = work.newton_steps + settings.max_iterations / NEWTON_PART / RESTART_PART;
    for (k, size) in RESTART_SIZES.iter().enumerate() {
        if best.is_within(tolerance) || work.newton_steps >= most {
            return;
        }
        let mut x = Iterate::new(measure, &restart::<D>(problem, measure, k, *size));
        newton(measure, system, &mut x, tolerance, RESTART_NEWTON, work);
        let plan = &RESTART_PLAN;
        proximal::<D>(
            measure,
            system,
            &mut x,
            tolerance,
            plan,
            RESTART_STEPS,
            work,
        );
        best.keep_better(&x);
    }
}

/// Start number `k`: reactions in the cone, of `size` \[-\] over the largest `q` in the energy norm, spread evenly over
/// directions by multiples of irrational numbers, so that every run draws the same.
fn restart<const D: usize>(
    problem: &ContactProblem,
    measure: &ErrorMeasure<'_>,
    k: usize,
    size: f64,
) -> Vec<f64> {
    let roots = measure.roots();
    let speed = |(i, q): (usize, &f64)| q.abs() / roots[i / D];
    let largest = problem.q.iter().enumerate().map(speed).fold(0.0, f64::max);
    let mut r = vec![0.0; problem.q.len()];
    for c in 0..roots.len() {
        let mut z = Vector::<D>::zeros();
        for i in 0..D {
            let draw = ((k * roots.len() + c + 1) as f64 * SPREAD[i]).fract();
            z[i] = if i == D - 1 { draw } else { 2.0 * draw - 1.0 };
        }
        let reaction = cone::project(problem.mu[c], &z) * (size * largest / roots[c]);
        store(&mut r, c, &reaction);
    }
    r
}

/// At least `few` sweeps, and more while they pay.
fn first_sweeps<const D: usize>(
    measure: &ErrorMeasure<'_>,
    sweeper: &Sweeper<'_, D>,
    best: &mut Iterate,
    tolerance: f64,
    few: usize,
    work: &mut Work,
) {
    let mut x = best.clone();
    let mut done = 0;
    while done < MOST && !best.is_within(tolerance) {
        let last = x.errors.scale_free;
        sweeper.symmetric_sweep(&mut x);
        x.refresh(measure);
        done += 2;
        best.keep_better(&x);
        if done >= few && x.errors.scale_free > PAYS * last {
            break;
        }
    }
    work.sweeps += done;
}
