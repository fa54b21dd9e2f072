//! Contact problems with bonds: friction sees the compliance that the bonds leave.
//!
//! For an intensity `beta` the bond is a spring `r~ = -D (x + shift)`, and `x = W r + q` with `r = rbar + r~` becomes
//! `x = Wt rbar + xt`, `Wt = (I + W D)^-1 W`, `xt = (I + W D)^-1 (q - W D shift)`: a problem without bonds. `beta` then
//! solves a scalar equation between 0 and 1 at each contact.

use faer::Mat;

use crate::cone::Cone;
use crate::delassus::{Delassus, DenseMatrix};
use crate::error::ContactError;
use crate::error_measure::ErrorMeasure;
use crate::local::{load, spatial, store};
use crate::problem::ContactProblem;
use crate::rcc::BondStep;
use crate::solve::bonded_contact::{bond_force, spring};
use crate::solve::dense_lu::DenseLu;
use crate::solve::gauss_seidel::{Kernel, Sweeper};
use crate::solve::iterate::Iterate;
use crate::solve::lagged_newton::LaggedNewton;
use crate::solve::outcome::{Method, Outcome, SolveSettings, Work};
use crate::solve::{LARGEST_ASSEMBLED, solve, start_or_zero};

/// Sweeps before the first Newton step.
const FEW: usize = 10;
/// Sweeps between two tries of Newton's method at most.
const LONGEST: usize = 500;
/// Rounds of so many sweeps, at whose pace the rest of them would not suffice, before the problem is given up.
const PATIENCE: usize = 2;
/// Factor on the sweeps of a round.
const GROWTH: usize = 10;
/// Rounds of frozen intensities before a method gives up.
const ROUNDS: usize = 200;
/// Tolerance of a problem with frozen intensities over that of the whole \[-\].
const INSIDE: f64 = 0.1;
/// Part of the change of the intensities that a round takes \[-\]: the whole of it may swing.
const RELAXATION: f64 = 0.7;

/// Solves a problem with a bond at each contact; without bonds this is [`solve`].
///
/// `r` is the whole reaction, dry part and bond force, and `u` is the end position `(dx_t, x_n)` of the step that the
/// bonds know. [`Method::Auto`] takes semismooth Newton on all contacts together, with the tangent of the bonds, then
/// sweeps with the exact solution of each bonded contact; any other method solves problems with frozen intensities
/// until these settle. Success is claimed by the same errors as in [`solve`], taken from the dry part.
pub fn solve_bonded(
    problem: &ContactProblem,
    bonds: &[BondStep],
    r: &mut Vec<f64>,
    settings: &SolveSettings,
) -> Outcome {
    if bonds.is_empty() {
        return solve(problem, r, settings);
    }
    let size = problem.q.len();
    start_or_zero(r, size);
    if let Err(refusal) = check(problem, bonds) {
        r.fill(0.0);
        return Outcome::refused(size, settings.method, refusal);
    }
    let w = problem.w.to_dense();
    match problem.cone {
        Cone::Frictionless => run::<1>(problem, bonds, &w, r, settings),
        Cone::Planar => run::<2>(problem, bonds, &w, r, settings),
        Cone::Spatial => run::<3>(problem, bonds, &w, r, settings),
    }
}

fn check(problem: &ContactProblem, bonds: &[BondStep]) -> Result<(), ContactError> {
    problem.check()?;
    let contacts = problem.contacts();
    let length = |what, found, expected| {
        Err(ContactError::Length {
            what,
            contacts,
            found,
            expected,
        })
    };
    if bonds.len() != contacts {
        return length("bonds", bonds.len(), contacts);
    }
    if problem.q.len() > LARGEST_ASSEMBLED {
        return length(
            "W of bonded contacts (at most)",
            problem.q.len(),
            LARGEST_ASSEMBLED,
        );
    }
    Ok(())
}

