//! Has the iteration arrived, and is the tangent still worth keeping?

use fe_core::ROUND_OFF;

use crate::body::BodySystem;
use crate::cost::COSTS;
use crate::error::StepFailure;
use crate::flat::largest;
use crate::law::LawError;
use crate::memory::ContactMemory;
use crate::newton_iterate::NewtonIterate;
use crate::scales::ModelScales;
use crate::step_problem::StepProblem;

/// How many times the largest force in play an element may resist a strain of size one, before its matrix is thought to
/// come from an iterate in which it was almost crushed \[-\].
const RIGID: f64 = 1e3;

/// Stiffness where neither a matrix nor a mass tells one \[N/m\].
const ANY_STIFFNESS: f64 = 1.0;

/// Iterations without progress after which a residual counts as round-off.
const STAGNATION: usize = 4;
/// Iterations of a step before which no residual counts as round-off: twice those without progress, for in the first
/// ones contacts may still open and close.
const EARLIEST: usize = 2 * STAGNATION;
/// How far above the allowed residual it may lie then \[-\].
const CLOSE: f64 = 100.0;
/// Factor by which an iteration that helps makes something smaller \[-\].
const PROGRESS: f64 = 0.5;

/// Contact problems with fewer rows are always solved to full accuracy.
const FEW_ROWS: usize = 90;
/// Accuracy of a contact solve over the accuracy of the iterate that it serves \[-\].
const FINER: f64 = 0.01;
/// Accuracy of a contact solve while prescribed unknowns still have to move \[-\].
const PENDING: f64 = 1e-3;
/// Worst accuracy of a contact solve \[-\].
const COARSEST: f64 = 1e-2;

/// Residual over the allowed one below which only round-off is left, which no tangent mends \[-\].
const ROUND_OFF_LEFT: f64 = 10.0;
/// Contraction of the residual in an iteration above which a tangent is useless \[-\].
const SLOW: f64 = 0.7;
/// Best contraction that is counted with \[-\].
const FAST: f64 = 1e-12;
/// Iterations that a new tangent needs.
const FRESH_ITERATIONS: f64 = 3.0;

/// Balance and contact law at an iterate.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Check {
    pub(crate) iteration: usize,
    pub(crate) converged: bool,
    /// Whether it converged with an error of the contact law above the tolerance, at the round-off of gaps and forces.
    pub(crate) stagnant: bool,
    /// Largest residual force on a free dof \[N\]; where round-off is larger than what is allowed, the force counts in
    /// that ratio.
    pub(crate) residual: f64,
    dof: u32,
    node: usize,
    /// Residual that is allowed \[N\].
    allowed: f64,
    newton_tolerance: f64,
    law: LawError,
    /// Error of the contact law relative to the largest contact force \[-\].
    pub(crate) contact_error: f64,
    contact_tolerance: f64,
    /// Whether prescribed dofs still have to move.
    pending: bool,
}

impl Check {
    /// Residual relative to the largest force in play, or to the round-off that stands for it.
    pub(crate) fn relative_residual(&self) -> f64 {
        let scale = self.allowed / self.newton_tolerance;
        if scale > 0.0 {
            self.residual / scale
        } else {
            0.0
        }
    }

    /// How far the iterate is from being accepted: 1 is just there.
    fn distance(&self) -> f64 {
        let balance = self.residual / self.allowed.max(f64::MIN_POSITIVE);
        balance.max(self.contact_error / self.contact_tolerance)
    }

    /// Whether the largest residual that is not allowed stands in this body.
    fn is_left_in(&self, body: &BodySystem) -> bool {
        self.residual > self.allowed && body.dofs.contains(&self.dof)
    }

    /// Why the iterations did not suffice, if they have to end here.
    pub(crate) fn failure(
        &self,
        step: &StepProblem<'_>,
        iterate: &NewtonIterate,
        bodies: &[BodySystem],
    ) -> StepFailure {
        let mut floating = bodies.iter().filter(|body| !body.anchors().is_empty());
        if let Some(body) = floating.find(|body| self.is_left_in(body)) {
            return StepFailure::Adrift {
                node: body.dofs[0] as usize / step.model.solid.dim(),
            };
        }
        StepFailure::Newton {
            iterations: self.iteration,
            residual: self.residual,
            node: self.node,
            allowed: self.allowed,
            contact_error: self.contact_error,
            contact: iterate.place(step.model, self.law.worst),
        }
    }
}

/// Follows the residual of each body through the iterations of a step.
#[derive(Debug)]
pub(crate) struct Monitor {
    iteration: usize,
    /// Residual of each body in the last two iterations \[N\].
    norms: Vec<[f64; 2]>,
    /// Factorizations of each body before the step.
    epochs: Vec<u64>,
    allowed: f64,
    /// Estimated seconds of one iteration.
    iteration_cost: f64,
    last_distance: f64,
    /// Whether the last correction helped and something is left that another one of its kind mends.
    calm: bool,
    /// Largest residual of the last iterations \[N\].
    recent: [f64; STAGNATION],
    /// Errors of the contact law of the last iterations \[-\].
    recent_errors: [f64; STAGNATION],
}

