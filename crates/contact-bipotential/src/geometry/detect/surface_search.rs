//! Closest point on a deformable surface: tree of padded boxes, exact facets, rims.
//!
//! In the plane the surface is a chain of lines in z = 0, its boxes are flat and its rims are the ends of the chain.

use fe_core::Surface;
use nalgebra::Vector3;
use parry3d_f64::bounding_volume::Aabb;
use parry3d_f64::math::Vector;
use parry3d_f64::partitioning::{
    Bvh, BvhBuildStrategy, BvhLeafUpdateStatus, BvhNode, BvhWorkspace, TraversalAction,
};

use crate::geometry::facet::{
    FacetPoint, Place, closest_point, conormal, facet_normal, interpolate, vertex_coordinates,
};
use crate::geometry::vector::{at_node, unit};

/// Two facets are equally close when their distances agree to this part of the distance ..
const TIE: f64 = 1e-12;
/// .. or to this part of the facet's size, squared: round-off of a node that lies on the surface.
const TIE_AT_ZERO: f64 = 1e-28;
/// By how much the boxes of the tree are larger than their facets, over the reach of the search \[-\]: a master may move
/// that far before the tree changes, and the larger it is, the more candidates are looked at.
const PADDING: f64 = 0.1;

/// A slave node's place on a master surface.
pub(super) struct SurfaceContact {
    pub(super) facet: u32,
    pub(super) nodes: [u32; 4],
    pub(super) count: usize,
    pub(super) weights: [f64; 4],
    pub(super) normal: Vector3<f64>,
    pub(super) gap: f64,
}

/// Outcome of a search for one node.
pub(super) struct Touch {
    pub(super) contact: Option<SurfaceContact>,
    pub(super) projections: u64,
}

impl Touch {
    fn nothing(projections: u64) -> Self {
        Self {
            contact: None,
            projections,
        }
    }
}

/// Axis-parallel box.
#[derive(Clone, Copy, Debug)]
struct Extent {
    min: Vector3<f64>,
    max: Vector3<f64>,
}

impl Extent {
    fn of(points: impl Iterator<Item = Vector3<f64>>) -> Self {
        let empty = Self {
            min: Vector3::repeat(f64::INFINITY),
            max: Vector3::repeat(f64::NEG_INFINITY),
        };
        points.fold(empty, |b, x| Self {
            min: b.min.zip_map(&x, f64::min),
            max: b.max.zip_map(&x, f64::max),
        })
    }

    fn distance_squared(&self, x: Vector3<f64>) -> f64 {
        let d = Vector3::from_fn(|i, _| (self.min[i] - x[i]).max(x[i] - self.max[i]).max(0.0));
        d.norm_squared()
    }

    fn is_apart(&self, other: &Self, reach: f64) -> bool {
        (0..3).any(|i| self.min[i] - other.max[i] > reach || other.min[i] - self.max[i] > reach)
    }

    fn size(&self) -> f64 {
        (self.max - self.min).norm()
    }

    fn padded(&self, by: f64) -> Aabb {
        let vector = |a: Vector3<f64>, s: f64| Vector::new(a[0] + s, a[1] + s, a[2] + s);
        Aabb::new(vector(self.min, -by), vector(self.max, by))
    }
}

/// Everything the search of one master surface remembers; all of it follows from the positions.
pub(super) struct SurfaceSearch {
    reach: f64,
    rim_tolerance: f64,
    dim: usize,
    nodes: Vec<u32>,
    /// Surface indices of each facet's nodes, and how many.
    facets: Vec<([u32; 4], u8)>,
    /// Bit `k`: side `k` of the facet (edge of a face, vertex of a line) belongs to no other facet.
    rim_sides: Vec<u8>,
    /// Rim sides (facet, side) at each surface node: `rims[rim_starts[i]..rim_starts[i + 1]]`.
    rim_starts: Vec<usize>,
    rims: Vec<(u32, u8)>,
    /// Surface indices of the nodes on the axis of symmetry.
    axis: Vec<usize>,
    points: Vec<Vector3<f64>>,
    normals: Vec<Vector3<f64>>,
    boxes: Vec<Extent>,
    tree: Option<Bvh>,
    workspace: BvhWorkspace,
}

impl std::fmt::Debug for SurfaceSearch {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("SurfaceSearch")
            .field("facets", &self.facets.len())
            .finish_non_exhaustive()
    }
}

