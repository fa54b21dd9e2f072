//! The global form of a contact problem, reduced to the local one.

use faer::Mat;
use faer::linalg::solvers::Solve;
use faer::sparse::{SparseColMat, Triplet};

use crate::cone::Cone;
use crate::delassus::Delassus;
use crate::error::ContactError;
use crate::problem::ContactProblem;

/// Numbers of `M^-1 H` that are held at a time: 32 MiB of them.
const BATCH: usize = 1 << 22;

/// A sparse matrix as a list of entries; entries at the same place are summed.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct SparseEntries {
    /// Number of rows.
    pub rows: usize,
    /// Number of columns.
    pub columns: usize,
    /// `(row, column, value)`.
    pub entries: Vec<(usize, usize, f64)>,
}

impl SparseEntries {
    /// A matrix of `rows` times `columns`; whether the entries `(row, column, value)` lie in it is checked where it is
    /// used.
    #[must_use]
    pub fn new(rows: usize, columns: usize, entries: Vec<(usize, usize, f64)>) -> Self {
        SparseEntries {
            rows,
            columns,
            entries,
        }
    }
}

/// `M v = H r + f`, `u = H^T v + w`: bodies and contacts together.
///
/// ```
/// use contact_bipotential::{Cone, GlobalProblem, SparseEntries};
///
/// // A mass of 2 that a load of 1 drives into an obstacle, whose reaction pushes it back.
/// let m = SparseEntries::new(1, 1, vec![(0, 0, 2.0)]);
/// let h = SparseEntries::new(1, 1, vec![(0, 0, 1.0)]);
/// let global = GlobalProblem::new(m, h, vec![-1.0], vec![0.0], vec![0.0], Cone::Frictionless);
/// let local = global.reduce()?;
/// assert_eq!((local.w.to_dense()[(0, 0)], local.q[0]), (0.5, -0.5));
/// # Ok::<(), contact_bipotential::ContactError>(())
/// ```
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct GlobalProblem {
    /// Mass or stiffness, `n x n`, not singular.
    pub m: SparseEntries,
    /// Columns are the unit reactions, `n x (dim contacts)`.
    pub h: SparseEntries,
    /// Load, `n`.
    pub f: Vec<f64>,
    /// Velocity of the obstacles, `dim contacts`.
    pub w: Vec<f64>,
    /// Friction coefficient of each contact \[-\].
    pub mu: Vec<f64>,
    /// Entries a contact.
    pub cone: Cone,
}

impl GlobalProblem {
    /// The problem of these matrices and vectors; whether they fit is checked by [`Self::reduce`].
    #[must_use]
    pub fn new(
        m: SparseEntries,
        h: SparseEntries,
        f: Vec<f64>,
        w: Vec<f64>,
        mu: Vec<f64>,
        cone: Cone,
    ) -> Self {
        GlobalProblem {
            m,
            h,
            f,
            w,
            mu,
            cone,
        }
    }

    /// The local problem: `W = H^T M^-1 H`, `q = H^T M^-1 f + w`, by a sparse factorisation of `M`.
    ///
    /// # Errors
    /// [`ContactError::Factorization`] for a singular `M`, [`ContactError::Length`] and [`ContactError::Entry`] for
    /// sizes that do not fit, and those of [`ContactProblem::check`].
    pub fn reduce(&self) -> Result<ContactProblem, ContactError> {
        let (n, contacts) = (self.f.len(), self.mu.len());
        let size = contacts * self.cone.dim();
        for (what, found, expected) in [
            ("M (rows)", self.m.rows, n),
            ("M (columns)", self.m.columns, n),
            ("H (rows)", self.h.rows, n),
            ("H (columns)", self.h.columns, size),
            ("w", self.w.len(), size),
        ] {
            if found != expected {
                return Err(ContactError::Length {
                    what,
                    contacts,
                    found,
                    expected,
                });
            }
        }
        let m = sparse(&self.m, "M")?;
        let h = sparse(&self.h, "H")?;
        let failed = |reason: String| ContactError::Factorization { size: n, reason };
        let lu = m.sp_lu().map_err(|e| failed(format!("{e:?}")))?;
        let mut q = self.w.clone();
        let mut entries = Vec::new();
        // Some columns at a time: H is sparse, M^-1 H is not.
        let batch = (BATCH / n.max(1)).clamp(1, size + 1);
        let mut first = 0;
        while first <= size {
            let count = batch.min(size + 1 - first);
            let mut right = Mat::<f64>::zeros(n, count);
            for k in 0..count {
                self.fill_column(&h, first + k, right.col_as_slice_mut(k));
            }
            lu.solve_in_place(&mut right);
            if right.col_iter().any(|c| c.iter().any(|x| !x.is_finite())) {
                return Err(failed("it is singular".to_owned()));
            }
            let product: Mat<f64> = h.transpose() * &right;
            for k in 0..count {
                let column = product.col_as_slice(k);
                if first + k == size {
                    q.iter_mut().zip(column).for_each(|(q, x)| *q += x);
                } else {
                    entries.extend(
                        column
                            .iter()
                            .enumerate()
                            .filter(|(_, x)| **x != 0.0)
                            .map(|(i, &x)| (i, first + k, x)),
                    );
                }
            }
            first += count;
        }
        let w = Delassus::from_entries(contacts, self.cone.dim(), &entries)?;
        ContactProblem::new(w, q, self.mu.clone(), self.cone)
    }

