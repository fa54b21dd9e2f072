//! What can be wrong with contact geometry.

use thiserror::Error;

use crate::cone::Cone;
use crate::error::ParameterError;

/// Contact geometry that cannot be used.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum GeometryError {
    /// A parameter of an obstacle outside of its bound.
    #[error(transparent)]
    Parameter(#[from] ParameterError),
    /// An interface that makes no sense.
    #[error("interface {interface:?}: {reason}")]
    Interface {
        /// Name of the interface.
        interface: String,
        /// What is wrong and what to try.
        reason: String,
    },
    /// An unknown number of unknowns a node, or positions that do not match it.
    #[error(
        "positions of {length} entries with {dim} unknowns a node; give 2 or 3 unknowns and whole nodes"
    )]
    Positions {
        /// Unknowns a node.
        dim: usize,
        /// Entries found.
        length: usize,
    },
    /// A compliance that does not fit its list of rows.
    #[error(
        "a compliance of {rows} x {columns} with rows up to {largest}; it must be square and hold every row"
    )]
    Compliance {
        /// Rows of the matrix.
        rows: usize,
        /// Columns of the matrix.
        columns: usize,
        /// Largest row asked for.
        largest: usize,
    },
    /// A cone that does not fit the dimension of the mesh.
    #[error(
        "contacts with {} components in a mesh with {dim} unknowns a node; give 1 (frictionless) or {dim}",
        cone.dim()
    )]
    Cone {
        /// What was asked for.
        cone: Cone,
        /// Unknowns a node.
        dim: usize,
    },
}
