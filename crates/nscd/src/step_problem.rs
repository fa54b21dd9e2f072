//! The problem that one step poses: start, length, loads and weights.

use crate::elements::Elements;
use crate::flat::{difference, largest};
use crate::model::Model;
use crate::scheme::{Inertia, Weights};
use crate::state::State;

/// Most that the prediction may miss of the prescribed motion, over that motion in the step, for Newton's iteration to
/// start with the prescribed unknowns at their ends \[-\]: more would crush the elements beside them.
const MISSED: f64 = 0.05;

/// What does not change while a step iterates.
#[derive(Debug)]
pub(crate) struct StepProblem<'a> {
    pub(crate) model: &'a Model,
    /// Where the step starts.
    pub(crate) now: &'a State,
    /// Length of the step \[s\].
    pub(crate) dt: f64,
    /// Weights of stiffness, damping and mass in the matrix of the step.
    pub(crate) weights: Weights,
    /// External force at the end \[N\].
    pub(crate) external_force: Vec<f64>,
    /// `(1 - xi)(F_ext0 - F_int0 - A v0) + xi F_ext1` \[N\].
    pub(crate) constant_force: Vec<f64>,
    /// Damping force `A v0` at the start \[N\].
    pub(crate) start_damping: Vec<f64>,
}

impl<'a> StepProblem<'a> {
    /// The step of length `dt` \[s\] from `now`.
    pub(crate) fn new(elements: &Elements<'a>, now: &'a State, dt: f64) -> Self {
        let model = elements.model();
        let mut external_force = vec![0.0; model.dof_count()];
        model.external_force(now.time + dt, &mut external_force);
        let xi = model.scheme.force_weight();
        let start_damping = elements.damping_force(&now.v);
        let constant_force = (0..external_force.len())
            .map(|i| {
                let start = now.external_force[i] - now.internal_force[i] - start_damping[i];
                (1.0 - xi) * start + xi * external_force[i]
            })
            .collect();
        let mut weights = model.scheme.weights(dt);
        if model.damping.is_none() {
            // A factor holds for any step that changes nothing in it.
            weights.damping = 0.0;
        }
        Self {
            model,
            now,
            dt,
            weights,
            external_force,
            constant_force,
            start_damping,
        }
    }

    /// End of the step \[s\].
    pub(crate) fn end(&self) -> f64 {
        self.now.time + self.dt
    }

    /// Where Newton starts, and the correction that the prescribed dofs still lack there \[m\], if they cannot start at
    /// their ends.
    pub(crate) fn predict(
        &self,
        fixed: &[bool],
        at_breakpoint: bool,
    ) -> (Vec<f64>, Option<Vec<f64>>) {
        let now = self.now;
        let mut u = self.extrapolated(at_breakpoint);
        let mut target = u.clone();
        self.model.prescribe(self.end(), &mut target);
        let distance = |from: &[f64]| largest(&difference(from, &target));
        if distance(&u) <= MISSED * distance(&now.u) {
            return (target, None);
        }
        for i in (0..u.len()).filter(|&i| fixed[i]) {
            u[i] = now.u[i];
        }
        let pending = (0..u.len())
            .map(|i| if fixed[i] { target[i] - u[i] } else { 0.0 })
            .collect();
        (u, Some(pending))
    }

    /// Free flight, or the last increment again in an equilibrium path.
    fn extrapolated(&self, at_breakpoint: bool) -> Vec<f64> {
        let now = self.now;
        match (self.model.scheme.inertia, now.last_dt) {
            (Inertia::Dynamic, _) => {
                let nodes = now.u.iter().zip(&now.v);
                nodes.map(|(u, v)| u + self.dt * v).collect()
            }
            (Inertia::QuasiStatic, Some(last)) if !at_breakpoint => {
                let ratio = self.dt / last;
                let nodes = now.u.iter().zip(&now.u_before);
                nodes.map(|(u, before)| u + ratio * (u - before)).collect()
            }
            _ => now.u.clone(),
        }
    }

    /// What the prescribed dofs still have to move from the displacement `u` \[m\]; zero on the others.
    pub(crate) fn prescribed_way(&self, u: &[f64]) -> Vec<f64> {
        let mut target = u.to_vec();
        self.model.prescribe(self.end(), &mut target);
        difference(&target, u)
    }

    /// End velocities: by the scheme where free, mean of the step where prescribed. (The scheme at theta = 1/2 would
    /// make a prescribed velocity jump ring for ever.)
    pub(crate) fn end_velocity(&self, u: &[f64], fixed: &[bool], v: &mut [f64]) {
        let (now, dt) = (self.now, self.dt);
        for i in 0..u.len() {
            let du = u[i] - now.u[i];
            v[i] = if fixed[i] {
                du / dt
            } else {
                self.model.scheme.end_velocity(now.v[i], du, dt)
            };
        }
    }
}
