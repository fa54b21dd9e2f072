//! What is known about the scenes from elsewhere, and how far the program is from it.
//!
//! [`closed_form`] holds the formulas, [`run`] computes scenes in memory, a [`Case`] compares the two over meshes,
//! steps and schemes. The tests in `tests/tests` assert bounds and slopes of cases, and what holds for the whole chain
//! (`suite`); `cargo xtask precision` draws the cases over the time they cost, `cargo xtask regress` compares short
//! forms of all scenes with the records in `tests/regress`.

pub mod case;
pub mod cases;
pub mod closed_form;
pub mod curve;
pub mod half_space;
pub mod run;
pub mod short;
pub mod traction;

pub use case::{Case, Found, Ladder, Measured, Rung, slope};
pub use run::{Plan, Ran, compute, compute_all};
