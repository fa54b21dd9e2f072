//! Tests of scenes, results and the program, in one binary.
#![allow(clippy::unwrap_used)] // helpers of tests fail the test

mod adhesion;
mod cli;
mod contact;
mod dilatation;
mod locate;
mod output;
mod overrides;
mod pictures;
mod plane;
mod quadratic;
mod refusals;
mod runs;
mod scene;
mod sweep;
mod verdict;
mod vtu_reader;

use std::path::PathBuf;

/// An empty folder of its own for a test.
fn fresh_folder(name: &str) -> PathBuf {
    let folder = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join(name);
    let _ = std::fs::remove_dir_all(&folder);
    std::fs::create_dir_all(&folder).unwrap();
    folder
}
