//! The table of a sweep: a row a run.

use super::{Outcome, Planned, Sweep};
use crate::energies::ENERGY_TERMS;
use crate::output::{History, OutputError, Summary, Units};
use crate::report;
use crate::spec::Extent;

/// Columns of `sweep.csv` after the varied fields that come from the summary; the energies follow.
const COLUMNS: [&str; 12] = [
    "folder",
    "status",
    "reason",
    "time",
    "steps",
    "rejected_steps",
    "newton_iterations",
    "factorizations",
    "contacts_max",
    "cpu_s",
    "wall_s",
    "max_penetration",
];

impl Sweep {
    /// `sweep.csv`: the varied fields by their full paths, how each run ended and what it cost, energies at the end,
    /// then `peak.force.<name>` (largest norm) and `peak.force.<name>.t` \[s\] of every force, the largest and the
    /// smallest value of each of its components, `peak.force.<name>.y.max` and `.min`, and the last value of every
    /// probe. Forces are in N, in plane strain in N/m; the radial integral of an axisymmetric scene is none and left
    /// out. What a run does not have is empty.
    pub(super) fn csv(&self, outcomes: &[Outcome]) -> Result<Vec<u8>, OutputError> {
        let measures: Vec<Vec<(String, f64)>> = self
            .runs
            .iter()
            .zip(outcomes)
            .map(|(planned, outcome)| measures(outcome, planned.extent()))
            .collect();
        let mut names: Vec<&String> = Vec::new();
        for (name, _) in measures.iter().flatten() {
            if !names.contains(&name) {
                names.push(name);
            }
        }
        let mut writer = csv::Writer::from_writer(Vec::new());
        let head = self.paths.iter().map(String::as_str).chain(COLUMNS);
        let head = head.chain(names.iter().map(|name| name.as_str()));
        let mut done = writer.write_record(head);
        for ((planned, outcome), measured) in self.runs.iter().zip(outcomes).zip(&measures) {
            let mut row = planned.values.clone();
            row.push(planned.folder.clone());
            row.extend(counts(outcome));
            row.extend(names.iter().map(|name| {
                let found = measured.iter().find(|(known, _)| known == *name);
                found.map_or_else(String::new, |(_, value)| format!("{value:?}"))
            }));
            done = done.and_then(|()| writer.write_record(row));
        }
        let bytes = done
            .map_err(std::io::Error::from)
            .and_then(|()| writer.into_inner().map_err(|e| e.into_error()));
        bytes.map_err(|source| OutputError::File {
            path: "sweep.csv".into(),
            source,
        })
    }

    /// The table for people: varied fields, status, costs and peaks of the forces.
    #[must_use]
    pub fn table(&self, outcomes: &[Outcome]) -> String {
        let mut heads = vec!["run".to_owned()];
        heads.extend(self.names.iter().cloned());
        heads.extend(
            ["status", "steps", "rejected", "contacts", "cpu_s", "wall_s"].map(str::to_owned),
        );
        let words = [self.names.len() + 1];
        let mut forces: Vec<String> = Vec::new();
        let extent = self.runs.first().map_or(Extent::Whole, Planned::extent);
        for peak in (outcomes.iter()).flat_map(|outcome| peaks(&outcome.history, extent)) {
            if !forces.contains(&peak.name) {
                forces.push(peak.name);
            }
        }
        let unit = Units::of(extent).force;
        heads.extend(forces.iter().map(|name| format!("peak {name} [{unit}]")));
        let mut lines = vec![heads];
        for (i, (planned, outcome)) in self.runs.iter().zip(outcomes).enumerate() {
            let mut line = vec![(i + 1).to_string()];
            line.extend(planned.values.iter().cloned());
            line.push(outcome.status().to_owned());
            let number = |pick: fn(&Summary) -> String| {
                outcome
                    .summary
                    .as_ref()
                    .map_or_else(|_| "-".to_owned(), pick)
            };
            line.push(number(|s| s.steps.to_string()));
            line.push(number(|s| s.rejected_steps.to_string()));
            line.push(number(|s| s.contacts_max.to_string()));
            line.push(number(|s| format!("{:.2}", s.cpu_s)));
            line.push(number(|s| format!("{:.2}", s.wall_s)));
            let peaks = peaks(&outcome.history, planned.extent());
            line.extend(forces.iter().map(|force| {
                let found = peaks.iter().find(|peak| peak.name == *force);
                found.map_or_else(|| "-".to_owned(), |peak| format!("{:.5e}", peak.norm))
            }));
            lines.push(line);
        }
        report::columns(&lines, &words)
    }
}

