//! Error against time of a case: a page and a plot in `docs/verification/precision`.

mod page;

use scenarios::output::{Axis, Chart, Curve, charts_svg};
use tests::{Case, Ladder, Measured, Ran, slope};

use crate::Outcome;
use crate::fclib::write_document;

/// A ladder that was climbed.
struct Climbed<'a> {
    ladder: &'a Ladder,
    rungs: Vec<Result<Measured, String>>,
    /// Value of each number of the finest rung it is compared with.
    finest: Vec<f64>,
    /// The last rung is that finest one.
    holds_finest: bool,
}

impl Climbed<'_> {
    /// Signed relative error of a number of a rung \[-\]; NaN for the reference itself and for runs that stopped.
    fn error(&self, rung: usize, number: usize) -> f64 {
        let Some(Ok(measured)) = self.rungs.get(rung) else {
            return f64::NAN;
        };
        let Some(found) = measured.found.get(number) else {
            return f64::NAN;
        };
        let is_reference = self.holds_finest && rung + 1 == self.rungs.len();
        match found.exact {
            None if is_reference => f64::NAN,
            _ => found.error(self.finest.get(number).copied()),
        }
    }

    /// Sizes, CPU seconds and absolute errors of a number, where there is one.
    fn points(&self, number: usize) -> Vec<(f64, f64, f64)> {
        let rungs = self.ladder.rungs.iter().zip(&self.rungs).enumerate();
        let points = rungs.filter_map(|(k, (rung, measured))| {
            let error = self.error(k, number).abs();
            let cpu = measured.as_ref().ok()?.cpu_s;
            (error.is_finite() && error > 0.0).then_some((rung.size, cpu, error))
        });
        points.collect()
    }

    /// Fitted order of convergence of a number; `None` below three points.
    fn order(&self, number: usize) -> Option<f64> {
        let points = self.points(number);
        let (sizes, errors): (Vec<f64>, Vec<f64>) = points.iter().map(|p| (p.0, p.2)).unzip();
        let order = slope(&sizes, &errors);
        (points.len() > 2 && order.is_finite()).then_some(order)
    }
}

/// Climbs all ladders of a case and writes its page.
pub(super) fn study(case: &Case) -> Outcome {
    println!("{}", case.name);
    let told = |result: &Result<Ran, String>| match result {
        Ok(ran) => println!("  {}: {:.2} s CPU", ran.plan.name, ran.summary.cpu_s),
        Err(reason) => println!("  {reason}"),
    };
    let climbed = climbed(case, case.climb(&told));
    if let Some(none) = climbed.iter().find(|c| c.rungs.iter().all(Result::is_err)) {
        return Err(format!(
            "{}, {}: no run reached its end",
            case.name, none.ladder.name
        ));
    }
    let name = |ending: &str| format!("precision/{}.{ending}", case.name);
    write_document(&name("svg"), &picture(case, &climbed)?)?;
    write_document(&name("md"), &page::markdown(case, &climbed))
}

fn climbed(case: &Case, results: Vec<Vec<Result<Measured, String>>>) -> Vec<Climbed<'_>> {
    let values = |rungs: &[Result<Measured, String>]| -> Vec<f64> {
        let last = rungs.last().and_then(|rung| rung.as_ref().ok());
        last.map_or(Vec::new(), |m| m.found.iter().map(|f| f.value).collect())
    };
    let first = results.first().map_or(Vec::new(), |rungs| values(rungs));
    let ladders = case.ladders.iter().zip(results);
    let climbed = ladders.map(|(ladder, rungs)| Climbed {
        ladder,
        finest: if ladder.against_first {
            first.clone()
        } else {
            values(&rungs)
        },
        holds_finest: !ladder.against_first,
        rungs,
    });
    climbed.collect()
}

/// Absolute error of the first number over CPU seconds, a curve a ladder.
fn picture(case: &Case, climbed: &[Climbed<'_>]) -> Result<String, String> {
    let curves = climbed.iter().map(|climbed| {
        let (cpu, error): (Vec<f64>, Vec<f64>) =
            climbed.points(0).iter().map(|p| (p.1, p.2)).unzip();
        Curve::new(climbed.ladder.name.clone(), &cpu, &error)
    });
    let drawn = curves.filter(|curve| !curve.points.is_empty()).collect();
    let first = climbed.iter().flat_map(|c| c.rungs.iter().flatten()).next();
    let quantity = first
        .and_then(|m| m.found.first())
        .map_or("error", |f| f.name);
    let y = Axis::logarithmic(&format!("Error of {quantity}"), "-");
    let chart = Chart::new(case.name, Axis::logarithmic("CPU", "s"), y, drawn);
    charts_svg(&[chart], 1)
}
