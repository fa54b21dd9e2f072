//! Studies: all combinations of given values, each a run of its own, and one table of them.

mod plan;
mod table;

use std::num::NonZeroUsize;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};

use crate::output::{Folder, History, OutputError, Summary, remove_runs};
use crate::run::{Options, run_with};
use crate::spec::{Extent, LoadedScene};

pub use plan::{SweepError, Vary};

/// All runs of a study, checked.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Sweep {
    /// The varied fields as they were asked for.
    pub names: Vec<String>,
    /// Their full paths.
    pub paths: Vec<String>,
    /// All combinations; the last field varies fastest.
    pub runs: Vec<Planned>,
}

/// One run of a sweep.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Planned {
    /// Name of its folder, `<number>_<field>=<value>..`.
    pub folder: String,
    /// Value of each varied field.
    pub values: Vec<String>,
    /// Its scene.
    pub scene: LoadedScene,
}

impl Planned {
    /// What its forces are forces of.
    fn extent(&self) -> Extent {
        Extent::of(&self.scene.scene)
    }
}

/// How one run of a sweep ended.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Outcome {
    /// What it did and cost, or why it could not be made at all.
    pub summary: Result<Summary, String>,
    /// Its `history.csv`.
    pub history: History,
}

impl Outcome {
    fn failed(reason: String) -> Outcome {
        Outcome {
            summary: Err(reason),
            history: History::default(),
        }
    }

    /// `completed`, `unreliable`, `stopped` or `failed`.
    #[must_use]
    pub fn status(&self) -> &'static str {
        match &self.summary {
            Ok(summary) => summary.status.word(),
            Err(_) => "failed",
        }
    }

    /// Why it is not completed.
    #[must_use]
    pub fn reason(&self) -> Option<&str> {
        match &self.summary {
            Ok(summary) => summary.reason.as_deref(),
            Err(reason) => Some(reason),
        }
    }
}

impl Sweep {
    /// Makes all runs, each into its folder under `out`, on `threads` threads: as many runs at a time as there are
    /// threads, and several threads a run where there are fewer runs. `tell` is called after each run with its index
    /// and the number of runs that have ended. The numbers of a run are those of the run alone, bit by bit. Writes
    /// `sweep.csv` when all have ended.
    ///
    /// # Errors
    /// [`OutputError`] when `out` or the table cannot be written; a run that fails is an [`Outcome`].
    pub fn run(
        &self,
        out: &Path,
        threads: NonZeroUsize,
        stop: Option<&AtomicBool>,
        tell: &(dyn Fn(usize, usize, &Outcome) + Sync),
    ) -> Result<Vec<Outcome>, OutputError> {
        let folder = Folder::create(out)?;
        remove_runs(&folder)?;
        let workers = threads.get().min(self.runs.len());
        let (next, ended) = (AtomicUsize::new(0), AtomicUsize::new(0));
        let outcomes = Mutex::new(vec![Outcome::failed(String::new()); self.runs.len()]);
        let work = |threads: usize| {
            loop {
                let index = next.fetch_add(1, Ordering::Relaxed);
                let Some(planned) = self.runs.get(index) else {
                    return;
                };
                let outcome = one(planned, &folder.file(&planned.folder), threads, stop);
                tell(index, ended.fetch_add(1, Ordering::Relaxed) + 1, &outcome);
                outcomes.lock().unwrap_or_else(PoisonError::into_inner)[index] = outcome;
            }
        };
        std::thread::scope(|scope| {
            for worker in 0..workers {
                let share = threads.get() / workers + usize::from(worker < threads.get() % workers);
                let work = &work;
                scope.spawn(move || work(share));
            }
        });
        let outcomes = outcomes
            .into_inner()
            .unwrap_or_else(PoisonError::into_inner);
        folder.write("sweep.csv", &self.csv(&outcomes)?)?;
        Ok(outcomes)
    }
}

/// Stack of a run's threads, that of a main thread.
const STACK: usize = 8 << 20;

fn one(planned: &Planned, folder: &Path, threads: usize, stop: Option<&AtomicBool>) -> Outcome {
    if stop.is_some_and(|stop| stop.load(Ordering::Relaxed)) {
        return Outcome::failed("not started: the sweep was interrupted".into());
    }
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(threads)
        .stack_size(STACK)
        .build();
    let options = Options { dump: None, stop };
    let alone = || match &pool {
        Ok(pool) => pool.install(|| {
            run_with(&planned.scene, folder, &options, &mut |_| ()).map_err(|e| e.to_string())
        }),
        Err(error) => Err(format!("cannot start {threads} threads: {error}")),
    };
    // Whatever happens in one run, the others go on.
    let summary = catch_unwind(AssertUnwindSafe(alone))
        .unwrap_or_else(|_| Err("the program failed; see the message above".into()));
    let history = match &summary {
        Ok(_) => History::read(&folder.join("history.csv")),
        Err(_) => Ok(History::default()),
    };
    match history {
        Ok(history) => Outcome { summary, history },
        Err(error) => Outcome::failed(error.to_string()),
    }
}
