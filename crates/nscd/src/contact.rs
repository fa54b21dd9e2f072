//! The contact side of a step: candidates, local problem, what is remembered.

use contact_bipotential::local::local_axes;
use contact_bipotential::solve::frozen;
use contact_bipotential::{
    BondStep, CompliancePart, Cone, Contact, ContactKey, ContactMap, ContactProblem, Delassus,
    Interface, SequenceSolver, SolveSettings,
};
use faer::Mat;

use crate::body::BodySystem;
use crate::error::StepFailure;
use crate::held::{held, take_out};
use crate::law::in_frame;
use crate::model::Model;
use crate::report::Counters;
use crate::scheme::ContactLevel;
use crate::state::State;
use crate::stepper::Stepper;
use crate::trial::{StepFrame, Trial};

/// Depth over the search distance that a contact on a rim may have although it is given up for the step \[-\].
const RIM_DEPTH: f64 = 1e-6;

/// What to try where bonds of a surface may catch or let go all at once.
const SNAP_ADVICE: &str = "try smaller steps; where bonds catch or let go all at once there is no equilibrium on the way, but with some \
                           viscosity b of the bonds or inertia of the bodies there is a motion";

/// What the contact solve remembers from iteration to iteration and from step to step. Nothing
/// here decides a result: forces are a warm start, scales only weigh an error.
#[derive(Debug)]
pub(crate) struct ContactMemory {
    /// Force of each slave node of each interface, `cone` entries each \[N\].
    forces: Vec<Vec<f64>>,
    /// `1 / trace W_cc` of each slave node of each interface [N/m].
    pub(crate) stiffness: Vec<Vec<f64>>,
    /// How often in this step the search lost a pressed slave node.
    lost: Vec<Vec<u8>>,
    /// Entries of a local vector.
    pub(crate) cone: usize,
    solver: SequenceSolver,
    kept: Option<KeptOperator>,
    /// The kept problem was solved in the present step.
    solved: bool,
    /// Factorizations of the bodies that the present contact problem stands on.
    epochs: Vec<u64>,
}

impl ContactMemory {
    pub(crate) fn new(model: &Model) -> Self {
        let cone = cone_of(model).dim();
        let sized = |k: usize| {
            model
                .interfaces
                .iter()
                .map(|i| vec![0.0; k * i.slave.len()])
                .collect()
        };
        Self {
            forces: sized(cone),
            stiffness: sized(1),
            lost: model
                .interfaces
                .iter()
                .map(|i| vec![0; i.slave.len()])
                .collect(),
            cone,
            solver: SequenceSolver::default(),
            kept: None,
            solved: false,
            epochs: Vec::new(),
        }
    }

    /// The remembered force of every contact of a map.
    pub(crate) fn recall(&self, map: &ContactMap) -> Vec<f64> {
        let cone = self.cone;
        map.contacts
            .iter()
            .flat_map(|c| {
                &self.forces[c.interface][cone * c.slave_index..cone * (c.slave_index + 1)]
            })
            .copied()
            .collect()
    }

    /// A node on the rim of a master can be lost by the search in one iteration and found in the
    /// next, for ever. One that was lost twice while pressed stays lost for the step; the deepest of those that are back is
    /// returned, for a step must not end with it.
    pub(crate) fn settle_rims(&mut self, map: ContactMap) -> (ContactMap, Option<Contact>) {
        let cone = self.cone;
        for (interface, forces) in self.forces.iter().enumerate() {
            for (slave_index, r) in forces.chunks_exact(cone).enumerate() {
                let key = ContactKey::new(interface, slave_index);
                if r[cone - 1] > 0.0 && map.find(key).is_none() {
                    let lost = &mut self.lost[interface][slave_index];
                    *lost = lost.saturating_add(1);
                }
            }
        }
        let stays = |c: &Contact| self.lost[c.interface][c.slave_index] < 2;
        let back = map.contacts.iter().filter(|c| !stays(c));
        let deepest = back.min_by(|a, b| a.gap.total_cmp(&b.gap)).copied();
        (filtered(&map, |_, c| stays(c)), deepest)
    }

    /// Refuses the end of a step at which a contact that was given up lies in its master.
    pub(crate) fn refuse_unsettled(
        &self,
        frame: &StepFrame<'_>,
        trial: &Trial,
    ) -> Result<(), StepFailure> {
        let Some(contact) = trial.given_up else {
            return Ok(());
        };
        let reach = frame.model.interfaces[contact.interface].search_distance;
        if contact.gap >= -RIM_DEPTH * reach {
            return Ok(());
        }
        Err(StepFailure::Rim {
            contact: name_of(frame.model, &contact),
        })
    }

