//! Sparse Cholesky factorization of one body, with the trailing block of the contact candidates.

use std::fmt;

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::cholesky::llt::factor::LltRegularization;
use faer::linalg::matmul::triangular::{self, BlockStructure};
use faer::linalg::triangular_inverse::invert_lower_triangular;
use faer::sparse::linalg::SupernodalThreshold;
use faer::sparse::linalg::cholesky::supernodal::{
    SupernodalLltRef, SymbolicSupernodalCholesky, factorize_supernodal_numeric_llt,
    factorize_supernodal_numeric_llt_scratch,
};
use faer::sparse::linalg::cholesky::{
    CholeskySymbolicParams, SymbolicCholesky, SymbolicCholeskyRaw, SymmetricOrdering,
    factorize_symbolic_cholesky,
};
use faer::sparse::{SparseColMatRef, SymbolicSparseColMatRef};
use faer::{Accum, Conj, Mat, MatMut, Par, Side};

use crate::error::NscdError;

/// A lower-triangular sparse matrix in compressed columns, rows sorted, diagonal first.
#[derive(Debug, Clone, Copy)]
pub(crate) struct LowerPattern<'a> {
    pub(crate) pointers: &'a [usize],
    pub(crate) rows: &'a [usize],
}

impl LowerPattern<'_> {
    fn n(&self) -> usize {
        self.pointers.len() - 1
    }

    /// The diagonal of the symmetric matrix whose lower triangle has the given values.
    pub(crate) fn diagonal(&self, values: &[f64]) -> Vec<f64> {
        let columns = self.pointers.iter().take(self.n());
        columns.map(|&k| values[k]).collect()
    }

    /// `x . A x` for the symmetric matrix whose lower triangle has the given values.
    pub(crate) fn energy(&self, values: &[f64], x: &[f64]) -> f64 {
        let mut product = vec![0.0; x.len()];
        self.subtract_product(values, x, &mut product);
        -x.iter().zip(&product).map(|(x, y)| x * y).sum::<f64>()
    }

    /// `y -= A x` for the symmetric matrix whose lower triangle has the given values.
    pub(crate) fn subtract_product(&self, values: &[f64], x: &[f64], y: &mut [f64]) {
        for j in 0..self.n() {
            let (start, end) = (self.pointers[j], self.pointers[j + 1]);
            let xj = x[j];
            let mut sum = values[start] * xj;
            for k in start + 1..end {
                let i = self.rows[k];
                y[i] -= values[k] * xj;
                sum += values[k] * x[i];
            }
            y[j] -= sum;
        }
    }
}

/// Numeric factor of one body in storage that is reused from factorization to factorization.
pub(crate) struct Factor {
    symbolic: SymbolicCholesky<usize>,
    values: Vec<f64>,
    memory: MemBuffer,
    /// Floating point operations of one numeric factorization.
    pub(crate) flops: f64,
}

impl fmt::Debug for Factor {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Factor")
            .field("n", &self.symbolic.nrows())
            .field("flops", &self.flops)
            .finish()
    }
}

/// The matrix is not positive definite: the pivot of this equation is not positive.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Indefinite {
    pub(crate) equation: usize,
}

impl Factor {
    /// Analyses a pattern that is already in elimination order.
    pub(crate) fn new(pattern: LowerPattern<'_>) -> Result<Self, NscdError> {
        let n = pattern.n();
        let (pointers, rows) = transpose_pattern(pattern);
        let upper = SymbolicSparseColMatRef::new_checked(n, n, &pointers, None, &rows);
        let params = CholeskySymbolicParams {
            supernodal_flop_ratio_threshold: SupernodalThreshold::FORCE_SUPERNODAL,
            ..Default::default()
        };
        let symbolic =
            factorize_symbolic_cholesky(upper, Side::Upper, SymmetricOrdering::Identity, params)
                .map_err(|e| NscdError::Symbolic {
                    unknowns: n,
                    reason: format!("{e:?}"),
                })?;
        let SymbolicCholeskyRaw::Supernodal(factor) = symbolic.raw() else {
            return Err(NscdError::Symbolic {
                unknowns: n,
                reason: "no supernodal structure".into(),
            });
        };
        let scratch = factorize_supernodal_numeric_llt_scratch::<usize, f64>(
            factor,
            Par::Seq,
            Default::default(),
        )
        .or(factor.solve_in_place_scratch::<f64>(1, Par::Seq));
        let (values, flops) = (vec![0.0; factor.len_val()], factorization_flops(factor));
        Ok(Self {
            memory: MemBuffer::new(scratch),
            values,
            flops,
            symbolic,
        })
    }

    fn supernodal(
        symbolic: &SymbolicCholesky<usize>,
    ) -> Option<&SymbolicSupernodalCholesky<usize>> {
        match symbolic.raw() {
            SymbolicCholeskyRaw::Supernodal(factor) => Some(factor),
            SymbolicCholeskyRaw::Simplicial(_) => None,
        }
    }

    /// Number of stored entries of the factor.
    pub(crate) fn fill(&self) -> usize {
        self.values.len()
    }

    /// Numeric factorization `A = L L^T`.
    ///
    /// # Errors
    /// [`Indefinite`] with the first equation whose pivot is not positive.
    pub(crate) fn factorize(
        &mut self,
        pattern: LowerPattern<'_>,
        values: &[f64],
    ) -> Result<(), Indefinite> {
        let n = pattern.n();
        let lower =
            SymbolicSparseColMatRef::new_checked(n, n, pattern.pointers, None, pattern.rows);
        let matrix = SparseColMatRef::new(lower, values);
        let Some(symbolic) = Self::supernodal(&self.symbolic) else {
            return Ok(());
        };
        factorize_supernodal_numeric_llt(
            &mut self.values,
            matrix,
            LltRegularization::default(),
            symbolic,
            Par::Seq,
            MemStack::new(&mut self.memory),
            Default::default(),
        )
        .map(|_| ())
        .map_err(|e| match e {
            faer::linalg::cholesky::llt::factor::LltError::NonPositivePivot { index } => {
                Indefinite { equation: index }
            }
        })
    }

