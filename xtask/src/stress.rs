//! A map of what the numerics survive: runs drawn from extremes, each of which completes with its audit closed or stops
//! with a reason.

mod audit;
mod contacts;
mod draw;
mod geometry;
mod report;
mod runs;
mod subject;
mod text;

use std::path::{Path, PathBuf};

use crate::{Outcome, root};
use draw::draw;
use runs::{End, Found};
use subject::{DIRECTIONS, Draw};

pub(crate) use subject::Case;

/// Runs of the map in the docs.
const RUNS: usize = 660;
/// CPU time that a run is named for \[s\].
const SLOW: f64 = 5.0;
/// Its seed.
const SEED: u64 = 2026;

#[derive(clap::Args)]
pub(crate) struct Options {
    /// Runs that are drawn
    #[arg(long, default_value_t = RUNS)]
    runs: usize,
    /// Part of them that is made, evenly spread; CI takes .1
    #[arg(long, default_value_t = 1.0)]
    share: f64,
    /// Another seed is another set of runs
    #[arg(long, default_value_t = SEED)]
    seed: u64,
    /// Only the runs of one case
    #[arg(long)]
    only: Option<Case>,
    /// Only the run with this number
    #[arg(long)]
    index: Option<usize>,
    /// Instead of runs so many random contact problems, every success checked in twice the digits
    #[arg(long)]
    contacts: Option<u64>,
    /// Folder for the scenes of all runs and a table of their ends
    #[arg(long)]
    write: Option<PathBuf>,
}

impl Options {
    /// What CI makes.
    pub(crate) fn tenth() -> Options {
        Options {
            runs: RUNS,
            share: 0.1,
            seed: SEED,
            only: None,
            index: None,
            contacts: None,
            write: None,
        }
    }
}

/// A run that was made.
pub(crate) struct Made {
    index: usize,
    draw: Draw,
    found: Found,
}

/// Makes the runs, and the map if they are those of the docs.
///
/// # Errors
/// Runs that ended wrong, or that hang.
pub(crate) fn run(options: &Options) -> Outcome {
    if let Some(count) = options.contacts {
        return contacts::run(count, options.seed);
    }
    let wanted = |index: &usize| match options.index {
        Some(only) => *index == only,
        None => {
            // The directions take turns; without the shift a stride would meet the same few of them again and again.
            let place = (index + index / DIRECTIONS) as f64 * options.share;
            (place + options.share).floor() > place.floor()
        }
    };
    let draws: Vec<(usize, Draw)> = (0..options.runs.max(options.index.map_or(0, |i| i + 1)))
        .filter(wanted)
        .map(|index| (index, draw(options.seed, index)))
        .filter(|(_, draw)| options.only.is_none_or(|case| draw.case == case))
        .collect();
    let title = |index: usize| format!("stress {} {index}", options.seed);
    let scenes: Vec<String> = draws
        .iter()
        .map(|(index, draw)| text::scene(draw, &title(*index)))
        .collect();
    if let Some(folder) = &options.write {
        write_scenes(folder, &draws, &scenes)?;
    }
    let found = runs::all(scenes, |place, found| tell(draws[place].0, found))?;
    let made: Vec<Made> = draws
        .into_iter()
        .zip(found)
        .map(|((index, draw), found)| Made { index, draw, found })
        .collect();
    println!("{}", report::short(&made));
    if let Some(folder) = &options.write {
        write(&folder.join("runs.csv"), &report::table(&made))?;
    }
    let whole = options.share >= 1.0 && options.only.is_none() && options.index.is_none();
    if whole && options.runs == RUNS && options.seed == SEED {
        let path = root().join("docs/verification/stress.md");
        write(&path, &report::markdown(&made, options.seed))?;
        println!("wrote {}", path.display());
    }
    let wrong = made.iter().filter(|m| matches!(m.found.end, End::Wrong(_)));
    match wrong.count() {
        0 => Ok(()),
        count => Err(format!("{count} runs ended wrong")),
    }
}

fn tell(index: usize, found: &Found) {
    match &found.end {
        End::Wrong(why) => println!("  {index}: wrong: {why}"),
        End::Budget => println!("  {index}: cut after {} iterations", found.iterations),
        _ if found.cpu > SLOW => println!("  {index}: {:.0} s CPU", found.cpu),
        _ => {}
    }
}

fn write(path: &Path, text: &str) -> Outcome {
    std::fs::write(path, text).map_err(|e| format!("{}: {e}", path.display()))
}

fn write_scenes(folder: &Path, draws: &[(usize, Draw)], scenes: &[String]) -> Outcome {
    std::fs::create_dir_all(folder).map_err(|e| format!("{}: {e}", folder.display()))?;
    for ((index, _), text) in draws.iter().zip(scenes) {
        write(&folder.join(format!("{index:04}.ron")), text)?;
    }
    Ok(())
}
