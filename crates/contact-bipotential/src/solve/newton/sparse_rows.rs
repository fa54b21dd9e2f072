//! The block rows of the Newton matrix for a block-sparse `W`.

use crate::delassus::BlockSparse;
use crate::local::{Matrix, load_block};
use crate::solve::block_lu::BlockRows;
use crate::solve::contact_mode::{Mode, across};

/// The Newton matrix, row by row. Sliding contacts keep a row for the friction limit, so that all blocks have one size.
pub(super) struct SparseRows<'a, const D: usize> {
    pub(super) w: &'a BlockSparse,
    pub(super) modes: &'a [Mode<D>],
    pub(super) mu: &'a [f64],
    pub(super) scales: &'a [f64],
    pub(super) alpha: f64,
}

impl<const D: usize> BlockRows<D> for SparseRows<'_, D> {
    #[inline]
    fn row(&self, c: usize, mut put: impl FnMut(usize, &Matrix<D>)) {
        let mode = &self.modes[c];
        put(c, &self.diagonal(c));
        if *mode == Mode::Free {
            return;
        }
        for (j, block) in self.w.blocks(c) {
            if self.modes[j] == Mode::Free {
                continue;
            }
            let m = match mode {
                Mode::Slip { along, beta } => {
                    let mut m = Matrix::zeros();
                    for k in 0..D {
                        m[(D - 1, k)] = block[(D - 1) * D + k];
                        if D == 3 {
                            m[(1, k)] = beta * (along[0] * block[D + k] - along[1] * block[k]);
                        }
                    }
                    m
                }
                _ => load_block(block),
            };
            put(j, &m);
        }
    }

    #[inline]
    fn is_alone(&self, c: usize) -> bool {
        self.modes[c] == Mode::Free
    }
}

impl<const D: usize> SparseRows<'_, D> {
    /// What stands on the diagonal beside the block of `W`.
    #[inline(always)]
    fn diagonal(&self, c: usize) -> Matrix<D> {
        let (scale, alpha) = (self.scales[c], self.alpha);
        match &self.modes[c] {
            Mode::Free => Matrix::identity(),
            Mode::Stick => Matrix::identity() * (alpha * scale),
            Mode::Slip { along, beta } => {
                let p = across(along);
                let inverse_rho = (1.0 + alpha) * scale;
                let mut m = Matrix::zeros();
                m[(D - 1, D - 1)] = alpha * scale;
                for i in 0..D - 1 {
                    m[(0, i)] = inverse_rho * along[i];
                    if D == 3 {
                        m[(1, i)] = ((1.0 - beta) * inverse_rho + alpha * beta * scale) * p[i];
                    }
                }
                m[(0, D - 1)] = -inverse_rho * self.mu[c];
                m
            }
        }
    }
}
