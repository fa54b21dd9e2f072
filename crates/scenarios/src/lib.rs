//! Scenes, runs and results: the only crate that reads files, writes files and looks at the clock.
//!
//! A scene is a RON text ([`spec`]), built in ([`catalog`]) or a file. The results of a run go into one folder
//! ([`output`]); [`report`] prints them. The program `setae` is a thin shell around this library.

pub mod build;
pub mod catalog;
pub mod clock;
pub mod contacts;
mod energies;
pub mod fclib;
pub mod fields;
pub mod output;
pub mod progress;
pub mod report;
pub mod row;
pub mod run;
pub mod spec;
pub mod sweep;

/// The example of the README compiles and runs.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
