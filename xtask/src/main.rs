//! Checks and studies of the workspace: `cargo xtask ci`, `cargo xtask tidy`, `cargo xtask fclib`,
//! `cargo xtask precision`, `cargo xtask figures`, `cargo xtask stress`, `cargo xtask speed`.

mod ci;
mod fclib;
mod figures;
mod precision;
mod regress;
mod speed;
mod stress;
mod tidy;

use std::process::ExitCode;

use clap::{Parser, Subcommand};

/// What went wrong, ready to be printed.
type Outcome = Result<(), String>;

#[derive(Parser)]
#[command(
    name = "cargo xtask",
    about = "Checks and studies of the setae workspace"
)]
struct Arguments {
    #[command(subcommand)]
    task: Task,
}

#[derive(Subcommand)]
enum Task {
    /// The gate: format, lints, tests, docs, benches compiled, tidy, the README's main command
    Ci,
    /// The invariants that a program can check
    Tidy,
    /// All methods on the problems of other codes: docs/verification/fclib.md and its picture
    Fclib {
        /// Folder of the problem files; $FCLIB_DIR or ../shared/fclib without it
        folder: Option<std::path::PathBuf>,
    },
    /// Error against time, of the contact methods and of the scenes with a reference: tables and pictures in
    /// docs/verification
    Precision {
        /// contact, or names of cases; all without a name
        names: Vec<String>,
    },
    /// Every scene in a short form against stored results and counters
    Regress {
        /// Names of scenes; all without a name
        names: Vec<String>,
        /// Store what comes out now
        #[arg(long)]
        update: bool,
    },
    /// The figures of Hu2022 and Feng2007: docs/verification/hu2022.md, feng2007.md and what they lead to
    Figures {
        /// laws, indentation, wheel, plate-cylinder, twist, supplement; all without a name
        names: Vec<String>,
    },
    /// CPU time of two programs on the same scenes, run in turn: docs/verification/speed.md
    Speed(speed::Options),
    /// What the numerics survive: runs drawn from extremes, all audited; docs/verification/stress.md
    Stress(stress::Options),
}

fn main() -> ExitCode {
    let outcome = match Arguments::parse().task {
        Task::Ci => ci::run(),
        Task::Tidy => tidy::run(),
        Task::Fclib { folder } => fclib::run(folder),
        Task::Precision { names } => precision::run(&names),
        Task::Regress { names, update } => regress::run(&names, update),
        Task::Figures { names } => figures::run(&names),
        Task::Speed(options) => speed::run(&options),
        Task::Stress(options) => stress::run(&options),
    };
    match outcome {
        Ok(()) => ExitCode::SUCCESS,
        Err(message) => {
            eprintln!("xtask: {message}");
            ExitCode::FAILURE
        }
    }
}

/// Root of the workspace.
fn root() -> std::path::PathBuf {
    let manifest = std::path::Path::new(env!("CARGO_MANIFEST_DIR"));
    manifest.parent().unwrap_or(manifest).to_path_buf()
}
