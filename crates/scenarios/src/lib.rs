//! Scenes, runs and results: the only crate that reads files, writes files and looks at the clock.
//!
//! A scene is a RON text ([`spec`]), built in ([`catalog`]) or a file. The results of a run go into one folder
//! ([`output`]); [`report`] prints them. The program `setae` is a thin shell around this library.

pub mod catalog;
pub mod fclib;
pub mod output;
pub mod report;
pub mod spec;

mod blame;
mod build;
mod clock;
mod contacts;
mod energies;
mod estimate;
mod fields;
mod progress;
mod row;
mod run;
mod sweep;
mod verdict;

pub use build::{Built, build};
pub use clock::Stopwatch;
pub use contacts::NodeContact;
pub use estimate::Estimate;
pub use fields::Fields;
pub use progress::Progress;
pub use row::{first_row, row};
pub use run::{Options, RunError, check, run, run_with, summarise};
pub use sweep::{Outcome, Planned, Sweep, SweepError, Vary};

/// The example of the README compiles and runs.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
