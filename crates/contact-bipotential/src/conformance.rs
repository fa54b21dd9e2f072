//! Problems made by formula, and what any solver must do with them.
//!
//! For tests and benches of this crate and of others that bring a solver or a `W` of their own.

mod exact;
mod random;

pub use exact::exact_error;
pub use random::{Drawn, drawn_problem};

use faer::Mat;

use crate::cone::Cone;
use crate::delassus::{BlockSparse, Delassus};
use crate::error_measure::{ErrorMeasure, errors};
use crate::law::Status;
use crate::problem::ContactProblem;
use crate::solve::Outcome;

/// A rough, curved indenter pressed into an elastic half-space and dragged along: a full-rank `W`, as finite elements
/// make it.
///
/// `side * side` contacts on a square of side 1, shear modulus 1, Poisson's ratio .3, compliances of Boussinesq and
/// Cerruti, within a cell the mean over it. `depth` \[-\] is how far the indenter sinks at its centre, `drag` \[-\] how
/// far it moves.
#[must_use]
pub fn half_space(side: usize, mu: f64, depth: f64, drag: f64) -> ContactProblem {
    let n = side * side;
    let h = 1.0 / side as f64;
    let at = |c: usize| [(c % side) as f64 * h, (c / side) as f64 * h];
    let mut w = Mat::zeros(3 * n, 3 * n);
    let mut q = vec![0.0; 3 * n];
    for c in 0..n {
        let a = at(c);
        let (x, y) = (a[0] - 0.5, a[1] - 0.5);
        // Ripples keep contacts from opening and closing all together.
        let rough = 0.05 * depth * ((13.0 * a[0]).sin() + (17.0 * a[1]).cos());
        q[3 * c] = drag * (1.0 + 0.3 * y);
        q[3 * c + 1] = -0.3 * drag * x;
        q[3 * c + 2] = 4.0 * depth * (x * x + y * y) - depth + rough;
        for d in 0..n {
            let b = at(d);
            let block = half_space_compliance([a[0] - b[0], a[1] - b[1]], h);
            for i in 0..3 {
                for j in 0..3 {
                    w[(3 * c + i, 3 * d + j)] = block[i][j];
                }
            }
        }
    }
    ContactProblem {
        w: Delassus::Dense(w),
        q,
        mu: vec![mu; n],
        cone: Cone::Spatial,
    }
}

/// Displacement of the surface at distance `x` from a unit force, by components; within a cell, that of a uniform
/// patch.
fn half_space_compliance(x: [f64; 2], h: f64) -> [[f64; 3]; 3] {
    let nu = 0.3;
    let r = (x[0] * x[0] + x[1] * x[1]).sqrt();
    let c = 1.0 / (2.0 * std::f64::consts::PI);
    if r == 0.0 {
        // Mean over the disc with the area of the cell: 16 / (3 pi a), its directional part halved.
        let inverse = 16.0 / (3.0 * std::f64::consts::PI) / (h / std::f64::consts::PI.sqrt());
        let tangential = c * inverse * (1.0 - nu + 0.5 * nu);
        return [
            [tangential, 0.0, 0.0],
            [0.0, tangential, 0.0],
            [0.0, 0.0, c * inverse * (1.0 - nu)],
        ];
    }
    let e = [x[0] / r, x[1] / r];
    let coupling = 0.5 * c * (1.0 - 2.0 * nu) / r;
    let mut w = [[0.0; 3]; 3];
    for i in 0..2 {
        for j in 0..2 {
            w[i][j] = c / r * (f64::from(u8::from(i == j)) * (1.0 - nu) + nu * e[i] * e[j]);
        }
        w[i][2] = coupling * e[i];
        w[2][i] = -coupling * e[i];
    }
    w[2][2] = c / r * (1.0 - nu);
    w
}

