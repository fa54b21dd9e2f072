//! A sequence of similar dense problems: the factors of an earlier Newton matrix stay in use.
//!
//! A time stepper solves problem after problem whose `W`, modes and slip directions differ little.

use crate::cone::Cone;
use crate::delassus::Delassus;
use crate::error_measure::ErrorMeasure;
use crate::problem::ContactProblem;
use crate::rcc::BondStep;
use crate::solve::bonded::solve_bonded;
use crate::solve::lagged_newton::LaggedNewton;
use crate::solve::outcome::{Method, Outcome, SolveSettings, Work};

/// Problems with fewer rows are not worth the memory: their factorisation is cheap.
const SMALLEST: usize = 90;

/// A solver with a memory: results do not depend on what it remembers beyond the tolerance, times do.
#[derive(Debug, Default)]
pub struct SequenceSolver {
    newton: LaggedNewton,
}

impl SequenceSolver {
    /// As [`solve_bonded`]; [`Method::Auto`] tries Newton's method with the remembered factors first.
    pub fn solve(
        &mut self,
        problem: &ContactProblem,
        bonds: &[BondStep],
        r: &mut Vec<f64>,
        settings: &SolveSettings,
    ) -> Outcome {
        let pays = r.len() >= SMALLEST || !bonds.is_empty();
        let sized = r.len() == problem.q.len() && pays && r.iter().all(|x| x.is_finite());
        let Delassus::Dense(w) = &problem.w else {
            return solve_bonded(problem, bonds, r, settings);
        };
        if !sized || settings.method != Method::Auto || problem.check().is_err() {
            return solve_bonded(problem, bonds, r, settings);
        }
        let (measure, mut work) = (ErrorMeasure::bonded(problem, bonds), Work::default());
        let newton = &mut self.newton;
        let best = match problem.cone {
            Cone::Frictionless => newton.run::<1>(&measure, w, r, settings, &mut work),
            Cone::Planar => newton.run::<2>(&measure, w, r, settings, &mut work),
            Cone::Spatial => newton.run::<3>(&measure, w, r, settings, &mut work),
        };
        let tolerance = settings.tolerance;
        let outcome = Outcome::of_best(&measure, best, r, tolerance, Method::Newton, work);
        if outcome.is_converged() {
            return outcome;
        }
        let mut rest = solve_bonded(problem, bonds, r, settings);
        rest.iterations += outcome.iterations;
        rest
    }
}
