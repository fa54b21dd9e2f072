//! The energy audit of a step: every term by its own formula.

use contact_bipotential::Cone;
use nalgebra::Vector3;

use crate::flat::{difference, dot};
use crate::local::{relative_displacement, relative_velocity};
use crate::newton_iterate::NewtonIterate;
use crate::report::EnergyTerms;
use crate::scheme::{ContactLevel, Inertia};
use crate::state::ContactState;
use crate::step_problem::StepProblem;

/// What the audit needs besides the iterate.
pub(crate) struct Accepted<'a> {
    /// Forces of supports and driven boundaries \[N\].
    pub(crate) support_force: &'a [f64],
    /// Displacement of each contact in the step, in its frame \[m\].
    pub(crate) moved: &'a [f64],
    /// State of each contact.
    pub(crate) contacts: &'a [ContactState],
    /// Free energy of all bonds \[J\].
    pub(crate) adhesive_energy: f64,
}

/// Energy terms of an accepted step. With `du` the displacement of the step, the force balance times `du` gives the
/// energy equation of the step.
pub(crate) fn audit(
    step: &StepProblem<'_>,
    iterate: &NewtonIterate,
    end: &Accepted<'_>,
) -> EnergyTerms {
    let mut terms = bulk_terms(step, iterate, end.support_force);
    contact_terms(step, iterate, end.moved, end.contacts, &mut terms);
    bond_terms(step, iterate, end.adhesive_energy, &mut terms);
    terms
}

/// Energy that friction may make in a step, over what is stored \[-\]: in the hundreds of steps of a run together no
/// more than what a run is allowed, and so much that it is rare.
const NO_WORK: f64 = 1e-6;

/// Marks the contacts that make energy by friction, where friction in sum does at a converged iterate; true if there is
/// a new one.
pub(crate) fn mark_turned(step: &StepProblem<'_>, iterate: &mut NewtonIterate) -> bool {
    let cone = iterate.map.cone();
    if cone == Cone::Frictionless || iterate.r.iter().all(|r| *r == 0.0) {
        return false;
    }
    let moved = relative_displacement(step, &iterate.map, &iterate.u);
    let work = |k: usize| dot(&iterate.r[cone.tangents(k)], &moved[cone.tangents(k)]);
    let works: Vec<f64> = (0..iterate.map.len()).map(work).collect();
    let stored = step.now.kinetic_energy + step.now.strain_energy.abs();
    if works.iter().sum::<f64>() <= NO_WORK * stored {
        return false;
    }
    iterate.turned.resize(works.len(), false);
    let mut is_new = false;
    for (turned, work) in iterate.turned.iter_mut().zip(works) {
        is_new |= work > 0.0 && !*turned;
        *turned |= work > 0.0;
    }
    is_new
}

/// Everything but contact.
fn bulk_terms(
    step: &StepProblem<'_>,
    iterate: &NewtonIterate,
    support_force: &[f64],
) -> EnergyTerms {
    let (model, now) = (step.model, step.now);
    let xi = step.weights.stiffness;
    let du = difference(&iterate.u, &now.u);
    let used = |start: &[f64], end: &[f64]| (1.0 - xi) * dot(&du, start) + xi * dot(&du, end);
    let strain = iterate.strain_energy - now.strain_energy;
    let mut terms = EnergyTerms {
        strain,
        load_work: used(&now.external_force, &step.external_force) + dot(&du, support_force),
        damping: used(&step.start_damping, &iterate.damping_force),
        bulk_error: used(&now.internal_force, &iterate.internal_force) - strain,
        ..EnergyTerms::default()
    };
    if model.scheme.inertia == Inertia::Dynamic {
        let jump = difference(&iterate.v, &now.v);
        let mut momentum = vec![0.0; jump.len()];
        model.mass.times(&jump, &mut momentum);
        terms.kinetic = model.kinetic_energy(&iterate.v) - now.kinetic_energy;
        terms.scheme_error = (0..du.len())
            .map(|i| (du[i] / step.dt - 0.5 * (now.v[i] + iterate.v[i])) * momentum[i])
            .sum();
    }
    terms
}

