//! What mesh and step do to the scenes with adhesion.

mod cases;
mod curve;
mod report;
mod runs;

use crate::Outcome;
use crate::fclib::write_document;
use runs::{Plan, Run, Sample};

/// A number of a run.
struct Quantity {
    name: &'static str,
    unit: &'static str,
    /// Factor from SI to the unit.
    scale: f64,
    /// `None` where it does not come about.
    read: fn(&[Sample]) -> Option<f64>,
}

/// A mesh and a step.
struct Level {
    mesh: &'static str,
    /// \[s\].
    dt: &'static str,
    sets: &'static [&'static str],
    /// Mesh and step are those of the scene.
    default: bool,
    /// Mesh and step are halved together from each of these levels to the next; the last is the reference.
    ladder: bool,
}

/// A scene with its levels.
struct Case {
    title: &'static str,
    about: &'static str,
    scene: &'static str,
    sets: &'static [&'static str],
    levels: &'static [Level],
    quantities: &'static [Quantity],
}

/// A level that was computed.
struct Row {
    level: &'static Level,
    run: Run,
    values: Vec<f64>,
}

struct Findings {
    case: &'static Case,
    rows: Vec<Row>,
}

impl Findings {
    /// The last rung.
    fn reference(&self) -> Option<&Row> {
        self.rows.iter().rfind(|row| row.level.ladder)
    }

    /// Deviation of every quantity from the reference [-].
    fn errors(&self, row: &Row) -> Vec<f64> {
        let reference = self.reference().map_or(&row.values, |r| &r.values);
        let pairs = row.values.iter().zip(reference);
        pairs.map(|(value, exact)| value / exact - 1.0).collect()
    }

    /// What the last three rungs approach, if each step between them is clearly smaller than the one before.
    fn limit(&self, quantity: usize) -> Option<f64> {
        let rungs = self.rows.iter().filter(|row| row.level.ladder);
        let values: Vec<f64> = rungs.map(|row| row.values[quantity]).collect();
        let &[.., a, b, c] = &values[..] else {
            return None;
        };
        let ratio = (b - a) / (c - b);
        (ratio > 1.3).then(|| c + (c - b) / (ratio - 1.0))
    }

    /// Largest deviation [-]; NaN if one is.
    fn worst(&self, row: &Row) -> f64 {
        let errors = self.errors(row).into_iter().map(f64::abs);
        errors.fold(0.0, |m, e| if e <= m { m } else { e })
    }
}

pub(super) fn run() -> Outcome {
    let plan = |case: &'static Case, level: &Level| {
        let sets = case.sets.iter().chain(level.sets).map(|s| s.to_string());
        let step = std::iter::once(format!("dt={}", level.dt));
        Plan {
            scene: case.scene,
            sets: sets.chain(step).collect(),
        }
    };
    let plans = cases::ALL.iter().flat_map(|case| {
        let levels = case.levels.iter();
        levels.map(move |level| plan(case, level))
    });
    let mut done = runs::all(&plans.collect::<Vec<_>>()).into_iter();
    let mut results = Vec::new();
    for case in cases::ALL {
        let levels = case.levels.iter().zip(&mut done);
        let rows = levels.map(|(level, run)| row(case, level, run?));
        results.push(Findings {
            case,
            rows: rows.collect::<Result<_, String>>()?,
        });
    }
    write_document("adhesion.md", &report::markdown(&results))?;
    write_document("adhesion.svg", &report::svg(&results)?)?;
    println!("docs/verification/adhesion.md and adhesion.svg written");
    Ok(())
}

fn row(case: &Case, level: &'static Level, run: Run) -> Result<Row, String> {
    let values = case.quantities.iter().map(|q| {
        let value = (q.read)(&run.samples).map(|v| v * q.scale);
        value.ok_or_else(|| format!("{}, {}: no {}", case.title, level.mesh, q.name))
    });
    Ok(Row {
        values: values.collect::<Result<_, String>>()?,
        level,
        run,
    })
}
