//! All methods of the contact solver on the problems of other codes, as a table and as performance profiles.

pub(crate) mod profile;
mod report;

use std::path::{Path, PathBuf};
use std::process::Command;

use serde::Deserialize;

use crate::{Outcome, root};

/// Methods in the order of the columns, as `setae contact --method` knows them.
const METHODS: [&str; 9] = [
    "auto",
    "proximal",
    "newton",
    "gauss-seidel",
    "gauss-seidel-anderson",
    "gauss-seidel-bipotential",
    "joli-feng",
    "uzawa",
    "uzawa-anderson",
];
/// Tolerances as they are written.
const TOLERANCES: [&str; 2] = ["1e-8", "1e-12"];

/// What one method made of one problem.
#[derive(Debug, Clone, Deserialize)]
pub(crate) struct Solve {
    file: String,
    pub(crate) contacts: Option<usize>,
    error: Option<f64>,
    pub(crate) error_scale_free: Option<f64>,
    status: String,
    cpu_s: Option<f64>,
}

impl Solve {
    fn name(&self) -> String {
        let name = Path::new(&self.file).file_name();
        name.map_or_else(|| self.file.clone(), |n| n.to_string_lossy().into_owned())
    }

    pub(crate) fn solved(&self) -> bool {
        self.status == "converged"
    }

    pub(crate) fn cpu(&self) -> f64 {
        self.cpu_s.unwrap_or(f64::NAN)
    }

    /// The larger of the two errors.
    fn worst(&self) -> f64 {
        let none = f64::NAN;
        self.error
            .unwrap_or(none)
            .max(self.error_scale_free.unwrap_or(none))
    }
}

/// All solves to one tolerance: a list a method, problems in the same order.
struct Study {
    tolerance: &'static str,
    methods: Vec<(&'static str, Vec<Solve>)>,
}

pub(crate) fn run(folder: Option<PathBuf>) -> Outcome {
    let folder = problem_folder(folder);
    if !folder.is_dir() {
        println!(
            "skipped: no folder {} (name one, or set FCLIB_DIR)",
            folder.display()
        );
        return Ok(());
    }
    let program = build()?;
    let mut studies = Vec::new();
    for tolerance in TOLERANCES {
        let mut methods = Vec::new();
        for method in METHODS {
            let solves = solve(&program, &folder, method, tolerance)?;
            let solved = solves.iter().filter(|s| s.solved()).count();
            println!("{tolerance} {method}: {solved} of {} solved", solves.len());
            methods.push((method, solves));
        }
        studies.push(Study { tolerance, methods });
    }
    write_document("fclib.md", &report::markdown(&studies))?;
    write_document("fclib_profile.svg", &profile::svg(&studies)?)?;
    println!("docs/verification/fclib.md and fclib_profile.svg written");
    Ok(())
}

/// Writes a file of `docs/verification`.
pub(crate) fn write_document(name: &str, text: &str) -> Outcome {
    let path = root().join("docs/verification").join(name);
    let folder = path.parent().unwrap_or(&path);
    std::fs::create_dir_all(folder)
        .and_then(|()| std::fs::write(&path, text))
        .map_err(|e| format!("{}: {e}", path.display()))
}

/// The folder of the problem files: the one named, `$FCLIB_DIR`, or `../shared/fclib`.
pub(crate) fn problem_folder(named: Option<PathBuf>) -> PathBuf {
    let named = named.or_else(|| std::env::var_os("FCLIB_DIR").map(PathBuf::from));
    named.unwrap_or_else(|| root().join("../shared/fclib"))
}

pub(crate) fn build() -> Result<PathBuf, String> {
    let cargo = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    let built = Command::new(cargo)
        .args(["build", "--release", "--quiet", "--package", "scenarios"])
        .current_dir(root())
        .status();
    if !built.is_ok_and(|s| s.success()) {
        return Err("the program setae does not build".to_owned());
    }
    let target = std::env::var_os("CARGO_TARGET_DIR").map(PathBuf::from);
    let target = target.unwrap_or_else(|| root().join("target"));
    Ok(target.join("release/setae"))
}

pub(crate) fn solve(
    program: &Path,
    folder: &Path,
    method: &str,
    tolerance: &str,
) -> Result<Vec<Solve>, String> {
    let mut command = Command::new(program);
    command.arg("contact").arg(folder).arg("--json");
    command.args(["--method", method, "--tol", tolerance]);
    let output = command
        .output()
        .map_err(|e| format!("{}: {e}", program.display()))?;
    serde_json::from_slice(&output.stdout).map_err(|e| {
        let said = String::from_utf8_lossy(&output.stderr);
        format!("setae contact --method {method} gave no table: {e}\n{said}")
    })
}