/// A wall of rigid bricks, `rows` high and `columns` wide, eight contacts under each: hyperstatic.
///
/// Bricks 2 x 1 x 1 of mass 1 in stretcher bond. `W = H^T M^-1 H` has rank at most `6 rows columns`, a quarter of its
/// size; `push` is the sideways acceleration of the top row over gravity.
#[must_use]
pub fn brick_wall(rows: usize, columns: usize, mu: f64, push: f64) -> ContactProblem {
    let contacts = wall_contacts(rows, columns);
    let n = contacts.len();
    let mut blocks = Vec::new();
    for (c, a) in contacts.iter().enumerate() {
        for (d, b) in contacts.iter().enumerate() {
            blocks.extend(shared_compliance(a, b).map(|block| (c, d, block.concat())));
        }
    }
    let top = (rows * columns).saturating_sub(columns);
    let acceleration = |body: Option<usize>| match body {
        Some(b) => [if b >= top { push } else { 0.0 }, 0.0, -1.0],
        None => [0.0; 3],
    };
    let relative = |a: &WallContact| {
        let (upper, lower) = (acceleration(a.upper), acceleration(a.lower));
        [0, 1, 2].map(|i| upper[i] - lower[i])
    };
    let q = contacts.iter().flat_map(relative).collect();
    let w = match BlockSparse::from_blocks(n, 3, &blocks) {
        Ok(w) => Delassus::BlockSparse(w),
        Err(_) => Delassus::Dense(Mat::identity(3 * n, 3 * n)),
    };
    ContactProblem {
        w,
        q,
        mu: vec![mu; n],
        cone: Cone::Spatial,
    }
}

/// A contact of two bricks, or of a brick and the ground, with the lever arm on each in x, y (up), z.
struct WallContact {
    lower: Option<usize>,
    upper: Option<usize>,
    lower_arm: [f64; 3],
    upper_arm: [f64; 3],
}

fn wall_contacts(rows: usize, columns: usize) -> Vec<WallContact> {
    let centre = |row: usize, column: usize| 2.0 * column as f64 + (row % 2) as f64;
    let mut contacts = Vec::new();
    for row in 0..rows {
        for column in 0..columns {
            for half in [centre(row, column) - 0.5, centre(row, column) + 0.5] {
                let under = |r: usize| (0..columns).find(|k| (centre(r, *k) - half).abs() < 0.75);
                let below = row.checked_sub(1).and_then(|r| Some((r, under(r)?)));
                if row > 0 && below.is_none() {
                    continue;
                }
                for (x, z) in [(-0.45, -0.5), (-0.45, 0.5), (0.45, -0.5), (0.45, 0.5)] {
                    let x = half + x;
                    contacts.push(WallContact {
                        lower: below.map(|(r, k)| r * columns + k),
                        upper: Some(row * columns + column),
                        lower_arm: below.map_or([0.0; 3], |(r, k)| [x - centre(r, k), 0.5, z]),
                        upper_arm: [x - centre(row, column), -0.5, z],
                    });
                }
            }
        }
    }
    contacts
}

/// What a unit reaction at `b` does to the velocity at `a`, in the frame `(x, z, up)`; `None` without a common brick.
fn shared_compliance(a: &WallContact, b: &WallContact) -> Option<[[f64; 3]; 3]> {
    const AXES: [[f64; 3]; 3] = [[1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, 1.0, 0.0]];
    const INVERSE_MASS: [f64; 6] = [1.0, 1.0, 1.0, 6.0, 2.4, 2.4];
    let mut block = None;
    for (body_a, arm_a, sign_a) in [(a.lower, &a.lower_arm, -1.0), (a.upper, &a.upper_arm, 1.0)] {
        for (body_b, arm_b, sign_b) in [(b.lower, &b.lower_arm, -1.0), (b.upper, &b.upper_arm, 1.0)]
        {
            if body_a.is_none() || body_a != body_b {
                continue;
            }
            let sum = block.get_or_insert([[0.0; 3]; 3]);
            for i in 0..3 {
                for j in 0..3 {
                    let (f, g) = (wrench(arm_a, &AXES[i]), wrench(arm_b, &AXES[j]));
                    let product: f64 = (0..6).map(|k| f[k] * INVERSE_MASS[k] * g[k]).sum();
                    sum[i][j] += sign_a * sign_b * product;
                }
            }
        }
    }
    block
}

