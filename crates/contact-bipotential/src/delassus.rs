//! The compliance of all contacts: `u = W r + q`.

mod block_sparse;

use std::fmt::Debug;
use std::sync::Arc;

use faer::Mat;

use crate::error::ContactError;
use crate::local::{Matrix, load_block};

pub use block_sparse::BlockSparse;

/// A dense matrix, stored by columns.
pub type DenseMatrix = Mat<f64>;

/// `W` that is only known by what it does to a vector.
///
/// ```
/// use std::sync::Arc;
///
/// use contact_bipotential::{Cone, ContactProblem, Delassus, DelassusOperator, SolveSettings, solve};
///
/// /// Contacts on springs of their own, compliance 2.
/// #[derive(Debug)]
/// struct Springs(usize);
///
/// impl DelassusOperator for Springs {
///     fn size(&self) -> usize {
///         self.0
///     }
///     fn apply(&self, r: &[f64], out: &mut [f64]) {
///         out.iter_mut().zip(r).for_each(|(u, r)| *u = 2.0 * r);
///     }
///     fn diagonal_block(&self, _contact: usize, _dim: usize, out: &mut [f64]) {
///         out[0] = 2.0;
///     }
/// }
///
/// let w = Delassus::Operator(Arc::new(Springs(2)));
/// let problem = ContactProblem::new(w, vec![-1.0, 1.0], vec![0.0; 2], Cone::Frictionless)?;
/// let mut r = Vec::new();
/// assert!(solve(&problem, &mut r, &SolveSettings::default()).is_converged());
/// assert!((r[0] - 0.5).abs() < 1e-9 && r[1].abs() < 1e-9);
/// # Ok::<(), contact_bipotential::ContactError>(())
/// ```
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
#[non_exhaustive]
pub enum Delassus {
    /// All entries.
    Dense(DenseMatrix),
    /// Blocks of pairs of contacts that share a body.
    BlockSparse(BlockSparse),
    /// Matrix-free.
    Operator(Arc<dyn DelassusOperator>),
}

/// Share of filled blocks from which the dense storage is faster \[-\]: its products run through whole columns.
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
    #[must_use]
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
    #[must_use]
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

    /// The diagonal block of contact `c`; `D` is [`Cone::dim`](crate::Cone::dim).
    #[must_use]
    pub fn diagonal<const D: usize>(&self, c: usize) -> Matrix<D> {
        match self {
            Delassus::Dense(w) => Matrix::from_fn(|i, j| w[(c * D + i, c * D + j)]),
            Delassus::BlockSparse(w) => {
                let found = w.row(c).binary_search(&(c as u32));
                found.map_or(Matrix::zeros(), |k| {
                    load_block(&w.row_values(c)[k * D * D..])
                })
            }
            Delassus::Operator(w) => {
                let mut flat = [0.0; 9];
                w.diagonal_block(c, D, &mut flat[..D * D]);
                load_block(&flat)
            }
        }
    }

    /// All entries. An operator is applied to every unit vector: `size` products.
    #[must_use]
    pub fn to_dense(&self) -> DenseMatrix {
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
