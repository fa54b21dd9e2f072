//! Biquadratic quadrilateral, 9 nodes, 9 Gauss points.

use super::facet::QUADRILATERAL_PARENTS;
use super::quadratic::{line, line_derivative};
use super::{CellData, CellKind, Element, FacetKind, GridCut};
use crate::quadrature::{QUADRILATERAL_9, QUADRILATERAL_16, QuadraturePoint};

/// Biquadratic quadrilateral on \[-1, 1\]^2.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Quad9;

/// Corners of the reference square, counter-clockwise, middles of its edges, its centre (VTK order).
const REFERENCE_NODES: [[f64; 3]; 9] = [
    [-1.0, -1.0, 0.0],
    [1.0, -1.0, 0.0],
    [1.0, 1.0, 0.0],
    [-1.0, 1.0, 0.0],
    [0.0, -1.0, 0.0],
    [1.0, 0.0, 0.0],
    [0.0, 1.0, 0.0],
    [-1.0, 0.0, 0.0],
    [0.0, 0.0, 0.0],
];

/// Local nodes of the edges, the cell to their left: ends, middle.
static FACETS: [&[usize]; 4] = [&[0, 1, 4], &[1, 2, 5], &[2, 3, 6], &[3, 0, 7]];

/// Row of the table of kinds.
pub(super) static CELL: CellData = CellData {
    name: "Quad9",
    nodes: 9,
    dim: 2,
    degree: 2,
    linear: CellKind::Quad4,
    quadratic: CellKind::Quad9,
    parents: &QUADRILATERAL_PARENTS,
    facets: &FACETS,
    facet_kind: FacetKind::Edge3,
    vtk_type: 28,
    grid_cut: GridCut::Cells(&[&[0, 1, 2, 3]]),
};

impl Element for Quad9 {
    const KIND: CellKind = CellKind::Quad9;
    const NODES: usize = 9;
    const POINTS: usize = 9;
    const DILATATION_MODES: usize = 3;
    type Nodal = [f64; 9];

    fn reference_nodes() -> &'static [[f64; 3]] {
        &REFERENCE_NODES
    }

    fn shape(xi: &[f64; 3]) -> [f64; 9] {
        REFERENCE_NODES.map(|c| line(c[0], xi[0]) * line(c[1], xi[1]))
    }

    fn shape_derivatives(xi: &[f64; 3]) -> [[f64; 9]; 3] {
        [
            REFERENCE_NODES.map(|c| line_derivative(c[0], xi[0]) * line(c[1], xi[1])),
            REFERENCE_NODES.map(|c| line(c[0], xi[0]) * line_derivative(c[1], xi[1])),
            [0.0; 9],
        ]
    }

    fn rule() -> &'static [QuadraturePoint] {
        &QUADRILATERAL_9
    }

    fn mass_rule() -> &'static [QuadraturePoint] {
        &QUADRILATERAL_16
    }
}
