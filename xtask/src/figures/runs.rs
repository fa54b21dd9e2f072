//! The runs of a study, one thread each, as many at a time as there are cores.

use std::collections::VecDeque;
use std::sync::{Mutex, PoisonError};

use nscd::{Observer, State, StepReport, Stepper, Totals, march};
use scenarios::build::{Built, build};
use scenarios::catalog;
use scenarios::clock::Stopwatch;
use scenarios::output::{Axis, Chart, Curve, History, Layout, Status, Summary, deformed_svg};
use scenarios::row::{first_row, row};
use scenarios::run::summarise;
use scenarios::spec::{Override, Scene};

/// Runs at a time.
const AT_A_TIME: usize = 2;

/// A run to be made.
#[derive(Clone, Debug)]
pub(super) struct Planned {
    pub(super) name: String,
    pub(super) scene: &'static str,
    /// `path=value`.
    pub(super) sets: Vec<String>,
    /// Times whose states are kept \[s\], increasing.
    pub(super) times: Vec<f64>,
}

impl Planned {
    pub(super) fn new(name: impl Into<String>, scene: &'static str, sets: &[String]) -> Planned {
        Planned {
            name: name.into(),
            scene,
            sets: sets.to_vec(),
            times: Vec::new(),
        }
    }

    /// Keeps the states of these times.
    pub(super) fn keeping(self, times: &[f64]) -> Planned {
        Planned {
            times: times.to_vec(),
            ..self
        }
    }
}

/// A run that was completed.
pub(super) struct Ran {
    pub(super) plan: Planned,
    pub(super) built: Built,
    pub(super) scene: Scene,
    history: History,
    /// One a time of the plan.
    snapshots: Vec<State>,
    pub(super) summary: Summary,
}

impl Ran {
    /// A column of the history.
    pub(super) fn column(&self, name: &str) -> Result<Vec<f64>, String> {
        let column = self.history.column(name);
        column.ok_or_else(|| format!("{}: the scene writes no column `{name}`", self.plan.name))
    }

    /// A column over another.
    pub(super) fn curve(&self, name: &str, x: &str, y: &str) -> Result<Curve, String> {
        Ok(Curve::new(name, &self.column(x)?, &self.column(y)?))
    }

    /// The state at a time of the plan.
    pub(super) fn snapshot(&self, index: usize) -> Result<&State, String> {
        let state = self.snapshots.get(index);
        state.ok_or_else(|| format!("{}: no state {index} was kept", self.plan.name))
    }

    /// Picture of the bodies at a time of the plan, coloured by the von Mises stress.
    pub(super) fn deformed(&self, title: &str, index: usize) -> Result<String, String> {
        let state = self.snapshot(index)?;
        let fields = scenarios::fields::Fields::new(&self.built, state);
        deformed_svg(title, &fields.frame(&self.built, state))
    }

    fn probed(&self, probe: &str) -> Result<u32, String> {
        let index = self.scene.output.probes.get_index_of(probe);
        let node = index.and_then(|i| self.built.probes.get(i));
        let node = node.ok_or_else(|| format!("{}: no probe `{probe}`", self.plan.name))?;
        Ok(*node)
    }

    /// Reference position of the node that a probe follows \[m\].
    pub(super) fn place(&self, probe: &str) -> Result<[f64; 3], String> {
        Ok(self.built.model.solid.mesh().points[self.probed(probe)? as usize])
    }

    /// Normal bond traction at a slave node that a probe follows \[Pa\]: its force over its share of the surface.
    pub(super) fn traction(&self, probe: &str) -> Result<Vec<f64>, String> {
        let node = self.probed(probe)?;
        let interfaces = self.built.model.interfaces.iter();
        let mut shares = interfaces.flat_map(|i| i.slave.iter().zip(&i.area));
        let share = shares.find(|(slave, _)| **slave == node);
        let (_, area) = share.ok_or_else(|| format!("probe `{probe}` follows no slave node"))?;
        let force = self.column(&format!("probe.{probe}.adhesion_normal"))?;
        Ok(force.iter().map(|f| f / area).collect())
    }
}

/// A curve a run: column `y` over column `x`, named as the run.
pub(super) fn curve_each<'a>(
    runs: impl IntoIterator<Item = &'a Ran>,
    x: &str,
    y: &str,
) -> Result<Vec<Curve>, String> {
    let curves = runs.into_iter().map(|run| run.curve(&run.plan.name, x, y));
    curves.collect()
}

/// Curves over time.
pub(super) fn over_time(title: &str, y: Axis, curves: Vec<Curve>) -> Chart {
    Chart::new(title, Axis::linear("Time", "s"), y, curves)
}

