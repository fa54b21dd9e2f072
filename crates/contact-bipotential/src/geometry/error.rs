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
        reason: InterfaceFault,
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

/// What is wrong with an interface.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum InterfaceFault {
    /// Nothing that could touch.
    #[error("it has no slave nodes; name a node set that is not empty")]
    NoSlave,
    /// Areas and slave nodes do not belong together.
    #[error("{areas} areas for {slaves} slave nodes; give one area a node")]
    Areas {
        /// Number of areas.
        areas: usize,
        /// Number of slave nodes.
        slaves: usize,
    },
    /// An area that is none.
    #[error("a tributary area is {area} m^2; it must be >= 0 and finite")]
    Area {
        /// The area \[m^2\].
        area: f64,
    },
    /// A node outside of the mesh.
    #[error("{side} node {node} does not exist: the mesh has {nodes} nodes")]
    Node {
        /// `"slave"` or `"master"`.
        side: &'static str,
        /// The node.
        node: u32,
        /// Nodes of the mesh.
        nodes: usize,
    },
    /// A node on both sides.
    #[error("node {node} is slave and master at once; split the surface in two")]
    Both {
        /// The node.
        node: u32,
    },
    /// A parameter outside of its bound.
    #[error(transparent)]
    Parameter(#[from] ParameterError),
    /// A master of bodies in space in a plane mesh, or the other way round.
    #[error(
        "its master has {}, but the mesh has {dim} unknowns a node; a plane body has edges, a body in space triangles or \
         quadrilaterals",
        if *.master_dim == 2 { "edges" } else { "faces" }
    )]
    Dimension {
        /// Unknowns a node of the bodies that have such a master.
        master_dim: usize,
        /// Unknowns a node of the mesh.
        dim: usize,
    },
    /// An obstacle whose normals leave the plane z = 0.
    #[error("the {part} is {z}; in the plane it must be 0")]
    ShapeOutOfPlane {
        /// Name and unit of what is not zero.
        part: &'static str,
        /// Its value, in the unit that `part` names.
        z: f64,
    },
    /// An obstacle that moves out of the plane z = 0.
    #[error(
        "the obstacle's motion leaves the plane; translate along x and y and rotate about z only"
    )]
    MotionOutOfPlane,
}
