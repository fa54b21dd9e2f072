//! The linear step of a semismooth Newton method on the equation of Alart and Curnier \[Alart1991\].
//!
//! The unknown is `r`, with `v = W r + q + alpha w (r - centre)` (`alpha = 0` is the problem itself, `alpha > 0` a proximal
//! point step), `w_c` the compliance scale and `rho = 1 / ((1 + alpha) w_c)`. Each contact is in one mode, by `z = r - rho v`:
//! free (`z_n <= 0`): `dr = -r`; stuck: `v + dv = 0`; sliding along `e = z_t / |z_t|`: `v_n + dv_n = 0`,
//! `e.(r_t + dr_t) = mu (r_n + dr_n)`, and across, with `p` the other tangent, `beta = mu z_n / |z_t| < 1`:
//! `beta p.dv_t + (1 - beta) w_c p.dr_t = -w_c p.r_t`. Free contacts leave the linear system, sliding ones keep two unknowns
//! (one in the plane).

mod sparse_rows;

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::lu::partial_pivoting;
use faer::{Mat, Par};

use crate::delassus::{BlockSparse, Delassus};
use crate::local::{Vector, load, store, tangential_norm};
use crate::problem::ContactProblem;
use crate::solve::block_lu::BlockLu;
use crate::solve::iterate::{Iterate, Work};
use crate::truth::Truth;

use sparse_rows::SparseRows;

/// What a contact does in one Newton step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Mode<const D: usize> {
    Free,
    Stick,
    Slip { along: Vector<D>, beta: f64 },
}

impl<const D: usize> Mode<D> {
    #[inline]
    pub(crate) fn of(mu: f64, w: f64, r: &Vector<D>, v: &Vector<D>) -> Self {
        let mut z = *r;
        for i in 0..D {
            z[i] -= v[i] / w;
        }
        let (length, radius) = (tangential_norm(&z), mu * z[D - 1]);
        if z[D - 1] <= 0.0 {
            return Mode::Free;
        }
        if D == 1 || length <= radius && mu > 0.0 {
            return Mode::Stick;
        }
        let mut along = [0.0; D];
        if length > 0.0 {
            for i in 0..D - 1 {
                along[i] = z[i] / length;
            }
        } else {
            along[0] = 1.0;
        }
        Mode::Slip {
            along,
            beta: if length > 0.0 { radius / length } else { 0.0 },
        }
    }

    /// Number of unknowns kept in the linear system.
    fn unknowns(&self) -> usize {
        match self {
            Mode::Free => 0,
            Mode::Stick => D,
            Mode::Slip { .. } => D - 1,
        }
    }

    /// Direction `k` in which a contact's reaction may change.
    fn trial(&self, k: usize, mu: f64) -> Vector<D> {
        let mut x = [0.0; D];
        match self {
            Mode::Slip { along, .. } if k == 0 => {
                x[D - 1] = 1.0;
                for i in 0..D - 1 {
                    x[i] = mu * along[i];
                }
            }
            Mode::Slip { along, .. } => x = across(along),
            _ => x[k] = 1.0,
        }
        x
    }

    /// Combination `k` of the components of `dv` that is prescribed.
    fn test(&self, k: usize) -> Vector<D> {
        let mut y = [0.0; D];
        match self {
            Mode::Slip { .. } if k == 0 => y[D - 1] = 1.0,
            Mode::Slip { along, beta } => {
                y = across(along);
                for x in &mut y {
                    *x *= beta;
                }
            }
            _ => y[k] = 1.0,
        }
        y
    }
}

/// The tangent across the slip direction.
pub(crate) fn across<const D: usize>(along: &Vector<D>) -> Vector<D> {
    let mut p = [0.0; D];
    if D == 3 {
        p[0] = -along[1];
        p[1] = along[0];
    }
    p
}

/// The linear system of the Newton step and the storage of its factors.
#[derive(Debug)]
pub(crate) struct NewtonSystem<'a, const D: usize> {
    problem: &'a ContactProblem,
    scales: &'a [f64],
    modes: Vec<Mode<D>>,
    sparse: Option<BlockLu<D>>,
    dense: Dense,
}

