//! Structured meshes.

use std::collections::BTreeMap;

use super::{CellBlock, CellKind, Facet, Mesh};
use crate::error::MeshError;

/// A box of `cells[0] x cells[1] x cells[2]` bricks, each one hexahedron or six tetrahedra.
///
/// Nodes are numbered with x fastest. The mesh has node and facet sets `x_min`, `x_max`, `y_min`,
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
    /// [`CellKind::Hex8`] or [`CellKind::Tet4`].
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
    /// [`MeshError::Box`] for a box without extent, without cells, or with a grading that is not positive;
    /// or for more nodes than 32-bit indices can address.
    pub fn generate(&self, block: &str) -> Result<Mesh, MeshError> {
        self.check()?;
        let axes: [Vec<f64>; 3] = std::array::from_fn(|i| self.coordinates(i));
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
        Ok(Mesh {
            dim: 3,
            points,
            blocks: vec![CellBlock {
                name: block.to_owned(),
                kind: self.kind,
                cells: self.connectivity(),
            }],
            node_sets,
            facet_sets,
        })
    }

    fn check(&self) -> Result<(), MeshError> {
        let refuse = |axis, what, value, bound| {
            Err(MeshError::Box {
                axis,
                what,
                value,
                bound,
            })
        };
        for axis in 0..3 {
            let (length, grading) = (self.max[axis] - self.min[axis], self.grading[axis]);
            if !(length > 0.0 && length.is_finite()) {
                return refuse(axis, "length [m]", length, "must be positive and finite");
            }
            if self.cells[axis] == 0 {
                return refuse(axis, "cells", 0.0, "must be at least 1");
            }
            if !(grading > 0.0 && grading.is_finite()) {
                return refuse(axis, "grading", grading, "must be positive and finite");
            }
        }
        let nodes = self.cells.iter().map(|&n| n as f64 + 1.0).product::<f64>();
        if nodes >= f64::from(u32::MAX) {
            return refuse(2, "nodes of the box", nodes, "must be below 2^32");
        }
        Ok(())
    }

    /// Coordinates of the grid lines along an axis \[m\].
    fn coordinates(&self, axis: usize) -> Vec<f64> {
        let n = self.cells[axis];
        let (min, max) = (self.min[axis], self.max[axis]);
        let log_ratio = self.grading[axis].ln() / (n.max(2) - 1) as f64;
        let fraction = |k: usize| {
            if log_ratio == 0.0 {
                k as f64 / n as f64
            } else {
                (k as f64 * log_ratio).exp_m1() / (n as f64 * log_ratio).exp_m1()
            }
        };
        (0..=n)
            .map(|k| {
                if k == n {
                    max
                } else {
                    min + (max - min) * fraction(k)
                }
            })
            .collect()
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
                    match self.kind {
                        CellKind::Hex8 => cells.extend(brick),
                        CellKind::Tet4 => {
                            cells.extend(TETRAHEDRA.iter().flatten().map(|&a| brick[a]));
                        }
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
        match self.kind {
            CellKind::Hex8 => facets.push(Facet::of_cell(brick, quad)),
            CellKind::Tet4 => {
                // The split runs through node 0 or 6, whichever lies on this side.
                let hinge = if side.is_multiple_of(2) { 0 } else { 6 };
                let first = quad.iter().position(|&a| a == hinge).unwrap_or(0);
                let around = |m: usize| brick[quad[(first + m) % 4]];
                facets.push(Facet::triangle([around(0), around(1), around(2)]));
                facets.push(Facet::triangle([around(0), around(2), around(3)]));
            }
        }
    }
}
