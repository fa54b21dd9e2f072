//! A candidate with everything that was measured about it.

use crate::truth::{Errors, Truth};

/// Reactions, the velocities that belong to them, and their errors.
#[derive(Debug, Clone)]
pub(crate) struct Iterate {
    pub(crate) r: Vec<f64>,
    pub(crate) u: Vec<f64>,
    pub(crate) errors: Errors,
}

impl Iterate {
    pub(crate) fn new(truth: &Truth<'_>, r: &[f64]) -> Self {
        let mut u = vec![0.0; r.len()];
        let errors = truth.evaluate(r, &mut u);
        Iterate {
            r: r.to_vec(),
            u,
            errors,
        }
    }

    /// Recomputes `u` and the errors from `r`.
    pub(crate) fn refresh(&mut self, truth: &Truth<'_>) {
        self.errors = truth.evaluate(&self.r, &mut self.u);
    }

    pub(crate) fn is_within(&self, tolerance: f64) -> bool {
        self.errors.worst() <= tolerance
    }

    /// Takes `other` over if it is better; tells whether.
    pub(crate) fn keep_better(&mut self, other: &Iterate) -> bool {
        let better = other.errors.worst() < self.errors.worst();
        if better {
            self.clone_from(other);
        }
        better
    }
}

/// What the methods did together.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Work {
    /// Passes over all contacts.
    pub sweeps: usize,
    /// Newton steps, one factorisation each.
    pub newton_steps: usize,
    /// Steps of the global predictor-corrector.
    pub projections: usize,
}
