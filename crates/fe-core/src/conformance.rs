//! The battery that every element and every block has to pass. A new element's test is a few lines:
//!
//! ```
//! use fe_core::{BoxMesh, CellKind, Solid, Tet4, conformance, solid_block};
//! use fe_core::nalgebra::Matrix3;
//! use hyperelastic::BlatzKo;
//!
//! conformance::check_element::<Tet4, 4>()?;
//!
//! let mesh = BoxMesh::uniform([0.0; 3], [1.0; 3], [3; 3]).with_kind(CellKind::Tet4).generate("box")?.validated()?;
//! let block = solid_block(&mesh, 0, BlatzKo::new(1.0)?, 1.0)?;
//! let u: Vec<f64> = (0..3 * mesh.points.len()).map(|dof| 0.02 * (dof as f64).sin()).collect();
//! conformance::check_block(block.as_ref(), &mesh.points, &u)?;
//!
//! let solid = Solid::new(mesh, vec![block])?;
//! let h = Matrix3::new(0.1, 0.2, 0.0, 0.0, -0.1, 0.1, 0.0, 0.0, 0.3);
//! conformance::check_patch(&solid, &h)?;
//! conformance::check_mass(&solid, 1.0)?;
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! Everything is deterministic, and nothing panics: a failure is a [`Violation`].

mod block;
mod element;
mod solid;

use crate::error::FeError;

pub use block::check_block;
pub use element::check_element;
pub use solid::{check_mass, check_patch};

/// Allowed relative difference of what agrees up to round-off.
const AGREEMENT: f64 = 1e-11;
/// Allowed relative difference from central differences.
const DIFFERENCES: f64 = 1e-6;

/// A property that does not hold, or a state at which it could not be checked.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Violation {
    /// Two numbers that should agree.
    #[error("{property}, {place}: found {found:e}, expected {expected:e} within {tolerance:e}")]
    Differs {
        /// The property.
        property: &'static str,
        /// Node, entry or element.
        place: String,
        /// What was found.
        found: f64,
        /// What should be.
        expected: f64,
        /// Allowed difference.
        tolerance: f64,
    },
    /// The check needs another input.
    #[error("cannot check {property}: {reason}")]
    Input {
        /// The property.
        property: &'static str,
        /// What is missing.
        reason: &'static str,
    },
    /// The elements refuse the state.
    #[error(transparent)]
    Fe(#[from] FeError),
}

/// Demands `|found - expected| <= tolerance`; NaN fails.
fn same(
    property: &'static str,
    place: impl FnOnce() -> String,
    found: f64,
    expected: f64,
    tolerance: f64,
) -> Result<(), Violation> {
    if (found - expected).abs() <= tolerance {
        return Ok(());
    }
    Err(Violation::Differs {
        property,
        place: place(),
        found,
        expected,
        tolerance,
    })
}

/// Demands that arrays agree to `tolerance` in each entry.
fn same_entries(
    property: &'static str,
    found: &[f64],
    expected: &[f64],
    tolerance: f64,
) -> Result<(), Violation> {
    for (entry, (&found, &expected)) in found.iter().zip(expected).enumerate() {
        let place = || format!("entry {entry}");
        same(property, place, found, expected, tolerance)?;
    }
    Ok(())
}

fn largest(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |m, v| m.max(v.abs()))
}

/// Numbers in \[-1, 1\] without pattern, the same in each run.
fn direction(seed: u64, length: usize) -> Vec<f64> {
    let mut state = seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1;
    let mut next = || {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        (state >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    };
    (0..length).map(|_| next()).collect()
}
