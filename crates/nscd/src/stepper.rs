//! One time step: predict, correct until balance and contact law agree, accept.

use contact_bipotential::{ContactMap, Detector};
use fe_core::{ElementWorkspace, FeError, Symmetry, node_adjacency};

use crate::body::{BodySystem, MatrixParts};
use crate::bonds::{adhesive_energy, bond_steps, refuse_velocity_level};
use crate::brace::braces;
use crate::buried::Hull;
use crate::contact::{ContactMemory, LinearisedContact, cone_of};
use crate::error::{NscdError, StepFailure};
use crate::extrapolation::Extrapolation;
use crate::floating::is_floating;
use crate::law::local_variable;
use crate::model::Model;
use crate::monitor::{Check, Monitor};
use crate::ordering::Graph;
use crate::report::{Clock, Counters, Phase, Phases, StepReport};
use crate::scheme::{ContactLevel, Inertia};
use crate::state::State;
use crate::trial::{StepFrame, Trial, damping_force};
use crate::unsupported::refuse_unsupported;

/// Advances a model by single steps. Holds factorizations and scratch, no truth: a rejected step
/// leaves the state as it was.
pub struct Stepper<'m> {
    pub(crate) model: &'m Model,
    pub(crate) bodies: Vec<BodySystem>,
    pub(crate) fixed: Vec<bool>,
    pub(crate) detector: Detector,
    pub(crate) hulls: Vec<Hull>,
    pub(crate) memory: ContactMemory,
    work: ElementWorkspace,
    initial_stiffness: Option<ElementWorkspace>,
    extrapolation: Extrapolation,
    breakpoints: Vec<f64>,
    /// Work done so far.
    pub counters: Counters,
    /// Seconds by phase so far.
    pub phases: Phases,
    pub(crate) clock: Box<dyn Clock>,
}

impl<'m> Stepper<'m> {
    /// Orders and analyses every body.
    ///
    /// # Errors
    /// Scheme parameters out of bounds, a matrix that cannot be analysed, an inverted element.
    pub fn new(model: &'m Model, clock: Box<dyn Clock>) -> Result<Self, NscdError> {
        model.scheme.validated()?;
        let fixed = model.prescribed();
        let candidate = model.candidates();
        let (offsets, neighbours) = node_adjacency(&model.solid);
        let graph = Graph {
            offsets: &offsets,
            neighbours: &neighbours,
        };
        refuse_unsupported(model, &fixed)?;
        refuse_velocity_level(model)?;
        let dim = model.solid.dim();
        let unknown = |n: &u32| (0..dim).any(|c| !fixed[dim * *n as usize + c]);
        let all = model.solid.bodies();
        // A body that is driven as a whole has no system to solve.
        let bodies = (0..all.len())
            .filter(|&b| all[b].iter().any(unknown))
            .map(|b| {
                let mut body = BodySystem::new(&model.solid, graph, b, &fixed, &candidate)?;
                let massless = model.scheme.inertia == Inertia::QuasiStatic;
                body.floating = massless && is_floating(model, &all[b], &fixed);
                Ok(body)
            })
            .collect::<Result<_, NscdError>>()?;
        let mut work = model.solid.workspace();
        let initial_stiffness = if model.damping.stiffness > 0.0 {
            let zero = vec![0.0; model.dof_count()];
            model.solid.tangent(&zero, &mut work, &mut zero.clone())?;
            Some(std::mem::replace(&mut work, model.solid.workspace()))
        } else {
            None
        };
        let mut stepper = Self {
            bodies,
            fixed,
            detector: detector(model)?,
            hulls: Hull::masters(model)?,
            memory: ContactMemory::new(model),
            work,
            initial_stiffness,
            extrapolation: Extrapolation::default(),
            breakpoints: model.breakpoints(),
            counters: Counters::default(),
            phases: [0.0; 6],
            clock,
            model,
        };
        stepper.refuse_overlap()?;
        Ok(stepper)
    }

