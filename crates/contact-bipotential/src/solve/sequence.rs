//! Newton's method for a sequence of similar dense problems: the factors of an earlier Newton matrix stay in use.
//!
//! A time stepper solves problem after problem whose `W`, modes and slip directions differ little. The Newton matrix of one
//! of them, factorised once, preconditions GMRES on the next: a few products with `W` instead of a factorisation. Where
//! that takes too long the factors are renewed. The matrix is that of the semismooth Newton method with three rows a contact
//! whatever its mode, in axes that do not turn with the slip, so that it changes as little as possible.

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::lu::partial_pivoting;
use faer::perm::PermRef;
use faer::{Mat, MatMut, Par};

use crate::cone::Cone;
use crate::delassus::{Delassus, dense_times};
use crate::local::{Matrix, Vector, affine, dot, load, local_axes, store};
use crate::problem::ContactProblem;
use crate::rcc::BondStep;
use crate::solve::iterate::{Iterate, Work};
use crate::solve::newton::{Mode, across, backtrack};
use crate::solve::{Method, Outcome, SolveSettings, finish, solve_bonded};
use crate::truth::{Dry, Truth};

/// Problems with fewer rows are not worth the memory: their factorisation is cheap.
const SMALLEST: usize = 90;
/// Newton steps before the general solver takes over.
const NEWTON_STEPS: usize = 25;
/// GMRES iterations after which the factors are renewed.
const KRYLOV_STEPS: usize = 20;
/// GMRES iterations that fresh factors would need too.
const FEW: usize = 3;
/// A factorisation costs about as much as one GMRES iteration for each so many rows: the factors are renewed when the
/// iterations beyond [`FEW`] have cost as much as new ones.
const ROWS_PER_ITERATION: usize = 60;
/// Relative residual of the linear system of a Newton step.
const FORCING: f64 = 1e-3;

/// A solver with a memory: results do not depend on what it remembers beyond the tolerance, times do.
#[derive(Debug, Default)]
pub struct SequenceSolver {
    factor: Option<Factor>,
    /// GMRES iterations beyond [`FEW`] since the factors were made.
    excess: usize,
}

impl SequenceSolver {
    /// As [`solve_bonded`]; [`Method::Auto`] tries Newton's method with the remembered factors first.
    pub fn solve(
        &mut self,
        problem: &ContactProblem,
        bonds: &[BondStep],
        r: &mut Vec<f64>,
        settings: &SolveSettings,
    ) -> Outcome {
        let pays = r.len() >= SMALLEST || !bonds.is_empty();
        let sized = r.len() == problem.q.len() && pays && r.iter().all(|x| x.is_finite());
        let Delassus::Dense(w) = &problem.w else {
            return solve_bonded(problem, bonds, r, settings);
        };
        if !sized || settings.method != Method::Auto || problem.check().is_err() {
            return solve_bonded(problem, bonds, r, settings);
        }
        let mut attempt = |r: &mut [f64]| match problem.cone {
            Cone::Frictionless => self.attempt::<1>(problem, bonds, w, r, settings),
            Cone::Planar => self.attempt::<2>(problem, bonds, w, r, settings),
            Cone::Spatial => self.attempt::<3>(problem, bonds, w, r, settings),
        };
        let outcome = attempt(r);
        if outcome.is_converged() {
            return outcome;
        }
        let mut rest = solve_bonded(problem, bonds, r, settings);
        rest.iterations += outcome.iterations;
        rest
    }

    pub(super) fn attempt<const D: usize>(
        &mut self,
        problem: &ContactProblem,
        bonds: &[BondStep],
        w: &Mat<f64>,
        r: &mut [f64],
        settings: &SolveSettings,
    ) -> Outcome {
        let truth = Truth::bonded(problem, bonds);
        let mut x = Iterate::new(&truth, r);
        let mut best = x.clone();
        let mut work = Work::default();
        while !best.is_within(settings.tolerance)
            && work.newton_steps < NEWTON_STEPS.min(settings.max_iterations)
        {
            work.newton_steps += 1;
            let system = System::<D>::new(&truth, w, &x);
            let Some(dr) = self.step(&system) else { break };
            x = backtrack(&truth, &x, &dr);
            best.keep_better(&x);
        }
        finish(&truth, r, best, settings, Method::Newton, work)
    }

    /// The Newton step: by GMRES with the remembered factors, or with new ones.
    fn step<const D: usize>(&mut self, system: &System<'_, D>) -> Option<Vec<f64>> {
        let rhs = system.right_side();
        let worth_it = self.excess * ROWS_PER_ITERATION <= rhs.len();
        if let Some(factor) = self
            .factor
            .as_ref()
            .filter(|f| worth_it && f.size() == rhs.len())
            && let Some((dr, iterations)) = gmres(system, factor, &rhs)
        {
            self.excess += iterations.saturating_sub(FEW);
            return Some(dr);
        }
        self.excess = 0;
        let factor = self.factor.insert(Factor::new(system.matrix()));
        let mut dr = rhs;
        factor.solve(&mut dr);
        dr.iter().all(|x| x.is_finite()).then_some(dr)
    }
}

