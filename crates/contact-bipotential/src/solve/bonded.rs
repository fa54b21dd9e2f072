//! Contact problems with bonds: friction sees the compliance that the bonds leave.
//!
//! For an intensity `beta` the bond is a spring `r~ = -D (x + shift)`, and `x = W r + q` with `r = rbar + r~` becomes
//! `x = Wt rbar + xt`, `Wt = (I + W D)^-1 W`, `xt = (I + W D)^-1 (q - W D shift)`: a problem without bonds. `beta` then solves
//! a scalar equation between 0 and 1 at each contact.

use faer::Mat;
use faer::linalg::solvers::Solve;

use crate::cone::Cone;
use crate::delassus::Delassus;
use crate::error::ContactError;
use crate::local::{Matrix, Vector, affine, load, local_axes, solve_small, spatial};
use crate::problem::ContactProblem;
use crate::rcc::BondStep;
use crate::solve::auto::LARGEST_ASSEMBLED;
use crate::solve::gauss_seidel::{Kernel, Sweeper};
use crate::solve::iterate::{Iterate, Work};
use crate::solve::sequence::SequenceSolver;
use crate::solve::single::SingleContact;
use crate::solve::{Method, Outcome, SolveSettings, finish, refused, solve};
use crate::truth::Truth;

/// Sweeps before the first Newton step.
const FEW: usize = 10;
/// Sweeps between two tries of Newton's method at most.
const LONGEST: usize = 500;
/// Rounds of so many sweeps, at whose pace the rest of them would not suffice, before the problem is given up.
const PATIENCE: usize = 2;
/// Rounds of frozen intensities before a method gives up.
const ROUNDS: usize = 200;
/// Evaluations for the intensity of one contact: bisection alone would need 50.
const EVALUATIONS: usize = 60;

/// Solves a problem with a bond at each contact; without bonds this is [`solve`].
///
/// `r` is the whole reaction, dry part and bond force, and `u` is the end position `(dx_t, x_n)` of the step that the bonds
/// know. [`Method::Auto`] takes semismooth Newton on all contacts together, with the tangent of the bonds, then sweeps with the
/// exact solution of each bonded contact; any other method solves problems with frozen intensities until these settle.
/// Success is claimed by the same errors as in [`solve`], taken from the dry part.
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
    if r.len() != size || !r.iter().all(|x| x.is_finite()) {
        r.clear();
        r.resize(size, 0.0);
    }
    if let Err(refusal) = check(problem, bonds) {
        r.fill(0.0);
        return refused(size, settings, refusal);
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
    w: &Mat<f64>,
    r: &mut [f64],
    settings: &SolveSettings,
) -> Outcome {
    if settings.method != Method::Auto {
        return settle::<D>(problem, bonds, w, r, settings);
    }
    let (mut newton, mut work) = (SequenceSolver::default(), Work::default());
    let truth = Truth::bonded(problem, bonds);
    let mut best = Iterate::new(&truth, r);
    let sweeper = Sweeper::<D>::bonded(problem, bonds, Kernel::Exact);
    let (tolerance, mut left) = (settings.tolerance, settings.max_iterations);
    // Far from the solution bonds look broken that are not: Newton's method starts from a few sweeps.
    let (mut round, mut hopeless) = (FEW, 0);
    while left > 0 && hopeless < PATIENCE && !best.is_within(tolerance) {
        let (before, sweeps) = (best.errors.worst(), round.min(left));
        sweeper.run_mixed(&truth, &mut best, tolerance, sweeps, &mut work);
        r.copy_from_slice(&best.r);
        work.newton_steps += newton
            .attempt::<D>(problem, bonds, w, r, settings)
            .work
            .newton_steps;
        best.keep_better(&Iterate::new(&truth, r));
        left -= sweeps;
        let after = best.errors.worst();
        let gain = (before / after).ln() * left as f64 / sweeps as f64;
        let too_slow = round == LONGEST && gain < (after / tolerance).ln();
        hopeless = if too_slow { hopeless + 1 } else { 0 };
        round = (10 * round).min(LONGEST);
    }
    finish(&truth, r, best, settings, Method::Newton, work)
}

/// Problems with frozen intensities, until these no longer change.
fn settle<const D: usize>(
    problem: &ContactProblem,
    bonds: &[BondStep],
    w: &Mat<f64>,
    r: &mut [f64],
    settings: &SolveSettings,
) -> Outcome {
    let truth = Truth::bonded(problem, bonds);
    let mut best = Iterate::new(&truth, r);
    let mut x = best.clone();
    let mut beta = intensities::<D>(bonds, &x.u);
    let (mut work, mut dry) = (Work::default(), Vec::new());
    let inside = SolveSettings {
        tolerance: 0.1 * settings.tolerance,
        ..*settings
    };
    for _ in 0..ROUNDS {
        if best.is_within(settings.tolerance) {
            break;
        }
        let eased = frozen(problem, bonds, w, &beta);
        let inner = solve(&eased, &mut dry, &inside);
        work.sweeps += inner.work.sweeps;
        work.newton_steps += inner.work.newton_steps;
        work.projections += inner.work.projections;
        for (c, bond) in bonds.iter().enumerate() {
            let at = bond_force::<D>(bond, beta[c], &load::<D>(&inner.u, c));
            for i in 0..D {
                x.r[c * D + i] = dry[c * D + i] + at[i];
            }
        }
        x.refresh(&truth);
        best.keep_better(&x);
        let next = intensities::<D>(bonds, &inner.u);
        for (beta, next) in beta.iter_mut().zip(next) {
            *beta += 0.7 * (next - *beta);
        }
    }
    finish(&truth, r, best, settings, settings.method, work)
}

