//! Tests of the whole chain, from a scene to an audited run.
//!
//! Slow ones are ignored: `cargo test --release -p tests -- --ignored` runs them too.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

mod common;

mod adhesion;
mod adhesion_scenes;
mod bar;
mod control;
mod convergence;
mod counters;
mod determinism;
mod energy;
mod held;
mod impact;
mod patch;
mod program;
mod quadratic_contact;
mod rates;
mod rigid;
mod robust;
mod twist;
