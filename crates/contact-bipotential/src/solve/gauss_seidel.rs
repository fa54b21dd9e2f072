//! Sweeps over the contacts, each solved with the others held.

use crate::delassus::{Delassus, DenseMatrix};
use crate::error_measure::ErrorMeasure;
use crate::local::{Matrix, Vector, load, store};
use crate::problem::ContactProblem;
use crate::rcc::BondStep;
use crate::solve::acceleration::Acceleration;
use crate::solve::bonded_contact::bonded_contact;
use crate::solve::iterate::Iterate;
use crate::solve::local_newton::{joli_feng, predict_correct};
use crate::solve::outcome::Work;
use crate::solve::single::SingleContact;

/// Sweeps after which the error is measured less often, and the symmetric sweeps between two measurements then: a
/// measurement costs about as much as a sweep.
const MANY: usize = 20;
const PAIRS: usize = 5;

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

    /// One sweep, forwards or backwards. For a dense `W`, `u` must belong to `r` and does so afterwards, up to
    /// rounding; for a block-sparse one it is not used.
    pub(crate) fn sweep(&self, r: &mut [f64], u: &mut [f64], backwards: bool) {
        let n = self.problem.contacts();
        for k in 0..n {
            let c = if backwards { n - 1 - k } else { k };
            match &self.problem.w {
                Delassus::BlockSparse(w) => {
                    let b = w.row_times::<D>(c, r) + load::<D>(&self.problem.q, c);
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
                b[i] -= w[(i, j)] * r[j];
            }
        }
        let mu = self.problem.mu[c];
        let scale = w.trace() / D as f64;
        let new = match self.kernel {
            Kernel::Exact if !self.bonds.is_empty() => bonded_contact(w, &b, mu, &self.bonds[c]),
            Kernel::Exact => self.blocks[c].solve(&b, mu).r,
            Kernel::PredictCorrect => predict_correct(w, scale, &b, mu, r),
            Kernel::JoliFeng => joli_feng(w, scale, &b, mu, r),
        };
        let step = new - r;
        let moved = step.iter().any(|x| *x != 0.0);
        (moved && new.sum().is_finite()).then_some((new, step))
    }

    /// A symmetric sweep: forwards, then backwards.
    pub(crate) fn symmetric_sweep(&self, x: &mut Iterate) {
        self.sweep(&mut x.r, &mut x.u, false);
        self.sweep(&mut x.r, &mut x.u, true);
    }

    /// Sweeps until `best` is within `tolerance` or `budget` sweeps are done; the error is measured every few sweeps.
    pub(crate) fn run(
        &self,
        measure: &ErrorMeasure<'_>,
        best: &mut Iterate,
        tolerance: f64,
        budget: usize,
        work: &mut Work,
    ) {
        let mut x = best.clone();
        let mut done = 0;
        while done < budget && !best.is_within(tolerance) {
            let pairs = if done < MANY { 1 } else { PAIRS };
            for _ in 0..pairs {
                self.symmetric_sweep(&mut x);
            }
            done += 2 * pairs;
            x.refresh(measure);
            best.keep_better(&x);
        }
        work.sweeps += done;
    }

    /// Sweeps whose sequence is extrapolated by Anderson's method, safeguarded by the recomputed error.
    pub(crate) fn run_accelerated(
        &self,
        measure: &ErrorMeasure<'_>,
        best: &mut Iterate,
        tolerance: f64,
        budget: usize,
        work: &mut Work,
    ) {
        let mut x = best.clone();
        let mut acceleration = Acceleration::new();
        let mut done = 0;
        while done < budget && !best.is_within(tolerance) {
            let before = x.r.clone();
            self.symmetric_sweep(&mut x);
            x.refresh(measure);
            done += 2;
            let improved = best.keep_better(&x);
            acceleration.accelerate(measure, &before, &mut x, best, improved);
        }
        work.sweeps += done;
    }
}

fn add_columns<const D: usize>(w: &DenseMatrix, c: usize, step: &Vector<D>, u: &mut [f64]) {
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