    /// Starts a step from the forces of the last accepted one.
    pub(crate) fn restore(&mut self, now: &State) {
        let cone = self.cone;
        self.clear();
        self.lost.iter_mut().for_each(|l| l.fill(0));
        self.solved = false;
        for c in &now.contacts {
            for (i, &axis) in local_axes(cone).iter().enumerate() {
                self.forces[c.interface][cone * c.slave_index + i] = c.force[axis];
            }
        }
    }

    /// Rows of the contacts that have a force.
    pub(crate) fn rows(&self) -> usize {
        let pressed = |f: &Vec<f64>| {
            f.chunks_exact(self.cone)
                .filter(|r| r[self.cone - 1] > 0.0)
                .count()
        };
        self.cone * self.forces.iter().map(pressed).sum::<usize>()
    }

    /// All remembered forces, one after the other.
    pub(crate) fn flat_forces(&self) -> impl Iterator<Item = f64> + '_ {
        self.forces.iter().flatten().copied()
    }

    /// Overwrites the forces in the order of [`Self::flat_forces`].
    pub(crate) fn set_flat_forces(&mut self, values: &[f64]) {
        self.forces
            .iter_mut()
            .flatten()
            .zip(values)
            .for_each(|(f, v)| *f = *v);
    }

    /// No contact has a force.
    pub(crate) fn clear(&mut self) {
        self.forces.iter_mut().for_each(|f| f.fill(0.0));
    }

    /// Remembers the forces of the given contacts; all others have none.
    pub(crate) fn store(&mut self, map: &ContactMap, r: &[f64]) {
        let cone = self.cone;
        self.clear();
        for (c, force) in map.contacts.iter().zip(r.chunks_exact(cone)) {
            self.forces[c.interface][cone * c.slave_index..cone * (c.slave_index + 1)]
                .copy_from_slice(force);
        }
    }
}

/// The local law: one row a contact where nothing rubs.
pub(crate) fn cone_of(model: &Model) -> Cone {
    let rubs = |i: &Interface| {
        let bonds = i.adhesion.as_ref();
        i.mu > 0.0 || bonds.is_some_and(|a| a.is_tangential() || a.bonded_friction > Some(0.0))
    };
    if !model.interfaces.iter().any(rubs) {
        Cone::Frictionless
    } else if model.solid.dim() == 2 {
        Cone::Planar
    } else {
        Cone::Spatial
    }
}

/// The contacts of a map that are kept.
pub(crate) fn filtered(map: &ContactMap, keep: impl Fn(usize, &Contact) -> bool) -> ContactMap {
    let kept = map
        .contacts
        .iter()
        .enumerate()
        .filter(|(k, c)| keep(*k, c))
        .map(|(_, c)| *c);
    ContactMap::new(kept.collect(), map.dim(), map.cone())
}

/// Which candidates have a bond or may form one: at the present gap, or at the `free` one that they would have without
/// forces. Bonds of neighbours may hold a surface so near that it stays within reach of its own.
fn acting(trial: &Trial, cone: usize, free: &[f64]) -> Vec<bool> {
    let one = |(k, bond): (usize, &BondStep)| {
        let normal = cone * k + cone - 1;
        bond.may_act(free[normal].min(trial.x[normal]))
    };
    trial.bonds.iter().enumerate().map(one).collect()
}

/// Which candidates enter the contact problem: those with a force or a bond, and those that the
/// correction brings near. The others are checked with their exact gap in the next iteration.
fn enters(model: &Model, trial: &Trial, cone: usize, free: &[f64], acts: &[bool]) -> Vec<bool> {
    let map = &trial.map;
    if model.scheme.contact == ContactLevel::Velocity {
        return vec![true; map.contacts.len()];
    }
    let near = |k: usize| {
        let interface = &model.interfaces[map.contacts[k].interface];
        free[cone * k + cone - 1] <= 0.25 * interface.search_distance
    };
    let bonded = |k: usize| acts.get(k).is_some_and(|acts| *acts);
    (0..map.contacts.len())
        .map(|k| near(k) || trial.r[cone * k + cone - 1] > 0.0 || bonded(k))
        .collect()
}

