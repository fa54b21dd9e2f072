//! Meshes: points, blocks of cells, and named sets of nodes and facets.

mod error;
mod generate;
mod quadratic;
#[cfg(feature = "serde")]
pub mod text;

use std::collections::BTreeMap;
use std::ops::Deref;

use nalgebra::Vector3;

pub use error::MeshError;
pub use generate::{
    AnnulusMesh, BoxMesh, DiscMesh, GridAxis, GridMesh, GridPiece, HalfBallMesh, HalfDiscMesh,
    Pole, QuarterDiscMesh, RectangleMesh,
};

use crate::element::{CellKind, Facet};
use crate::symmetry::Symmetry;

/// Cells of one kind that share a material.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct CellBlock {
    /// Name, used in errors and output.
    pub name: String,
    /// Kind of all cells of the block.
    pub kind: CellKind,
    /// Node indices, cell after cell, in VTK order.
    pub cells: Vec<u32>,
}

impl CellBlock {
    /// Cells by their nodes, cell after cell, in VTK order.
    #[must_use]
    pub fn new(name: &str, kind: CellKind, cells: Vec<u32>) -> CellBlock {
        CellBlock {
            name: name.to_owned(),
            kind,
            cells,
        }
    }

    /// Number of cells.
    pub fn cell_count(&self) -> usize {
        self.cells.len() / self.kind.node_count()
    }

    /// The cells' node lists, in order.
    pub fn iter(&self) -> std::slice::ChunksExact<'_, u32> {
        self.cells.chunks_exact(self.kind.node_count())
    }
}

/// Points, cells and named sets. Everything public: a mesh is plain data until it is [`Mesh::validated`].
#[derive(Debug, Clone, Default, PartialEq)]
#[non_exhaustive]
pub struct Mesh {
    /// Unknowns per node: 3 in space, 2 in the plane (then the third coordinate is ignored).
    pub dim: usize,
    /// What the plane stands for; [`Symmetry::None`] in space.
    pub symmetry: Symmetry,
    /// Reference coordinates \[m\].
    pub points: Vec<Vector3<f64>>,
    /// Blocks of cells.
    pub blocks: Vec<CellBlock>,
    /// Named node lists, sorted, without repeats.
    pub node_sets: BTreeMap<String, Vec<u32>>,
    /// Named facet lists, outward.
    pub facet_sets: BTreeMap<String, Vec<Facet>>,
}

/// A mesh that satisfies [`Mesh::validate`], and can be read only: what elements and solids are made from.
///
/// ```
/// use fe_core::BoxMesh;
/// let mut mesh = BoxMesh::uniform([0.0; 3], [1.0; 3], [2; 3]).generate("cube")?;
/// mesh.points[0].x = -0.1;
/// let mesh = mesh.validated()?;
/// assert_eq!(mesh.points.len(), 27);
///
/// // To change it, take the mesh out, and have it checked again.
/// let mut mesh = mesh.into_inner();
/// mesh.points[0].x = 1.0;
/// assert!(mesh.validated().is_err());
/// # Ok::<(), fe_core::MeshError>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct ValidMesh(Mesh);

impl ValidMesh {
    /// The mesh, to be changed.
    #[must_use]
    pub fn into_inner(self) -> Mesh {
        self.0
    }
}

impl Deref for ValidMesh {
    type Target = Mesh;

    fn deref(&self) -> &Mesh {
        &self.0
    }
}

impl Mesh {
    /// A mesh of these points \[m\] and blocks, without sets.
    #[must_use]
    pub fn new(symmetry: Symmetry, points: Vec<Vector3<f64>>, blocks: Vec<CellBlock>) -> Mesh {
        Mesh {
            dim: symmetry.dim(),
            symmetry,
            points,
            blocks,
            ..Mesh::default()
        }
    }

