//! \[Feng2007\] figures 5 to 15: two soft blocks meet obliquely.

use std::fmt::Write as _;

use nscd::State;
use scenarios::Fields;
use scenarios::output::{Axis, Chart, Curve, Values, charts_svg};

use super::Figure;
use super::measure::{digits, largest_von_mises, peak};
use super::runs::{Planned, Ran, Shown, curve_each, over_time};

const FRICTION: [f64; 4] = [0.0, 0.2, 0.5, 0.8];
/// The runs that are shown.
const SHOWN: [usize; 2] = [1, 3];
const STEPS: usize = 100;
/// Steps of the pictures: the start, t = 0.4 and 0.6.
const PICTURES: [usize; 3] = [0, 39, 59];
/// The paper's largest von Mises stresses for the shown runs.
const PAPER_VON_MISES: [f64; 2] = [1330.0, 3330.0];
/// Digits in tables.
const ROUND: usize = 3;
/// Middles of the lower side of the upper block, of its trailing and of its leading edge: the paper's points are lost
/// with its figure 5.
const PROBES: &str = "output.probes={\"A\": (body: \"upper\", node: (1.0, 0.5, 1.25), quantities: [von_mises]), \
                      \"B\": (body: \"upper\", node: (1.0, 0.0, 1.25), quantities: [displacement]), \
                      \"C\": (body: \"upper\", node: (1.0, 1.0, 1.25), quantities: [von_mises])}";

pub(super) fn runs() -> Vec<Planned> {
    let times: Vec<f64> = (1..=STEPS).map(|k| k as f64 / STEPS as f64).collect();
    let run = |mu: f64| {
        let sets = [format!("blocks.mu={mu:?}"), PROBES.to_owned()];
        Planned::new(format!("mu = {mu}"), "impact", sets).keeping(&times)
    };
    FRICTION.map(run).to_vec()
}

pub(super) fn figures(runs: &[Ran]) -> Result<Vec<Figure>, String> {
    Ok(vec![
        start(runs)?,
        shapes(runs)?,
        Figure {
            number: "10 to 12",
            title: "Energies",
            pictures: vec![("fig10.svg", charts_svg(&energies(runs)?, 2)?)],
            caption: energy_caption(runs)?,
        },
        Figure {
            number: "13 to 15",
            title: "Stress at A and C, trace of B",
            pictures: vec![("fig13.svg", charts_svg(&points(runs)?, 2)?)],
            caption: point_caption(runs)?,
        },
    ])
}

/// Figure 5.
fn start(runs: &[Ran]) -> Result<Figure, String> {
    let first = runs.first().ok_or("no runs")?;
    let picture = first.deformed("Initial configuration", PICTURES[0])?;
    Ok(Figure {
        number: "5",
        title: "Initial configuration and mesh",
        pictures: vec![("fig05.svg", picture)],
        caption: format!(
            "After the first step of 0.01 s, in free flight: the colours are round-off. {} unknowns. The paper's mesh and its points A to D are lost with its figure: here A is the middle of \
             the lower side of the upper block, B the middle of its trailing lower edge (y = 0), C that of its leading one (y = 1), and the \
             plane BCD is x = 1.",
            first.summary.dofs
        ),
    })
}

/// The charts of figures 10 to 12.
fn energies(runs: &[Ran]) -> Result<[Chart; 3], String> {
    let energy = || Axis::linear("Energy", "J");
    let kinetic = curve_each(runs, "t", "energy.kinetic")?;
    let strain = curve_each(runs, "t", "energy.strain")?;
    Ok([
        over_time("(10) Kinetic energy", energy(), kinetic),
        over_time("(11) Strain energy", energy(), strain),
        over_time("(12) Total energy", energy(), totals(runs)?),
    ])
}

/// The charts of figures 13 to 15.
fn points(runs: &[Ran]) -> Result<[Chart; 3], String> {
    let stress = || Axis::linear("Stress", "Pa");
    let at_a = curve_each(runs, "t", "probe.A.von_mises")?;
    Ok([
        over_time("(13) Von Mises stress at A", stress(), at_a),
        over_time("(14) sigma_zz at C", stress(), normal_stress(runs)?),
        trace(runs)?,
    ])
}

/// Figures 6 to 9.
fn shapes(runs: &[Ran]) -> Result<Figure, String> {
    let mut pictures = Vec::new();
    let mut text = "| run | largest von Mises stress at t = 0.4 s [Pa] | at 0.6 s [Pa] | in the run [Pa] | paper [Pa] |\n|---|---:|---:|---:|---:|\n"
        .to_owned();
    let files = [["fig06.svg", "fig07.svg"], ["fig08.svg", "fig09.svg"]];
    for ((&index, files), paper) in SHOWN.iter().zip(files).zip(PAPER_VON_MISES) {
        let run = runs.get(index).ok_or("too few runs")?;
        let at = |k: usize| Ok::<f64, String>(largest_von_mises(run, run.snapshot(k)?));
        for (file, k) in files.into_iter().zip(&PICTURES[1..]) {
            let title = format!(
                "{}, t = {} s",
                run.plan.name,
                digits(run.snapshot(*k)?.time, 1)
            );
            pictures.push((file, run.deformed(&title, *k)?));
        }
        let all: Result<Vec<f64>, String> = (0..run.snapshots.len()).map(at).collect();
        let top = all?.into_iter().fold(0.0, f64::max);
        let _ = writeln!(
            text,
            "| {} | {} | {} | {} | {paper} |",
            run.plan.name,
            digits(at(PICTURES[1])?, 3),
            digits(at(PICTURES[2])?, 3),
            digits(top, 3)
        );
    }
    text += "\n**Agrees:** with mu = 0.2 the upper block slides and leaves upright, with 0.8 it sticks, leans forward and tumbles; friction raises the \
             stress. **Differs:** the largest stress. Stresses here are means over an element; at the edge that digs in they grow \
             with the fineness of the mesh, which the paper does not state.";
    Ok(Figure {
        number: "6 to 9",
        title: "Deformed shapes with von Mises stress",
        pictures,
        caption: text,
    })
}