impl SurfaceSearch {
    pub(super) fn new(surface: &Surface, reach: f64, rim_tolerance: f64) -> Self {
        let facets: Vec<([u32; 4], u8)> = (0..surface.facets.len())
            .map(|f| {
                let corners = surface.corners(f);
                let mut local = [0; 4];
                local[..corners.len()].copy_from_slice(corners);
                (local, corners.len() as u8)
            })
            .collect();
        let rim_sides = rim_sides(&facets);
        let (rim_starts, rims) = rims_at_nodes(&facets, &rim_sides, surface.nodes.len());
        Self {
            reach,
            rim_tolerance,
            dim: surface.dim(),
            nodes: surface.nodes.clone(),
            facets,
            rim_sides,
            rim_starts,
            rims,
            axis: Vec::new(),
            points: Vec::new(),
            normals: Vec::new(),
            boxes: Vec::new(),
            tree: None,
            workspace: BvhWorkspace::default(),
        }
    }

    /// Continues a chain across x = 0 by its mirror image: its ends there are no rims, and their normals run along y.
    pub(super) fn mirror_at_axis(&mut self, is_on_axis: impl Fn(u32) -> bool) {
        let on_axis: Vec<bool> = self.nodes.iter().map(|node| is_on_axis(*node)).collect();
        for ((corners, count), mask) in self.facets.iter().zip(&mut self.rim_sides) {
            for (k, corner) in corners[..*count as usize].iter().enumerate() {
                *mask &= !(u8::from(on_axis[*corner as usize]) << k);
            }
        }
        (self.rim_starts, self.rims) =
            rims_at_nodes(&self.facets, &self.rim_sides, self.nodes.len());
        self.axis = (0..on_axis.len()).filter(|i| on_axis[*i]).collect();
    }

    pub(super) fn set_reach(&mut self, reach: f64) {
        self.reach = reach;
    }

    /// Reads the surface's positions out of the flat array of the mesh.
    pub(super) fn gather(&mut self, positions: &[f64]) {
        self.points.clear();
        self.points.extend(
            self.nodes
                .iter()
                .map(|node| at_node(positions, self.dim, *node)),
        );
    }

    /// The box test: true if no slave can be within reach of the surface.
    pub(super) fn is_out_of_reach(&self, slaves: impl Iterator<Item = Vector3<f64>>) -> bool {
        let surface = Extent::of(self.points.iter().copied());
        Extent::of(slaves).is_apart(&surface, self.reach)
    }

    /// Brings boxes and tree up to date; true if the tree had to change.
    ///
    /// The tree's boxes are padded, so small motions leave it alone. Padding never changes a result: every
    /// candidate is tested again with its exact box.
    pub(super) fn refit(&mut self) -> bool {
        self.boxes.clear();
        for (corners, count) in &self.facets {
            let corners = &corners[..*count as usize];
            self.boxes
                .push(Extent::of(corners.iter().map(|i| self.points[*i as usize])));
        }
        let pad = PADDING * self.reach;
        let Some(tree) = &mut self.tree else {
            let leaves: Vec<Aabb> = self.boxes.iter().map(|b| b.padded(pad)).collect();
            self.tree = Some(Bvh::from_leaves(BvhBuildStrategy::Binned, &leaves));
            return true;
        };
        let mut moved = false;
        for (k, extent) in self.boxes.iter().enumerate() {
            let status = tree.insert_or_update_partially(extent.padded(0.0), k as u32, pad);
            moved |= !matches!(status, BvhLeafUpdateStatus::Unchanged);
        }
        if moved {
            tree.refit(&mut self.workspace);
        }
        moved
    }

    /// Unit normals at the surface nodes, by surface index.
    pub(super) fn set_normals(&mut self, normals: Vec<Vector3<f64>>) {
        self.normals = normals;
        for i in &self.axis {
            let along = Vector3::new(0.0, self.normals[*i][1], 0.0);
            self.normals[*i] = unit(along).unwrap_or_else(Vector3::zeros);
        }
    }

