//! One step in the making: its constants, and the iterate that Newton improves.

use contact_bipotential::{BondStep, Contact, ContactMap};
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
    /// Force balance without contact \[N\]: zero together with the contact forces on free dofs,
    /// minus the support forces on prescribed ones.
    pub(crate) balance: Vec<f64>,
    /// Candidate contacts at the iterate.
    pub(crate) map: ContactMap,
    /// The deepest of the contacts at the iterate that are left out because they come and go with the iterations.
    pub(crate) given_up: Option<Contact>,
    /// Bond of each candidate over the step; empty where no interface has adhesion.
    pub(crate) bonds: Vec<BondStep>,
    /// Local variable of the contact law of each candidate (slip and gap) \[m\].
    pub(crate) x: Vec<f64>,
    /// Force of each candidate, like `x` \[N\].
    pub(crate) r: Vec<f64>,
    /// `H^T r` \[N\].
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

#[cfg(test)]
mod tests {
    use fe_core::{BoxMesh, Solid, solid_block};
    use hyperelastic::{ElasticConstants, NeoHookean};
    use proptest::prelude::*;

    use crate::body::{BodySystem, MatrixParts};
    use crate::ordering::Graph;
    use crate::report::Counters;
    use crate::stepper::Stepper;
    use crate::{ContactLevel, Inertia, Model, NoClock, Rayleigh, Scheme, Settings};

    use super::*;

    fn model(theta: f64, xi: f64, damping: Rayleigh) -> Model {
        let mesh = BoxMesh::uniform([0.0; 3], [1.0, 1.0, 2.0], [1, 1, 2])
            .generate("block")
            .unwrap();
        let law = NeoHookean::new(ElasticConstants::from_shear_lame(2.0, 3.0).unwrap()).unwrap();
        let block = solid_block(&mesh, 0, law, 1.5).unwrap();
        let held = mesh.node_sets["z_min"].clone();
        let solid = Solid::new(mesh, vec![block]).unwrap();
        let scheme = Scheme {
            theta,
            xi,
            contact: ContactLevel::Position,
            inertia: Inertia::Dynamic,
        };
        Model {
            mass: solid.consistent_mass(),
            damping,
            supports: vec![fe_core::Dirichlet::clamped("base", held)],
            loads: Vec::new(),
            interfaces: Vec::new(),
            scheme,
            settings: Settings::default(),
            solid,
        }
    }

    /// Balance of a frame at `u`.
    fn balance(
        frame: &StepFrame<'_>,
        initial: &ElementWorkspace,
        fixed: &[bool],
        u: &[f64],
    ) -> Vec<f64> {
        let n = u.len();
        let mut work = frame.model.solid.workspace();
        let empty = ContactMap::new(Vec::new(), 3, contact_bipotential::Cone::Spatial);
        let mut trial = Trial {
            u: u.to_vec(),
            v: vec![0.0; n],
            internal_force: vec![0.0; n],
            strain_energy: 0.0,
            damping_force: vec![0.0; n],
            balance: vec![0.0; n],
            map: empty,
            given_up: None,
            bonds: Vec::new(),
            x: Vec::new(),
            r: Vec::new(),
            contact_force: vec![0.0; n],
            pending: None,
        };
        frame
            .model
            .solid
            .internal_force(u, &mut work, &mut trial.internal_force)
            .unwrap();
        frame.end_velocity(u, fixed, &mut trial.v);
        trial.damping_force = damping_force(frame.model, Some(initial), &trial.v);
        frame.balance(&mut trial);
        trial.balance
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(24))]
        /// The factorized matrix is minus the derivative of the whole residual, contact excluded:
        /// `A^-1 (b(u) - b(u + z))` gives `z` back.
        #[test]
        fn the_matrix_of_a_step_is_the_derivative_of_its_residual(
            theta in 0.5..1.0_f64, xi in 0.5..1.0_f64, dt in 0.01..0.5_f64,
            alpha in 0.0..0.5_f64, beta in 0.0..0.1_f64,
            shape in prop::collection::vec(-0.1..0.1_f64, 36), direction in prop::collection::vec(-1.0..1.0_f64, 36),
        ) {
            let model = model(theta, xi, Rayleigh { mass: alpha, stiffness: beta });
            let fixed = model.prescribed();
            let free = |x: &[f64]| -> Vec<f64> { x.iter().zip(&fixed).map(|(x, f)| if *f { 0.0 } else { *x }).collect() };
            let (u, z) = (free(&shape), free(&direction));
            let now = Stepper::new(&model, Box::new(NoClock)).unwrap().initial_state(vec![0.1; 36]).unwrap();
            let mut initial = model.solid.workspace();
            model.solid.tangent(&[0.0; 36], &mut initial, &mut [0.0; 36]).unwrap();
            let frame = StepFrame::new(&model, &now, dt, Some(&initial));
            let mut work = model.solid.workspace();
            model.solid.tangent(&u, &mut work, &mut [0.0; 36]).unwrap();
            let (offsets, neighbours) = fe_core::node_adjacency(&model.solid);
            let graph = Graph { offsets: &offsets, neighbours: &neighbours };
            let mut body = BodySystem::new(&model.solid, graph, 0, &fixed, &[false; 12]).unwrap();
            let parts = MatrixParts { mass: &model.mass, mass_damping: alpha, initial_stiffness: Some((&initial, beta)) };
            let mut counters = Counters::default();
            body.refactor(&work, parts, frame.weights, &[], &mut counters).unwrap();
            prop_assume!(counters.indefinite_tangents == 0);
            let h = 1e-6;
            let moved = |s: f64| -> Vec<f64> { u.iter().zip(&z).map(|(u, z)| u + s * h * z).collect() };
            let (ahead, behind) = (balance(&frame, &initial, &fixed, &moved(1.0)), balance(&frame, &initial, &fixed, &moved(-1.0)));
            let slope: Vec<f64> = ahead.iter().zip(&behind).map(|(a, b)| (b - a) / (2.0 * h)).collect();
            body.forward(&slope);
            let mut back = vec![0.0; 36];
            body.backward(None, &mut back, &mut counters).unwrap();
            for (back, z) in back.iter().zip(&z) {
                prop_assert!((back - z).abs() < 1e-5, "{back} {z}");
            }
        }
    }
}
