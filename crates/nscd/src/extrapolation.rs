//! Anderson's extrapolation of the iterates of a step.
//!
//! With a lagged tangent the corrections shrink by a nearly constant factor in a few directions; a
//! least-squares combination of the last ones takes these directions out, for a few scalar products.
//! Displacements and contact forces are combined with the same weights, so that a balance which is
//! linear in both stays one. Nothing is believed because of it: the next check recomputes everything.

use crate::flat::{difference, dot};

/// Corrections that are combined.
const DEPTH: usize = 5;

/// The last corrections of a step.
#[derive(Debug, Default)]
pub(crate) struct Extrapolation {
    /// Corrected iterate (displacements, then contact forces) and the correction that led there.
    last: Option<(Vec<f64>, Vec<f64>)>,
    /// Differences of the two from iteration to iteration.
    differences: Vec<(Vec<f64>, Vec<f64>)>,
}

impl Extrapolation {
    /// Forgets everything: after a new factorization the corrections are of another kind.
    pub(crate) fn forget(&mut self) {
        self.last = None;
        self.differences.clear();
    }

    /// Replaces the corrected iterate by the extrapolated one. `correction` is the displacement part.
    pub(crate) fn apply(&mut self, iterate: &mut [f64], correction: &[f64]) {
        if let Some((last_iterate, last_correction)) = self.last.take() {
            if self.differences.len() == DEPTH {
                self.differences.remove(0);
            }
            self.differences.push((
                difference(iterate, &last_iterate),
                difference(correction, &last_correction),
            ));
        }
        self.last = Some((iterate.to_vec(), correction.to_vec()));
        let Some(weights) = self.weights(correction) else {
            return;
        };
        for (weight, (step, _)) in weights.iter().zip(&self.differences) {
            iterate
                .iter_mut()
                .zip(step)
                .for_each(|(x, s)| *x -= weight * s);
        }
    }

    /// Weights of the differences of corrections that come closest to `correction`, by modified
    /// Gram-Schmidt from the latest on; directions that add nothing new are left out.
    fn weights(&self, correction: &[f64]) -> Option<Vec<f64>> {
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
                direction
                    .iter_mut()
                    .zip(q)
                    .for_each(|(d, q)| *d -= along * q);
                combination
                    .iter_mut()
                    .zip(c)
                    .for_each(|(a, c)| *a -= along * c);
            }
            let left = dot(&direction, &direction);
            if left <= 1e-12 * size || left == 0.0 {
                continue;
            }
            let scale = left.sqrt().recip();
            direction
                .iter_mut()
                .chain(&mut combination)
                .for_each(|x| *x *= scale);
            let share = dot(&direction, correction);
            weights
                .iter_mut()
                .zip(&combination)
                .for_each(|(w, c)| *w += share * c);
            basis.push((direction, combination));
        }
        (!basis.is_empty() && weights.iter().all(|w| w.is_finite())).then_some(weights)
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
        let mut extrapolation = Extrapolation::default();
        for _ in 0..5 {
            let correction: Vec<f64> = x.iter().zip(rates).map(|(x, r)| (r - 1.0) * x).collect();
            x.iter_mut().zip(&correction).for_each(|(x, c)| *x += c);
            extrapolation.apply(&mut x, &correction);
        }
        assert!(x.iter().all(|x| x.abs() < 1e-10), "{x:?}");
    }

    #[test]
    fn without_history_nothing_changes() {
        let mut x = vec![1.0, 2.0];
        Extrapolation::default().apply(&mut x, &[0.1, 0.2]);
        assert_eq!(x, [1.0, 2.0]);
    }
}
