//! Anderson's acceleration of sweeps and projections, safeguarded by the recomputed error.

use crate::anderson::Anderson;
use crate::error_measure::ErrorMeasure;
use crate::solve::iterate::Iterate;

/// Pairs of differences that are kept.
const DEPTH: usize = 8;
/// Steps without a new best point after which the extrapolation rests, and how long it rests: what circles must be left
/// to itself for a while.
const PATIENCE: usize = 20;
const REST: usize = 20;
/// Error of an extrapolated point over that of the plain one, beyond which it is not taken \[-\].
const WORSE: f64 = 2.0;

/// The acceleration of a sequence of iterates.
#[derive(Debug)]
pub(crate) struct Acceleration {
    anderson: Anderson,
    idle: usize,
    rest: usize,
}

impl Acceleration {
    pub(crate) fn new() -> Self {
        Acceleration {
            anderson: Anderson::new(DEPTH),
            idle: 0,
            rest: 0,
        }
    }

    pub(crate) fn forget(&mut self) {
        self.anderson.forget();
    }

    /// Extrapolates the sequence after its step from the reactions `before` to `x`, and keeps the best point met in
    /// `best`; `improved` tells whether the plain step was one.
    pub(crate) fn accelerate(
        &mut self,
        measure: &ErrorMeasure<'_>,
        before: &[f64],
        x: &mut Iterate,
        best: &mut Iterate,
        mut improved: bool,
    ) {
        if self.rest == 0 {
            let plain = x.clone();
            let residual = energy_norm(measure, before, &x.r);
            if self.anderson.extrapolate(&mut x.r, &residual) {
                x.refresh(measure);
                improved |= best.keep_better(x);
                if x.errors.scale_free > WORSE * plain.errors.scale_free {
                    *x = plain;
                    self.anderson.forget();
                }
            }
        }
        self.note(improved);
    }

    fn note(&mut self, improved: bool) {
        self.idle = if improved { 0 } else { self.idle + 1 };
        self.rest = self.rest.saturating_sub(1);
        if self.idle >= PATIENCE {
            self.anderson.forget();
            self.idle = 0;
            self.rest = REST;
        }
    }
}

/// The step `after - before`, scaled by the compliances to the square root of an energy.
fn energy_norm(measure: &ErrorMeasure<'_>, before: &[f64], after: &[f64]) -> Vec<f64> {
    let roots = measure.roots();
    let dim = after.len() / roots.len().max(1);
    let steps = after.iter().zip(before).enumerate();
    steps.map(|(i, (a, b))| roots[i / dim] * (a - b)).collect()
}
