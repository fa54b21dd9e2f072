//! Sweeps over the contacts, each solved with the others held.

use crate::delassus::Delassus;
use crate::local::{Matrix, Vector, load, store, trace};
use crate::problem::ContactProblem;
use crate::rcc::BondStep;
use crate::solve::bonded::bonded_contact;
use crate::solve::iterate::{Iterate, Work};
use crate::solve::local_newton::{joli_feng, predict_correct};
use crate::solve::mixing::Mixer;
use crate::solve::single::SingleContact;
use crate::truth::Truth;

/// How one contact is solved while the others are held.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Kernel {
    /// [`SingleContact`].
    Exact,
    /// A few predictor-corrector steps of the bi-potential method.
    PredictCorrect,
    /// Newton on `Z = r - Proj(r*)`.
    JoliFeng,
}

/// The contacts of a problem, prepared for sweeps.
#[derive(Debug)]
pub(crate) struct Sweeper<'a, const D: usize> {
    problem: &'a ContactProblem,
    bonds: &'a [BondStep],
    kernel: Kernel,
    blocks: Vec<SingleContact<D>>,
    diagonals: Vec<Matrix<D>>,
}

impl<'a, const D: usize> Sweeper<'a, D> {
    pub(crate) fn new(problem: &'a ContactProblem, kernel: Kernel) -> Self {
        Self::bonded(problem, &[], kernel)
    }

    /// The same with a bond at each contact, or none at all; a bonded contact is always solved exactly.
    pub(crate) fn bonded(
        problem: &'a ContactProblem,
        bonds: &'a [BondStep],
        kernel: Kernel,
    ) -> Self {
        let diagonals: Vec<_> = (0..problem.contacts())
            .map(|c| problem.w.diagonal::<D>(c))
            .collect();
        let blocks = diagonals.iter().map(SingleContact::new).collect();
        Sweeper {
            problem,
            bonds,
            kernel,
            blocks,
            diagonals,
        }
    }

    /// One sweep, forwards or backwards. For a dense `W`, `u` must belong to `r` and does so afterwards, up to rounding;
    /// for a block-sparse one it is not used.
    pub(crate) fn sweep(&self, r: &mut [f64], u: &mut [f64], backwards: bool) {
        let n = self.problem.contacts();
        for k in 0..n {
            let c = if backwards { n - 1 - k } else { k };
            match &self.problem.w {
                Delassus::BlockSparse(w) => {
                    let mut b = w.row_times::<D>(c, r);
                    for i in 0..D {
                        b[i] += self.problem.q[c * D + i];
                    }
                    if let Some((new, _)) = self.relax(c, &load(r, c), b) {
                        store(r, c, &new);
                    }
                }
                Delassus::Dense(w) => {
                    if let Some((new, step)) = self.relax(c, &load(r, c), load(u, c)) {
                        store(r, c, &new);
                        add_columns::<D>(w, c, &step, u);
                    }
                }
                Delassus::Operator(_) => return,
            }
        }
    }

    /// New reaction of a contact with present velocity `b`, and its change; `None` where nothing changes.
    #[inline(always)]
    fn relax(&self, c: usize, r: &Vector<D>, mut b: Vector<D>) -> Option<(Vector<D>, Vector<D>)> {
        let w = &self.diagonals[c];
        for i in 0..D {
            for j in 0..D {
                b[i] -= w[i][j] * r[j];
            }
        }
        let mu = self.problem.mu[c];
        let scale = trace(w) / D as f64;
        let new = match self.kernel {
            Kernel::Exact if !self.bonds.is_empty() => bonded_contact(w, &b, mu, &self.bonds[c]),
            Kernel::Exact => self.blocks[c].solve(&b, mu).r,
            Kernel::PredictCorrect => predict_correct(w, scale, &b, mu, r),
            Kernel::JoliFeng => joli_feng(w, scale, &b, mu, r),
        };
        let mut step = new;
        let (mut moved, mut sum) = (false, 0.0);
        for i in 0..D {
            step[i] -= r[i];
            moved |= step[i] != 0.0;
            sum += new[i];
        }
        (moved && sum.is_finite()).then_some((new, step))
    }

    /// Two sweeps, there and back.
    pub(crate) fn there_and_back(&self, x: &mut Iterate) {
        self.sweep(&mut x.r, &mut x.u, false);
        self.sweep(&mut x.r, &mut x.u, true);
    }

    /// Sweeps until `best` is within `tolerance` or `budget` sweeps are done; the true error is measured every few sweeps.
    pub(crate) fn run(
        &self,
        truth: &Truth<'_>,
        best: &mut Iterate,
        tolerance: f64,
        budget: usize,
        work: &mut Work,
    ) {
        let mut x = best.clone();
        let mut done = 0;
        while done < budget && !best.is_within(tolerance) {
            let pairs = if done < 20 { 1 } else { 5 };
            for _ in 0..pairs {
                self.there_and_back(&mut x);
            }
            done += 2 * pairs;
            x.refresh(truth);
            best.keep_better(&x);
        }
        work.sweeps += done;
    }

    /// Sweeps whose sequence is extrapolated by Anderson's method, safeguarded by the true error.
    pub(crate) fn run_mixed(
        &self,
        truth: &Truth<'_>,
        best: &mut Iterate,
        tolerance: f64,
        budget: usize,
        work: &mut Work,
    ) {
        let mut x = best.clone();
        let mut mixer = Mixer::new(truth);
        let mut done = 0;
        while done < budget && !best.is_within(tolerance) {
            let before = x.r.clone();
            self.there_and_back(&mut x);
            x.refresh(truth);
            done += 2;
            let mut improved = best.keep_better(&x);
            let plain = x.errors.scale_free;
            if let Some(mixed) = mixer.mix(&before, &x.r) {
                let swept = x.clone();
                x.r = mixed;
                x.refresh(truth);
                improved |= best.keep_better(&x);
                if x.errors.scale_free > 2.0 * plain {
                    x = swept;
                    mixer.forget();
                }
            }
            mixer.note(improved);
        }
        work.sweeps += done;
    }
}

fn add_columns<const D: usize>(w: &faer::Mat<f64>, c: usize, step: &Vector<D>, u: &mut [f64]) {
    let mut columns = [w.col_as_slice(c * D); D];
    for i in 1..D {
        columns[i] = w.col_as_slice(c * D + i);
    }
    let columns = columns.map(|x| &x[..u.len()]);
    for (k, u) in u.iter_mut().enumerate() {
        for i in 0..D {
            *u += columns[i][k] * step[i];
        }
    }
}
