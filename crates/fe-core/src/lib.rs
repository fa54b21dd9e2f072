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

#[cfg(any(test, feature = "conformance"))]
pub mod conformance;

/// The example of the README is a doc test.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;

mod adjacency;
mod block;
mod constraint;
mod element;
mod error;
mod kinematics;
mod mass;
mod mesh;
mod motion;
mod parallel;
mod pattern;
mod quadrature;
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
    CellKind, Element, Facet, FacetKind, Hex8, Hex27, Nodal, Quad4, Quad9, Tet4, Tet10, Tri3, Tri6,
    corner_points, reference_gradients,
};
pub use error::FeError;
pub use hyperelastic;
pub use hyperelastic::ROUND_OFF;
pub use kinematics::{deformation_gradient, linear_strain_matrix, nonlinear_strain_matrix};
pub use mass::MassMatrix;
#[cfg(feature = "serde")]
pub use mesh::text;
pub use mesh::{
    AnnulusMesh, BoxMesh, CellBlock, DiscMesh, GridAxis, GridMesh, GridPiece, HalfBallMesh,
    HalfDiscMesh, Mesh, MeshError, Pole, QuarterDiscMesh, RectangleMesh, ValidMesh,
};
pub use motion::{Interpolation, Motion, Rotation, Table};
pub use pattern::{SymmetricPattern, node_adjacency};
pub use quadrature::QuadraturePoint;
pub use solid::{ElementWorkspace, Solid};
pub use surface::{Surface, current_positions};
pub use symmetry::Symmetry;
