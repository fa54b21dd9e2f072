//! The error of reactions in twice the digits, by other means than the solvers use.

use crate::problem::ContactProblem;

/// The largest of penetration, cone slack, complementarity and slip misalignment \[-\], as
/// [`Errors`](crate::Errors) names them, with `W r + q` summed in twice the digits.
///
/// Infinite for what is not finite.
#[must_use]
pub fn exact_error(problem: &ContactProblem, r: &[f64]) -> f64 {
    let (d, n) = (problem.cone.dim(), problem.q.len());
    if r.len() != n || !r.iter().all(|x| x.is_finite()) {
        return f64::INFINITY;
    }
    let w = problem.w.to_dense();
    let u: Vec<f64> = (0..n)
        .map(|i| sum(problem.q[i], |j| (w[(i, j)], r[j]), n))
        .collect();
    let mean = |c: usize| (c * d..c * d + d).map(|i| w[(i, i)]).sum::<f64>() / d as f64;
    let means: Vec<f64> = (0..n / d).map(mean).collect();
    let positive = means.iter().filter(|x| **x > 0.0);
    let (total, count) = positive.fold((0.0, 0.0), |(t, k), x| (t + x, k + 1.0));
    let rest = if count > 0.0 { total / count } else { 1.0 };
    let (mut parts, mut moved, mut free) = ([0.0; 4], 0.0, 0.0);
    // One length for all: squares of any unit stay in range.
    let unit = means
        .iter()
        .enumerate()
        .flat_map(|(c, m)| (c * d..c * d + d).map(move |i| (i, *m)))
        .map(|(i, m)| problem.q[i].abs().max(u[i].abs()) / if m > 0.0 { m } else { rest }.sqrt())
        .fold(0.0, f64::max);
    if unit == 0.0 {
        return if r.iter().all(|x| *x == 0.0) {
            0.0
        } else {
            breaches_alone(problem, r)
        };
    }
    for (c, mean) in means.iter().enumerate() {
        let root = if *mean > 0.0 { *mean } else { rest }.sqrt();
        let at = c * d..c * d + d;
        let force: Vec<f64> = r[at.clone()].iter().map(|x| x * root / unit).collect();
        let speed: Vec<f64> = u[at.clone()].iter().map(|x| x / root / unit).collect();
        for (part, found) in parts
            .iter_mut()
            .zip(breaches(problem.mu[c], &force, &speed))
        {
            *part += found * found;
        }
        moved += speed.iter().map(|x| x * x).sum::<f64>();
        free += problem.q[at]
            .iter()
            .map(|x| (x / root / unit).powi(2))
            .sum::<f64>();
    }
    let worst = parts
        .iter()
        .fold(0.0, |m: f64, x| if *x <= m { m } else { *x });
    let error = (worst / moved.max(free)).sqrt();
    if error.is_nan() { f64::INFINITY } else { error }
}

/// Nothing moves, whatever `r` is: only the cone can be left.
fn breaches_alone(problem: &ContactProblem, r: &[f64]) -> f64 {
    let d = problem.cone.dim();
    let mut cones = r.chunks(d).zip(&problem.mu);
    let inside = cones.all(|(r, mu)| breaches(*mu, r, &vec![0.0; d]).iter().all(|x| *x == 0.0));
    if inside { 0.0 } else { f64::INFINITY }
}

/// Penetration, cone slack, complementarity and slip misalignment of one contact, normal last.
fn breaches(mu: f64, r: &[f64], u: &[f64]) -> [f64; 4] {
    let n = r.len() - 1;
    let pressed = r[n].max(0.0);
    let radius = mu * pressed;
    let in_disc = |x: &[f64]| {
        let length = x.iter().map(|x| x * x).sum::<f64>().sqrt();
        let shrink = if length > radius {
            radius / length
        } else {
            1.0
        };
        x.iter().map(|x| x * shrink).collect::<Vec<f64>>()
    };
    let distance = |a: &[f64], b: &[f64]| {
        let squares = a.iter().zip(b).map(|(a, b)| (a - b) * (a - b));
        squares.sum::<f64>().sqrt()
    };
    let admissible = in_disc(&r[..n]);
    let pulled: Vec<f64> = admissible.iter().zip(u).map(|(r, u)| r - u).collect();
    [
        (-u[n]).max(0.0),
        (r[n] - pressed).abs() + distance(&r[..n], &admissible),
        pressed.min(u[n].max(0.0)),
        distance(&admissible, &in_disc(&pulled)),
    ]
}

/// `start` plus the products of `n` pairs, each operation with what it rounds away.
fn sum(start: f64, pair: impl Fn(usize) -> (f64, f64), n: usize) -> f64 {
    let (mut high, mut low) = (start, 0.0);
    for j in 0..n {
        let (a, b) = pair(j);
        let product = a * b;
        let lost = a.mul_add(b, -product);
        let next = high + product;
        let part = next - high;
        low += (high - (next - part)) + (product - part) + lost;
        high = next;
    }
    high + low
}
