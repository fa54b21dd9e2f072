//! The figures of \[Hu2022\], made again from runs: `docs/verification/hu2022.md` and the pages beside its pictures.

mod indentation;
mod laws;
pub(crate) mod measure;
mod page;
mod plate_cylinder;
mod runs;
mod supplement;
mod twist;
mod wheel;

use crate::Outcome;

use runs::{Planned, Ran};

/// A part of the paper: which runs its figures need, and what they make of them.
struct Study {
    /// On the command line and in names of files.
    name: &'static str,
    title: &'static str,
    runs: fn() -> Vec<Planned>,
    figures: fn(&[Ran]) -> Result<Vec<Figure>, String>,
}

/// A figure of the paper.
struct Figure {
    /// Its number in the paper with the parts that are here.
    number: &'static str,
    title: &'static str,
    /// File names with their pictures.
    pictures: Vec<(&'static str, String)>,
    /// What is seen, what agrees with the paper, what differs and why.
    caption: String,
}

const STUDIES: [Study; 6] = [
    Study {
        name: "laws",
        title: "The laws (2.3)",
        runs: Vec::new,
        figures: laws::figures,
    },
    Study {
        name: "indentation",
        title: "Indentation of an adhesive block (4.1)",
        runs: indentation::runs,
        figures: indentation::figures,
    },
    Study {
        name: "wheel",
        title: "A confined wheel that rolls (4.2)",
        runs: wheel::runs,
        figures: wheel::figures,
    },
    Study {
        name: "plate-cylinder",
        title: "A plate drawn over a half-cylinder (4.3)",
        runs: plate_cylinder::runs,
        figures: plate_cylinder::figures,
    },
    Study {
        name: "twist",
        title: "A block twisted off its ground (4.4)",
        runs: twist::runs,
        figures: twist::figures,
    },
    Study {
        name: "supplement",
        title: "Debonding down to epsilon (supplement)",
        runs: supplement::runs,
        figures: supplement::figures,
    },
];

/// Makes the figures of the named studies, of all without a name, and the page that leads to them. A study that fails does not
/// keep the others from being made.
pub(crate) fn run(names: &[String]) -> Outcome {
    let known = || STUDIES.iter().map(|study| study.name);
    if let Some(name) = names
        .iter()
        .find(|name| known().all(|k| k != name.as_str()))
    {
        let known: Vec<&str> = known().collect();
        return Err(format!(
            "no figures `{name}`; there are {}",
            known.join(", ")
        ));
    }
    let mut failures = Vec::new();
    for study in &STUDIES {
        if !names.is_empty() && !names.iter().any(|name| name == study.name) {
            continue;
        }
        match make(study) {
            Ok(count) => println!("{}: {count} figures", study.name),
            Err(reason) => failures.push(format!("{}: {reason}", study.name)),
        }
    }
    page::write_index()?;
    if failures.is_empty() {
        Ok(())
    } else {
        Err(failures.join("\n       "))
    }
}

fn make(study: &Study) -> Result<usize, String> {
    let ran = runs::compute((study.runs)())?;
    let figures = (study.figures)(&ran)?;
    page::write(study, &figures, &ran)?;
    Ok(figures.len())
}
