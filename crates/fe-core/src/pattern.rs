//! The sparsity of the tangent, and the gather of element tangents into it.

use rayon::prelude::*;

use crate::adjacency::Adjacency;
use crate::block::tangent_index;
use crate::error::{FeError, check_length};
use crate::mass::MassMatrix;
use crate::parallel::{NONZEROS_PER_TASK, ROWS_PER_TASK, sequential};
use crate::solid::{ElementWorkspace, Solid};

/// Marks a degree of freedom that is not an unknown of the system, and a nonzero without mass.
const NONE: u32 = u32::MAX;

/// Graph of the nodes, without loops: offsets (`nodes + 1` long) and neighbours, sorted. Two nodes are
/// neighbours if an element has both.
#[must_use]
pub fn node_adjacency(solid: &Solid) -> (Vec<usize>, Vec<u32>) {
    let with_loops = solid.adjacency();
    let mut offsets = vec![0];
    let mut columns = Vec::with_capacity(with_loops.columns.len());
    for (node, pair) in with_loops.offsets.windows(2).enumerate() {
        let row = &with_loops.columns[pair[0]..pair[1]];
        columns.extend(row.iter().filter(|&&other| other as usize != node));
        offsets.push(columns.len());
    }
    (offsets, columns)
}

/// Lower triangle of a symmetric sparse matrix, by columns, in the numbers of the equations.
///
/// Built once for a numbering; then each assembly is a parallel sum over the nonzeros, in the order of the
/// elements.
#[derive(Debug, Clone)]
pub struct SymmetricPattern {
    column_pointers: Vec<usize>,
    row_indices: Vec<usize>,
    /// Where the sources of each nonzero start; one more entry than nonzeros.
    starts: Vec<u32>,
    /// Positions in the buffer of element tangents, those of a nonzero in the order of the elements.
    sources: Vec<u32>,
    /// Entry of the consistent mass matrix that belongs to a nonzero, or `NONE`.
    mass_entries: Vec<u32>,
    /// Node of each equation, or `NONE`.
    nodes: Vec<u32>,
}

/// Consecutive columns of the pattern; offsets are relative.
#[derive(Debug, Default)]
struct Columns {
    lengths: Vec<usize>,
    rows: Vec<usize>,
    source_counts: Vec<u32>,
    sources: Vec<u32>,
    mass_entries: Vec<u32>,
}

impl SymmetricPattern {
    /// The pattern for a numbering: `equation[dof]` is the equation of a degree of freedom, below `n`, or
    /// `u32::MAX` if it is not an unknown of this system.
    ///
    /// # Errors
    /// [`FeError::Length`] unless `equation` is `dof_count` long, [`FeError::Index`] for an equation that is
    /// not below `n` or given twice, [`FeError::TooLarge`] beyond 32-bit indices.
    pub fn new(solid: &Solid, equation: &[u32], n: usize) -> Result<SymmetricPattern, FeError> {
        check_length("equation numbers", solid.dof_count(), equation.len())?;
        let dofs = invert(equation, n)?;
        let adjacency = solid.adjacency();
        let builder = Builder {
            solid,
            equation,
            adjacency: &adjacency,
        };
        let chunks: Vec<Columns> = dofs
            .par_chunks(ROWS_PER_TASK)
            .enumerate()
            .map(|(task, dofs)| builder.columns(task * ROWS_PER_TASK, dofs))
            .collect();
        let node = |&dof: &u32| {
            if dof == NONE {
                NONE
            } else {
                dof / solid.dim() as u32
            }
        };
        SymmetricPattern::join(chunks, dofs.iter().map(node).collect())
    }

    /// Number of equations.
    pub fn dimension(&self) -> usize {
        self.nodes.len()
    }

    /// Start of each column, `n + 1` long.
    pub fn column_pointers(&self) -> &[usize] {
        &self.column_pointers
    }

    /// Row of each nonzero; sorted in each column, which starts with the diagonal.
    pub fn row_indices(&self) -> &[usize] {
        &self.row_indices
    }

    /// Number of nonzeros of the lower triangle.
    pub fn nonzeros(&self) -> usize {
        self.row_indices.len()
    }

    /// `values = scale K` [N/m times the unit of `scale`], from the tangents of the last
    /// [`Solid::tangent`] of the same solid. `values` is `nonzeros` long.
    pub fn gather_tangent(&self, work: &ElementWorkspace, scale: f64, values: &mut [f64]) {
        if work.tangents.is_empty() {
            values.fill(0.0);
            return;
        }
        let sum = |first: usize, part: &mut [f64]| {
            let starts = &self.starts[first..first + part.len() + 1];
            for (value, range) in part.iter_mut().zip(starts.windows(2)) {
                let sources = &self.sources[range[0] as usize..range[1] as usize];
                let sum = sources
                    .iter()
                    .map(|&s| work.tangents[s as usize])
                    .sum::<f64>();
                *value = scale * sum;
            }
        };
        self.in_parts(values, sum);
    }

    /// `values += scale M` [kg times the unit of `scale`], for a mass matrix of the same solid, consistent or
    /// diagonal. A diagonal matrix may come from elsewhere ([`MassMatrix::diagonal`]).
    pub fn add_mass(&self, mass: &MassMatrix, scale: f64, values: &mut [f64]) {
        let masses = mass.values();
        if mass.is_diagonal() {
            for (&start, &node) in self.column_pointers.iter().zip(&self.nodes) {
                if let Some(m) = masses.get(node as usize) {
                    values[start] += scale * m;
                }
            }
            return;
        }
        self.in_parts(values, |first, part| {
            for (value, &entry) in part.iter_mut().zip(&self.mass_entries[first..]) {
                if let Some(m) = masses.get(entry as usize) {
                    *value += scale * m;
                }
            }
        });
    }

