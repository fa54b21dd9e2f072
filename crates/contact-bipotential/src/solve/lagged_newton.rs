//! Semismooth Newton on dense problems, with or without bonds, whose factors stay in use.
//!
//! The Newton matrix of one step or one problem, factorised once, preconditions GMRES on the next: a few products with
//! `W` instead of a factorisation. Where that takes too long the factors are renewed. The matrix is that of the
//! semismooth Newton method with three rows a contact whatever its mode, in axes that do not turn with the slip, so
//! that it changes as little as possible.

use faer::Mat;

use crate::delassus::{DenseMatrix, dense_times};
use crate::error_measure::{Dry, ErrorMeasure};
use crate::local::{Matrix, Vector, load, local_axes, store};
use crate::solve::contact_mode::{Mode, across, slip_excess};
use crate::solve::dense_lu::DenseLu;
use crate::solve::gmres::gmres;
use crate::solve::iterate::Iterate;
use crate::solve::outcome::{SolveSettings, Work};

/// Newton steps before the general solver takes over.
const NEWTON_STEPS: usize = 25;
/// GMRES iterations after which the factors are renewed.
const KRYLOV_STEPS: usize = 20;
/// GMRES iterations that fresh factors would need too.
const FEW: usize = 3;
/// A factorisation costs about as much as one GMRES iteration for each so many rows: the factors are renewed when the
/// iterations beyond [`FEW`] have cost as much as new ones.
const ROWS_PER_ITERATION: usize = 60;
/// Relative residual of the linear system of a Newton step \[-\].
const FORCING: f64 = 1e-3;

/// Newton's method with a memory.
#[derive(Debug, Default)]
pub(crate) struct LaggedNewton {
    factor: Option<DenseLu>,
    /// GMRES iterations beyond [`FEW`] since the factors were made.
    excess: usize,
}

impl LaggedNewton {
    /// The best point met from the reactions `start` on. `w` is the `W` of the problem that `measure` belongs to.
    pub(crate) fn run<const D: usize>(
        &mut self,
        measure: &ErrorMeasure<'_>,
        w: &DenseMatrix,
        start: &[f64],
        settings: &SolveSettings,
        work: &mut Work,
    ) -> Iterate {
        let mut x = Iterate::new(measure, start);
        let mut best = x.clone();
        for _ in 0..NEWTON_STEPS.min(settings.max_iterations) {
            if best.is_within(settings.tolerance) {
                break;
            }
            work.newton_steps += 1;
            let system = System::<D>::new(measure, w, &x);
            let Some(dr) = self.step(&system) else { break };
            x = x.backtrack(measure, &dr);
            best.keep_better(&x);
        }
        best
    }

    /// The Newton step: by GMRES with the remembered factors, or with new ones.
    fn step<const D: usize>(&mut self, system: &System<'_, D>) -> Option<Vec<f64>> {
        let rhs = system.right_side();
        let worth_it = self.excess * ROWS_PER_ITERATION <= rhs.len();
        let kept = self.factor.as_ref();
        if let Some(factor) = kept.filter(|f| worth_it && f.size() == rhs.len())
            && let Some((dr, iterations)) = gmres(
                |r, v| system.apply(r, v),
                |x| factor.solve(x),
                &rhs,
                FORCING,
                KRYLOV_STEPS,
            )
        {
            self.excess += iterations.saturating_sub(FEW);
            return Some(dr);
        }
        self.excess = 0;
        let factor = self.factor.insert(DenseLu::new(system.matrix()));
        let mut dr = rhs;
        factor.solve(&mut dr);
        dr.iter().all(|x| x.is_finite()).then_some(dr)
    }
}

/// The linear system of a Newton step with all rows of all contacts.
struct System<'a, const D: usize> {
    w: &'a DenseMatrix,
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
    fn new(measure: &'a ErrorMeasure<'_>, w: &'a DenseMatrix, x: &'a Iterate) -> Self {
        let (scales, count) = (measure.scales(), measure.scales().len());
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
            let dry = measure.dry(c, &load::<D>(&x.r, c), &u);
            system.modes.push(Mode::of(dry.mu, scales[c], &dry.r, &u));
            system.mu.push(dry.mu);
            system.dry.push(dry.r);
            if !measure.bonds().is_empty() {
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
        let mut out = self.dry_rows(c, &(bond.stiffness * v + r), v);
        if let Mode::Slip { along, .. } = &self.modes[c] {
            let limit = self.scales[c] * self.dry[c][D - 1] * bond.friction.dot(v);
            out -= along * limit;
        }
        out
    }

    /// The same, with the change of the part of `r` that the law governs.
    #[inline(always)]
    fn dry_rows(&self, c: usize, r: &Vector<D>, v: &Vector<D>) -> Vector<D> {
        let scale = self.scales[c];
        match &self.modes[c] {
            Mode::Free => r * scale,
            Mode::Stick => *v,
            Mode::Slip { along, beta } => {
                let p = across(along);
                let excess = scale * slip_excess(self.mu[c], along, r);
                let sideways = beta * p.dot(v) + (1.0 - beta) * scale * p.dot(r);
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
                let (is, wanted) = (p.dot(&out), self.scales[c] * p.dot(&r));
                out += p * (wanted - is);
            }
            store(&mut b, c, &-out);
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
                let mut unit = Vector::zeros();
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
        let (mut stiffness, mut friction) = (Matrix::zeros(), Vector::zeros());
        for (i, a) in local_axes(D).iter().enumerate() {
            friction[i] = dry.mu_slope * dry.bond.intensity_slope[*a];
            for (j, b) in local_axes(D).iter().enumerate() {
                stiffness[(i, j)] = dry.bond.stiffness[(*a, *b)];
            }
        }
        BondTangent {
            stiffness,
            friction,
        }
    }
}
