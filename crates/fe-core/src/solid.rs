//! Solids: mesh, blocks, and the ordered gather of what elements compute.

use crate::adjacency::Adjacency;
use crate::block::{Block, tangent_index, tangent_len};
use crate::error::{FeError, check_length};
use crate::mass::MassMatrix;
use crate::mesh::{Mesh, MeshError, ValidMesh, check_symmetry};
use crate::parallel::for_each_row;

/// Deformable bodies: a mesh, its blocks, and the maps from elements to nodes. Immutable.
#[derive(Debug)]
pub struct Solid {
    mesh: ValidMesh,
    blocks: Vec<Box<dyn Block>>,
    ranges: Vec<BlockRange>,
    slots: NodeSlots,
    bodies: Vec<Vec<u32>>,
}

/// Where a block's entries start in the buffers of all elements.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct BlockRange {
    pub(crate) elements: usize,
    pub(crate) slots: usize,
    pub(crate) tangents: usize,
}

/// For each node, the places ("slots": one for each node of each element, in order) where elements store what
/// belongs to it.
#[derive(Debug, Clone, Default)]
struct NodeSlots {
    offsets: Vec<u32>,
    slots: Vec<u32>,
}

/// Buffers of the elements. Scratch: it holds no truth between calls, except that the tangents of the last
/// successful [`Solid::tangent`] stay.
#[derive(Debug, Clone, Default)]
pub struct ElementWorkspace {
    pub(crate) forces: Vec<f64>,
    pub(crate) energies: Vec<f64>,
    pub(crate) tangents: Vec<f64>,
}

impl ElementWorkspace {
    /// Strain energy of each element \[J\], blocks one after the other, of the last call.
    pub fn energies(&self) -> &[f64] {
        &self.energies
    }
}

impl Solid {
    /// Checks that mesh and blocks go together, and computes the gather maps.
    ///
    /// # Errors
    /// [`FeError::Mesh`] for a block of another symmetry than the mesh, or a node without block,
    /// [`FeError::Index`] if a block refers to a node that does not exist,
    /// [`FeError::TooLarge`] beyond 32-bit indices.
    pub fn new(mesh: ValidMesh, blocks: Vec<Box<dyn Block>>) -> Result<Solid, FeError> {
        let nodes = mesh.points.len();
        for block in &blocks {
            check_symmetry(mesh.symmetry, block.symmetry())?;
            if let Some(&node) = block.connectivity().iter().find(|&&n| n as usize >= nodes) {
                return Err(FeError::Index {
                    what: "node",
                    index: node as usize,
                    count: nodes,
                });
            }
        }
        let ranges = block_ranges(&blocks)?;
        let slots = NodeSlots::new(&blocks, nodes);
        if let Some(node) = (0..nodes).find(|&node| slots.of(node).is_empty()) {
            return Err(FeError::Mesh(MeshError::OrphanNode { node }));
        }
        let bodies = connected_components(&blocks, nodes);
        Ok(Solid {
            mesh,
            blocks,
            ranges,
            slots,
            bodies,
        })
    }

    /// The mesh in its reference configuration.
    pub fn mesh(&self) -> &Mesh {
        &self.mesh
    }

    /// Unknowns per node, 2 or 3.
    pub fn dim(&self) -> usize {
        self.mesh.dim
    }

    /// Number of nodes.
    pub fn node_count(&self) -> usize {
        self.mesh.points.len()
    }

    /// Number of unknowns: `dim * nodes`.
    pub fn dof_count(&self) -> usize {
        self.dim() * self.node_count()
    }

    /// Number of elements of all blocks.
    pub fn element_count(&self) -> usize {
        self.blocks.iter().map(|block| block.element_count()).sum()
    }

    /// The blocks.
    pub fn blocks(&self) -> &[Box<dyn Block>] {
        &self.blocks
    }

    /// Nodes of each connected body, sorted; bodies in the order of their first node.
    pub fn bodies(&self) -> &[Vec<u32>] {
        &self.bodies
    }

    /// Buffers for this solid; those of the tangents are allocated when they are first needed.
    #[must_use]
    pub fn workspace(&self) -> ElementWorkspace {
        ElementWorkspace {
            forces: vec![0.0; self.dim() * self.slots.slots.len()],
            energies: vec![0.0; self.element_count()],
            tangents: Vec::new(),
        }
    }

    /// Internal force `f` \[N\] for the displacement `u` \[m\]; returns the strain energy \[J\].
    ///
    /// # Errors
    /// [`FeError::Inverted`] for the first element that is turned inside out, [`FeError::Length`] for arrays
    /// that are not `dof_count` long. `f` then has no meaning.
    pub fn internal_force(
        &self,
        u: &[f64],
        work: &mut ElementWorkspace,
        f: &mut [f64],
    ) -> Result<f64, FeError> {
        self.check_arrays(u, work, f)?;
        let (mut forces, mut energies) = (&mut work.forces[..], &mut work.energies[..]);
        for block in &self.blocks {
            let elements = block.element_count();
            let force = take(
                &mut forces,
                elements * block.nodes_per_element() * self.dim(),
            );
            let energy = take(&mut energies, elements);
            block.internal_force(u, force, energy)?;
        }
        self.gather_forces(&work.forces, f);
        Ok(work.energies.iter().sum())
    }