    /// Adds another mesh with its own nodes. Its set `name` becomes `prefix.name`; blocks keep their names.
    /// An empty `prefix` keeps the names of sets too. A set that exists already is extended. An empty mesh takes the
    /// dimension and the symmetry of the other.
    ///
    /// # Errors
    /// [`MeshError::Symmetry`] if the two differ in symmetry; nothing is added then.
    pub fn append(&mut self, prefix: &str, other: Mesh) -> Result<(), MeshError> {
        let shift = self.points.len() as u32;
        if self.blocks.is_empty() && self.points.is_empty() {
            (self.dim, self.symmetry) = (other.dim, other.symmetry);
        }
        check_symmetry(self.symmetry, other.symmetry)?;
        let rename = |name: String| match prefix {
            "" => name,
            _ => format!("{prefix}.{name}"),
        };
        self.points.extend(other.points);
        for mut block in other.blocks {
            block.cells.iter_mut().for_each(|node| *node += shift);
            self.blocks.push(block);
        }
        for (name, nodes) in other.node_sets {
            let set = self.node_sets.entry(rename(name)).or_default();
            set.extend(nodes.into_iter().map(|node| node + shift));
        }
        for (name, facets) in other.facet_sets {
            let set = self.facet_sets.entry(rename(name)).or_default();
            set.extend(facets.into_iter().map(|mut facet| {
                let count = facet.nodes().len();
                facet.nodes[..count].iter_mut().for_each(|n| *n += shift);
                facet
            }));
        }
        Ok(())
    }

    /// The node set of that name.
    ///
    /// # Errors
    /// [`MeshError::UnknownSet`] with the names there are.
    pub fn node_set(&self, name: &str) -> Result<&[u32], MeshError> {
        let found = self.node_sets.get(name).map(Vec::as_slice);
        found.ok_or_else(|| unknown_set("node", name, self.node_sets.keys()))
    }

    /// The facet set of that name.
    ///
    /// # Errors
    /// [`MeshError::UnknownSet`] with the names there are.
    pub fn facet_set(&self, name: &str) -> Result<&[Facet], MeshError> {
        let found = self.facet_sets.get(name).map(Vec::as_slice);
        found.ok_or_else(|| unknown_set("facet", name, self.facet_sets.keys()))
    }

    /// All facets that belong to one cell only, outward, in the order of blocks and cells.
    #[must_use]
    pub fn boundary_facets(&self) -> Vec<Facet> {
        let mut all = Vec::new();
        for block in &self.blocks {
            for cell in block.iter() {
                for local in block.kind.facets() {
                    let facet = Facet::of_cell(block.kind.facet_kind(), cell, local);
                    all.push((facet.key(), all.len(), facet));
                }
            }
        }
        all.sort_unstable_by_key(|(key, order, _)| (*key, *order));
        let mut single: Vec<_> = all
            .chunk_by(|a, b| a.0 == b.0)
            .filter(|shared| shared.len() == 1)
            .map(|shared| (shared[0].1, shared[0].2))
            .collect();
        single.sort_unstable_by_key(|(order, _)| *order);
        single.into_iter().map(|(_, facet)| facet).collect()
    }

    /// The mesh, checked: the only way to a [`ValidMesh`].
    ///
    /// # Errors
    /// The first defect that [`Mesh::validate`] finds.
    pub fn validated(self) -> Result<ValidMesh, MeshError> {
        self.validate()?;
        Ok(ValidMesh(self))
    }

    /// Checks all that the assembly relies on: finite points, indices in range, positive Jacobians at the
    /// quadrature points, no node without element, sorted sets.
    ///
    /// # Errors
    /// The first defect found, with block and element.
    pub fn validate(&self) -> Result<(), MeshError> {
        self.validate_points()?;
        let mut used = vec![false; self.points.len()];
        for block in &self.blocks {
            self.validate_cells(block)?;
            block
                .cells
                .iter()
                .for_each(|&node| used[node as usize] = true);
        }
        if let Some(node) = used.iter().position(|used| !used) {
            return Err(MeshError::OrphanNode { node });
        }
        self.validate_node_sets()?;
        self.validate_facet_sets()
    }

