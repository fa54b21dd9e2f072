//! Runs of scenes in memory, one thread each.

use std::collections::VecDeque;
use std::sync::{Mutex, PoisonError};

use nscd::{Observer, State, StepReport, Stepper, Totals, march};
use scenarios::Stopwatch;
use scenarios::catalog;
use scenarios::output::{History, Status, Summary};
use scenarios::spec::{Layout, LoadedScene, Override, Scene, parse};
use scenarios::summarise;
use scenarios::{Built, build};
use scenarios::{first_row, row};

/// Runs at a time of [`compute_all`].
const AT_A_TIME: usize = 2;

/// A run to be made.
#[derive(Clone, Debug)]
pub struct Plan {
    /// What the run is called.
    pub name: String,
    /// Name of a built-in scene, or the text of one.
    pub scene: String,
    /// `path=value`.
    pub sets: Vec<String>,
    /// Times whose states are kept \[s\], increasing.
    pub times: Vec<f64>,
}

impl Plan {
    /// A built-in scene, or the text of a scene, with changed values.
    pub fn new<S: Into<String>>(
        name: impl Into<String>,
        scene: impl Into<String>,
        sets: impl IntoIterator<Item = S>,
    ) -> Plan {
        Plan {
            name: name.into(),
            scene: scene.into(),
            sets: sets.into_iter().map(Into::into).collect(),
            times: Vec::new(),
        }
    }

    /// Keeps the states of these times \[s\].
    #[must_use]
    pub fn keeping(self, times: &[f64]) -> Plan {
        Plan {
            times: times.to_vec(),
            ..self
        }
    }
}

/// A run that was made, to its end or not.
#[derive(Debug)]
pub struct Ran {
    /// What was asked for.
    pub plan: Plan,
    /// The model.
    pub built: Built,
    /// The scene with the changed values.
    pub scene: Scene,
    /// One row an accepted step and one for the start, as in `history.csv`.
    pub history: History,
    /// One state a time of the plan that was reached.
    pub snapshots: Vec<State>,
    /// The last accepted state.
    pub last: State,
    /// What `summary.json` says. The CPU seconds hold the building of the model but no output.
    pub summary: Summary,
}

impl Ran {
    /// A column of the history.
    ///
    /// # Errors
    /// If the scene writes no such column.
    pub fn column(&self, name: &str) -> Result<Vec<f64>, String> {
        let column = self.history.column(name);
        column.ok_or_else(|| format!("{}: the scene writes no column `{name}`", self.plan.name))
    }

    /// Last entry of a column.
    ///
    /// # Errors
    /// If the scene writes no such column.
    pub fn end(&self, name: &str) -> Result<f64, String> {
        let column = self.column(name)?;
        let last = column.last().copied();
        last.ok_or_else(|| format!("{}: the history is empty", self.plan.name))
    }

    /// Two columns as a curve.
    ///
    /// # Errors
    /// If the scene writes no such columns.
    pub fn curve(&self, x: &str, y: &str) -> Result<crate::curve::Curve, String> {
        let (x, y) = (self.column(x)?, self.column(y)?);
        Ok(x.into_iter().zip(y).collect())
    }

    /// The state at a time of the plan.
    ///
    /// # Errors
    /// If the run did not get there.
    pub fn snapshot(&self, index: usize) -> Result<&State, String> {
        let state = self.snapshots.get(index);
        state.ok_or_else(|| format!("{}: no state {index} was kept", self.plan.name))
    }

    /// Node that a probe follows.
    ///
    /// # Errors
    /// If there is no such probe.
    pub fn probed(&self, probe: &str) -> Result<u32, String> {
        let index = self.scene.output.probes.get_index_of(probe);
        let node = index.and_then(|i| self.built.probes.get(i));
        let node = node.ok_or_else(|| format!("{}: no probe `{probe}`", self.plan.name))?;
        Ok(*node)
    }

    /// Normal bond traction at a slave node that a probe follows \[Pa\], one a row of the history: its force over its
    /// share of the surface.
    ///
    /// # Errors
    /// If the probe follows no slave node or not its `adhesion_normal`.
    pub fn traction(&self, probe: &str) -> Result<Vec<f64>, String> {
        let node = self.probed(probe)?;
        let interfaces = self.built.model.interfaces.iter();
        let mut shares = interfaces.flat_map(|i| i.slave.iter().zip(&i.area));
        let share = shares.find(|(slave, _)| **slave == node);
        let (_, area) = share.ok_or_else(|| format!("probe `{probe}` follows no slave node"))?;
        let force = self.column(&format!("probe.{probe}.adhesion_normal"))?;
        Ok(force.iter().map(|f| f / area).collect())
    }