fn totals(runs: &[Ran]) -> Result<Vec<Curve>, String> {
    let total = |run: &Ran| {
        let (kinetic, strain) = (run.column("energy.kinetic")?, run.column("energy.strain")?);
        let sum: Vec<f64> = kinetic.iter().zip(&strain).map(|(a, b)| a + b).collect();
        Ok(Curve::new(run.plan.name.clone(), &run.column("t")?, &sum))
    };
    runs.iter().map(total).collect()
}

/// The axial stress at C, of the states that were kept.
fn normal_stress(runs: &[Ran]) -> Result<Vec<Curve>, String> {
    let curve = |run: &Ran| {
        let node = run.probed("C")?;
        let time: Vec<f64> = run.snapshots.iter().map(|s| s.time).collect();
        let states = run.snapshots.iter();
        let stress: Vec<f64> = states.map(|s| nodal_axial_stress(run, s, node)).collect();
        Ok(Curve::new(run.plan.name.clone(), &time, &stress))
    };
    runs.iter().map(curve).collect()
}

/// Mean over the elements around the node \[Pa\].
fn nodal_axial_stress(run: &Ran, state: &State, node: u32) -> f64 {
    let fields = Fields::new(&run.built, state);
    let frame = fields.frame(&run.built, state);
    let stress = frame.cell_data.iter().find_map(|array| match array.values {
        Values::SymmetricTensor(values) => Some(values),
        _ => None,
    });
    let nodes = frame.cells.iter().flat_map(|cells| {
        let count = cells.kind.node_count();
        cells.connectivity.chunks_exact(count)
    });
    let around = nodes
        .zip(stress.unwrap_or_default().chunks_exact(6))
        .filter(|(cell, _)| cell.contains(&node));
    let (sum, count) = around.fold((0.0, 0.0), |(sum, n), (_, s)| (sum + s[2], n + 1.0));
    sum / count
}

/// Place of B in the plane x = 1.
fn trace(runs: &[Ran]) -> Result<Chart, String> {
    let curve = |run: &Ran| {
        let place = run.place("B")?;
        let moved = |axis: usize, name: &str| {
            let column = run.column(&format!("probe.B.displacement.{name}"))?;
            Ok::<Vec<f64>, String>(column.iter().map(|u| place[axis] + u).collect())
        };
        Ok(Curve::new(
            run.plan.name.clone(),
            &moved(1, "y")?,
            &moved(2, "z")?,
        ))
    };
    let curves: Result<Vec<Curve>, String> = runs.iter().map(curve).collect();
    let (y, z) = (Axis::linear("y", "m"), Axis::linear("z", "m"));
    Ok(Chart::new("(15) Trace of B", y, z, curves?))
}

fn energy_caption(runs: &[Ran]) -> Result<String, String> {
    let mut text = "| run | energy at the start [J] | at the end [J] | friction [J] | closing of contacts [J] | error of the time integration [J] |\n\
                    |---|---:|---:|---:|---:|---:|\n"
        .to_owned();
    for run in runs {
        let energy = |row: &dyn Fn(&str) -> Result<f64, String>| {
            Ok::<f64, String>(row("energy.kinetic")? + row("energy.strain")?)
        };
        let start = energy(&|name| run.column(name).map(|c| c[0]))?;
        let _ = writeln!(
            text,
            "| {} | {} | {} | {} | {} | {} |",
            run.plan.name,
            digits(start, 4),
            digits(energy(&|name| run.end(name))?, 4),
            digits(run.end("dissipation.friction")?, ROUND),
            digits(run.end("dissipation.impact")?, ROUND),
            digits(run.end("error.integration")?, 2),
        );
    }
    text += "\n**Agrees:** the total energy is nearly conserved without friction; the energy that friction takes is nearly the same for mu = 0.2 and \
             0.5 and less for 0.8, where the block hardly slides. **Differs:** nothing that the text of the paper states. The loss \
             without friction is that of nodes that close at the position level in the middle of a step.";
    Ok(text)
}

fn point_caption(runs: &[Ran]) -> Result<String, String> {
    let mut text = "| run | largest von Mises stress at A [Pa] | at C [Pa] | largest height of B over its start [m] |\n|---|---:|---:|---:|\n"
        .to_owned();
    for run in runs {
        let time = run.column("t")?;
        let top = |name: &str| Ok::<f64, String>(peak(&time, &run.column(name)?).1);
        let _ = writeln!(
            text,
            "| {} | {} | {} | {} |",
            run.plan.name,
            digits(top("probe.A.von_mises")?, ROUND),
            digits(top("probe.C.von_mises")?, ROUND),
            digits(top("probe.B.displacement.z")?, ROUND),
        );
    }
    text += "\n**Agrees:** a larger coefficient of friction raises the stress, and B goes higher: the block tumbles over its leading edge. \
             **Differs:** the paper's points are not known; at A, in the middle, mu = 0.2 is a little below mu = 0.";
    Ok(text)
}
