//! One time step: predict, correct until balance and contact law agree, accept.

use std::fmt;

use contact_bipotential::{Anderson, ContactMap, ContactProblem};

use crate::accept::accept;
use crate::body::BodySystem;
use crate::bonds::{
    adhesive_energy, bond_steps, initial_bonds, lost_bonds, refuse_snap, refuse_velocity_level,
};
use crate::contact::ContactSolver;
use crate::contact_stiffness::contact_stiffness;
use crate::elements::Elements;
use crate::energy::mark_turned;
use crate::error::{NscdError, StepFailure};
use crate::local::{local_variable, turn_slips};
use crate::memory::{ContactMemory, refuse_chattering};
use crate::model::Model;
use crate::monitor::Monitor;
use crate::newton_iterate::NewtonIterate;
use crate::overlap::OverlapCheck;
use crate::report::{Clock, Counters, Overlap, Phase, Phases, StepReport};
use crate::scales::ModelScales;
use crate::scheme::ContactLevel;
use crate::search::ContactSearch;
use crate::state::State;
use crate::step_problem::StepProblem;
use crate::tally::Tally;
use crate::tunnelling::refuse_tunnelling;
use crate::unsupported::refuse_unsupported;

/// Distance of two times over the step below which they are the same \[-\]: far above the round-off of a sum of steps,
/// far below any step.
pub(crate) const SAME_TIME: f64 = 1e-9;
/// Part of a correction below which it is not shortened further when it turns an element inside out \[-\].
const SHORTEST: f64 = 0.1;
/// Part of a correction that turned an element inside out, that is tried next \[-\].
const SHORTER: f64 = 0.5;
/// Corrections of a step that Anderson's acceleration combines: with a lagged tangent they shrink by a nearly constant
/// factor in a few directions. Displacements and contact forces are combined with the same weights, so that a balance
/// that is linear in both stays one.
const CORRECTIONS: usize = 5;

/// Advances a model by single steps. Holds factorizations and scratch, no truth: a rejected step leaves the state as it
/// was.
///
/// ```
/// use nscd::fe_core::{BoxMesh, Dirichlet, Solid, solid_block};
/// use nscd::{Model, NoClock, Scheme, Stepper};
/// use hyperelastic::{ElasticConstants, NeoHookean};
///
/// let mesh = BoxMesh::uniform([0.0; 3], [1.0, 1.0, 2.0], [1, 1, 2]).generate("bar")?.validated()?;
/// let base = Dirichlet::clamped("base", mesh.node_set("z_min")?.to_vec());
/// let law = NeoHookean::new(ElasticConstants::from_shear_lame(2e5, 3e5)?)?;
/// let bar = solid_block(&mesh, 0, law, 1000.0)?;
/// let model = Model::new(Solid::new(mesh, vec![bar])?)
///     .with_support(base)
///     .with_scheme(Scheme::dynamic(1.0, 1.0));
/// let mut stepper = Stepper::new(&model, Box::new(NoClock))?;
/// let now = stepper.initial_state([0.0, 0.0, 0.1].repeat(12))?;
/// let (next, report) = stepper.step(&now, 1e-3)?;
/// assert!(next.strain_energy > 0.0 && report.energy.imbalance().abs() < 1e-9 * now.kinetic_energy);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub struct Stepper<'m> {
    model: &'m Model,
    scales: ModelScales,
    /// Times that no step crosses \[s\].
    breakpoints: Vec<f64>,
    /// Which unknowns are prescribed.
    fixed: Vec<bool>,
    elements: Elements<'m>,
    bodies: Vec<BodySystem>,
    search: ContactSearch<'m>,
    overlap: OverlapCheck<'m>,
    memory: ContactMemory,
    contact: ContactSolver,
    anderson: Anderson,
    tally: Tally,
}

