//! The runs, one thread each: built, marched, audited, with panics caught and hangs seen.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::mpsc;
use std::time::Duration;

use nscd::{NoClock, NscdError, StepFailure, Stepper, Totals, march};
use scenarios::Stopwatch;
use scenarios::build;
use scenarios::spec::parse;

use super::audit::{Auditor, Worst};

/// Runs at a time.
const AT_A_TIME: usize = 2;
/// Wall time without any result after which the runs at work count as hanging \[s\].
const PATIENCE: u64 = 600;
const STACK: usize = 64 << 20;

/// How a run ended.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum End {
    Completed,
    /// Refused before the first step, with the reason.
    Refused(String),
    /// Stopped on the way: what kind of reason, and the reason.
    Stopped(&'static str, String),
    /// Cut because it took too many iterations.
    Budget,
    /// A panic, a number that is none, or a step that is not what it claims to be.
    Wrong(String),
}

/// A run and what was found.
#[derive(Clone, Debug)]
pub(super) struct Found {
    pub(super) end: End,
    pub(super) worst: Worst,
    pub(super) steps: u64,
    pub(super) rejected: u64,
    pub(super) iterations: u64,
    /// \[s\].
    pub(super) cpu: f64,
}

impl Found {
    fn only(end: End, cpu: f64) -> Found {
        Found {
            end,
            worst: Worst::default(),
            steps: 0,
            rejected: 0,
            iterations: 0,
            cpu,
        }
    }
}

/// Makes all runs; `told` hears of each as it ends. The results stand in the order of the scenes.
///
/// # Errors
/// No run ended for a long time, or threads cannot be had.
pub(super) fn all(scenes: Vec<String>, told: impl Fn(usize, &Found)) -> Result<Vec<Found>, String> {
    let count = scenes.len();
    let scenes = Arc::new(scenes);
    let next = Arc::new(AtomicUsize::new(0));
    let (sender, results) = mpsc::channel();
    for _ in 0..AT_A_TIME.min(count) {
        let (scenes, next, sender) = (Arc::clone(&scenes), Arc::clone(&next), sender.clone());
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(1)
            .stack_size(STACK)
            .build()
            .map_err(|e| e.to_string())?;
        std::thread::spawn(move || {
            loop {
                let index = next.fetch_add(1, Ordering::Relaxed);
                let Some(text) = scenes.get(index) else {
                    return;
                };
                let found = pool.install(|| guarded(text));
                if sender.send((index, found)).is_err() {
                    return;
                }
            }
        });
    }
    let mut found: Vec<Option<Found>> = vec![None; count];
    for _ in 0..count {
        let (index, result) = results
            .recv_timeout(Duration::from_secs(PATIENCE))
            .map_err(|_| hanging(&found, next.load(Ordering::Relaxed)))?;
        told(index, &result);
        found[index] = Some(result);
    }
    Ok(found.into_iter().flatten().collect())
}

fn hanging(found: &[Option<Found>], begun: usize) -> String {
    let begun = found.iter().take(begun).enumerate();
    let open: Vec<String> = begun
        .filter(|(_, f)| f.is_none())
        .map(|(i, _)| i.to_string())
        .collect();
    format!(
        "no run ended for {PATIENCE} s; at work are those in places {}",
        open.join(", ")
    )
}

fn guarded(text: &str) -> Found {
    let stopwatch = Stopwatch::start();
    let outcome = catch_unwind(AssertUnwindSafe(|| one(text, &stopwatch)));
    outcome.unwrap_or_else(|panic| {
        let said = panic.downcast_ref::<String>().map(String::as_str);
        let said = said.or_else(|| panic.downcast_ref::<&str>().copied());
        let end = End::Wrong(format!("panic: {}", said.unwrap_or("without a word")));
        Found::only(end, stopwatch.cpu_s())
    })
}

fn one(text: &str, stopwatch: &Stopwatch) -> Found {
    let refused = |reason: String| Found::only(End::Refused(reason), stopwatch.cpu_s());
    let built = match parse("scene.ron", text, &[]).and_then(|loaded| build(&loaded)) {
        Ok(built) => built,
        Err(error) => return refused(error.to_string()),
    };
    let mut stepper = match Stepper::new(&built.model, Box::new(NoClock)) {
        Ok(stepper) => stepper,
        Err(error) => return refused(error.to_string()),
    };
    let mut state = match stepper.initial_state(built.velocity.clone()) {
        Ok(state) => state,
        Err(error) => return refused(error.to_string()),
    };
    let mut auditor = match Auditor::new(&built.model, &state) {
        Ok(auditor) => auditor,
        Err(error) => return refused(error),
    };
    let mut totals = Totals::default();
    let end = march(
        &mut stepper,
        &mut state,
        built.span,
        &mut totals,
        &mut auditor,
    );
    let early = (state.time - built.span.end).abs() > 1e-9 * built.span.end;
    let end = match (end, auditor.fault.take()) {
        (_, Some(fault)) => End::Wrong(fault),
        (Ok(()), None) if early => End::Wrong(format!(
            "completed at t = {:e} s of {:e} s",
            state.time, built.span.end
        )),
        (Ok(()), None) => End::Completed,
        (Err(_), None) if auditor.over_budget => End::Budget,
        (Err(error), None) => End::Stopped(kind(&error), error.to_string()),
    };
    Found {
        end,
        worst: auditor.worst,
        steps: stepper.counters().steps,
        rejected: stepper.counters().rejected_steps,
        iterations: stepper.counters().newton_iterations,
        cpu: stopwatch.cpu_s(),
    }
}

/// The word of the map for a reason.
fn kind(error: &NscdError) -> &'static str {
    let NscdError::Stopped { failure, .. } = error else {
        return "other";
    };
    match failure {
        StepFailure::Element(_) => "element inverted",
        StepFailure::Newton { .. } => "no equilibrium",
        StepFailure::Contact { .. } => "contact unsolved",
        StepFailure::Indefinite { .. } => "indefinite",
        StepFailure::Linear { .. } => "linear solve",
        StepFailure::TooFast { .. } => "too fast",
        StepFailure::Snap { .. } => "snap",
        StepFailure::Adrift { .. } => "adrift",
        StepFailure::Passed { .. } => "passed through",
        StepFailure::Rim { .. } => "rim",
        StepFailure::Immovable { .. } => "immovable",
        StepFailure::Lost { .. } => "contact lost",
        StepFailure::NotFinite { .. } => "not finite",
        _ => "other",
    }
}
