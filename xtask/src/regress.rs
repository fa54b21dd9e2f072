//! Every scene in a short form against stored results and counters: a slower or less accurate algorithm fails.

mod record;

use tests::short::short_forms;
use tests::{Plan, Ran, compute_all};

use crate::{Outcome, root};
use record::Record;

/// Runs the named scenes, or all, and compares them with `tests/regress`; `update` writes the records instead.
///
/// # Errors
/// What differs, scene by scene.
pub(crate) fn run(names: &[String], update: bool) -> Outcome {
    let forms = short_forms().into_iter();
    let plans: Vec<Plan> = forms
        .filter(|plan| names.is_empty() || names.contains(&plan.name))
        .collect();
    if plans.is_empty() {
        return Err(format!("no short form is called {}", names.join(", ")));
    }
    let all: Vec<String> = plans.iter().map(|plan| plan.name.clone()).collect();
    let runs = compute_all(plans, &|_| ());
    let mut failures = Vec::new();
    for (name, run) in all.iter().zip(runs) {
        match run
            .and_then(Ran::completed)
            .and_then(|ran| judge(&ran, update))
        {
            Ok(differences) => failures.extend(differences),
            Err(reason) => failures.push(format!("{name}: {reason}")),
        }
    }
    if failures.is_empty() {
        return Ok(());
    }
    Err(format!(
        "{}\nIf this is meant, `cargo xtask regress --update` stores the new results; say why in the message of the commit.",
        failures.join("\n")
    ))
}

/// Stores a run or tells in what it differs from the stored one.
fn judge(ran: &Ran, update: bool) -> Result<Vec<String>, String> {
    let (name, cpu) = (&ran.plan.name, ran.summary.cpu_s);
    if update {
        store(ran)?;
        println!("{name}: {cpu:.2} s CPU, stored");
        return Ok(Vec::new());
    }
    let findings = compare(ran)?;
    println!("{name}: {cpu:.2} s CPU, {}", findings.word());
    let told = findings.failures.iter().map(|f| format!("{name}: {f}"));
    Ok(told.collect())
}

/// What a comparison found.
#[derive(Debug, Default)]
struct Findings {
    /// Numbers that differ, counters that grew.
    failures: Vec<String>,
    /// Counters that shrank.
    gains: Vec<String>,
    /// Columns and counters compared.
    compared: usize,
}

impl Findings {
    fn word(&self) -> String {
        match (self.failures.len(), self.gains.is_empty()) {
            (0, true) => format!("{} numbers as stored", self.compared),
            (0, false) => format!("fewer {}: store this", self.gains.join(", ")),
            (n, _) => format!("{n} differences"),
        }
    }
}

fn path(name: &str) -> std::path::PathBuf {
    root().join("tests/regress").join(format!("{name}.json"))
}

fn store(ran: &Ran) -> Outcome {
    let path = path(&ran.plan.name);
    let mut text = serde_json::to_string_pretty(&Record::of(ran)?).map_err(|e| e.to_string())?;
    text.push('\n');
    let folder = path.parent().unwrap_or(&path);
    std::fs::create_dir_all(folder)
        .and_then(|()| std::fs::write(&path, text))
        .map_err(|e| format!("{}: {e}", path.display()))
}

fn compare(ran: &Ran) -> Result<Findings, String> {
    let path = path(&ran.plan.name);
    let told = |e: &dyn std::fmt::Display| {
        format!(
            "{}: {e}; `cargo xtask regress --update {}` writes it",
            path.display(),
            ran.plan.name
        )
    };
    let text = std::fs::read_to_string(&path).map_err(|e| told(&e))?;
    let stored: Record = serde_json::from_str(&text).map_err(|e| told(&e))?;
    Ok(stored.compare(&Record::of(ran)?))
}
