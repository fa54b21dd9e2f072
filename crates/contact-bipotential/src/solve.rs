//! Solving a contact problem.

mod auto;
mod block_lu;
mod bonded;
mod gauss_seidel;
mod iterate;
mod local_newton;
mod mixing;
mod newton;
mod proximal;
pub mod sequence;
pub mod single;
mod uzawa;

pub use bonded::{frozen, solve_bonded};
pub use iterate::Work;

use crate::cone::Cone;
use crate::delassus::Delassus;
use crate::error::ContactError;
use crate::law::ContactDiagnostic;
use crate::problem::ContactProblem;
use crate::truth::{Errors, Truth};

use gauss_seidel::{Kernel, Sweeper};
use iterate::Iterate;
use newton::NewtonSystem;
use proximal::ProximalPlan;

/// The algorithms.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Method {
    /// Chooses and falls back. The default.
    Auto,
    /// Proximal points with an inner semismooth Newton method.
    Proximal,
    /// Semismooth Newton on the equation of Alart and Curnier, with backtracking.
    Newton,
    /// Symmetric sweeps over the contacts with the exact solution of each.
    GaussSeidel,
    /// The same, extrapolated by Anderson's method.
    GaussSeidelAnderson,
    /// Symmetric sweeps with a few predictor-corrector steps of the bi-potential method for each contact.
    GaussSeidelBipotential,
    /// Symmetric sweeps with the local Newton method of Joli and Feng.
    JoliFeng,
    /// Predictor and corrector of the bi-potential method on all contacts at once. Needs only products with `W`.
    Uzawa,
    /// The same, extrapolated by Anderson's method.
    UzawaAnderson,
}

impl Method {
    /// All methods.
    pub const ALL: [Method; 9] = [
        Method::Auto,
        Method::Proximal,
        Method::Newton,
        Method::GaussSeidel,
        Method::GaussSeidelAnderson,
        Method::GaussSeidelBipotential,
        Method::JoliFeng,
        Method::Uzawa,
        Method::UzawaAnderson,
    ];

    /// A name for tables and options.
    pub fn name(self) -> &'static str {
        match self {
            Method::Auto => "auto",
            Method::Proximal => "proximal",
            Method::Newton => "newton",
            Method::GaussSeidel => "gauss-seidel",
            Method::GaussSeidelAnderson => "gauss-seidel-anderson",
            Method::GaussSeidelBipotential => "gauss-seidel-bipotential",
            Method::JoliFeng => "joli-feng",
            Method::Uzawa => "uzawa",
            Method::UzawaAnderson => "uzawa-anderson",
        }
    }
}

/// What to solve with and how well.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SolveSettings {
    /// The algorithm.
    pub method: Method,
    /// Both errors ([`Errors::siconos`] and [`Errors::scale_free`]) must be at or below this [-]. Below about 1e-13 rounding
    /// decides.
    pub tolerance: f64,
    /// Largest number of iterations of the method: sweeps, Newton steps or projections. [`Method::Auto`] takes it for its
    /// sweeps and a tenth of it for its Newton steps.
    pub max_iterations: usize,
}

impl Default for SolveSettings {
    fn default() -> Self {
        SolveSettings {
            method: Method::Auto,
            tolerance: 1e-10,
            max_iterations: 20_000,
        }
    }
}

/// Whether the problem is solved.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SolveStatus {
    /// Both errors, recomputed from `r`, are within the tolerance.
    Converged,
    /// They are not; `r` is the best point met.
    NotConverged,
}

/// What came out.
#[derive(Debug, Clone)]
pub struct Outcome {
    /// Whether the problem is solved.
    pub status: SolveStatus,
    /// The method that found `r`; for [`Method::Auto`] the last one it used.
    pub method: Method,
    /// Iterations of all methods that ran.
    pub iterations: usize,
    /// The same, by kind.
    pub work: Work,
    /// [`Errors::siconos`] of `r`.
    pub error: f64,
    /// [`Errors::scale_free`] of `r`.
    pub error_scale_free: f64,
    /// `u = W r + q`.
    pub u: Vec<f64>,
    /// Per contact, only when not converged.
    pub diagnostics: Vec<ContactDiagnostic>,
    /// Why the data were refused, if they were.
    pub refusal: Option<ContactError>,
}

impl Outcome {
    /// Whether the problem is solved.
    pub fn is_converged(&self) -> bool {
        self.status == SolveStatus::Converged
    }
}

