//! Work-precision of the contact methods: which error for which time.

mod report;

use cpu_time::ProcessTime;

use contact_bipotential::conformance::{brick_wall, half_space};
use contact_bipotential::{ContactProblem, Method, SolveSettings, errors, solve};

use crate::{Outcome, fclib};

/// Tolerances as they are written.
const TOLERANCES: [&str; 11] = [
    "1e-2", "1e-3", "1e-4", "1e-5", "1e-6", "1e-7", "1e-8", "1e-9", "1e-10", "1e-11", "1e-12",
];
/// Problems of other codes: capsules, a tower of bars, a periodic box of polyhedra.
const FILES: [&str; 3] = [
    "Capsules-i125-1213.hdf5",
    "KaplasTower-i1061-4.hdf5.dat",
    "LMGC_100_PR_PerioBox-i00361-60-03000.hdf5",
];
/// CPU seconds that a measurement covers, if [`MOST`] solves suffice.
const ENOUGH: f64 = 0.05;
const MOST: u32 = 2000;

/// A solve to one tolerance.
#[derive(Debug, Clone, Copy)]
struct Point {
    cpu: f64,
    /// Scale-free, recomputed from the reactions.
    error: f64,
    solved: bool,
}

/// A problem with the points of each method, those of the first tolerances of [`TOLERANCES`].
struct Study {
    name: String,
    contacts: usize,
    methods: Vec<(&'static str, Vec<Point>)>,
}

pub(super) fn run() -> Outcome {
    let mut studies = vec![
        generated("elastic half-space", &half_space(10, 0.4, 1e-2, 3e-3))?,
        generated("wall of rigid bricks", &brick_wall(4, 3, 0.6, 0.5))?,
    ];
    let folder = fclib::problem_folder(None);
    let files: Vec<_> = FILES.iter().map(|name| folder.join(name)).collect();
    if files.iter().all(|file| file.is_file()) {
        let program = fclib::build()?;
        for (name, file) in FILES.iter().zip(&files) {
            studies.push(stored(&program, name, file)?);
        }
    } else {
        println!("without the problems of other codes, which are not in FCLIB_DIR");
    }
    fclib::write_document("contact_precision.md", &report::markdown(&studies))?;
    fclib::write_document("contact_precision.svg", &report::svg(&studies)?)?;
    println!("docs/verification/contact_precision.md and contact_precision.svg written");
    Ok(())
}

/// Points at tighter and tighter tolerances, up to the first that is not reached: the next ones would not be either.
fn points(mut solve: impl FnMut(&str) -> Result<Point, String>) -> Result<Vec<Point>, String> {
    let mut points = Vec::new();
    for tolerance in TOLERANCES {
        let point = solve(tolerance)?;
        points.push(point);
        if !point.solved {
            break;
        }
    }
    Ok(points)
}

fn generated(name: &str, problem: &ContactProblem) -> Result<Study, String> {
    let mut methods = Vec::new();
    for method in Method::ALL {
        let points = points(|tolerance| {
            let tolerance = tolerance.parse().map_err(|e| format!("{tolerance}: {e}"))?;
            let settings = SolveSettings::default()
                .with_method(method)
                .with_tolerance(tolerance);
            Ok(measure(problem, &settings))
        })?;
        methods.push((method.name(), points));
    }
    println!("{name} done");
    Ok(Study {
        name: name.to_owned(),
        contacts: problem.contacts(),
        methods,
    })
}

fn measure(problem: &ContactProblem, settings: &SolveSettings) -> Point {
    let mut r = Vec::new();
    let clock = ProcessTime::now();
    let solved = solve(problem, &mut r, settings).is_converged();
    let (mut runs, mut spent) = (1, clock.elapsed().as_secs_f64());
    while spent < ENOUGH && runs < MOST {
        let _ = solve(problem, &mut Vec::new(), settings);
        runs += 1;
        spent = clock.elapsed().as_secs_f64();
    }
    Point {
        cpu: spent / f64::from(runs),
        error: errors(problem, &r).scale_free,
        solved,
    }
}

fn stored(program: &std::path::Path, name: &str, file: &std::path::Path) -> Result<Study, String> {
    let mut contacts = 0;
    let mut methods = Vec::new();
    for method in Method::ALL {
        let points = points(|tolerance| {
            let rows = fclib::solve(program, file, method.name(), tolerance)?;
            let row = rows.first().ok_or_else(|| format!("{name}: no result"))?;
            contacts = row.contacts.unwrap_or(0);
            Ok(Point {
                cpu: row.cpu(),
                error: row.error_scale_free.unwrap_or(f64::NAN),
                solved: row.solved(),
            })
        })?;
        methods.push((method.name(), points));
    }
    println!("{name} done");
    Ok(Study {
        name: name.to_owned(),
        contacts,
        methods,
    })
}
