//! Discs and balls: a bulged square or cubic core, and shells of cells from its sides to the rim.

use std::f64::consts::FRAC_PI_4;

use nalgebra::Vector3;

use super::{
    Pole, into_kind, name_side, require_finite, require_indices, require_positive, single_block,
};
use crate::element::{CellKind, Facet};
use crate::mesh::Mesh;
use crate::mesh::MeshError;

/// Distance of the core's corners from the centre, in radii.
const CORE: f64 = 0.6;

/// How far the core's sides are bulged: 0 is flat, 1 is round. Between, angles at its corners are near 120 degrees.
const BULGE: f64 = 1.0 / 3.0;

/// The whole or the part of a disc or ball that a grid of cells in \[-1, 1\]^dim or its upper part becomes.
#[derive(Debug)]
pub(super) struct OGrid {
    pub(super) shape: &'static str,
    pub(super) center: Vector3<f64>,
    pub(super) radius: f64,
    pub(super) pole: Pole,
    /// Cells of a quarter of the rim.
    pub(super) quarter: usize,
    /// Name of the rim.
    pub(super) rim: &'static str,
    /// The core in its own coordinates. What lies at 1 or -1 there faces the rim.
    pub(super) core: Mesh,
    /// Cells, of which those of the core are the linear form or what is cut into it.
    pub(super) kind: CellKind,
}

impl OGrid {
    /// Builds the mesh with the rim named.
    pub(super) fn generate(self, block: &str) -> Result<Mesh, MeshError> {
        require_finite(self.shape, self.center.as_slice())?;
        require_positive(self.shape, "radius [m]", self.radius)?;
        let xi = &self.core.points;
        let faces: Vec<Facet> = self.core.boundary_facets();
        let faces: Vec<Facet> = faces.into_iter().filter(|f| faces_rim(f, xi)).collect();
        let mut outer: Vec<u32> = faces.iter().flat_map(|f| f.nodes().to_vec()).collect();
        outer.sort_unstable();
        outer.dedup();
        // Cells of the shell become as long as they are wide on average.
        let layers = ((2 * self.quarter + 2) / 5).max(1);
        let nodes = xi.len() as f64 + outer.len() as f64 * layers as f64;
        require_indices(self.shape, nodes)?;

        let mut points: Vec<Vector3<f64>> = xi
            .iter()
            .map(|xi| self.place(core_point(xi, self.core.dim)))
            .collect();
        for layer in 1..=layers {
            let t = layer as f64 / layers as f64;
            for &node in &outer {
                let xi = &xi[node as usize];
                let (from, to) = (core_point(xi, self.core.dim), rim_point(xi));
                points.push(self.place((1.0 - t) * from + t * to));
            }
        }
        let cells = self.cells(&faces, &outer, layers);
        let first_of_rim = points.len() - outer.len();
        let (kind, symmetry) = (self.core.blocks[0].kind, self.core.symmetry);
        let mut mesh = single_block(symmetry, points, block, kind, cells);
        let boundary = mesh.boundary_facets();
        name_side(&mut mesh, &boundary, self.rim, |n| n >= first_of_rim);
        into_kind(mesh, self.kind, self.center, |n| n as usize >= first_of_rim)
    }

    /// From the unit circle or ball to its place \[m\].
    fn place(&self, mut x: Vector3<f64>) -> Vector3<f64> {
        if self.pole == Pole::Down {
            let last = self.core.dim - 1;
            x[last] = -x[last];
        }
        self.center + self.radius * x
    }

    fn cells(&self, faces: &[Facet], outer: &[u32], layers: usize) -> Vec<u32> {
        let mut cells = self.core.blocks[0].cells.clone();
        let core = self.core.points.len();
        let at = |node: u32, layer: usize| match layer {
            0 => node,
            _ => {
                let index = outer.partition_point(|&n| n < node);
                (core + (layer - 1) * outer.len() + index) as u32
            }
        };
        for layer in 0..layers {
            for face in faces {
                let nodes = face.nodes();
                if let &[a, b] = nodes {
                    let next = layer + 1;
                    cells.extend([at(a, layer), at(a, next), at(b, next), at(b, layer)]);
                } else {
                    cells.extend(nodes.iter().map(|&n| at(n, layer)));
                    cells.extend(nodes.iter().map(|&n| at(n, layer + 1)));
                }
            }
        }
        if self.pole == Pole::Down {
            // A mirrored cell keeps its sense when it is walked the other way round.
            let kind = self.core.blocks[0].kind;
            for cell in cells.chunks_exact_mut(kind.node_count()) {
                match kind.dim() {
                    3 => cell.rotate_left(4),
                    _ => cell.reverse(),
                }
            }
        }
        cells
    }
}

/// True if a facet of the core lies at 1 or -1 in some coordinate.
fn faces_rim(facet: &Facet, xi: &[Vector3<f64>]) -> bool {
    let side = |i: usize, at: f64| facet.nodes().iter().all(|&n| xi[n as usize][i] == at);
    (0..3).any(|i| side(i, 1.0) || side(i, -1.0))
}

/// Place of a core point in the unit circle or ball: between a square (cube) and the circle (sphere) through its
/// corners.
fn core_point(xi: &Vector3<f64>, dim: usize) -> Vector3<f64> {
    let flat = 1.0 / (dim as f64).sqrt();
    let bulged = |coordinates: f64| CORE * (flat + BULGE * (1.0 / coordinates.sqrt() - flat));
    // First coordinate in the middle of a face, in the middle of an edge, and at a corner.
    let (face, edge, corner) = (bulged(1.0), bulged(2.0), bulged(3.0));
    Vector3::from_fn(|i, _| {
        let (s, t) = (xi[(i + 1) % 3].powi(2), xi[(i + 2) % 3].powi(2));
        xi[i] * (face + (edge - face) * (s + t) + (corner - 2.0 * edge + face) * s * t)
    })
}

/// Place on the unit circle or sphere; equal steps along a side become equal angles.
fn rim_point(xi: &Vector3<f64>) -> Vector3<f64> {
    xi.map(|xi| (FRAC_PI_4 * xi).tan()).normalize()
}
