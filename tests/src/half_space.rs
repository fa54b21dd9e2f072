//! Pull-off of a rigid ball from an elastic half-space with bonds: rings of constant traction, independent of the
//! program.
//!
//! Radii are in `a0 = (9 pi w R^2 / (2 E*))^(1/3)`, gaps in `a0^2 / R`, tractions in `E* a0 / R`; the work of
//! separation `w` is `2 / (9 pi)` then. Bonds act across any gap. Equilibria follow one another along the mean opening
//! of the surfaces, which grows where force and travel turn back.

mod elliptic;

use std::f64::consts::PI;

use faer::Mat;
use faer::linalg::solvers::Solve;

use crate::curve::{Curve, peak};
use elliptic::disc;

/// Work of separation in these units \[-\].
const ENERGY: f64 = 2.0 / (9.0 * PI);
/// The equal rings reach so far \[a0\]; the contact is smaller where the pull is largest.
const EQUAL: f64 = 0.95;
/// Growth of the rings beyond \[-\].
const GROWTH: f64 = 1.06;
/// Gap at the last ring over the one at which bonds start to break \[-\]: beyond, they take a part of `1e-6` of the
/// force.
const LARGEST_GAP: f64 = 1000.0;
/// Mean lift of the half-space at the start, and the steps of the opening \[a0^2 / R\].
const LIFT: f64 = 0.13;
const STRIDE: f64 = 0.005;
/// Steps in which the bonds are switched on.
const RAMP: u32 = 10;
/// Newton steps of an equilibrium.
const NEWTON_STEPS: usize = 30;

/// Traction of bonds of strength `s0` at a gap >= 0, and its derivative.
pub type Bonds = fn(f64, f64) -> (f64, f64);

/// The bonds of the program without viscosity: `beta = min(1, (x0/x)^2)`, a traction that falls with the third power of
/// the gap.
pub fn recoverable(strength: f64, gap: f64) -> (f64, f64) {
    let x0 = ENERGY / strength;
    if gap <= x0 {
        return (strength / x0 * gap, strength / x0);
    }
    let pull = strength * (x0 / gap).powi(3);
    (pull, -3.0 * pull / gap)
}

/// Pull-off force over `pi w R` \[-\] at a Maugis parameter \[-\], with so many `rings` on `a0`.
///
/// # Errors
/// Newton's method fails before the force falls.
pub fn pull_off(lambda: f64, rings: u32, bonds: Bonds) -> Result<f64, String> {
    let strength = 0.5 * lambda * (16.0 * PI * ENERGY / 9.0).cbrt();
    HalfSpace::new(rings, strength, bonds).largest_pull()
}

struct HalfSpace {
    bonds: Bonds,
    strength: f64,
    /// Midst of each ring.
    radii: Vec<f64>,
    areas: Vec<f64>,
    /// Displacement of ring `i` by a unit traction on ring `j`.
    compliance: Mat<f64>,
    /// Share of each ring in the mean opening, and what its traction does to it.
    shares: Vec<f64>,
    opened: Vec<f64>,
    /// What a gap is multiplied with to compare it with a traction.
    stiffness: f64,
    /// Mean opening before anything moves.
    flat: f64,
}

/// An equilibrium: pressure on each ring, depth of the ball and mean opening.
#[derive(Clone)]
struct Point {
    pressure: Vec<f64>,
    depth: f64,
    opening: f64,
    touches: bool,
}

impl HalfSpace {
    fn new(rings: u32, strength: f64, bonds: Bonds) -> HalfSpace {
        let mut width = 1.0 / f64::from(rings);
        let stiffness = f64::from(rings);
        let softening = (2.0 * ENERGY / strength).sqrt();
        let (equal, end) = (EQUAL.max(1.15 * softening), LARGEST_GAP.sqrt() * softening);
        let mut edges = vec![0.0];
        let mut last = 0.0;
        while last < end {
            if last > equal {
                width *= GROWTH;
            }
            last += width;
            edges.push(last);
        }
        let ring = |f: fn(f64, f64) -> f64| edges.windows(2).map(|e| f(e[0], e[1])).collect();
        let radii: Vec<f64> = ring(|a, b| 0.5 * (a + b));
        let areas: Vec<f64> = ring(|a, b| PI * (b * b - a * a));
        let (n, inside) = (radii.len(), PI * equal * equal);
        let compliance = Mat::from_fn(n, n, |i, j| {
            disc(radii[i], edges[j + 1]) - disc(radii[i], edges[j])
        });
        let share = |(r, a): (&f64, &f64)| if *r < equal { a / inside } else { 0.0 };
        let shares: Vec<f64> = radii.iter().zip(&areas).map(share).collect();
        let flat = shares
            .iter()
            .zip(&radii)
            .map(|(s, r)| 0.5 * s * r * r)
            .sum();
        let opened = |j| (0..n).map(|i| shares[i] * compliance[(i, j)]).sum();
        HalfSpace {
            opened: (0..n).map(opened).collect(),
            bonds,
            strength,
            radii,
            areas,
            compliance,
            shares,
            stiffness,
            flat,
        }
    }

