//! Boxes.

use std::collections::BTreeMap;

use super::{check_grid, check_kind, graded};
use crate::error::MeshError;
use crate::mesh::{CellBlock, CellKind, Facet, FacetKind, Mesh, Symmetry};

/// A box of `cells[0] x cells[1] x cells[2]` bricks, each one hexahedron or six tetrahedra.
///
/// Nodes are numbered with x fastest, those that quadratic cells add come after them. The mesh has node and facet sets `x_min`, `x_max`, `y_min`,
/// `y_max`, `z_min`, `z_max` and the node set `all`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BoxMesh {
    /// Lowest corner \[m\].
    pub min: [f64; 3],
    /// Highest corner \[m\].
    pub max: [f64; 3],
    /// Bricks per axis.
    pub cells: [usize; 3],
    /// Size of the last brick over that of the first, per axis \[-\]; sizes grow geometrically, 1 is uniform.
    pub grading: [f64; 3],
    /// A kind of solid cells.
    pub kind: CellKind,
}

/// The six tetrahedra of a brick around its diagonal 0-6. The same split in each brick makes the faces of
/// neighbours fit (Kuhn's triangulation).
const TETRAHEDRA: [[usize; 4]; 6] = [
    [0, 1, 2, 6],
    [0, 2, 3, 6],
    [0, 3, 7, 6],
    [0, 7, 4, 6],
    [0, 4, 5, 6],
    [0, 5, 1, 6],
];

/// Sides in the order of the hexahedron's facets.
const SIDES: [&str; 6] = ["x_min", "x_max", "y_min", "y_max", "z_min", "z_max"];

impl BoxMesh {
    /// A box of equal hexahedra.
    pub fn uniform(min: [f64; 3], max: [f64; 3], cells: [usize; 3]) -> BoxMesh {
        BoxMesh {
            min,
            max,
            cells,
            grading: [1.0; 3],
            kind: CellKind::Hex8,
        }
    }

    /// The same box with another kind of cells.
    pub fn with_kind(self, kind: CellKind) -> BoxMesh {
        BoxMesh { kind, ..self }
    }

    /// Builds the mesh; its only block gets the name `block`.
    ///
    /// # Errors
    /// [`MeshError::Shape`] for a box without extent, without cells, with a grading that is not positive, or with
    /// more nodes than 32-bit indices can address; [`MeshError::CellDimension`] for plane cells.
    pub fn generate(&self, block: &str) -> Result<Mesh, MeshError> {
        check_kind(block, self.kind, 3)?;
        check_grid("box", &self.min, &self.max, &self.cells, &self.grading)?;
        let axes: [Vec<f64>; 3] = std::array::from_fn(|i| {
            graded(self.min[i], self.max[i], self.cells[i], self.grading[i])
        });
        let mut points = Vec::with_capacity(axes.iter().map(Vec::len).product());
        for &z in &axes[2] {
            for &y in &axes[1] {
                points.extend(axes[0].iter().map(|&x| [x, y, z]));
            }
        }
        let all = (0..points.len() as u32).collect();
        let mut node_sets = BTreeMap::from([("all".to_owned(), all)]);
        let mut facet_sets = BTreeMap::new();
        for (side, name) in SIDES.iter().enumerate() {
            let facets = self.side_facets(side);
            let mut nodes: Vec<u32> = facets.iter().flat_map(|f| f.nodes().to_vec()).collect();
            nodes.sort_unstable();
            nodes.dedup();
            node_sets.insert((*name).to_owned(), nodes);
            facet_sets.insert((*name).to_owned(), facets);
        }
        let mesh = Mesh {
            dim: 3,
            symmetry: Symmetry::None,
            points,
            blocks: vec![CellBlock {
                name: block.to_owned(),
                kind: self.kind.linear(),
                cells: self.connectivity(),
            }],
            node_sets,
            facet_sets,
        };
        match self.kind.degree() {
            1 => Ok(mesh),
            _ => mesh.quadratic(),
        }
    }

    /// The eight corners of a brick, VTK order.
    fn brick(&self, [i, j, k]: [usize; 3]) -> [u32; 8] {
        let (nx, ny) = (self.cells[0] + 1, self.cells[1] + 1);
        let node =
            |di: usize, dj: usize, dk: usize| ((i + di) + nx * ((j + dj) + ny * (k + dk))) as u32;
        [
            node(0, 0, 0),
            node(1, 0, 0),
            node(1, 1, 0),
            node(0, 1, 0),
            node(0, 0, 1),
            node(1, 0, 1),
            node(1, 1, 1),
            node(0, 1, 1),
        ]
    }

    fn connectivity(&self) -> Vec<u32> {
        let [nx, ny, nz] = self.cells;
        let mut cells = Vec::new();
        for k in 0..nz {
            for j in 0..ny {
                for i in 0..nx {
                    let brick = self.brick([i, j, k]);
                    if self.kind.linear() == CellKind::Tet4 {
                        cells.extend(TETRAHEDRA.iter().flatten().map(|&a| brick[a]));
                    } else {
                        cells.extend(brick);
                    }
                }
            }
        }
        cells
    }

    /// Outward facets of one side, in the order of the bricks.
    fn side_facets(&self, side: usize) -> Vec<Facet> {
        let axis = side / 2;
        let mut low = [0; 3];
        let mut high = self.cells;
        if side.is_multiple_of(2) {
            high[axis] = 1;
        } else {
            low[axis] = high[axis] - 1;
        }
        let mut facets = Vec::new();
        for k in low[2]..high[2] {
            for j in low[1]..high[1] {
                for i in low[0]..high[0] {
                    self.brick_facets(&self.brick([i, j, k]), side, &mut facets);
                }
            }
        }
        facets
    }

    fn brick_facets(&self, brick: &[u32; 8], side: usize, facets: &mut Vec<Facet>) {
        let quad = CellKind::Hex8.facets()[side];
        if self.kind.linear() == CellKind::Tet4 {
            // The split runs through node 0 or 6, whichever lies on this side.
            let hinge = if side.is_multiple_of(2) { 0 } else { 6 };
            let first = quad.iter().position(|&a| a == hinge).unwrap_or(0);
            let around = |m: usize| brick[quad[(first + m) % 4]];
            facets.push(Facet::triangle([around(0), around(1), around(2)]));
            facets.push(Facet::triangle([around(0), around(2), around(3)]));
        } else {
            facets.push(Facet::of_cell(FacetKind::Quad4, brick, quad));
        }
    }
}
