//! `setae contact`: problems of any code, solved and tabulated.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clap::builder::PossibleValuesParser;
use clap::builder::TypedValueParser as _;
use contact_bipotential::{ContactProblem, Method, Outcome, SolveSettings, solve};
use scenarios::Stopwatch;
use scenarios::fclib;
use scenarios::report;
use serde::Serialize;

use crate::console::Console;
use crate::{STOPPED, UNUSABLE};

/// What to solve and how.
#[derive(clap::Args)]
pub(crate) struct Arguments {
    /// Problem files (Siconos .dat, FCLib .hdf5), or folders of such.
    #[arg(value_name = "PATH", required = true)]
    paths: Vec<PathBuf>,
    /// Largest error of a solution: by the measure of Siconos, the scale-free one, and each part of the law.
    #[arg(long, value_name = "TOL", default_value = "1e-8", value_parser = tolerance)]
    tol: f64,
    /// Algorithm.
    #[arg(long, default_value = "auto", value_parser = methods())]
    method: Method,
    /// Largest number of iterations (sweeps, Newton steps or projections) for each problem.
    #[arg(long, value_name = "N", default_value_t = SolveSettings::default().max_iterations as u32, value_parser = clap::value_parser!(u32).range(1..))]
    max_iterations: u32,
    /// Print a JSON array instead of a table.
    #[arg(long)]
    json: bool,
}

fn methods() -> impl clap::builder::TypedValueParser<Value = Method> {
    let names = PossibleValuesParser::new(Method::ALL.map(Method::name));
    names.try_map(|name| {
        let mut all = Method::ALL.into_iter();
        all.find(|m| m.name() == name).ok_or("unknown method")
    })
}

fn tolerance(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(x) if x > 0.0 && x < 1.0 => Ok(x),
        _ => Err("give a number between 0 and 1, as in 1e-8".to_owned()),
    }
}

/// One problem of the table. What an unreadable file lacks is left out.
#[derive(Debug, Serialize)]
struct Row {
    file: String,
    contacts: Option<usize>,
    method: Option<&'static str>,
    iterations: Option<usize>,
    error: Option<f64>,
    error_scale_free: Option<f64>,
    penetration: Option<f64>,
    cone_slack: Option<f64>,
    complementarity: Option<f64>,
    slip_misalignment: Option<f64>,
    status: &'static str,
    cpu_s: Option<f64>,
    norm_u: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    reason: Option<String>,
}

const CONVERGED: &str = "converged";
const NOT_CONVERGED: &str = "not converged";
const UNREADABLE: &str = "unreadable";

/// Solves and prints; the exit code is 0 if all is solved, 1 if something is not, 2 if something cannot be read.
pub(crate) fn run(arguments: &Arguments, console: &Console) -> ExitCode {
    let settings = SolveSettings::default()
        .with_method(arguments.method)
        .with_tolerance(arguments.tol)
        .with_max_iterations(arguments.max_iterations as usize);
    let clock = MeanClock::new();
    let mut rows = Vec::new();
    for path in &arguments.paths {
        match files(path) {
            Ok(files) => rows.extend(files.iter().map(|f| row(f, &settings, &clock))),
            Err(reason) => rows.push(unreadable(path, reason)),
        }
    }
    if arguments.json {
        console.say(&json(&rows));
    } else {
        console.say(&table(&rows));
    }
    let some = |status: &str| rows.iter().any(|r| r.status == status);
    if some(UNREADABLE) {
        ExitCode::from(UNUSABLE)
    } else if some(NOT_CONVERGED) {
        ExitCode::from(STOPPED)
    } else {
        ExitCode::SUCCESS
    }
}

/// The path itself, or the problem files of a folder by name.
fn files(path: &Path) -> Result<Vec<PathBuf>, String> {
    if !path.is_dir() {
        return Ok(vec![path.to_owned()]);
    }
    let entries = std::fs::read_dir(path).map_err(|e| e.to_string())?;
    let mut files = Vec::new();
    for entry in entries {
        let file = entry.map_err(|e| e.to_string())?.path();
        let known = |e: &std::ffi::OsStr| e == "dat" || e == "hdf5" || e == "h5";
        if file.extension().is_some_and(known) && file.is_file() {
            files.push(file);
        }
    }
    if files.is_empty() {
        return Err("a folder without .dat, .hdf5 and .h5 files".to_owned());
    }
    files.sort();
    Ok(files)
}

fn unreadable(path: &Path, reason: String) -> Row {
    Row {
        file: path.display().to_string(),
        contacts: None,
        method: None,
        iterations: None,
        error: None,
        error_scale_free: None,
        penetration: None,
        cone_slack: None,
        complementarity: None,
        slip_misalignment: None,
        status: UNREADABLE,
        cpu_s: None,
        norm_u: None,
        reason: Some(reason),
    }
}

