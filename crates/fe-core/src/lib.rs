//! Finite elements for solids in large deformation (total Lagrangian formulation).
//!
//! A [`Mesh`] holds points, cells and named sets. Each cell block becomes a [`Block`]: elements of one
//! kind with one material, whose kernels write per-element forces and tangents. A [`Solid`] gathers them
//! in a fixed order, so that results are the same bits for any number of threads. [`SymmetricPattern`]
//! turns element tangents into the lower triangle of a sparse matrix.
//!
//! Plane problems ([`Symmetry`]) have two unknowns a node: plane strain, where forces, masses and energies are those of
//! one metre of thickness, and axisymmetric, where they are those of the whole ring.
//!
//! Points and vectors are [`nalgebra::Vector3`]; in the plane their third component is zero.
//! Unknowns are displacements \[m\], stored flat: component `i` of node `a` is entry `dim * a + i`.
//! Second-order symmetric tensors are stored as 11 22 33 12 13 23.

pub mod element;
pub mod kinematics;
pub mod quadrature;

#[cfg(any(test, feature = "conformance"))]
pub mod conformance;

mod adjacency;
mod block;
mod constraint;
mod error;
mod mass;
mod mesh;
mod motion;
mod parallel;
mod pattern;
mod solid;
mod surface;
mod symmetry;

pub use nalgebra;

pub use block::{
    Block, Dilatation, ElementState, SolidBlock, solid_block, solid_block_with, tangent_index,
    tangent_len,
};
pub use constraint::{DeadTraction, Dirichlet, Gravity};
pub use element::{
    CellKind, Element, ElementVisitor, Facet, FacetKind, Hex8, Hex27, Quad4, Quad9, Tet4, Tet10,
    Tri3, Tri6,
};
pub use error::FeError;
pub use mass::MassMatrix;
#[cfg(feature = "serde")]
pub use mesh::text;
pub use mesh::{
    AnnulusMesh, BoxMesh, CellBlock, DiscMesh, GridAxis, GridMesh, GridPiece, HalfBallMesh,
    HalfDiscMesh, Mesh, MeshError, Pole, QuarterDiscMesh, RectangleMesh,
};
pub use motion::{Interpolation, Motion, Rotation, Table};
pub use pattern::{SymmetricPattern, node_adjacency};
pub use solid::{ElementWorkspace, Solid};
pub use surface::{Surface, current_positions};
pub use symmetry::Symmetry;

/// Relative difference \[-\] below which two numbers are the same: 64 units in the last place. A sum of a few dozen terms,
/// or a chain of as many operations, stays within it; what differs by more differs for another reason than rounding.
pub const ROUND_OFF: f64 = 64.0 * f64::EPSILON;
