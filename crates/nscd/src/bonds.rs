//! Bonds from step to step: what a slave node remembers, turned with its master's material.

use contact_bipotential::{
    Adhesion, Bond, BondStep, Contact, ContactKey, ContactMap, Interface, Master, material_frame,
};
use nalgebra::{Matrix3, Vector3};

use crate::error::{NscdError, StepFailure};
use crate::flat::round_off;
use crate::memory::ContactMemory;
use crate::model::Model;
use crate::newton_iterate::NewtonIterate;
use crate::scheme::ContactLevel;
use crate::state::{NodeBond, State};
use crate::step_problem::StepProblem;

/// How far an adhesive interface is searched at least, in gaps at which bonds start to break \[-\].
const LEAST_REACH: f64 = 3.0;
/// How far an adhesive interface is searched, in gaps of its bonds that hold: for what they may open in a step \[-\].
const OPENING: f64 = 2.0;
/// Least `1 + cos` of the angle between two normals for which there is a shortest way to turn one to the other \[-\].
const OPPOSITE: f64 = 1e-3;

/// Bonds know gaps and separations, velocity-level contact knows neither.
pub(crate) fn refuse_velocity_level(model: &Model) -> Result<(), NscdError> {
    let mut adhesive = model.interfaces.iter().filter(|i| i.adhesion.is_some());
    match (model.scheme.contact, adhesive.next()) {
        (ContactLevel::Velocity, Some(interface)) => Err(NscdError::AdhesionAtVelocity {
            interface: interface.name.clone(),
        }),
        _ => Ok(()),
    }
}

/// Free energy of all bonds \[J\].
pub(crate) fn adhesive_energy(model: &Model, bonds: &[Vec<NodeBond>]) -> f64 {
    let of_interface = |(interface, bonds): (&Interface, &Vec<NodeBond>)| -> f64 {
        let Some(law) = &interface.adhesion else {
            return 0.0;
        };
        let each = bonds.iter().zip(&interface.area);
        each.map(|(bond, area)| bond.with(bond.separation).energy(law, *area))
            .sum()
    };
    model.interfaces.iter().zip(bonds).map(of_interface).sum()
}

/// The bond of every contact of a map over the step; empty where no interface has adhesion.
pub(crate) fn bond_steps(step: &StepProblem<'_>, map: &ContactMap, u: &[f64]) -> Vec<BondStep> {
    let model = step.model;
    if model.interfaces.iter().all(|i| i.adhesion.is_none()) {
        return Vec::new();
    }
    let positions = model.positions(u);
    let roundoff = round_off(&positions);
    let one = |c: &Contact| {
        let interface = &model.interfaces[c.interface];
        let Some(law) = &interface.adhesion else {
            return BondStep::none();
        };
        let node = &step.now.bonds[c.interface][c.slave_index];
        let separation = if node.separation == [0.0; 2] {
            [0.0; 2]
        } else {
            let axes = stored_axes(step, c, node, &positions);
            turned(node.separation, &axes, &c.frame)
        };
        let area = interface.area[c.slave_index];
        if area == 0.0 {
            return BondStep::none();
        }
        BondStep::new(law, area, step.dt, node.with(separation), roundoff)
    };
    map.contacts.iter().map(one).collect()
}

/// The axes of what a bond remembers, where the master's material has taken them by the end of the step. On an obstacle
/// they were the frame of the contact: any other normal to which the separation were turned could lie far from the
/// contact's, and on the way there and back by another normal a vector turns about both.
fn stored_axes(
    step: &StepProblem<'_>,
    contact: &Contact,
    node: &NodeBond,
    positions: &[f64],
) -> Matrix3<f64> {
    let interface = &step.model.interfaces[contact.interface];
    let dim = step.model.solid.dim();
    let axes = |t| material_frame(interface, node.facet, positions, dim, t);
    let (then, end) = (axes(step.now.time), axes(step.end()));
    let before = step.now.contact(contact.key());
    match (&interface.master, before) {
        (Master::Obstacle(_), Some(before)) => end * then.tr_mul(&before.frame),
        _ => end,
    }
}

/// A tangential vector with components in the axes `from` (two tangents and their normal), in the axes `to`: turned
/// with the normal the shortest way, so that there and back is nothing.
fn turned(components: [f64; 2], from: &Matrix3<f64>, to: &Matrix3<f64>) -> [f64; 2] {
    let v = from * Vector3::new(components[0], components[1], 0.0);
    let axis = from.column(2).cross(&to.column(2));
    let cosine = from.column(2).dot(&to.column(2));
    // Opposite normals have no shortest way; such a pair has nothing to do with the one before.
    let scale = 1.0 / (1.0 + cosine).max(OPPOSITE);
    let once = axis.cross(&v);
    let twice = axis.cross(&once);
    let turned = to.tr_mul(&(v + once + scale * twice));
    [turned[0], turned[1]]
}

