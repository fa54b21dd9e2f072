//! Runs of scenes in memory, one thread each.

use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};

use nscd::{NoClock, Observer, State, StepReport, Stepper, Totals, march};
use scenarios::build::{Built, build};
use scenarios::clock::Stopwatch;
use scenarios::contacts::{NodeContact, bonds};
use scenarios::spec::Override;

/// Runs at a time.
const WORKERS: usize = 2;

/// What is kept of an accepted step.
#[derive(Clone, Debug)]
pub(super) struct Sample {
    pub(super) time: f64,
    /// Force of each interface \[N\].
    pub(super) force: Vec<[f64; 3]>,
    /// Moment of each interface \[N m\].
    pub(super) moment: Vec<[f64; 3]>,
    /// Mean intensity of each interface with adhesion \[-\].
    pub(super) mean: Vec<f64>,
    /// Intensity at each probe \[-\].
    pub(super) beta: Vec<f64>,
    /// Pull of the bonds at each probe over its area \[Pa\].
    pub(super) pull: Vec<f64>,
}

/// A run that reached its end.
#[derive(Debug)]
pub(super) struct Run {
    pub(super) samples: Vec<Sample>,
    pub(super) dofs: usize,
    pub(super) rejected: usize,
    /// Seconds of its thread.
    pub(super) cpu: f64,
}

struct Recorder<'a> {
    built: &'a Built,
    /// Area of each probe on the first interface \[m^2\], in the plane \[m\].
    areas: Vec<f64>,
    samples: Vec<Sample>,
}

impl Observer for Recorder<'_> {
    fn accepted(
        &mut self,
        _: &Stepper<'_>,
        state: &State,
        report: &StepReport,
        _: &Totals,
    ) -> Result<(), Box<dyn std::error::Error + Send + Sync>> {
        let model = &self.built.model;
        let probes = self.built.probes.iter();
        let probes = probes.map(|node| NodeContact::of(model, state, *node));
        let probes: Vec<NodeContact> = probes.collect();
        let pulls = probes.iter().zip(&self.areas);
        self.samples.push(Sample {
            time: state.time,
            force: report.interfaces.iter().map(|i| i.force).collect(),
            moment: report.interfaces.iter().map(|i| i.moment).collect(),
            mean: bonds(model, state).iter().map(|b| b.mean).collect(),
            beta: probes.iter().map(|p| p.beta).collect(),
            pull: pulls.map(|(p, area)| p.bond_normal / area).collect(),
        });
        Ok(())
    }
}

/// A scene with changed values.
pub(super) struct Plan {
    pub(super) scene: &'static str,
    pub(super) sets: Vec<String>,
}

/// Makes all runs, the dear ones first if they stand last; results in the order of the plans.
pub(super) fn all(plans: &[Plan]) -> Vec<Result<Run, String>> {
    let (next, done) = (AtomicUsize::new(0), Mutex::new(Vec::new()));
    let work = || {
        loop {
            let Some(index) = plans
                .len()
                .checked_sub(next.fetch_add(1, Ordering::Relaxed) + 1)
            else {
                return;
            };
            let plan = &plans[index];
            let run = alone(plan).map_err(|e| format!("{} {:?}: {e}", plan.scene, plan.sets));
            match &run {
                Ok(run) => println!("{} {:?}: {:.1} s", plan.scene, plan.sets, run.cpu),
                Err(reason) => println!("{reason}"),
            }
            let mut done = done.lock().unwrap_or_else(PoisonError::into_inner);
            done.push((index, run));
        }
    };
    std::thread::scope(|scope| {
        for _ in 0..WORKERS {
            scope.spawn(work);
        }
    });
    let mut done = done.into_inner().unwrap_or_else(PoisonError::into_inner);
    done.sort_by_key(|(index, _)| *index);
    done.into_iter().map(|(_, run)| run).collect()
}

/// A pool of its own tells a run's CPU time apart from the others'.
fn alone(plan: &Plan) -> Result<Run, String> {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1);
    let pool = pool.stack_size(8 << 20).build();
    pool.map_err(|e| e.to_string())?.install(|| one(plan))
}

fn one(plan: &Plan) -> Result<Run, String> {
    let sets = plan.sets.iter().map(|set| set.parse());
    let sets = sets.collect::<Result<Vec<Override>, _>>()?;
    let loaded = scenarios::catalog::load(plan.scene, &sets).map_err(|e| e.to_string())?;
    let watch = Stopwatch::start();
    let built = build(&loaded).map_err(|e| e.to_string())?;
    let text = |e: nscd::NscdError| e.to_string();
    let mut stepper = Stepper::new(&built.model, Box::new(NoClock)).map_err(text)?;
    let start = stepper.initial_state(built.velocity.clone());
    let mut state = start.map_err(text)?;
    let mut recorder = Recorder {
        built: &built,
        areas: areas(&built),
        samples: Vec::new(),
    };
    let mut totals = Totals::default();
    let span = built.span;
    march(&mut stepper, &mut state, span, &mut totals, &mut recorder).map_err(text)?;
    Ok(Run {
        samples: recorder.samples,
        dofs: built.model.solid.dof_count(),
        rejected: totals.rejections.len(),
        cpu: watch.cpu_s(),
    })
}

fn areas(built: &Built) -> Vec<f64> {
    let area = |node: &u32| {
        let interface = built.model.interfaces.first()?;
        let at = interface.slave.iter().position(|slave| slave == node)?;
        interface.area.get(at).copied()
    };
    let probes = built.probes.iter();
    probes.map(|node| area(node).unwrap_or(f64::NAN)).collect()
}
