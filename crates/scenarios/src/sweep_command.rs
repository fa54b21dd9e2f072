//! `setae sweep`: all combinations of values, computed side by side.

use std::num::NonZeroUsize;
use std::path::PathBuf;
use std::process::ExitCode;

use scenarios::catalog;
use scenarios::spec::Override;
use scenarios::{Outcome, Sweep, SweepError, Vary};

use crate::console::Console;
use crate::failure::Failure;
use crate::{MOST_THREADS, STOPPED, Voice, interruption, tell_of_earlier};

/// What to vary.
#[derive(clap::Args)]
pub(crate) struct Arguments {
    /// Name of a built-in scene, or a file.
    #[arg(value_name = "SCENE|FILE.ron")]
    scene: String,
    /// Values of a field, found as by --set; commas inside of brackets and texts do not separate. The last --vary
    /// varies fastest.
    #[arg(long = "vary", value_name = "PATH=VALUE,..", required = true)]
    varied: Vec<Vary>,
    /// Change a value of all runs, as in `setae run`.
    #[arg(long = "set", value_name = "PATH=VALUE")]
    sets: Vec<Override>,
    /// Folder of the table and of the runs' folders; out/SCENE-sweep without it.
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Number of threads; all cores without it. The results do not depend on it.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=MOST_THREADS))]
    threads: Option<u16>,
    /// Print nothing but errors.
    #[arg(long)]
    quiet: bool,
}

impl From<SweepError> for Failure {
    fn from(error: SweepError) -> Self {
        match error {
            SweepError::Scene {
                number,
                runs,
                which,
                source,
            } => Failure::Combination(format!("run {number} of {runs} ({which}): "), source),
            other => Failure::Other(other.to_string()),
        }
    }
}

pub(crate) fn run(arguments: &Arguments, console: &Console) -> Result<ExitCode, Failure> {
    let sweep = Sweep::plan(&arguments.scene, &arguments.sets, &arguments.varied)?;
    let out = arguments
        .out
        .clone()
        .unwrap_or_else(|| catalog::default_sweep_folder(&arguments.scene));
    let asked = arguments
        .threads
        .map(usize::from)
        .and_then(NonZeroUsize::new);
    let threads = match asked {
        Some(threads) => threads,
        None => std::thread::available_parallelism().unwrap_or(NonZeroUsize::MIN),
    };
    let quiet = arguments.quiet;
    tell_of_earlier(&out, &Voice { console, quiet });
    let stop = interruption()?;
    let tell = |index: usize, ended: usize, outcome: &Outcome| {
        let progress = format!("[{ended}/{}] {}", sweep.runs.len(), sweep.which(index));
        match (outcome.reason(), &outcome.summary) {
            (None, Ok(summary)) if !arguments.quiet => {
                console.tell(&format!(
                    "{progress}: completed, {} steps, {:.2} s\n",
                    summary.steps, summary.wall_s
                ));
            }
            (None, _) => {}
            (Some(reason), _) => console.tell(&format!(
                "error: {progress}: {}: {reason}\n",
                outcome.status()
            )),
        }
    };
    let outcomes = sweep
        .run(&out, threads, Some(&stop), &tell)
        .map_err(|error| Failure::Other(error.to_string()))?;
    let completed = outcomes.iter().filter(|o| o.reason().is_none()).count();
    if !arguments.quiet {
        console.say(&format!(
            "{}\n{completed} of {} runs completed; results in {}\n",
            sweep.table(&outcomes),
            outcomes.len(),
            out.join("sweep.csv").display()
        ));
    }
    Ok(if completed == outcomes.len() {
        ExitCode::SUCCESS
    } else {
        ExitCode::from(STOPPED)
    })
}