    /// Facets that may be closest to `x`, with the squared distances of their boxes; a superset.
    fn candidates(&self, x: Vector3<f64>, found: &mut Vec<(f64, u32)>) {
        found.clear();
        let Some(tree) = &self.tree else { return };
        let mut limit = self.reach * self.reach;
        tree.traverse(|node: &BvhNode| {
            if node_distance_squared(node, x) > limit {
                return TraversalAction::Prune;
            }
            if let Some(facet) = node.leaf_data() {
                let (corners, count) = &self.facets[facet as usize];
                let nearest = corners[..*count as usize]
                    .iter()
                    .map(|i| {
                        let r = self.points[*i as usize] - x;
                        r.norm_squared()
                    })
                    .fold(f64::INFINITY, f64::min);
                let extent = &self.boxes[facet as usize];
                found.push((extent.distance_squared(x), facet));
                // No closest point is farther than a vertex; the slack keeps ties.
                limit = limit.min(nearest + tie(nearest, extent));
            }
            TraversalAction::Continue
        });
    }

    fn vertices<'a>(&self, facet: u32, buffer: &'a mut [Vector3<f64>; 4]) -> &'a [Vector3<f64>] {
        let (corners, count) = &self.facets[facet as usize];
        for (x, i) in buffer.iter_mut().zip(corners) {
            *x = self.points[*i as usize];
        }
        &buffer[..*count as usize]
    }

    fn project(&self, facet: u32, x: Vector3<f64>) -> FacetPoint {
        let mut buffer = [Vector3::zeros(); 4];
        closest_point(self.vertices(facet, &mut buffer), x)
    }

    /// The contact of a node at `x`, if the surface is within reach; `found` is scratch.
    pub(super) fn touch(&self, x: Vector3<f64>, found: &mut Vec<(f64, u32)>) -> Touch {
        self.candidates(x, found);
        // By facet number, so that neither the shape of the tree nor its history can break a tie; the first to
        // be projected is the one with the nearest box, which settles most of the others.
        found.sort_unstable_by_key(|(_, facet)| *facet);
        let first = found
            .iter()
            .enumerate()
            .min_by(|a, b| a.1.0.total_cmp(&b.1.0))
            .map(|(k, _)| k);
        let Some(first) = first else {
            return Touch::nothing(0);
        };
        let mut best = (found[first].1, self.project(found[first].1, x));
        let mut projections = 1;
        for (k, (box_distance, facet)) in found.iter().enumerate() {
            let slack = tie(best.1.distance_squared, &self.boxes[*facet as usize]);
            if k == first || *box_distance > best.1.distance_squared + slack {
                continue;
            }
            projections += 1;
            let at = self.project(*facet, x);
            let (d, closest) = (at.distance_squared, best.1.distance_squared);
            if d < closest - slack || (d <= closest + slack && *facet < best.0) {
                best = (*facet, at);
            }
        }
        if best.1.distance_squared > self.reach * self.reach {
            return Touch::nothing(projections);
        }
        Touch {
            contact: self.contact(x, best.0, &best.1),
            projections,
        }
    }

    fn contact(&self, x: Vector3<f64>, facet: u32, at: &FacetPoint) -> Option<SurfaceContact> {
        let (corners, count) = &self.facets[facet as usize];
        let count = *count as usize;
        let corner_normals: [Vector3<f64>; 4] = corners.map(|i| self.normals[i as usize]);
        let mut buffer = [Vector3::zeros(); 4];
        let vertices = self.vertices(facet, &mut buffer);
        let normal = unit(interpolate(&corner_normals[..count], &at.weights))
            .or_else(|| facet_normal(vertices, at.coordinates))?;
        let whole = x - at.point;
        let offset = self.without_overhang(whole, facet, at)?;
        // The signed distance, not n . offset: the same on a flat surface, and continuous where the
        // closest point jumps from one side of a valley to the other, as n is not.
        let along_a_normal = match at.place {
            Place::Interior => facet_normal(vertices, at.coordinates).map(|m| m.dot(&offset)),
            // Two rims that meet at an angle leave some overhang of each other, which is no gap.
            Place::Vertex(_) if offset != whole => Some(normal.dot(&offset)),
            _ => None,
        };
        let gap = along_a_normal.unwrap_or_else(|| offset.norm().copysign(normal.dot(&offset)));
        Some(SurfaceContact {
            facet,
            nodes: corners.map(|i| self.nodes[i as usize]),
            count,
            weights: at.weights,
            normal,
            gap,
        })
    }

    /// The node seen from its closest point, without the part that hangs over the rim; `None` when it hangs
    /// over too far to rest on the surface.
    ///
    /// Only the direction out of the surface across its rim counts: above a convex ridge that runs
    /// into the rim, a node is in contact like above any other ridge. The sign of the gap does not matter, or
    /// an open contact would hold up a node that falls past the rim.
    fn without_overhang(
        &self,
        mut offset: Vector3<f64>,
        facet: u32,
        at: &FacetPoint,
    ) -> Option<Vector3<f64>> {
        match at.place {
            Place::Interior => Some(offset),
            Place::Edge(k) if self.rim_sides[facet as usize] & (1 << k) == 0 => Some(offset),
            Place::Edge(k) => {
                offset = self.clip(offset, facet, k as usize, at.coordinates)?;
                Some(offset)
            }
            Place::Vertex(k) => {
                let node = self.facets[facet as usize].0[k as usize] as usize;
                for (facet, side) in &self.rims[self.rim_starts[node]..self.rim_starts[node + 1]] {
                    let (corners, count) = &self.facets[*facet as usize];
                    let own = corners
                        .iter()
                        .position(|c| *c as usize == node)
                        .unwrap_or(0);
                    let coordinates = vertex_coordinates(*count as usize, own);
                    offset = self.clip(offset, *facet, *side as usize, coordinates)?;
                }
                Some(offset)
            }
        }
    }

    fn clip(
        &self,
        offset: Vector3<f64>,
        facet: u32,
        side: usize,
        coordinates: [f64; 2],
    ) -> Option<Vector3<f64>> {
        let mut buffer = [Vector3::zeros(); 4];
        let outward = conormal(self.vertices(facet, &mut buffer), side, coordinates);
        let overhang = offset.dot(&outward).max(0.0);
        let tolerance = self.rim_tolerance * self.boxes[facet as usize].size();
        (overhang <= tolerance).then(|| offset - overhang * outward)
    }
}

