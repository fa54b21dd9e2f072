//! What an earlier run or sweep has left in a folder.

use std::fs;
use std::io::Read as _;
use std::path::{Path, PathBuf};

use super::{Folder, OutputError, Status, Summary};

/// Removes the folders that the runs of an earlier sweep left in this one: what a run writes, and the folder when
/// nothing else is in it.
///
/// # Errors
/// [`OutputError`] when one of them is in use or cannot be removed.
pub fn remove_runs(folder: &Folder) -> Result<(), OutputError> {
    for path in runs_of_sweep(folder.path()) {
        let fields = path.join("fields");
        drop(Folder::create(&path)?);
        // Fails where something of somebody else is left, which stays.
        let _ = fs::remove_dir(&fields);
        let _ = fs::remove_dir(&path);
    }
    Ok(())
}

/// The results in a folder that a new run or sweep would replace, in words.
#[must_use]
pub fn earlier_results(path: &Path) -> Option<String> {
    let runs = runs_of_sweep(path).len();
    if runs > 0 {
        return Some(format!("a sweep of {runs} runs"));
    }
    let text = fs::read(path.join("summary.json")).ok();
    let summary: Option<Summary> = text.and_then(|text| serde_json::from_slice(&text).ok());
    match summary {
        Some(summary) => {
            let status = match summary.status {
                Status::Running => "broken off",
                status => status.word(),
            };
            let (steps, time) = (summary.steps, summary.time);
            Some(format!("a run ({status}, {steps} steps to t = {time:e} s)"))
        }
        None if is_history(&path.join("history.csv")) => Some("a run without a summary".to_owned()),
        None => None,
    }
}

/// Folders in a folder that runs of a sweep have written, `<number>_<field>=<value>..`.
fn runs_of_sweep(path: &Path) -> Vec<PathBuf> {
    let Ok(entries) = fs::read_dir(path) else {
        return Vec::new();
    };
    let named = |path: &PathBuf| {
        let name = path.file_name().and_then(|name| name.to_str());
        let parts = name.and_then(|name| name.split_once('_'));
        parts.is_some_and(|(number, rest)| {
            !number.is_empty() && number.bytes().all(|b| b.is_ascii_digit()) && rest.contains('=')
        })
    };
    let folders = entries.filter_map(|entry| Some(entry.ok()?.path()));
    let mut runs: Vec<PathBuf> = folders
        .filter(|path| named(path) && is_history(&path.join("history.csv")))
        .collect();
    runs.sort();
    runs
}

/// Whether a file is a `history.csv` of this program.
fn is_history(path: &Path) -> bool {
    let mut head = [0; HISTORY.len()];
    let read = fs::File::open(path).and_then(|mut file| file.read_exact(&mut head));
    read.is_ok() && head == *HISTORY
}

/// How every `history.csv` begins.
const HISTORY: &[u8; 16] = b"t,energy.kinetic";