    /// The model that is advanced.
    pub fn model(&self) -> &'m Model {
        self.model
    }

    /// The state at `t = 0` with the given velocities [m/s].
    ///
    /// # Errors
    /// An element that is inverted from the start.
    pub fn initial_state(&mut self, mut velocity: Vec<f64>) -> Result<State, NscdError> {
        let n = self.model.dof_count();
        let mut u = vec![0.0; n];
        self.model.prescribe(0.0, &mut u);
        (0..n)
            .filter(|&i| self.fixed[i])
            .for_each(|i| velocity[i] = 0.0);
        let mut internal_force = vec![0.0; n];
        let strain_energy =
            self.model
                .solid
                .internal_force(&u, &mut self.work, &mut internal_force)?;
        let mut external_force = vec![0.0; n];
        self.model.external_force(0.0, &mut external_force);
        let bonds = self.initial_bonds(&u);
        Ok(State {
            time: 0.0,
            kinetic_energy: self.model.kinetic_energy(&velocity),
            adhesive_energy: adhesive_energy(self.model, &bonds),
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
        self.memory.restore(now);
        self.reach_for_bonds(now);
        self.extrapolation.forget();
        let frame = StepFrame::new(self.model, now, dt, self.initial_stiffness.as_ref());
        let mut trial = self.predict(&frame)?;
        let mut monitor = Monitor::new(&self.bodies, self.model, self.memory.rows());
        loop {
            let check = monitor.check(self, &frame, &trial)?;
            if check.converged {
                self.refuse_tunnelling(&frame, &trial)?;
                self.memory.refuse_unsettled(&frame, &trial)?;
                self.memory.refuse_snap(&frame, &trial)?;
                let unforeseen = self.settle_gaps(&frame, &mut trial)?;
                return Ok(self.accept(&frame, trial, &check, unforeseen));
            }
            if check.iteration == self.model.settings.newton_iterations {
                return Err(self.no_equilibrium(&frame, &trial, &check));
            }
            self.refresh_tangents(&frame, &trial, &monitor)?;
            let correction = self.correction(
                &frame,
                &trial,
                monitor.contact_accuracy(&check, self.memory.rows()),
            )?;
            self.apply(&frame, &mut trial, correction)?;
            self.counters.newton_iterations += 1;
        }
    }

    /// Why the iterations did not suffice.
    fn no_equilibrium(&self, frame: &StepFrame<'_>, trial: &Trial, check: &Check) -> StepFailure {
        let adrift = self
            .bodies
            .iter()
            .find(|body| body.floating && check.is_left_in(body));
        match adrift {
            Some(body) => StepFailure::Adrift {
                node: body.dofs[0] as usize / frame.model.solid.dim(),
            },
            None => check.failure(frame, trial),
        }
    }

    fn predict(&mut self, frame: &StepFrame<'_>) -> Result<Trial, StepFailure> {
        let at_breakpoint = self
            .breakpoints
            .iter()
            .any(|t| (t - frame.now.time).abs() <= 1e-9 * frame.dt);
        let (u, pending) = frame.predict(&self.fixed, at_breakpoint);
        let n = u.len();
        let zeros = || vec![0.0; n];
        let mut trial = Trial {
            v: zeros(),
            internal_force: zeros(),
            strain_energy: 0.0,
            damping_force: zeros(),
            balance: zeros(),
            map: ContactMap::new(Vec::new(), self.model.solid.dim(), cone_of(self.model)),
            given_up: None,
            bonds: Vec::new(),
            x: Vec::new(),
            r: Vec::new(),
            contact_force: zeros(),
            pending,
            u,
        };
        if self.model.scheme.contact == ContactLevel::Velocity {
            trial.map = self.predicted_contacts(frame);
        }
        match self.evaluate(frame, &mut trial) {
            Err(StepFailure::Element(_)) if trial.pending.is_none() => {
                self.start_from_rest(frame, trial)
            }
            other => other.map(|()| trial),
        }
    }

    /// The extrapolation turned an element inside out: start from the old positions instead and
    /// let the prescribed motion come in through the tangent.
    fn start_from_rest(
        &mut self,
        frame: &StepFrame<'_>,
        mut trial: Trial,
    ) -> Result<Trial, StepFailure> {
        let mut target = frame.now.u.clone();
        self.model.prescribe(frame.end(), &mut target);
        trial.u.copy_from_slice(&frame.now.u);
        trial.pending = Some(
            target
                .iter()
                .zip(&frame.now.u)
                .map(|(a, b)| a - b)
                .collect(),
        );
        self.evaluate(frame, &mut trial)?;
        Ok(trial)
    }

    /// Forces, contacts and balance at the iterate.
    fn evaluate(&mut self, frame: &StepFrame<'_>, trial: &mut Trial) -> Result<(), StepFailure> {
        let start = self.clock.seconds();
        let solid = &self.model.solid;
        trial.strain_energy = solid
            .internal_force(&trial.u, &mut self.work, &mut trial.internal_force)
            .map_err(inverted)?;
        self.counters.force_evaluations += 1;
        frame.end_velocity(&trial.u, &self.fixed, &mut trial.v);
        if !self.model.damping.is_none() {
            trial.damping_force =
                damping_force(self.model, self.initial_stiffness.as_ref(), &trial.v);
        }
        frame.balance(trial);
        self.book(Phase::Elements, start);
        if self.model.scheme.contact == ContactLevel::Position && !self.model.interfaces.is_empty()
        {
            let found = self.detect(frame, &trial.u);
            (trial.map, trial.given_up) = self.memory.settle_rims(found);
            trial.bonds = bond_steps(frame, &trial.map, &trial.u);
        }
        trial.x = local_variable(frame, &trial.map, self.memory.cone, &trial.u, &trial.v);
        trial.r = self.memory.recall(&trial.map);
        trial.contact_force.fill(0.0);
        trial
            .map
            .apply_transpose(&trial.r, &mut trial.contact_force);
        Ok(())
    }

    /// Factorizes the bodies whose tangent is missing or no longer worth keeping.
    fn refresh_tangents(
        &mut self,
        frame: &StepFrame<'_>,
        trial: &Trial,
        monitor: &Monitor,
    ) -> Result<(), StepFailure> {
        let stale: Vec<bool> = (0..self.bodies.len())
            .map(|b| monitor.is_stale(b, &self.bodies[b], frame))
            .collect();
        if !stale.contains(&true) {
            return Ok(());
        }
        self.extrapolation.forget();
        let start = self.clock.seconds();
        let mut force = vec![0.0; trial.u.len()];
        self.model
            .solid
            .tangent(&trial.u, &mut self.work, &mut force)
            .map_err(inverted)?;
        self.counters.tangent_evaluations += 1;
        self.book(Phase::Elements, start);
        let start = self.clock.seconds();
        let parts = MatrixParts {
            mass: &self.model.mass,
            mass_damping: self.model.damping.mass,
            initial_stiffness: self
                .initial_stiffness
                .as_ref()
                .map(|w| (w, self.model.damping.stiffness)),
        };
        let braces = match self.model.scheme.contact {
            ContactLevel::Position => braces(trial, self.memory.cone),
            ContactLevel::Velocity => Vec::new(),
        };
        for (body, _) in self.bodies.iter_mut().zip(&stale).filter(|(_, s)| **s) {
            body.refactor(
                &self.work,
                parts,
                frame.weights,
                &braces,
                &mut self.counters,
            )?;
        }
        self.book(Phase::Factorization, start);
        Ok(())
    }

    /// The correction of all displacements that balances the linearised bodies under the contact law.
    fn correction(
        &mut self,
        frame: &StepFrame<'_>,
        trial: &Trial,
        tolerance: f64,
    ) -> Result<Vec<f64>, StepFailure> {
        let mut z = vec![0.0; trial.u.len()];
        let start = self.clock.seconds();
        let rhs = self.right_hand_side(frame, trial);
        self.bodies.iter_mut().for_each(|body| body.forward(&rhs));
        self.book(Phase::Substitution, start);
        let pressed = trial.r.iter().any(|r| *r != 0.0);
        if !pressed {
            self.substitute_back(None, &mut z)?;
            if self.stays_open(trial, &z) {
                self.memory.clear();
                return Ok(z);
            }
        }
        let start = self.clock.seconds();
        let linearised = LinearisedContact::new(
            frame,
            &mut self.memory,
            &mut self.bodies,
            trial,
            &mut self.counters,
        )?;
        self.book(Phase::Condensation, start);
        let start = self.clock.seconds();
        let force =
            linearised.solve(self.model, tolerance, &mut self.memory, &mut self.counters)?;
        self.book(Phase::Contact, start);
        self.substitute_back(Some(&force), &mut z)?;
        Ok(z)
    }

    fn right_hand_side(&self, frame: &StepFrame<'_>, trial: &Trial) -> Vec<f64> {
        let mut rhs = trial.balance.clone();
        if let Some(pending) = &trial.pending {
            let mut coupling = vec![0.0; rhs.len()];
            self.model
                .solid
                .tangent_times(&self.work, pending, &mut coupling);
            rhs.iter_mut()
                .zip(&coupling)
                .for_each(|(b, k)| *b -= frame.weights.stiffness * k);
        }
        for brace in self.bodies.iter().flat_map(BodySystem::braces) {
            brace.load(&trial.map, &trial.x, &trial.r, &mut rhs);
        }
        rhs
    }

    fn substitute_back(&mut self, force: Option<&[f64]>, z: &mut [f64]) -> Result<(), StepFailure> {
        let start = self.clock.seconds();
        for body in &mut self.bodies {
            body.backward(force, z, &mut self.counters)?;
        }
        self.book(Phase::Substitution, start);
        Ok(())
    }

    /// Whether every candidate would stay open under the correction `z` alone.
    fn stays_open(&self, trial: &Trial, z: &[f64]) -> bool {
        let cone = self.memory.cone;
        let mut moved = vec![0.0; trial.x.len()];
        trial.map.apply(z, &mut moved);
        (0..trial.map.contacts.len()).all(|k| {
            let n = cone * k + cone - 1;
            let gap = trial.x[n] + moved[n];
            gap >= 0.0 && !trial.bonds.get(k).is_some_and(|bond| bond.may_act(gap))
        })
    }

    /// Moves the iterate; a correction that turns an element inside out is halved.
    fn apply(
        &mut self,
        frame: &StepFrame<'_>,
        trial: &mut Trial,
        mut z: Vec<f64>,
    ) -> Result<(), StepFailure> {
        if let Some(pending) = trial.pending.take() {
            z.iter_mut().zip(&pending).for_each(|(z, p)| *z += p);
        } else {
            self.extrapolate(trial, &mut z);
        }
        let from = trial.u.clone();
        let mut scale = 1.0;
        loop {
            for i in 0..from.len() {
                trial.u[i] = from[i] + scale * z[i];
            }
            match self.evaluate(frame, trial) {
                Err(StepFailure::Element(_)) if scale > 0.1 => scale *= 0.5,
                Err(failure) => return Err(failure),
                Ok(()) if scale == 1.0 => return Ok(()),
                Ok(()) => {
                    let left = self.prescribed_rest(frame, &trial.u);
                    trial.pending = left;
                    return Ok(());
                }
            }
        }
    }

    /// Lets the earlier corrections of the step improve the correction and the contact forces.
    fn extrapolate(&mut self, trial: &Trial, z: &mut [f64]) {
        let mut iterate: Vec<f64> = trial.u.iter().zip(&*z).map(|(u, z)| u + z).collect();
        iterate.extend(self.memory.flat_forces());
        self.extrapolation.apply(&mut iterate, z);
        let (u, forces) = iterate.split_at(z.len());
        z.iter_mut()
            .zip(u.iter().zip(&trial.u))
            .for_each(|(z, (new, old))| *z = new - old);
        self.memory.set_flat_forces(forces);
    }

    /// What the prescribed dofs still lack after a shortened correction.
    fn prescribed_rest(&self, frame: &StepFrame<'_>, u: &[f64]) -> Option<Vec<f64>> {
        let mut target = u.to_vec();
        self.model.prescribe(frame.end(), &mut target);
        target.iter_mut().zip(u).for_each(|(t, u)| *t -= u);
        target.iter().any(|t| *t != 0.0).then_some(target)
    }

    pub(crate) fn book(&mut self, phase: Phase, start: f64) {
        self.phases[phase as usize] += self.clock.seconds() - start;
    }
}

fn detector(model: &Model) -> Result<Detector, NscdError> {
    let reference = model.positions(&vec![0.0; model.dof_count()]);
    let interfaces = model.interfaces.clone();
    let detector = Detector::new(interfaces, &reference, model.solid.dim(), cone_of(model))?;
    Ok(match model.solid.mesh().symmetry {
        Symmetry::Axisymmetric => detector.axisymmetric(&reference),
        _ => detector,
    })
}

fn inverted(error: FeError) -> StepFailure {
    StepFailure::Element(error.to_string())
}

impl std::fmt::Debug for Stepper<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Stepper")
            .field("bodies", &self.bodies.len())
            .field("counters", &self.counters)
            .finish()
    }
}
