//! Triquadratic hexahedron, 27 nodes, 27 Gauss points.

use super::quadratic::{line, line_derivative};
use super::{CellData, CellKind, Element, FacetKind, GridCut};
use crate::quadrature::{HEXAHEDRON_27, HEXAHEDRON_64, QuadraturePoint};

/// Triquadratic hexahedron on \[-1, 1\]^3.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Hex27;

/// Corners of the reference cube, middles of its edges, of its faces, its centre (VTK order).
const REFERENCE_NODES: [[f64; 3]; 27] = [
    [-1.0, -1.0, -1.0],
    [1.0, -1.0, -1.0],
    [1.0, 1.0, -1.0],
    [-1.0, 1.0, -1.0],
    [-1.0, -1.0, 1.0],
    [1.0, -1.0, 1.0],
    [1.0, 1.0, 1.0],
    [-1.0, 1.0, 1.0],
    [0.0, -1.0, -1.0],
    [1.0, 0.0, -1.0],
    [0.0, 1.0, -1.0],
    [-1.0, 0.0, -1.0],
    [0.0, -1.0, 1.0],
    [1.0, 0.0, 1.0],
    [0.0, 1.0, 1.0],
    [-1.0, 0.0, 1.0],
    [-1.0, -1.0, 0.0],
    [1.0, -1.0, 0.0],
    [1.0, 1.0, 0.0],
    [-1.0, 1.0, 0.0],
    [-1.0, 0.0, 0.0],
    [1.0, 0.0, 0.0],
    [0.0, -1.0, 0.0],
    [0.0, 1.0, 0.0],
    [0.0, 0.0, -1.0],
    [0.0, 0.0, 1.0],
    [0.0, 0.0, 0.0],
];

/// Local nodes of the facets, outward: corners, middles of the edges, centre; faces as those of the trilinear one.
static FACETS: [&[usize]; 6] = [
    &[0, 4, 7, 3, 16, 15, 19, 11, 20],
    &[1, 2, 6, 5, 9, 18, 13, 17, 21],
    &[0, 1, 5, 4, 8, 17, 12, 16, 22],
    &[3, 7, 6, 2, 19, 14, 18, 10, 23],
    &[0, 3, 2, 1, 11, 10, 9, 8, 24],
    &[4, 5, 6, 7, 12, 13, 14, 15, 25],
];

/// Corners between which the other nodes lie.
static PARENTS: [&[usize]; 19] = [
    &[0, 1],
    &[1, 2],
    &[2, 3],
    &[3, 0],
    &[4, 5],
    &[5, 6],
    &[6, 7],
    &[7, 4],
    &[0, 4],
    &[1, 5],
    &[2, 6],
    &[3, 7],
    &[0, 4, 7, 3],
    &[1, 2, 6, 5],
    &[0, 1, 5, 4],
    &[3, 7, 6, 2],
    &[0, 3, 2, 1],
    &[4, 5, 6, 7],
    &[0, 1, 2, 3, 4, 5, 6, 7],
];

/// Row of the table of kinds.
pub(super) static CELL: CellData = CellData {
    name: "Hex27",
    nodes: 27,
    dim: 3,
    degree: 2,
    linear: CellKind::Hex8,
    quadratic: CellKind::Hex27,
    parents: &PARENTS,
    facets: &FACETS,
    facet_kind: FacetKind::Quad9,
    vtk_type: 29,
    grid_cut: GridCut::Cells(&[&[0, 1, 2, 3, 4, 5, 6, 7]]),
};

impl Element for Hex27 {
    const KIND: CellKind = CellKind::Hex27;
    const NODES: usize = 27;
    const POINTS: usize = 27;
    const DILATATION_MODES: usize = 4;
    type Nodal = [f64; 27];

    fn reference_nodes() -> &'static [[f64; 3]] {
        &REFERENCE_NODES
    }

    fn shape(xi: &[f64; 3]) -> [f64; 27] {
        REFERENCE_NODES.map(|c| line(c[0], xi[0]) * line(c[1], xi[1]) * line(c[2], xi[2]))
    }

    fn shape_derivatives(xi: &[f64; 3]) -> [[f64; 27]; 3] {
        [(0, 1, 2), (1, 2, 0), (2, 0, 1)].map(|(j, k, l)| {
            REFERENCE_NODES
                .map(|c| line_derivative(c[j], xi[j]) * line(c[k], xi[k]) * line(c[l], xi[l]))
        })
    }

    fn rule() -> &'static [QuadraturePoint] {
        &HEXAHEDRON_27
    }

    fn mass_rule() -> &'static [QuadraturePoint] {
        &HEXAHEDRON_64
    }
}
