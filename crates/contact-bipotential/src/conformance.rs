//! Problems made by formula, and what any solver must do with them.
//!
//! For tests and benches of this crate and of others that bring a solver or a `W` of their own.

use faer::Mat;

use crate::cone::Cone;
use crate::delassus::{BlockSparse, Delassus};
use crate::law::Status;
use crate::problem::ContactProblem;
use crate::solve::Outcome;
use crate::truth::{Truth, errors};

/// A rough, curved indenter pressed into an elastic half-space and dragged along: a full-rank `W`, as finite elements make it.
///
/// `side * side` contacts on a square of side 1, shear modulus 1, Poisson's ratio .3, compliances of Boussinesq and Cerruti
/// [Johnson1985, eq. 3.19, 3.75]. `depth` [-] is how far the indenter sinks at its centre, `drag` [-] how far it moves.
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
    ContactProblem { w: Delassus::Dense(w), q, mu: vec![mu; n], cone: Cone::Spatial }
}

/// Displacement of the surface at distance `x` from a unit force, by components; within a cell, that of a uniform patch.
fn half_space_compliance(x: [f64; 2], h: f64) -> [[f64; 3]; 3] {
    let nu = 0.3;
    let r = (x[0] * x[0] + x[1] * x[1]).sqrt();
    let c = 1.0 / (2.0 * std::f64::consts::PI);
    if r == 0.0 {
        // Mean over the disc with the area of the cell: 16 / (3 pi a), its directional part halved.
        let inverse = 16.0 / (3.0 * std::f64::consts::PI) / (h / std::f64::consts::PI.sqrt());
        let tangential = c * inverse * (1.0 - nu + 0.5 * nu);
        return [[tangential, 0.0, 0.0], [0.0, tangential, 0.0], [0.0, 0.0, c * inverse * (1.0 - nu)]];
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

/// A wall of rigid bricks, `rows` high and `columns` wide, four contacts a bed joint, pushed sideways at the top: hyperstatic.
///
/// `W = H^T M^-1 H` has rank at most `6 rows columns`, less than its size `3 * 8 * ..`; `push` is the sideways acceleration of
/// the top row over gravity.
pub fn brick_wall(rows: usize, columns: usize, mu: f64, push: f64) -> ContactProblem {
    let size = [2.0, 1.0, 1.0];
    // Contacts: (lower brick or none, upper brick, lever arms, in x y z).
    let mut contacts: Vec<(Option<usize>, usize, [f64; 3], [f64; 3])> = Vec::new();
    let centre = |row: usize, column: usize| 2.0 * column as f64 + (row % 2) as f64;
    for row in 0..rows {
        for column in 0..columns {
            let upper = row * columns + column;
            for side in [-0.5, 0.5] {
                let half = centre(row, column) + side * size[0] / 2.0 * 2.0 - side;
                let below = row.checked_sub(1).and_then(|r| (0..columns).find(|k| (centre(r, *k) - half).abs() < 0.75).map(|k| (r, k)));
                if row > 0 && below.is_none() {
                    continue;
                }
                for x in [half - 0.45, half + 0.45] {
                    for z in [-0.5, 0.5] {
                        let up = [x - centre(row, column), -0.5, z];
                        let low = below.map_or([0.0; 3], |(r, k)| [x - centre(r, k), 0.5, z]);
                        contacts.push((below.map(|(r, k)| r * columns + k), upper, low, up));
                    }
                }
            }
        }
    }
    wall_problem(&contacts, rows * columns, columns, mu, push)
}

type WallContact = (Option<usize>, usize, [f64; 3], [f64; 3]);

fn wall_problem(contacts: &[WallContact], bricks: usize, columns: usize, mu: f64, push: f64) -> ContactProblem {
    // Unit mass, inertia of the 2 x 1 x 1 brick; frame (t1, t2, n) = (x, z, y).
    let inertia = [2.0 / 12.0, 5.0 / 12.0, 5.0 / 12.0];
    let axes = [[1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, 1.0, 0.0]];
    let row = |arm: &[f64; 3], axis: &[f64; 3]| {
        let [a, b, c] = *arm;
        let [x, y, z] = *axis;
        [x, y, z, b * z - c * y, c * x - a * z, a * y - b * x]
    };
    let inverse = [1.0, 1.0, 1.0, 1.0 / inertia[0], 1.0 / inertia[1], 1.0 / inertia[2]];
    let mut blocks = Vec::new();
    let mut q = Vec::new();
    for (c, a) in contacts.iter().enumerate() {
        for (d, b) in contacts.iter().enumerate() {
            let mut block = vec![0.0; 9];
            let mut shared = false;
            for (body_a, arm_a, sign_a) in [(a.0, &a.2, -1.0), (Some(a.1), &a.3, 1.0)] {
                for (body_b, arm_b, sign_b) in [(b.0, &b.2, -1.0), (Some(b.1), &b.3, 1.0)] {
                    if body_a.is_none() || body_a != body_b {
                        continue;
                    }
                    shared = true;
                    for i in 0..3 {
                        for j in 0..3 {
                            let (f, g) = (row(arm_a, &axes[i]), row(arm_b, &axes[j]));
                            block[3 * i + j] += sign_a * sign_b * (0..6).map(|k| f[k] * inverse[k] * g[k]).sum::<f64>();
                        }
                    }
                }
            }
            if shared {
                blocks.push((c, d, block));
            }
        }
        let acceleration = |body: Option<usize>| {
            let side = if body.is_some_and(|b| b + columns >= bricks) { push } else { 0.0 };
            let down = if body.is_some() { -1.0 } else { 0.0 };
            [side, 0.0, down]
        };
        let (low, up) = (acceleration(a.0), acceleration(Some(a.1)));
        q.extend((0..3).map(|i| up[i] - low[i]));
    }
    let n = contacts.len();
    let w = BlockSparse::from_blocks(n, 3, &blocks).map_or_else(|_| Delassus::Dense(Mat::identity(3 * n, 3 * n)), Delassus::BlockSparse);
    ContactProblem { w, q, mu: vec![mu; n], cone: Cone::Spatial }
}

/// The same problem in other units: `W` times `factor_w`, `q` times `factor_q`.
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
    ContactProblem { w, q, mu: problem.mu.clone(), cone: problem.cone }
}

/// What any outcome must be, solved or not: finite, of the right length, and honest.
///
/// # Errors
/// What is wrong with it, in words.
pub fn check_outcome(problem: &ContactProblem, r: &[f64], outcome: &Outcome, tolerance: f64) -> Result<(), String> {
    if r.len() != problem.q.len() || outcome.u.len() != problem.q.len() {
        return Err(format!("{} reactions and {} velocities for {} unknowns", r.len(), outcome.u.len(), problem.q.len()));
    }
    if !r.iter().chain(&outcome.u).all(|x| x.is_finite()) || !outcome.error.is_finite() || !outcome.error_scale_free.is_finite() {
        return Err("NaN or infinity".to_owned());
    }
    let truth = errors(problem, r);
    if outcome.is_converged() && truth.worst() > tolerance {
        return Err(format!("false success: {truth:?}"));
    }
    if !outcome.is_converged() && outcome.refusal.is_none() && outcome.diagnostics.len() != problem.contacts() {
        return Err(format!("{} diagnostics for {} contacts", outcome.diagnostics.len(), problem.contacts()));
    }
    Ok(())
}

/// The law, contact by contact, in words a mechanician would use, with tolerances relative to the largest reaction and velocity.
///
/// # Errors
/// The first contact that breaks the law, and how.
pub fn check_law(problem: &ContactProblem, r: &[f64], tolerance: f64) -> Result<(), String> {
    let truth = Truth::new(problem);
    let mut u = vec![0.0; r.len()];
    truth.velocity(r, &mut u);
    let d = problem.cone.dim();
    let largest = |v: &[f64]| v.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
    let (ru, uu) = (largest(r), largest(&u).max(largest(&problem.q)));
    for (c, diagnostic) in truth.diagnose(r, &u).iter().enumerate() {
        let (normal, gap) = (r[c * d + d - 1], u[c * d + d - 1]);
        let slip = (c * d..c * d + d - 1).map(|i| u[i] * u[i]).sum::<f64>().sqrt();
        let friction = (c * d..c * d + d - 1).map(|i| r[i] * r[i]).sum::<f64>().sqrt();
        let fail = |what: &str| Err(format!("contact {c} {what}: {diagnostic:?}, r_n {normal:e}, u_n {gap:e}, slip {slip:e}"));
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
        if diagnostic.status == Status::Slip && slip * friction * (1.0 - diagnostic.misalignment.cos()) > tolerance * ru * uu {
            return fail("is not opposed by friction");
        }
    }
    Ok(())
}
