//! The method that chooses and falls back.

use crate::delassus::Delassus;
use crate::error_measure::ErrorMeasure;
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
    if work.newton_steps > 0 {
        Method::Proximal
    } else {
        Method::GaussSeidel
    }
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
