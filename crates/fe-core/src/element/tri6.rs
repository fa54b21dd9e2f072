//! Quadratic triangle, 6 nodes, 6 points.

use super::facet::TRIANGLE_PARENTS;
use super::quadratic::{simplex, simplex_derivatives};
use super::{CellData, CellKind, Element, FacetKind, GridCut};
use crate::quadrature::{QuadraturePoint, TRIANGLE_6, TRIANGLE_7};

/// Quadratic triangle on the corner of the unit square.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Tri6;

/// Corners of the reference triangle, counter-clockwise, and middles of its edges (VTK order).
const REFERENCE_NODES: [[f64; 3]; 6] = [
    [0.0, 0.0, 0.0],
    [1.0, 0.0, 0.0],
    [0.0, 1.0, 0.0],
    [0.5, 0.0, 0.0],
    [0.5, 0.5, 0.0],
    [0.0, 0.5, 0.0],
];

/// Local nodes of the edges, the cell to their left: ends, middle.
static FACETS: [&[usize]; 3] = [&[0, 1, 3], &[1, 2, 4], &[2, 0, 5]];

/// Row of the table of kinds.
pub(super) static CELL: CellData = CellData {
    name: "Tri6",
    nodes: 6,
    dim: 2,
    degree: 2,
    linear: CellKind::Tri3,
    quadratic: CellKind::Tri6,
    parents: &TRIANGLE_PARENTS,
    facets: &FACETS,
    facet_kind: FacetKind::Edge3,
    vtk_type: 22,
    grid_cut: GridCut::ShorterDiagonal,
};

impl Element for Tri6 {
    const KIND: CellKind = CellKind::Tri6;
    const NODES: usize = 6;
    const POINTS: usize = 6;
    type Nodal = [f64; 6];

    fn reference_nodes() -> &'static [[f64; 3]] {
        &REFERENCE_NODES
    }

    fn shape(xi: &[f64; 3]) -> [f64; 6] {
        simplex([1.0 - xi[0] - xi[1], xi[0], xi[1]], &TRIANGLE_PARENTS)
    }

    fn shape_derivatives(xi: &[f64; 3]) -> [[f64; 6]; 3] {
        simplex_derivatives([1.0 - xi[0] - xi[1], xi[0], xi[1]], &TRIANGLE_PARENTS)
    }

    fn rule() -> &'static [QuadraturePoint] {
        &TRIANGLE_6
    }

    fn mass_rule() -> &'static [QuadraturePoint] {
        &TRIANGLE_7
    }
}
