//! The compliance of all contacts: `u = W r + q`.

use std::fmt::Debug;
use std::sync::Arc;

use faer::Mat;

use crate::error::ContactError;
use crate::local::Matrix;

/// `W` that is only known by what it does to a vector.
pub trait DelassusOperator: Debug + Send + Sync {
    /// Size of `r` and `u`: cone dimension times contacts.
    fn size(&self) -> usize;
    /// `out = W r`.
    fn apply(&self, r: &[f64], out: &mut [f64]);
    /// Diagonal block of contact `c`, `dim x dim` by rows.
    fn diagonal_block(&self, c: usize, dim: usize, out: &mut [f64]);
}

/// The Delassus matrix `W` [unit of `u` / unit of `r`], in the storage that suits the problem.
///
/// Slightly unsymmetric and rank-deficient matrices are welcome.
#[derive(Debug, Clone)]
pub enum Delassus {
    /// All entries.
    Dense(Mat<f64>),
    /// Blocks of pairs of contacts that share a body.
    BlockSparse(BlockSparse),
    /// Matrix-free.
    Operator(Arc<dyn DelassusOperator>),
}

/// A square matrix of `dim x dim` blocks in compressed rows; columns ascend in each row, the diagonal is always there, and
/// so is the mirror image of every block, if only as zeros.
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
    pub fn dim(&self) -> usize {
        self.dim
    }

    /// Number of contacts.
    pub fn contacts(&self) -> usize {
        self.offsets.len() - 1
    }

    /// Number of stored blocks.
    pub fn block_count(&self) -> usize {
        self.columns.len()
    }

    /// Columns of the blocks in row `c`.
    #[inline]
    pub fn row(&self, c: usize) -> &[u32] {
        &self.columns[self.offsets[c]..self.offsets[c + 1]]
    }

    /// Values of the blocks in row `c`, block after block, each by rows.
    #[inline]
    pub fn row_values(&self, c: usize) -> &[f64] {
        let size = self.dim * self.dim;
        &self.values[self.offsets[c] * size..self.offsets[c + 1] * size]
    }

    /// All entries, as a dense matrix.
    pub fn to_dense(&self) -> Mat<f64> {
        let (d, n) = (self.dim, self.contacts() * self.dim);
        let mut w = Mat::zeros(n, n);
        for c in 0..self.contacts() {
            for (&column, block) in self
                .row(c)
                .iter()
                .zip(self.row_values(c).chunks_exact(d * d))
            {
                for i in 0..d {
                    for j in 0..d {
                        w[(c * d + i, column as usize * d + j)] = block[i * d + j];
                    }
                }
            }
        }
        w
    }

    /// `u_c = sum_j W_cj r_j` for one contact.
    #[inline(always)]
    pub(crate) fn row_times<const D: usize>(&self, c: usize, r: &[f64]) -> [f64; D] {
        let mut u = [0.0; D];
        for (&column, block) in self
            .row(c)
            .iter()
            .zip(self.row_values(c).chunks_exact(D * D))
        {
            let x = &r[column as usize * D..column as usize * D + D];
            for i in 0..D {
                for j in 0..D {
                    u[i] += block[i * D + j] * x[j];
                }
            }
        }
        u
    }

    fn times<const D: usize>(&self, r: &[f64], out: &mut [f64]) {
        for (c, u) in out.chunks_exact_mut(D).enumerate() {
            u.copy_from_slice(&self.row_times::<D>(c, r));
        }
    }
}

/// Share of filled blocks from which the dense storage is faster.
const DENSE_SHARE: f64 = 0.4;

impl Delassus {
    /// From entries `(row, column, value)` of the flat matrix, summed where they meet; dense or block-sparse by fill.
    ///
    /// # Errors
    /// [`ContactError::Entry`] outside of the matrix.
    pub fn from_entries(
        contacts: usize,
        dim: usize,
        entries: &[(usize, usize, f64)],
    ) -> Result<Self, ContactError> {
        let w = BlockSparse::from_entries(contacts, dim, entries)?;
        let full = w.block_count() as f64 > DENSE_SHARE * (contacts * contacts) as f64;
        Ok(if full {
            Delassus::Dense(w.to_dense())
        } else {
            Delassus::BlockSparse(w)
        })
    }

    /// The storage that suits the fill: a dense matrix with few non-zero blocks becomes block-sparse.
    pub fn compressed(self, contacts: usize, dim: usize) -> Self {
        let Delassus::Dense(w) = &self else {
            return self;
        };
        let mut entries = Vec::new();
        for j in 0..w.ncols() {
            entries.extend(
                w.col_as_slice(j)
                    .iter()
                    .enumerate()
                    .filter(|(_, x)| **x != 0.0)
                    .map(|(i, &x)| (i, j, x)),
            );
        }
        Self::from_entries(contacts, dim, &entries).unwrap_or(self)
    }

    /// Size of `r` and `u`.
    pub fn size(&self) -> usize {
        match self {
            Delassus::Dense(w) => w.nrows(),
            Delassus::BlockSparse(w) => w.contacts() * w.dim(),
            Delassus::Operator(w) => w.size(),
        }
    }

    /// `out = W r`; both of length [`Self::size`].
    pub fn times(&self, r: &[f64], out: &mut [f64]) {
        match self {
            Delassus::Dense(w) => dense_times(w, r, out),
            Delassus::BlockSparse(w) => match w.dim() {
                1 => w.times::<1>(r, out),
                2 => w.times::<2>(r, out),
                _ => w.times::<3>(r, out),
            },
            Delassus::Operator(w) => w.apply(r, out),
        }
    }

