//! Surfaces: facets with their nodes, areas, normals and neighbours.

mod shares;
mod winding;

use nalgebra::Vector3;

use crate::element::Facet;
use crate::error::FeError;
use crate::mesh::Mesh;

/// A part of the boundary of one or more bodies.
///
/// Quadratic faces are cut between their nodes into facets of degree 1, which stand for them wherever a place or a
/// normal on the surface is asked for: a curved face is then off by the square of the size of a facet, its nodes are
/// not. Areas are those of the faces themselves.
#[derive(Debug, Clone, PartialEq)]
pub struct Surface {
    /// Facets of degree 1, outward.
    pub facets: Vec<Facet>,
    /// Nodes of the facets, sorted, without repeats. "Surface index" means a position in this list.
    pub nodes: Vec<u32>,
    faces: Vec<Facet>,
    dim: usize,
    corners: Vec<[u32; 4]>,
    offsets: Vec<u32>,
    around: Vec<u32>,
}

impl Surface {
    /// A surface from outward faces.
    ///
    /// # Errors
    /// [`FeError::Surface`] if there is no face, or edges are mixed with triangles or quadrilaterals.
    pub fn new(faces: Vec<Facet>) -> Result<Surface, FeError> {
        let refuse = |reason| Err(FeError::Surface { reason });
        let Some(first) = faces.first() else {
            return refuse("it has no facets; name a facet set that is not empty");
        };
        let dim = first.kind.dim();
        if faces.iter().any(|face| face.kind.dim() != dim) {
            return refuse(
                "edges of plane bodies cannot be mixed with triangles or quadrilaterals",
            );
        }
        let facets: Vec<Facet> = faces.iter().flat_map(Facet::pieces).collect();
        let mut nodes: Vec<u32> = facets.iter().flat_map(|f| f.nodes().to_vec()).collect();
        nodes.sort_unstable();
        nodes.dedup();
        let corners = facets.iter().map(|f| local_corners(f, &nodes)).collect();
        let (offsets, around) = facets_around_nodes(&corners, nodes.len());
        Ok(Surface {
            facets,
            nodes,
            faces,
            dim,
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
    #[must_use]
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

    /// Integral of each node's shape function over the faces, per surface index \[m^2\]: what a uniform traction
    /// loads a node with. For one metre of thickness in plane strain, for the whole ring if axisymmetric. Corners of
    /// quadratic triangles, and nodes on the axis at the end of a quadratic edge, get zero or nearly so, also negative.
    ///
    /// `mesh` is the whole mesh, of which only points and symmetry matter.
    #[must_use]
    pub fn shape_integrals(&self, mesh: &Mesh) -> Vec<f64> {
        self.sum_shares(mesh, |shares| shares)
    }

    /// Area that belongs to each node, never negative, per surface index \[m^2\]: [`Surface::shape_integrals`], in
    /// which no face counts for a node that has less than 1 % of its integral; the other nodes of the face get that.
    /// What acts per area acts on nodes with an area only.
    #[must_use]
    pub fn tributary_areas(&self, mesh: &Mesh) -> Vec<f64> {
        self.sum_shares(mesh, shares::usable)
    }

    fn sum_shares(&self, mesh: &Mesh, change: impl Fn([f64; 9]) -> [f64; 9]) -> Vec<f64> {
        let mut areas = vec![0.0; self.nodes.len()];
        for face in &self.faces {
            let shares = change(shares::shares(face, &mesh.points, mesh.symmetry));
            for (node, share) in face.nodes().iter().zip(shares) {
                areas[self.nodes.partition_point(|n| n < node)] += share;
            }
        }
        areas
    }

    /// Unit normal at each surface node, from the facets around it weighted with their angle at the node
    /// (the result does not depend on how a flat face is cut into facets).
    ///
    /// `positions` are current coordinates \[m\] of the whole mesh, flat, `dim * node + component`. A node
    /// whose facets cancel or have no area gets a zero vector.
    #[must_use]
    pub fn vertex_normals(&self, positions: &[f64]) -> Vec<Vector3<f64>> {
        let mut normals = vec![Vector3::zeros(); self.nodes.len()];
        for (facet, corners) in self.facets.iter().zip(&self.corners) {
            let count = facet.nodes().len();
            let x = self.facet_positions(facet, positions);
            for m in 0..count {
                normals[corners[m] as usize] += corner_normal(&x[..count], m);
            }
        }
        normals.iter_mut().for_each(|n| *n = unit(*n));
        normals
    }

    /// Current coordinates of a facet's nodes \[m\]; unused entries are zero.
    fn facet_positions(&self, facet: &Facet, positions: &[f64]) -> [Vector3<f64>; 4] {
        let mut x = [Vector3::zeros(); 4];
        for (x, &node) in x.iter_mut().zip(facet.nodes()) {
            let start = self.dim * node as usize;
            x.as_mut_slice()[..self.dim].copy_from_slice(&positions[start..start + self.dim]);
        }
        x
    }
}

/// Reference positions displaced by `u` \[m\]: flat, `dim * node + component`, as
/// [`Surface::vertex_normals`] wants them.
pub fn current_positions(points: &[Vector3<f64>], dim: usize, u: &[f64], positions: &mut Vec<f64>) {
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

/// Outward normal at corner `m` of a facet, as long as the angle there (1 for an edge).
fn corner_normal(x: &[Vector3<f64>], m: usize) -> Vector3<f64> {
    let count = x.len();
    if count == 2 {
        let d = x[1] - x[0];
        return unit(Vector3::new(d.y, -d.x, 0.0));
    }
    let to_next = x[(m + 1) % count] - x[m];
    let to_previous = x[(m + count - 1) % count] - x[m];
    let normal = to_next.cross(&to_previous);
    let angle = normal.norm().atan2(to_next.dot(&to_previous));
    angle * unit(normal)
}

/// Unit vector, or zero for a vector without direction.
fn unit(v: Vector3<f64>) -> Vector3<f64> {
    let length = v.norm();
    if length > 0.0 {
        v / length
    } else {
        Vector3::zeros()
    }
}
