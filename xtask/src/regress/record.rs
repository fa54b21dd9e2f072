//! What is stored of a run.

use std::collections::BTreeMap;

use ::tests::Ran;
use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

use super::Findings;

/// Largest difference of a number, relative to the largest of its family \[-\]. Another machine sums in another order,
/// and friction amplifies that; a change of algorithm that is seen in the third digit of the error it makes is far
/// above.
const TOLERANCE: f64 = 1e-5;

/// Columns that hold round-off, and the most that they may hold.
const BOUNDED: [(&str, f64); 1] = [("contact.error", 1e-8)];

/// Penetration beyond the stored one, relative to the size of the bodies \[-\].
const PENETRATION: f64 = 1e-9;

/// Share by which a counter of work may grow, and the number that it may in any case.
const GROWTH: (f64, u64) = (0.05, 2);

/// A run in numbers.
#[derive(Debug, Serialize, Deserialize)]
pub(super) struct Record {
    sets: Vec<String>,
    /// Diagonal of the box around all bodies \[m\].
    size: f64,
    /// Must stay as they are.
    shape: BTreeMap<String, u64>,
    /// Must not grow.
    work: BTreeMap<String, u64>,
    columns: BTreeMap<String, Column>,
}

/// A column of the history; some quantities are NaN where they do not exist.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
struct Column {
    end: Option<f64>,
    mean: Option<f64>,
    /// Largest size.
    largest: f64,
    /// Entries that are not finite.
    missing: usize,
}

impl Column {
    fn of(values: &[f64]) -> Column {
        let finite = || values.iter().copied().filter(|v| v.is_finite());
        let count = finite().count();
        Column {
            end: values.last().copied().filter(|v| v.is_finite()),
            mean: (count > 0).then(|| finite().sum::<f64>() / count as f64),
            largest: finite().map(f64::abs).fold(0.0, f64::max),
            missing: values.len() - count,
        }
    }
}

impl Record {
    pub(super) fn of(ran: &Ran) -> Result<Record, String> {
        let s = &ran.summary;
        let counters = |pairs: &[(&str, usize)]| -> BTreeMap<String, u64> {
            pairs
                .iter()
                .map(|(name, n)| ((*name).to_owned(), *n as u64))
                .collect()
        };
        let columns = ran
            .history
            .header()
            .iter()
            .map(|name| Ok((name.clone(), Column::of(&ran.column(name)?))));
        Ok(Record {
            sets: ran.plan.sets.clone(),
            size: size(&ran.built.model.solid.mesh().points),
            shape: counters(&[
                ("steps", s.steps),
                ("dofs", s.dofs),
                ("elements", s.elements),
                ("contacts_max", s.contacts_max),
            ]),
            work: counters(&[
                ("rejected_steps", s.rejected_steps),
                ("newton_iterations", s.newton_iterations),
                ("factorizations", s.factorizations),
                ("contact_solves", s.contact_solves),
                ("contact_iterations", s.contact_iterations),
                ("bonded_solves", s.bonded_solves as usize),
                ("indefinite_tangents", s.indefinite_tangents),
            ]),
            columns: columns.collect::<Result<_, String>>()?,
        })
    }

    /// What is different in `now`.
    pub(super) fn compare(&self, now: &Record) -> Findings {
        let mut findings = Findings::default();
        if self.sets != now.sets {
            let told = format!("stored for {:?}, run with {:?}", self.sets, now.sets);
            findings.failures.push(told);
            return findings;
        }
        for (name, was) in &self.shape {
            findings.compared += 1;
            let is = now.shape.get(name);
            if is != Some(was) {
                findings
                    .failures
                    .push(format!("{name}: {was} stored, now {is:?}"));
            }
        }
        for (name, was) in &self.work {
            findings.work(name, *was, now.work.get(name).copied().unwrap_or(u64::MAX));
        }
        for (name, was) in &self.columns {
            findings.compared += 1;
            match now.columns.get(name) {
                None => findings.failures.push(format!("column {name} is gone")),
                Some(is) => findings.failures.extend(self.difference(name, *was, *is)),
            }
        }
        findings
    }

