//! The Delassus matrix as blocks of pairs of contacts.

use faer::Mat;

use super::DenseMatrix;
use crate::error::ContactError;
use crate::local::Vector;

/// A square matrix of `dim x dim` blocks in compressed rows; columns ascend in each row, the diagonal is always there,
/// and so is the mirror image of every block, if only as zeros.
#[derive(Debug, Clone, PartialEq)]
pub struct BlockSparse {
    dim: usize,
    offsets: Vec<usize>,
    columns: Vec<u32>,
    values: Vec<f64>,
}

impl BlockSparse {
    /// From blocks `(row, column, values by rows)` in any order; blocks at the same place are summed.
    ///
    /// ```
    /// use contact_bipotential::BlockSparse;
    ///
    /// // Two frictionless contacts that share a body.
    /// let blocks = [(0, 0, vec![2.0]), (1, 1, vec![3.0]), (0, 1, vec![0.5]), (1, 0, vec![0.5])];
    /// let w = BlockSparse::from_blocks(2, 1, &blocks)?;
    /// assert_eq!(w.to_dense()[(1, 0)], 0.5);
    /// # Ok::<(), contact_bipotential::ContactError>(())
    /// ```
    ///
    /// # Errors
    /// [`ContactError::Block`] outside of `contacts`, [`ContactError::Length`] for a block without `dim * dim` values.
    pub fn from_blocks(
        contacts: usize,
        dim: usize,
        blocks: &[(usize, usize, Vec<f64>)],
    ) -> Result<Self, ContactError> {
        let zero = vec![0.0; dim * dim];
        let mut order: Vec<(usize, usize, &[f64])> =
            (0..contacts).map(|c| (c, c, zero.as_slice())).collect();
        for (row, column, values) in blocks {
            order.push((*column, *row, &zero));
            if *row >= contacts || *column >= contacts {
                return Err(ContactError::Block {
                    row: *row,
                    column: *column,
                    contacts,
                });
            }
            if values.len() != dim * dim {
                let (found, expected) = (values.len(), dim * dim);
                return Err(ContactError::Length {
                    what: "block of W",
                    contacts,
                    found,
                    expected,
                });
            }
            order.push((*row, *column, values));
        }
        order.sort_by_key(|b| (b.0, b.1));
        Ok(Self::from_sorted(contacts, dim, &order))
    }

    fn from_sorted(contacts: usize, dim: usize, blocks: &[(usize, usize, &[f64])]) -> Self {
        let mut w = BlockSparse {
            dim,
            offsets: vec![0],
            columns: Vec::new(),
            values: Vec::new(),
        };
        let mut last = None;
        for (row, column, values) in blocks {
            if last == Some((*row, *column)) {
                let start = w.values.len() - dim * dim;
                for (sum, x) in w.values[start..].iter_mut().zip(*values) {
                    *sum += x;
                }
                continue;
            }
            while w.offsets.len() <= *row {
                w.offsets.push(w.columns.len());
            }
            w.columns.push(*column as u32);
            w.values.extend_from_slice(values);
            last = Some((*row, *column));
        }
        while w.offsets.len() <= contacts {
            w.offsets.push(w.columns.len());
        }
        w
    }

    /// From entries `(row, column, value)` of the flat matrix; entries at the same place are summed.
    ///
    /// # Errors
    /// [`ContactError::Entry`] outside of the matrix.
    pub fn from_entries(
        contacts: usize,
        dim: usize,
        entries: &[(usize, usize, f64)],
    ) -> Result<Self, ContactError> {
        let size = contacts * dim;
        if let Some(&(row, column, _)) = entries.iter().find(|e| e.0 >= size || e.1 >= size) {
            return Err(ContactError::Entry {
                what: "W",
                row,
                column,
                rows: size,
                columns: size,
            });
        }
        let mut places: Vec<(usize, usize)> = Vec::with_capacity(2 * entries.len());
        places.extend(entries.iter().map(|e| (e.0 / dim, e.1 / dim)));
        places.extend(entries.iter().map(|e| (e.1 / dim, e.0 / dim)));
        places.extend((0..contacts).map(|c| (c, c)));
        places.sort_unstable();
        places.dedup();
        let zero = vec![0.0; dim * dim];
        let blocks: Vec<_> = places
            .iter()
            .map(|&(r, c)| (r, c, zero.as_slice()))
            .collect();
        let mut w = Self::from_sorted(contacts, dim, &blocks);
        for &(row, column, value) in entries {
            if let Ok(k) = places.binary_search(&(row / dim, column / dim)) {
                w.values[k * dim * dim + (row % dim) * dim + column % dim] += value;
            }
        }
        Ok(w)
    }

    /// Entries a contact.
    #[must_use]
    pub fn dim(&self) -> usize {
        self.dim
    }

    /// Number of contacts.
    #[must_use]
    pub fn contacts(&self) -> usize {
        self.offsets.len() - 1
    }

    /// Number of stored blocks.
    pub(crate) fn block_count(&self) -> usize {
        self.columns.len()
    }

    /// Columns of the blocks in row `c`.
    #[inline]
    pub(crate) fn row(&self, c: usize) -> &[u32] {
        &self.columns[self.offsets[c]..self.offsets[c + 1]]
    }

    /// Values of the blocks in row `c`, block after block, each by rows.
    #[inline]
    pub(crate) fn row_values(&self, c: usize) -> &[f64] {
        let size = self.dim * self.dim;
        &self.values[self.offsets[c] * size..self.offsets[c + 1] * size]
    }

    /// Column and values by rows of every block in row `c`.
    #[inline(always)]
    pub(crate) fn blocks(&self, c: usize) -> impl Iterator<Item = (usize, &[f64])> {
        let columns = self.row(c).iter().map(|&column| column as usize);
        columns.zip(self.row_values(c).chunks_exact(self.dim * self.dim))
    }

    /// All entries, as a dense matrix.
    #[must_use]
    pub fn to_dense(&self) -> DenseMatrix {
        let (d, n) = (self.dim, self.contacts() * self.dim);
        let mut w = Mat::zeros(n, n);
        for c in 0..self.contacts() {
            for (column, block) in self.blocks(c) {
                for i in 0..d {
                    for j in 0..d {
                        w[(c * d + i, column * d + j)] = block[i * d + j];
                    }
                }
            }
        }
        w
    }

    /// `u_c = sum_j W_cj r_j` for one contact.
    #[inline(always)]
    pub(crate) fn row_times<const D: usize>(&self, c: usize, r: &[f64]) -> Vector<D> {
        let mut u = [0.0; D];
        for (column, block) in self.blocks(c) {
            let x = &r[column * D..column * D + D];
            for i in 0..D {
                for j in 0..D {
                    u[i] += block[i * D + j] * x[j];
                }
            }
        }
        Vector::from(u)
    }

    pub(crate) fn times<const D: usize>(&self, r: &[f64], out: &mut [f64]) {
        for (c, u) in out.chunks_exact_mut(D).enumerate() {
            u.copy_from_slice(self.row_times::<D>(c, r).as_slice());
        }
    }
}
