//! Anderson's acceleration of a fixed-point sequence \[Anderson1965\].
//!
//! Where the steps of a sequence shrink by a nearly constant factor in a few directions, the combination of the last
//! ones whose residuals cancel best takes these directions out, for a few scalar products. Nothing is to be believed
//! because of it: who extrapolates measures the error of what comes out.

use crate::flat::{difference, dot};

/// Part of the squared length of a residual difference that must be new to count \[-\]: the rest is round-off of the
/// others.
const NEW_PART: f64 = 1e-12;

/// The last few steps of a sequence.
#[derive(Debug, Clone)]
pub struct Anderson {
    depth: usize,
    /// Iterate and residual of the last step.
    last: Option<(Vec<f64>, Vec<f64>)>,
    /// Differences of the two from step to step, the oldest first.
    differences: Vec<(Vec<f64>, Vec<f64>)>,
}

impl Anderson {
    /// A sequence of which `depth` differences are kept.
    #[must_use]
    pub fn new(depth: usize) -> Self {
        Anderson {
            depth: depth.max(1),
            last: None,
            differences: Vec::new(),
        }
    }

    /// Forgets everything: the sequence goes on by another rule, or from another place.
    pub fn forget(&mut self) {
        self.last = None;
        self.differences.clear();
    }

    /// Replaces the `iterate` that the sequence reached by the extrapolated one; false where it stays as it is, because
    /// there is nothing yet to extrapolate from or the outcome is no number.
    ///
    /// `residual` belongs to the step that led to `iterate`: the step itself or a part of it, scaled to the norm in
    /// which the residuals are to cancel. The two may differ in length; each must keep its own from call to call.
    pub fn extrapolate(&mut self, iterate: &mut [f64], residual: &[f64]) -> bool {
        if let Some((last_iterate, last_residual)) = self.last.take() {
            if self.differences.len() == self.depth {
                self.differences.remove(0);
            }
            self.differences.push((
                difference(iterate, &last_iterate),
                difference(residual, &last_residual),
            ));
        }
        let weights = self.weights(residual);
        let (last, _) = self.last.insert((iterate.to_vec(), residual.to_vec()));
        let Some(weights) = weights else {
            return false;
        };
        for (weight, (step, _)) in weights.iter().zip(&self.differences) {
            for (x, s) in iterate.iter_mut().zip(step) {
                *x -= weight * s;
            }
        }
        let finite = iterate.iter().all(|x| x.is_finite());
        if !finite {
            iterate.copy_from_slice(last);
        }
        finite
    }

    /// Weights of the differences of residuals that come closest to `residual`, by modified Gram-Schmidt from the
    /// latest on; directions that add nothing new are left out.
    fn weights(&self, residual: &[f64]) -> Option<Vec<f64>> {
        let m = self.differences.len();
        let mut basis: Vec<(Vec<f64>, Vec<f64>)> = Vec::with_capacity(m);
        let mut weights = vec![0.0; m];
        for k in (0..m).rev() {
            let mut direction = self.differences[k].1.clone();
            let mut combination = vec![0.0; m];
            combination[k] = 1.0;
            let size = dot(&direction, &direction);
            for (q, c) in &basis {
                let along = dot(q, &direction);
                subtract(&mut direction, along, q);
                subtract(&mut combination, along, c);
            }
            let left = dot(&direction, &direction);
            if left <= NEW_PART * size || left == 0.0 {
                continue;
            }
            let scale = left.sqrt().recip();
            for x in direction.iter_mut().chain(&mut combination) {
                *x *= scale;
            }
            subtract(&mut weights, -dot(&direction, residual), &combination);
            basis.push((direction, combination));
        }
        (!basis.is_empty() && weights.iter().all(|w| w.is_finite())).then_some(weights)
    }
}

/// `a -= s b`.
fn subtract(a: &mut [f64], s: f64, b: &[f64]) {
    for (a, b) in a.iter_mut().zip(b) {
        *a -= s * b;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A linear fixed-point iteration in four dimensions ends after five extrapolated steps.
    #[test]
    fn linear_iterations_end_after_as_many_steps_as_directions() {
        let rates = [0.9, -0.5, 0.3, 0.1];
        let mut x = vec![1.0, 2.0, -3.0, 0.5];
        let mut anderson = Anderson::new(5);
        for _ in 0..5 {
            let correction: Vec<f64> = x.iter().zip(rates).map(|(x, r)| (r - 1.0) * x).collect();
            x.iter_mut().zip(&correction).for_each(|(x, c)| *x += c);
            anderson.extrapolate(&mut x, &correction);
        }
        assert!(x.iter().all(|x| x.abs() < 1e-10), "{x:?}");
    }

    #[test]
    fn without_history_nothing_changes() {
        let mut x = vec![1.0, 2.0];
        assert!(!Anderson::new(5).extrapolate(&mut x, &[0.1, 0.2]));
        assert_eq!(x, [1.0, 2.0]);
    }
}