    fn validate_points(&self) -> Result<(), MeshError> {
        if self.dim != self.symmetry.dim() {
            return Err(MeshError::Dimension {
                dim: self.dim,
                symmetry: self.symmetry,
            });
        }
        if self.points.is_empty() {
            return Err(MeshError::Empty { what: "points" });
        }
        if self.blocks.iter().all(|block| block.cells.is_empty()) {
            return Err(MeshError::Empty { what: "cells" });
        }
        let finite = |point: &Vector3<f64>| point.iter().all(|x| x.is_finite());
        if let Some(node) = self.points.iter().position(|point| !finite(point)) {
            return Err(MeshError::PointNotFinite {
                node,
                point: self.points[node],
            });
        }
        let axisymmetric = self.symmetry == Symmetry::Axisymmetric;
        match self.points.iter().position(|point| point[0] < 0.0) {
            Some(node) if axisymmetric => Err(MeshError::NegativeRadius {
                node,
                radius: self.points[node][0],
            }),
            _ => Ok(()),
        }
    }

    fn validate_cells(&self, block: &CellBlock) -> Result<(), MeshError> {
        let name = || block.name.clone();
        let (kind, nodes) = (block.kind, block.kind.node_count());
        if kind.dim() != self.dim {
            return Err(MeshError::CellDimension {
                block: name(),
                kind,
                dim: self.dim,
            });
        }
        if !block.cells.len().is_multiple_of(nodes) {
            return Err(MeshError::Connectivity {
                block: name(),
                length: block.cells.len(),
                nodes,
            });
        }
        for (element, cell) in block.iter().enumerate() {
            self.validate_cell(block, element, cell)?;
        }
        Ok(())
    }

    fn validate_cell(
        &self,
        block: &CellBlock,
        element: usize,
        cell: &[u32],
    ) -> Result<(), MeshError> {
        let name = || block.name.clone();
        let points = self.points.len();
        if let Some(&node) = cell.iter().find(|&&node| node as usize >= points) {
            return Err(MeshError::NodeOutOfRange {
                block: name(),
                element,
                node,
                points,
            });
        }
        let repeated = (1..cell.len()).find(|&a| cell[..a].contains(&cell[a]));
        if let Some(a) = repeated {
            return Err(MeshError::RepeatedNode {
                block: name(),
                element,
                node: cell[a],
            });
        }
        match block.kind.bad_jacobian(&self.points, cell) {
            Some((point, det_j)) => Err(MeshError::Jacobian {
                block: name(),
                element,
                point,
                det_j,
            }),
            None => Ok(()),
        }
    }

    fn validate_node_sets(&self) -> Result<(), MeshError> {
        for (set, nodes) in &self.node_sets {
            let disorder = nodes.windows(2).find(|pair| pair[0] >= pair[1]);
            let outside = nodes.iter().find(|&&n| n as usize >= self.points.len());
            if let Some(&node) = disorder.map(|pair| &pair[1]).or(outside) {
                return Err(MeshError::NodeSet {
                    set: set.clone(),
                    node,
                });
            }
        }
        Ok(())
    }

    fn validate_facet_sets(&self) -> Result<(), MeshError> {
        for (set, facets) in &self.facet_sets {
            let wrong = |facet: &Facet| {
                facet.kind.dim() != self.dim
                    || facet
                        .nodes()
                        .iter()
                        .any(|&n| n as usize >= self.points.len())
            };
            if let Some(facet) = facets.iter().position(wrong) {
                return Err(MeshError::FacetSet {
                    set: set.clone(),
                    facet,
                });
            }
        }
        Ok(())
    }
}

/// Demands that two meshes, or a mesh and a block, stand for the same.
pub(crate) fn check_symmetry(expected: Symmetry, actual: Symmetry) -> Result<(), MeshError> {
    if expected == actual {
        return Ok(());
    }
    Err(MeshError::Symmetry { expected, actual })
}

fn unknown_set<'a>(
    what: &'static str,
    set: &str,
    known: impl Iterator<Item = &'a String>,
) -> MeshError {
    let known: Vec<&str> = known.map(String::as_str).collect();
    MeshError::UnknownSet {
        what,
        set: set.to_owned(),
        known: known.join(", "),
    }
}
