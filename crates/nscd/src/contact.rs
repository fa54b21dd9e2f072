//! The contact problem of one iteration: which forces, together with the residual, make the linearised bodies obey the
//! contact law.

use contact_bipotential::{
    BondStep, Cone, ContactMap, ContactProblem, Delassus, Outcome, SequenceSolver, SolveSettings,
    freeze_bonds,
};
use faer::Mat;

use crate::blocked::{blocked_directions, take_out};
use crate::body::BodySystem;
use crate::error::StepFailure;
use crate::flat::round_off;
use crate::memory::{ContactMemory, filtered};
use crate::model::Model;
use crate::newton_iterate::NewtonIterate;
use crate::operator::ContactOperator;
use crate::report::Counters;
use crate::scheme::ContactLevel;
use crate::step_problem::StepProblem;

/// A candidate enters the contact problem when it comes nearer than this part of the search distance \[-\].
const NEAR: f64 = 0.25;

/// Linearises and solves the contact problems of the iterations.
#[derive(Debug, Default)]
pub(crate) struct ContactSolver {
    operator: ContactOperator,
    sequence: SequenceSolver,
    last: Option<LastProblem>,
}

/// What besides the operator belongs to the last contact problem that was solved.
#[derive(Debug)]
struct LastProblem {
    q: Vec<f64>,
    mu: Vec<f64>,
    bonds: Vec<BondStep>,
    /// Intensity of each bond.
    intensities: Vec<f64>,
    cone: Cone,
}

/// A contact problem with its contacts.
#[derive(Debug)]
pub(crate) struct LinearisedContact {
    map: ContactMap,
    problem: ContactProblem,
    /// `W` before blocked directions were taken out of it; `None` where there are none.
    whole: Option<Mat<f64>>,
    /// One a contact, or none where no bond can act.
    bonds: Vec<BondStep>,
    /// Warm start.
    r: Vec<f64>,
}

impl ContactSolver {
    /// Forgets the problem of the last step; what is kept of its operator stays.
    pub(crate) fn begin_step(&mut self) {
        self.last = None;
    }

    /// Condenses the bodies and selects the contacts that matter.
    pub(crate) fn linearise(
        &mut self,
        step: &StepProblem<'_>,
        iterate: &NewtonIterate,
        bodies: &mut [BodySystem],
        memory: &mut ContactMemory,
        counters: &mut Counters,
    ) -> Result<LinearisedContact, StepFailure> {
        let (model, cone) = (step.model, iterate.map.cone());
        let free = free_motion(iterate, bodies, counters)?;
        let acts = acting(iterate, &free);
        let keep = entering(model, iterate, &free, &acts);
        let map = filtered(&iterate.map, |k, _| keep[k]);
        self.last = None;
        let mut w = self.operator.assemble(&map, bodies, memory);
        let mut q = selected(&free, cone, &keep);
        refuse_immovable(model, iterate, &map, &w, &q)?;
        let blocked = blocked_directions(&w, &q, cone);
        let whole = (!blocked.is_empty()).then(|| w.clone());
        take_out(&blocked, &mut w, &mut q, cone);
        let contacts = map.contacts.iter();
        let mu = contacts.map(|c| model.interfaces[c.interface].mu).collect();
        let mut bonds = Vec::new();
        if acts.contains(&true) {
            let kept = iterate.bonds.iter().zip(&keep).filter(|(_, k)| **k);
            bonds = kept.map(|(bond, _)| *bond).collect();
        }
        Ok(LinearisedContact {
            r: selected(&iterate.r, cone, &keep),
            problem: ContactProblem::unchecked(Delassus::Dense(w), q, mu, cone),
            map,
            whole,
            bonds,
        })
    }

    /// Solves it to the relative error `tolerance`, remembers the forces and returns `H^T r` \[N\].
    pub(crate) fn solve(
        &mut self,
        mut linearised: LinearisedContact,
        model: &Model,
        tolerance: f64,
        memory: &mut ContactMemory,
        counters: &mut Counters,
    ) -> Result<Vec<f64>, StepFailure> {
        let settings = SolveSettings::default()
            .with_tolerance(tolerance)
            .with_max_iterations(model.settings.contact_iterations);
        let LinearisedContact {
            map,
            problem,
            bonds,
            r,
            ..
        } = &mut linearised;
        let outcome = self.sequence.solve(problem, bonds, r, &settings);
        counters.contact_solves += 1;
        counters.bonded_solves += u64::from(!bonds.is_empty());
        counters.contact_iterations += outcome.iterations as u64;
        counters.contacts_max = counters.contacts_max.max(map.len() as u64);
        let error = outcome.errors.worst();
        // Where round-off leaves a little more, the exact gaps of the next iterate decide.
        if error > tolerance.max(model.settings.stagnant_contact_error()) {
            return Err(unsolved(model, map, &outcome, !bonds.is_empty()));
        }
        let mut force = vec![0.0; model.dof_count()];
        map.apply_transpose(r, &mut force);
        memory.store(map, r);
        self.keep(linearised, &outcome.u);
        Ok(force)
    }