    /// Runs `part(first, slice)` over slices of the values, in parallel if it pays.
    fn in_parts(&self, values: &mut [f64], part: impl Fn(usize, &mut [f64]) + Sync) {
        let values = &mut values[..self.row_indices.len()];
        if sequential(values.len(), NONZEROS_PER_TASK) {
            part(0, values);
        } else {
            let parts = values.par_chunks_mut(NONZEROS_PER_TASK).enumerate();
            parts.for_each(|(task, slice)| part(task * NONZEROS_PER_TASK, slice));
        }
    }

    fn join(chunks: Vec<Columns>, nodes: Vec<u32>) -> Result<SymmetricPattern, FeError> {
        let count: usize = chunks.iter().map(|chunk| chunk.sources.len()).sum();
        if count >= NONE as usize {
            return Err(FeError::TooLarge {
                what: "sources of the tangent",
                count,
            });
        }
        let mut pattern = SymmetricPattern {
            column_pointers: vec![0],
            row_indices: Vec::new(),
            starts: vec![0],
            sources: Vec::with_capacity(count),
            mass_entries: Vec::new(),
            nodes,
        };
        let (mut nonzeros, mut start) = (0, 0);
        for chunk in chunks {
            for length in chunk.lengths {
                nonzeros += length;
                pattern.column_pointers.push(nonzeros);
            }
            for count in chunk.source_counts {
                start += count;
                pattern.starts.push(start);
            }
            pattern.row_indices.extend(chunk.rows);
            pattern.sources.extend(chunk.sources);
            pattern.mass_entries.extend(chunk.mass_entries);
        }
        Ok(pattern)
    }
}

/// What is needed to find the nonzeros of a column.
#[derive(Debug, Clone, Copy)]
struct Builder<'a> {
    solid: &'a Solid,
    equation: &'a [u32],
    adjacency: &'a Adjacency,
}

impl Builder<'_> {
    fn columns(&self, first: usize, dofs: &[u32]) -> Columns {
        let mut columns = Columns::default();
        let mut found: Vec<(u32, u32)> = Vec::new();
        for (column, &dof) in (first..).zip(dofs) {
            let before = columns.rows.len();
            found.clear();
            if dof != NONE {
                self.sources(column as u32, dof as usize, &mut found);
            }
            if found.is_empty() {
                // Factorisations want a diagonal even where nothing acts.
                columns.rows.push(column);
                columns.source_counts.push(0);
            }
            found.sort_unstable();
            for same_row in found.chunk_by(|a, b| a.0 == b.0) {
                columns.rows.push(same_row[0].0 as usize);
                columns.source_counts.push(same_row.len() as u32);
                columns
                    .sources
                    .extend(same_row.iter().map(|(_, source)| source));
            }
            columns.lengths.push(columns.rows.len() - before);
            columns.mass_entries.resize(columns.rows.len(), NONE);
            if dof != NONE {
                let (rows, entries) = (&columns.rows, &mut columns.mass_entries);
                self.masses(dof as usize, &rows[before..], &mut entries[before..]);
            }
        }
        columns
    }

    /// Rows at and below the diagonal, with the places in the element tangents that add to them.
    fn sources(&self, column: u32, dof: usize, found: &mut Vec<(u32, u32)>) {
        let dim = self.solid.dim();
        let (node, k) = (dof / dim, dof % dim);
        for &slot in self.solid.slots_of(node) {
            let place = self.solid.locate_slot(slot as usize);
            for (a, &other) in place.cell.iter().enumerate() {
                for i in 0..dim {
                    let row = self.equation[dim * other as usize + i];
                    if row != NONE && row >= column {
                        let nodes = place.cell.len();
                        let index = tangent_index(dim, nodes, (a, i), (place.local, k));
                        found.push((row, (place.tangent + index) as u32));
                    }
                }
            }
        }
    }

    /// Entries of the consistent mass matrix for the rows that are the same component of a neighbour.
    fn masses(&self, dof: usize, rows: &[usize], entries: &mut [u32]) {
        let dim = self.solid.dim();
        let (node, k) = (dof / dim, dof % dim);
        for z in self.adjacency.offsets[node]..self.adjacency.offsets[node + 1] {
            let row = self.equation[dim * self.adjacency.columns[z] as usize + k];
            // Rows above the diagonal, and dofs that are no unknowns, are not found.
            if let Ok(place) = rows.binary_search(&(row as usize)) {
                entries[place] = z as u32;
            }
        }
    }
}

/// Degree of freedom of each equation, or `NONE`.
fn invert(equation: &[u32], n: usize) -> Result<Vec<u32>, FeError> {
    let mut dofs = vec![NONE; n];
    for (dof, &number) in equation.iter().enumerate() {
        if number == NONE {
            continue;
        }
        match dofs.get_mut(number as usize) {
            Some(free) if *free == NONE => *free = dof as u32,
            _ => {
                return Err(FeError::Index {
                    what: "free equation",
                    index: number as usize,
                    count: n,
                });
            }
        }
    }
    Ok(dofs)
}