/// A contact between nodes that are driven on both sides has no compliance: no force of it can mend a penetration.
fn refuse_immovable(
    model: &Model,
    trial: &Trial,
    map: &ContactMap,
    w: &Mat<f64>,
    q: &[f64],
) -> Result<(), StepFailure> {
    let cone = map.cone().dim();
    let normal = |k: usize| cone * k + cone - 1;
    let closed = (0..map.len()).filter(|&k| w[(normal(k), normal(k))] == 0.0 && q[normal(k)] < 0.0);
    let deepest = closed.min_by(|a, b| q[normal(*a)].total_cmp(&q[normal(*b)]));
    let Some(deepest) = deepest else {
        return Ok(());
    };
    let positions = model.positions(&trial.u);
    let roundoff = 64.0 * f64::EPSILON * positions.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
    let depth = -q[normal(deepest)];
    if depth <= roundoff {
        return Ok(());
    }
    Err(StepFailure::Immovable {
        contact: describe(model, map, deepest),
        depth,
    })
}

/// The contact problem of one iteration: which forces, together with the residual, make the
/// linearised bodies obey the contact law.
#[derive(Debug)]
pub(crate) struct LinearisedContact {
    map: ContactMap,
    problem: ContactProblem,
    /// `W` before held directions were taken out of it; `None` where there are none.
    whole: Option<Mat<f64>>,
    /// One a contact, or none where no bond can act.
    bonds: Vec<BondStep>,
    /// Warm start.
    r: Vec<f64>,
}

impl LinearisedContact {
    /// Condenses the bodies and selects the contacts that matter.
    pub(crate) fn new(
        frame: &StepFrame<'_>,
        memory: &mut ContactMemory,
        bodies: &mut [BodySystem],
        trial: &Trial,
        counters: &mut Counters,
    ) -> Result<Self, StepFailure> {
        let (model, cone) = (frame.model, memory.cone);
        let mut z = vec![0.0; model.dof_count()];
        for body in bodies.iter_mut().filter(|b| b.has_candidates()) {
            body.condense(z.len(), counters)?;
            body.free_surface(&mut z);
        }
        let mut free = vec![0.0; trial.x.len()];
        trial.map.apply(&z, &mut free);
        free.iter_mut().zip(&trial.x).for_each(|(f, x)| *f += x);
        let acts = acting(trial, cone, &free);
        let keep = enters(model, trial, cone, &free, &acts);
        let map = filtered(&trial.map, |k, _| keep[k]);
        let select = |all: &[f64]| -> Vec<f64> {
            all.chunks_exact(cone)
                .zip(&keep)
                .filter(|(_, k)| **k)
                .flat_map(|(c, _)| c.iter().copied())
                .collect()
        };
        let mut w = memory.operator(&map, bodies);
        let mut q = select(&free);
        refuse_immovable(model, trial, &map, &w, &q)?;
        let held = held(&w, &q, cone);
        let whole = (!held.is_empty()).then(|| w.clone());
        take_out(&held, &mut w, &mut q, cone);
        let mu = map
            .contacts
            .iter()
            .map(|c| model.interfaces[c.interface].mu)
            .collect();
        let problem = ContactProblem {
            w: Delassus::Dense(w),
            q,
            mu,
            cone: map.cone(),
        };
        let kept = trial.bonds.iter().zip(&keep).filter(|(_, k)| **k);
        let mut bonds: Vec<BondStep> = kept.map(|(bond, _)| *bond).collect();
        if !acts.contains(&true) {
            bonds.clear();
        }
        Ok(Self {
            r: select(&trial.r),
            map,
            problem,
            whole,
            bonds,
        })
    }

    /// Solves it to the relative error `tolerance`, remembers the forces and returns `H^T r` \[N\].
    pub(crate) fn solve(
        mut self,
        model: &Model,
        tolerance: f64,
        memory: &mut ContactMemory,
        counters: &mut Counters,
    ) -> Result<Vec<f64>, StepFailure> {
        let settings = SolveSettings {
            tolerance,
            max_iterations: model.settings.contact_iterations,
            ..SolveSettings::default()
        };
        let solver = &mut memory.solver;
        let outcome = solver.solve(&self.problem, &self.bonds, &mut self.r, &settings);
        counters.contact_solves += 1;
        counters.bonded_solves += u64::from(!self.bonds.is_empty());
        counters.contact_iterations += outcome.iterations as u64;
        counters.contacts_max = counters.contacts_max.max(self.map.len() as u64);
        if outcome.error.max(outcome.error_scale_free)
            > tolerance.max(model.settings.contact_tolerance)
        {
            let errors = outcome.diagnostics.iter().enumerate();
            let worst = errors
                .max_by(|a, b| a.1.error.total_cmp(&b.1.error))
                .map_or(0, |(k, _)| k);
            return Err(StepFailure::Contact {
                contacts: self.map.len(),
                error: outcome.error_scale_free,
                method: format!("{:?}", outcome.method),
                advice: if self.bonds.is_empty() {
                    "try smaller steps"
                } else {
                    SNAP_ADVICE
                },
                contact: describe(model, &self.map, worst),
            });
        }
        let mut force = vec![0.0; model.dof_count()];
        self.map.apply_transpose(&self.r, &mut force);
        memory.store(&self.map, &self.r);
        memory.keep_operator(self, &outcome.u);
        Ok(force)
    }
}

