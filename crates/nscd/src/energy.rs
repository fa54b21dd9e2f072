//! The end of a step: energy audit, forces of interfaces and supports, new state.

use contact_bipotential::local::local_axes;

use nalgebra::Vector3;

use crate::bonds::{adhesive_energy, carry_on};
use crate::law::{in_frame, relative_displacement, relative_velocity, state_before};
use crate::model::point;
use crate::monitor::Check;
use crate::report::{EnergyTerms, Resultant, StepReport};
use crate::scheme::{ContactLevel, Inertia};
use crate::state::{BondState, ContactState, ContactStatus, State};
use crate::stepper::Stepper;
use crate::trial::{StepFrame, Trial};

impl Stepper<'_> {
    /// Turns a converged iterate into the next state and its report. `unforeseen` is the deepest penetration of all nodes \[m\].
    pub(crate) fn accept(
        &mut self,
        frame: &StepFrame<'_>,
        trial: Trial,
        check: &Check,
        unforeseen: f64,
    ) -> (State, StepReport) {
        let model = frame.model;
        let support_force: Vec<f64> = (0..trial.u.len())
            .map(|i| {
                if self.fixed[i] {
                    -(trial.balance[i] + trial.contact_force[i])
                } else {
                    0.0
                }
            })
            .collect();
        let cone = self.memory.cone;
        let moved = relative_displacement(frame, &trial.map, &trial.u);
        let contacts = contact_states(frame, &trial, &moved, cone);
        let mut energy = bulk_terms(frame, &trial, &support_force);
        contact_terms(frame, &trial, &moved, &contacts, cone, &mut energy);
        let positions = model.positions(&trial.u);
        let bonds = carry_on(frame, &trial, &positions);
        self.count_lost_bonds(frame.now, &trial.map);
        let adhesive = adhesive_energy(model, &bonds);
        bond_terms(frame, &trial, adhesive, &mut energy);
        // A gap of the size of the round-off of the positions is closed, with or without a force.
        let touching = 64.0 * f64::EPSILON * positions.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
        let report = StepReport {
            time: frame.end(),
            dt: frame.dt,
            newton_iterations: check.iteration,
            residual: check.relative_residual(),
            contact_error: check.contact_error,
            contacts_closed: contacts
                .iter()
                .filter(|c| c.status != ContactStatus::Open || c.gap <= touching)
                .count(),
            penetration: contacts.iter().map(|c| -c.gap).fold(unforeseen, f64::max),
            energy,
            interfaces: interface_resultants(
                model.interfaces.len(),
                &contacts,
                &positions,
                model.solid.dim(),
            ),
            supports: self.support_resultants(&support_force, &positions),
        };
        let state = State {
            time: frame.end(),
            kinetic_energy: model.kinetic_energy(&trial.v),
            u: trial.u,
            v: trial.v,
            internal_force: trial.internal_force,
            external_force: frame.external_force.clone(),
            strain_energy: trial.strain_energy,
            support_force,
            contact_force: trial.contact_force,
            contacts,
            bonds,
            adhesive_energy: adhesive,
            last_dt: Some(frame.dt),
            u_before: frame.now.u.clone(),
        };
        (state, report)
    }

    /// Force and moment of each support; a dof named twice counts for the later one.
    fn support_resultants(&self, force: &[f64], positions: &[f64]) -> Vec<Resultant> {
        let dim = self.model().solid.dim();
        let mut owner = vec![usize::MAX; force.len()];
        for (s, support) in self.model().supports.iter().enumerate() {
            for &node in &support.nodes {
                (0..dim)
                    .filter(|&c| support.components[c])
                    .for_each(|c| owner[dim * node as usize + c] = s);
            }
        }
        let mut sums = vec![Resultant::default(); self.model().supports.len()];
        for node in 0..force.len() / dim {
            for c in 0..dim {
                let dof = dim * node + c;
                if let Some(sum) = sums.get_mut(owner[dof]) {
                    let mut f = [0.0; 3];
                    f[c] = force[dof];
                    sum.add(f, point(positions, dim, node as u32));
                }
            }
        }
        sums
    }
}

