//! Pages of the studies and the page that leads to them.

use std::fmt::Write as _;

use super::runs::Ran;
use super::{Figure, Paper, STUDIES, Study};
use crate::fclib::write_document;
use crate::{Outcome, root};

pub(super) fn write(study: &Study, figures: &[Figure], runs: &[Ran]) -> Outcome {
    let folder = study.paper.folder;
    for (file, svg) in figures.iter().flat_map(|figure| &figure.pictures) {
        write_document(&format!("{folder}/{file}"), svg)?;
    }
    let name = format!("{folder}/{}.md", study.name);
    write_document(&name, &text(study, figures, runs))
}

fn text(study: &Study, figures: &[Figure], runs: &[Ran]) -> String {
    let mut text = format!(
        "# [{}] {}\n\nMade by `cargo xtask figures {}`; numbers in the text are those of the runs.\n",
        study.paper.key, study.title, study.name
    );
    for figure in figures {
        let _ = writeln!(text, "\n## Figure {}: {}\n", figure.number, figure.title);
        for (file, _) in &figure.pictures {
            let _ = writeln!(text, "![Figure {}]({file})\n", figure.number);
        }
        let _ = writeln!(text, "{}", figure.caption);
    }
    if !runs.is_empty() {
        text += "\n## Runs\n\n| run | scene | changed | unknowns | steps | cut | CPU [s] |\n\
                 |---|---|---|---:|---:|---:|---:|\n";
    }
    for run in runs {
        let (plan, summary) = (&run.plan, &run.summary);
        let sets: Vec<String> = plan.sets.iter().map(|set| format!("`{set}`")).collect();
        let _ = writeln!(
            text,
            "| {} | `{}` | {} | {} | {} | {} | {:.1} |",
            plan.name,
            plan.scene,
            sets.join(" "),
            summary.dofs,
            summary.steps,
            summary.rejected_steps,
            summary.cpu_s
        );
    }
    text
}

/// Writes the page that leads to the studies of a paper, from the pages that are there.
pub(super) fn write_index(paper: &Paper) -> Outcome {
    let mut text = format!(
        "# The figures of [{}]\n\n\
         Made by `cargo xtask figures`: every figure of the paper that data can make, from the built-in scenes. {}\n",
        paper.key, paper.about
    );
    let studies = STUDIES.iter().filter(|s| s.paper.folder == paper.folder);
    for study in studies {
        let file = format!("{}/{}.md", paper.folder, study.name);
        let path = root().join("docs/verification").join(&file);
        let _ = writeln!(text, "\n## {}\n", study.title);
        let Ok(page) = std::fs::read_to_string(&path) else {
            let _ = writeln!(text, "Not made yet: `cargo xtask figures {}`.", study.name);
            continue;
        };
        let headings = page
            .lines()
            .filter_map(|line| line.strip_prefix("## Figure "));
        for heading in headings {
            let _ = writeln!(text, "- [Figure {heading}]({file})");
        }
    }
    write_document(&format!("{}.md", paper.folder), &text)
}
