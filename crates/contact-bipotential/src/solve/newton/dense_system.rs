//! The Newton system of a dense `W`: free contacts leave it, sliding ones keep the unknowns that the slip leaves them.

use faer::Mat;

use crate::delassus::{DenseMatrix, dense_times};
use crate::local::{Vector, load, store};
use crate::solve::contact_mode::{Mode, across, slip_excess};
use crate::solve::dense_lu::DenseLu;

/// Storage that is used again from step to step.
#[derive(Debug)]
pub(super) struct DenseStorage {
    matrix: Mat<f64>,
    /// Contact and number of each unknown.
    unknowns: Vec<(u32, u8)>,
}

impl DenseStorage {
    pub(super) fn new() -> Self {
        DenseStorage {
            matrix: Mat::new(),
            unknowns: Vec::new(),
        }
    }
}

/// One Newton step.
#[derive(Debug)]
pub(super) struct DenseSystem<'a, const D: usize> {
    pub(super) w: &'a DenseMatrix,
    pub(super) mu: &'a [f64],
    pub(super) scales: &'a [f64],
    pub(super) modes: &'a [Mode<D>],
    pub(super) alpha: f64,
}

impl<const D: usize> DenseSystem<'_, D> {
    /// Writes the step `dr` from the reactions `r` with the velocities `v`.
    pub(super) fn step(&self, storage: &mut DenseStorage, r: &[f64], v: &[f64], dr: &mut [f64]) {
        let DenseStorage { matrix, unknowns } = storage;
        unknowns.clear();
        for (c, mode) in self.modes.iter().enumerate() {
            unknowns.extend((0..mode.unknowns()).map(|k| (c as u32, k as u8)));
        }
        // What is known of the step already moves the contacts.
        self.known(r, dr);
        let mut shifted = vec![0.0; r.len()];
        dense_times(self.w, dr, &mut shifted);
        for (c, scale) in self.scales.iter().enumerate() {
            for i in c * D..c * D + D {
                shifted[i] += v[i] + self.alpha * scale * dr[i];
            }
        }
        let n = unknowns.len();
        if matrix.nrows() != n {
            *matrix = Mat::zeros(n, n);
        }
        self.assemble(unknowns, matrix);
        let mut x = self.right_side(unknowns, r, v, &shifted);
        let lu = DenseLu::new(std::mem::replace(matrix, Mat::new()));
        lu.solve(&mut x);
        *matrix = lu.into_storage();
        for (&(c, k), x) in unknowns.iter().zip(&x) {
            let c = c as usize;
            let trial = self.modes[c].trial(usize::from(k), self.mu[c]);
            store(dr, c, &(load::<D>(dr, c) + trial * *x));
        }
    }

    /// The part of the step that does not depend on the others: free contacts let go, sliding ones return to the
    /// friction limit.
    fn known(&self, r: &[f64], dr: &mut [f64]) {
        for (c, mode) in self.modes.iter().enumerate() {
            let r = load::<D>(r, c);
            let known = match mode {
                Mode::Free => -r,
                Mode::Stick => Vector::zeros(),
                Mode::Slip { along, .. } => along * -slip_excess(self.mu[c], along, &r),
            };
            store(dr, c, &known);
        }
    }

    fn right_side(
        &self,
        unknowns: &[(u32, u8)],
        r: &[f64],
        v: &[f64],
        shifted: &[f64],
    ) -> Vec<f64> {
        let one = |&(c, k): &(u32, u8)| {
            let (c, k) = (c as usize, usize::from(k));
            let test = self.modes[c].test(k);
            let moved = load::<D>(shifted, c);
            match (&self.modes[c], k) {
                (Mode::Slip { along, .. }, 1) => {
                    // The part of dv that the known changes make, and -w p.r.
                    let dv = moved - load::<D>(v, c);
                    let p = across(along);
                    -test.dot(&dv) - (1.0 + self.alpha) * self.scales[c] * p.dot(&load(r, c))
                }
                _ => -test.dot(&moved),
            }
        };
        unknowns.iter().map(one).collect()
    }

    fn assemble(&self, unknowns: &[(u32, u8)], matrix: &mut Mat<f64>) {
        let mut column = vec![0.0; self.w.nrows()];
        for (j, &(c, k)) in unknowns.iter().enumerate() {
            let (c, k) = (c as usize, usize::from(k));
            let trial = self.modes[c].trial(k, self.mu[c]);
            combine::<D>(self.w, c, &trial, &mut column);
            for i in 0..D {
                column[c * D + i] += self.alpha * self.scales[c] * trial[i];
            }
            let out = matrix.col_as_slice_mut(j);
            self.test_column(&column, out);
            if let (Mode::Slip { beta, .. }, 1) = (&self.modes[c], k) {
                out[j] += (1.0 - beta) * (1.0 + self.alpha) * self.scales[c];
            }
        }
    }

    /// The test directions of all contacts, applied to a column of velocities.
    #[inline(always)]
    fn test_column(&self, column: &[f64], out: &mut [f64]) {
        let mut i = 0;
        for (m, mode) in self.modes.iter().enumerate() {
            let x = &column[m * D..m * D + D];
            match mode {
                Mode::Free => {}
                Mode::Stick => {
                    out[i..i + D].copy_from_slice(x);
                    i += D;
                }
                Mode::Slip { along, beta } => {
                    out[i] = x[D - 1];
                    if D == 3 {
                        out[i + 1] = beta * (along[0] * x[1] - along[1] * x[0]);
                    }
                    i += D - 1;
                }
            }
        }
    }
}

/// `out = W[:, c] x`.
fn combine<const D: usize>(w: &DenseMatrix, c: usize, x: &Vector<D>, out: &mut [f64]) {
    let mut first = true;
    for k in 0..D {
        if x[k] == 0.0 {
            continue;
        }
        let column = w.col_as_slice(c * D + k);
        if first {
            for (o, a) in out.iter_mut().zip(column) {
                *o = a * x[k];
            }
            first = false;
        } else {
            for (o, a) in out.iter_mut().zip(column) {
                *o += a * x[k];
            }
        }
    }
    if first {
        out.fill(0.0);
    }
}
