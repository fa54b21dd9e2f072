//! Has the iteration arrived, and is the tangent still worth keeping?

use crate::body::BodySystem;
use crate::contact::describe;
use crate::error::StepFailure;
use crate::law::LawError;
use crate::model::Model;
use crate::stepper::Stepper;
use crate::trial::{StepFrame, Trial};

/// Round-off of a sum of the size of its terms, with room for the number of terms.
const ROUND_OFF: f64 = 64.0 * f64::EPSILON;
/// How many times the largest force in play an element may resist a strain of size one, before its matrix is thought to come from an
/// iterate in which it was almost crushed.
const RIGID: f64 = 1e3;

/// Iterations without progress after which a residual counts as round-off, and how far above the
/// allowed one it may lie then.
const STAGNATION: usize = 4;
const CLOSE: f64 = 100.0;
/// Contact problems with fewer rows are always solved to full accuracy.
const FEW_ROWS: usize = 90;

/// Balance and contact law at an iterate.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Check {
    pub(crate) iteration: usize,
    pub(crate) converged: bool,
    /// Largest residual force on a free dof \[N\], its node, and what is allowed; where round-off is larger than what
    /// is allowed, the force counts in that ratio.
    pub(crate) residual: f64,
    dof: u32,
    node: usize,
    allowed: f64,
    newton_tolerance: f64,
    law: LawError,
    /// Error of the contact law relative to the largest contact force.
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
    pub(crate) fn is_left_in(&self, body: &BodySystem) -> bool {
        self.residual > self.allowed && body.dofs.contains(&self.dof)
    }

    pub(crate) fn failure(&self, frame: &StepFrame<'_>, trial: &Trial) -> StepFailure {
        StepFailure::Newton {
            iterations: self.iteration,
            residual: self.residual,
            node: self.node,
            allowed: self.allowed,
            contact_error: self.contact_error,
            contact: describe(frame.model, &trial.map, self.law.worst),
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
    extent: f64,
    /// Smallest edge of the elements around each node \[m\].
    element_size: Vec<f64>,
    largest_mass: f64,
    last_distance: f64,
    /// Whether the last correction helped and something is left that another one of its kind mends.
    calm: bool,
    /// Largest residual of the last iterations \[N\].
    recent: [f64; STAGNATION],
}

impl Monitor {
    pub(crate) fn new(bodies: &[BodySystem], model: &Model, contact_rows: usize) -> Self {
        let elements: usize = model.solid.blocks().iter().map(|b| b.element_count()).sum();
        let solves: f64 = bodies.iter().map(BodySystem::solve_cost).sum();
        let extent = model
            .solid
            .mesh()
            .points
            .iter()
            .flatten()
            .fold(0.0_f64, |m, x| m.max(x.abs()));
        Self {
            iteration: 0,
            norms: vec![[0.0; 2]; bodies.len()],
            epochs: bodies.iter().map(BodySystem::epoch).collect(),
            allowed: 0.0,
            iteration_cost: elements as f64 * 1e-6 + solves + contact_cost(contact_rows),
            extent,
            element_size: smallest_edges(model),
            largest_mass: largest(&model.mass.row_sums()),
            last_distance: f64::MAX,
            calm: true,
            recent: [f64::MAX; STAGNATION],
        }
    }

    /// Checks the iterate and learns the contraction of every body.
    pub(crate) fn check(
        &mut self,
        stepper: &mut Stepper<'_>,
        frame: &StepFrame<'_>,
        trial: &Trial,
    ) -> Result<Check, StepFailure> {
        let settings = &frame.model.settings;
        let factored = stepper
            .bodies
            .iter()
            .map(BodySystem::largest_diagonal)
            .fold(0.0, f64::max);
        // Before the first factorization the mass alone gives the scale; without mass any scale tells
        // a penetration from round-off.
        let inertia = frame.weights.mass * self.largest_mass;
        let stiffness = match factored.max(inertia) {
            0.0 => 1.0,
            known => known,
        };
        let travel = largest(&trial.u) + frame.dt * largest(&trial.v);
        let scale = [
            &trial.internal_force,
            &frame.external_force,
            &trial.contact_force,
            &trial.damping_force,
        ]
        .into_iter()
        .map(|f| largest(f))
        .fold(0.0, f64::max);
        let base = settings.newton_tolerance * scale;
        let unknown = if factored > 0.0 { 0.0 } else { stiffness };
        let (residual, dof) = self.residual(stepper, trial, [base, scale], unknown, travel)?;
        let blur = ROUND_OFF * (self.extent + travel) / settings.contact_tolerance;
        let law = stepper
            .memory
            .law_error(frame.model, trial, stiffness, blur);
        let contact_error = law.largest;
        let check = Check {
            iteration: self.iteration,
            converged: trial.pending.is_none()
                && (residual <= self.allowed || self.is_round_off(residual))
                && contact_error <= settings.contact_tolerance,
            residual,
            dof,
            node: dof as usize / frame.model.solid.dim(),
            allowed: self.allowed,
            newton_tolerance: settings.newton_tolerance,
            law,
            contact_error,
            contact_tolerance: settings.contact_tolerance,
            pending: trial.pending.is_some(),
        };
        let distance = check.distance();
        self.calm = check.residual > check.allowed && distance < 0.5 * self.last_distance;
        self.last_distance = distance;
        self.iteration += 1;
        Ok(check)
    }

    /// Accuracy that the next contact solve needs \[-\]: full where it is cheap or where the last
    /// correction did not help (a small penetration beside wide gaps hides in a loose tolerance),
    /// else a hundredth of what the iterate has, since the lagged tangent leaves more than that.
    pub(crate) fn contact_accuracy(&self, check: &Check, contact_rows: usize) -> f64 {
        let full = 0.01 * check.contact_tolerance;
        if contact_rows < FEW_ROWS || !self.calm {
            return full;
        }
        if check.pending {
            return 1e-3;
        }
        let reached = check.relative_residual().max(check.contact_error);
        (0.01 * reached).clamp(full, 1e-2)
    }

    /// Whether the residual has stopped falling so close above the allowed one that it can only be
    /// round-off, which strongly deformed elements have more of than the estimate knows.
    fn is_round_off(&mut self, residual: f64) -> bool {
        self.recent.rotate_left(1);
        let oldest = std::mem::replace(&mut self.recent[STAGNATION - 1], residual);
        let fallen = self.recent.iter().any(|r| *r < 0.5 * oldest);
        self.iteration >= 2 * STAGNATION && !fallen && residual <= CLOSE * self.allowed
    }

    /// Largest residual and its dof; the contraction of every body goes to the body. `base` is what is allowed where
    /// round-off is no matter and `scale` the largest force in play \[N\], `unknown` the stiffness before the first factorization [N/m], `travel` the size of the displacements \[m\].
    ///
    /// The bound is one for each dof: on a graded mesh the round-off of the largest elements would hide all that
    /// happens among the smallest.
    fn residual(
        &mut self,
        stepper: &mut Stepper<'_>,
        trial: &Trial,
        [base, scale]: [f64; 2],
        unknown: f64,
        travel: f64,
    ) -> Result<(f64, u32), StepFailure> {
        let dim = stepper.model().solid.dim();
        let sizes = &self.element_size;
        // Strains carry the round-off of numbers of size one, displacements that of their own size.
        let floors: Vec<Vec<f64>> = stepper
            .bodies
            .iter()
            .map(|body| {
                // A matrix from an iterate with an almost crushed element is no measure for the one that is judged.
                let around = |((d, [whole, elastic]), softest): ((&u32, &[f64; 2]), &f64)| {
                    let size = sizes[*d as usize / dim];
                    let likely = elastic.min(softest.max(RIGID * scale / size));
                    ROUND_OFF * ((whole - elastic + likely + unknown) * travel + likely * size)
                };
                let diagonals = body.dofs.iter().zip(body.diagonals());
                diagonals.zip(body.softest()).map(around).collect()
            })
            .collect();
        let least = floors.iter().flatten().fold(f64::MAX, |m, f| m.min(*f));
        self.allowed = base.max(least);
        let mut worst = (0.0, 0);
        for (k, body) in stepper.bodies.iter_mut().enumerate() {
            let mut norm = 0.0_f64;
            for (&d, floor) in body.dofs.iter().zip(&floors[k]) {
                let size = (trial.balance[d as usize] + trial.contact_force[d as usize]).abs();
                if !size.is_finite() {
                    return Err(StepFailure::NotFinite {
                        node: d as usize / dim,
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
            // Contact passes a disturbance back and forth between two bodies: two iterations tell
            // more than one.
            let [before, previous] = self.norms[k];
            match self.iteration {
                0 => {}
                1 => body.learn_contraction(norm / previous),
                _ => body.learn_contraction((norm / before).sqrt()),
            }
            self.norms[k] = [previous, norm];
        }
        Ok(worst)
    }

    /// Whether a new factorization of the body pays: it is missing, or the iterations that the old
    /// one still needs cost more than a new one with its own.
    pub(crate) fn is_stale(&self, index: usize, body: &BodySystem, frame: &StepFrame<'_>) -> bool {
        if !body.is_factored_for(frame.weights) {
            return true;
        }
        // Close to the allowed residual only round-off is left, which no tangent mends.
        let (Some(rate), true) = (
            body.contraction(),
            self.norms[index][1] > 10.0 * self.allowed,
        ) else {
            return false;
        };
        if rate > 0.7 {
            return true;
        }
        // The first correction goes most of the way with any tangent, and a new one is better made
        // there; what a new tangent did not mend, a second one in the same step will not mend either.
        if self.iteration == 1 || self.epochs[index] != body.epoch() {
            return false;
        }
        let decades = (self.allowed.max(f64::MIN_POSITIVE) / self.norms[index][1]).ln();
        let remaining = decades / rate.max(1e-12).ln();
        let fresh = 3.0 + frame.model.settings.lag * body.factor_cost() / self.iteration_cost;
        remaining > fresh
    }
}

/// Estimated seconds of one contact solve with so many rows: a few products with W.
fn contact_cost(rows: usize) -> f64 {
    let n = rows as f64;
    n * n * 3e-8
}

/// Shortest edge of the bounding boxes of the elements around each node \[m\].
fn smallest_edges(model: &Model) -> Vec<f64> {
    let points = &model.solid.mesh().points;
    let dim = model.solid.dim();
    let blocks = model.solid.blocks().iter();
    let cells = blocks.flat_map(|b| b.connectivity().chunks_exact(b.nodes_per_element()));
    let mut smallest = vec![f64::MAX; points.len()];
    for cell in cells {
        let extent = |c: usize| {
            let along = cell.iter().map(|&n| points[n as usize][c]);
            along.clone().fold(f64::MIN, f64::max) - along.fold(f64::MAX, f64::min)
        };
        let edge = (0..dim).map(extent).fold(f64::MAX, f64::min);
        for &n in cell {
            let at = &mut smallest[n as usize];
            *at = at.min(edge);
        }
    }
    smallest
}

fn largest(x: &[f64]) -> f64 {
    x.iter().fold(0.0, |m, v| m.max(v.abs()))
}
