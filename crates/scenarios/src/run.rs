//! From a checked scene to results.

use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};

use fe_core::Mesh;
use nscd::{
    Clock, Counters, Model, NscdError, Observer, Phase, State, StepReport, Stepper, Totals, march,
};
use thiserror::Error;

use crate::blame;
use crate::build::{Built, build};
use crate::clock::Stopwatch;
use crate::estimate::{Estimate, free_memory};
use crate::fields::Fields;
use crate::output::{EnergySummary, OutputError, Results, Status, Summary, Units};
use crate::progress::Progress;
use crate::row::{energies, first_row, row};
use crate::spec::{Extent, LoadedScene, Scene, SceneError};
use crate::verdict::{energy_warning, verdict};

/// Why a run could not be made at all. A run that stops before its end is not an error but a [`Summary`] that says
/// so.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum RunError {
    /// The scene describes something that cannot be built.
    #[error(transparent)]
    Scene(#[from] Box<SceneError>),
    /// The results cannot be written.
    #[error(transparent)]
    Output(#[from] OutputError),
}

/// Computes a scene and writes its results into a folder; `watch` is called after each accepted step.
///
/// # Errors
/// [`RunError`].
pub fn run(
    loaded: &LoadedScene,
    folder: &Path,
    watch: &mut dyn FnMut(&Progress),
) -> Result<Summary, RunError> {
    run_with(loaded, folder, &Options::default(), watch)
}

/// What a run does besides what its scene says.
#[derive(Clone, Copy, Debug, Default)]
#[non_exhaustive]
pub struct Options<'a> {
    /// The contact problem of the last iteration of this accepted step, from 1, is written as FCLib. Where that step
    /// has none, a warning in the summary says so.
    pub dump: Option<usize>,
    /// When this turns true, the run stops after the step that it computes, with all its results.
    pub stop: Option<&'a AtomicBool>,
}

impl<'a> Options<'a> {
    /// With [`Options::stop`].
    #[must_use]
    pub fn with_stop(mut self, stop: &'a AtomicBool) -> Self {
        self.stop = Some(stop);
        self
    }
}

/// As [`run`], with [`Options`].
///
/// # Errors
/// [`RunError`].
pub fn run_with(
    loaded: &LoadedScene,
    folder: &Path,
    options: &Options<'_>,
    watch: &mut dyn FnMut(&Progress),
) -> Result<Summary, RunError> {
    let stopwatch = Stopwatch::start();
    let built = affordable(loaded)?;
    let (mut stepper, mut state) = ready(loaded, &built, stopwatch)?;
    let results = Results::create(folder, &loaded.scene)?;
    let mut recorder = Recorder {
        loaded,
        built: &built,
        results,
        watch,
        dump: options.dump,
        stop: options.stop,
        interrupted: false,
        failure: None,
        stopwatch,
        saved: 0.0,
    };
    let mut totals = Totals::default();
    recorder.start(&stepper, &state, &totals)?;
    let end = march(
        &mut stepper,
        &mut state,
        built.span,
        &mut totals,
        &mut recorder,
    );
    if let Some(failure) = recorder.failure.take() {
        // The disk may be full; then the summary of a running run has to do.
        let _ = recorder.save(&stepper, &state, &totals, Some(failure.to_string()));
        return Err(failure.into());
    }
    recorder.frame(&state, stepper.counters().steps as usize, true)?;
    let stopped = end.err().map(|error| match recorder.interrupted {
        true => format!("interrupted at t = {:e} s", state.time),
        false => blame::error(&error, built.model.solid.mesh()),
    });
    let mut summary = summarise(
        &loaded.scene,
        &stepper,
        &state,
        &totals,
        &stopwatch,
        stopped,
    );
    summary.warnings.extend(loaded.scene.warnings());
    if let Some(step) = recorder.dump {
        let reason = format!(
            "no contact problem to dump: step {step} was not reached, or nothing touches in it"
        );
        summary.warnings.push(reason);
    }
    recorder.results.finish(&summary)?;
    Ok(summary)
}

/// All that a run would refuse before its first step, and nothing computed.
///
/// # Errors
/// [`RunError::Scene`].
pub fn check(loaded: &LoadedScene) -> Result<(), RunError> {
    let built = affordable(loaded)?;
    ready(loaded, &built, Stopwatch::start())?;
    Ok(())
}

