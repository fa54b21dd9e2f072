//! Bilinear quadrilateral, 4 nodes, 4 Gauss points.

use super::{CellData, CellKind, Element, FacetKind, GridCut};
use crate::quadrature::{QUADRILATERAL_4, QUADRILATERAL_9, QuadraturePoint};

/// Bilinear quadrilateral on \[-1, 1\]^2.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Quad4;

/// Corners of the reference square, counter-clockwise (VTK order).
const REFERENCE_NODES: [[f64; 3]; 4] = [
    [-1.0, -1.0, 0.0],
    [1.0, -1.0, 0.0],
    [1.0, 1.0, 0.0],
    [-1.0, 1.0, 0.0],
];

/// Local nodes of the edges, the cell to their left.
static FACETS: [&[usize]; 4] = [&[0, 1], &[1, 2], &[2, 3], &[3, 0]];

/// Row of the table of kinds.
pub(super) static CELL: CellData = CellData {
    name: "Quad4",
    nodes: 4,
    dim: 2,
    degree: 1,
    linear: CellKind::Quad4,
    quadratic: CellKind::Quad9,
    parents: &[],
    facets: &FACETS,
    facet_kind: FacetKind::Edge2,
    vtk_type: 9,
    grid_cut: GridCut::Cells(&[&[0, 1, 2, 3]]),
};

impl Element for Quad4 {
    const KIND: CellKind = CellKind::Quad4;
    const NODES: usize = 4;
    const POINTS: usize = 4;
    type Nodal = [f64; 4];

    fn reference_nodes() -> &'static [[f64; 3]] {
        &REFERENCE_NODES
    }

    fn shape(xi: &[f64; 3]) -> [f64; 4] {
        REFERENCE_NODES.map(|c| 0.25 * (1.0 + c[0] * xi[0]) * (1.0 + c[1] * xi[1]))
    }

    fn shape_derivatives(xi: &[f64; 3]) -> [[f64; 4]; 3] {
        [
            REFERENCE_NODES.map(|c| 0.25 * c[0] * (1.0 + c[1] * xi[1])),
            REFERENCE_NODES.map(|c| 0.25 * c[1] * (1.0 + c[0] * xi[0])),
            [0.0; 4],
        ]
    }

    fn rule() -> &'static [QuadraturePoint] {
        &QUADRILATERAL_4
    }

    fn mass_rule() -> &'static [QuadraturePoint] {
        &QUADRILATERAL_9
    }
}
