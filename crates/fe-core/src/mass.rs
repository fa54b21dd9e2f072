//! Mass matrices.

use crate::adjacency::Adjacency;
use crate::block::Block;
use crate::parallel::for_each_row;

/// A symmetric mass matrix \[kg; kg/m in plane strain\]: one number for each pair of nodes, the same for each
/// component.
///
/// Stored by rows, both triangles, columns sorted.
#[derive(Debug, Clone, PartialEq)]
pub struct MassMatrix {
    dim: usize,
    offsets: Vec<usize>,
    columns: Vec<u32>,
    values: Vec<f64>,
}

impl MassMatrix {
    /// The matrix that belongs to the shape functions of the blocks' elements.
    pub(crate) fn consistent(
        dim: usize,
        adjacency: Adjacency,
        blocks: &[Box<dyn Block>],
    ) -> MassMatrix {
        let Adjacency { offsets, columns } = adjacency;
        let mut values = vec![0.0; columns.len()];
        for_each_element(blocks, |_, cell, mass| {
            for (&a, row) in cell.iter().zip(mass.chunks_exact(cell.len())) {
                let range = offsets[a as usize]..offsets[a as usize + 1];
                let neighbours = &columns[range.clone()];
                for (&b, m) in cell.iter().zip(row) {
                    values[range.start + neighbours.partition_point(|&c| c < b)] += m;
                }
            }
        });
        MassMatrix {
            dim,
            offsets,
            columns,
            values,
        }
    }

    /// Diagonal matrix. Elements of degree 1 give each node its row sum. Row sums of quadratic triangles and
    /// tetrahedra are zero or negative at corners: elements of degree 2 share their mass in the proportions of their
    /// diagonal instead, which is the same for rectangles and boxes.
    pub(crate) fn lumped(dim: usize, nodes: usize, blocks: &[Box<dyn Block>]) -> MassMatrix {
        let mut masses = vec![0.0; nodes];
        for_each_element(blocks, |block, cell, mass| {
            let rows = mass.chunks_exact(cell.len());
            let diagonal = rows.clone().enumerate().map(|(a, row)| row[a]);
            let total: f64 = mass.iter().sum();
            let scale = total / diagonal.clone().sum::<f64>();
            for ((&node, row), on_diagonal) in cell.iter().zip(rows).zip(diagonal) {
                masses[node as usize] += match block.degree() {
                    1 => row.iter().sum::<f64>(),
                    _ => scale * on_diagonal,
                };
            }
        });
        MassMatrix::diagonal(dim, masses)
    }

    /// Diagonal matrix from the mass of each node \[kg\].
    #[must_use]
    pub fn diagonal(dim: usize, node_masses: Vec<f64>) -> MassMatrix {
        let nodes = node_masses.len();
        MassMatrix {
            dim,
            offsets: (0..=nodes).collect(),
            columns: (0..nodes as u32).collect(),
            values: node_masses,
        }
    }

    /// Unknowns per node.
    pub fn dim(&self) -> usize {
        self.dim
    }

    /// Number of nodes.
    pub fn node_count(&self) -> usize {
        self.offsets.len() - 1
    }

    /// True if masses stand on the diagonal only.
    pub fn is_diagonal(&self) -> bool {
        let mut rows = self.columns.iter().enumerate();
        self.columns.len() == self.node_count() && rows.all(|(a, &b)| a == b as usize)
    }

    /// Row offsets, `nodes + 1` long.
    pub fn offsets(&self) -> &[usize] {
        &self.offsets
    }

    /// Column (node) of each entry.
    pub fn columns(&self) -> &[u32] {
        &self.columns
    }

    /// Value of each entry \[kg\].
    pub fn values(&self) -> &[f64] {
        &self.values
    }

    /// `out = M v`; both flat, `dim * node + component`.
    pub fn times(&self, v: &[f64], out: &mut [f64]) {
        match self.dim {
            2 => self.times_dim::<2>(v, out),
            _ => self.times_dim::<3>(v, out),
        }
    }

    /// `v . M v`: twice the kinetic energy \[J\] of the velocity `v` \[m/s\].
    #[must_use]
    pub fn quadratic(&self, v: &[f64]) -> f64 {
        let mut product = vec![0.0; v.len()];
        self.times(v, &mut product);
        v.iter().zip(&product).map(|(v, p)| v * p).sum()
    }

    /// Total mass \[kg\].
    #[must_use]
    pub fn total(&self) -> f64 {
        self.row_sums().iter().sum()
    }

    /// Mass that belongs to each node \[kg\]: the row sums.
    #[must_use]
    pub fn row_sums(&self) -> Vec<f64> {
        let row = |pair: &[usize]| self.values[pair[0]..pair[1]].iter().sum();
        self.offsets.windows(2).map(row).collect()
    }

    fn times_dim<const D: usize>(&self, v: &[f64], out: &mut [f64]) {
        for_each_row(out, D, |a, out| {
            let mut sum = [0.0; D];
            for z in self.offsets[a]..self.offsets[a + 1] {
                let start = D * self.columns[z] as usize;
                let v = &v[start..start + D];
                (0..D).for_each(|i| sum[i] = self.values[z].mul_add(v[i], sum[i]));
            }
            out.copy_from_slice(&sum);
        });
    }
}

/// Calls `add(block, cell, mass)` for the consistent mass of each element, in order.
fn for_each_element(blocks: &[Box<dyn Block>], mut add: impl FnMut(&dyn Block, &[u32], &[f64])) {
    for block in blocks {
        let nodes = block.nodes_per_element();
        let mut masses = vec![0.0; block.element_count() * nodes * nodes];
        block.mass(&mut masses);
        let cells = block.connectivity().chunks_exact(nodes);
        for (cell, mass) in cells.zip(masses.chunks_exact(nodes * nodes)) {
            add(block.as_ref(), cell, mass);
        }
    }
}
