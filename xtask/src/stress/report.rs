//! The map as Markdown, as a table of all runs, and in a few lines.

use std::collections::BTreeMap;
use std::fmt::Write as _;

use super::Made;
use super::draw::Extreme;
use super::runs::{End, Found};

/// Share of the energy made up by the time integration beyond which a run is warned of, as in its summary.
const NOTABLE: f64 = 0.1;

#[derive(Default)]
struct Count {
    runs: usize,
    completed: usize,
    /// Of these with a notable error of the time integration.
    warned: usize,
    refused: usize,
    stopped: BTreeMap<&'static str, usize>,
    budget: usize,
    wrong: usize,
    energy: f64,
    law: f64,
    cpu: f64,
}

impl Count {
    fn of<'a>(made: impl Iterator<Item = &'a Made>) -> Count {
        let mut count = Count::default();
        made.for_each(|m| count.add(&m.found));
        count
    }

    fn add(&mut self, found: &Found) {
        self.runs += 1;
        self.cpu += found.cpu;
        self.energy = self.energy.max(found.worst.energy);
        self.law = self.law.max(found.worst.law.max(found.worst.contact_error));
        match &found.end {
            End::Completed => {
                self.completed += 1;
                self.warned += usize::from(found.worst.integration > NOTABLE);
            }
            End::Refused(_) => self.refused += 1,
            End::Stopped(kind, _) => *self.stopped.entry(kind).or_default() += 1,
            End::Budget => self.budget += 1,
            End::Wrong(_) => self.wrong += 1,
        }
    }

    fn stops(&self) -> usize {
        self.stopped.values().sum()
    }

    fn reasons(&self) -> String {
        let each = self.stopped.iter().map(|(kind, n)| format!("{kind} {n}"));
        each.collect::<Vec<_>>().join(", ")
    }
}

/// A few lines for the terminal.
pub(super) fn short(made: &[Made]) -> String {
    let all = Count::of(made.iter());
    format!(
        "{} runs: {} completed ({} with a notable integration error), {} refused, {} stopped ({}), {} cut, {} wrong; \
         {:.0} s CPU; worst open audit {:.1e}, worst contact error {:.1e}",
        all.runs,
        all.completed,
        all.warned,
        all.refused,
        all.stops(),
        all.reasons(),
        all.budget,
        all.wrong,
        all.cpu,
        all.energy,
        all.law
    )
}

/// One line a run.
pub(super) fn table(made: &[Made]) -> String {
    let mut text = "index;case;kind;extremes;end;steps;rejected;iterations;cpu_s;energy;residual;law;contact_error;depth;integration;reason\n".to_owned();
    for m in made {
        let (end, reason) = match &m.found.end {
            End::Completed => ("completed", ""),
            End::Refused(why) => ("refused", why.as_str()),
            End::Stopped(kind, why) => (*kind, why.as_str()),
            End::Budget => ("budget", ""),
            End::Wrong(why) => ("wrong", why.as_str()),
        };
        let (f, w) = (&m.found, &m.found.worst);
        let _ = writeln!(
            text,
            "{};{:?};{:?};{:?};{end};{};{};{};{:.3};{:.1e};{:.1e};{:.1e};{:.1e};{:.1e};{:.1e};{}",
            m.index,
            m.draw.case,
            m.draw.kind,
            m.draw.extremes,
            f.steps,
            f.rejected,
            f.iterations,
            f.cpu,
            w.energy,
            w.residual,
            w.law,
            w.contact_error,
            w.depth,
            w.integration,
            reason.replace('\n', " ")
        );
    }
    text
}

/// The page of the docs.
pub(super) fn markdown(made: &[Made], seed: u64) -> String {
    let mut text = HEAD
        .replace("{runs}", &made.len().to_string())
        .replace("{seed}", &seed.to_string());
    let _ = writeln!(text, "{TABLE}");
    let mut row = |name: &str, count: &Count| {
        let _ = writeln!(
            text,
            "| {name} | {} | {} | {} | {} | {} | {} | {} | {:.0e} | {:.0e} | {:.1} |",
            count.runs,
            count.completed,
            count.warned,
            count.refused,
            if count.stops() == 0 {
                "-".to_owned()
            } else {
                format!("{} ({})", count.stops(), count.reasons())
            },
            count.budget,
            count.wrong,
            count.energy,
            count.law,
            count.cpu
        );
    };
    for (extreme, name) in Extreme::ALL {
        row(
            name,
            &Count::of(made.iter().filter(|m| m.draw.extremes.contains(&extreme))),
        );
    }
    row("**all runs**", &Count::of(made.iter()));
    text.push_str(TAIL);
    text
}

const HEAD: &str = "# What the numerics survive\n\n\
    Made by `cargo xtask stress`: {runs} runs drawn with seed {seed}, each with at least one thing extreme, often several.\n\
    Run `k` is the same everywhere: `cargo xtask stress --index k --write DIR` makes it alone and writes its scene. CI makes a tenth.\n\n";
const TABLE: &str = "| what is extreme | runs | completed | of these warned | refused | stopped, why | cut | wrong | open audit | contact error | CPU \\[s\\] |\n\
    |---|---:|---:|---:|---:|---|---:|---:|---:|---:|---:|";
const TAIL: &str = "\n";