    fn difference(&self, name: &str, was: Column, is: Column) -> Option<String> {
        let bound = BOUNDED
            .iter()
            .find(|(column, _)| *column == name)
            .map(|(_, bound)| *bound);
        let bound = match name {
            "contact.penetration" => Some(2.0 * was.largest + PENETRATION * self.size),
            _ => bound,
        };
        if let Some(bound) = bound {
            let within = is.largest <= bound;
            return (!within).then(|| format!("{name}: {:e}, may be {bound:e}", is.largest));
        }
        let allowed = TOLERANCE * self.scale(name);
        if was.missing != is.missing {
            return Some(format!(
                "{name}: {} numbers missing, now {}",
                was.missing, is.missing
            ));
        }
        let pairs = [
            ("end", was.end, is.end),
            ("mean", was.mean, is.mean),
            ("largest", Some(was.largest), Some(is.largest)),
        ];
        let alike = |was: Option<f64>, is: Option<f64>| match (was, is) {
            (Some(was), Some(is)) => (was - is).abs() <= allowed,
            _ => was == is,
        };
        let (what, was, is) = pairs.iter().find(|(_, was, is)| !alike(*was, *is))?;
        Some(format!(
            "{name}, {what}: {was:?} stored, now {is:?}, may differ by {allowed:.0e}"
        ))
    }

    /// Largest number of the family of a column.
    fn scale(&self, name: &str) -> f64 {
        let family = |name: &str| -> String {
            let energies = ["energy.", "work.", "dissipation.", "error."];
            match name {
                _ if energies.iter().any(|e| name.starts_with(e)) => "energy".to_owned(),
                _ if name.starts_with("force.") => "force".to_owned(),
                _ if name.starts_with("moment.") => "moment".to_owned(),
                _ => name
                    .trim_end_matches(".x")
                    .trim_end_matches(".y")
                    .trim_end_matches(".z")
                    .to_owned(),
            }
        };
        let largest = |wanted: &str| {
            let alike = self
                .columns
                .iter()
                .filter(|(other, _)| family(other) == wanted);
            alike.map(|(_, column)| column.largest).fold(0.0, f64::max)
        };
        // What is zero but for round-off has no scale of its own.
        let force = largest("force");
        match family(name).as_str() {
            "moment" => largest("moment").max(1e-6 * self.size * force),
            length if length.ends_with("gap") || length.ends_with("displacement") => {
                largest(length).max(1e-6 * self.size)
            }
            at_node if at_node.contains("force") || at_node.contains("adhesion_") => {
                largest(at_node).max(1e-6 * force)
            }
            other => largest(other),
        }
    }
}

impl Findings {
    fn work(&mut self, name: &str, was: u64, is: u64) {
        self.compared += 1;
        let slack = (GROWTH.0 * was as f64) as u64 + GROWTH.1;
        if is > was.saturating_add(slack) {
            self.failures
                .push(format!("{name}: {was} stored, now {is}: more work"));
        } else if is + 2 * slack < was {
            self.gains.push(format!("{name} ({is} of {was})"));
        }
    }
}

fn size(points: &[Vector3<f64>]) -> f64 {
    let extent = |i: usize| {
        let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
        for x in points {
            (low, high) = (low.min(x[i]), high.max(x[i]));
        }
        high - low
    };
    extent(0).hypot(extent(1)).hypot(extent(2))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn record(force: f64, newton: u64) -> Record {
        let column = |v| Column::of(&[0.0, v]);
        let columns = [
            ("force.a.x", force),
            ("force.a.y", 1e-14),
            ("contact.error", 1e-12),
        ];
        Record {
            sets: Vec::new(),
            size: 1.0,
            shape: BTreeMap::from([("steps".to_owned(), 10)]),
            work: BTreeMap::from([("newton_iterations".to_owned(), newton)]),
            columns: columns.map(|(name, v)| (name.to_owned(), column(v))).into(),
        }
    }

    #[test]
    fn what_differs_is_told() {
        let stored = record(1.0, 100);
        assert!(stored.compare(&record(1.0 + 1e-7, 103)).failures.is_empty());
        assert_eq!(stored.compare(&record(1.0 + 1e-4, 100)).failures.len(), 1);
        assert_eq!(stored.compare(&record(f64::NAN, 100)).failures.len(), 1);
        assert_eq!(stored.compare(&record(1.0, 108)).failures.len(), 1);
        assert_eq!(stored.compare(&record(1.0, 60)).gains.len(), 1);
        let mut other = record(1.0, 100);
        other
            .columns
            .insert("contact.error".to_owned(), Column::of(&[1e-6]));
        other.shape.insert("steps".to_owned(), 11);
        assert_eq!(stored.compare(&other).failures.len(), 2);
    }
}