/// Solves `problem`. `r` is the start (anything of another length, or not finite, counts as zero) and the answer.
///
/// Never claims success unless the errors recomputed from `r` are within the tolerance; never returns NaN or infinity.
/// Data that fail [`ContactProblem::check`] come back as not converged, with the reason and `r = 0`.
pub fn solve(problem: &ContactProblem, r: &mut Vec<f64>, settings: &SolveSettings) -> Outcome {
    let size = problem.q.len();
    if r.len() != size || !r.iter().all(|x| x.is_finite()) {
        r.clear();
        r.resize(size, 0.0);
    }
    if let Err(refusal) = problem.check() {
        r.fill(0.0);
        return refused(size, settings, refusal);
    }
    match problem.cone {
        Cone::Frictionless => run::<1>(problem, r, settings),
        Cone::Planar => run::<2>(problem, r, settings),
        Cone::Spatial => run::<3>(problem, r, settings),
    }
}

fn refused(size: usize, settings: &SolveSettings, refusal: ContactError) -> Outcome {
    Outcome {
        status: SolveStatus::NotConverged,
        method: settings.method,
        iterations: 0,
        work: Work::default(),
        error: f64::MAX,
        error_scale_free: f64::MAX,
        u: vec![0.0; size],
        diagnostics: Vec::new(),
        refusal: Some(refusal),
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
            if needs_entries(settings.method) && w.size() <= auto::LARGEST_ASSEMBLED =>
        {
            assembled = ContactProblem {
                w: Delassus::Dense(problem.w.to_dense()),
                ..problem.clone()
            };
            &assembled
        }
        _ => problem,
    };
    let truth = Truth::new(problem);
    let mut best = Iterate::new(&truth, r);
    if best.errors == Errors::WORST {
        // A start so large that W r overflows is no start.
        best = Iterate::new(&truth, &vec![0.0; r.len()]);
    }
    let mut work = Work::default();
    let method = apply::<D>(problem, &truth, &mut best, settings, &mut work);
    finish(&truth, r, best, settings, method, work)
}

fn needs_entries(method: Method) -> bool {
    !matches!(method, Method::Uzawa | Method::UzawaAnderson)
}

fn apply<const D: usize>(
    problem: &ContactProblem,
    truth: &Truth<'_>,
    best: &mut Iterate,
    settings: &SolveSettings,
    work: &mut Work,
) -> Method {
    let (tolerance, budget) = (settings.tolerance, settings.max_iterations);
    let sweeper = |kernel| Sweeper::<D>::new(problem, kernel);
    match settings.method {
        Method::Auto => return auto::auto::<D>(problem, truth, best, settings, work),
        Method::Proximal => {
            let plan = ProximalPlan {
                budget,
                alpha: 1.0,
                ..ProximalPlan::default()
            };
            let mut system = NewtonSystem::<D>::new(problem, truth.scales());
            proximal::proximal(truth, &mut system, best, tolerance, &plan, work);
        }
        Method::Newton => {
            let mut system = NewtonSystem::<D>::new(problem, truth.scales());
            newton::newton(truth, &mut system, best, tolerance, budget.min(200), work);
        }
        Method::GaussSeidel => sweeper(Kernel::Exact).run(truth, best, tolerance, budget, work),
        Method::GaussSeidelAnderson => {
            sweeper(Kernel::Exact).run_mixed(truth, best, tolerance, budget, work)
        }
        Method::GaussSeidelBipotential => {
            sweeper(Kernel::PredictCorrect).run(truth, best, tolerance, budget, work)
        }
        Method::JoliFeng => sweeper(Kernel::JoliFeng).run(truth, best, tolerance, budget, work),
        Method::Uzawa => uzawa::uzawa::<D>(problem, truth, best, tolerance, budget, false, work),
        Method::UzawaAnderson => {
            uzawa::uzawa::<D>(problem, truth, best, tolerance, budget, true, work)
        }
    }
    settings.method
}

fn finish(
    truth: &Truth<'_>,
    r: &mut [f64],
    best: Iterate,
    settings: &SolveSettings,
    method: Method,
    work: Work,
) -> Outcome {
    r.copy_from_slice(&best.r);
    let mut u = best.u;
    let Errors {
        siconos,
        scale_free,
        ..
    } = truth.evaluate(r, &mut u);
    let converged = siconos <= settings.tolerance && scale_free <= settings.tolerance;
    if !u.iter().all(|x| x.is_finite()) {
        u.fill(0.0);
    }
    Outcome {
        status: if converged {
            SolveStatus::Converged
        } else {
            SolveStatus::NotConverged
        },
        method,
        iterations: work.sweeps + work.newton_steps + work.projections,
        work,
        error: siconos,
        error_scale_free: scale_free,
        diagnostics: if converged {
            Vec::new()
        } else {
            truth.diagnose(r, &u)
        },
        u,
        refusal: None,
    }
}

#[cfg(test)]
mod tests;
