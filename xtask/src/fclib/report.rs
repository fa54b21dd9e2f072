//! The table as Markdown.

use std::fmt::Write as _;

use super::{Solve, Study};

/// Problems beyond which no other solver comes; totals are given without them too.
const HARDEST: &str = "RockPile";

pub(super) fn markdown(studies: &[Study]) -> String {
    let mut text = "# The contact solver on the problems of other codes\n\n\
        Made by `cargo xtask fclib` (folder of the files: its argument, `FCLIB_DIR`, or `../shared/fclib`). Every solve starts\n\
        from zero, runs on one thread and may take 20000 sweeps or projections, `newton` 200 steps. A cell gives CPU seconds where the\n\
        problem is solved, that is, where all errors, recomputed from the reactions, are within the tolerance (see\n\
        [solvers](../theory/solvers.md)); otherwise, in italics, the larger of the measure of Siconos and the scale-free one.\n\n\
        ![Performance profiles](fclib_profile.svg)\n\n\
        Share of the problems solved within so many times the CPU time of the best method for each.\n"
        .to_owned();
    for study in studies {
        let _ = writeln!(text, "\n## Tolerance {}\n", study.tolerance);
        text += &totals(study);
        text.push('\n');
        text += &table(study);
    }
    text
}

fn totals(study: &Study) -> String {
    let mut text = "| method | solved | CPU on the solved [s] | the same without RockPile | CPU on the unsolved [s] |\n\
                    |---|---:|---:|---:|---:|\n"
        .to_owned();
    let sum = |solves: &[Solve], which: &dyn Fn(&Solve) -> bool| -> f64 {
        // `sum` of nothing is minus zero.
        solves
            .iter()
            .filter(|s| which(s))
            .map(Solve::cpu)
            .fold(0.0, |a, b| a + b)
    };
    for (method, solves) in &study.methods {
        let solved = solves.iter().filter(|s| s.solved()).count();
        let _ = writeln!(
            text,
            "| {method} | {solved} of {} | {:.3} | {:.3} | {:.3} |",
            solves.len(),
            sum(solves, &Solve::solved),
            sum(solves, &|s| s.solved() && !s.file.contains(HARDEST)),
            sum(solves, &|s| !s.solved()),
        );
    }
    let best: f64 = problems(study)
        .map(|k| fastest(study, k))
        .filter(|t| t.is_finite())
        .sum();
    let any = problems(study).filter(|k| fastest(study, *k).is_finite());
    let _ = writeln!(
        text,
        "| best for each problem | {} of {} | {best:.3} | | |",
        any.count(),
        problems(study).len()
    );
    text
}

/// Indices of the problems.
fn problems(study: &Study) -> std::ops::Range<usize> {
    0..study.methods.iter().map(|m| m.1.len()).min().unwrap_or(0)
}

/// CPU seconds of the fastest method that solves problem `k`; infinite where none does.
pub(super) fn fastest(study: &Study, k: usize) -> f64 {
    let solves = study.methods.iter().map(|m| &m.1[k]);
    let times = solves.filter(|s| s.solved()).map(Solve::cpu);
    times.fold(f64::INFINITY, f64::min)
}

fn table(study: &Study) -> String {
    let names: Vec<&str> = study.methods.iter().map(|m| m.0).collect();
    let mut text = format!("| problem | contacts | {} |\n", names.join(" | "));
    text += &format!("|---|---:|{}\n", "---:|".repeat(names.len()));
    for k in problems(study) {
        let first = &study.methods[0].1[k];
        let contacts = first
            .contacts
            .map_or_else(|| "-".to_owned(), |n| n.to_string());
        let cells: Vec<String> = study.methods.iter().map(|m| cell(&m.1[k])).collect();
        let _ = writeln!(
            text,
            "| {} | {contacts} | {} |",
            first.name(),
            cells.join(" | ")
        );
    }
    text
}

fn cell(solve: &Solve) -> String {
    if solve.solved() {
        format!("{:.1e}", solve.cpu())
    } else if solve.worst().is_nan() {
        solve.status.clone()
    } else {
        format!("*error {:.0e}*", solve.worst())
    }
}