/// The model, unless it cannot fit the memory.
fn affordable(loaded: &LoadedScene) -> Result<Built, Box<SceneError>> {
    let free = free_memory();
    if let Some(refusal) = free.and_then(|free| Estimate::of(&loaded.scene).refusal(free)) {
        return Err(Box::new(loaded.refuse("bodies", refusal)));
    }
    build(loaded).map_err(Box::new)
}

/// The stepper and the state that it starts from.
fn ready<'m>(
    loaded: &LoadedScene,
    built: &'m Built,
    stopwatch: Stopwatch,
) -> Result<(Stepper<'m>, State), Box<SceneError>> {
    let mesh = built.model.solid.mesh();
    let refuse = |e: NscdError| Box::new(loaded.refuse(&place(&e), blame::error(&e, mesh)));
    let mut stepper = Stepper::new(&built.model, Box::new(stopwatch)).map_err(refuse)?;
    let velocity = built.velocity.clone();
    let state = stepper.initial_state(velocity).map_err(refuse)?;
    Ok((stepper, state))
}

/// Wall time between two summaries of a running run \[s\]: a kill loses no more, and writing one takes a millisecond.
const BETWEEN_SUMMARIES: f64 = 2.0;

impl Clock for Stopwatch {
    fn seconds(&self) -> f64 {
        self.wall_s()
    }
}

/// Writes what the stepper reports.
struct Recorder<'a> {
    loaded: &'a LoadedScene,
    built: &'a Built,
    results: Results,
    watch: &'a mut dyn FnMut(&Progress),
    /// Step whose contact problem is still to be written.
    dump: Option<usize>,
    stop: Option<&'a AtomicBool>,
    /// Whether `stop` has ended the march.
    interrupted: bool,
    /// An output error ends the march; it is kept here to be told as it is.
    failure: Option<OutputError>,
    stopwatch: Stopwatch,
    /// When the last summary was written \[s\].
    saved: f64,
}

impl Recorder<'_> {
    fn start(
        &mut self,
        stepper: &Stepper<'_>,
        state: &State,
        totals: &Totals,
    ) -> Result<(), OutputError> {
        self.save(stepper, state, totals, None)?;
        let row = first_row(&self.loaded.scene, self.built, state);
        self.results.start(&row);
        self.frame(state, 0, false)
    }

    /// How far the run is, as its summary until the last one; `stopped` says why it goes no farther.
    fn save(
        &mut self,
        stepper: &Stepper<'_>,
        state: &State,
        totals: &Totals,
        stopped: Option<String>,
    ) -> Result<(), OutputError> {
        let running = stopped.is_none();
        let scene = &self.loaded.scene;
        let mut summary = summarise(scene, stepper, state, totals, &self.stopwatch, stopped);
        if running {
            summary.status = Status::Running;
            summary.reason = None;
        }
        self.saved = self.stopwatch.wall_s();
        summary.write(self.results.folder())
    }

    fn frame(&mut self, state: &State, step: usize, last: bool) -> Result<(), OutputError> {
        if !self.results.wants_frame(step, state.time, last) {
            return Ok(());
        }
        let fields = Fields::new(self.built, state);
        self.results
            .frame(step, &fields.frame(self.built, state), last)
    }

    fn record(
        &mut self,
        stepper: &Stepper<'_>,
        state: &State,
        report: &StepReport,
        totals: &Totals,
    ) -> Result<(), OutputError> {
        let row = row(&self.loaded.scene, self.built, state, report, totals);
        self.results.record(&row)?;
        let step = stepper.counters().steps as usize;
        if self.dump == Some(step)
            && let Some(problem) = stepper.last_contact_problem()
        {
            self.results.contact_problem(step, &problem)?;
            self.dump = None;
        }
        if self.stopwatch.wall_s() - self.saved > BETWEEN_SUMMARIES {
            self.save(stepper, state, totals, None)?;
        }
        self.frame(state, step, false)
    }
}

impl Observer for Recorder<'_> {
    fn next_time(&self, time: f64) -> Option<f64> {
        self.results.next_time(time, self.built.span.dt)
    }

    fn accepted(
        &mut self,
        stepper: &Stepper<'_>,
        state: &State,
        report: &StepReport,
        totals: &Totals,
    ) -> Result<(), Box<dyn std::error::Error + Send + Sync>> {
        (self.watch)(&Progress {
            time: state.time,
            end: self.built.span.end,
            steps: stepper.counters().steps as usize,
            rejected_steps: stepper.counters().rejected_steps as usize,
            newton_iterations: stepper.counters().newton_iterations as usize,
            contacts: report.contacts_closed,
        });
        self.record(stepper, state, report, totals)
            .map_err(|failure| {
                let text = failure.to_string();
                self.failure = Some(failure);
                text
            })?;
        self.interrupted = self.stop.is_some_and(|stop| stop.load(Ordering::Relaxed));
        if self.interrupted {
            return Err("interrupted".into());
        }
        Ok(())
    }
}

