//! Slip and gap: the local variable of the contact law, at an iterate.

use contact_bipotential::{Cone, Contact, ContactMap};

use crate::flat::difference;
use crate::scheme::ContactLevel;
use crate::step_problem::StepProblem;

/// Local variable of every contact of `map` at an iterate \[m\]: slip of the step and gap, or at the velocity level the
/// end velocity times the displacement that a unit of it stands for.
pub(crate) fn local_variable(
    step: &StepProblem<'_>,
    map: &ContactMap,
    u: &[f64],
    v: &[f64],
) -> Vec<f64> {
    let cone = map.cone();
    match step.model.scheme.contact {
        ContactLevel::Position => {
            let mut x = relative_displacement(step, map, u);
            for (c, x) in map.contacts.iter().zip(x.chunks_exact_mut(cone.dim())) {
                x[cone.normal(0)] = c.gap;
                take_off_turn(step, cone, c, x);
            }
            x
        }
        ContactLevel::Velocity => {
            let scheme = &step.model.scheme;
            let rate = scheme.velocity_rate(step.dt);
            let start = relative_velocity(step, map, &step.now.v);
            let mut x = relative_velocity(step, map, v);
            for (k, c) in map.contacts.iter().enumerate() {
                let n = cone.normal(k);
                // A contact that parts and is pressed all the same may not close further in the step: held at the speed
                // with which it parts, it would be pushed along its way, and its force would make energy.
                x[n] += match start[n] {
                    closing if closing < 0.0 => {
                        step.model.interfaces[c.interface].restitution * closing
                    }
                    parting => scheme.start_weight() * parting,
                };
            }
            x.iter_mut().for_each(|x| *x /= rate);
            x
        }
    }
}

/// Lets friction act on the slip of the step where `turned` says so, instead of on the end velocity; `x` is
/// [`local_variable`] at the velocity level \[m\].
pub(crate) fn turn_slips(
    step: &StepProblem<'_>,
    map: &ContactMap,
    turned: &[bool],
    u: &[f64],
    x: &mut [f64],
) {
    if !turned.contains(&true) {
        return;
    }
    let cone = map.cone();
    let moved = relative_displacement(step, map, u);
    for k in (0..map.len()).filter(|k| turned[*k]) {
        x[cone.tangents(k)].copy_from_slice(&moved[cone.tangents(k)]);
    }
}

/// An open bond that turns as a whole does not slip: the node goes round with the normal, `g_0 (n_1 - n_0)`.
fn take_off_turn(step: &StepProblem<'_>, cone: Cone, contact: &Contact, x: &mut [f64]) {
    if step.model.interfaces[contact.interface].adhesion.is_none() {
        return;
    }
    let Some(before) = step.now.contact(contact.key()) else {
        return;
    };
    for (x, axis) in x[cone.tangents(0)].iter_mut().zip(cone.axes()) {
        let turn = contact.frame.column(*axis).dot(&before.frame.column(2));
        *x += before.gap.max(0.0) * turn;
    }
}

/// Displacement of the slave relative to the master in the step, in local frames \[m\].
pub(crate) fn relative_displacement(
    step: &StepProblem<'_>,
    map: &ContactMap,
    u: &[f64],
) -> Vec<f64> {
    relative(map, &difference(u, &step.now.u), 1.0)
}

/// Velocity of the slave relative to the master, in local frames \[m/s\].
pub(crate) fn relative_velocity(step: &StepProblem<'_>, map: &ContactMap, v: &[f64]) -> Vec<f64> {
    relative(map, v, 1.0 / step.dt)
}

/// `H w` minus `obstacle` times the obstacle's displacement in the step.
fn relative(map: &ContactMap, w: &[f64], obstacle: f64) -> Vec<f64> {
    let mut x = vec![0.0; map.row_count()];
    let mut offset = x.clone();
    map.apply(w, &mut x);
    map.slip_offsets(&mut offset);
    let rows = x.iter_mut().zip(&offset);
    rows.for_each(|(x, o)| *x += obstacle * o);
    x
}