/// Makes all runs.
///
/// # Errors
/// The runs that cannot be made or stop before their end, with the reasons.
pub(super) fn compute(plans: Vec<Planned>) -> Result<Vec<Ran>, String> {
    let count = plans.len();
    let waiting: Mutex<VecDeque<(usize, Planned)>> =
        Mutex::new(plans.into_iter().enumerate().collect());
    let done = Mutex::new(Vec::with_capacity(count));
    let work = || {
        loop {
            let next = lock(&waiting).pop_front();
            let Some((index, plan)) = next else { return };
            let name = plan.name.clone();
            let result = alone(plan).map_err(|reason| format!("{name}: {reason}"));
            match &result {
                Ok(ran) => println!("  {name}: {:.1} s CPU", ran.summary.cpu_s),
                Err(reason) => println!("  {reason}"),
            }
            lock(&done).push((index, result));
        }
    };
    std::thread::scope(|scope| {
        for _ in 0..AT_A_TIME.min(count) {
            scope.spawn(work);
        }
    });
    let mut done = done.into_inner().unwrap_or_else(PoisonError::into_inner);
    done.sort_by_key(|(index, _)| *index);
    done.into_iter().map(|(_, result)| result).collect()
}

fn lock<T>(mutex: &Mutex<T>) -> std::sync::MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

/// A run on a thread of its own, so that its CPU time is told apart.
fn alone(plan: Planned) -> Result<Ran, String> {
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(1)
        .stack_size(8 << 20)
        .build()
        .map_err(|e| e.to_string())?;
    pool.install(|| one(plan))
}

fn one(plan: Planned) -> Result<Ran, String> {
    // The scene's own pictures are not made, and may not fit the changed scene.
    let sets = ["output.plots=[]"]
        .into_iter()
        .chain(plan.sets.iter().map(String::as_str));
    let sets: Result<Vec<Override>, String> = sets.map(str::parse).collect();
    let loaded = catalog::load(plan.scene, &sets?).map_err(|e| e.to_string())?;
    let built = build(&loaded).map_err(|e| e.to_string())?;
    let stopwatch = Stopwatch::start();
    let (history, snapshots, summary) = {
        let text = |e: nscd::NscdError| e.to_string();
        let mut stepper = Stepper::new(&built.model, Box::new(stopwatch)).map_err(text)?;
        let initial = stepper.initial_state(built.velocity.clone());
        let mut state = initial.map_err(text)?;
        let mut keeper = Keeper::new(&loaded.scene, &built, &plan.times, &state);
        let mut totals = Totals::default();
        let end = march(
            &mut stepper,
            &mut state,
            built.span,
            &mut totals,
            &mut keeper,
        );
        let stopped = end.err().map(|e| e.to_string());
        let summary = summarise(&stepper, &state, &totals, &stopwatch, stopped);
        (keeper.history, keeper.snapshots, summary)
    };
    if summary.status != Status::Completed {
        let reason = summary.reason.unwrap_or_default();
        return Err(format!("stopped at t = {:e} s: {reason}", summary.time));
    }
    Ok(Ran {
        plan,
        built,
        scene: loaded.scene,
        history,
        snapshots,
        summary,
    })
}

/// Keeps what the figures need.
struct Keeper<'a> {
    scene: &'a Scene,
    built: &'a Built,
    times: &'a [f64],
    layout: Layout,
    history: History,
    snapshots: Vec<State>,
}

impl<'a> Keeper<'a> {
    fn new(scene: &'a Scene, built: &'a Built, times: &'a [f64], start: &State) -> Keeper<'a> {
        let layout = Layout::of(scene);
        let mut history = History::new(layout.header());
        history.push(layout.numbers(&first_row(scene, built, start)));
        Keeper {
            scene,
            built,
            times,
            layout,
            history,
            snapshots: Vec::new(),
        }
    }
}

impl Observer for Keeper<'_> {
    fn accepted(
        &mut self,
        _: &Stepper<'_>,
        state: &State,
        report: &StepReport,
        totals: &Totals,
    ) -> Result<(), Box<dyn std::error::Error + Send + Sync>> {
        let row = row(self.scene, self.built, state, report, totals);
        self.history.push(self.layout.numbers(&row));
        // Sums of steps reach a time only to round-off.
        let slack = 1e-6 * self.built.span.dt;
        while self
            .times
            .get(self.snapshots.len())
            .is_some_and(|t| state.time >= t - slack)
        {
            self.snapshots.push(state.clone());
        }
        Ok(())
    }
}
