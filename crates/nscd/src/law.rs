//! The contact law at an iterate: its local variable, and how far the iterate is from obeying it.

use contact_bipotential::cone::project;
use contact_bipotential::local::local_axes;
use contact_bipotential::{BondStep, Contact, ContactKey, ContactMap};

use crate::contact::ContactMemory;
use crate::model::Model;
use crate::scheme::ContactLevel;
use crate::state::{ContactState, State};
use crate::trial::{StepFrame, Trial};

/// Local variable of every contact of `map` at an iterate \[m\]: slip of the step and gap, or at the
/// velocity level the end velocity times the displacement that a unit of it stands for.
pub(crate) fn local_variable(
    frame: &StepFrame<'_>,
    map: &ContactMap,
    cone: usize,
    u: &[f64],
    v: &[f64],
) -> Vec<f64> {
    match frame.model.scheme.contact {
        ContactLevel::Position => {
            let mut x = relative_displacement(frame, map, u);
            for (c, x) in map.contacts.iter().zip(x.chunks_exact_mut(cone)) {
                x[cone - 1] = c.gap;
                take_off_turn(frame, c, x);
            }
            x
        }
        ContactLevel::Velocity => {
            let rate = frame.model.scheme.velocity_rate(frame.dt);
            let start = relative_velocity(frame, map, &frame.now.v);
            let mut x = relative_velocity(frame, map, v);
            for (k, c) in map.contacts.iter().enumerate() {
                let n = cone * k + cone - 1;
                x[n] += frame.model.interfaces[c.interface].restitution * start[n].min(0.0);
            }
            x.iter_mut().for_each(|x| *x /= rate);
            x
        }
    }
}

/// An open bond that turns as a whole does not slip: the node goes round with the normal, `g_0 (n_1 - n_0)`.
fn take_off_turn(frame: &StepFrame<'_>, contact: &Contact, x: &mut [f64]) {
    if frame.model.interfaces[contact.interface].adhesion.is_none() {
        return;
    }
    let Some(before) = state_before(frame.now, contact.key()) else {
        return;
    };
    let last = x.len() - 1;
    for (x, axis) in x[..last].iter_mut().zip(local_axes(last + 1)) {
        let turn = contact.frame.column(*axis).dot(&before.frame.column(2));
        *x += before.gap.max(0.0) * turn;
    }
}

/// What a slave node did at the end of the last step, if it was a candidate then.
pub(crate) fn state_before(now: &State, key: ContactKey) -> Option<&ContactState> {
    let found = now.contacts.binary_search_by_key(&key, ContactState::key);
    found.ok().map(|i| &now.contacts[i])
}

/// Displacement of the slave relative to the master in the step, in local frames \[m\].
pub(crate) fn relative_displacement(
    frame: &StepFrame<'_>,
    map: &ContactMap,
    u: &[f64],
) -> Vec<f64> {
    let du: Vec<f64> = u.iter().zip(&frame.now.u).map(|(a, b)| a - b).collect();
    relative(map, &du, 1.0)
}

/// Velocity of the slave relative to the master, in local frames [m/s].
pub(crate) fn relative_velocity(frame: &StepFrame<'_>, map: &ContactMap, v: &[f64]) -> Vec<f64> {
    relative(map, v, 1.0 / frame.dt)
}

/// `H w` minus `obstacle` times the obstacle's displacement in the step.
fn relative(map: &ContactMap, w: &[f64], obstacle: f64) -> Vec<f64> {
    let mut x = vec![0.0; map.row_count()];
    let mut offset = x.clone();
    map.apply(w, &mut x);
    map.slip_offsets(&mut offset);
    x.iter_mut()
        .zip(&offset)
        .for_each(|(x, o)| *x += obstacle * o);
    x
}

/// Error of the contact law at an iterate.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct LawError {
    /// Largest `|r - Proj_K(r - rho (x + mu |x_t| n))|`, `rho = 1/trace W_cc`, relative to the largest contact force or
    /// to the round-off of this contact that stands for it [-].
    pub(crate) largest: f64,
    /// Index of that contact in the map.
    pub(crate) worst: usize,
}

impl ContactMemory {
    /// Mean of `1 / W_ii` of a contact that entered a contact problem, else infinite [N/m].
    pub(crate) fn local_stiffness(&self, contact: &Contact) -> f64 {
        match self.stiffness[contact.interface][contact.slave_index] {
            0.0 => f64::INFINITY,
            inverse_trace => self.cone as f64 * inverse_trace,
        }
    }

    /// Error of the contact law with exact gaps; `fallback` is the stiffness [N/m] of contacts
    /// that never entered a contact problem, `blur` the gap \[m\] that cannot be told from round-off over the tolerance.
    pub(crate) fn law_error(
        &self,
        model: &Model,
        trial: &Trial,
        fallback: f64,
        blur: f64,
    ) -> LawError {
        let cone = self.cone;
        let force = trial.r.iter().fold(0.0, |m: f64, r| m.max(r.abs()));
        let mut error = LawError::default();
        for (k, c) in trial.map.contacts.iter().enumerate() {
            let (r, x) = (
                &trial.r[cone * k..cone * (k + 1)],
                &trial.x[cone * k..cone * (k + 1)],
            );
            let rho = match self.stiffness[c.interface][c.slave_index] {
                0.0 => fallback,
                known => known,
            };
            let mu = model.interfaces[c.interface].mu;
            let (mu, r) = without_bond(trial.bonds.get(k), mu, r, x);
            let scale = force.max(rho * blur).max(f64::MIN_POSITIVE);
            let size = natural_map(mu, rho, &r[3 - cone..], x) / scale;
            if size > error.largest {
                error = LawError {
                    largest: size,
                    worst: k,
                };
            }
        }
        error
    }
}

/// Friction coefficient and the part of a force that the contact law governs; missing tangents stand in front.
fn without_bond(bond: Option<&BondStep>, mu: f64, r: &[f64], x: &[f64]) -> (f64, [f64; 3]) {
    let mut dry = [0.0; 3];
    dry[3 - r.len()..].copy_from_slice(r);
    let Some(bond) = bond else { return (mu, dry) };
    let at = bond.at(&in_frame(x));
    let axes = local_axes(r.len());
    for (i, axis) in axes.iter().enumerate() {
        dry[3 - r.len() + i] -= at.force[*axis];
    }
    (bond.friction(mu, at.intensity), dry)
}

/// A local vector in `(t1, t2, n)`.
pub(crate) fn in_frame(x: &[f64]) -> [f64; 3] {
    let mut full = [0.0; 3];
    for (x, axis) in x.iter().zip(local_axes(x.len())) {
        full[*axis] = *x;
    }
    full
}

/// Norm of `r - Proj_K(r - rho (x + mu |x_t| n))`, normal last.
fn natural_map(mu: f64, rho: f64, r: &[f64], x: &[f64]) -> f64 {
    let last = r.len() - 1;
    let slip = x[..last].iter().map(|t| t * t).sum::<f64>().sqrt();
    // A missing tangent is a zero one.
    let place = 2 - last;
    let (mut force, mut trial) = ([0.0; 3], [0.0; 3]);
    for i in 0..=last {
        force[place + i] = r[i];
        trial[place + i] = r[i] - rho * x[i];
    }
    trial[2] -= rho * mu * slip;
    let projected = project::<3>(mu, &trial);
    (0..3)
        .map(|i| (force[i] - projected[i]).powi(2))
        .sum::<f64>()
        .sqrt()
}