/// Friction, impact, curved gaps, and the work of moving obstacles.
fn contact_terms(
    step: &StepProblem<'_>,
    iterate: &NewtonIterate,
    moved: &[f64],
    contacts: &[ContactState],
    terms: &mut EnergyTerms,
) {
    let cone = iterate.map.cone();
    let velocity = match step.model.scheme.contact {
        ContactLevel::Velocity => mean_velocity(step, iterate),
        ContactLevel::Position => Vec::new(),
    };
    for (k, c) in iterate.map.contacts.iter().enumerate() {
        let r = iterate.force(k);
        let dx = cone.spatial(&moved[cone.range(k)]);
        let bond = contacts[k].bond.map_or(Vector3::zeros(), |bond| bond.force);
        let slip = contacts[k].slip;
        terms.load_work += contacts[k].global_force().dot(&c.obstacle_motion);
        terms.friction -= (r[0] - bond[0]) * slip[0] + (r[1] - bond[1]) * slip[1];
        match step.model.scheme.contact {
            ContactLevel::Velocity => {
                let way = impact_way(
                    step,
                    velocity[cone.normal(k)],
                    contacts[k].normal_velocity,
                    dx[2],
                );
                terms.impact -= r[2] * way;
                terms.gap_error += r[2] * (way - dx[2]);
            }
            ContactLevel::Position => {
                let before = step.now.contact(c.key());
                let closing = before.map_or(c.gap - dx[2], |b| b.gap) - c.gap;
                let loss = (r[2] - bond[2]) * closing;
                if is_press_fit(step, closing) {
                    terms.load_work -= loss;
                } else {
                    terms.impact += loss;
                }
                let told = r[0] * slip[0] + r[1] * slip[1] - r[2] * closing;
                terms.gap_error += told - r.dot(&dx);
                // What the bond is told about its start and where the pair started may differ for a new pair.
                terms.bond_error += bond[2] * (closing - bond_closing(iterate, k));
            }
        }
    }
}

/// Whether a contact that opens by `-closing` \[m\] takes out an overlap of the start of an equilibrium path: a press
/// fit, whose work comes from outside.
fn is_press_fit(step: &StepProblem<'_>, closing: f64) -> bool {
    let is_still = step.model.scheme.inertia == Inertia::QuasiStatic;
    is_still && step.now.last_dt.is_none() && closing < 0.0
}

/// Way of an impulse \[m\], from the mean normal velocity of the step, that at its end and the displacement `dx`: it
/// works on the mean of the velocities before and after it, whatever way the scheme takes. A contact that parted at the
/// start has no impact, and its force works on the displacement.
fn impact_way(step: &StepProblem<'_>, mean: f64, end: f64, dx: f64) -> f64 {
    let start = 2.0 * mean - end;
    if start < 0.0 { step.dt * mean } else { dx }
}

/// Mean of the relative velocities before and after the step, in the frames of the contacts \[m/s\].
fn mean_velocity(step: &StepProblem<'_>, iterate: &NewtonIterate) -> Vec<f64> {
    let ends = step.now.v.iter().zip(&iterate.v);
    let mean: Vec<f64> = ends.map(|(a, b)| 0.5 * (a + b)).collect();
    relative_velocity(step, &iterate.map, &mean)
}

/// How far a contact closed since the start that its bond remembers \[m\].
fn bond_closing(iterate: &NewtonIterate, k: usize) -> f64 {
    let gap = iterate.map.contacts[k].gap.max(0.0);
    iterate.bonds.get(k).map_or(0.0, |b| b.start().gap - gap)
}

/// Adhesive energy, dissipation and integration error of the bonds. Bonds of pairs that the search has lost
/// are gone; what they stored counts as an error of the integration.
fn bond_terms(
    step: &StepProblem<'_>,
    iterate: &NewtonIterate,
    adhesive: f64,
    terms: &mut EnergyTerms,
) {
    terms.adhesive = adhesive - step.now.adhesive_energy;
    terms.bond_error -= terms.adhesive;
    for (k, bond) in iterate.bonds.iter().enumerate() {
        let energy = bond.energy(&iterate.local(k));
        terms.bond += energy.dissipated;
        terms.bond_error += energy.work - energy.dissipated;
    }
}