/// `W` of the last contact problem: it holds as long as no frame, no stencil and no factor changed,
/// which is the rule between bodies and rigid planes.
#[derive(Debug)]
struct KeptOperator {
    contacts: Vec<Contact>,
    /// Factorizations of the bodies at the time.
    epochs: Vec<u64>,
    w: Mat<f64>,
    q: Vec<f64>,
    mu: Vec<f64>,
    bonds: Vec<BondStep>,
    /// Intensity of each bond.
    intensities: Vec<f64>,
}

impl ContactMemory {
    fn operator(&mut self, map: &ContactMap, bodies: &[BodySystem]) -> Mat<f64> {
        let epochs: Vec<u64> = bodies.iter().map(BodySystem::epoch).collect();
        self.epochs = epochs;
        if let Some(last) = self.kept.take()
            && last.epochs == self.epochs
            && same_operator(&last.contacts, &map.contacts)
        {
            return last.w;
        }
        let parts: Vec<&CompliancePart> = bodies.iter().filter_map(BodySystem::condensed).collect();
        let mut w = Mat::zeros(map.row_count(), map.row_count());
        map.delassus(&parts, &mut w);
        self.remember_stiffness(map, &w);
        w
    }

    fn keep_operator(&mut self, last: LinearisedContact, x: &[f64]) {
        if let Delassus::Dense(w) = last.problem.w {
            let w = last.whole.unwrap_or(w);
            let at = last.bonds.iter().zip(x.chunks_exact(self.cone));
            self.kept = Some(KeptOperator {
                contacts: last.map.contacts,
                epochs: self.epochs.clone(),
                w,
                q: last.problem.q,
                mu: last.problem.mu,
                intensities: at.map(|(b, x)| b.intensity(&in_frame(x)).0).collect(),
                bonds: last.bonds,
            });
            self.solved = true;
        }
    }

    fn remember_stiffness(&mut self, map: &ContactMap, w: &Mat<f64>) {
        for (k, c) in map.contacts.iter().enumerate() {
            let trace: f64 = (self.cone * k..self.cone * (k + 1))
                .map(|i| w[(i, i)])
                .sum();
            if trace > 0.0 {
                self.stiffness[c.interface][c.slave_index] = 1.0 / trace;
            }
        }
    }
}

impl Stepper<'_> {
    /// The contact problem of the last iteration that had one in the last step [m, N], a copy; `None` where nothing touched.
    /// With bonds it is the problem that they leave for the dry forces.
    pub fn last_contact_problem(&self) -> Option<ContactProblem> {
        let kept = self.memory.kept.as_ref().filter(|_| self.memory.solved)?;
        let problem = ContactProblem {
            w: Delassus::Dense(kept.w.clone()),
            q: kept.q.clone(),
            mu: kept.mu.clone(),
            cone: cone_of(self.model()),
        };
        if kept.bonds.is_empty() {
            return Some(problem);
        }
        Some(frozen(&problem, &kept.bonds, &kept.w, &kept.intensities))
    }
}

fn same_operator(a: &[Contact], b: &[Contact]) -> bool {
    a.len() == b.len()
        && a.iter()
            .zip(b)
            .all(|(a, b)| a.stencil == b.stencil && a.frame == b.frame)
}

/// Names a contact for an error message.
pub(crate) fn describe(model: &Model, map: &ContactMap, index: usize) -> String {
    let contact = map.contacts.get(index);
    contact.map_or_else(|| "no contact".to_owned(), |c| name_of(model, c))
}

fn name_of(model: &Model, c: &Contact) -> String {
    let interface = &model.interfaces[c.interface].name;
    format!(
        "node {} of interface \"{interface}\" (gap {:e} m)",
        c.slave, c.gap
    )
}