impl<'m> Stepper<'m> {
    /// Orders and analyses every body.
    ///
    /// # Errors
    /// Scheme parameters out of bounds, a matrix that cannot be analysed, an inverted element, a body that nothing
    /// holds, bodies that overlap.
    pub fn new(model: &'m Model, clock: Box<dyn Clock>) -> Result<Self, NscdError> {
        model.scheme.validated()?;
        let fixed = model.prescribed();
        refuse_unsupported(model, &fixed)?;
        refuse_velocity_level(model)?;
        let mut stepper = Self {
            model,
            scales: ModelScales::of(model),
            breakpoints: model.breakpoints(),
            bodies: BodySystem::all(model, &fixed)?,
            fixed,
            elements: Elements::new(model)?,
            search: ContactSearch::new(model)?,
            overlap: OverlapCheck::new(model)?,
            memory: ContactMemory::new(model),
            contact: ContactSolver::default(),
            anderson: Anderson::new(CORRECTIONS),
            tally: Tally::new(clock),
        };
        let (search, tally) = (&mut stepper.search, &mut stepper.tally);
        stepper.overlap.refuse_start(search, tally)?;
        let sizes = &stepper.scales.element_size;
        stepper.overlap.refuse_kick(search, sizes)?;
        Ok(stepper)
    }

