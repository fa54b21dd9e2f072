//! Figures 9 and 10: a soft plate drawn over a soft half-cylinder.

use std::fmt::Write as _;

use scenarios::output::{Axis, Chart, Curve, charts_svg};

use super::Figure;
use super::measure::{digits, first_below_after_peak, milliseconds, peak};
use super::runs::{Planned, Ran, Shown, curve_each, over_time};

/// Times of descent \[ms\]: 1000, 500, 333, 250 and 200 mm/s over 1 mm. Case 1 is the first.
const DESCENTS: [f64; 5] = [1.0, 2.0, 3.0, 4.0, 5.0];
const FRICTION: [f64; 5] = [0.0, 0.2, 0.4, 0.6, 0.8];
/// Time of sliding at 1 m/s \[ms\].
const SLIDING: f64 = 8.0;
/// The slave node on the line of first contact: bonds belong to slave nodes.
const NODE: &str = "cylinder";
/// Intensity of a bond that has let go.
const DEFAULT_THRESHOLD: f64 = 0.1;

/// The motion of the plate in the five cases.
fn descent(milliseconds: f64) -> [String; 2] {
    let (down, end) = (1e-3 * milliseconds, 1e-3 * (milliseconds + SLIDING));
    let slide = 1e-3 * SLIDING;
    [
        format!(
            "drive.motion.translation=([({down:?}, 0.0), ({end:?}, {slide:?})], [(0.0, 0.0), ({down:?}, -0.001)], 0.0)"
        ),
        format!("time.end={end:?}"),
    ]
}

/// First the coefficients of friction of case 1, then the other cases without friction.
pub(super) fn runs() -> Vec<Planned> {
    let run = |name: String, milliseconds: f64, mu: f64| {
        let mut sets = descent(milliseconds).to_vec();
        sets.push(format!("contact.mu={mu:?}"));
        let times = [1e-3 * milliseconds, 1e-3 * (milliseconds + SLIDING)];
        Planned::new(name, "plate-cylinder", &sets).keeping(&times)
    };
    let rough = FRICTION.map(|mu| run(format!("mu = {mu}"), DESCENTS[0], mu));
    let slow = DESCENTS[1..].iter().enumerate();
    let slow = slow.map(|(i, time)| run(format!("case {}", i + 2), *time, 0.0));
    rough.into_iter().chain(slow).collect()
}

pub(super) fn figures(runs: &[Ran]) -> Result<Vec<Figure>, String> {
    let rough: Vec<&Ran> = runs.iter().take(FRICTION.len()).collect();
    let cases: Vec<&Ran> = runs
        .iter()
        .take(1)
        .chain(runs.iter().skip(FRICTION.len()))
        .collect();
    let curves = Figure {
        number: "10",
        title: "Bonds between plate and half-cylinder",
        pictures: vec![("fig10.svg", charts_svg(&charts(&rough, &cases)?, 2)?)],
        caption: caption(&rough, &cases)?,
    };
    Ok(vec![shapes(runs)?, curves])
}

/// Figure 9.
fn shapes(runs: &[Ran]) -> Result<Figure, String> {
    let shown = runs.get(2).ok_or("no runs")?;
    Ok(Figure {
        number: "9 b-c",
        title: "Von Mises stress of plate and half-cylinder",
        pictures: vec![
            (
                "fig09b.svg",
                shown.deformed("(b) At the end of the descent", 0)?,
            ),
            (
                "fig09c.svg",
                shown.deformed("(c) At the end of the run", 1)?,
            ),
        ],
        caption: format!(
            "Case 1 with {}. The paper: a slight compression at the onset of sliding; then the cylinder is dragged along and leans. \
             Parts of the plate that are out of contact are drawn too; a plate of this length touches the cylinder throughout.",
            shown.plan.name
        ),
    })
}

/// The charts of figure 10.
fn charts(rough: &[&Ran], cases: &[&Ran]) -> Result<[Chart; 4], String> {
    let (beta, force) = (
        format!("probe.{NODE}.beta"),
        format!("probe.{NODE}.adhesion_tangential"),
    );
    let intensity = || Axis::linear("beta", "-");
    let traction = || Axis::linear("Tangential bond force", "N/m");
    let named = |mut curves: Vec<Curve>| {
        if let Some(first) = curves.first_mut() {
            first.name = "case 1".to_owned();
        }
        curves
    };
    let each = |runs: &[&Ran], y: &str| curve_each(runs.iter().copied(), "t", y);
    Ok([
        over_time("(b) Intensity in case 1", intensity(), each(rough, &beta)?),
        over_time(
            "(c) Intensity, mu = 0",
            intensity(),
            named(each(cases, &beta)?),
        ),
        over_time(
            "(d) Tangential bond force in case 1",
            traction(),
            each(rough, &force)?,
        ),
        over_time(
            "(e) Tangential bond force, mu = 0",
            traction(),
            named(each(cases, &force)?),
        ),
    ])
}

fn caption(rough: &[&Ran], cases: &[&Ran]) -> Result<String, String> {
    let mut text = "Figure 10 (a), and what the node does with mu = 0:\n\n\
        | case | descent [ms] | speed [mm/s] | beta at the onset of sliding | largest tangential bond force [N/m] | at [ms] | beta < 0.1 at [ms] |\n\
        |---|---:|---:|---:|---:|---:|---:|\n"
        .to_owned();
    for (i, (run, down)) in cases.iter().zip(DESCENTS).enumerate() {
        let (time, beta) = (run.column("t")?, run.column(&format!("probe.{NODE}.beta"))?);
        let onset = time.partition_point(|t| *t < 1e-3 * down * (1.0 - 1e-9));
        let _ = writeln!(
            text,
            "| {} | {down} | {} | {} | {}",
            i + 1,
            digits(1e3 / down, 3),
            digits(beta.get(onset).copied().unwrap_or(f64::NAN), 3),
            ends(run)?
        );
    }
    text += "\nCase 1 with friction:\n\n| | largest beta | largest tangential bond force [N/m] | at [ms] | beta < 0.1 at [ms] |\n\
             |---|---:|---:|---:|---:|\n";
    for run in rough {
        let beta = run.column(&format!("probe.{NODE}.beta"))?;
        let (_, top) = peak(&run.column("t")?, &beta);
        let _ = writeln!(
            text,
            "| {} | {} | {}",
            run.plan.name,
            digits(top, 3),
            ends(run)?
        );
    }
    text += "\n**Agrees:** beta reaches 0.2 in the fastest descent and 1 in the slowest; rougher surfaces and slower descents give stronger \
             bonds, later debonding and larger tangential bond forces.\n\n**Differs:** the paper follows a node of the plate; bonds belong to slave nodes here, and these \
             are the nodes of the cylinder, so the curves are those of its top node. Forces are per metre of thickness.";
    Ok(text)
}

/// The last cells of a row: largest tangential bond force, its time, the time of debonding.
fn ends(run: &Ran) -> Result<String, String> {
    let (time, beta) = (run.column("t")?, run.column(&format!("probe.{NODE}.beta"))?);
    let (at, top) = peak(
        &time,
        &run.column(&format!("probe.{NODE}.adhesion_tangential"))?,
    );
    let broken = first_below_after_peak(&time, &beta, DEFAULT_THRESHOLD);
    Ok(format!(
        "{} | {} | {} |",
        digits(top, 4),
        milliseconds(Some(at)),
        milliseconds(broken)
    ))
}
