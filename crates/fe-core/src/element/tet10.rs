//! Quadratic tetrahedron, 10 nodes, 8 points.

use super::quadratic::{simplex, simplex_derivatives};
use super::tet4::TETRAHEDRA_OF_BRICK;
use super::{CellData, CellKind, Element, FacetKind, GridCut};
use crate::quadrature::{QuadraturePoint, TETRAHEDRON_8, TETRAHEDRON_14};

/// Quadratic tetrahedron on the corner of the unit cube.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Tet10;

/// Corners of the reference tetrahedron and middles of its edges, VTK order.
const REFERENCE_NODES: [[f64; 3]; 10] = [
    [0.0, 0.0, 0.0],
    [1.0, 0.0, 0.0],
    [0.0, 1.0, 0.0],
    [0.0, 0.0, 1.0],
    [0.5, 0.0, 0.0],
    [0.5, 0.5, 0.0],
    [0.0, 0.5, 0.0],
    [0.0, 0.0, 0.5],
    [0.5, 0.0, 0.5],
    [0.0, 0.5, 0.5],
];

/// Local nodes of the facets, outward: corners, middles of the edges.
static FACETS: [&[usize]; 4] = [
    &[0, 2, 1, 6, 5, 4],
    &[0, 1, 3, 4, 8, 7],
    &[1, 2, 3, 5, 9, 8],
    &[0, 3, 2, 7, 9, 6],
];

/// Corners between which the other nodes lie.
static PARENTS: [&[usize]; 6] = [&[0, 1], &[1, 2], &[2, 0], &[0, 3], &[1, 3], &[2, 3]];

/// Row of the table of kinds.
pub(super) static CELL: CellData = CellData {
    name: "Tet10",
    nodes: 10,
    dim: 3,
    degree: 2,
    linear: CellKind::Tet4,
    quadratic: CellKind::Tet10,
    parents: &PARENTS,
    facets: &FACETS,
    facet_kind: FacetKind::Tri6,
    vtk_type: 24,
    grid_cut: GridCut::Cells(&TETRAHEDRA_OF_BRICK),
};

impl Element for Tet10 {
    const KIND: CellKind = CellKind::Tet10;
    const NODES: usize = 10;
    const POINTS: usize = 8;
    type Nodal = [f64; 10];

    fn reference_nodes() -> &'static [[f64; 3]] {
        &REFERENCE_NODES
    }

    fn shape(xi: &[f64; 3]) -> [f64; 10] {
        simplex([1.0 - xi[0] - xi[1] - xi[2], xi[0], xi[1], xi[2]], &PARENTS)
    }

    fn shape_derivatives(xi: &[f64; 3]) -> [[f64; 10]; 3] {
        simplex_derivatives([1.0 - xi[0] - xi[1] - xi[2], xi[0], xi[1], xi[2]], &PARENTS)
    }

    fn rule() -> &'static [QuadraturePoint] {
        &TETRAHEDRON_8
    }

    fn mass_rule() -> &'static [QuadraturePoint] {
        &TETRAHEDRON_14
    }
}
