//! Surfaces: facets with their nodes, areas, normals and neighbours.

use crate::error::FeError;
use crate::mesh::{Facet, Mesh, Symmetry};
use crate::quadrature::GAUSS_2;
use crate::vector::{cross, dot, minus, norm, unit};

/// A part of the boundary of one or more bodies.
#[derive(Debug, Clone, PartialEq)]
pub struct Surface {
    /// Facets, outward.
    pub facets: Vec<Facet>,
    /// Nodes of the facets, sorted, without repeats. "Surface index" means a position in this list.
    pub nodes: Vec<u32>,
    dim: usize,
    corners: Vec<[u32; 4]>,
    offsets: Vec<u32>,
    around: Vec<u32>,
}

impl Surface {
    /// A surface from outward facets.
    ///
    /// # Errors
    /// [`FeError::Surface`] if there is no facet, or edges are mixed with triangles or quadrilaterals.
    pub fn new(facets: Vec<Facet>) -> Result<Surface, FeError> {
        let refuse = |reason| Err(FeError::Surface { reason });
        if facets.is_empty() {
            return refuse("it has no facets; name a facet set that is not empty");
        }
        if facets.iter().any(|f| !(2..=4).contains(&f.count)) {
            return refuse("a facet has 2, 3 or 4 nodes");
        }
        let plane = facets[0].count == 2;
        if facets.iter().any(|f| (f.count == 2) != plane) {
            return refuse(
                "edges of plane bodies cannot be mixed with triangles or quadrilaterals",
            );
        }
        let mut nodes: Vec<u32> = facets.iter().flat_map(|f| f.nodes().to_vec()).collect();
        nodes.sort_unstable();
        nodes.dedup();
        let corners = facets.iter().map(|f| local_corners(f, &nodes)).collect();
        let (offsets, around) = facets_around_nodes(&corners, nodes.len());
        Ok(Surface {
            facets,
            nodes,
            dim: if plane { 2 } else { 3 },
            corners,
            offsets,
            around,
        })
    }

    /// Unknowns per node: 2 for edges, 3 for triangles and quadrilaterals.
    pub fn dim(&self) -> usize {
        self.dim
    }

    /// Surface index of a node, if it belongs to the surface.
    pub fn index_of(&self, node: u32) -> Option<usize> {
        self.nodes.binary_search(&node).ok()
    }

    /// Facets around a node, increasing; `index` is a surface index.
    pub fn facets_around(&self, index: usize) -> &[u32] {
        &self.around[self.offsets[index] as usize..self.offsets[index + 1] as usize]
    }

    /// Surface indices of a facet's nodes, in the order of the facet.
    pub fn corners(&self, facet: usize) -> &[u32] {
        &self.corners[facet][..self.facets[facet].nodes().len()]
    }

    /// Area that belongs to each node: the integral of its shape function over the facets, per surface
    /// index \[m^2\]; for one metre of thickness in plane strain, for the whole ring if axisymmetric.
    ///
    /// `mesh` is the whole mesh, of which only points and symmetry matter.
    pub fn tributary_areas(&self, mesh: &Mesh) -> Vec<f64> {
        let mut areas = vec![0.0; self.nodes.len()];
        for (facet, corners) in self.facets.iter().zip(&self.corners) {
            let shares = facet_shares(facet, &mesh.points, mesh.symmetry);
            for (share, &index) in shares.iter().zip(&corners[..facet.nodes().len()]) {
                areas[index as usize] += share;
            }
        }
        areas
    }

    /// Unit normal at each surface node, from the facets around it weighted with their angle at the node
    /// (the result does not depend on how a flat face is cut into facets).
    ///
    /// `positions` are current coordinates \[m\] of the whole mesh, flat, `dim * node + component`. A node
    /// whose facets cancel or have no area gets a zero vector.
    pub fn vertex_normals(&self, positions: &[f64]) -> Vec<[f64; 3]> {
        let mut normals = vec![[0.0; 3]; self.nodes.len()];
        for (facet, corners) in self.facets.iter().zip(&self.corners) {
            let count = facet.nodes().len();
            let x = self.facet_positions(facet, positions);
            for m in 0..count {
                let weighted = corner_normal(&x[..count], m);
                let normal = &mut normals[corners[m] as usize];
                (0..3).for_each(|i| normal[i] += weighted[i]);
            }
        }
        normals.iter_mut().for_each(|n| *n = unit(n));
        normals
    }

