//! `setae`: soft bodies in contact, from a scene to audited results.

mod contact_command;
mod sweep_command;

use std::io::{IsTerminal as _, Write as _};
use std::path::PathBuf;
use std::process::ExitCode;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use clap::{Parser, Subcommand};
use indicatif::{ProgressBar, ProgressStyle};
use miette::{GraphicalReportHandler, GraphicalTheme};
use scenarios::Progress;
use scenarios::catalog;
use scenarios::output::Status;
use scenarios::report;
use scenarios::spec::{Override, SceneError};
use scenarios::{Options, RunError};
use signal_hook::consts::{SIGINT, SIGTERM};
use signal_hook::flag::{register, register_conditional_shutdown};

/// Soft bodies in contact: impact, friction and adhesion at finite strain.
#[derive(Parser)]
#[command(
    version,
    after_help = "Exit code: 0 the run completed and converged, 1 it stopped before its end, 2 the input or the output \
                  folder is unusable."
)]
struct Arguments {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    /// List the built-in scenes.
    List,
    /// Print a scene with its comments; save it as a file to change it.
    Show {
        /// Name of a built-in scene.
        #[arg(value_name = "SCENE")]
        scene: String,
        /// Change a value first, as in mu=0.5.
        #[arg(long = "set", value_name = "PATH=VALUE")]
        sets: Vec<Override>,
    },
    /// Read a scene, check every value and describe it; compute nothing.
    Check {
        /// Scene file, or name of a built-in scene.
        #[arg(value_name = "FILE")]
        scene: String,
        /// Change a value first, as in mu=0.5.
        #[arg(long = "set", value_name = "PATH=VALUE")]
        sets: Vec<Override>,
    },
    /// Compute a scene.
    Run {
        /// Name of a built-in scene, or a file.
        #[arg(value_name = "SCENE|FILE.ron")]
        scene: String,
        /// Folder of the results; out/SCENE without it.
        #[arg(long, value_name = "DIR")]
        out: Option<PathBuf>,
        /// Change a value: any ending of its path that no other value has, as in mu=0.5, dt=1e-3,
        /// lower.mesh.cells=(4,4,2).
        #[arg(long = "set", value_name = "PATH=VALUE")]
        sets: Vec<Override>,
        /// Number of threads; all cores without it. The results do not depend on it.
        #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=MOST_THREADS))]
        threads: Option<u16>,
        /// Also write the contact problem of the N-th step as FCLib, contact_step_N.hdf5, for `setae contact` and
        /// others.
        #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..))]
        dump_contact: Option<u32>,
        /// Print nothing but errors.
        #[arg(long)]
        quiet: bool,
    },
    /// Compute all combinations of values and collect them in one table.
    #[command(
        after_help = "Exit code: 0 all runs completed, 1 some did not, 2 the input or the output folder is unusable."
    )]
    Sweep(sweep_command::Arguments),
    /// Solve contact problems of any code.
    #[command(after_help = "Exit code: 0 all are solved, 1 some are not, 2 some cannot be read.")]
    Contact(contact_command::Arguments),
}

/// Unknowns up to which a check builds the whole model too, which takes a second.
const LARGEST_BUILT: usize = 300_000;
/// Threads that can be asked for; more are a slip.
const MOST_THREADS: i64 = 1024;
/// What a shell adds to the number of the signal that ended a program to make its exit code.
const SIGNALLED: i32 = 128;
/// The run stopped before its end.
const STOPPED: u8 = 1;
/// The input or the output folder is unusable.
const UNUSABLE: u8 = 2;

fn main() -> ExitCode {
    let done = match Arguments::parse().command {
        Command::List => {
            list();
            Ok(ExitCode::SUCCESS)
        }
        Command::Show { scene, sets } => show(&scene, &sets),
        Command::Check { scene, sets } => check(&scene, &sets),
        Command::Run {
            scene,
            out,
            sets,
            threads,
            dump_contact,
            quiet,
        } => {
            let folder = out.unwrap_or_else(|| catalog::default_folder(&scene));
            let dump = dump_contact.map(|n| n as usize);
            run(&scene, folder, &sets, threads, dump, quiet)
        }
        Command::Sweep(arguments) => sweep_command::run(&arguments),
        Command::Contact(arguments) => Ok(contact_command::run(&arguments)),
    };
    done.unwrap_or_else(|failure| {
        eprint!("{}", failure.text());
        ExitCode::from(UNUSABLE)
    })
}

/// An error that ends the program.
enum Failure {
    Scene(Box<SceneError>),
    /// A combination of a sweep, and what is wrong with it.
    Combination(String, Box<SceneError>),
    Other(String),
}

impl From<SceneError> for Failure {
    fn from(error: SceneError) -> Self {
        Failure::Scene(Box::new(error))
    }
}

impl Failure {
    /// The error, with the lines of the scene when it has a place.
    fn text(&self) -> String {
        let (which, error) = match self {
            Failure::Scene(error) => ("", error),
            Failure::Combination(which, error) => (which.as_str(), error),
            Failure::Other(text) => return format!("error: {text}\n"),
        };
        let mut text = format!("error: {which}{error}\n");
        if error.faults().is_empty() {
            return text;
        }
        let colors = std::io::stderr().is_terminal() && std::env::var_os("NO_COLOR").is_none();
        let theme = if colors {
            GraphicalTheme::unicode()
        } else {
            GraphicalTheme::unicode_nocolor()
        };
        let handler = GraphicalReportHandler::new_themed(theme)
            .with_context_lines(1)
            .with_wrap_lines(false);
        // The sentences stand above; the picture shows the places only.
        let mut picture = String::new();
        if handler.render_report(&mut picture, &Places(error)).is_ok() {
            text += picture.trim_start_matches('\n');
        }
        text
    }
}

