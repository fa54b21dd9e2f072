//! The tables as Markdown.

use std::fmt::Write as _;

use tests::{Case, Measured};

use super::Climbed;
use crate::figures::measure::digits;

pub(super) fn markdown(case: &Case, climbed: &[Climbed<'_>]) -> String {
    let mut text = format!(
        "# {}: error against time\n\n{}\n\nMade by `cargo xtask precision {}` from the scene `{}`",
        case.name, case.about, case.name, case.scene
    );
    let sets = case
        .sets
        .iter()
        .map(|set| format!("`{set}`"))
        .collect::<Vec<_>>();
    if !sets.is_empty() {
        let _ = write!(text, " with {}", sets.join(", "));
    }
    let _ = writeln!(
        text,
        ".\nA row is a run on one thread; its CPU seconds hold the building of the model but no output. In brackets the relative\n\
         error{}.\n\n![Error against time]({}.svg)",
        if any_open(climbed) {
            "; without a closed form, against the finest run of its ladder or of the first one"
        } else {
            ""
        },
        case.name
    );
    for ladder in climbed {
        section(&mut text, ladder);
    }
    text
}

fn any_open(climbed: &[Climbed<'_>]) -> bool {
    let runs = climbed.iter().flat_map(|c| c.rungs.iter().flatten());
    runs.flat_map(|m| &m.found).any(|f| f.exact.is_none())
}

fn section(text: &mut String, climbed: &Climbed<'_>) {
    let _ = writeln!(text, "\n## {}\n", climbed.ladder.name);
    let Some(first) = climbed.rungs.iter().flatten().next() else {
        return;
    };
    let heads: Vec<String> = first
        .found
        .iter()
        .map(|f| format!("{} [{}]", f.name, f.unit))
        .collect();
    let _ = writeln!(
        text,
        "| run | unknowns | steps (cut) | CPU [s] | {} |\n|---|---:|---:|---:|{}",
        heads.join(" | "),
        "---:|".repeat(heads.len())
    );
    for (k, (rung, measured)) in climbed.ladder.rungs.iter().zip(&climbed.rungs).enumerate() {
        let _ = match measured {
            Ok(measured) => writeln!(text, "| {} | {} |", rung.label, row(climbed, k, measured)),
            Err(reason) => writeln!(
                text,
                "| {} | {} |",
                rung.label,
                reason.replace(['\n', '|'], " ")
            ),
        };
    }
    // Where the closed form differs from run to run the brackets say it all.
    let same = |number: usize| {
        let all = || climbed.rungs.iter().flatten();
        let exact = all().map(|m| m.found.get(number).and_then(|f| f.exact));
        exact.reduce(|a, b| if a == b { a } else { None }).flatten()
    };
    let exact = (0..first.found.len()).map(|k| same(k).map_or("-".to_owned(), |e| digits(e, 5)));
    let exact: Vec<String> = exact.collect();
    if first.found.iter().any(|f| f.exact.is_some()) {
        let _ = writeln!(text, "| closed form | | | | {} |", exact.join(" | "));
    }
    let orders = (0..first.found.len()).map(|number| {
        climbed
            .order(number)
            .map_or("-".to_owned(), |order| format!("{order:.2}"))
    });
    let _ = writeln!(
        text,
        "| fitted order | | | | {} |",
        orders.collect::<Vec<_>>().join(" | ")
    );
    if let Some(order) = climbed.ladder.order {
        let _ = writeln!(
            text,
            "\nTheory: order {order} of the {}.",
            first.found[0].name
        );
    }
}

fn row(climbed: &Climbed<'_>, rung: usize, measured: &Measured) -> String {
    let numbers = measured.found.iter().enumerate().map(|(number, found)| {
        let error = climbed.error(rung, number);
        let bracket = if error.is_nan() {
            String::new()
        } else {
            format!(" ({})", percent(error))
        };
        format!("{}{bracket}", digits(found.value, 5))
    });
    let numbers: Vec<String> = numbers.collect();
    let [steps, cut] = measured.steps;
    let cpu = digits(measured.cpu_s, 2);
    format!(
        "{} | {steps} ({cut}) | {cpu} | {}",
        measured.dofs,
        numbers.join(" | ")
    )
}

fn percent(error: f64) -> String {
    if error.abs() < 1e-5 {
        format!("{error:+.0e}")
    } else {
        format!("{:+.3} %", 100.0 * error)
    }
}