impl Monitor {
    /// For a new step that starts with contact forces in so many rows.
    pub(crate) fn new(bodies: &[BodySystem], scales: &ModelScales, contact_rows: usize) -> Self {
        let elements = COSTS.element_forces(scales.elements);
        let solves: f64 = bodies.iter().map(BodySystem::solve_cost).sum();
        Self {
            iteration: 0,
            norms: vec![[0.0; 2]; bodies.len()],
            epochs: bodies.iter().map(BodySystem::epoch).collect(),
            allowed: 0.0,
            iteration_cost: elements + solves + COSTS.contact_solve(contact_rows),
            last_distance: f64::MAX,
            calm: true,
            recent: [f64::MAX; STAGNATION],
            recent_errors: [f64::MAX; STAGNATION],
        }
    }

    /// Checks the iterate and learns the contraction of every body.
    pub(crate) fn check(
        &mut self,
        step: &StepProblem<'_>,
        iterate: &NewtonIterate,
        bodies: &mut [BodySystem],
        memory: &ContactMemory,
        scales: &ModelScales,
    ) -> Result<Check, StepFailure> {
        let settings = &step.model.settings;
        let bound = Bound::of(step, iterate, bodies, scales);
        let (residual, dof) = self.residual(iterate, bodies, &bound, &scales.element_size)?;
        let blur = ROUND_OFF * (scales.extent + bound.travel) / settings.contact_tolerance;
        let law = LawError::of(step.model, memory, iterate, bound.stiffness, blur);
        let balanced = residual <= self.allowed || self.is_round_off(residual);
        let stagnant = self.is_stagnant(law.largest, settings.stagnant_contact_error());
        let obeyed = law.largest <= settings.contact_tolerance;
        let check = Check {
            iteration: self.iteration,
            converged: iterate.pending.is_none() && balanced && (obeyed || stagnant),
            stagnant: !obeyed,
            residual,
            dof,
            node: dof as usize / bound.dim,
            allowed: self.allowed,
            newton_tolerance: settings.newton_tolerance,
            law,
            contact_error: law.largest,
            contact_tolerance: settings.contact_tolerance,
            pending: iterate.pending.is_some(),
        };
        let distance = check.distance();
        self.calm = check.residual > check.allowed && distance < PROGRESS * self.last_distance;
        self.last_distance = distance;
        self.iteration += 1;
        Ok(check)
    }

    /// Accuracy that the next contact solve needs \[-\]: full where it is cheap or where the last
    /// correction did not help (a small penetration beside wide gaps hides in a loose tolerance),
    /// else a hundredth of what the iterate has, since the lagged tangent leaves more than that.
    pub(crate) fn contact_accuracy(&self, check: &Check, contact_rows: usize) -> f64 {
        let full = FINER * check.contact_tolerance;
        if contact_rows < FEW_ROWS || !self.calm {
            return full;
        }
        if check.pending {
            return PENDING;
        }
        let reached = check.relative_residual().max(check.contact_error);
        (FINER * reached).clamp(full, COARSEST)
    }

    /// Whether the residual has stopped falling so close above the allowed one that it can only be
    /// round-off, which strongly deformed elements have more of than the estimate knows.
    fn is_round_off(&mut self, residual: f64) -> bool {
        self.recent.rotate_left(1);
        let oldest = std::mem::replace(&mut self.recent[STAGNATION - 1], residual);
        let fallen = self.recent.iter().any(|r| *r < PROGRESS * oldest);
        self.iteration >= EARLIEST && !fallen && residual <= CLOSE * self.allowed
    }

    /// Whether the error of the contact law has stopped falling so close above the tolerance that it can only be the
    /// round-off of gaps and forces.
    fn is_stagnant(&mut self, error: f64, most: f64) -> bool {
        self.recent_errors.rotate_left(1);
        let oldest = std::mem::replace(&mut self.recent_errors[STAGNATION - 1], error);
        let fallen = self.recent_errors.iter().any(|e| *e < PROGRESS * oldest);
        self.iteration >= EARLIEST && !fallen && error <= most
    }

