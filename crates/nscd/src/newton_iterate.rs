//! The iterate that Newton's method improves.

use contact_bipotential::{BondStep, Contact, ContactMap};

use nalgebra::Vector3;

use crate::error::ContactPlace;
use crate::model::Model;
use crate::scheme::Inertia;
use crate::step_problem::StepProblem;

/// End of a step as far as the iterations have come. Flat vectors are `dim * node + component`.
#[derive(Debug)]
pub(crate) struct NewtonIterate {
    /// Displacement \[m\].
    pub(crate) u: Vec<f64>,
    /// Velocity \[m/s\].
    pub(crate) v: Vec<f64>,
    /// Internal force \[N\].
    pub(crate) internal_force: Vec<f64>,
    /// Strain energy \[J\].
    pub(crate) strain_energy: f64,
    /// Damping force `A v` \[N\].
    pub(crate) damping_force: Vec<f64>,
    /// Force balance without contact \[N\]: zero together with the contact forces on free dofs, minus the support
    /// forces on prescribed ones.
    pub(crate) balance: Vec<f64>,
    /// Candidate contacts.
    pub(crate) map: ContactMap,
    /// The deepest of the contacts that are left out because they chatter: they come and go with the iterations.
    pub(crate) chattering: Option<Contact>,
    /// Bond of each candidate over the step; empty where no interface has adhesion.
    pub(crate) bonds: Vec<BondStep>,
    /// Local variable of the contact law of each candidate (slip and gap) \[m\].
    pub(crate) x: Vec<f64>,
    /// Candidates whose friction acts on the slip of the step instead of on the end velocity; empty where none does.
    pub(crate) turned: Vec<bool>,
    /// Force of each candidate, like `x` \[N\].
    pub(crate) r: Vec<f64>,
    /// `H^T r` \[N\].
    pub(crate) contact_force: Vec<f64>,
    /// Correction that the prescribed dofs still have to make \[m\].
    pub(crate) pending: Option<Vec<f64>>,
}

impl NewtonIterate {
    /// The iterate at the displacement `u`, not evaluated yet.
    pub(crate) fn at(model: &Model, u: Vec<f64>, pending: Option<Vec<f64>>) -> Self {
        let zeros = || vec![0.0; u.len()];
        Self {
            v: zeros(),
            internal_force: zeros(),
            strain_energy: 0.0,
            damping_force: zeros(),
            balance: zeros(),
            map: ContactMap::new(Vec::new(), model.solid.dim(), model.cone()),
            chattering: None,
            bonds: Vec::new(),
            x: Vec::new(),
            turned: Vec::new(),
            r: Vec::new(),
            contact_force: zeros(),
            pending,
            u,
        }
    }

    /// The force balance without contact, from velocities, internal and damping forces.
    pub(crate) fn balance_forces(&mut self, step: &StepProblem<'_>) {
        let xi = step.weights.stiffness;
        let balance = &mut self.balance;
        if step.model.scheme.inertia == Inertia::Dynamic {
            let velocities = self.v.iter().zip(&step.now.v);
            let rate: Vec<f64> = velocities.map(|(v1, v0)| (v1 - v0) / step.dt).collect();
            step.model.mass.times(&rate, balance);
            balance.iter_mut().for_each(|b| *b = -*b);
        } else {
            balance.fill(0.0);
        }
        for i in 0..balance.len() {
            let internal = self.internal_force[i] + self.damping_force[i];
            balance[i] += step.constant_force[i] - xi * internal;
        }
    }

    /// Row of the normal component of contact `k`.
    fn normal(&self, k: usize) -> usize {
        self.map.cone().normal(k)
    }

    /// Normal component of the local variable of contact `k` \[m\]: its gap at the position level.
    pub(crate) fn gap(&self, k: usize) -> f64 {
        self.x[self.normal(k)]
    }

    /// Whether contact `k` has a pressing force.
    pub(crate) fn is_pressed(&self, k: usize) -> bool {
        self.r[self.normal(k)] > 0.0
    }

    /// Local variable of contact `k` in `(t1, t2, n)` \[m\].
    pub(crate) fn local(&self, k: usize) -> Vector3<f64> {
        let cone = self.map.cone();
        cone.spatial(&self.x[cone.range(k)])
    }

    /// Force of contact `k` in `(t1, t2, n)` \[N\].
    pub(crate) fn force(&self, k: usize) -> Vector3<f64> {
        let cone = self.map.cone();
        cone.spatial(&self.r[cone.range(k)])
    }

    /// Whether every candidate would stay open, and every bond idle, under the correction `z` \[m\] alone.
    pub(crate) fn stays_open(&self, z: &[f64]) -> bool {
        let mut moved = vec![0.0; self.x.len()];
        self.map.apply(z, &mut moved);
        (0..self.map.len()).all(|k| {
            let gap = self.gap(k) + moved[self.normal(k)];
            gap >= 0.0 && !self.bonds.get(k).is_some_and(|bond| bond.may_act(gap))
        })
    }

    /// Contact `k` as an error names it.
    pub(crate) fn place(&self, model: &Model, k: usize) -> Option<ContactPlace> {
        self.map.contacts.get(k).map(|c| model.place(c))
    }
}
