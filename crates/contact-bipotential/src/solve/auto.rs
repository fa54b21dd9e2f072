//! The method that chooses and falls back.

use crate::delassus::Delassus;
use crate::problem::ContactProblem;
use crate::solve::gauss_seidel::{Kernel, Sweeper};
use crate::solve::iterate::{Iterate, Work};
use crate::solve::newton::{NewtonSystem, newton};
use crate::solve::proximal::{MODERATE, ProximalPlan, proximal};
use crate::solve::uzawa::uzawa;
use crate::solve::{Method, SolveSettings};
use crate::truth::Truth;

/// An operator of at most this size is assembled for [`Method::Auto`]; beyond, only products with it are used.
pub(crate) const LARGEST_ASSEMBLED: usize = 6000;
/// A start with reactions and a smaller error is warm: no sweeps before Newton.
const WARM: f64 = 0.1;
/// Newton steps that a dense problem, likely of full rank, gets before it counts as hyperstatic.
const PATIENCE: usize = 15;

/// A few sweeps to find out who touches, then proximal Newton; where that is spent, more sweeps and a more careful Newton.
pub(crate) fn auto<const D: usize>(
    problem: &ContactProblem,
    truth: &Truth<'_>,
    best: &mut Iterate,
    settings: &SolveSettings,
    work: &mut Work,
) -> Method {
    let tolerance = settings.tolerance;
    if best.is_within(tolerance) {
        return Method::GaussSeidel;
    }
    let dense = match &problem.w {
        Delassus::Operator(_) => {
            uzawa::<D>(
                problem,
                truth,
                best,
                tolerance,
                settings.max_iterations,
                true,
                work,
            );
            return Method::UzawaAnderson;
        }
        Delassus::Dense(_) => true,
        Delassus::BlockSparse(_) => false,
    };
    let sweeper = Sweeper::<D>::new(problem, Kernel::Exact);
    if best.errors.scale_free > WARM || best.r.iter().all(|x| *x == 0.0) {
        look_around(
            truth,
            &sweeper,
            best,
            tolerance,
            if dense { 6 } else { 20 },
            work,
        );
    }
    let mut system = NewtonSystem::<D>::new(problem, truth.scales());
    if dense {
        newton(truth, &mut system, best, tolerance, PATIENCE, work);
    }
    let steps = settings.max_iterations / 10;
    let plans = [
        ProximalPlan {
            alpha: MODERATE,
            budget: steps / 2,
            ..ProximalPlan::default()
        },
        ProximalPlan {
            alpha: 1e-2,
            inner_steps: 10,
            budget: steps / 4,
            rise: 3.0,
        },
        ProximalPlan {
            alpha: 1.0,
            inner_steps: 20,
            budget: steps / 4,
            rise: 2.0,
        },
    ];
    let sweeps = settings.max_iterations / plans.len();
    for (k, plan) in plans.iter().enumerate() {
        if best.is_within(tolerance) {
            break;
        }
        if k > 0 {
            sweeper.run(truth, best, tolerance, (500 * k).min(sweeps), work);
        }
        proximal(truth, &mut system, best, tolerance, plan, work);
    }
    if work.newton_steps > 0 {
        Method::Proximal
    } else {
        Method::GaussSeidel
    }
}

/// At least `few` sweeps, and more while each pair gains a factor of five: then sweeping is all it takes.
fn look_around<const D: usize>(
    truth: &Truth<'_>,
    sweeper: &Sweeper<'_, D>,
    best: &mut Iterate,
    tolerance: f64,
    few: usize,
    work: &mut Work,
) {
    let mut x = best.clone();
    let mut done = 0;
    while done < 200 && !best.is_within(tolerance) {
        let last = x.errors.scale_free;
        sweeper.there_and_back(&mut x);
        x.refresh(truth);
        done += 2;
        best.keep_better(&x);
        if done >= few && x.errors.scale_free > 0.2 * last {
            break;
        }
    }
    work.sweeps += done;
}