    /// The model that is advanced.
    pub fn model(&self) -> &'m Model {
        self.model
    }

    /// Work done so far.
    pub fn counters(&self) -> &Counters {
        &self.tally.counters
    }

    /// Seconds by phase so far, in the order of [`Phase::ALL`].
    pub fn phases(&self) -> &Phases {
        &self.tally.phases
    }

    /// The contact problem of the last iteration that had one in the last step \[m, N\], a copy; `None` where nothing
    /// touched. With bonds it is the problem that they leave for the dry forces.
    #[must_use]
    pub fn last_contact_problem(&self) -> Option<ContactProblem> {
        self.contact.last_problem()
    }

    /// Slave nodes inside the bodies of their masters that no contact holds, wherever they came in, but for those that
    /// another interface is nearer to.
    pub fn overlap(&mut self, state: &State) -> Option<Overlap> {
        self.overlap.find(state, &mut self.search, &mut self.tally)
    }

    /// The state at `t = 0` with the given velocities \[m/s\].
    ///
    /// # Errors
    /// An element that is inverted from the start.
    pub fn initial_state(&mut self, mut velocity: Vec<f64>) -> Result<State, NscdError> {
        let (model, n) = (self.model, self.model.dof_count());
        let mut u = vec![0.0; n];
        model.prescribe(0.0, &mut u);
        let prescribed = velocity.iter_mut().zip(&self.fixed).filter(|(_, f)| **f);
        prescribed.for_each(|(v, _)| *v = 0.0);
        let mut internal_force = vec![0.0; n];
        let strain_energy = self.elements.internal_force(&u, &mut internal_force)?;
        let mut external_force = vec![0.0; n];
        model.external_force(0.0, &mut external_force);
        let mut contacts = Vec::new();
        let positions = model.positions(&u);
        if model.interfaces.iter().any(|i| i.adhesion.is_some()) {
            contacts = self.search.contacts_at(&positions, 0.0);
        }
        let bonds = initial_bonds(model, &positions, &contacts);
        Ok(State {
            time: 0.0,
            kinetic_energy: model.kinetic_energy(&velocity),
            adhesive_energy: adhesive_energy(model, &bonds),
            bonds,
            u_before: u.clone(),
            u,
            v: velocity,
            internal_force,
            external_force,
            strain_energy,
            support_force: vec![0.0; n],
            contact_force: vec![0.0; n],
            contacts: Vec::new(),
            last_dt: None,
        })
    }

    /// One step of length `dt` \[s\] from `now`, which stays untouched.
    ///
    /// # Errors
    /// Why the step was rejected.
    pub fn step(&mut self, now: &State, dt: f64) -> Result<(State, StepReport), StepFailure> {
        self.begin(now);
        let step = StepProblem::new(&self.elements, now, dt);
        let mut iterate = self.predict(&step)?;
        let mut monitor = Monitor::new(&self.bodies, &self.scales, self.memory.rows());
        loop {
            let (bodies, memory) = (&mut self.bodies, &self.memory);
            let check = monitor.check(&step, &iterate, bodies, memory, &self.scales)?;
            if check.converged && self.turns_slips(&step, &mut iterate) {
                continue;
            }
            if check.converged {
                let unforeseen = self.confirm(&step, &mut iterate)?;
                self.tally.counters.stagnant_steps += u64::from(check.stagnant);
                return Ok(accept(&step, iterate, &check, &self.fixed, unforeseen));
            }
            if check.iteration == self.model.settings.newton_iterations {
                return Err(check.failure(&step, &iterate, &self.bodies));
            }
            self.refresh_tangents(&step, &iterate, &monitor)?;
            let accuracy = monitor.contact_accuracy(&check, self.memory.rows());
            let correction = self.correction(&step, &iterate, accuracy)?;
            self.apply(&step, &mut iterate, correction)?;
            self.tally.counters.newton_iterations += 1;
        }
    }

    /// At the velocity level friction opposes the end velocity; where a slip turns round in a step, it may push along
    /// the way of the step and make energy. There, from now on, friction opposes that way. True if there is any more.
    fn turns_slips(&self, step: &StepProblem<'_>, iterate: &mut NewtonIterate) -> bool {
        if self.model.scheme.contact == ContactLevel::Position || !mark_turned(step, iterate) {
            return false;
        }
        self.put_local_variable(step, iterate);
        true
    }

    fn put_local_variable(&self, step: &StepProblem<'_>, iterate: &mut NewtonIterate) {
        let NewtonIterate { map, u, v, .. } = &*iterate;
        let mut x = local_variable(step, map, u, v);
        turn_slips(step, map, &iterate.turned, u, &mut x);
        iterate.x = x;
    }

    /// Takes note of an accepted or rejected step.
    pub(crate) fn count_step(&mut self, is_accepted: bool) {
        let counters = &mut self.tally.counters;
        counters.steps += u64::from(is_accepted);
        counters.rejected_steps += u64::from(!is_accepted);
    }

    fn begin(&mut self, now: &State) {
        self.memory.restore(now);
        self.contact.begin_step();
        self.search.reach_for_bonds(now);
        self.anderson.forget();
    }

    fn predict(&mut self, step: &StepProblem<'_>) -> Result<NewtonIterate, StepFailure> {
        let is_now = |t: &f64| (t - step.now.time).abs() <= SAME_TIME * step.dt;
        let at_breakpoint = self.breakpoints.iter().any(is_now);
        let (u, pending) = step.predict(&self.fixed, at_breakpoint);
        let mut iterate = NewtonIterate::at(self.model, u, pending);
        if self.model.scheme.contact == ContactLevel::Velocity {
            let reach = self.scales.reach;
            iterate.map = self.search.predicted_contacts(step, reach, &mut self.tally);
        }
        match self.evaluate(step, &mut iterate) {
            Err(StepFailure::Element(_)) if iterate.pending.is_none() => {
                self.start_from_rest(step, &mut iterate)?;
            }
            other => other?,
        }
        Ok(iterate)
    }

    /// The extrapolation turned an element inside out: start from the old positions instead and
    /// let the prescribed motion come in through the tangent.
    fn start_from_rest(
        &mut self,
        step: &StepProblem<'_>,
        iterate: &mut NewtonIterate,
    ) -> Result<(), StepFailure> {
        iterate.u.copy_from_slice(&step.now.u);
        iterate.pending = Some(step.prescribed_way(&step.now.u));
        self.evaluate(step, iterate)
    }

    /// Forces, contacts and balance at the iterate.
    fn evaluate(
        &mut self,
        step: &StepProblem<'_>,
        iterate: &mut NewtonIterate,
    ) -> Result<(), StepFailure> {
        let start = self.tally.seconds();
        let elements = &mut self.elements;
        iterate.strain_energy = elements
            .internal_force(&iterate.u, &mut iterate.internal_force)
            .map_err(StepFailure::Element)?;
        self.tally.counters.force_evaluations += 1;
        step.end_velocity(&iterate.u, &self.fixed, &mut iterate.v);
        if !self.model.damping.is_none() {
            iterate.damping_force = elements.damping_force(&iterate.v);
        }
        iterate.balance_forces(step);
        self.tally.book(Phase::Elements, start);
        if self.model.scheme.contact == ContactLevel::Position && !self.model.interfaces.is_empty()
        {
            let tally = &mut self.tally;
            let found = self.search.contacts_after(step, &iterate.u, tally);
            (iterate.map, iterate.chattering) = self.memory.leave_out_chattering(found);
            iterate.bonds = bond_steps(step, &iterate.map, &iterate.u);
        }
        self.put_local_variable(step, iterate);
        iterate.r = self.memory.recall(&iterate.map);
        iterate.contact_force.fill(0.0);
        let force = &mut iterate.contact_force;
        iterate.map.apply_transpose(&iterate.r, force);
        Ok(())
    }

    /// Factorizes the bodies whose tangent is missing or no longer worth keeping.
    fn refresh_tangents(
        &mut self,
        step: &StepProblem<'_>,
        iterate: &NewtonIterate,
        monitor: &Monitor,
    ) -> Result<(), StepFailure> {
        let bodies = self.bodies.iter().enumerate();
        let stale: Vec<bool> = bodies
            .map(|(b, body)| monitor.is_stale(b, body, step))
            .collect();
        if !stale.contains(&true) {
            return Ok(());
        }
        self.anderson.forget();
        let start = self.tally.seconds();
        self.elements
            .update_tangents(&iterate.u)
            .map_err(StepFailure::Element)?;
        self.tally.counters.tangent_evaluations += 1;
        self.tally.book(Phase::Elements, start);
        let start = self.tally.seconds();
        let contacts = match self.model.scheme.contact {
            ContactLevel::Position => contact_stiffness(iterate),
            ContactLevel::Velocity => Vec::new(),
        };
        BodySystem::compare(&mut self.bodies, &self.elements, step.weights);
        for (body, _) in self.bodies.iter_mut().zip(&stale).filter(|(_, s)| **s) {
            let counters = &mut self.tally.counters;
            body.refactor(&self.elements, step.weights, &contacts, counters)?;
        }
        self.tally.book(Phase::Factorization, start);
        Ok(())
    }

    /// The correction of all displacements \[m\] that balances the linearised bodies under the contact law, which is
    /// solved to the relative error `accuracy`.
    fn correction(
        &mut self,
        step: &StepProblem<'_>,
        iterate: &NewtonIterate,
        accuracy: f64,
    ) -> Result<Vec<f64>, StepFailure> {
        let mut z = vec![0.0; iterate.u.len()];
        let start = self.tally.seconds();
        let rhs = self.right_hand_side(step, iterate);
        self.bodies.iter_mut().for_each(|body| body.forward(&rhs));
        self.tally.book(Phase::Substitution, start);
        let pressed = iterate.r.iter().any(|r| *r != 0.0);
        if !pressed {
            self.substitute_back(None, &mut z)?;
            if iterate.stays_open(&z) {
                self.memory.clear();
                return Ok(z);
            }
        }
        let (bodies, memory, tally) = (&mut self.bodies, &mut self.memory, &mut self.tally);
        let start = tally.seconds();
        let counters = &mut tally.counters;
        let linearised = self
            .contact
            .linearise(step, iterate, bodies, memory, counters)?;
        tally.book(Phase::Condensation, start);
        let start = tally.seconds();
        let counters = &mut tally.counters;
        let force = self
            .contact
            .solve(linearised, self.model, accuracy, memory, counters)?;
        tally.book(Phase::Contact, start);
        self.substitute_back(Some(&force), &mut z)?;
        Ok(z)
    }

    fn right_hand_side(&self, step: &StepProblem<'_>, iterate: &NewtonIterate) -> Vec<f64> {
        let mut rhs = iterate.balance.clone();
        if let Some(pending) = &iterate.pending {
            let coupling = self.elements.tangent_times(pending);
            let rows = rhs.iter_mut().zip(&coupling);
            rows.for_each(|(b, k)| *b -= step.weights.stiffness * k);
        }
        for contact in self.bodies.iter().flat_map(BodySystem::contact_stiffness) {
            contact.load(&iterate.map, &iterate.x, &iterate.r, &mut rhs);
        }
        rhs
    }

    fn substitute_back(&mut self, force: Option<&[f64]>, z: &mut [f64]) -> Result<(), StepFailure> {
        let start = self.tally.seconds();
        for body in &mut self.bodies {
            body.backward(force, z, &mut self.tally.counters)?;
        }
        self.tally.book(Phase::Substitution, start);
        Ok(())
    }

    /// Moves the iterate; a correction that turns an element inside out is halved.
    fn apply(
        &mut self,
        step: &StepProblem<'_>,
        iterate: &mut NewtonIterate,
        mut z: Vec<f64>,
    ) -> Result<(), StepFailure> {
        if let Some(pending) = iterate.pending.take() {
            z.iter_mut().zip(&pending).for_each(|(z, p)| *z += p);
        } else {
            self.extrapolate(iterate, &mut z);
        }
        let from = iterate.u.clone();
        let mut scale = 1.0;
        loop {
            for i in 0..from.len() {
                iterate.u[i] = from[i] + scale * z[i];
            }
            match self.evaluate(step, iterate) {
                Err(StepFailure::Element(_)) if scale > SHORTEST => scale *= SHORTER,
                Err(failure) => return Err(failure),
                Ok(()) if scale == 1.0 => return Ok(()),
                Ok(()) => {
                    let left = step.prescribed_way(&iterate.u);
                    iterate.pending = left.iter().any(|x| *x != 0.0).then_some(left);
                    return Ok(());
                }
            }
        }
    }

    /// Lets the earlier corrections of the step improve the correction and the contact forces.
    fn extrapolate(&mut self, iterate: &NewtonIterate, z: &mut [f64]) {
        let mut corrected: Vec<f64> = iterate.u.iter().zip(&*z).map(|(u, z)| u + z).collect();
        corrected.extend(self.memory.flat_forces());
        self.anderson.extrapolate(&mut corrected, z);
        let (u, forces) = corrected.split_at(z.len());
        let nodes = z.iter_mut().zip(u.iter().zip(&iterate.u));
        nodes.for_each(|(z, (new, old))| *z = new - old);
        self.memory.set_flat_forces(forces);
    }

    /// Refuses a converged iterate that something speaks against, and gives its contacts their gaps at the end of the
    /// step: at the velocity level they keep their predicted frames. Returns the deepest penetration \[m\] of slave
    /// nodes that no contact was predicted for.
    fn confirm(
        &mut self,
        step: &StepProblem<'_>,
        iterate: &mut NewtonIterate,
    ) -> Result<f64, StepFailure> {
        refuse_tunnelling(step, &iterate.u)?;
        refuse_chattering(self.model, iterate.chattering.as_ref())?;
        refuse_snap(step, iterate, &self.memory)?;
        let mut unforeseen = 0.0;
        if !self.model.interfaces.is_empty() {
            if self.model.scheme.contact == ContactLevel::Velocity {
                let end = self
                    .search
                    .contacts_after(step, &iterate.u, &mut self.tally);
                self.overlap
                    .refuse_lost(step.now, &iterate.u, &end.contacts)?;
                unforeseen = settle_gaps(&mut iterate.map, &end);
            } else {
                let contacts = &iterate.map.contacts;
                self.overlap.refuse_lost(step.now, &iterate.u, contacts)?;
            }
        }
        self.tally.counters.lost_bonds += lost_bonds(self.model, step.now, &iterate.map);
        Ok(unforeseen)
    }
}

/// Gives the contacts of a map the gaps of `end`; returns the deepest penetration there \[m\].
fn settle_gaps(map: &mut ContactMap, end: &ContactMap) -> f64 {
    for c in &mut map.contacts {
        if let Some(k) = end.find(c.key()) {
            c.gap = end.contacts[k].gap;
        }
    }
    end.contacts.iter().map(|c| -c.gap).fold(0.0, f64::max)
}

impl fmt::Debug for Stepper<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Stepper")
            .field("bodies", &self.bodies.len())
            .field("counters", &self.tally.counters)
            .finish()
    }
}

#[cfg(test)]
mod tests;