    /// As [`Solid::internal_force`], and keeps the tangent of each element in `work`, for
    /// [`Solid::tangent_times`] and [`crate::SymmetricPattern::gather_tangent`].
    ///
    /// # Errors
    /// As [`Solid::internal_force`]. The tangents in `work` then have no meaning.
    pub fn tangent(
        &self,
        u: &[f64],
        work: &mut ElementWorkspace,
        f: &mut [f64],
    ) -> Result<f64, FeError> {
        self.check_arrays(u, work, f)?;
        work.tangents.resize(self.tangent_entries(), 0.0);
        let (mut forces, mut energies) = (&mut work.forces[..], &mut work.energies[..]);
        let mut tangents = &mut work.tangents[..];
        for block in &self.blocks {
            let (elements, nodes) = (block.element_count(), block.nodes_per_element());
            let force = take(&mut forces, elements * nodes * self.dim());
            let energy = take(&mut energies, elements);
            let tangent = take(&mut tangents, elements * tangent_len(self.dim(), nodes));
            block.tangent(u, force, energy, tangent)?;
        }
        self.gather_forces(&work.forces, f);
        Ok(work.energies.iter().sum())
    }

    /// `y = K x` \[N\] from the tangents of the last [`Solid::tangent`]; `x` and `y` are `dof_count` long, `x` in
    /// \[m\]. Before any tangent was computed `K` is zero.
    pub fn tangent_times(&self, work: &ElementWorkspace, x: &[f64], y: &mut [f64]) {
        let dim = self.dim();
        let mut products = vec![0.0; work.forces.len()];
        if !work.tangents.is_empty() {
            for (block, range) in self.blocks.iter().zip(&self.ranges) {
                let (nodes, cells) = (block.nodes_per_element(), block.connectivity());
                let end = range.slots + cells.len();
                let len = tangent_len(dim, nodes);
                let out = &mut products[dim * range.slots..dim * end];
                for_each_row(out, dim * nodes, |element, product| {
                    let start = range.tangents + element * len;
                    let cell = &cells[element * nodes..(element + 1) * nodes];
                    element_times(dim, cell, &work.tangents[start..start + len], x, product);
                });
            }
        }
        self.gather_forces(&products, y);
    }

    /// Mass matrix that belongs to the shape functions \[kg\].
    #[must_use]
    pub fn consistent_mass(&self) -> MassMatrix {
        MassMatrix::consistent(self.dim(), self.adjacency(), &self.blocks)
    }

    /// Diagonal mass matrix \[kg\], positive: the row sums of the consistent one; elements of degree 2 share their mass
    /// in the proportions of its diagonal.
    #[must_use]
    pub fn lumped_mass(&self) -> MassMatrix {
        MassMatrix::lumped(self.dim(), self.node_count(), &self.blocks)
    }

    /// Neighbours of each node through elements.
    pub(crate) fn adjacency(&self) -> Adjacency {
        Adjacency::new(self.node_count(), |node, row| {
            for &slot in self.slots_of(node) {
                row.extend(self.locate_slot(slot as usize).cell);
            }
        })
    }

    /// Entries of all element tangents.
    pub(crate) fn tangent_entries(&self) -> usize {
        let entries = |block: &dyn Block| {
            block.element_count() * tangent_len(self.dim(), block.nodes_per_element())
        };
        self.blocks
            .iter()
            .map(|block| entries(block.as_ref()))
            .sum()
    }

    /// Slots of a node, increasing.
    pub(crate) fn slots_of(&self, node: usize) -> &[u32] {
        self.slots.of(node)
    }

    /// Element that a slot belongs to.
    pub(crate) fn locate_slot(&self, slot: usize) -> SlotLocation<'_> {
        let index = self.ranges.partition_point(|range| range.slots <= slot) - 1;
        let (block, range) = (&self.blocks[index], &self.ranges[index]);
        let nodes = block.nodes_per_element();
        let (element, local) = ((slot - range.slots) / nodes, (slot - range.slots) % nodes);
        SlotLocation {
            cell: &block.connectivity()[element * nodes..(element + 1) * nodes],
            local,
            tangent: range.tangents + element * tangent_len(self.dim(), nodes),
        }
    }

    fn check_arrays(&self, u: &[f64], work: &ElementWorkspace, f: &[f64]) -> Result<(), FeError> {
        check_length("displacement", self.dof_count(), u.len())?;
        check_length("force", self.dof_count(), f.len())?;
        let expected = self.dim() * self.slots.slots.len();
        check_length("element workspace", expected, work.forces.len())
    }

    /// Sums what elements stored for each node, in the order of the elements.
    fn gather_forces(&self, stored: &[f64], f: &mut [f64]) {
        match self.dim() {
            2 => gather::<2>(&self.slots, stored, f),
            _ => gather::<3>(&self.slots, stored, f),
        }
    }
}