    /// The diagonal block of contact `c`.
    pub fn diagonal<const D: usize>(&self, c: usize) -> Matrix<D> {
        let mut block = [[0.0; D]; D];
        match self {
            Delassus::Dense(w) => {
                for i in 0..D {
                    for j in 0..D {
                        block[i][j] = w[(c * D + i, c * D + j)];
                    }
                }
            }
            Delassus::BlockSparse(w) => {
                let found = w.row(c).binary_search(&(c as u32));
                if let Ok(k) = found {
                    let values = &w.row_values(c)[k * D * D..(k + 1) * D * D];
                    for i in 0..D {
                        block[i].copy_from_slice(&values[i * D..(i + 1) * D]);
                    }
                }
            }
            Delassus::Operator(w) => {
                let mut flat = [0.0; 9];
                w.diagonal_block(c, D, &mut flat[..D * D]);
                for i in 0..D {
                    block[i].copy_from_slice(&flat[i * D..(i + 1) * D]);
                }
            }
        }
        block
    }

    /// All entries. An operator is applied to every unit vector: `size` products.
    pub fn to_dense(&self) -> Mat<f64> {
        match self {
            Delassus::Dense(w) => w.clone(),
            Delassus::BlockSparse(w) => w.to_dense(),
            Delassus::Operator(w) => {
                let n = w.size();
                let (mut e, mut column, mut dense) = (vec![0.0; n], vec![0.0; n], Mat::zeros(n, n));
                for j in 0..n {
                    e[j] = 1.0;
                    w.apply(&e, &mut column);
                    e[j] = 0.0;
                    dense.col_as_slice_mut(j).copy_from_slice(&column);
                }
                dense
            }
        }
    }
}

/// `out = W r` by columns, four at a time; columns without reaction are skipped.
pub(crate) fn dense_times(w: &Mat<f64>, r: &[f64], out: &mut [f64]) {
    out.fill(0.0);
    let mut columns = r.iter().enumerate().filter(|(_, x)| **x != 0.0);
    loop {
        let mut taken = [(0usize, 0.0); 4];
        let mut count = 0;
        for slot in &mut taken {
            if let Some((j, &x)) = columns.next() {
                *slot = (j, x);
                count += 1;
            }
        }
        if count == 0 {
            return;
        }
        let [a, b, c, d] = taken.map(|(j, _)| w.col_as_slice(j));
        let x = taken.map(|(_, x)| x);
        for i in 0..out.len() {
            out[i] += a[i] * x[0] + b[i] * x[1] + c[i] * x[2] + d[i] * x[3];
        }
        if count < 4 {
            return;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[derive(Debug)]
    struct Hidden(Mat<f64>);
    impl DelassusOperator for Hidden {
        fn size(&self) -> usize {
            self.0.nrows()
        }
        fn apply(&self, r: &[f64], out: &mut [f64]) {
            dense_times(&self.0, r, out);
        }
        fn diagonal_block(&self, c: usize, dim: usize, out: &mut [f64]) {
            for i in 0..dim * dim {
                out[i] = self.0[(c * dim + i / dim, c * dim + i % dim)];
            }
        }
    }

    #[test]
    fn storages_agree() {
        let n = 12;
        let mut entries = Vec::new();
        for i in 0..n {
            for j in 0..n {
                if (i / 3 + j / 3) % 2 == 0 {
                    entries.push((i, j, (i * 7 + j * 3) as f64 * 0.1 - 2.0));
                }
            }
        }
        let sparse = BlockSparse::from_entries(4, 3, &entries).unwrap();
        assert_eq!(sparse.block_count(), 8);
        let dense = sparse.to_dense();
        let r: Vec<f64> = (0..n)
            .map(|i| if i % 5 == 0 { 0.0 } else { i as f64 - 4.0 })
            .collect();
        let all = [
            Delassus::Dense(dense.clone()),
            Delassus::BlockSparse(sparse),
            Delassus::Operator(Arc::new(Hidden(dense.clone()))),
        ];
        let expected: Vec<f64> = (0..n)
            .map(|i| (0..n).map(|j| dense[(i, j)] * r[j]).sum())
            .collect();
        for w in &all {
            let mut u = vec![f64::NAN; n];
            w.times(&r, &mut u);
            for i in 0..n {
                assert!((u[i] - expected[i]).abs() < 1e-12);
            }
            assert_eq!(w.diagonal::<3>(2), all[0].diagonal::<3>(2));
            assert_eq!(w.to_dense(), dense);
        }
    }

    #[test]
    fn blocks_are_summed_and_checked() {
        let blocks = vec![(1, 0, vec![1.0]), (0, 0, vec![2.0]), (1, 0, vec![0.5])];
        let w = BlockSparse::from_blocks(2, 1, &blocks).unwrap();
        assert_eq!(w.to_dense()[(1, 0)], 1.5);
        assert!(BlockSparse::from_blocks(2, 1, &[(2, 0, vec![1.0])]).is_err());
        assert!(BlockSparse::from_blocks(2, 2, &[(1, 0, vec![1.0])]).is_err());
        assert!(BlockSparse::from_entries(2, 1, &[(0, 2, 1.0)]).is_err());
    }
}
