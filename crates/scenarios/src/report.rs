//! What the program prints: descriptions of scenes and the table that closes a run.

use std::fmt::Write as _;

use crate::energies::ENERGY_TERMS;
use crate::estimate::{Estimate, bytes, seconds};
use crate::output::{Status, Summary};
use crate::spec::{Body, Dilatation, Inertia, Interface, Prescribed, Scene, Symmetry};

/// A short description of a checked scene: bodies, unknowns, interfaces, steps.
#[must_use]
pub fn description(name: &str, scene: &Scene) -> String {
    let mut rows: Rows = scene.bodies.iter().map(|b| body_row(scene, b)).collect();
    rows.extend(scene.interfaces.iter().map(interface_row));
    rows.extend(scene.motions.iter().map(|m| motion_row(scene, m)));
    if scene.is_plane() {
        let section = match scene.symmetry.unwrap_or_default() {
            Symmetry::PlaneStrain => "plane strain, of 1 m thickness",
            Symmetry::Axisymmetric => "axisymmetric about y, whole rings",
        };
        rows.push(("symmetry".into(), section.into()));
    }
    let size = scene.size();
    rows.push(("elements".into(), size.elements.to_string()));
    let dofs = format!("{} (prescribed ones included)", size.dofs);
    rows.push(("dofs".into(), dofs));
    let inertia = match scene.time.inertia {
        Inertia::Dynamic => "dynamic",
        Inertia::QuasiStatic => "quasi-static",
    };
    let (count, time) = (scene.step_count(), &scene.time);
    let steps = format!("{count} of {} s to {} s, {inertia}", time.dt, time.end);
    rows.push(("steps".into(), steps));
    let estimate = Estimate::of(scene);
    let memory = format!("about {} without contacts", bytes(estimate.memory));
    rows.push(("memory".into(), memory));
    let time = format!(
        "roughly {} of CPU, to a factor of ten",
        seconds(estimate.time)
    );
    rows.push(("time".into(), time));
    let mut text = format!("{name}: {}\n{}", scene.title, aligned(&rows));
    for warning in scene.warnings() {
        let _ = writeln!(text, "warning: {warning}");
    }
    text
}

fn body_row(scene: &Scene, (name, body): (&String, &Body)) -> (String, String) {
    let size = body.mesh.size(scene.refine);
    let material = scene.materials.get(&body.material);
    let law = material.map_or("?", |material| material.law.name());
    let mut counts = format!(
        "{} elements, {} nodes, {law} `{}`",
        size.elements, size.nodes, body.material
    );
    if body.dilatation == Dilatation::Projected {
        counts += ", dilatation projected";
    }
    (format!("body {name}"), counts)
}

fn interface_row((name, interface): (&String, &Interface)) -> (String, String) {
    let master = interface.master.form().words;
    let mut words = format!("`{}` on {master}, mu = {}", interface.slave, interface.mu);
    if let Some(bonds) = &interface.adhesion {
        let _ = write!(words, ", adhesion w = {} J/m^2", bonds.energy);
    }
    (format!("interface {name}"), words)
}

fn motion_row(scene: &Scene, (name, given): (&String, &Prescribed)) -> (String, String) {
    let mut components = given.components.clone();
    components.retain(|c| c != 'z' || !scene.is_plane());
    let words = format!("`{}`, components {components}", given.nodes);
    (format!("motion {name}"), words)
}

fn aligned(rows: &[(String, String)]) -> String {
    let width = rows
        .iter()
        .map(|(name, _)| name.chars().count())
        .max()
        .unwrap_or(0);
    rows.iter()
        .map(|(name, value)| format!("  {name:<width$}  {value}\n"))
        .collect()
}