/// What every slave node remembers after the step. A pair that the search has lost is a new one when it meets again.
pub(crate) fn bonds_after(
    step: &StepProblem<'_>,
    iterate: &NewtonIterate,
    positions: &[f64],
) -> Vec<Vec<NodeBond>> {
    let (model, dim) = (step.model, step.model.solid.dim());
    let mut bonds: Vec<Vec<NodeBond>> = no_bonds(model);
    let contacts = iterate.map.contacts.iter().zip(&iterate.bonds);
    for (k, (c, bond)) in contacts.enumerate() {
        let interface = &model.interfaces[c.interface];
        if interface.adhesion.is_none() || interface.area[c.slave_index] == 0.0 {
            continue;
        }
        let end = bond.finish(&iterate.local(k));
        let axes = match interface.master {
            Master::Obstacle(_) => c.frame,
            Master::Surface(_) => material_frame(interface, c.facet, positions, dim, step.end()),
        };
        bonds[c.interface][c.slave_index] = NodeBond {
            intensity: end.intensity,
            gap: end.gap,
            separation: turned(end.separation, &c.frame, &axes),
            facet: c.facet,
        };
    }
    bonds
}

fn no_bonds(model: &Model) -> Vec<Vec<NodeBond>> {
    let interfaces = model.interfaces.iter();
    interfaces
        .map(|i| match i.adhesion {
            Some(_) => vec![NodeBond::default(); i.slave.len()],
            None => Vec::new(),
        })
        .collect()
}

/// How far the search has to reach as bonds hold, of each adhesive interface \[m\].
pub(crate) fn reaches(model: &Model, now: &State) -> Vec<(usize, f64)> {
    let adhesive = model.interfaces.iter().enumerate();
    let adhesive = adhesive.filter_map(|(k, i)| Some((k, i.adhesion.as_ref()?)));
    let reach = |(k, law): (usize, &Adhesion)| {
        let bonds = now.bonds[k].iter();
        let holding = bonds.filter(|b| b.with(b.separation).holds(law));
        let least = LEAST_REACH * law.damage_gap();
        (k, holding.fold(least, |m, b| m.max(OPENING * b.gap)))
    };
    adhesive.map(reach).collect()
}

/// How many bonds held before the step and have lost their pair in the search.
pub(crate) fn lost_bonds(model: &Model, now: &State, map: &ContactMap) -> u64 {
    let mut lost = 0;
    for (k, interface) in model.interfaces.iter().enumerate() {
        let Some(law) = &interface.adhesion else {
            continue;
        };
        for (slave_index, bond) in now.bonds[k].iter().enumerate() {
            let key = ContactKey::new(k, slave_index);
            if bond.with(bond.separation).holds(law) && map.find(key).is_none() {
                lost += 1;
            }
        }
    }
    lost
}

/// The bonds at the start, given the contacts there: those of touching pairs have the initial intensity, at most what
/// their gap leaves where intensities follow it at once.
pub(crate) fn initial_bonds(
    model: &Model,
    positions: &[f64],
    contacts: &[Contact],
) -> Vec<Vec<NodeBond>> {
    let mut bonds = no_bonds(model);
    let roundoff = round_off(positions);
    for c in contacts {
        let interface = &model.interfaces[c.interface];
        let Some(law) = &interface.adhesion else {
            continue;
        };
        // A node without area has no bond.
        if interface.area[c.slave_index] == 0.0 {
            continue;
        }
        let bond = &mut bonds[c.interface][c.slave_index];
        bond.gap = c.gap.max(0.0);
        bond.facet = c.facet;
        if BondStep::new(law, 1.0, 0.0, Bond::default(), roundoff).touches(c.gap) {
            bond.intensity = law.initial.min(law.lasting(bond.gap));
        }
    }
    bonds
}

/// A converged step is not believed where another end of it may satisfy the law too.
pub(crate) fn refuse_snap(
    step: &StepProblem<'_>,
    iterate: &NewtonIterate,
    memory: &ContactMemory,
) -> Result<(), StepFailure> {
    for (k, (c, bond)) in iterate.map.contacts.iter().zip(&iterate.bonds).enumerate() {
        if bond.may_snap(&iterate.local(k), memory.local_stiffness(c)) {
            return Err(StepFailure::Snap {
                contact: step.model.place(c),
                dt: step.dt,
            });
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use contact_bipotential::FrameRule;
    use proptest::prelude::*;

    use super::*;

    proptest! {
        /// A bond that is carried to the master's axes and back, step after step, keeps length and direction.
        #[test]
        fn there_and_back_is_nothing(
            from in prop::array::uniform3(-1.0..1.0_f64), tilt in prop::array::uniform3(-0.4..0.4_f64), v in prop::array::uniform2(-1.0..1.0_f64),
        ) {
            let (from, tilt) = (Vector3::from(from), Vector3::from(tilt));
            prop_assume!(from.norm() > 0.5 && (from + tilt).norm() > 0.5);
            let (n, m) = (from.normalize(), (from + tilt).normalize());
            let (from, to) = (FrameRule::spatial(n).at(n), FrameRule::spatial(m).at(m));
            let mut back = v;
            for _ in 0..100 {
                let there = turned(back, &from, &to);
                prop_assert!((there[0].hypot(there[1]) - v[0].hypot(v[1])).abs() < 1e-12);
                back = turned(there, &to, &from);
            }
            prop_assert!((back[0] - v[0]).abs() < 1e-11 && (back[1] - v[1]).abs() < 1e-11, "{v:?} {back:?}");
        }
    }
}