#[derive(Debug)]
struct Dense {
    matrix: Mat<f64>,
    unknowns: Vec<(u32, u8)>,
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
            dense: Dense {
                matrix: Mat::new(),
                unknowns: Vec::new(),
            },
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
            Delassus::Dense(w) => self.step_dense(w, r, v, alpha, dr),
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
        // What the freed contacts let go of acts on the others.
        let mut known = vec![0.0; r.len()];
        for (c, mode) in self.modes.iter().enumerate() {
            if *mode == Mode::Free {
                for i in c * D..c * D + D {
                    known[i] = -r[i];
                }
            }
        }
        let mut shift = vec![0.0; r.len()];
        if known.iter().any(|x| *x != 0.0) {
            self.problem.w.times(&known, &mut shift);
        }
        for (c, mode) in self.modes.iter().enumerate() {
            let (rc, mut vc, dv) = (load::<D>(r, c), load::<D>(v, c), load::<D>(&shift, c));
            for i in 0..D {
                vc[i] += dv[i];
            }
            let (mu, scale) = (self.problem.mu[c], (1.0 + alpha) * self.scales[c]);
            let mut b = [0.0; D];
            match mode {
                Mode::Free => b = rc,
                Mode::Stick => b = vc,
                Mode::Slip { along, beta } => {
                    b[D - 1] = vc[D - 1];
                    b[0] = scale * (slip_excess(mu, along, &rc));
                    if D == 3 {
                        let p = across(along);
                        b[1] =
                            scale * crate::local::dot(&p, &rc) + beta * crate::local::dot(&p, &dv);
                    }
                }
            }
            for x in &mut b {
                *x = -*x;
            }
            store(dr, c, &b);
        }
        lu.solve(dr);
        true
    }

    fn step_dense(
        &mut self,
        w: &Mat<f64>,
        r: &[f64],
        v: &[f64],
        alpha: f64,
        dr: &mut [f64],
    ) -> bool {
        let mut known = vec![0.0; r.len()];
        self.dense.unknowns.clear();
        for (c, mode) in self.modes.iter().enumerate() {
            let rc = load::<D>(r, c);
            let mut fixed = [0.0; D];
            match mode {
                Mode::Free => {
                    for i in 0..D {
                        fixed[i] = -rc[i];
                    }
                }
                Mode::Stick => {}
                Mode::Slip { along, .. } => {
                    let excess = slip_excess(self.problem.mu[c], along, &rc);
                    for i in 0..D {
                        fixed[i] = -excess * along[i];
                    }
                }
            }
            store(&mut known, c, &fixed);
            self.dense
                .unknowns
                .extend((0..mode.unknowns()).map(|k| (c as u32, k as u8)));
        }
        let mut shifted = vec![0.0; r.len()];
        self.problem.w.times(&known, &mut shifted);
        for (c, scale) in self.scales.iter().enumerate() {
            for i in c * D..c * D + D {
                shifted[i] += v[i] + alpha * scale * known[i];
            }
        }
        self.assemble_dense(w, alpha);
        let mut x = self.dense_right_side(r, v, &shifted, alpha);
        solve_dense(&mut self.dense.matrix, &mut x);
        dr.copy_from_slice(&known);
        for (&(c, k), x) in self.dense.unknowns.iter().zip(&x) {
            let c = c as usize;
            let trial = self.modes[c].trial(usize::from(k), self.problem.mu[c]);
            for i in 0..D {
                dr[c * D + i] += trial[i] * x;
            }
        }
        true
    }

    fn dense_right_side(&self, r: &[f64], v: &[f64], shifted: &[f64], alpha: f64) -> Vec<f64> {
        let one = |&(c, k): &(u32, u8)| {
            let (c, k) = (c as usize, usize::from(k));
            let test = self.modes[c].test(k);
            let moved = load::<D>(shifted, c);
            match (&self.modes[c], k) {
                (Mode::Slip { along, .. }, 1) => {
                    // The part of dv that the known changes make, and -w p.r.
                    let mut dv = moved;
                    let vc = load::<D>(v, c);
                    for i in 0..D {
                        dv[i] -= vc[i];
                    }
                    let p = across(along);
                    -crate::local::dot(&test, &dv)
                        - (1.0 + alpha) * self.scales[c] * crate::local::dot(&p, &load::<D>(r, c))
                }
                _ => -crate::local::dot(&test, &moved),
            }
        };
        self.dense.unknowns.iter().map(one).collect()
    }

    fn assemble_dense(&mut self, w: &Mat<f64>, alpha: f64) {
        let n = self.dense.unknowns.len();
        if self.dense.matrix.nrows() != n {
            self.dense.matrix = Mat::zeros(n, n);
        }
        let mut column = vec![0.0; w.nrows()];
        for (j, &(c, k)) in self.dense.unknowns.iter().enumerate() {
            let (c, k) = (c as usize, usize::from(k));
            let trial = self.modes[c].trial(k, self.problem.mu[c]);
            combine::<D>(w, c, &trial, &mut column);
            for i in 0..D {
                column[c * D + i] += alpha * self.scales[c] * trial[i];
            }
            let out = self.dense.matrix.col_as_slice_mut(j);
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
            if let (Mode::Slip { beta, .. }, 1) = (&self.modes[c], k) {
                out[j] += (1.0 - beta) * (1.0 + alpha) * self.scales[c];
            }
        }
    }
}