    /// Equilibrium with the opening of the guess `x` and a part of the bonds' traction.
    fn settle(&self, mut x: Point, part: f64) -> Option<Point> {
        let n = self.radii.len();
        for _ in 0..NEWTON_STEPS {
            let mut matrix = Mat::zeros(n + 1, n + 1);
            let mut right = Mat::zeros(n + 1, 1);
            let mut missing = x.opening;
            x.touches = false;
            for i in 0..n {
                let lift: f64 = (0..n)
                    .map(|j| self.compliance[(i, j)] * x.pressure[j])
                    .sum();
                let gap = 0.5 * self.radii[i].powi(2) - x.depth + lift;
                missing -= self.shares[i] * gap;
                let (pull, slope) = (self.bonds)(self.strength, gap.max(0.0));
                let (dry, distance) = (x.pressure[i] + part * pull, self.stiffness * gap);
                let touches = dry > distance;
                x.touches |= touches;
                let (residual, factor) = if touches {
                    (distance, self.stiffness)
                } else {
                    (dry, part * slope)
                };
                for j in 0..n {
                    matrix[(i, j)] = factor * self.compliance[(i, j)];
                }
                matrix[(i, i)] += f64::from(u8::from(!touches));
                matrix[(i, n)] = -factor;
                matrix[(n, i)] = self.opened[i];
                right[(i, 0)] = -residual;
            }
            matrix[(n, n)] = -self.shares.iter().sum::<f64>();
            right[(n, 0)] = missing;
            let worst = (0..n).fold(self.stiffness * missing.abs(), |m, i| {
                m.max(right[(i, 0)].abs())
            });
            if worst < 1e-10 * self.strength {
                return Some(x);
            }
            let step = matrix.partial_piv_lu().solve(&right);
            let moved = x.pressure.iter_mut().enumerate();
            moved.for_each(|(i, p)| *p += step[(i, 0)]);
            x.depth += step[(n, 0)];
        }
        None
    }

    /// Opens the surfaces until the force falls: for good once nothing touches.
    fn largest_pull(&self) -> Result<f64, String> {
        let mut stride = STRIDE;
        let mut x = Point {
            pressure: vec![0.0; self.radii.len()],
            depth: LIFT,
            opening: self.flat - LIFT,
            touches: true,
        };
        let lost = |x: &Point| format!("no equilibrium at a mean opening of {}", x.opening);
        for part in 0..=RAMP {
            let share = f64::from(part) / f64::from(RAMP);
            x = self.settle(x.clone(), share).ok_or_else(|| lost(&x))?;
        }
        let mut before = x.clone();
        let mut curve: Curve = vec![(x.opening, self.pull(&x))];
        loop {
            match self.settle(extended(&before, &x, stride), 1.0) {
                Some(next) => {
                    (before, x) = (x, next);
                    curve.push((x.opening, self.pull(&x)));
                    let top = peak(&curve).map_or(0.0, |top| top.1);
                    let enough = if x.touches { 0.98 * top } else { top };
                    if curve[curve.len() - 1].1 < enough {
                        return Ok(top);
                    }
                }
                None if stride > 1e-3 * STRIDE => stride *= 0.5,
                None => return Err(lost(&x)),
            }
        }
    }

    fn pull(&self, x: &Point) -> f64 {
        let force = x.pressure.iter().zip(&self.areas).map(|(p, a)| p * a);
        -force.sum::<f64>() / (PI * ENERGY)
    }
}

/// The guess behind two equilibria, `stride` further in the opening.
fn extended(before: &Point, x: &Point, stride: f64) -> Point {
    let last = x.opening - before.opening;
    let ratio = if last > 0.0 { stride / last } else { 0.0 };
    let ahead = |a: f64, b: f64| b + ratio * (b - a);
    let pairs = before.pressure.iter().zip(&x.pressure);
    Point {
        pressure: pairs.map(|(a, b)| ahead(*a, *b)).collect(),
        depth: ahead(before.depth, x.depth),
        opening: x.opening + stride,
        touches: x.touches,
    }
}

#[cfg(test)]
mod tests;