/// The places of an error without its sentences.
#[derive(Debug)]
struct Places<'a>(&'a SceneError);

impl std::fmt::Display for Places<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let count = self.0.faults().len();
        if count == 1 {
            f.write_str("1 fault in the scene")
        } else {
            write!(f, "{count} faults in the scene")
        }
    }
}

impl std::error::Error for Places<'_> {}

impl miette::Diagnostic for Places<'_> {
    fn source_code(&self) -> Option<&dyn miette::SourceCode> {
        self.0.source_code()
    }

    fn labels(&self) -> Option<Box<dyn Iterator<Item = miette::LabeledSpan> + '_>> {
        self.0.labels()
    }
}

/// To the standard output; a reader that has gone away is not an error.
fn say(text: &str) {
    let mut out = std::io::stdout().lock();
    let _ = out.write_all(text.as_bytes()).and_then(|()| out.flush());
}

fn list() {
    let width = catalog::SCENES
        .iter()
        .map(|entry| entry.name.len())
        .max()
        .unwrap_or(0);
    for entry in catalog::SCENES {
        match catalog::load(entry.name, &[]) {
            Ok(loaded) => {
                let scene = &loaded.scene;
                say(&format!(
                    "{:<width$}  {}  {}\n",
                    entry.name, scene.title, scene.source
                ));
            }
            Err(error) => say(&format!("{:<width$}  {error}\n", entry.name)),
        }
    }
}

fn show(scene: &str, sets: &[Override]) -> Result<ExitCode, Failure> {
    say(&catalog::load(scene, sets)?.source.text);
    Ok(ExitCode::SUCCESS)
}

fn check(scene: &str, sets: &[Override]) -> Result<ExitCode, Failure> {
    let loaded = catalog::load(scene, sets)?;
    if loaded.scene.size().dofs <= LARGEST_BUILT {
        scenarios::build(&loaded)?;
    }
    say(&report::description(&loaded.source.name, &loaded.scene));
    Ok(ExitCode::SUCCESS)
}

fn run(
    scene: &str,
    folder: PathBuf,
    sets: &[Override],
    threads: Option<u16>,
    dump: Option<usize>,
    quiet: bool,
) -> Result<ExitCode, Failure> {
    let loaded = catalog::load(scene, sets)?;
    if let Some(threads) = threads {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads.into())
            .build_global();
        pool.map_err(|error| Failure::Other(format!("cannot start {threads} threads: {error}")))?;
    }
    let bar = progress_bar(quiet);
    let watch = &mut |progress: &Progress| advance(&bar, progress);
    let stop = interruption()?;
    let mut options = Options::default().with_stop(&stop);
    options.dump = dump;
    let outcome = scenarios::run_with(&loaded, &folder, &options, watch);
    bar.finish_and_clear();
    let summary = outcome.map_err(|error| match error {
        RunError::Scene(error) => Failure::Scene(error),
        error => Failure::Other(error.to_string()),
    })?;
    if !quiet {
        say(&format!(
            "{}\nresults in {}\n",
            report::closing_table(&summary),
            folder.display()
        ));
    }
    match summary.status {
        Status::Completed => Ok(ExitCode::SUCCESS),
        Status::Unreliable | Status::Stopped => {
            eprintln!(
                "error: {}",
                summary.reason.as_deref().unwrap_or("no reason given")
            );
            Ok(ExitCode::from(STOPPED))
        }
    }
}

/// Turns true at the first Ctrl-C or request to end; the second one ends the program at once.
fn interruption() -> Result<Arc<AtomicBool>, Failure> {
    let flag = Arc::new(AtomicBool::new(false));
    for signal in [SIGINT, SIGTERM] {
        register_conditional_shutdown(signal, SIGNALLED + signal, flag.clone())
            .and_then(|_| register(signal, flag.clone()))
            .map_err(|error| Failure::Other(format!("cannot watch for Ctrl-C: {error}")))?;
    }
    Ok(flag)
}

/// Ticks of the progress bar for the whole run.
const TICKS: u64 = 10_000;

fn progress_bar(quiet: bool) -> ProgressBar {
    if quiet || !std::io::stderr().is_terminal() {
        return ProgressBar::hidden();
    }
    let bar = ProgressBar::new(TICKS);
    let style = ProgressStyle::with_template("[{bar:30}] {percent:>3}%  {msg}  {elapsed} + {eta}");
    bar.set_style(
        style
            .unwrap_or_else(|_| ProgressStyle::default_bar())
            .progress_chars("=> "),
    );
    bar
}

fn advance(bar: &ProgressBar, progress: &Progress) {
    let done = if progress.end > 0.0 {
        progress.time / progress.end
    } else {
        0.0
    };
    bar.set_position((done.clamp(0.0, 1.0) * TICKS as f64) as u64);
    let rejected = match progress.rejected_steps {
        0 => String::new(),
        n => format!(" ({n} rejected)"),
    };
    bar.set_message(format!(
        "t = {:.4e}  step {}{rejected}  iterations {}  contacts {}",
        progress.time, progress.steps, progress.newton_iterations, progress.contacts
    ));
}
