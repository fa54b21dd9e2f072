//! What to solve with, how well, and what came out.

use crate::error::ContactError;
use crate::error_measure::{ErrorMeasure, Errors};
use crate::law::ContactDiagnostic;
use crate::solve::iterate::Iterate;

/// The algorithms.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
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
    #[must_use]
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
#[non_exhaustive]
pub struct SolveSettings {
    /// The algorithm.
    pub method: Method,
    /// All errors ([`Errors::worst`]) must be at or below this \[-\]. Below about 1e-13 rounding decides.
    pub tolerance: f64,
    /// Largest number of iterations of the method: sweeps, Newton steps or projections. [`Method::Auto`] takes it for
    /// its sweeps and a tenth of it for its Newton steps.
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

impl SolveSettings {
    /// The same with another algorithm.
    #[must_use]
    pub const fn with_method(mut self, method: Method) -> Self {
        self.method = method;
        self
    }

    /// The same with another tolerance of the errors \[-\].
    #[must_use]
    pub const fn with_tolerance(mut self, tolerance: f64) -> Self {
        self.tolerance = tolerance;
        self
    }

    /// The same with another largest number of iterations.
    #[must_use]
    pub const fn with_max_iterations(mut self, max_iterations: usize) -> Self {
        self.max_iterations = max_iterations;
        self
    }
}

/// Whether the problem is solved.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SolveStatus {
    /// All errors, recomputed from `r`, are within the tolerance.
    Converged,
    /// They are not; `r` is the best point met.
    NotConverged,
}

/// What the methods did together.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct Work {
    /// Passes over all contacts.
    pub sweeps: usize,
    /// Newton steps, one factorisation each.
    pub newton_steps: usize,
    /// Steps of the global predictor-corrector.
    pub projections: usize,
}

impl Work {
    pub(crate) fn add(&mut self, other: &Work) {
        self.sweeps += other.sweeps;
        self.newton_steps += other.newton_steps;
        self.projections += other.projections;
    }
}

/// What came out.
#[derive(Debug, Clone)]
#[non_exhaustive]
#[must_use]
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
    /// All errors of `r`: success is claimed by [`Errors::worst`].
    pub errors: Errors,
    /// `u = W r + q`.
    pub u: Vec<f64>,
    /// Per contact, only when not converged.
    pub diagnostics: Vec<ContactDiagnostic>,
    /// Why the data were refused, if they were.
    pub refusal: Option<ContactError>,
}

impl Outcome {
    /// Whether the problem is solved.
    #[must_use]
    pub fn is_converged(&self) -> bool {
        self.status == SolveStatus::Converged
    }

    /// Nothing was solved: the data of `size` unknowns cannot be used.
    pub(crate) fn refused(size: usize, method: Method, refusal: ContactError) -> Outcome {
        Outcome {
            status: SolveStatus::NotConverged,
            method,
            iterations: 0,
            work: Work::default(),
            error: f64::MAX,
            error_scale_free: f64::MAX,
            errors: Errors::WORST,
            u: vec![0.0; size],
            diagnostics: Vec::new(),
            refusal: Some(refusal),
        }
    }

    /// The best point met goes to `r`, and its errors are recomputed from there.
    pub(crate) fn of_best(
        measure: &ErrorMeasure<'_>,
        best: Iterate,
        r: &mut [f64],
        tolerance: f64,
        method: Method,
        work: Work,
    ) -> Outcome {
        r.copy_from_slice(&best.r);
        let mut u = best.u;
        let errors = measure.certify(r, &mut u, tolerance);
        let converged = errors.worst() <= tolerance;
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
            error: errors.siconos,
            error_scale_free: errors.scale_free,
            errors,
            diagnostics: if converged {
                Vec::new()
            } else {
                measure.diagnose(r, &u)
            },
            u,
            refusal: None,
        }
    }
}