/// `e.r_t - mu r_n`.
fn slip_excess<const D: usize>(mu: f64, along: &Vector<D>, r: &Vector<D>) -> f64 {
    crate::local::dot(along, r) - mu * r[D - 1]
}

/// `out = W[:, c] x`.
fn combine<const D: usize>(w: &Mat<f64>, c: usize, x: &Vector<D>, out: &mut [f64]) {
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

fn solve_dense(matrix: &mut Mat<f64>, x: &mut [f64]) {
    let n = x.len();
    if n == 0 {
        return;
    }
    let (mut order, mut place) = (vec![0usize; n], vec![0usize; n]);
    let params = Default::default();
    let scratch =
        partial_pivoting::factor::lu_in_place_scratch::<usize, f64>(n, n, Par::Seq, params);
    let scratch =
        scratch.or(partial_pivoting::solve::solve_in_place_scratch::<usize, f64>(n, 1, Par::Seq));
    let mut memory = MemBuffer::new(scratch);
    let stack = MemStack::new(&mut memory);
    let (_, order) = partial_pivoting::factor::lu_in_place(
        matrix.as_mut(),
        &mut order,
        &mut place,
        Par::Seq,
        stack,
        params,
    );
    let right = faer::MatMut::from_column_major_slice_mut(x, n, 1);
    partial_pivoting::solve::solve_in_place(
        matrix.as_ref(),
        matrix.as_ref(),
        order,
        right,
        Par::Seq,
        stack,
    );
}

/// Newton's method on the problem itself (`alpha = 0`) with backtracking on the natural map: fast and, on hyperstatic
/// problems, unreliable. Kept for comparison.
pub(crate) fn newton<const D: usize>(
    truth: &Truth<'_>,
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
        x = backtrack(truth, &x, &dr);
        best.keep_better(&x);
    }
}

/// The first of `r + dr`, `r + dr/2`, .. that lowers the error, or the best of them.
pub(crate) fn backtrack(truth: &Truth<'_>, x: &Iterate, dr: &[f64]) -> Iterate {
    let mut trial = x.clone();
    let mut best: Option<Iterate> = None;
    let mut t = 1.0;
    for _ in 0..7 {
        for i in 0..dr.len() {
            trial.r[i] = x.r[i] + t * dr[i];
        }
        trial.refresh(truth);
        if trial.errors.scale_free < (1.0 - 0.1 * t) * x.errors.scale_free {
            return trial;
        }
        match &mut best {
            Some(b) if b.errors.scale_free <= trial.errors.scale_free => {}
            _ => best = Some(trial.clone()),
        }
        t *= 0.5;
    }
    best.unwrap_or(trial)
}
