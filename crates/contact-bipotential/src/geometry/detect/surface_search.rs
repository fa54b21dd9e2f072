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

use super::rims::{Corners, Rims};
use crate::geometry::facet::{
    FacetPlace, FacetPoint, closest_point, conormal, facet_normal, interpolate, vertex_coordinates,
};
use crate::geometry::vector::{at_node, unit};

/// Two facets are equally close when their distances agree to this part of the distance ..
const TIE: f64 = 1e-12;
/// .. or to this part of the facet's size, squared: round-off of a node that lies on the surface.
const TIE_AT_ZERO: f64 = 1e-28;
/// By how much the boxes of the tree are larger than their facets, over the reach of the search \[-\]: a master may
/// move that far before the tree changes, and the larger it is, the more candidates are looked at.
const PADDING: f64 = 0.1;

/// A slave node's place on a master surface.
pub(super) struct SurfaceContact {
    pub(super) facet: u32,
    /// Nodes of the facet in the mesh.
    pub(super) nodes: Corners,
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
    facets: Vec<Corners>,
    rims: Rims,
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
        let facets: Vec<Corners> = (0..surface.facets.len())
            .map(|f| Corners::new(surface.corners(f)))
            .collect();
        Self {
            reach,
            rim_tolerance,
            dim: surface.dim(),
            nodes: surface.nodes.clone(),
            rims: Rims::new(&facets, surface.nodes.len()),
            facets,
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
        self.rims = self.rims.without(&self.facets, &on_axis);
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
        for facet in &self.facets {
            let corners = facet.indices().iter().map(|i| self.points[*i as usize]);
            self.boxes.push(Extent::of(corners));
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
                let corners = self.facets[facet as usize].indices().iter();
                let nearest = corners
                    .map(|i| (self.points[*i as usize] - x).norm_squared())
                    .fold(f64::INFINITY, f64::min);
                let extent = &self.boxes[facet as usize];
                found.push((extent.distance_squared(x), facet));
                // No closest point is farther than a vertex; the slack keeps ties.
                limit = limit.min(nearest + tie(nearest, extent));
            }
            TraversalAction::Continue
        });
    }

    fn project(&self, facet: u32, x: Vector3<f64>) -> FacetPoint {
        let mut buffer = [Vector3::zeros(); 4];
        closest_point(
            gather(&self.points, &self.facets[facet as usize], &mut buffer),
            x,
        )
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
        let corners = &self.facets[facet as usize];
        let [mut vertices, mut normals] = [[Vector3::zeros(); 4]; 2];
        let vertices = gather(&self.points, corners, &mut vertices);
        let normals = gather(&self.normals, corners, &mut normals);
        let normal = unit(interpolate(normals, &at.weights))
            .or_else(|| facet_normal(vertices, at.coordinates))?;
        let whole = x - at.point;
        let offset = self.without_overhang(whole, facet, at)?;
        // The signed distance, not n . offset: the same on a flat surface, and continuous where the
        // closest point jumps from one side of a valley to the other, as n is not.
        let along_a_normal = match at.place {
            FacetPlace::Interior => facet_normal(vertices, at.coordinates).map(|m| m.dot(&offset)),
            // Two rims that meet at an angle leave some overhang of each other, which is no gap.
            FacetPlace::Vertex(_) if offset != whole => Some(normal.dot(&offset)),
            _ => None,
        };
        let gap = along_a_normal.unwrap_or_else(|| offset.norm().copysign(normal.dot(&offset)));
        Some(SurfaceContact {
            facet,
            nodes: corners.map(|i| self.nodes[i as usize]),
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
            FacetPlace::Interior => Some(offset),
            FacetPlace::Edge(k) if !self.rims.is_rim(facet, k) => Some(offset),
            FacetPlace::Edge(k) => {
                offset = self.clip(offset, facet, k as usize, at.coordinates)?;
                Some(offset)
            }
            FacetPlace::Vertex(k) => {
                let node = self.facets[facet as usize].indices()[k as usize];
                for (facet, side) in self.rims.at_node(node) {
                    let corners = self.facets[*facet as usize].indices();
                    let own = corners.iter().position(|c| *c == node).unwrap_or(0);
                    let coordinates = vertex_coordinates(corners.len(), own);
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
        let outward = conormal(
            gather(&self.points, &self.facets[facet as usize], &mut buffer),
            side,
            coordinates,
        );
        let overhang = offset.dot(&outward).max(0.0);
        let tolerance = self.rim_tolerance * self.boxes[facet as usize].size();
        (overhang <= tolerance).then(|| offset - overhang * outward)
    }
}

/// What belongs to the corners of a facet, out of a list by surface index.
fn gather<'a>(
    values: &[Vector3<f64>],
    corners: &Corners,
    buffer: &'a mut [Vector3<f64>; 4],
) -> &'a [Vector3<f64>] {
    let indices = corners.indices();
    for (value, i) in buffer.iter_mut().zip(indices) {
        *value = values[*i as usize];
    }
    &buffer[..indices.len()]
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