/// Where in a scene to look for the cause of an error.
fn place(error: &NscdError) -> String {
    match error {
        NscdError::Overlap { interface, .. } | NscdError::StartsInside { interface, .. } => {
            format!("interfaces.{interface}")
        }
        _ => "time".to_owned(),
    }
}

fn rejection(r: &nscd::Rejection, mesh: &Mesh) -> String {
    let reason = blame::failure(&r.reason, mesh);
    format!("t = {:e} s, dt = {:e} s: {reason}", r.time, r.dt)
}

fn warnings(totals: &Totals, model: &Model, counters: &Counters) -> Vec<String> {
    let lost_bonds = counters.lost_bonds;
    let error = totals.energy.integration_error();
    let energies = energy_warning(model.scheme.inertia, &totals.audit, error);
    let mut warnings: Vec<String> = energies.into_iter().collect();
    if lost_bonds > 0 {
        warnings.push(format!(
            "{lost_bonds} bonds that still held were lost with their pair: nodes slid off their master or moved too far in one \
             step; try a larger master, smaller steps or a larger search_distance"
        ));
    }
    if counters.stagnant_steps > 0 {
        warnings.push(format!(
            "in {} steps round-off kept the error of the contact law above the tolerance of {:e}: up to {:e}",
            counters.stagnant_steps, model.settings.contact_tolerance, totals.max_contact_error
        ));
    }
    if let Some(overlap) = totals.overlap {
        warnings.push(format!(
            "at the end {} slave nodes lie inside the bodies of their masters and no contact holds them, node {} of interface \"{}\" \
             {:e} m deep: they came in through sides that belong to no master, or over its rim",
            overlap.nodes, overlap.node, model.interfaces[overlap.interface].name, overlap.depth
        ));
    }
    warnings
}

/// Rejected steps that a summary tells one by one.
const MOST_REJECTIONS: usize = 100;

/// What a run did and cost; `stopped` says why it did not reach its end.
#[must_use]
pub fn summarise(
    scene: &Scene,
    stepper: &Stepper<'_>,
    state: &State,
    totals: &Totals,
    stopwatch: &Stopwatch,
    stopped: Option<String>,
) -> Summary {
    let (counters, solid) = (stepper.counters(), &stepper.model().solid);
    let energy = EnergySummary::new(totals.initial_energy, &energies(state, totals));
    let phases = Phase::ALL.iter().zip(stepper.phases());
    let mut warnings = warnings(totals, stepper.model(), counters);
    let verdict = verdict(scene, &totals.audit);
    warnings.extend(verdict.accepted);
    let (status, reason) = match (stopped, verdict.objections.is_empty()) {
        (Some(reason), _) => {
            warnings.extend(verdict.objections);
            (Status::Stopped, Some(reason))
        }
        (None, true) => (Status::Completed, None),
        (None, false) => (Status::Unreliable, Some(verdict.objections.join("; "))),
    };
    Summary {
        status,
        reason,
        units: Units::of(Extent::of(scene)),
        time: state.time,
        steps: counters.steps as usize,
        rejected_steps: counters.rejected_steps as usize,
        newton_iterations: counters.newton_iterations as usize,
        factorizations: counters.factorizations as usize,
        contact_solves: counters.contact_solves as usize,
        contact_iterations: counters.contact_iterations as usize,
        dofs: solid.dof_count(),
        elements: solid.element_count(),
        contacts_max: counters.contacts_max as usize,
        bonded_solves: counters.bonded_solves,
        phases: phases
            .map(|((_, name), seconds)| ((*name).to_owned(), *seconds))
            .collect(),
        indefinite_tangents: counters.indefinite_tangents as usize,
        max_residual: totals.max_residual,
        rejections: totals
            .rejections
            .iter()
            .take(MOST_REJECTIONS)
            .map(|r| rejection(r, solid.mesh()))
            .collect(),
        warnings,
        energy,
        max_penetration: totals.max_penetration,
        max_contact_error: totals.max_contact_error,
        cpu_s: stopwatch.cpu_s(),
        wall_s: stopwatch.wall_s(),
    }
}