    /// The run itself if it reached its end.
    ///
    /// # Errors
    /// Why it did not.
    pub fn completed(self) -> Result<Ran, String> {
        if self.summary.status == Status::Completed {
            return Ok(self);
        }
        let reason = self.summary.reason.unwrap_or_default();
        let (name, time) = (&self.plan.name, self.summary.time);
        let status = self.summary.status.word();
        Err(format!("{name}: {status} at t = {time:e} s: {reason}"))
    }
}

/// Makes one run on a thread of its own, so that its CPU time is told apart.
///
/// # Errors
/// The scene cannot be built. A run that stops before its end is none, see [`Ran::completed`].
pub fn compute(plan: Plan) -> Result<Ran, String> {
    let name = plan.name.clone();
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(1)
        .stack_size(8 << 20)
        .build()
        .map_err(|e| e.to_string())?;
    let ran = pool.install(|| one(plan));
    ran.map_err(|reason| format!("{name}: {reason}"))
}

/// Makes all runs, as many at a time as there are cores in a small machine; results in the order of the plans. `told`
/// is called for each that is done.
pub fn compute_all(
    plans: Vec<Plan>,
    told: &(dyn Fn(&Result<Ran, String>) + Sync),
) -> Vec<Result<Ran, String>> {
    let count = plans.len();
    let waiting: Mutex<VecDeque<(usize, Plan)>> =
        Mutex::new(plans.into_iter().enumerate().collect());
    let done = Mutex::new(Vec::with_capacity(count));
    let work = || {
        loop {
            let next = lock(&waiting).pop_front();
            let Some((index, plan)) = next else { return };
            let result = compute(plan);
            told(&result);
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

/// The scene of a plan; its own pictures are not made, and may not fit the changed values.
fn load(plan: &Plan) -> Result<LoadedScene, String> {
    let sets = std::iter::once("output.plots=[]").chain(plan.sets.iter().map(String::as_str));
    let sets: Vec<Override> = sets.map(str::parse).collect::<Result<_, String>>()?;
    let loaded = if plan.scene.contains('(') {
        parse(&plan.name, &plan.scene, &sets)
    } else {
        catalog::load(&plan.scene, &sets)
    };
    loaded.map_err(|e| e.to_string())
}

fn one(plan: Plan) -> Result<Ran, String> {
    let loaded = load(&plan)?;
    let stopwatch = Stopwatch::start();
    let built = build(&loaded).map_err(|e| e.to_string())?;
    let text = |e: nscd::NscdError| e.to_string();
    let (keeper, last, summary) = {
        let mut stepper = Stepper::new(&built.model, Box::new(stopwatch)).map_err(text)?;
        let initial = stepper.initial_state(built.velocity.clone());
        let mut state = initial.map_err(text)?;
        let mut keeper = Keeper::new(&loaded.scene, &built, &plan.times, &state);
        let (mut totals, span) = (Totals::default(), built.span);
        let end = march(&mut stepper, &mut state, span, &mut totals, &mut keeper);
        let stopped = end.err().map(|e| e.to_string());
        let summary = summarise(
            &loaded.scene,
            &stepper,
            &state,
            &totals,
            &stopwatch,
            stopped,
        );
        ((keeper.history, keeper.snapshots), state, summary)
    };
    let (history, snapshots) = keeper;
    Ok(Ran {
        plan,
        built,
        scene: loaded.scene,
        history,
        snapshots,
        last,
        summary,
    })
}

/// Keeps the history, and the states of the times asked for.
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
        history.push(first_row(scene, built, start).numbers(&layout));
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
        self.history.push(row.numbers(&self.layout));
        // Sums of steps reach a time only to round-off.
        let slack = 1e-6 * self.built.span.dt;
        let wanted = |kept: usize| self.times.get(kept);
        while wanted(self.snapshots.len()).is_some_and(|t| state.time >= t - slack) {
            self.snapshots.push(state.clone());
        }
        Ok(())
    }
}
