//! Structured meshes of simple bodies.
//!
//! Every mesh has the node set `all`, and for each named part of the boundary a node set and a facet set. Plane
//! meshes are made for plane strain; set [`Mesh::symmetry`] for an axisymmetric body.

mod annulus;
mod axis;
mod box_mesh;
mod disc;
mod grid;
mod half_ball;
mod o_grid;
mod rectangle;

pub use annulus::AnnulusMesh;
pub use axis::{GridAxis, GridPiece};
pub use box_mesh::BoxMesh;
pub use disc::{DiscMesh, HalfDiscMesh, QuarterDiscMesh};
pub use grid::GridMesh;
pub use half_ball::HalfBallMesh;
pub use rectangle::RectangleMesh;

use nalgebra::Vector3;

use super::{CellBlock, Mesh};
use crate::element::{CellKind, Facet, GridCut};
use crate::mesh::MeshError;
use crate::symmetry::Symmetry;

/// Where the dome of a half body points along its last axis: y in the plane, z in space.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Pole {
    /// Towards the positive axis.
    Up,
    /// Towards the negative axis.
    Down,
}

/// Refuses a quantity unless `good`.
fn require(
    good: bool,
    shape: &'static str,
    what: &str,
    value: f64,
    bound: &'static str,
) -> Result<(), MeshError> {
    if good {
        return Ok(());
    }
    Err(MeshError::Shape {
        shape,
        what: what.to_owned(),
        value,
        bound,
    })
}

fn require_positive(shape: &'static str, what: &str, value: f64) -> Result<(), MeshError> {
    let good = value > 0.0 && value.is_finite();
    require(good, shape, what, value, "must be positive and finite")
}

fn require_cells(shape: &'static str, what: &str, cells: usize) -> Result<(), MeshError> {
    require(cells >= 1, shape, what, cells as f64, "must be at least 1")
}

fn require_indices(shape: &'static str, nodes: f64) -> Result<(), MeshError> {
    let good = nodes < f64::from(u32::MAX);
    require(good, shape, "nodes", nodes, "must be below 2^32")
}

fn require_finite(shape: &'static str, center: &[f64]) -> Result<(), MeshError> {
    for (axis, &x) in center.iter().enumerate() {
        let what = format!("center on axis {axis} [m]");
        require(x.is_finite(), shape, &what, x, "must be finite")?;
    }
    Ok(())
}

/// Checks lengths, numbers of cells and gradings of a grid.
fn check_grid(
    shape: &'static str,
    min: &[f64],
    max: &[f64],
    cells: &[usize],
    grading: &[f64],
) -> Result<(), MeshError> {
    for axis in 0..min.len() {
        let on = |what: &str| format!("{what} on axis {axis}");
        require_positive(shape, &on("length [m]"), max[axis] - min[axis])?;
        require_cells(shape, &on("cells"), cells[axis])?;
        require_positive(shape, &on("grading"), grading[axis])?;
    }
    require_indices(shape, cells.iter().map(|&n| n as f64 + 1.0).product())
}

fn check_kind(block: &str, kind: CellKind, dim: usize) -> Result<(), MeshError> {
    if kind.dim() == dim {
        return Ok(());
    }
    Err(MeshError::CellDimension {
        block: block.to_owned(),
        kind,
        dim,
    })
}

/// A mesh of one block with the node set `all`.
fn single_block(
    symmetry: Symmetry,
    points: Vec<Vector3<f64>>,
    block: &str,
    kind: CellKind,
    cells: Vec<u32>,
) -> Mesh {
    let all = (0..points.len() as u32).collect();
    let mut mesh = Mesh::new(symmetry, points, vec![CellBlock::new(block, kind, cells)]);
    mesh.node_sets.insert("all".to_owned(), all);
    mesh
}

/// Names the part of the boundary whose nodes satisfy `belongs`, which is given their numbers.
fn name_side(mesh: &mut Mesh, boundary: &[Facet], name: &str, belongs: impl Fn(usize) -> bool) {
    let on_side = |facet: &&Facet| facet.nodes().iter().all(|&n| belongs(n as usize));
    let facets: Vec<Facet> = boundary.iter().filter(on_side).copied().collect();
    let mut nodes: Vec<u32> = facets.iter().flat_map(|f| f.nodes().to_vec()).collect();
    nodes.sort_unstable();
    nodes.dedup();
    mesh.node_sets.insert(name.to_owned(), nodes);
    mesh.facet_sets.insert(name.to_owned(), facets);
}

/// Refuses another kind of cells than `of`, quadrilaterals or hexahedra, or its quadratic form.
fn check_shape_kind(shape: &'static str, kind: CellKind, of: CellKind) -> Result<(), MeshError> {
    if kind.linear() == of {
        return Ok(());
    }
    Err(MeshError::Kind {
        shape,
        kind,
        known: [of, of.quadratic()],
    })
}

/// The cells asked for in a mesh of quadrilaterals or hexahedra: cut, and of degree 2.
///
/// A new node whose corners all belong to `round` goes to the sphere around `center` \[m\] with the mean of their
/// radii.
fn into_kind(
    mut mesh: Mesh,
    kind: CellKind,
    center: Vector3<f64>,
    round: impl Fn(u32) -> bool,
) -> Result<Mesh, MeshError> {
    let block = &mut mesh.blocks[0];
    block.cells = cut_grid(kind, &mesh.points, &block.cells);
    block.kind = kind.linear();
    if kind.degree() == 1 {
        return Ok(mesh);
    }
    let radius = |x: &Vector3<f64>| (x - center).norm();
    mesh.quadratic_at(|corners, x| {
        if !corners.iter().all(|&corner| round(corner)) {
            return x;
        }
        let radii = corners.iter().map(|&n| radius(&mesh.points[n as usize]));
        let mean = radii.sum::<f64>() / corners.len() as f64;
        center + mean * (x - center).normalize()
    })
}

/// The mesh, or that of quadratic cells with straight edges.
fn of_degree(degree: usize, mesh: Mesh) -> Result<Mesh, MeshError> {
    match degree {
        1 => Ok(mesh),
        _ => mesh.quadratic(),
    }
}

/// Cells of degree 1 with the corners of a kind, from quadrilaterals or bricks.
fn cut_grid(kind: CellKind, points: &[Vector3<f64>], grid_cells: &[u32]) -> Vec<u32> {
    let parts = match kind.grid_cut() {
        GridCut::Cells(parts) => parts,
        GridCut::ShorterDiagonal => return triangles(points, grid_cells),
    };
    let corners = 1 << kind.dim();
    let mut cells = Vec::new();
    for grid_cell in grid_cells.chunks_exact(corners) {
        let local = parts.iter().copied().flatten();
        cells.extend(local.map(|&corner| grid_cell[corner]));
    }
    cells
}

/// Squares of the two diagonals of a quadrilateral whose relative difference is less are equal \[-\]: round-off must
/// not decide between them.
const EQUAL_DIAGONALS: f64 = 1e-9;

/// Cuts quadrilaterals along their shorter diagonal into triangles.
fn triangles(points: &[Vector3<f64>], quads: &[u32]) -> Vec<u32> {
    let length = |a: u32, b: u32| (points[a as usize] - points[b as usize]).norm_squared();
    let cut = |quad: &[u32]| {
        let [a, b, c, d] = [quad[0], quad[1], quad[2], quad[3]];
        if length(a, c) <= (1.0 + EQUAL_DIAGONALS) * length(b, d) {
            [a, b, c, a, c, d]
        } else {
            [a, b, d, b, c, d]
        }
    };
    quads.chunks_exact(4).flat_map(cut).collect()
}