/// The linear system of a Newton step with all rows of all contacts.
struct System<'a, const D: usize> {
    w: &'a Mat<f64>,
    scales: &'a [f64],
    modes: Vec<Mode<D>>,
    /// Friction coefficient and the part of the reaction that the law governs.
    mu: Vec<f64>,
    dry: Vec<Vector<D>>,
    /// What the bonds add per change of `u`; empty without bonds.
    bonds: Vec<BondTangent<D>>,
    x: &'a Iterate,
}

impl<'a, const D: usize> System<'a, D> {
    fn new(truth: &'a Truth<'_>, w: &'a Mat<f64>, x: &'a Iterate) -> Self {
        let (scales, count) = (truth.scales(), truth.scales().len());
        let mut system = System {
            w,
            scales,
            modes: Vec::with_capacity(count),
            mu: Vec::with_capacity(count),
            dry: Vec::with_capacity(count),
            bonds: Vec::new(),
            x,
        };
        for c in 0..count {
            let u = load::<D>(&x.u, c);
            let dry = truth.dry(c, &load::<D>(&x.r, c), &u);
            system.modes.push(Mode::of(dry.mu, scales[c], &dry.r, &u));
            system.mu.push(dry.mu);
            system.dry.push(dry.r);
            if !truth.bonds().is_empty() {
                system.bonds.push(BondTangent::new(&dry));
            }
        }
        system
    }

    /// The rows of contact `c` applied to the change of its own `r` and to the velocity `v` that all changes make.
    #[inline(always)]
    fn rows(&self, c: usize, r: &Vector<D>, v: &Vector<D>) -> Vector<D> {
        let Some(bond) = self.bonds.get(c) else {
            return self.dry_rows(c, r, v);
        };
        let mut out = self.dry_rows(c, &affine(&bond.stiffness, v, r), v);
        if let Mode::Slip { along, .. } = &self.modes[c] {
            let limit = self.scales[c] * self.dry[c][D - 1] * dot(&bond.friction, v);
            for i in 0..D - 1 {
                out[i] -= along[i] * limit;
            }
        }
        out
    }

    /// The same, with the change of the part of `r` that the law governs.
    #[inline(always)]
    fn dry_rows(&self, c: usize, r: &Vector<D>, v: &Vector<D>) -> Vector<D> {
        let scale = self.scales[c];
        match &self.modes[c] {
            Mode::Free => r.map(|x| scale * x),
            Mode::Stick => *v,
            Mode::Slip { along, beta } => {
                let p = across(along);
                let excess = scale * (dot(along, r) - self.mu[c] * r[D - 1]);
                let sideways = beta * dot(&p, v) + (1.0 - beta) * scale * dot(&p, r);
                let mut out = *v;
                for i in 0..D - 1 {
                    out[i] = along[i] * excess + p[i] * sideways;
                }
                out
            }
        }
    }

    fn apply(&self, r: &[f64], v: &mut [f64]) {
        dense_times(self.w, r, v);
        for c in 0..self.modes.len() {
            let out = self.rows(c, &load::<D>(r, c), &load::<D>(v, c));
            store(v, c, &out);
        }
    }

    fn right_side(&self) -> Vec<f64> {
        let mut b = vec![0.0; self.x.r.len()];
        for (c, mode) in self.modes.iter().enumerate() {
            let (r, u) = (self.dry[c], load::<D>(&self.x.u, c));
            let mut out = self.dry_rows(c, &r, &u);
            if let Mode::Slip { along, .. } = mode {
                // Across the slip the equation reads `beta p.dv + (1 - beta) w p.dr = -w p.r`.
                let p = across(along);
                let (is, wanted) = (dot(&p, &out), self.scales[c] * dot(&p, &r));
                for i in 0..D - 1 {
                    out[i] += p[i] * (wanted - is);
                }
            }
            store(&mut b, c, &out.map(|x| -x));
        }
        b
    }

    fn matrix(&self) -> Mat<f64> {
        let n = self.x.r.len();
        let mut matrix = Mat::zeros(n, n);
        for j in 0..n {
            let column = self.w.col_as_slice(j);
            let out = matrix.col_as_slice_mut(j);
            for c in 0..self.modes.len() {
                let mut unit = [0.0; D];
                if c == j / D {
                    unit[j % D] = 1.0;
                }
                store(out, c, &self.rows(c, &unit, &load::<D>(column, c)));
            }
        }
        matrix
    }
}

/// Change of what the law governs, per change of `u`.
struct BondTangent<const D: usize> {
    /// Of the dry part of the reaction: what the bond lets go.
    stiffness: Matrix<D>,
    /// Of the friction coefficient.
    friction: Vector<D>,
}

impl<const D: usize> BondTangent<D> {
    fn new(dry: &Dry<D>) -> Self {
        let (mut stiffness, mut friction) = ([[0.0; D]; D], [0.0; D]);
        for (i, a) in local_axes(D).iter().enumerate() {
            friction[i] = dry.mu_slope * dry.bond.intensity_slope[*a];
            for (j, b) in local_axes(D).iter().enumerate() {
                stiffness[i][j] = dry.bond.stiffness[*a][*b];
            }
        }
        BondTangent {
            stiffness,
            friction,
        }
    }
}

