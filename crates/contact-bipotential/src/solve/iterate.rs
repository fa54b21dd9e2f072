//! Reactions with everything that was measured about them.

use crate::error_measure::{ErrorMeasure, Errors};

/// Halvings of a Newton step that are tried.
const HALVINGS: usize = 7;
/// Part of the error, times the length of the step, that a step must take off to be taken at once \[-\].
const DECREASE: f64 = 0.1;

/// Reactions, the velocities that belong to them, and their errors.
#[derive(Debug, Clone)]
pub(crate) struct Iterate {
    pub(crate) r: Vec<f64>,
    pub(crate) u: Vec<f64>,
    pub(crate) errors: Errors,
}

impl Iterate {
    pub(crate) fn new(measure: &ErrorMeasure<'_>, r: &[f64]) -> Self {
        let mut u = vec![0.0; r.len()];
        let errors = measure.evaluate(r, &mut u);
        Iterate {
            r: r.to_vec(),
            u,
            errors,
        }
    }

    /// Recomputes `u` and the errors from `r`.
    pub(crate) fn refresh(&mut self, measure: &ErrorMeasure<'_>) {
        self.errors = measure.evaluate(&self.r, &mut self.u);
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

    /// The first of `r + dr`, `r + dr/2`, .. that lowers the error, or the best of them.
    pub(crate) fn backtrack(&self, measure: &ErrorMeasure<'_>, dr: &[f64]) -> Iterate {
        let mut x = self.clone();
        let mut best: Option<Iterate> = None;
        let mut t = 1.0;
        for _ in 0..HALVINGS {
            for i in 0..dr.len() {
                x.r[i] = self.r[i] + t * dr[i];
            }
            x.refresh(measure);
            if x.errors.scale_free < (1.0 - DECREASE * t) * self.errors.scale_free {
                return x;
            }
            match &mut best {
                Some(b) if b.errors.scale_free <= x.errors.scale_free => {}
                _ => best = Some(x.clone()),
            }
            t *= 0.5;
        }
        best.unwrap_or(x)
    }
}