/// The columns of [`COLUMNS`] behind the folder.
fn counts(outcome: &Outcome) -> Vec<String> {
    let reason = outcome.reason().unwrap_or_default().to_owned();
    let mut cells = vec![outcome.status().to_owned(), reason];
    match &outcome.summary {
        Ok(s) => {
            cells.push(format!("{:?}", s.time));
            let counts = [
                s.steps,
                s.rejected_steps,
                s.newton_iterations,
                s.factorizations,
                s.contacts_max,
            ];
            cells.extend(counts.map(|count| count.to_string()));
            cells.extend([s.cpu_s, s.wall_s, s.max_penetration].map(|value| format!("{value:?}")));
        }
        Err(_) => cells.resize(COLUMNS.len() - 1, String::new()),
    }
    cells
}

/// Energies, peaks of the forces and last values of the probes, by the name of the column.
fn measures(outcome: &Outcome, extent: Extent) -> Vec<(String, f64)> {
    let Ok(summary) = &outcome.summary else {
        return Vec::new();
    };
    let energy = &summary.energy;
    let mut measures = vec![
        ("energy.initial".to_owned(), energy.initial),
        ("energy.final".to_owned(), energy.end),
    ];
    let terms = ENERGY_TERMS.iter();
    measures.extend(terms.map(|term| (term.column.to_owned(), (term.value)(&energy.terms))));
    for peak in peaks(&outcome.history, extent) {
        let name = format!("peak.force.{}", peak.name);
        measures.push((name.clone(), peak.norm));
        measures.push((format!("{name}.t"), peak.time));
        for (axis, [least, most]) in peak.components {
            measures.push((format!("{name}.{axis}.max"), most));
            measures.push((format!("{name}.{axis}.min"), least));
        }
    }
    let probes = outcome.history.header().iter();
    for name in probes.filter(|name| name.starts_with("probe.")) {
        let last = outcome
            .history
            .column(name)
            .and_then(|values| values.last().copied());
        measures.extend(last.map(|value| (name.clone(), value)));
    }
    measures
}

/// Extremes of a force over a run.
struct Peak {
    name: String,
    /// Largest norm \[N\].
    norm: f64,
    /// When it was reached first \[s\].
    time: f64,
    /// Smallest and largest value of each component, with sign \[N\].
    components: Vec<(&'static str, [f64; 2])>,
}

/// The extremes of every force of a history, of the components that are forces.
fn peaks(history: &History, extent: Extent) -> Vec<Peak> {
    let name = |column: &String| {
        Some(
            column
                .strip_prefix("force.")?
                .strip_suffix(".x")?
                .to_owned(),
        )
    };
    let names = history.header().iter().filter_map(name);
    let peak = |name: String| {
        let times = history.column("t")?;
        let column = |axis: &&'static str| {
            let values = history.column(&format!("force.{name}.{axis}"))?;
            Some((*axis, values))
        };
        let columns: Vec<_> = extent
            .force_axes()
            .iter()
            .map(column)
            .collect::<Option<_>>()?;
        let norm = |i: usize| {
            let squares = columns.iter().map(|(_, values)| values[i] * values[i]);
            squares.sum::<f64>().sqrt()
        };
        // The first of equal ones.
        let best = (0..times.len())
            .rev()
            .max_by(|&a, &b| norm(a).total_cmp(&norm(b)))?;
        let extremes = |values: &[f64]| {
            let least = values.iter().copied().fold(f64::INFINITY, f64::min);
            [
                least,
                values.iter().copied().fold(f64::NEG_INFINITY, f64::max),
            ]
        };
        let components = columns
            .iter()
            .map(|(axis, values)| (*axis, extremes(values)));
        Some(Peak {
            norm: norm(best),
            time: times[best],
            components: components.collect(),
            name,
        })
    };
    names.filter_map(peak).collect()
}
