//! Frictional contact problems written by other codes: Siconos `.dat` and FCLib `.hdf5`.
//!
//! Both keep the normal component first; problems here have it last, and the readers turn them ([`mod@write`] turns
//! them back). What a file claims about its sizes is never believed further than its length allows.

pub mod dat;
mod hdf5;
pub mod write;

use std::path::{Path, PathBuf};

use contact_bipotential::{ContactError, ContactProblem};
use thiserror::Error;

/// Largest file that is read \[bytes\].
pub(crate) const LARGEST_FILE: u64 = 1 << 30;
/// Largest number of unknowns that a file may announce.
pub(crate) const LARGEST_SIZE: usize = 1 << 24;

/// A problem file that cannot be used.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum FclibError {
    /// The file cannot be read at all.
    #[error("{}: {reason}", path.display())]
    File {
        /// The file.
        path: PathBuf,
        /// What the system said.
        reason: String,
    },
    /// A text file is wrong in one place.
    #[error("{}, line {line}: {reason}", path.display())]
    Text {
        /// The file.
        path: PathBuf,
        /// Line, from 1.
        line: usize,
        /// What is wrong.
        reason: String,
    },
    /// A dataset is missing or wrong.
    #[error("{}, {dataset}: {reason}", path.display())]
    Dataset {
        /// The file.
        path: PathBuf,
        /// Path of the dataset inside of the file.
        dataset: String,
        /// What is wrong.
        reason: String,
    },
    /// The file is readable, what it says is no contact problem.
    #[error("{}: {source}", path.display())]
    Problem {
        /// The file.
        path: PathBuf,
        /// Why not.
        source: ContactError,
    },
}

/// Reads a problem, by its extension: `.hdf5` and `.h5` are FCLib, all others Siconos text.
///
/// # Errors
/// [`FclibError`] naming the file, the line or dataset, and what is wrong there.
pub fn read(path: &Path) -> Result<ContactProblem, FclibError> {
    let bytes = read_bytes(path)?;
    match path.extension().and_then(|e| e.to_str()) {
        Some("hdf5" | "h5") => hdf5::parse(path, bytes),
        _ => dat::parse(path, &bytes),
    }
}

fn read_bytes(path: &Path) -> Result<Vec<u8>, FclibError> {
    let file = |reason: String| FclibError::File {
        path: path.to_owned(),
        reason,
    };
    let length = std::fs::metadata(path)
        .map_err(|e| file(e.to_string()))?
        .len();
    if length > LARGEST_FILE {
        return Err(file(format!(
            "{length} bytes, more than the {LARGEST_FILE} that are read"
        )));
    }
    std::fs::read(path).map_err(|e| file(e.to_string()))
}

/// Position in the local order (normal last) of entry `k` of a flat vector with the normal first.
fn normal_last(k: usize, dim: usize) -> usize {
    k / dim * dim + (k % dim + dim - 1) % dim
}

/// A flat vector turned from normal first to normal last.
fn turned(v: &[f64], dim: usize) -> Vec<f64> {
    let mut out = vec![0.0; v.len()];
    for (k, &x) in v.iter().enumerate() {
        out[normal_last(k, dim)] = x;
    }
    out
}

/// Entries of a matrix over flat vectors on both sides, turned.
fn turned_entries(entries: &mut [(usize, usize, f64)], dim: usize) {
    for e in entries {
        e.0 = normal_last(e.0, dim);
        e.1 = normal_last(e.1, dim);
    }
}

#[cfg(test)]
mod tests;