    /// Column `j` of `[H, f]`.
    fn fill_column(&self, h: &SparseColMat<usize, f64>, j: usize, out: &mut [f64]) {
        if j == h.ncols() {
            out.copy_from_slice(&self.f);
            return;
        }
        for (i, x) in h.row_idx_of_col(j).zip(h.val_of_col(j)) {
            out[i] = *x;
        }
    }
}

fn sparse(a: &SparseEntries, what: &'static str) -> Result<SparseColMat<usize, f64>, ContactError> {
    let (rows, columns) = (a.rows, a.columns);
    if let Some(&(row, column, _)) = a.entries.iter().find(|e| e.0 >= rows || e.1 >= columns) {
        return Err(ContactError::Entry {
            what,
            row,
            column,
            rows,
            columns,
        });
    }
    let list: Vec<_> = a
        .entries
        .iter()
        .map(|&(i, j, x)| Triplet::new(i, j, x))
        .collect();
    SparseColMat::try_new_from_triplets(rows, columns, &list).map_err(|e| {
        ContactError::Factorization {
            size: rows,
            reason: format!("{what}: {e:?}"),
        }
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn two_masses(m: [[f64; 2]; 2]) -> GlobalProblem {
        let entries = (0..4).map(|k| (k / 2, k % 2, m[k / 2][k % 2])).collect();
        GlobalProblem {
            m: SparseEntries::new(2, 2, entries),
            h: SparseEntries::new(2, 2, vec![(0, 0, 1.0), (1, 0, -1.0), (1, 1, 2.0)]),
            f: vec![1.0, 3.0],
            w: vec![0.5, -1.0],
            mu: vec![0.0; 2],
            cone: Cone::Frictionless,
        }
    }

    #[test]
    fn reduction_is_the_schur_complement() {
        let p = two_masses([[2.0, 1.0], [1.0, 3.0]]).reduce().unwrap();
        // M^-1 = [[3, -1], [-1, 2]] / 5 by hand.
        let w = p.w.to_dense();
        let expected = [[7.0 / 5.0, -6.0 / 5.0], [-6.0 / 5.0, 8.0 / 5.0]];
        for i in 0..2 {
            for j in 0..2 {
                assert!((w[(i, j)] - expected[i][j]).abs() < 1e-15);
            }
        }
        assert!((p.q[0] - (-1.0 + 0.5)).abs() < 1e-15 && (p.q[1] - (2.0 - 1.0)).abs() < 1e-15);
    }

    #[test]
    fn what_cannot_be_reduced_says_why() {
        let singular = two_masses([[1.0, 2.0], [2.0, 4.0]]).reduce().unwrap_err();
        assert!(
            matches!(singular, ContactError::Factorization { size: 2, .. }),
            "{singular}"
        );
        let mut short = two_masses([[2.0, 1.0], [1.0, 3.0]]);
        short.w.pop();
        assert!(matches!(
            short.reduce(),
            Err(ContactError::Length { what: "w", .. })
        ));
        let mut outside = two_masses([[2.0, 1.0], [1.0, 3.0]]);
        outside.h.entries.push((2, 0, 1.0));
        assert!(matches!(
            outside.reduce(),
            Err(ContactError::Entry {
                what: "H",
                row: 2,
                ..
            })
        ));
    }
}