/// Factors `P A = L U`.
#[derive(Debug)]
struct Factor {
    lu: Mat<f64>,
    order: Vec<usize>,
    place: Vec<usize>,
}

impl Factor {
    fn new(mut lu: Mat<f64>) -> Self {
        let n = lu.nrows();
        let (mut order, mut place) = (vec![0; n], vec![0; n]);
        let params = Default::default();
        let scratch =
            partial_pivoting::factor::lu_in_place_scratch::<usize, f64>(n, n, Par::Seq, params);
        let mut memory = MemBuffer::new(scratch);
        let stack = MemStack::new(&mut memory);
        partial_pivoting::factor::lu_in_place(
            lu.as_mut(),
            &mut order,
            &mut place,
            Par::Seq,
            stack,
            params,
        );
        Factor { lu, order, place }
    }

    fn size(&self) -> usize {
        self.order.len()
    }

    fn solve(&self, x: &mut [f64]) {
        let n = self.size();
        let scratch = partial_pivoting::solve::solve_in_place_scratch::<usize, f64>(n, 1, Par::Seq);
        let mut memory = MemBuffer::new(scratch);
        let order = PermRef::new_checked(&self.order, &self.place, n);
        let right = MatMut::from_column_major_slice_mut(x, n, 1);
        let stack = MemStack::new(&mut memory);
        partial_pivoting::solve::solve_in_place(
            self.lu.as_ref(),
            self.lu.as_ref(),
            order,
            right,
            Par::Seq,
            stack,
        );
    }
}

/// GMRES with the factors on the right; `None` if it does not reach the forcing term soon.
fn gmres<const D: usize>(
    system: &System<'_, D>,
    factor: &Factor,
    rhs: &[f64],
) -> Option<(Vec<f64>, usize)> {
    let norm = length(rhs);
    if norm == 0.0 || !norm.is_finite() {
        return None;
    }
    let mut basis = vec![rhs.iter().map(|x| x / norm).collect::<Vec<f64>>()];
    let mut reduced = Hessenberg::new(norm);
    for k in 0..KRYLOV_STEPS {
        let mut direction = basis[k].clone();
        factor.solve(&mut direction);
        let mut image = vec![0.0; direction.len()];
        system.apply(&direction, &mut image);
        let mut column = Vec::with_capacity(k + 2);
        for q in &basis {
            let h: f64 = q.iter().zip(&image).map(|(a, b)| a * b).sum();
            image.iter_mut().zip(q).for_each(|(x, q)| *x -= h * q);
            column.push(h);
        }
        let rest = length(&image);
        column.push(rest);
        let residual = reduced.push(column);
        if !residual.is_finite() {
            return None;
        }
        if residual <= FORCING * norm || rest == 0.0 {
            let weights = reduced.solve();
            let mut sum = vec![0.0; rhs.len()];
            for (q, y) in basis.iter().zip(&weights) {
                sum.iter_mut().zip(q).for_each(|(s, q)| *s += y * q);
            }
            factor.solve(&mut sum);
            return sum.iter().all(|x| x.is_finite()).then_some((sum, k + 1));
        }
        basis.push(image.iter().map(|x| x / rest).collect());
    }
    None
}

/// The small least-squares problem of GMRES, triangular by Givens rotations.
struct Hessenberg {
    columns: Vec<Vec<f64>>,
    rotations: Vec<(f64, f64)>,
    right: Vec<f64>,
}

impl Hessenberg {
    fn new(norm: f64) -> Self {
        Hessenberg {
            columns: Vec::new(),
            rotations: Vec::new(),
            right: vec![norm],
        }
    }

    /// Adds a column and returns the norm of the residual.
    fn push(&mut self, mut column: Vec<f64>) -> f64 {
        let k = self.columns.len();
        for (i, (c, s)) in self.rotations.iter().enumerate() {
            (column[i], column[i + 1]) = (
                c * column[i] + s * column[i + 1],
                c * column[i + 1] - s * column[i],
            );
        }
        let size = column[k].hypot(column[k + 1]);
        let (c, s) = if size > 0.0 {
            (column[k] / size, column[k + 1] / size)
        } else {
            (1.0, 0.0)
        };
        column[k] = size;
        column.truncate(k + 1);
        let last = self.right[k];
        self.right[k] = c * last;
        self.right.push(-s * last);
        self.rotations.push((c, s));
        self.columns.push(column);
        self.right[k + 1].abs()
    }

    fn solve(&self) -> Vec<f64> {
        let n = self.columns.len();
        let mut y = self.right[..n].to_vec();
        for k in (0..n).rev() {
            y[k] /= self.columns[k][k];
            for i in 0..k {
                y[i] -= self.columns[k][i] * y[k];
            }
        }
        y
    }
}

fn length(x: &[f64]) -> f64 {
    x.iter().map(|v| v * v).sum::<f64>().sqrt()
}
