//! Pages of the studies and the page that leads to them.

use std::fmt::Write as _;

use super::runs::Ran;
use super::{Figure, STUDIES, Study};
use crate::fclib::write_document;
use crate::{Outcome, root};

/// Beside `hu2022.md`: the pages of the studies and all pictures.
const FOLDER: &str = "hu2022";

pub(super) fn write(study: &Study, figures: &[Figure], runs: &[Ran]) -> Outcome {
    for (file, svg) in figures.iter().flat_map(|figure| &figure.pictures) {
        write_document(&format!("{FOLDER}/{file}"), svg)?;
    }
    let name = format!("{FOLDER}/{}.md", study.name);
    write_document(&name, &text(study, figures, runs))
}

fn text(study: &Study, figures: &[Figure], runs: &[Ran]) -> String {
    let mut text = format!(
        "# [Hu2022] {}\n\nMade by `cargo xtask figures {}`; numbers in the text are those of the runs.\n",
        study.title, study.name
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

/// Writes the page that leads to the studies, from the pages that are there.
pub(super) fn write_index() -> Outcome {
    let mut text = "# The figures of [Hu2022]\n\n\
        Made by `cargo xtask figures`: every figure of the paper that data can make, from the built-in scenes. Figures 1, 4, 5 and 11\n\
        are sketches of set-ups; the tables 6 (e) and 10 (a) stand in the text of their figures.\n"
        .to_owned();
    for study in &STUDIES {
        let file = format!("{FOLDER}/{}.md", study.name);
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
    write_document("hu2022.md", &text)
}
