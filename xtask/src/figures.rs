//! The figures of \[Hu2022\] and \[Feng2007\], made again from runs: `docs/verification/hu2022.md`, `feng2007.md` and
//! the pages beside their pictures.

mod cone;
mod impact;
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

/// A paper whose figures are made.
struct Paper {
    /// As it is cited.
    key: &'static str,
    /// Name of the page that leads to the studies, and of the folder of their pages and pictures.
    folder: &'static str,
    /// Below the title.
    about: &'static str,
}

const HU2022: Paper = Paper {
    key: "Hu2022",
    folder: "hu2022",
    about: "Figures 1, 4, 5 and 11\n\
            are sketches of set-ups; the tables 6 (e) and 10 (a) stand in the text of their figures.",
};

const FENG2007: Paper = Paper {
    key: "Feng2007",
    folder: "feng2007",
    about: "Figures 1 and 2\n\
            are sketches of set-ups. The pictures of the paper are lost; numbers can be compared where its text gives them.",
};

/// A part of a paper: which runs its figures need, and what they make of them.
struct Study {
    paper: Paper,
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

const STUDIES: [Study; 8] = [
    Study {
        paper: HU2022,
        name: "laws",
        title: "The laws (2.3)",
        runs: Vec::new,
        figures: laws::figures,
    },
    Study {
        paper: HU2022,
        name: "indentation",
        title: "Indentation of an adhesive block (4.1)",
        runs: indentation::runs,
        figures: indentation::figures,
    },
    Study {
        paper: HU2022,
        name: "wheel",
        title: "A confined wheel that rolls (4.2)",
        runs: wheel::runs,
        figures: wheel::figures,
    },
    Study {
        paper: HU2022,
        name: "plate-cylinder",
        title: "A plate drawn over a half-cylinder (4.3)",
        runs: plate_cylinder::runs,
        figures: plate_cylinder::figures,
    },
    Study {
        paper: HU2022,
        name: "twist",
        title: "A block twisted off its ground (4.4)",
        runs: twist::runs,
        figures: twist::figures,
    },
    Study {
        paper: HU2022,
        name: "supplement",
        title: "Debonding down to epsilon (supplement)",
        runs: supplement::runs,
        figures: supplement::figures,
    },
    Study {
        paper: FENG2007,
        name: "cone",
        title: "A rigid cone on a half-space (4.1)",
        runs: cone::runs,
        figures: cone::figures,
    },
    Study {
        paper: FENG2007,
        name: "impact",
        title: "Two blocks that meet obliquely (4.2)",
        runs: impact::runs,
        figures: impact::figures,
    },
];

/// Makes the figures of the named studies, of all without a name, and the pages that lead to them. A study that fails
/// does not keep the others from being made.
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
    page::write_index(&HU2022)?;
    page::write_index(&FENG2007)?;
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