fn intensities<const D: usize>(bonds: &[BondStep], u: &[f64]) -> Vec<f64> {
    let one = |(c, bond): (usize, &BondStep)| bond.intensity(&spatial(&load::<D>(u, c))).0;
    bonds.iter().enumerate().map(one).collect()
}

fn bond_force<const D: usize>(bond: &BondStep, beta: f64, u: &Vector<D>) -> Vector<D> {
    let ((d, shift), mut force) = (spring::<D>(bond, beta), [0.0; D]);
    for i in 0..D {
        force[i] = -d[i] * (u[i] + shift[i]);
    }
    force
}

fn spring<const D: usize>(bond: &BondStep, beta: f64) -> (Vector<D>, Vector<D>) {
    let (stiffness, offset) = bond.spring(beta);
    let (mut d, mut shift) = ([0.0; D], [0.0; D]);
    for (i, axis) in local_axes(D).iter().enumerate() {
        (d[i], shift[i]) = (stiffness[*axis], offset[*axis]);
    }
    (d, shift)
}

/// The problem that is left for the dry part when every bond keeps an intensity `beta` \[-\]: `Wt` and `xt`. `w` is the
/// `W` of `problem`, dense.
pub fn frozen(
    problem: &ContactProblem,
    bonds: &[BondStep],
    w: &Mat<f64>,
    beta: &[f64],
) -> ContactProblem {
    match problem.cone {
        Cone::Frictionless => frozen_with::<1>(problem, bonds, w, beta),
        Cone::Planar => frozen_with::<2>(problem, bonds, w, beta),
        Cone::Spatial => frozen_with::<3>(problem, bonds, w, beta),
    }
}

fn frozen_with<const D: usize>(
    problem: &ContactProblem,
    bonds: &[BondStep],
    w: &Mat<f64>,
    beta: &[f64],
) -> ContactProblem {
    let n = problem.q.len();
    let (mut d, mut load) = (vec![0.0; n], vec![0.0; n]);
    let mut mu = problem.mu.clone();
    for (c, bond) in bonds.iter().enumerate() {
        let (stiffness, shift) = spring::<D>(bond, beta[c]);
        mu[c] = bond.friction(mu[c], beta[c]);
        for i in 0..D {
            d[c * D + i] = stiffness[i];
            load[c * D + i] = -stiffness[i] * shift[i];
        }
    }
    let eased = Mat::from_fn(n, n, |i, j| w[(i, j)] * d[j] + f64::from(i == j));
    let moved = Mat::from_fn(n, 1, |i, _| {
        problem.q[i] + (0..n).map(|j| w[(i, j)] * load[j]).sum::<f64>()
    });
    let lu = eased.partial_piv_lu();
    ContactProblem {
        w: Delassus::Dense(lu.solve(w)),
        q: lu.solve(&moved).col_as_slice(0).to_vec(),
        mu,
        cone: problem.cone,
    }
}

/// The whole reaction of one bonded contact with `x = W r + b`: the exact solution for each intensity, and the intensity from
/// its scalar equation, whose root always lies in [0, 1].
pub(crate) fn bonded_contact<const D: usize>(
    w: &Matrix<D>,
    b: &Vector<D>,
    mu: f64,
    bond: &BondStep,
) -> Vector<D> {
    let at = |beta: f64| {
        let (d, shift) = spring::<D>(bond, beta);
        let (mut eased, mut moved, mut columns) = ([[0.0; D]; D], *b, [[0.0; D]; D]);
        for i in 0..D {
            for j in 0..D {
                eased[i][j] = w[i][j] * d[j] + f64::from(u8::from(i == j));
                moved[i] -= w[i][j] * d[j] * shift[j];
            }
        }
        let moved = solve_small(&eased, &moved).unwrap_or(moved);
        for j in 0..D {
            let mut column = [0.0; D];
            for i in 0..D {
                column[i] = w[i][j];
            }
            columns[j] = solve_small(&eased, &column).unwrap_or(column);
        }
        let mut compliance = [[0.0; D]; D];
        for i in 0..D {
            for j in 0..D {
                compliance[i][j] = columns[j][i];
            }
        }
        let dry = SingleContact::new(&compliance)
            .solve(&moved, bond.friction(mu, beta))
            .r;
        let x = affine(&compliance, &dry, &moved);
        let pull = bond_force::<D>(bond, beta, &x);
        let mut r = dry;
        for i in 0..D {
            r[i] += pull[i];
        }
        (bond.intensity(&spatial(&x)).0 - beta, r)
    };
    // Regula falsi with halved weights (Illinois), from the bracket [0, 1].
    let (mut low, mut high) = (0.0, 1.0);
    let ((mut g_low, mut r), (mut g_high, r_high)) = (at(low), at(high));
    if g_high >= 0.0 {
        return r_high;
    }
    for _ in 0..EVALUATIONS {
        if g_low <= 0.0 || high - low < 1e-15 {
            break;
        }
        let beta = (low * g_high - high * g_low) / (g_high - g_low);
        let (g, found) = at(beta.clamp(low, high));
        r = found;
        if g.abs() < 1e-15 {
            break;
        }
        if g > 0.0 {
            (low, g_low) = (beta, g);
            g_high *= 0.5;
        } else {
            (high, g_high) = (beta, g);
            g_low *= 0.5;
        }
    }
    r
}

#[cfg(test)]
mod tests;