    /// Largest residual \[N\] and its dof; the contraction of every body goes to the body.
    ///
    /// The bound is one for each dof: on a graded mesh the round-off of the largest elements would hide all that
    /// happens among the smallest.
    fn residual(
        &mut self,
        iterate: &NewtonIterate,
        bodies: &mut [BodySystem],
        bound: &Bound,
        element_size: &[f64],
    ) -> Result<(f64, u32), StepFailure> {
        let floors = bodies.iter().map(|body| bound.floors(body, element_size));
        let floors: Vec<Vec<f64>> = floors.collect();
        let least = floors.iter().flatten().fold(f64::MAX, |m, f| m.min(*f));
        self.allowed = (bound.tolerance * bound.force).max(least);
        let mut worst = (0.0, 0);
        for (k, body) in bodies.iter_mut().enumerate() {
            let mut norm = 0.0_f64;
            for (&d, floor) in body.dofs.iter().zip(&floors[k]) {
                let at = d as usize;
                let size = (iterate.balance[at] + iterate.contact_force[at]).abs();
                if !size.is_finite() {
                    return Err(StepFailure::NotFinite {
                        node: at / bound.dim,
                    });
                }
                let weight = if *floor > self.allowed {
                    self.allowed / floor
                } else {
                    1.0
                };
                let size = weight * size;
                if size > norm {
                    norm = size;
                    if size > worst.0 {
                        worst = (size, d);
                    }
                }
            }
            self.follow(k, body, norm);
        }
        Ok(worst)
    }

    /// Tells a body the contraction of its residual. Contact passes a disturbance back and forth between two bodies:
    /// two iterations tell more than one.
    fn follow(&mut self, index: usize, body: &mut BodySystem, norm: f64) {
        let [before, previous] = self.norms[index];
        match self.iteration {
            0 => {}
            1 => body.learn_contraction(norm / previous),
            _ => body.learn_contraction((norm / before).sqrt()),
        }
        self.norms[index] = [previous, norm];
    }

    /// Whether a new factorization of the body pays: it is missing, or the iterations that the old
    /// one still needs cost more than a new one with its own.
    pub(crate) fn is_stale(&self, index: usize, body: &BodySystem, step: &StepProblem<'_>) -> bool {
        if !body.is_factored_for(step.weights) {
            return true;
        }
        let left = self.norms[index][1];
        let (Some(rate), true) = (body.contraction(), left > ROUND_OFF_LEFT * self.allowed) else {
            return false;
        };
        if rate > SLOW {
            return true;
        }
        // The first correction goes most of the way with any tangent, and a new one is better made
        // there; what a new tangent did not mend, a second one in the same step will not mend either.
        if self.iteration == 1 || self.epochs[index] != body.epoch() {
            return false;
        }
        let decades = (self.allowed.max(f64::MIN_POSITIVE) / left).ln();
        let remaining = decades / rate.max(FAST).ln();
        let lag = step.model.settings.lag;
        remaining > FRESH_ITERATIONS + lag * body.factor_cost() / self.iteration_cost
    }
}

/// What a residual is compared with.
struct Bound {
    /// Largest force in play \[N\].
    force: f64,
    /// Allowed residual over that force, where round-off is no matter \[-\].
    tolerance: f64,
    /// Largest diagonal entry of the matrices, or what stands for it \[N/m\].
    stiffness: f64,
    /// The same before the first factorization, zero after it \[N/m\].
    unknown: f64,
    /// Size of the displacements, and of what the velocities make in the step \[m\].
    travel: f64,
    dim: usize,
}

impl Bound {
    fn of(
        step: &StepProblem<'_>,
        iterate: &NewtonIterate,
        bodies: &[BodySystem],
        scales: &ModelScales,
    ) -> Self {
        let diagonals = bodies.iter().map(BodySystem::largest_diagonal);
        let factored = diagonals.fold(0.0, f64::max);
        // Before the first factorization the mass alone gives the scale; without mass any scale tells
        // a penetration from round-off.
        let stiffness = match factored.max(step.weights.mass * scales.largest_mass) {
            0.0 => ANY_STIFFNESS,
            known => known,
        };
        Self {
            force: largest_force(step, iterate),
            tolerance: step.model.settings.newton_tolerance,
            stiffness,
            unknown: if factored > 0.0 { 0.0 } else { stiffness },
            travel: largest(&iterate.u) + step.dt * largest(&iterate.v),
            dim: step.model.solid.dim(),
        }
    }

    /// Round-off of the residual of each dof of a body \[N\]. Strains carry the round-off of numbers of size one,
    /// displacements that of their own size.
    fn floors(&self, body: &BodySystem, element_size: &[f64]) -> Vec<f64> {
        let around = |((d, [whole, elastic]), softest): ((&u32, &[f64; 2]), &f64)| {
            let size = element_size[*d as usize / self.dim];
            // A matrix from an iterate with an almost crushed element is no measure for the one that is judged.
            let likely = elastic.min(softest.max(RIGID * self.force / size));
            let moved = whole - elastic + likely + self.unknown;
            ROUND_OFF * (moved * self.travel + likely * size)
        };
        let diagonals = body.dofs.iter().zip(body.diagonals());
        diagonals.zip(body.softest()).map(around).collect()
    }
}

fn largest_force(step: &StepProblem<'_>, iterate: &NewtonIterate) -> f64 {
    let forces = [
        &iterate.internal_force,
        &step.external_force,
        &iterate.contact_force,
        &iterate.damping_force,
    ];
    forces.map(|f| largest(f)).into_iter().fold(0.0, f64::max)
}