/// Counters, phases and the energy audit as aligned columns.
#[must_use]
pub fn closing_table(summary: &Summary) -> String {
    let mut text = match summary.status {
        Status::Completed => format!(
            "completed: {} steps to t = {}\n",
            summary.steps,
            short(summary.time)
        ),
        // The reasons are told as an error.
        Status::Unreliable => format!(
            "unreliable: {} steps to t = {}\n",
            summary.steps,
            short(summary.time)
        ),
        Status::Running | Status::Stopped => format!(
            "stopped at t = {} after {} steps\n",
            short(summary.time),
            summary.steps
        ),
    };
    for warning in &summary.warnings {
        text += &format!("warning: {warning}\n");
    }
    let columns = [counters(summary), phases(summary), energies(summary)];
    let rows = columns.iter().map(Vec::len).max().unwrap_or(0);
    text.push('\n');
    for i in 0..rows {
        let mut line = String::new();
        for column in &columns {
            let names = column
                .iter()
                .map(|(name, _)| name.chars().count())
                .max()
                .unwrap_or(0);
            let values = column
                .iter()
                .map(|(_, value)| value.chars().count())
                .max()
                .unwrap_or(0);
            let (name, value) = column
                .get(i)
                .map_or(("", ""), |(n, v)| (n.as_str(), v.as_str()));
            // A heading has no value and may run over both columns.
            let _ = write!(line, "{name:<names$}  {value:>values$}    ");
        }
        text += line.trim_end();
        text.push('\n');
    }
    text
}

type Rows = Vec<(String, String)>;

fn counters(summary: &Summary) -> Rows {
    let count = |name: &str, value: usize| (name.to_owned(), value.to_string());
    vec![
        ("Counters".to_owned(), String::new()),
        count("steps", summary.steps),
        count("rejected steps", summary.rejected_steps),
        count("Newton iterations", summary.newton_iterations),
        count("factorizations", summary.factorizations),
        count("contact solves", summary.contact_solves),
        count("contact iterations", summary.contact_iterations),
        count("most contacts", summary.contacts_max),
        count("dofs", summary.dofs),
        count("elements", summary.elements),
        (
            "max penetration [m]".to_owned(),
            format!("{:.2e}", summary.max_penetration),
        ),
        (
            "max contact error [-]".to_owned(),
            format!("{:.2e}", summary.max_contact_error),
        ),
    ]
}

fn phases(summary: &Summary) -> Rows {
    let mut rows = vec![
        ("Time [s]".to_owned(), String::new()),
        ("cpu".to_owned(), format!("{:.3}", summary.cpu_s)),
        ("wall".to_owned(), format!("{:.3}", summary.wall_s)),
    ];
    rows.extend(
        summary
            .phases
            .iter()
            .map(|(name, seconds)| (format!("- {name}"), format!("{seconds:.3}"))),
    );
    rows
}

fn energies(summary: &Summary) -> Rows {
    let energy = &summary.energy;
    let joule = |name: &str, value: f64| (name.to_owned(), format!("{value:.6e}"));
    let terms = ENERGY_TERMS.iter();
    let terms = terms.map(|term| joule(term.words, (term.value)(&energy.terms)));
    let mut rows = vec![
        (format!("Energy [{}]", summary.units.energy), String::new()),
        joule("initial", energy.initial),
        joule("final", energy.end),
    ];
    rows.extend(terms);
    rows.push(joule("unexplained", energy.unexplained()));
    rows
}

/// Lines of cells under each other, all of the same number of cells: numbers to the right, the columns in `words` to
/// the left.
#[must_use]
pub fn columns(lines: &[Vec<String>], words: &[usize]) -> String {
    let count = lines.first().map_or(0, Vec::len);
    let width = |k: usize| lines.iter().map(|line| line[k].chars().count()).max();
    let widths: Vec<usize> = (0..count).map(|k| width(k).unwrap_or(0)).collect();
    let mut text = String::new();
    for line in lines {
        let mut row = String::new();
        for (k, (cell, width)) in line.iter().zip(&widths).enumerate() {
            let _ = if words.contains(&k) {
                write!(row, "{cell:<width$}  ")
            } else {
                write!(row, "{cell:>width$}  ")
            };
        }
        text += row.trim_end();
        text.push('\n');
    }
    text
}

fn short(value: f64) -> String {
    format!("{}", format!("{value:.6e}").parse::<f64>().unwrap_or(value))
}
