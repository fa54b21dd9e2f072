//! The linear step of a semismooth Newton method on the equation of Alart and Curnier \[Alart1991\].
//!
//! The unknown is `r`, with `v = W r + q + alpha w (r - centre)` (`alpha = 0` is the problem itself, `alpha > 0` a
//! proximal point step), `w_c` the compliance scale and `rho = 1 / ((1 + alpha) w_c)`. Each contact is in one mode, by
//! `z = r - rho v`: free (`z_n <= 0`): `dr = -r`; stuck: `v + dv = 0`; sliding along `e = z_t / |z_t|`:
//! `v_n + dv_n = 0`, `e.(r_t + dr_t) = mu (r_n + dr_n)`, and across, with `p` the other tangent,
//! `beta = mu z_n / |z_t| < 1`: `beta p.dv_t + (1 - beta) w_c p.dr_t = -w_c p.r_t`. Free contacts leave the linear
//! system, sliding ones keep two unknowns (one in the plane).

mod dense_system;
mod sparse_rows;

use crate::delassus::{BlockSparse, Delassus};
use crate::error_measure::ErrorMeasure;
use crate::local::{Vector, load, store};
use crate::problem::ContactProblem;
use crate::solve::block_lu::BlockLu;
use crate::solve::contact_mode::{Mode, across, slip_excess};
use crate::solve::iterate::Iterate;
use crate::solve::outcome::Work;

use dense_system::{DenseStorage, DenseSystem};
use sparse_rows::SparseRows;

/// The linear system of the Newton step and the storage of its factors.
#[derive(Debug)]
pub(crate) struct NewtonSystem<'a, const D: usize> {
    problem: &'a ContactProblem,
    scales: &'a [f64],
    modes: Vec<Mode<D>>,
    sparse: Option<BlockLu<D>>,
    dense: DenseStorage,
}

impl<'a, const D: usize> NewtonSystem<'a, D> {
    pub(crate) fn new(problem: &'a ContactProblem, scales: &'a [f64]) -> Self {
        let sparse = match &problem.w {
            Delassus::BlockSparse(w) => Some(BlockLu::new(w)),
            _ => None,
        };
        NewtonSystem {
            problem,
            scales,
            modes: vec![Mode::Free; problem.contacts()],
            sparse,
            dense: DenseStorage::new(),
        }
    }

    /// Sets the modes from `r` and `v`.
    pub(crate) fn classify(&mut self, r: &[f64], v: &[f64], alpha: f64) {
        for c in 0..self.modes.len() {
            self.modes[c] = Mode::of(
                self.problem.mu[c],
                (1.0 + alpha) * self.scales[c],
                &load::<D>(r, c),
                &load::<D>(v, c),
            );
        }
    }

    /// The Newton step `dr` for the present modes; false where the matrix is singular.
    pub(crate) fn step(&mut self, r: &[f64], v: &[f64], alpha: f64, dr: &mut [f64]) -> bool {
        let ok = match &self.problem.w {
            Delassus::BlockSparse(w) => self.step_sparse(w, r, v, alpha, dr),
            Delassus::Dense(w) => {
                DenseSystem {
                    w,
                    mu: &self.problem.mu,
                    scales: self.scales,
                    modes: &self.modes,
                    alpha,
                }
                .step(&mut self.dense, r, v, dr);
                true
            }
            Delassus::Operator(_) => false,
        };
        ok && dr.iter().all(|x| x.is_finite())
    }

    fn step_sparse(
        &mut self,
        w: &BlockSparse,
        r: &[f64],
        v: &[f64],
        alpha: f64,
        dr: &mut [f64],
    ) -> bool {
        let rows = SparseRows {
            w,
            modes: &self.modes,
            mu: &self.problem.mu,
            scales: self.scales,
            alpha,
        };
        let Some(lu) = self.sparse.as_mut() else {
            return false;
        };
        if !lu.factorize(w, &rows) {
            return false;
        }
        let shift = released_velocity(w, &self.modes, r);
        for (c, mode) in self.modes.iter().enumerate() {
            let (r, v, dv) = (load(r, c), load(v, c), load(&shift, c));
            let scale = (1.0 + alpha) * self.scales[c];
            let b = sparse_right_side(mode, self.problem.mu[c], scale, &r, &(v + dv), &dv);
            store(dr, c, &b);
        }
        lu.solve(dr);
        true
    }
}

/// The velocities that letting go of the free contacts makes.
fn released_velocity<const D: usize>(w: &BlockSparse, modes: &[Mode<D>], r: &[f64]) -> Vec<f64> {
    let (mut known, mut shift) = (vec![0.0; r.len()], vec![0.0; r.len()]);
    for (c, mode) in modes.iter().enumerate() {
        if *mode == Mode::Free {
            store(&mut known, c, &-load::<D>(r, c));
        }
    }
    if known.iter().any(|x| *x != 0.0) {
        w.times::<D>(&known, &mut shift);
    }
    shift
}

/// The right side of the rows of a contact in the sparse system; `v` holds the shift `dv` by the released contacts.
fn sparse_right_side<const D: usize>(
    mode: &Mode<D>,
    mu: f64,
    scale: f64,
    r: &Vector<D>,
    v: &Vector<D>,
    dv: &Vector<D>,
) -> Vector<D> {
    let b = match mode {
        Mode::Free => *r,
        Mode::Stick => *v,
        Mode::Slip { along, beta } => {
            let mut b = Vector::zeros();
            b[D - 1] = v[D - 1];
            b[0] = scale * slip_excess(mu, along, r);
            if D == 3 {
                let p = across(along);
                b[1] = scale * p.dot(r) + beta * p.dot(dv);
            }
            b
        }
    };
    -b
}

/// Newton's method on the problem itself (`alpha = 0`) with backtracking on the natural map: fast and, on hyperstatic
/// problems, unreliable. Kept for comparison.
pub(crate) fn newton<const D: usize>(
    measure: &ErrorMeasure<'_>,
    system: &mut NewtonSystem<'_, D>,
    best: &mut Iterate,
    tolerance: f64,
    budget: usize,
    work: &mut Work,
) {
    let mut x = best.clone();
    let mut dr = vec![0.0; x.r.len()];
    for _ in 0..budget {
        if best.is_within(tolerance) {
            return;
        }
        system.classify(&x.r, &x.u, 0.0);
        work.newton_steps += 1;
        if !system.step(&x.r, &x.u, 0.0, &mut dr) {
            return;
        }
        x = x.backtrack(measure, &dr);
        best.keep_better(&x);
    }
}
