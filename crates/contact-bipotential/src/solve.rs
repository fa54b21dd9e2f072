//! Solving a contact problem.

mod acceleration;
mod auto;
mod block_lu;
mod bonded;
mod bonded_contact;
mod contact_mode;
mod dense_lu;
mod gauss_seidel;
mod gmres;
mod iterate;
mod lagged_newton;
mod local_newton;
mod newton;
mod outcome;
mod proximal;
mod sequence;
mod single;
mod uzawa;

pub use bonded::{freeze_bonds, solve_bonded};
pub use outcome::{Method, Outcome, SolveSettings, SolveStatus, Work};
pub use sequence::SequenceSolver;
pub use single::{SingleContact, SingleSolution, solve_single};

use crate::cone::Cone;
use crate::delassus::Delassus;
use crate::error_measure::{ErrorMeasure, Errors};
use crate::problem::ContactProblem;

use gauss_seidel::{Kernel, Sweeper};
use iterate::Iterate;
use newton::NewtonSystem;
use proximal::ProximalPlan;

/// An operator of at most this size is assembled where a method needs entries: a dense `W` of 288 MB. Beyond,
/// [`Method::Auto`] uses only products with it.
const LARGEST_ASSEMBLED: usize = 6000;
/// Newton steps of [`Method::Newton`] at most: one that circles does not come out of it.
const MOST_NEWTON_STEPS: usize = 200;
/// The proximal method from any start: a step that each Newton step can stand.
const CAREFUL: ProximalPlan = ProximalPlan {
    alpha: 1.0,
    inner_steps: 6,
    rise: 4.0,
};

/// Solves `problem`. `r` is the start (anything of another length, or not finite, counts as zero) and the answer.
///
/// Never claims success unless the errors recomputed from `r` are within the tolerance; never returns NaN or infinity.
/// Data that fail [`ContactProblem::check`] come back as not converged, with the reason and `r = 0`.
///
/// ```
/// use contact_bipotential::{Cone, ContactProblem, Delassus, SolveSettings, solve};
///
/// # fn main() -> Result<(), contact_bipotential::ContactError> {
/// // One contact in the plane, (t, n): pressed by 1, dragged along by 10, compliances 2 and 1.
/// let w = Delassus::from_entries(1, 2, &[(0, 0, 2.0), (1, 1, 1.0)])?;
/// let problem = ContactProblem::new(w, vec![10.0, -1.0], vec![0.3], Cone::Planar)?;
/// let mut r = Vec::new();
/// let outcome = solve(&problem, &mut r, &SolveSettings::default());
/// assert!(outcome.is_converged());
/// // It slides: the friction force is at its limit, against the velocity.
/// assert!((r[1] - 1.0).abs() < 1e-9 && (r[0] + 0.3).abs() < 1e-9);
/// assert!((outcome.u[0] - 9.4).abs() < 1e-9);
/// # Ok(())
/// # }
/// ```
pub fn solve(problem: &ContactProblem, r: &mut Vec<f64>, settings: &SolveSettings) -> Outcome {
    let size = problem.q.len();
    start_or_zero(r, size);
    if let Err(refusal) = problem.check() {
        r.fill(0.0);
        return Outcome::refused(size, settings.method, refusal);
    }
    match problem.cone {
        Cone::Frictionless => run::<1>(problem, r, settings),
        Cone::Planar => run::<2>(problem, r, settings),
        Cone::Spatial => run::<3>(problem, r, settings),
    }
}

/// A start that is none becomes zero.
fn start_or_zero(r: &mut Vec<f64>, size: usize) {
    if r.len() != size || !r.iter().all(|x| x.is_finite()) {
        r.clear();
        r.resize(size, 0.0);
    }
}

fn run<const D: usize>(
    problem: &ContactProblem,
    r: &mut [f64],
    settings: &SolveSettings,
) -> Outcome {
    let assembled;
    let problem = match &problem.w {
        Delassus::Operator(w)
            if needs_entries(settings.method) && w.size() <= LARGEST_ASSEMBLED =>
        {
            assembled = ContactProblem {
                w: Delassus::Dense(problem.w.to_dense()),
                ..problem.clone()
            };
            &assembled
        }
        _ => problem,
    };
    let measure = ErrorMeasure::new(problem);
    let mut best = Iterate::new(&measure, r);
    if best.errors == Errors::WORST {
        // A start so large that W r overflows is no start.
        best = Iterate::new(&measure, &vec![0.0; r.len()]);
    }
    let mut work = Work::default();
    let method = apply::<D>(problem, &measure, &mut best, settings, &mut work);
    Outcome::of_best(&measure, best, r, settings.tolerance, method, work)
}

fn needs_entries(method: Method) -> bool {
    !matches!(method, Method::Uzawa | Method::UzawaAnderson)
}

fn apply<const D: usize>(
    problem: &ContactProblem,
    measure: &ErrorMeasure<'_>,
    best: &mut Iterate,
    settings: &SolveSettings,
    work: &mut Work,
) -> Method {
    let (method, tolerance) = (settings.method, settings.tolerance);
    let budget = settings.max_iterations;
    let sweeper = |kernel| Sweeper::<D>::new(problem, kernel);
    let system = || NewtonSystem::<D>::new(problem, measure.scales());
    match method {
        Method::Auto => return auto::auto::<D>(problem, measure, best, settings, work),
        Method::Proximal => {
            let mut system = system();
            proximal::proximal(
                measure,
                &mut system,
                best,
                tolerance,
                &CAREFUL,
                budget,
                work,
            );
        }
        Method::Newton => {
            let steps = budget.min(MOST_NEWTON_STEPS);
            newton::newton(measure, &mut system(), best, tolerance, steps, work);
        }
        Method::GaussSeidel => {
            sweeper(Kernel::Exact).run(measure, best, tolerance, budget, work);
        }
        Method::GaussSeidelAnderson => {
            sweeper(Kernel::Exact).run_accelerated(measure, best, tolerance, budget, work);
        }
        Method::GaussSeidelBipotential => {
            sweeper(Kernel::PredictCorrect).run(measure, best, tolerance, budget, work);
        }
        Method::JoliFeng => sweeper(Kernel::JoliFeng).run(measure, best, tolerance, budget, work),
        Method::Uzawa | Method::UzawaAnderson => {
            let accelerated = method == Method::UzawaAnderson;
            uzawa::uzawa::<D>(problem, measure, best, tolerance, budget, accelerated, work);
        }
    }
    method
}

#[cfg(test)]
mod tests;