fn run<const D: usize>(
    problem: &ContactProblem,
    bonds: &[BondStep],
    w: &DenseMatrix,
    r: &mut [f64],
    settings: &SolveSettings,
) -> Outcome {
    if settings.method != Method::Auto {
        return settle::<D>(problem, bonds, w, r, settings);
    }
    let (mut newton, mut work) = (LaggedNewton::default(), Work::default());
    let measure = ErrorMeasure::bonded(problem, bonds);
    let mut best = Iterate::new(&measure, r);
    let sweeper = Sweeper::<D>::bonded(problem, bonds, Kernel::Exact);
    let (tolerance, mut left) = (settings.tolerance, settings.max_iterations);
    // Far from the solution bonds look broken that are not: Newton's method starts from a few sweeps.
    let (mut round, mut hopeless) = (FEW, 0);
    while left > 0 && hopeless < PATIENCE && !best.is_within(tolerance) {
        let (before, sweeps) = (best.errors.worst(), round.min(left));
        sweeper.run_accelerated(&measure, &mut best, tolerance, sweeps, &mut work);
        let start = best.r.clone();
        let found = newton.run::<D>(&measure, w, &start, settings, &mut work);
        best.keep_better(&found);
        left -= sweeps;
        let after = best.errors.worst();
        let gain = (before / after).ln() * left as f64 / sweeps as f64;
        let too_slow = round == LONGEST && gain < (after / tolerance).ln();
        hopeless = if too_slow { hopeless + 1 } else { 0 };
        round = (GROWTH * round).min(LONGEST);
    }
    Outcome::of_best(&measure, best, r, tolerance, Method::Newton, work)
}

/// Problems with frozen intensities, until these no longer change.
fn settle<const D: usize>(
    problem: &ContactProblem,
    bonds: &[BondStep],
    w: &DenseMatrix,
    r: &mut [f64],
    settings: &SolveSettings,
) -> Outcome {
    let measure = ErrorMeasure::bonded(problem, bonds);
    let mut best = Iterate::new(&measure, r);
    let mut x = best.clone();
    let mut beta = intensities::<D>(bonds, &x.u);
    let (mut work, mut dry) = (Work::default(), Vec::new());
    let inside = settings.with_tolerance(INSIDE * settings.tolerance);
    for _ in 0..ROUNDS {
        if best.is_within(settings.tolerance) {
            break;
        }
        let inner = solve(&freeze_bonds(problem, bonds, w, &beta), &mut dry, &inside);
        work.add(&inner.work);
        for (c, bond) in bonds.iter().enumerate() {
            let force = bond_force::<D>(bond, beta[c], &load(&inner.u, c));
            store(&mut x.r, c, &(load::<D>(&dry, c) + force));
        }
        x.refresh(&measure);
        best.keep_better(&x);
        let next = intensities::<D>(bonds, &inner.u);
        for (beta, next) in beta.iter_mut().zip(next) {
            *beta += RELAXATION * (next - *beta);
        }
    }
    let (tolerance, method) = (settings.tolerance, settings.method);
    Outcome::of_best(&measure, best, r, tolerance, method, work)
}

fn intensities<const D: usize>(bonds: &[BondStep], u: &[f64]) -> Vec<f64> {
    let one = |(c, bond): (usize, &BondStep)| bond.intensity(&spatial(&load::<D>(u, c))).0;
    bonds.iter().enumerate().map(one).collect()
}

/// The problem that is left for the dry part when every bond keeps an intensity `beta` \[-\]: `Wt` and `xt`. `w` is the
/// `W` of `problem`, dense; `bonds` and `beta` hold one entry a contact.
#[must_use]
pub fn freeze_bonds(
    problem: &ContactProblem,
    bonds: &[BondStep],
    w: &DenseMatrix,
    beta: &[f64],
) -> ContactProblem {
    match problem.cone {
        Cone::Frictionless => freeze::<1>(problem, bonds, w, beta),
        Cone::Planar => freeze::<2>(problem, bonds, w, beta),
        Cone::Spatial => freeze::<3>(problem, bonds, w, beta),
    }
}

fn freeze<const D: usize>(
    problem: &ContactProblem,
    bonds: &[BondStep],
    w: &DenseMatrix,
    beta: &[f64],
) -> ContactProblem {
    let n = problem.q.len();
    let (mut d, mut force) = (vec![0.0; n], vec![0.0; n]);
    let mut mu = problem.mu.clone();
    for (c, bond) in bonds.iter().enumerate() {
        let (stiffness, shift) = spring::<D>(bond, beta[c]);
        mu[c] = bond.friction(mu[c], beta[c]);
        store(&mut d, c, &stiffness);
        store(&mut force, c, &-stiffness.component_mul(&shift));
    }
    let moved = |i: usize| problem.q[i] + (0..n).map(|j| w[(i, j)] * force[j]).sum::<f64>();
    let mut q: Vec<f64> = (0..n).map(moved).collect();
    let mut softened = w.clone();
    let lu = DenseLu::new(Mat::from_fn(n, n, |i, j| {
        w[(i, j)] * d[j] + f64::from(u8::from(i == j))
    }));
    lu.solve_columns(&mut softened);
    lu.solve(&mut q);
    ContactProblem::unchecked(Delassus::Dense(softened), q, mu, problem.cone)
}

#[cfg(test)]
mod tests;
