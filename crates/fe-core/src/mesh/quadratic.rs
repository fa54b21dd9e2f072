//! From cells of degree 1 to cells of degree 2.

use std::collections::BTreeMap;

use nalgebra::Vector3;

use super::{CellBlock, Mesh};
use crate::element::Facet;
use crate::mesh::MeshError;

/// No corner.
const NONE: u32 = u32::MAX;

impl Mesh {
    /// The same bodies of quadratic cells: nodes in the middle of edges, faces and cells, shared by neighbours. The
    /// nodes there were stay and keep their numbers. Facet sets become quadratic, and node sets take the nodes between
    /// theirs: those of the facet set of that name, else those whose corners all belong to it.
    ///
    /// # Errors
    /// [`MeshError::Shape`] if there are more nodes than 32-bit indices can address.
    pub fn quadratic(&self) -> Result<Mesh, MeshError> {
        self.quadratic_at(|_, x| x)
    }

    /// [`Mesh::quadratic`] with nodes that lie elsewhere: `place` gets the corners in whose middle a node lies and
    /// where it would lie \[m\], and gives its place \[m\]. Nodes of faces and cells follow those of their edges before
    /// they are asked for, so that cells with curved edges are curved inside too.
    ///
    /// # Errors
    /// As [`Mesh::quadratic`].
    pub(crate) fn quadratic_at(
        &self,
        place: impl Fn(&[u32], Vector3<f64>) -> Vector3<f64>,
    ) -> Result<Mesh, MeshError> {
        let added = |block: &CellBlock| block.kind.quadratic().parents().len() * block.cell_count();
        let most = self.points.len() + self.blocks.iter().map(added).sum::<usize>();
        if most >= NONE as usize {
            return Err(MeshError::Shape {
                shape: "quadratic",
                what: "nodes, those of each cell counted".to_owned(),
                value: most as f64,
                bound: "must be below 2^32",
            });
        }
        let mut builder = Builder {
            points: self.points.clone(),
            first: self.points.len(),
            middles: BTreeMap::new(),
            corners: Vec::new(),
            place,
        };
        let blocks = self.blocks.iter().map(|block| builder.block(block));
        let blocks = blocks.collect();
        let facet_sets: BTreeMap<String, Vec<Facet>> = self
            .facet_sets
            .iter()
            .map(|(name, facets)| {
                let facets = facets.iter().map(|facet| builder.facet(facet));
                (name.clone(), facets.collect())
            })
            .collect();
        let node_sets = self
            .node_sets
            .iter()
            .map(|(name, nodes)| {
                let added = match facet_sets.get(name) {
                    Some(facets) => facets.iter().flat_map(|f| f.nodes().to_vec()).collect(),
                    None => builder.between(nodes),
                };
                let mut all: Vec<u32> = nodes.iter().copied().chain(added).collect();
                all.sort_unstable();
                all.dedup();
                (name.clone(), all)
            })
            .collect();
        Ok(Mesh {
            dim: self.dim,
            symmetry: self.symmetry,
            points: builder.points,
            blocks,
            node_sets,
            facet_sets,
        })
    }
}

/// Nodes in the middle of corners, as they are found.
struct Builder<F> {
    points: Vec<Vector3<f64>>,
    /// Number of corners.
    first: usize,
    /// Nodes of edges and faces by their corners, sorted.
    middles: BTreeMap<[u32; 4], u32>,
    /// Corners of each node that was added.
    corners: Vec<[u32; 8]>,
    place: F,
}

impl<F: Fn(&[u32], Vector3<f64>) -> Vector3<f64>> Builder<F> {
    fn block(&mut self, block: &CellBlock) -> CellBlock {
        let mut cells = Vec::new();
        let kind = block.kind.quadratic();
        let complete = block.kind.degree() == 2;
        for cell in block.iter() {
            let start = cells.len();
            cells.extend_from_slice(cell);
            for parents in kind.parents().iter().filter(|_| !complete) {
                let corners: Vec<u32> = parents.iter().map(|&a| cell[a]).collect();
                let node = match corners.len() {
                    8 => self.centre(&corners, &cells[start..]),
                    _ => self.middle(&corners),
                };
                cells.push(node);
            }
        }
        CellBlock::new(&block.name, kind, cells)
    }

    fn facet(&mut self, facet: &Facet) -> Facet {
        let kind = facet.kind.quadratic();
        if kind == facet.kind {
            return *facet;
        }
        let mut nodes = facet.nodes().to_vec();
        for parents in kind.parents() {
            let corners: Vec<u32> = parents.iter().map(|&a| facet.nodes[a]).collect();
            nodes.push(self.middle(&corners));
        }
        Facet::new(kind, nodes)
    }

    /// Node in the middle of an edge, or of a quadrilateral given by its corners in order.
    fn middle(&mut self, corners: &[u32]) -> u32 {
        let mut key = [NONE; 4];
        key[..corners.len()].copy_from_slice(corners);
        key.sort_unstable();
        if let Some(&node) = self.middles.get(&key) {
            return node;
        }
        let ends = self.sum(corners);
        let x = match *corners {
            [a, b, c, d] => {
                let edges = [[a, b], [b, c], [c, d], [d, a]].map(|edge| self.middle(&edge));
                let edges = self.sum(&edges);
                0.5 * edges - 0.25 * ends
            }
            _ => 0.5 * ends,
        };
        let node = self.add(corners, x);
        self.middles.insert(key, node);
        node
    }

    /// Node in the middle of a hexahedron, from its corners and the 26 nodes it has so far: the blend of its faces.
    fn centre(&mut self, corners: &[u32], nodes: &[u32]) -> u32 {
        let [corner, edge, face] = [0..8, 8..20, 20..26].map(|part| self.sum(&nodes[part]));
        self.add(corners, 0.5 * face - 0.25 * edge + 0.125 * corner)
    }

    fn add(&mut self, corners: &[u32], x: Vector3<f64>) -> u32 {
        let mut all = [NONE; 8];
        all[..corners.len()].copy_from_slice(corners);
        self.corners.push(all);
        self.points.push((self.place)(corners, x));
        (self.points.len() - 1) as u32
    }

    /// Sum of the places of nodes \[m\]; exact for four that agree.
    fn sum(&self, nodes: &[u32]) -> Vector3<f64> {
        let point = |&node: &u32| self.points[node as usize];
        let pair = |pair: &[u32]| -> Vector3<f64> { pair.iter().map(point).sum() };
        nodes.chunks(2).map(pair).sum()
    }

    /// Added nodes whose corners all belong to a set.
    fn between(&self, set: &[u32]) -> Vec<u32> {
        let belongs = |&corner: &u32| corner == NONE || set.binary_search(&corner).is_ok();
        let added = (self.first as u32..).zip(&self.corners);
        let inside = added.filter(|(_, corners)| corners.iter().all(belongs));
        inside.map(|(node, _)| node).collect()
    }
}