/// Where a slot is: its element's nodes, its local number, and the start of the element's tangent.
#[derive(Debug, Clone, Copy)]
pub(crate) struct SlotLocation<'a> {
    pub(crate) cell: &'a [u32],
    pub(crate) local: usize,
    pub(crate) tangent: usize,
}

fn gather<const D: usize>(slots: &NodeSlots, stored: &[f64], f: &mut [f64]) {
    for_each_row(f, D, |node, f| {
        let mut sum = [0.0; D];
        for &slot in slots.of(node) {
            let start = D * slot as usize;
            let values = &stored[start..start + D];
            (0..D).for_each(|i| sum[i] += values[i]);
        }
        f.copy_from_slice(&sum);
    });
}

/// Cuts the first `count` entries off a slice.
fn take<'a>(rest: &mut &'a mut [f64], count: usize) -> &'a mut [f64] {
    let (head, tail) = std::mem::take(rest).split_at_mut(count);
    *rest = tail;
    head
}

/// `K_e x` of one element.
fn element_times(dim: usize, cell: &[u32], tangent: &[f64], x: &[f64], product: &mut [f64]) {
    let nodes = cell.len();
    product.fill(0.0);
    for i in 0..dim {
        for k in i..dim {
            let start = tangent_index(dim, nodes, (0, i), (0, k));
            let block = &tangent[start..start + nodes * nodes];
            for (a, row) in block.chunks_exact(nodes).enumerate() {
                let x_a = x[dim * cell[a] as usize + i];
                let mut sum = 0.0;
                for (b, &entry) in row.iter().enumerate() {
                    sum += entry * x[dim * cell[b] as usize + k];
                    if i != k {
                        product[dim * b + k] += entry * x_a;
                    }
                }
                product[dim * a + i] += sum;
            }
        }
    }
}

fn block_ranges(blocks: &[Box<dyn Block>]) -> Result<Vec<BlockRange>, FeError> {
    let mut next = BlockRange {
        elements: 0,
        slots: 0,
        tangents: 0,
    };
    let mut ranges = Vec::new();
    for block in blocks {
        ranges.push(next);
        let (elements, nodes) = (block.element_count(), block.nodes_per_element());
        check_length("connectivity", elements * nodes, block.connectivity().len())?;
        next.elements += elements;
        next.slots += elements * nodes;
        next.tangents += elements * tangent_len(block.dim(), nodes);
    }
    let limit = u32::MAX as usize;
    if next.tangents >= limit {
        return Err(FeError::TooLarge {
            what: "element tangents",
            count: next.tangents,
        });
    }
    Ok(ranges)
}

impl NodeSlots {
    fn new(blocks: &[Box<dyn Block>], nodes: usize) -> NodeSlots {
        let all = || blocks.iter().flat_map(|block| block.connectivity());
        let mut offsets = vec![0_u32; nodes + 1];
        all().for_each(|&node| offsets[node as usize + 1] += 1);
        for node in 0..nodes {
            offsets[node + 1] += offsets[node];
        }
        let mut next = offsets.clone();
        let mut slots = vec![0; offsets[nodes] as usize];
        for (slot, &node) in all().enumerate() {
            let place = &mut next[node as usize];
            slots[*place as usize] = slot as u32;
            *place += 1;
        }
        NodeSlots { offsets, slots }
    }

    fn of(&self, node: usize) -> &[u32] {
        &self.slots[self.offsets[node] as usize..self.offsets[node + 1] as usize]
    }
}

/// Nodes that are connected by elements, each list sorted, in the order of their first nodes.
fn connected_components(blocks: &[Box<dyn Block>], nodes: usize) -> Vec<Vec<u32>> {
    let mut parent: Vec<u32> = (0..nodes as u32).collect();
    for block in blocks {
        for cell in block.connectivity().chunks_exact(block.nodes_per_element()) {
            for pair in cell.windows(2) {
                let (a, b) = (root(&mut parent, pair[0]), root(&mut parent, pair[1]));
                parent[a.max(b) as usize] = a.min(b);
            }
        }
    }
    let mut bodies: Vec<Vec<u32>> = Vec::new();
    let mut body_of = vec![0; nodes];
    for node in 0..nodes as u32 {
        // The root is the lowest node of its body, so its body exists when the others come.
        let lowest = root(&mut parent, node);
        if lowest == node {
            body_of[node as usize] = bodies.len();
            bodies.push(Vec::new());
        }
        bodies[body_of[lowest as usize]].push(node);
    }
    bodies
}

fn root(parent: &mut [u32], mut node: u32) -> u32 {
    while parent[node as usize] != node {
        let above = parent[parent[node as usize] as usize];
        parent[node as usize] = above;
        node = above;
    }
    node
}