    /// `x <- L^-1 x`.
    pub(crate) fn forward(&mut self, x: &mut [f64]) {
        if let Some(symbolic) = Self::supernodal(&self.symbolic) {
            let n = x.len();
            let rhs = MatMut::from_column_major_slice_mut(x, n, 1);
            let stack = MemStack::new(&mut self.memory);
            SupernodalLltRef::new(symbolic, &self.values).l_solve_with_conj(
                Conj::No,
                rhs,
                Par::Seq,
                stack,
            );
        }
    }

    /// `x <- L^-T x`.
    pub(crate) fn backward(&mut self, x: &mut [f64]) {
        if let Some(symbolic) = Self::supernodal(&self.symbolic) {
            let n = x.len();
            let rhs = MatMut::from_column_major_slice_mut(x, n, 1);
            let stack = MemStack::new(&mut self.memory);
            SupernodalLltRef::new(symbolic, &self.values).l_transpose_solve_with_conj(
                Conj::No,
                rhs,
                Par::Seq,
                stack,
            );
        }
    }

    /// The trailing block `L22` (dense, lower) of the equations `first..n`.
    ///
    /// Supernodes can straddle the boundary, so the columns are filtered one by one.
    fn trailing_block(&self, first: usize) -> Mat<f64> {
        let n = self.symbolic.nrows();
        let mut block = Mat::zeros(n - first, n - first);
        let Some(symbolic) = Self::supernodal(&self.symbolic) else {
            return block;
        };
        let factor = SupernodalLltRef::new(symbolic, &self.values);
        for s in 0..symbolic.n_supernodes() {
            let (begin, end) = (symbolic.supernode_begin()[s], symbolic.supernode_end()[s]);
            let node = factor.supernode(s);
            for j in begin.max(first)..end {
                let column = node.val().col(j - begin);
                for i in j..end {
                    block[(i - first, j - first)] = column[i - begin];
                }
                for (k, &i) in node.pattern().iter().enumerate() {
                    block[(i - first, j - first)] = column[end - begin + k];
                }
            }
        }
        block
    }

    /// The body condensed onto its equations `first..n`: see [`Condensed`], and its compliance
    /// `C = L22^-T L22^-1 = (A^-1)_22` \[m/N\].
    pub(crate) fn condense(&self, first: usize) -> (Condensed, Mat<f64>) {
        let factor = self.trailing_block(first);
        let m = factor.nrows();
        let mut inverse = Mat::zeros(m, m);
        invert_lower_triangular(inverse.as_mut(), factor.as_ref(), Par::Seq);
        let mut compliance = Mat::zeros(m, m);
        triangular::matmul(
            compliance.as_mut(),
            BlockStructure::TriangularLower,
            Accum::Replace,
            inverse.transpose(),
            BlockStructure::TriangularUpper,
            inverse.as_ref(),
            BlockStructure::TriangularLower,
            1.0,
            Par::Seq,
        );
        for j in 0..m {
            for i in 0..j {
                compliance[(i, j)] = compliance[(j, i)];
            }
        }
        (Condensed { inverse }, compliance)
    }
}

/// The trailing block of a factor, inverted: how the candidate surface of a body gives way.
#[derive(Debug)]
pub(crate) struct Condensed {
    /// `L22^-1`, lower triangular.
    inverse: Mat<f64>,
}

impl Condensed {
    /// `z = L22^-T y` for the trailing part `y` of a forward solution.
    pub(crate) fn free_solution(&self, y: &[f64], z: &mut [f64]) {
        let m = self.inverse.nrows();
        for j in 0..m {
            let column = self.inverse.col(j);
            z[j] = (j..m).map(|i| column[i] * y[i]).sum();
        }
    }

    /// `y += L22^-1 f`: a force on the surface enters a forward solution.
    pub(crate) fn add_force(&self, f: &[f64], y: &mut [f64]) {
        for (j, &fj) in f.iter().enumerate().filter(|(_, f)| **f != 0.0) {
            let column = self.inverse.col(j);
            for i in j..y.len() {
                y[i] += column[i] * fj;
            }
        }
    }
}

fn transpose_pattern(lower: LowerPattern<'_>) -> (Vec<usize>, Vec<usize>) {
    let n = lower.n();
    let mut pointers = vec![0; n + 1];
    for &i in lower.rows {
        pointers[i + 1] += 1;
    }
    for i in 0..n {
        pointers[i + 1] += pointers[i];
    }
    let mut next = pointers.clone();
    let mut rows = vec![0; lower.rows.len()];
    for j in 0..n {
        for &i in &lower.rows[lower.pointers[j]..lower.pointers[j + 1]] {
            rows[next[i]] = j;
            next[i] += 1;
        }
    }
    (pointers, rows)
}

fn factorization_flops(factor: &SymbolicSupernodalCholesky<usize>) -> f64 {
    (0..factor.n_supernodes())
        .map(|s| {
            let columns = factor.supernode_end()[s] - factor.supernode_begin()[s];
            let below = factor.supernode(s).pattern().len();
            (0..columns)
                .map(|k| ((columns - k + below) as f64).powi(2))
                .sum::<f64>()
        })
        .sum()
}