/// Force and moment of a unit force along `axis` at `arm`.
fn wrench(arm: &[f64; 3], axis: &[f64; 3]) -> [f64; 6] {
    let ([a, b, c], [x, y, z]) = (*arm, *axis);
    [x, y, z, b * z - c * y, c * x - a * z, a * y - b * x]
}

/// The same problem in other units: `W` times `factor_w`, `q` times `factor_q`.
#[must_use]
pub fn scaled(problem: &ContactProblem, factor_w: f64, factor_q: f64) -> ContactProblem {
    let mut w = problem.w.to_dense();
    for j in 0..w.ncols() {
        for x in w.col_as_slice_mut(j) {
            *x *= factor_w;
        }
    }
    let mut w = Delassus::Dense(w);
    if let Delassus::BlockSparse(_) = problem.w {
        w = w.compressed(problem.contacts(), problem.cone.dim());
    }
    let q = problem.q.iter().map(|x| x * factor_q).collect();
    ContactProblem {
        w,
        q,
        mu: problem.mu.clone(),
        cone: problem.cone,
    }
}

/// What any outcome must be, solved or not: finite, of the right length, and honest.
///
/// # Errors
/// What is wrong with it, in words.
pub fn check_outcome(
    problem: &ContactProblem,
    r: &[f64],
    outcome: &Outcome,
    tolerance: f64,
) -> Result<(), String> {
    if r.len() != problem.q.len() || outcome.u.len() != problem.q.len() {
        return Err(format!(
            "{} reactions and {} velocities for {} unknowns",
            r.len(),
            outcome.u.len(),
            problem.q.len()
        ));
    }
    if !r.iter().chain(&outcome.u).all(|x| x.is_finite())
        || !outcome.error.is_finite()
        || !outcome.error_scale_free.is_finite()
    {
        return Err("NaN or infinity".to_owned());
    }
    let measure = errors(problem, r);
    if outcome.is_converged() && measure.worst() > tolerance {
        return Err(format!("false success: {measure:?}"));
    }
    if !outcome.is_converged()
        && outcome.refusal.is_none()
        && outcome.diagnostics.len() != problem.contacts()
    {
        return Err(format!(
            "{} diagnostics for {} contacts",
            outcome.diagnostics.len(),
            problem.contacts()
        ));
    }
    Ok(())
}

/// The law, contact by contact, in words a mechanician would use, with tolerances relative to the largest reaction and
/// velocity.
///
/// # Errors
/// The first contact that breaks the law, and how.
pub fn check_law(problem: &ContactProblem, r: &[f64], tolerance: f64) -> Result<(), String> {
    let measure = ErrorMeasure::new(problem);
    let mut u = vec![0.0; r.len()];
    measure.velocity(r, &mut u);
    let d = problem.cone.dim();
    let largest = |v: &[f64]| v.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
    let (ru, uu) = (largest(r), largest(&u).max(largest(&problem.q)));
    for (c, diagnostic) in measure.diagnose(r, &u).iter().enumerate() {
        let (normal, gap) = (r[c * d + d - 1], u[c * d + d - 1]);
        let slip = (c * d..c * d + d - 1)
            .map(|i| u[i] * u[i])
            .sum::<f64>()
            .sqrt();
        let friction = (c * d..c * d + d - 1)
            .map(|i| r[i] * r[i])
            .sum::<f64>()
            .sqrt();
        let fail = |what: &str| {
            Err(format!(
                "contact {c} {what}: {diagnostic:?}, r_n {normal:e}, u_n {gap:e}, slip {slip:e}"
            ))
        };
        if diagnostic.penetration > tolerance * uu {
            return fail("penetrates");
        }
        if diagnostic.cone_slack < -tolerance * ru {
            return fail("leaves the cone");
        }
        if normal * gap.abs() > tolerance * ru * uu {
            return fail("pulls or pushes at a distance");
        }
        let limit = problem.mu[c] * normal - friction;
        if slip * limit.abs() > tolerance * ru * uu {
            return fail("slides below its friction limit");
        }
        if diagnostic.status == Status::Slip
            && slip * friction * (1.0 - diagnostic.misalignment.cos()) > tolerance * ru * uu
        {
            return fail("is not opposed by friction");
        }
    }
    Ok(())
}