    /// Current coordinates of a facet's nodes \[m\]; unused entries are zero.
    fn facet_positions(&self, facet: &Facet, positions: &[f64]) -> [[f64; 3]; 4] {
        let mut x = [[0.0; 3]; 4];
        for (x, &node) in x.iter_mut().zip(facet.nodes()) {
            let start = self.dim * node as usize;
            x[..self.dim].copy_from_slice(&positions[start..start + self.dim]);
        }
        x
    }
}

/// Reference positions displaced by `u` \[m\]: flat, `dim * node + component`, as
/// [`Surface::vertex_normals`] wants them.
pub fn current_positions(points: &[[f64; 3]], dim: usize, u: &[f64], positions: &mut Vec<f64>) {
    positions.clear();
    let moved = points.iter().zip(u.chunks_exact(dim));
    positions.extend(moved.flat_map(|(x, u)| (0..dim).map(|i| x[i] + u[i])));
}

fn local_corners(facet: &Facet, nodes: &[u32]) -> [u32; 4] {
    let mut corners = [u32::MAX; 4];
    for (corner, node) in corners.iter_mut().zip(facet.nodes()) {
        *corner = nodes.partition_point(|n| n < node) as u32;
    }
    corners
}

fn facets_around_nodes(corners: &Vec<[u32; 4]>, nodes: usize) -> (Vec<u32>, Vec<u32>) {
    let used = |corners: &[u32; 4]| {
        corners
            .map(|c| c as usize)
            .into_iter()
            .filter(move |&c| c < nodes)
    };
    let mut offsets = vec![0_u32; nodes + 1];
    for facet in corners {
        used(facet).for_each(|c| offsets[c + 1] += 1);
    }
    for c in 0..nodes {
        offsets[c + 1] += offsets[c];
    }
    let mut next = offsets.clone();
    let mut around = vec![0; offsets[nodes] as usize];
    for (f, facet) in corners.iter().enumerate() {
        for c in used(facet) {
            around[next[c] as usize] = f as u32;
            next[c] += 1;
        }
    }
    (offsets, around)
}

/// Integral of each shape function over a facet \[m^2\]; unused entries are zero.
fn facet_shares(facet: &Facet, points: &[[f64; 3]], symmetry: Symmetry) -> [f64; 4] {
    let x = |m: usize| points[facet.nodes[m] as usize];
    match facet.nodes().len() {
        2 => {
            let (a, b) = (x(0), x(1));
            let half = 0.5 * (b[0] - a[0]).hypot(b[1] - a[1]);
            // Exact for shape functions and a radius that are linear along the edge.
            let share = |near: f64, far: f64| half * symmetry.extent((2.0 * near + far) / 3.0);
            [share(a[0], b[0]), share(b[0], a[0]), 0.0, 0.0]
        }
        3 => {
            let normal = cross(&minus(&x(1), &x(0)), &minus(&x(2), &x(0)));
            let third = norm(&normal) / 6.0;
            [third, third, third, 0.0]
        }
        _ => quad_shares(&[x(0), x(1), x(2), x(3)]),
    }
}

/// Integral of the bilinear shape functions over a quadrilateral \[m^2\], 2x2 Gauss points: exact if flat.
fn quad_shares(x: &[[f64; 3]; 4]) -> [f64; 4] {
    let signs = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];
    let mut shares = [0.0; 4];
    for point in signs {
        let [xi, eta] = [point[0] * GAUSS_2, point[1] * GAUSS_2];
        let (mut along_xi, mut along_eta) = ([0.0; 3], [0.0; 3]);
        for (x, s) in x.iter().zip(signs) {
            for i in 0..3 {
                along_xi[i] += 0.25 * s[0] * (1.0 + s[1] * eta) * x[i];
                along_eta[i] += 0.25 * s[1] * (1.0 + s[0] * xi) * x[i];
            }
        }
        let area = norm(&cross(&along_xi, &along_eta));
        for (share, s) in shares.iter_mut().zip(signs) {
            *share += 0.25 * (1.0 + s[0] * xi) * (1.0 + s[1] * eta) * area;
        }
    }
    shares
}

/// Outward normal at corner `m` of a facet, as long as the angle there (1 for an edge).
fn corner_normal(x: &[[f64; 3]], m: usize) -> [f64; 3] {
    let count = x.len();
    if count == 2 {
        let d = minus(&x[1], &x[0]);
        return unit(&[d[1], -d[0], 0.0]);
    }
    let to_next = minus(&x[(m + 1) % count], &x[m]);
    let to_previous = minus(&x[(m + count - 1) % count], &x[m]);
    let normal = cross(&to_next, &to_previous);
    let angle = norm(&normal).atan2(dot(&to_next, &to_previous));
    unit(&normal).map(|n| angle * n)
}
