//! Errors of this crate: what is wrong, where, and what to try.

use crate::element::CellKind;
use crate::mesh::MeshError;

/// What can go wrong in this crate.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum FeError {
    /// The mesh is unusable.
    #[error(transparent)]
    Mesh(#[from] MeshError),
    /// An element is turned inside out, or the displacement is not finite.
    #[error(
        "block `{block}`, element {element}, quadrature point {point}: det F = {det_f:e} must be positive and finite; \
         take a smaller step, or a finer mesh where the deformation is large"
    )]
    Inverted {
        /// Name of the block.
        block: String,
        /// Element in the block.
        element: usize,
        /// Quadrature point in the element.
        point: usize,
        /// Determinant of the deformation gradient \[-\].
        det_f: f64,
    },
    /// Elements for which the projected dilatation is the pointwise one.
    #[error(
        "block `{block}`: the volume of a {kind:?} cell changes alike in all its quadrature points, so projecting the dilatation changes nothing and \
         the cells lock as before; use Quad4 in the plane, Hex8 in space, or elements of second order"
    )]
    Unprojectable {
        /// Name of the block.
        block: String,
        /// Kind of the cells.
        kind: CellKind,
    },
    /// A parameter outside its physical bounds.
    #[error("{place}: {what} = {value:e}, {bound}")]
    Parameter {
        /// What the parameter belongs to.
        place: String,
        /// The parameter, with its unit.
        what: &'static str,
        /// The refused value.
        value: f64,
        /// The bound.
        bound: &'static str,
    },
    /// An index of a block, a node or a degree of freedom that does not exist.
    #[error("{what} {index} does not exist, there are {count}")]
    Index {
        /// What is counted.
        what: &'static str,
        /// The index asked for.
        index: usize,
        /// How many there are.
        count: usize,
    },
    /// An array of the wrong length.
    #[error("{what} has {actual} entries, expected {expected}")]
    Length {
        /// The array.
        what: &'static str,
        /// Length expected.
        expected: usize,
        /// Length given.
        actual: usize,
    },
    /// Elements of another kind than the cells of the block.
    #[error("block `{block}` has {actual:?} cells, the element is {expected:?}")]
    CellKind {
        /// Name of the block.
        block: String,
        /// Kind of the element.
        expected: CellKind,
        /// Kind of the cells.
        actual: CellKind,
    },
    /// More entries than a 32-bit index can address.
    #[error("{what}: {count} entries are more than 32-bit indices can address; use a coarser mesh")]
    TooLarge {
        /// What is counted.
        what: &'static str,
        /// How many there are.
        count: usize,
    },
    /// A table of time data that is empty, not finite or not in order.
    #[error("table, entry {entry}: {reason}")]
    Table {
        /// Index of the entry.
        entry: usize,
        /// What is wrong.
        reason: &'static str,
    },
    /// A surface without facets, or with facets of different dimensions.
    #[error("surface: {reason}")]
    Surface {
        /// What is wrong.
        reason: &'static str,
    },
}

/// Checks the length of an array argument.
///
/// # Errors
/// [`FeError::Length`] if it differs.
pub(crate) fn check_length(
    what: &'static str,
    expected: usize,
    actual: usize,
) -> Result<(), FeError> {
    if expected == actual {
        Ok(())
    } else {
        Err(FeError::Length {
            what,
            expected,
            actual,
        })
    }
}
