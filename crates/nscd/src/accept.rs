//! The end of a step: new state, forces of interfaces and supports, report.

use nalgebra::Vector3;

use crate::bonds::{adhesive_energy, bonds_after};
use crate::energy::{Accepted, audit};
use crate::flat::{largest, round_off};
use crate::iterate::Iterate;
use crate::local::{relative_displacement, relative_velocity};
use crate::model::{Model, point};
use crate::monitor::Check;
use crate::report::{Resultant, StepReport};
use crate::scheme::ContactLevel;
use crate::state::{BondState, ContactState, ContactStatus, State};
use crate::step_problem::StepProblem;

/// A friction force that comes so near to the edge of the cone, relative to it, is on it \[-\].
const ON_CONE: f64 = 1e-9;
/// A normal force below this part of the largest contact force is none \[-\].
const NO_FORCE: f64 = 1e-12;

/// Turns a converged iterate into the next state and its report. `fixed` tells the prescribed unknowns, `unforeseen` is the
/// deepest penetration of nodes that no contact was predicted for \[m\].
pub(crate) fn accept(
    step: &StepProblem<'_>,
    iterate: Iterate,
    check: &Check,
    fixed: &[bool],
    unforeseen: f64,
) -> (State, StepReport) {
    let model = step.model;
    let support_force = support_force(&iterate, fixed);
    let moved = relative_displacement(step, &iterate.map, &iterate.u);
    let contacts = contact_states(step, &iterate, &moved);
    let positions = model.positions(&iterate.u);
    let bonds = bonds_after(step, &iterate, &positions);
    let adhesive_energy = adhesive_energy(model, &bonds);
    let end = Accepted {
        support_force: &support_force,
        moved: &moved,
        contacts: &contacts,
        adhesive_energy,
    };
    let energy = audit(step, &iterate, &end);
    // A gap of the size of the round-off of the positions is closed, with or without a force.
    let touching = round_off(&positions);
    let is_closed = |c: &&ContactState| c.status != ContactStatus::Open || c.gap <= touching;
    let report = StepReport {
        time: step.end(),
        dt: step.dt,
        newton_iterations: check.iteration,
        residual: check.relative_residual(),
        contact_error: check.contact_error,
        contacts_closed: contacts.iter().filter(is_closed).count(),
        penetration: contacts.iter().map(|c| -c.gap).fold(unforeseen, f64::max),
        energy,
        interfaces: interface_resultants(model, &contacts, &positions),
        supports: support_resultants(model, &support_force, &positions),
    };
    let state = State {
        time: step.end(),
        kinetic_energy: model.kinetic_energy(&iterate.v),
        u: iterate.u,
        v: iterate.v,
        internal_force: iterate.internal_force,
        external_force: step.external_force.clone(),
        strain_energy: iterate.strain_energy,
        support_force,
        contact_force: iterate.contact_force,
        contacts,
        bonds,
        adhesive_energy,
        last_dt: Some(step.dt),
        u_before: step.now.u.clone(),
    };
    (state, report)
}

/// What the supports have to carry \[N\]: minus the balance on prescribed unknowns.
fn support_force(iterate: &Iterate, fixed: &[bool]) -> Vec<f64> {
    let left = |i: usize| iterate.balance[i] + iterate.contact_force[i];
    (0..fixed.len())
        .map(|i| if fixed[i] { -left(i) } else { 0.0 })
        .collect()
}

fn contact_states(step: &StepProblem<'_>, iterate: &Iterate, moved: &[f64]) -> Vec<ContactState> {
    let force_scale = largest(&iterate.r);
    let velocity = relative_velocity(step, &iterate.map, &iterate.v);
    let cone = iterate.map.cone();
    let contacts = iterate.map.contacts.iter().enumerate();
    contacts
        .map(|(k, c)| {
            let (force, x) = (iterate.force(k), iterate.local(k));
            let motion = match step.model.scheme.contact {
                ContactLevel::Position => x,
                ContactLevel::Velocity => cone.spatial(&moved[cone.range(k)]),
            };
            let interface = &step.model.interfaces[c.interface];
            let mut mu = interface.mu;
            let bonded = iterate
                .bonds
                .get(k)
                .filter(|_| interface.adhesion.is_some());
            let bond = bonded.map(|bond| {
                let at = bond.at(&x);
                mu = bond.friction(mu, at.intensity);
                BondState {
                    intensity: at.intensity,
                    separation: bond.finish(&x).separation,
                    force: at.force,
                }
            });
            let dry = force - bond.map_or(Vector3::zeros(), |bond| bond.force);
            ContactState {
                interface: c.interface,
                slave_index: c.slave_index,
                node: c.slave,
                gap: c.gap,
                normal_velocity: velocity[cone.normal(k)],
                slip: [motion[0], motion[1]],
                force,
                frame: c.frame,
                status: status(mu, dry, force_scale),
                bond,
            }
        })
        .collect()
}

/// What a contact does under the force `r` that contact and friction govern \[N\], in `(t1, t2, n)`.
fn status(mu: f64, r: Vector3<f64>, force_scale: f64) -> ContactStatus {
    if r[2] <= NO_FORCE * force_scale {
        ContactStatus::Open
    } else if r[0].hypot(r[1]) >= mu * r[2] * (1.0 - ON_CONE) {
        ContactStatus::Slip
    } else {
        ContactStatus::Stick
    }
}

fn interface_resultants(
    model: &Model,
    contacts: &[ContactState],
    positions: &[f64],
) -> Vec<Resultant> {
    let mut sums = vec![Resultant::default(); model.interfaces.len()];
    for c in contacts {
        let at = point(positions, model.solid.dim(), c.node);
        sums[c.interface].add(c.global_force(), at);
    }
    sums
}

/// Force and moment of each support; a dof named twice counts for the later one.
fn support_resultants(model: &Model, force: &[f64], positions: &[f64]) -> Vec<Resultant> {
    let dim = model.solid.dim();
    let mut owner = vec![usize::MAX; force.len()];
    for (s, support) in model.supports.iter().enumerate() {
        for &node in &support.nodes {
            (0..dim)
                .filter(|&c| support.components[c])
                .for_each(|c| owner[dim * node as usize + c] = s);
        }
    }
    let mut sums = vec![Resultant::default(); model.supports.len()];
    for node in 0..force.len() / dim {
        for c in 0..dim {
            let dof = dim * node + c;
            if let Some(sum) = sums.get_mut(owner[dof]) {
                let mut f = Vector3::zeros();
                f[c] = force[dof];
                sum.add(f, point(positions, dim, node as u32));
            }
        }
    }
    sums
}
