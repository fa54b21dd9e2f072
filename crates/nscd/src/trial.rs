//! One step in the making: its constants, and the iterate that Newton improves.

use contact_bipotential::ContactMap;
use fe_core::ElementWorkspace;

use crate::model::Model;
use crate::scheme::{Inertia, Weights};
use crate::state::State;

/// What does not change while a step iterates.
#[derive(Debug)]
pub(crate) struct StepFrame<'a> {
    pub(crate) model: &'a Model,
    pub(crate) now: &'a State,
    pub(crate) dt: f64,
    pub(crate) weights: Weights,
    pub(crate) external_force: Vec<f64>,
    /// `(1 - xi)(F_ext0 - F_int0 - A v0) + xi F_ext1`.
    constant_force: Vec<f64>,
    /// Damping force `A v0` at the start.
    pub(crate) start_damping: Vec<f64>,
}

/// The iterate.
#[derive(Debug)]
pub(crate) struct Trial {
    pub(crate) u: Vec<f64>,
    pub(crate) v: Vec<f64>,
    pub(crate) internal_force: Vec<f64>,
    pub(crate) strain_energy: f64,
    pub(crate) damping_force: Vec<f64>,
    /// Force balance without contact [N]: zero together with the contact forces on free dofs,
    /// minus the support forces on prescribed ones.
    pub(crate) balance: Vec<f64>,
    /// Candidate contacts at the iterate.
    pub(crate) map: ContactMap,
    /// Local variable of the contact law of each candidate (slip and gap) [m].
    pub(crate) x: Vec<f64>,
    /// Force of each candidate, like `x` [N].
    pub(crate) r: Vec<f64>,
    /// `H^T r` [N].
    pub(crate) contact_force: Vec<f64>,
    /// Correction that the prescribed dofs still have to make.
    pub(crate) pending: Option<Vec<f64>>,
}

/// Damping force `A v` with `A = mass M + stiffness K_0`.
pub(crate) fn damping_force(
    model: &Model,
    initial: Option<&ElementWorkspace>,
    v: &[f64],
) -> Vec<f64> {
    let mut force = vec![0.0; v.len()];
    if model.damping.mass != 0.0 {
        model.mass.times(v, &mut force);
        force.iter_mut().for_each(|f| *f *= model.damping.mass);
    }
    if let Some(work) = initial {
        let mut elastic = vec![0.0; v.len()];
        model.solid.tangent_times(work, v, &mut elastic);
        force
            .iter_mut()
            .zip(&elastic)
            .for_each(|(f, e)| *f += model.damping.stiffness * e);
    }
    force
}

impl<'a> StepFrame<'a> {
    pub(crate) fn new(
        model: &'a Model,
        now: &'a State,
        dt: f64,
        initial: Option<&ElementWorkspace>,
    ) -> Self {
        let mut external_force = vec![0.0; model.dof_count()];
        model.external_force(now.time + dt, &mut external_force);
        let xi = model.scheme.force_weight();
        let start_damping = damping_force(model, initial, &now.v);
        let constant_force = (0..external_force.len())
            .map(|i| {
                let start = now.external_force[i] - now.internal_force[i] - start_damping[i];
                (1.0 - xi) * start + xi * external_force[i]
            })
            .collect();
        Self {
            model,
            now,
            dt,
            weights: model.scheme.weights(dt),
            external_force,
            constant_force,
            start_damping,
        }
    }

    pub(crate) fn end(&self) -> f64 {
        self.now.time + self.dt
    }

    /// Where Newton starts: free flight, or the last increment again in an equilibrium path. The
    /// prescribed dofs start there too, and what they still lack is returned as pending.
    pub(crate) fn predict(
        &self,
        fixed: &[bool],
        at_breakpoint: bool,
    ) -> (Vec<f64>, Option<Vec<f64>>) {
        let now = self.now;
        let mut u: Vec<f64> = match (self.model.scheme.inertia, now.last_dt) {
            (Inertia::Dynamic, _) => now
                .u
                .iter()
                .zip(&now.v)
                .map(|(u, v)| u + self.dt * v)
                .collect(),
            (Inertia::QuasiStatic, Some(last)) if !at_breakpoint => {
                let ratio = self.dt / last;
                now.u
                    .iter()
                    .zip(&now.u_before)
                    .map(|(u, before)| u + ratio * (u - before))
                    .collect()
            }
            _ => now.u.clone(),
        };
        let mut target = u.clone();
        self.model.prescribe(self.end(), &mut target);
        let step = now
            .u
            .iter()
            .zip(&target)
            .map(|(a, b)| (a - b).abs())
            .fold(0.0, f64::max);
        let jump = u
            .iter()
            .zip(&target)
            .map(|(a, b)| (a - b).abs())
            .fold(0.0, f64::max);
        if jump <= 0.05 * step {
            return (target, None);
        }
        for (i, &is_fixed) in fixed.iter().enumerate() {
            let at = u[i];
            u[i] = if is_fixed { now.u[i] } else { at };
        }
        let pending = (0..u.len())
            .map(|i| if fixed[i] { target[i] - u[i] } else { 0.0 })
            .collect();
        (u, Some(pending))
    }

    /// End velocities: by the scheme where free, mean of the step where prescribed. (The scheme at
    /// theta = 1/2 would make a prescribed velocity jump ring for ever.)
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

    /// The force balance without contact at the iterate.
    pub(crate) fn balance(&self, trial: &mut Trial) {
        let xi = self.weights.stiffness;
        let balance = &mut trial.balance;
        if self.model.scheme.inertia == Inertia::Dynamic {
            let rate: Vec<f64> = trial
                .v
                .iter()
                .zip(&self.now.v)
                .map(|(v1, v0)| (v1 - v0) / self.dt)
                .collect();
            self.model.mass.times(&rate, balance);
            balance.iter_mut().for_each(|b| *b = -*b);
        } else {
            balance.fill(0.0);
        }
        for i in 0..balance.len() {
            balance[i] +=
                self.constant_force[i] - xi * (trial.internal_force[i] + trial.damping_force[i]);
        }
    }
}
