//! Figure 6: bonds between a stiff ball and a soft block.

use std::fmt::Write as _;

use scenarios::output::{Axis, Chart, Curve, charts_svg};

use super::Figure;
use super::measure::{digits, first_above, first_below_after_peak, peak};
use super::runs::{Planned, Ran, Shown, curve_each, over_time};

/// `w` \[J/m^2\] and `C_n` \[N/m^3\].
const CASES: [(f64, f64); 3] = [(20.0, 2e9), (20.0, 4e9), (40.0, 2e9)];
/// Nodes outward from the pole.
const NODES: usize = 7;
/// Node A.
const A: &str = "n5";
const HALF: f64 = 0.5;

pub(super) fn runs() -> Vec<Planned> {
    let case = |(i, (w, stiffness)): (usize, &(f64, f64))| {
        let sets = [
            format!("adhesion.w={w:?}"),
            format!("adhesion.C_n={stiffness:?}"),
        ];
        Planned::new(format!("case {}", i + 1), "indentation", &sets)
    };
    CASES.iter().enumerate().map(case).collect()
}

pub(super) fn figures(runs: &[Ran]) -> Result<Vec<Figure>, String> {
    let first = runs.first().ok_or("no runs")?;
    let traction = || Axis::linear("Normal bond traction", "Pa");
    let beta = || Axis::linear("beta", "-");
    let at_a = |run: &Ran| {
        let (time, traction) = (run.column("t")?, run.traction(A)?);
        Ok(Curve::new(run.plan.name.clone(), &time, &traction))
    };
    let at_a: Result<Vec<Curve>, String> = runs.iter().map(at_a).collect();
    let (betas, tractions) = nodes(first)?;
    let a_beta = format!("probe.{A}.beta");
    let charts = [
        over_time("(a) Intensity at 7 nodes, case 1", beta(), betas),
        acting(
            "(b) Bond traction at 7 nodes, case 1",
            traction(),
            tractions,
        ),
        over_time(
            "(c) Intensity at node A",
            beta(),
            curve_each(runs, "t", &a_beta)?,
        ),
        acting("(d) Bond traction at node A", traction(), at_a?),
    ];
    Ok(vec![Figure {
        number: "6",
        title: "Bonding and debonding under a ball",
        pictures: vec![("fig06.svg", charts_svg(&charts, 2)?)],
        caption: caption(runs)?,
    }])
}

/// `beta` and the traction of all nodes over time.
fn nodes(run: &Ran) -> Result<(Vec<Curve>, Vec<Curve>), String> {
    let time = run.column("t")?;
    let (mut betas, mut tractions) = (Vec::new(), Vec::new());
    for i in 0..NODES {
        let probe = format!("n{i}");
        let name = format!("d = {} mm", digits(1e3 * run.place(&probe)?[0], 2));
        let beta = run.column(&format!("probe.{probe}.beta"))?;
        betas.push(Curve::new(name.clone(), &time, &beta));
        tractions.push(Curve::new(name, &time, &run.traction(&probe)?));
    }
    Ok((betas, tractions))
}

/// Over the time in which the bonds pull.
fn acting(title: &str, y: Axis, mut curves: Vec<Curve>) -> Chart {
    let points = || curves.iter().flat_map(|c| &c.points);
    let least = 1e-3 * points().map(|(_, pull)| *pull).fold(0.0, f64::max);
    let times = points().filter(|(_, pull)| *pull > least).map(|(t, _)| *t);
    let (from, to) = times.fold((f64::INFINITY, 0.0_f64), |(a, b), t| (a.min(t), b.max(t)));
    let room = 0.05 * (to - from);
    for curve in &mut curves {
        curve
            .points
            .retain(|(t, _)| *t >= from - room && *t <= to + room);
    }
    over_time(title, y, curves)
}

fn seconds(time: Option<f64>) -> String {
    time.map_or("-".to_owned(), |t| digits(t, 3))
}

fn caption(runs: &[Ran]) -> Result<String, String> {
    let first = runs.first().ok_or("no runs")?;
    let time = first.column("t")?;
    let mut text = "Tractions are nodal forces over the share of the surface that the node has: the run is axisymmetric, and the rings grow \
        with d.\n\n\
        | node | d [mm] | bonds form from [s] | largest beta | largest pull [Pa] | at [s] | beta < 1/2 at [s] |\n\
        |---|---:|---:|---:|---:|---:|---:|\n"
        .to_owned();
    let mut tops = Vec::new();
    for i in 0..NODES {
        let probe = format!("n{i}");
        let beta = first.column(&format!("probe.{probe}.beta"))?;
        let (at, top) = peak(&time, &first.traction(&probe)?);
        tops.push(top);
        let _ = writeln!(
            text,
            "| {probe} | {} | {} | {} | {} | {} | {} |",
            digits(1e3 * first.place(&probe)?[0], 3),
            seconds(first_above(&time, &beta, 0.0)),
            digits(peak(&time, &beta).1, 3),
            digits(top, 3),
            seconds(Some(at)),
            seconds(first_below_after_peak(&time, &beta, HALF)),
        );
    }
    text += "\nFigure 6 (e), and what node A does; s0 = sqrt(w C_n), x0 = sqrt(w / C_n):\n\n\
             | case | w [J/m^2] | C_n [N/m^3] | s0 [Pa] | x0 [mm] | largest pull [Pa] | at [s] | beta < 1/2 at [s] |\n\
             |---|---:|---:|---:|---:|---:|---:|---:|\n";
    for (run, (w, stiffness)) in runs.iter().zip(CASES) {
        let time = run.column("t")?;
        let (at, top) = peak(&time, &run.traction(A)?);
        let beta = run.column(&format!("probe.{A}.beta"))?;
        let _ = writeln!(
            text,
            "| {} | {w} | {stiffness:e} | {} | {} | {} | {} | {} |",
            run.plan.name,
            digits((w * stiffness).sqrt(), 3),
            digits(1e3 * (w / stiffness).sqrt(), 3),
            digits(top, 3),
            seconds(Some(at)),
            seconds(first_below_after_peak(&time, &beta, HALF))
        );
    }
    let (least, most) = tops
        .iter()
        .fold((f64::INFINITY, 0.0_f64), |(a, b), t| (a.min(*t), b.max(*t)));
    let _ = write!(
        text,
        "\n**Agrees:** nodes bond in the order of their distance from O and part in the opposite order, with curves of one shape; the \
         distance hardly changes the pull at separation (largest over least: {}); a larger C_n or w pulls harder.\n\n**Differs:** with \
         a larger C_n a bond carries more but over a shorter way, so beta falls earlier, with a larger w later. The tables and pictures \
         of the paper are lost: its three parameter sets, radius, depth and mesh are choices of the scene; node A is at d = {} mm (paper: \
         3.4 mm). The ball is rigid (paper: 1600 times stiffer than the block; the scene `indentation-elastic` has it). Beta stays above epsilon until the end: the opening is slow, so beta = w / k, 1e-4 only at a gap of 100 x0.",
        digits(most / least, 3),
        digits(1e3 * first.place(A)?[0], 2),
    );
    Ok(text)
}