fn row(path: &Path, settings: &SolveSettings, clock: &MeanClock) -> Row {
    let problem = match fclib::read(path) {
        Ok(problem) => problem,
        Err(error) => return unreadable(path, error.to_string()),
    };
    let (outcome, cpu) = clock.solve(&problem, settings);
    let converged = outcome.is_converged();
    Row {
        file: path.display().to_string(),
        contacts: Some(problem.contacts()),
        method: Some(outcome.method.name()),
        iterations: Some(outcome.iterations),
        error: Some(outcome.error),
        error_scale_free: Some(outcome.error_scale_free),
        penetration: Some(outcome.errors.penetration),
        cone_slack: Some(outcome.errors.cone),
        complementarity: Some(outcome.errors.complementarity),
        slip_misalignment: Some(outcome.errors.slip),
        status: if converged { CONVERGED } else { NOT_CONVERGED },
        cpu_s: Some(cpu),
        norm_u: Some(outcome.u.iter().map(|x| x * x).sum::<f64>().sqrt()),
        reason: (!converged).then(|| worst_contact(&outcome, settings.tolerance)),
    }
}

fn worst_contact(outcome: &Outcome, tolerance: f64) -> String {
    if let Some(refusal) = &outcome.refusal {
        return refusal.to_string();
    }
    let contacts = outcome.diagnostics.iter().enumerate();
    let worst = contacts.max_by(|a, b| a.1.error.total_cmp(&b.1.error));
    let parts = outcome.errors.parts().into_iter();
    let part = parts.max_by(|a, b| a.1.total_cmp(&b.1));
    let mut text = format!("above {tolerance:e}");
    if let Some((name, error)) = part {
        let _ = write!(text, "; {name} {error:.1e}");
    }
    if let Some((k, d)) = worst {
        let _ = write!(text, "; worst: contact {k}, {:?}", d.status);
    }
    text
}

/// Measures a solve by its mean over as many runs as the clock needs to see it.
struct MeanClock {
    /// CPU time that is long enough \[s\].
    enough: f64,
}

impl MeanClock {
    /// Ticks of the CPU clock that a measurement must cover.
    const TICKS: f64 = 20.0;
    /// Bounds of what is long enough \[s\], whatever the clock claims about its ticks.
    const ENOUGH: [f64; 2] = [1e-3, 0.5];
    /// Repetitions at most.
    const MOST: u32 = 2000;

    /// Finds the tick of the CPU clock: some count nanoseconds, some hundredths of a second.
    fn new() -> Self {
        let start = Stopwatch::start();
        let mut now = start.cpu_s();
        // From an edge to the next.
        let first = now;
        while now == first {
            now = start.cpu_s();
        }
        let edge = now;
        while now == edge {
            now = start.cpu_s();
        }
        let [least, most] = Self::ENOUGH;
        MeanClock {
            enough: (Self::TICKS * (now - edge)).clamp(least, most),
        }
    }

    /// The outcome from a cold start and the CPU seconds of one solve.
    fn solve(&self, problem: &ContactProblem, settings: &SolveSettings) -> (Outcome, f64) {
        let clock = Stopwatch::start();
        let outcome = solve(problem, &mut Vec::new(), settings);
        let mut runs = 1;
        let mut spent = clock.cpu_s();
        while spent < self.enough && runs < Self::MOST {
            let _ = solve(problem, &mut Vec::new(), settings);
            runs += 1;
            spent = clock.cpu_s();
        }
        (outcome, spent / f64::from(runs))
    }
}

fn json(rows: &[Row]) -> String {
    // Rows hold strings and finite numbers: they always have a JSON form.
    let text = serde_json::to_string_pretty(rows).unwrap_or_default();
    text + "\n"
}

const HEADS: [&str; 13] = [
    "file",
    "contacts",
    "method",
    "iterations",
    "error",
    "scale-free",
    "penetration",
    "cone",
    "complement.",
    "slip",
    "status",
    "cpu_s",
    "norm_u",
];

/// The columns of [`HEADS`] that are words: file, method, status.
const WORDS: [usize; 3] = [0, 2, 10];

fn table(rows: &[Row]) -> String {
    let mut lines = vec![HEADS.map(str::to_owned).to_vec()];
    lines.extend(rows.iter().map(|row| cells(row).to_vec()));
    let mut text = report::columns(&lines, &WORDS);
    for row in rows {
        if let Some(reason) = &row.reason {
            let _ = writeln!(text, "{}: {}: {reason}", row.status, row.file);
        }
    }
    let solved = rows.iter().filter(|r| r.status == CONVERGED).count();
    // An empty sum is -0.
    let cpu: f64 = rows.iter().filter_map(|r| r.cpu_s).sum::<f64>() + 0.0;
    let _ = writeln!(
        text,
        "{solved} of {} solved, {cpu:.3} CPU seconds",
        rows.len()
    );
    text
}

fn cells(row: &Row) -> [String; HEADS.len()] {
    let count = |n: Option<usize>| n.map_or_else(|| "-".to_owned(), |n| n.to_string());
    let small = |x: Option<f64>| x.map_or_else(|| "-".to_owned(), |x| format!("{x:.1e}"));
    let name = Path::new(&row.file).file_name();
    [
        name.map_or_else(|| row.file.clone(), |n| n.to_string_lossy().into_owned()),
        count(row.contacts),
        row.method.unwrap_or("-").to_owned(),
        count(row.iterations),
        small(row.error),
        small(row.error_scale_free),
        small(row.penetration),
        small(row.cone_slack),
        small(row.complementarity),
        small(row.slip_misalignment),
        row.status.to_owned(),
        row.cpu_s
            .map_or_else(|| "-".to_owned(), |x| format!("{x:.2e}")),
        row.norm_u
            .map_or_else(|| "-".to_owned(), |x| format!("{x:.7e}")),
    ]
}
