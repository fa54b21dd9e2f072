//! Figure 1 of the supplement: how small the bond force is where bonds count as broken.

use scenarios::output::{Axis, Chart, Curve, charts_svg};

use super::Figure;
use super::measure::{digits, peak};
use super::runs::{Planned, Ran};

const NODE: &str = "pole";
const EPSILON: f64 = 1e-4;

pub(super) fn runs() -> Vec<Planned> {
    vec![Planned::new("debonding", "debonding", [""; 0])]
}

pub(super) fn figures(runs: &[Ran]) -> Result<Vec<Figure>, String> {
    let run = runs.first().ok_or("no runs")?;
    let (beta, force) = branch(run)?;
    let (_, top) = peak(&beta, &force);
    let chart = Chart::new(
        "Bond force while the node debonds",
        Axis::logarithmic("beta", "-"),
        Axis::logarithmic("Bond force", "N/m"),
        vec![
            Curve::mark("epsilon", (EPSILON, top), (EPSILON, last(&force))),
            Curve::new("node", &beta, &force),
        ],
    );
    Ok(vec![Figure {
        number: "S1",
        title: "Bond force over intensity",
        pictures: vec![("figS1.svg", charts_svg(&[chart], 1)?)],
        caption: caption(&beta, &force),
    }])
}

/// `beta` and the size of the bond force of the node from its largest `beta` on, as long as both are there.
fn branch(run: &Ran) -> Result<(Vec<f64>, Vec<f64>), String> {
    let beta = run.column(&format!("probe.{NODE}.beta"))?;
    let normal = run.column(&format!("probe.{NODE}.adhesion_normal"))?;
    let tangential = run.column(&format!("probe.{NODE}.adhesion_tangential"))?;
    let steps: Vec<f64> = (0..beta.len()).map(|k| k as f64).collect();
    let start = peak(&steps, &beta).0 as usize;
    let rows = (start..beta.len()).map(|k| (beta[k], normal[k].hypot(tangential[k])));
    Ok(rows
        .filter(|(beta, force)| *beta > 0.0 && *force > 0.0)
        .unzip())
}

fn last(values: &[f64]) -> f64 {
    values.last().copied().unwrap_or(f64::NAN)
}

fn caption(beta: &[f64], force: &[f64]) -> String {
    let (at, top) = peak(beta, force);
    // The slope behind the peak, where beta is small.
    let small = beta
        .iter()
        .zip(force)
        .filter(|(beta, _)| **beta < 0.1 && **beta < at);
    let small: Vec<(f64, f64)> = small.map(|(b, f)| (b.log10(), f.log10())).collect();
    let slope = match (small.first(), small.last()) {
        (Some(a), Some(b)) if a.0 > b.0 => digits((a.1 - b.1) / (a.0 - b.0), 3),
        _ => "-".to_owned(),
    };
    format!(
        "From intact bonds (right) the force rises with the separation to {} N/m at beta = {}, then falls. Mean slope below beta = 0.1: {slope}. \
         At the last step before the bond is forgotten beta = {} and the force is {} N/m, {} of the peak.\n\nThe paper: the force grows first, \
         then falls fast to the order of 1e-9 at beta = 1e-4 (unit not given). Slow separation follows beta = w / k, so the force falls as \
         beta^(3/2), to 1e-6 of its scale at epsilon; separation faster than w / b falls as beta^2 at nearly constant distance, to 1e-8. With \
         nodal forces of some N or less both leave what the paper calls negligible.",
        digits(top, 3),
        digits(at, 3),
        digits(last(beta), 3),
        digits(last(force), 3),
        digits(last(force) / top, 2),
    )
}