impl Resultant {
    fn add(&mut self, f: [f64; 3], at: [f64; 3]) {
        let m = [
            at[1] * f[2] - at[2] * f[1],
            at[2] * f[0] - at[0] * f[2],
            at[0] * f[1] - at[1] * f[0],
        ];
        for i in 0..3 {
            self.force[i] += f[i];
            self.moment[i] += m[i];
        }
    }
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// Everything but contact. With `du` the displacement of the step, the force balance times `du`
/// gives the energy equation of the step; each term is evaluated by its own formula.
fn bulk_terms(frame: &StepFrame<'_>, trial: &Trial, support_force: &[f64]) -> EnergyTerms {
    let (model, now) = (frame.model, frame.now);
    let xi = frame.weights.stiffness;
    let du: Vec<f64> = trial.u.iter().zip(&now.u).map(|(a, b)| a - b).collect();
    let used = |start: &[f64], end: &[f64]| (1.0 - xi) * dot(&du, start) + xi * dot(&du, end);
    let strain = trial.strain_energy - now.strain_energy;
    let mut terms = EnergyTerms {
        strain,
        load_work: used(&now.external_force, &frame.external_force) + dot(&du, support_force),
        damping: used(&frame.start_damping, &trial.damping_force),
        bulk_error: used(&now.internal_force, &trial.internal_force) - strain,
        ..EnergyTerms::default()
    };
    if model.scheme.inertia == Inertia::Dynamic {
        let jump: Vec<f64> = trial.v.iter().zip(&now.v).map(|(a, b)| a - b).collect();
        let mut momentum = vec![0.0; jump.len()];
        model.mass.times(&jump, &mut momentum);
        terms.kinetic = model.kinetic_energy(&trial.v) - now.kinetic_energy;
        terms.scheme_error = (0..du.len())
            .map(|i| (du[i] / frame.dt - 0.5 * (now.v[i] + trial.v[i])) * momentum[i])
            .sum();
    }
    terms
}

/// Friction, impact, curved gaps, and the work of moving obstacles.
fn contact_terms(
    frame: &StepFrame<'_>,
    trial: &Trial,
    moved: &[f64],
    contacts: &[ContactState],
    cone: usize,
    terms: &mut EnergyTerms,
) {
    let velocity = match frame.model.scheme.contact {
        ContactLevel::Velocity => mean_velocity(frame, trial),
        ContactLevel::Position => Vec::new(),
    };
    for (k, c) in trial.map.contacts.iter().enumerate() {
        let r = in_frame(&trial.r[cone * k..cone * (k + 1)]);
        let dx = in_frame(&moved[cone * k..cone * (k + 1)]);
        let bond = contacts[k].bond.map_or(Vector3::zeros(), |bond| bond.force);
        let slip = contacts[k].slip;
        terms.load_work += contacts[k].global_force().dot(&c.obstacle_motion);
        terms.friction -= (r[0] - bond[0]) * slip[0] + (r[1] - bond[1]) * slip[1];
        match frame.model.scheme.contact {
            ContactLevel::Velocity => {
                // An impulse works on the mean of the velocities before and after it, whatever way the scheme takes.
                let way = frame.dt * velocity[cone * (k + 1) - 1];
                terms.impact -= r[2] * way;
                terms.gap_error += r[2] * (way - dx[2]);
            }
            ContactLevel::Position => {
                let before = state_before(frame.now, c.key());
                let closing = before.map_or(c.gap - dx[2], |b| b.gap) - c.gap;
                terms.impact += (r[2] - bond[2]) * closing;
                let told = r[0] * slip[0] + r[1] * slip[1] - r[2] * closing;
                terms.gap_error += told - dot(&r, &dx);
                // What the bond is told about its start and where the pair started may differ for a new pair.
                terms.bond_error += bond[2] * (closing - bond_closing(trial, k));
            }
        }
    }
}

/// Mean of the relative velocities before and after the step, in the frames of the contacts \[m/s\].
fn mean_velocity(frame: &StepFrame<'_>, trial: &Trial) -> Vec<f64> {
    let ends = frame.now.v.iter().zip(&trial.v);
    let mean: Vec<f64> = ends.map(|(a, b)| 0.5 * (a + b)).collect();
    relative_velocity(frame, &trial.map, &mean)
}

/// How far a contact closed since the start that its bond remembers \[m\].
fn bond_closing(trial: &Trial, k: usize) -> f64 {
    let gap = trial.map.contacts[k].gap.max(0.0);
    trial.bonds.get(k).map_or(0.0, |b| b.start().gap - gap)
}

/// Adhesive energy, dissipation and integration error of the bonds. Bonds of pairs that the search has lost
/// are gone; what they stored counts as an error of the integration.
fn bond_terms(frame: &StepFrame<'_>, trial: &Trial, adhesive: f64, terms: &mut EnergyTerms) {
    terms.adhesive = adhesive - frame.now.adhesive_energy;
    terms.bond_error -= terms.adhesive;
    let cone = trial.map.cone().dim();
    for (bond, x) in trial.bonds.iter().zip(trial.x.chunks_exact(cone)) {
        let energy = bond.energy(&in_frame(x));
        terms.bond += energy.dissipated;
        terms.bond_error += energy.work - energy.dissipated;
    }
}

fn contact_states(
    frame: &StepFrame<'_>,
    trial: &Trial,
    moved: &[f64],
    cone: usize,
) -> Vec<ContactState> {
    let force_scale = trial.r.iter().fold(0.0_f64, |m, r| m.max(r.abs()));
    let velocity = relative_velocity(frame, &trial.map, &trial.v);
    let contacts = trial.map.contacts.iter().enumerate();
    contacts
        .map(|(k, c)| {
            let (mut force, mut motion) = (Vector3::zeros(), [0.0; 3]);
            for (i, &axis) in local_axes(cone).iter().enumerate() {
                force[axis] = trial.r[cone * k + i];
                motion[axis] = moved[cone * k + i];
            }
            let mut mu = frame.model.interfaces[c.interface].mu;
            let adhesive = frame.model.interfaces[c.interface].adhesion.is_some();
            let x = in_frame(&trial.x[cone * k..cone * (k + 1)]);
            if frame.model.scheme.contact == ContactLevel::Position {
                motion = x;
            }
            let bond = trial.bonds.get(k).filter(|_| adhesive).map(|bond| {
                let at = bond.at(&x);
                mu = bond.friction(mu, at.intensity);
                BondState {
                    intensity: at.intensity,
                    separation: bond.finish(&x).separation,
                    force: at.force.into(),
                }
            });
            let dry = force - bond.map_or(Vector3::zeros(), |bond| bond.force);
            let on_cone = dry[0].hypot(dry[1]) >= mu * dry[2] * (1.0 - 1e-9);
            let status = if dry[2] <= 1e-12 * force_scale {
                ContactStatus::Open
            } else if on_cone {
                ContactStatus::Slip
            } else {
                ContactStatus::Stick
            };
            ContactState {
                interface: c.interface,
                slave_index: c.slave_index,
                node: c.slave,
                gap: c.gap,
                normal_velocity: velocity[cone * k + cone - 1],
                slip: [motion[0], motion[1]],
                force,
                frame: c.frame,
                status,
                bond,
            }
        })
        .collect()
}

fn interface_resultants(
    count: usize,
    contacts: &[ContactState],
    positions: &[f64],
    dim: usize,
) -> Vec<Resultant> {
    let mut sums = vec![Resultant::default(); count];
    for c in contacts {
        sums[c.interface].add(c.global_force().into(), point(positions, dim, c.node));
    }
    sums
}
