//! `setae`: soft bodies in contact, from a scene to audited results.

mod console;
mod contact_command;
mod failure;
mod news;
mod sweep_command;

use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use clap::{Parser, Subcommand};
use scenarios::catalog;
use scenarios::output::{Status, earlier_results};
use scenarios::report;
use scenarios::spec::{LoadedScene, Override, SceneError};
use scenarios::{Options, RunError};
use signal_hook::consts::{SIGINT, SIGTERM};
use signal_hook::flag::{register, register_conditional_shutdown};

use crate::console::Console;
use crate::failure::Failure;
use crate::news::News;

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

/// Threads that can be asked for; more are a slip.
const MOST_THREADS: i64 = 1024;
/// What a shell adds to the number of the signal that ended a program to make its exit code.
const SIGNALLED: i32 = 128;
/// The run stopped before its end.
const STOPPED: u8 = 1;
/// The input or the output folder is unusable.
const UNUSABLE: u8 = 2;

fn main() -> ExitCode {
    let console = Console::default();
    let code = match Arguments::try_parse() {
        Ok(arguments) => command(arguments.command, &console),
        // Help and the version are such errors too.
        Err(error) => match error.print() {
            Ok(()) if error.exit_code() == 0 => ExitCode::SUCCESS,
            _ => ExitCode::from(UNUSABLE),
        },
    };
    if code == ExitCode::SUCCESS && console.is_unheard() {
        return ExitCode::from(UNUSABLE);
    }
    code
}

fn command(command: Command, console: &Console) -> ExitCode {
    let done = match command {
        Command::List => {
            list(console);
            Ok(ExitCode::SUCCESS)
        }
        Command::Show { scene, sets } => show(&scene, &sets, console),
        Command::Check { scene, sets } => check(&scene, &sets, console),
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
            let voice = Voice { console, quiet };
            run(&scene, folder, &sets, threads, dump, &voice)
        }
        Command::Sweep(arguments) => sweep_command::run(&arguments, console),
        Command::Contact(arguments) => Ok(contact_command::run(&arguments, console)),
    };
    done.unwrap_or_else(|failure| {
        console.tell(&failure.text());
        ExitCode::from(UNUSABLE)
    })
}

/// The console, and whether only errors go there.
struct Voice<'a> {
    console: &'a Console,
    quiet: bool,
}

/// The scene with all overrides, none of which undoes another one.
fn load(scene: &str, sets: &[Override]) -> Result<LoadedScene, Failure> {
    let loaded = catalog::load(scene, sets)?;
    match loaded.source.undone() {
        Some((first, second)) => Err(Failure::from(SceneError::Set {
            path: first.path.clone(),
            value: first.value.clone(),
            reason: format!(
                "is undone by --set {}={}; give one of the two",
                second.path, second.value
            ),
        })),
        None => Ok(loaded),
    }
}

fn list(console: &Console) {
    let width = catalog::SCENES
        .iter()
        .map(|entry| entry.name.len())
        .max()
        .unwrap_or(0);
    for entry in catalog::SCENES {
        match catalog::load(entry.name, &[]) {
            Ok(loaded) => {
                let scene = &loaded.scene;
                console.say(&format!(
                    "{:<width$}  {}  {}\n",
                    entry.name, scene.title, scene.source
                ));
            }
            Err(error) => console.say(&format!("{:<width$}  {error}\n", entry.name)),
        }
    }
}

fn show(scene: &str, sets: &[Override], console: &Console) -> Result<ExitCode, Failure> {
    console.say(&load(scene, sets)?.source.text);
    Ok(ExitCode::SUCCESS)
}

fn check(scene: &str, sets: &[Override], console: &Console) -> Result<ExitCode, Failure> {
    let loaded = load(scene, sets)?;
    scenarios::check(&loaded)?;
    console.say(&report::description(&loaded.source.name, &loaded.scene));
    Ok(ExitCode::SUCCESS)
}

impl From<RunError> for Failure {
    fn from(error: RunError) -> Self {
        match error {
            RunError::Scene(error) => Failure::Scene(error),
            error => Failure::Other(error.to_string()),
        }
    }
}

fn run(
    scene: &str,
    folder: PathBuf,
    sets: &[Override],
    threads: Option<u16>,
    dump: Option<usize>,
    voice: &Voice<'_>,
) -> Result<ExitCode, Failure> {
    let loaded = load(scene, sets)?;
    if let Some(threads) = threads {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads.into())
            .build_global();
        pool.map_err(|error| Failure::Other(format!("cannot start {threads} threads: {error}")))?;
    }
    tell_of_earlier(&folder, voice);
    let stop = interruption()?;
    let mut options = Options::default().with_stop(&stop);
    options.dump = dump;
    let mut news = News::new(voice.console, voice.quiet);
    let outcome = scenarios::run_with(&loaded, &folder, &options, &mut |progress| {
        news.tell(progress);
    });
    news.end();
    let summary = outcome?;
    let console = voice.console;
    if !voice.quiet {
        console.say(&format!(
            "{}\nresults in {}\n",
            report::closing_table(&summary),
            folder.display()
        ));
    }
    if summary.status != Status::Completed {
        let reason = summary.reason.as_deref().unwrap_or("no reason given");
        console.tell(&format!("error: {reason}\n"));
        return Ok(ExitCode::from(STOPPED));
    }
    if let Some(step) = dump.filter(|step| *step > summary.steps) {
        console.tell(&format!(
            "error: --dump-contact {step}: the run has {} steps, so that nothing was written\n",
            summary.steps
        ));
        return Ok(ExitCode::from(STOPPED));
    }
    Ok(ExitCode::SUCCESS)
}

/// Says what a run into a folder replaces.
fn tell_of_earlier(folder: &Path, voice: &Voice<'_>) {
    if let Some(earlier) = earlier_results(folder).filter(|_| !voice.quiet) {
        let folder = folder.display();
        voice
            .console
            .tell(&format!("replaces {earlier} in {folder}\n"));
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
