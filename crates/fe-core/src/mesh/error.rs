//! What makes a mesh unusable.

use nalgebra::Vector3;

use crate::element::CellKind;
use crate::symmetry::Symmetry;

/// What makes a mesh unusable.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum MeshError {
    /// The number of unknowns per node does not belong to the symmetry.
    #[error("a mesh with symmetry {symmetry:?} has {} unknowns a node, not {dim}", symmetry.dim())]
    Dimension {
        /// The refused value.
        dim: usize,
        /// Symmetry of the mesh.
        symmetry: Symmetry,
    },
    /// Meshes or blocks of different symmetry, which cannot belong to one solid.
    #[error(
        "symmetry {actual:?} does not go with {expected:?}; all bodies are in space, or all in plane strain, or all axisymmetric"
    )]
    Symmetry {
        /// Symmetry of the mesh.
        expected: Symmetry,
        /// Symmetry of what was added.
        actual: Symmetry,
    },
    /// A point of an axisymmetric mesh on the wrong side of the axis.
    #[error("point {node}: the radius x = {radius:e} of an axisymmetric mesh must not be negative")]
    NegativeRadius {
        /// Index of the point.
        node: usize,
        /// Its first coordinate \[m\].
        radius: f64,
    },
    /// A mesh without points or without cells.
    #[error("the mesh has no {what}")]
    Empty {
        /// `points` or `cells`.
        what: &'static str,
    },
    /// A coordinate is NaN or infinite.
    #[error("point {node} has a coordinate that is not finite: {:?}", point.as_slice())]
    PointNotFinite {
        /// Index of the point.
        node: usize,
        /// Its coordinates \[m\].
        point: Vector3<f64>,
    },
    /// A block of cells of another dimension than the mesh.
    #[error("block `{block}` has {kind:?} cells, which do not fit a mesh of dimension {dim}")]
    CellDimension {
        /// Name of the block.
        block: String,
        /// Kind of its cells.
        kind: CellKind,
        /// Dimension of the mesh.
        dim: usize,
    },
    /// The connectivity is not a whole number of cells.
    #[error(
        "block `{block}`: {length} node indices are not a multiple of the {nodes} nodes of a cell"
    )]
    Connectivity {
        /// Name of the block.
        block: String,
        /// Length of the connectivity.
        length: usize,
        /// Nodes per cell.
        nodes: usize,
    },
    /// An element refers to a point that does not exist.
    #[error(
        "block `{block}`, element {element}: node {node} does not exist, the mesh has {points} points"
    )]
    NodeOutOfRange {
        /// Name of the block.
        block: String,
        /// Element in the block.
        element: usize,
        /// The index that is too large.
        node: u32,
        /// Number of points of the mesh.
        points: usize,
    },
    /// An element uses one point twice.
    #[error("block `{block}`, element {element}: node {node} appears twice")]
    RepeatedNode {
        /// Name of the block.
        block: String,
        /// Element in the block.
        element: usize,
        /// The node.
        node: u32,
    },
    /// An element is inverted or flat in the reference configuration.
    #[error(
        "block `{block}`, element {element}: Jacobian {det_j:e} at quadrature point {point} is not positive; \
         check the node order (VTK) and the shape of the element"
    )]
    Jacobian {
        /// Name of the block.
        block: String,
        /// Element in the block.
        element: usize,
        /// Quadrature point in the element.
        point: usize,
        /// Determinant of dX/dxi \[m^3, m^2 in the plane\].
        det_j: f64,
    },
    /// A point that no element uses would have no stiffness and no mass.
    #[error("node {node} belongs to no element; remove it from the mesh")]
    OrphanNode {
        /// The node.
        node: usize,
    },
    /// A node set is not strictly increasing, or refers to a point that does not exist.
    #[error(
        "node set `{set}`: entry {node} is out of order or out of range (sets are sorted, without repeats)"
    )]
    NodeSet {
        /// Name of the set.
        set: String,
        /// The offending entry.
        node: u32,
    },
    /// A facet has an impossible number of nodes, or refers to a point that does not exist.
    #[error("facet set `{set}`: facet {facet} has a wrong number of nodes or a node out of range")]
    FacetSet {
        /// Name of the set.
        set: String,
        /// Index of the facet in the set.
        facet: usize,
    },
    /// A set that the mesh does not have.
    #[error("the mesh has no {what} set `{set}`; it has: {known}")]
    UnknownSet {
        /// `node` or `facet`.
        what: &'static str,
        /// The name asked for.
        set: String,
        /// The names there are.
        known: String,
    },
    /// A structured mesh that is not made of such cells.
    #[error("{shape} mesh: {kind:?} cells do not fill it; take {:?} or {:?}", known[0], known[1])]
    Kind {
        /// The generator.
        shape: &'static str,
        /// Kind of cells asked for.
        kind: CellKind,
        /// The kinds that are possible.
        known: [CellKind; 2],
    },
    /// A structured mesh that cannot be generated.
    #[error("{shape} mesh: {what} = {value}, {bound}")]
    Shape {
        /// The generator.
        shape: &'static str,
        /// The quantity.
        what: String,
        /// Its value.
        value: f64,
        /// The bound that it violates.
        bound: &'static str,
    },
}
