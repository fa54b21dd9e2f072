//! Trilinear hexahedron, 8 nodes, 8 Gauss points.

use super::{CellData, CellKind, Element, FacetKind, GridCut};
use crate::quadrature::{HEXAHEDRON_8, HEXAHEDRON_27, QuadraturePoint};

/// Trilinear hexahedron on \[-1, 1\]^3.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Hex8;

/// Corners of the reference cube, VTK order.
const REFERENCE_NODES: [[f64; 3]; 8] = [
    [-1.0, -1.0, -1.0],
    [1.0, -1.0, -1.0],
    [1.0, 1.0, -1.0],
    [-1.0, 1.0, -1.0],
    [-1.0, -1.0, 1.0],
    [1.0, -1.0, 1.0],
    [1.0, 1.0, 1.0],
    [-1.0, 1.0, 1.0],
];

/// Local nodes of the facets, outward: x, y, z low and high.
static FACETS: [&[usize]; 6] = [
    &[0, 4, 7, 3],
    &[1, 2, 6, 5],
    &[0, 1, 5, 4],
    &[3, 7, 6, 2],
    &[0, 3, 2, 1],
    &[4, 5, 6, 7],
];

/// Row of the table of kinds.
pub(super) static CELL: CellData = CellData {
    name: "Hex8",
    nodes: 8,
    dim: 3,
    degree: 1,
    linear: CellKind::Hex8,
    quadratic: CellKind::Hex27,
    parents: &[],
    facets: &FACETS,
    facet_kind: FacetKind::Quad4,
    vtk_type: 12,
    grid_cut: GridCut::Cells(&[&[0, 1, 2, 3, 4, 5, 6, 7]]),
};

impl Element for Hex8 {
    const KIND: CellKind = CellKind::Hex8;
    const NODES: usize = 8;
    const POINTS: usize = 8;
    type Nodal = [f64; 8];

    fn reference_nodes() -> &'static [[f64; 3]] {
        &REFERENCE_NODES
    }

    fn shape(xi: &[f64; 3]) -> [f64; 8] {
        REFERENCE_NODES
            .map(|c| 0.125 * (1.0 + c[0] * xi[0]) * (1.0 + c[1] * xi[1]) * (1.0 + c[2] * xi[2]))
    }

    fn shape_derivatives(xi: &[f64; 3]) -> [[f64; 8]; 3] {
        let factor = |c: &[f64; 3], j: usize| 1.0 + c[j] * xi[j];
        [(0, 1, 2), (1, 2, 0), (2, 0, 1)]
            .map(|(j, k, l)| REFERENCE_NODES.map(|c| 0.125 * c[j] * factor(&c, k) * factor(&c, l)))
    }

    fn rule() -> &'static [QuadraturePoint] {
        &HEXAHEDRON_8
    }

    fn mass_rule() -> &'static [QuadraturePoint] {
        &HEXAHEDRON_27
    }
}
