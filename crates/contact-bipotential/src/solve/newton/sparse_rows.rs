//! The block rows of the Newton matrix for a block-sparse `W`.

use crate::delassus::BlockSparse;
use crate::local::Matrix;
use crate::solve::block_lu::BlockRows;
use crate::solve::newton::{Mode, across};

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
        let mut extra = [[0.0; D]; D];
        let mode = &self.modes[c];
        let scale = self.scales[c];
        match mode {
            Mode::Free => {
                for i in 0..D {
                    extra[i][i] = 1.0;
                }
                return put(c, &extra);
            }
            Mode::Stick => {
                for i in 0..D {
                    extra[i][i] = self.alpha * scale;
                }
            }
            Mode::Slip { along, beta } => {
                let p = across(along);
                let inverse_rho = (1.0 + self.alpha) * scale;
                extra[D - 1][D - 1] = self.alpha * scale;
                for i in 0..D - 1 {
                    extra[0][i] = inverse_rho * along[i];
                    if D == 3 {
                        extra[1][i] =
                            ((1.0 - beta) * inverse_rho + self.alpha * beta * scale) * p[i];
                    }
                }
                extra[0][D - 1] = -inverse_rho * self.mu[c];
            }
        }
        put(c, &extra);
        for (&j, block) in self
            .w
            .row(c)
            .iter()
            .zip(self.w.row_values(c).chunks_exact(D * D))
        {
            let j = j as usize;
            if self.modes[j] == Mode::Free {
                continue;
            }
            let mut m = [[0.0; D]; D];
            match mode {
                Mode::Slip { along, beta } => {
                    m[D - 1].copy_from_slice(&block[(D - 1) * D..]);
                    if D == 3 {
                        for k in 0..D {
                            m[1][k] = beta * (along[0] * block[D + k] - along[1] * block[k]);
                        }
                    }
                }
                _ => {
                    for i in 0..D {
                        m[i].copy_from_slice(&block[i * D..i * D + D]);
                    }
                }
            }
            put(j, &m);
        }
    }

    #[inline]
    fn is_alone(&self, c: usize) -> bool {
        self.modes[c] == Mode::Free
    }
}