    fn keep(&mut self, solved: LinearisedContact, x: &[f64]) {
        let cone = solved.problem.cone;
        let Delassus::Dense(w) = solved.problem.w else {
            return;
        };
        let at = solved.bonds.iter().zip(x.chunks_exact(cone.dim()));
        self.last = Some(LastProblem {
            q: solved.problem.q,
            mu: solved.problem.mu,
            intensities: at.map(|(b, x)| b.intensity(&cone.spatial(x)).0).collect(),
            bonds: solved.bonds,
            cone,
        });
        let w = solved.whole.unwrap_or(w);
        self.operator.keep(solved.map.contacts, w);
    }

    /// The last contact problem of the present step, a copy; with bonds the one that they leave for the dry forces.
    pub(crate) fn last_problem(&self) -> Option<ContactProblem> {
        let (last, w) = (self.last.as_ref()?, self.operator.kept()?);
        let w_of_all = Delassus::Dense(w.clone());
        let problem =
            ContactProblem::unchecked(w_of_all, last.q.clone(), last.mu.clone(), last.cone);
        if last.bonds.is_empty() {
            return Some(problem);
        }
        Some(freeze_bonds(&problem, &last.bonds, w, &last.intensities))
    }
}

/// Why a contact problem does not count as solved.
fn unsolved(model: &Model, map: &ContactMap, outcome: &Outcome, bonded: bool) -> StepFailure {
    let errors = outcome.diagnostics.iter().enumerate();
    let worst = errors.max_by(|a, b| a.1.error.total_cmp(&b.1.error));
    let worst = map.contacts.get(worst.map_or(0, |(k, _)| k));
    StepFailure::Contact {
        contacts: map.len(),
        error: outcome.errors.worst(),
        method: outcome.method,
        bonded,
        contact: worst.map(|c| model.place(c)),
    }
}

/// Local variable that every candidate would have without contact forces \[m\].
fn free_motion(
    iterate: &NewtonIterate,
    bodies: &mut [BodySystem],
    counters: &mut Counters,
) -> Result<Vec<f64>, StepFailure> {
    let mut z = vec![0.0; iterate.u.len()];
    for body in bodies.iter_mut().filter(|b| b.has_candidates()) {
        body.condense(z.len(), counters)?;
        body.free_surface(&mut z);
    }
    let mut free = vec![0.0; iterate.x.len()];
    iterate.map.apply(&z, &mut free);
    let both = free.iter_mut().zip(&iterate.x);
    both.for_each(|(f, x)| *f += x);
    Ok(free)
}

/// The entries of the contacts that are kept.
fn selected(all: &[f64], cone: Cone, keep: &[bool]) -> Vec<f64> {
    let contacts = all.chunks_exact(cone.dim()).zip(keep);
    let kept = contacts.filter(|(_, keep)| **keep);
    kept.flat_map(|(entries, _)| entries.iter().copied())
        .collect()
}

/// Which candidates have a bond or may form one: at the present gap, or at the `free` one that they would have without
/// forces. Bonds of neighbours may hold a surface so near that it stays within reach of its own.
fn acting(iterate: &NewtonIterate, free: &[f64]) -> Vec<bool> {
    let cone = iterate.map.cone();
    let one = |(k, bond): (usize, &BondStep)| {
        let normal = cone.normal(k);
        bond.may_act(free[normal].min(iterate.gap(k)))
    };
    iterate.bonds.iter().enumerate().map(one).collect()
}

/// Which candidates enter the contact problem: those with a force or a bond, those that the correction brings near, and
/// those that are closed: where other contacts press, the free motion may lead a node far away that they push back. The
/// others are checked with their exact gap in the next iteration.
fn entering(model: &Model, iterate: &NewtonIterate, free: &[f64], acts: &[bool]) -> Vec<bool> {
    let map = &iterate.map;
    if model.scheme.contact == ContactLevel::Velocity {
        return vec![true; map.len()];
    }
    let cone = map.cone();
    let near = |k: usize| {
        let interface = &model.interfaces[map.contacts[k].interface];
        free[cone.normal(k)] <= NEAR * interface.search_distance
    };
    let bonded = |k: usize| acts.get(k).is_some_and(|acts| *acts);
    (0..map.len())
        .map(|k| near(k) || iterate.gap(k) <= 0.0 || iterate.is_pressed(k) || bonded(k))
        .collect()
}

/// A contact between nodes that are driven on both sides has no compliance: no force of it can mend a penetration.
fn refuse_immovable(
    model: &Model,
    iterate: &NewtonIterate,
    map: &ContactMap,
    w: &Mat<f64>,
    q: &[f64],
) -> Result<(), StepFailure> {
    let cone = map.cone();
    let normal = |k: usize| cone.normal(k);
    let closed = (0..map.len()).filter(|&k| w[(normal(k), normal(k))] == 0.0 && q[normal(k)] < 0.0);
    let deepest = closed.min_by(|a, b| q[normal(*a)].total_cmp(&q[normal(*b)]));
    let Some(deepest) = deepest else {
        return Ok(());
    };
    let depth = -q[normal(deepest)];
    if depth <= round_off(&model.positions(&iterate.u)) {
        return Ok(());
    }
    Err(StepFailure::Immovable {
        contact: model.place(&map.contacts[deepest]),
        depth,
    })
}