fn tie(distance_squared: f64, extent: &Extent) -> f64 {
    let size = extent.size();
    TIE * distance_squared + TIE_AT_ZERO * size * size
}

fn node_distance_squared(node: &BvhNode, x: Vector3<f64>) -> f64 {
    let (min, max) = (node.mins(), node.maxs());
    Extent {
        min: Vector3::new(min.x, min.y, min.z),
        max: Vector3::new(max.x, max.y, max.z),
    }
    .distance_squared(x)
}

/// The nodes of side `k` of a facet, the same for all facets that share it: an edge of a face, a vertex of a line
/// (twice). A collapsed side (a quadrilateral with two equal nodes) bounds nothing.
fn side_nodes((corners, count): &([u32; 4], u8), k: usize) -> Option<(u32, u32)> {
    let (a, b) = (corners[k], corners[(k + 1) % *count as usize]);
    match (a == b, *count) {
        (true, _) => None,
        (false, 2) => Some((a, a)),
        (false, _) => Some((a.min(b), a.max(b))),
    }
}

/// Bit mask per facet of the sides that no other facet shares.
fn rim_sides(facets: &[([u32; 4], u8)]) -> Vec<u8> {
    let mut sides: Vec<((u32, u32), usize, usize)> = Vec::new();
    for (f, facet) in facets.iter().enumerate() {
        let own = (0..facet.1 as usize).filter_map(|k| Some((side_nodes(facet, k)?, f, k)));
        sides.extend(own);
    }
    sides.sort_unstable();
    let mut mask = vec![0; facets.len()];
    for same in sides.chunk_by(|a, b| a.0 == b.0) {
        if let [(_, f, k)] = same {
            mask[*f] |= 1 << k;
        }
    }
    mask
}

fn rims_at_nodes(
    facets: &[([u32; 4], u8)],
    rim_sides: &[u8],
    nodes: usize,
) -> (Vec<usize>, Vec<(u32, u8)>) {
    let mut all: Vec<(u32, u32, u8)> = Vec::new();
    for (f, facet) in facets.iter().enumerate() {
        for k in (0..facet.1 as usize).filter(|k| rim_sides[f] & (1 << k) != 0) {
            if let Some((a, b)) = side_nodes(facet, k) {
                all.extend([(a, f as u32, k as u8), (b, f as u32, k as u8)]);
            }
        }
    }
    all.sort_unstable();
    all.dedup();
    let mut starts = vec![0; nodes + 1];
    for (node, ..) in &all {
        starts[*node as usize + 1] += 1;
    }
    for i in 0..nodes {
        starts[i + 1] += starts[i];
    }
    (starts, all.into_iter().map(|(_, f, k)| (f, k)).collect())
}
