//! Linear tetrahedron, 4 nodes, 1 point.

use super::{CellData, CellKind, Element, FacetKind, GridCut};
use crate::quadrature::{QuadraturePoint, TETRAHEDRON_1, TETRAHEDRON_4};

/// Linear tetrahedron on the corner of the unit cube.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Tet4;

/// Corners of the reference tetrahedron, VTK order.
const REFERENCE_NODES: [[f64; 3]; 4] = [
    [0.0, 0.0, 0.0],
    [1.0, 0.0, 0.0],
    [0.0, 1.0, 0.0],
    [0.0, 0.0, 1.0],
];

/// Local nodes of the facets, outward.
static FACETS: [&[usize]; 4] = [&[0, 2, 1], &[0, 1, 3], &[1, 2, 3], &[0, 3, 2]];

/// The six tetrahedra of a brick around its diagonal 0-6. The same split in each brick makes the faces of
/// neighbours fit (Kuhn's triangulation).
pub(super) static TETRAHEDRA_OF_BRICK: [&[usize]; 6] = [
    &[0, 1, 2, 6],
    &[0, 2, 3, 6],
    &[0, 3, 7, 6],
    &[0, 7, 4, 6],
    &[0, 4, 5, 6],
    &[0, 5, 1, 6],
];

/// Row of the table of kinds.
pub(super) static CELL: CellData = CellData {
    name: "Tet4",
    nodes: 4,
    dim: 3,
    degree: 1,
    linear: CellKind::Tet4,
    quadratic: CellKind::Tet10,
    parents: &[],
    facets: &FACETS,
    facet_kind: FacetKind::Tri3,
    vtk_type: 10,
    grid_cut: GridCut::Cells(&TETRAHEDRA_OF_BRICK),
};

impl Element for Tet4 {
    const KIND: CellKind = CellKind::Tet4;
    const NODES: usize = 4;
    const POINTS: usize = 1;
    type Nodal = [f64; 4];

    fn reference_nodes() -> &'static [[f64; 3]] {
        &REFERENCE_NODES
    }

    fn shape(xi: &[f64; 3]) -> [f64; 4] {
        [1.0 - xi[0] - xi[1] - xi[2], xi[0], xi[1], xi[2]]
    }

    fn shape_derivatives(_xi: &[f64; 3]) -> [[f64; 4]; 3] {
        [
            [-1.0, 1.0, 0.0, 0.0],
            [-1.0, 0.0, 1.0, 0.0],
            [-1.0, 0.0, 0.0, 1.0],
        ]
    }

    fn rule() -> &'static [QuadraturePoint] {
        &TETRAHEDRON_1
    }

    fn mass_rule() -> &'static [QuadraturePoint] {
        &TETRAHEDRON_4
    }
}
