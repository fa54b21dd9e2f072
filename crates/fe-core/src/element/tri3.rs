//! Linear triangle, 3 nodes, 1 point.

use super::{CellData, CellKind, Element, FacetKind, GridCut};
use crate::quadrature::{QuadraturePoint, TRIANGLE_1, TRIANGLE_6};

/// Linear triangle on the corner of the unit square.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Tri3;

/// Corners of the reference triangle, counter-clockwise (VTK order).
const REFERENCE_NODES: [[f64; 3]; 3] = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];

/// Local nodes of the edges, the cell to their left.
static FACETS: [&[usize]; 3] = [&[0, 1], &[1, 2], &[2, 0]];

/// Row of the table of kinds.
pub(super) static CELL: CellData = CellData {
    name: "Tri3",
    nodes: 3,
    dim: 2,
    degree: 1,
    linear: CellKind::Tri3,
    quadratic: CellKind::Tri6,
    parents: &[],
    facets: &FACETS,
    facet_kind: FacetKind::Edge2,
    vtk_type: 5,
    grid_cut: GridCut::ShorterDiagonal,
};

impl Element for Tri3 {
    const KIND: CellKind = CellKind::Tri3;
    const NODES: usize = 3;
    const POINTS: usize = 1;
    type Nodal = [f64; 3];

    fn reference_nodes() -> &'static [[f64; 3]] {
        &REFERENCE_NODES
    }

    fn shape(xi: &[f64; 3]) -> [f64; 3] {
        [1.0 - xi[0] - xi[1], xi[0], xi[1]]
    }

    fn shape_derivatives(_xi: &[f64; 3]) -> [[f64; 3]; 3] {
        [[-1.0, 1.0, 0.0], [-1.0, 0.0, 1.0], [0.0; 3]]
    }

    fn rule() -> &'static [QuadraturePoint] {
        &TRIANGLE_1
    }

    fn mass_rule() -> &'static [QuadraturePoint] {
        &TRIANGLE_6
    }
}
