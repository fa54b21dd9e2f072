//! Time stepping, damping, mass and solver limits.

use nscd::{ContactLevel, Inertia};
use serde::{Deserialize, Serialize};

/// Duration, step and scheme [Feng2007, eq. 38-41].
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Time {
    /// End \[s\]; the start is 0.
    pub end: f64,
    /// Step \[s\].
    pub dt: f64,
    /// Weight of the new velocity in the displacement update \[-\], 0.5 (trapezoid) to 1 (backward Euler).
    #[serde(default = "half")]
    pub theta: f64,
    /// Weight of the new internal forces in the balance \[-\], 0.5 to 1.
    #[serde(default = "half")]
    pub xi: f64,
    /// Where the contact law acts.
    #[serde(default)]
    pub contact: ContactLevel,
    /// With mass or without.
    #[serde(default)]
    pub inertia: Inertia,
    /// A step is never cut below this \[s\]; the stepper's own limit when absent.
    #[serde(default)]
    pub min_dt: Option<f64>,
}

impl Time {
    /// Steps `dt` \[s\] until `end` \[s\] with the trapezoidal scheme, all else left to its default.
    #[must_use]
    pub fn new(end: f64, dt: f64) -> Time {
        Time {
            end,
            dt,
            theta: half(),
            xi: half(),
            contact: ContactLevel::default(),
            inertia: Inertia::default(),
            min_dt: None,
        }
    }
}

fn half() -> f64 {
    0.5
}

/// Mass matrix.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum MassKind {
    /// From the shape functions.
    #[default]
    Consistent,
    /// Row sums on the diagonal.
    Lumped,
}

/// Tolerances and limits. What is absent is the solver's own default.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Solver {
    /// Relative error of the contact law at which its solution is accepted \[-\].
    #[serde(default)]
    pub contact_tolerance: Option<f64>,
    /// Iterations of one contact solve \[-\].
    #[serde(default)]
    pub max_contact_iterations: Option<usize>,
    /// Relative residual of the equations of motion at which a step is accepted \[-\].
    #[serde(default)]
    pub newton_tolerance: Option<f64>,
    /// Newton iterations of one step before it is cut \[-\].
    #[serde(default)]
    pub max_newton: Option<usize>,
}
