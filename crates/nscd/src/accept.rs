//! The end of a step: new state, forces of interfaces and supports, report.

use contact_bipotential::Contact;
use nalgebra::Vector3;

use crate::bonds::{adhesive_energy, bonds_after};
use crate::energy::{Accepted, audit};
use crate::flat::{largest, round_off};
use crate::local::{relative_displacement, relative_velocity};
use crate::model::{Model, point};
use crate::monitor::Check;
use crate::newton_iterate::NewtonIterate;
use crate::report::{Resultant, StepReport};
use crate::scheme::ContactLevel;
use crate::state::{BondState, ContactState, ContactStatus, State};
use crate::step_problem::StepProblem;

/// A friction force that comes so near to the edge of the cone, relative to it, is on it \[-\].
const ON_CONE: f64 = 1e-9;
/// A normal force below this part of the largest contact force is none \[-\].
const NO_FORCE: f64 = 1e-12;

/// Turns a converged iterate into the next state and its report. `fixed` tells the prescribed unknowns, `unforeseen` is
/// the deepest penetration of nodes that no contact was predicted for \[m\].
pub(crate) fn accept(
    step: &StepProblem<'_>,
    iterate: NewtonIterate,
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
    let report = StepReport {
        newton_iterations: check.iteration,
        residual: check.relative_residual(),
        contact_error: check.contact_error,
        penetration: contacts.iter().map(|c| -c.gap).fold(unforeseen, f64::max),
        energy: audit(step, &iterate, &end),
        ..resultants(step, &end, &positions)
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

/// What a report says of times, closed contacts, and forces of interfaces and supports.
fn resultants(step: &StepProblem<'_>, end: &Accepted<'_>, positions: &[f64]) -> StepReport {
    // A gap of the size of the round-off of the positions is closed, with or without a force.
    let touching = round_off(positions);
    let is_closed = |c: &&ContactState| c.status != ContactStatus::Open || c.gap <= touching;
    StepReport {
        time: step.end(),
        dt: step.dt,
        contacts_closed: end.contacts.iter().filter(is_closed).count(),
        interfaces: interface_resultants(step.model, end.contacts, positions),
        supports: support_resultants(step.model, end.support_force, positions),
        ..StepReport::default()
    }
}

/// What the supports have to carry \[N\]: minus the balance on prescribed unknowns.
fn support_force(iterate: &NewtonIterate, fixed: &[bool]) -> Vec<f64> {
    let left = |i: usize| iterate.balance[i] + iterate.contact_force[i];
    (0..fixed.len())
        .map(|i| if fixed[i] { -left(i) } else { 0.0 })
        .collect()
}

fn contact_states(
    step: &StepProblem<'_>,
    iterate: &NewtonIterate,
    moved: &[f64],
) -> Vec<ContactState> {
    let force_scale = largest(&iterate.r);
    let velocity = relative_velocity(step, &iterate.map, &iterate.v);
    let cone = iterate.map.cone();
    let one = |(k, c): (usize, &Contact)| {
        let force = iterate.force(k);
        let motion = match step.model.scheme.contact {
            ContactLevel::Position => iterate.local(k),
            ContactLevel::Velocity => cone.spatial(&moved[cone.range(k)]),
        };
        let (bond, mu) = bond_state(step.model, iterate, k);
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
    };
    iterate.map.contacts.iter().enumerate().map(one).collect()
}

/// The bond of contact `k`, if its interface has adhesion, and the coefficient of friction that it leaves.
fn bond_state(model: &Model, iterate: &NewtonIterate, k: usize) -> (Option<BondState>, f64) {
    let interface = &model.interfaces[iterate.map.contacts[k].interface];
    let (Some(bond), Some(_)) = (iterate.bonds.get(k), &interface.adhesion) else {
        return (None, interface.mu);
    };
    let x = iterate.local(k);
    let at = bond.at(&x);
    let state = BondState {
        intensity: at.intensity,
        separation: bond.finish(&x).separation,
        force: at.force,
    };
    (Some(state), bond.friction(interface.mu, at.intensity))
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
