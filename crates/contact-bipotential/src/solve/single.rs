//! The exact solution of one contact: `u = W r + b` with the law between `u` and `r`.
//!
//! Free if `b_n >= 0`, stuck if `-W^-1 b` lies in the cone; else the contact slides with `u_t = -a r_t`, `u_n = 0`, and
//! `a > 0` solves `|r_t(a)| = mu r_n(a)`, whose square is the quartic of Bonnefon and Daviet \[Bonnefon2011\]. The
//! unsquared equation is kept here: the right side times the determinant is a quadratic in `a`, the left the length of
//! a vector linear in `a`, and for positive definite `W` the ends of `[0, a_max]` always bracket a root. Newton inside the
//! bracket cannot fail and never meets the spurious roots that squaring brings.

mod slip_root;

use crate::cone;
use crate::law::{Status, natural_map};
use crate::local::{
    Matrix, Vector, affine, inverse, max_abs, solve_small, tangential_norm, times, trace,
};

use slip_root::SlipRoot;

/// Largest accepted scale-free residual of a contact that is called solved.
const SOLVED: f64 = 1e-13;

/// One solved contact.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SingleSolution<const D: usize> {
    /// Reaction, always finite.
    pub r: Vector<D>,
    /// What the contact does.
    pub status: Status,
    /// False where no solution was found (only for `W` singular or not positive definite): `r` is then the best point met.
    pub solved: bool,
}

/// The compliance of one contact with everything that does not depend on `b`, ready for many solutions.
#[derive(Debug, Clone)]
pub struct SingleContact<const D: usize> {
    /// `W` divided by `scale`.
    w: Matrix<D>,
    scale: f64,
    /// No entry is far above the diagonal.
    tame: bool,
    stick: Option<Matrix<D>>,
    slip: Reduced,
}

/// The tangential problem once `u_n = 0` has been used to remove `r_n`.
#[derive(Debug, Clone, Copy, Default)]
struct Reduced {
    inv_wnn: f64,
    /// `W_tt - W_tn W_nt / W_nn`.
    w: [[f64; 2]; 2],
    trace: f64,
    det: f64,
}

impl<const D: usize> SingleContact<D> {
    /// Prepares the compliance `w`, unit of `u` over unit of `r`.
    pub fn new(w: &Matrix<D>) -> Self {
        let mean = trace(w) / D as f64;
        let scale = if mean.is_finite() && mean > 0.0 {
            power_of_two(mean)
        } else {
            1.0
        };
        let (mut wn, inverse_scale) = (*w, 1.0 / scale);
        for x in wn.iter_mut().flatten() {
            *x *= inverse_scale;
        }
        let tame = wn.iter().all(|row| row.iter().all(|x| x.abs() <= 1e20));
        SingleContact {
            w: wn,
            scale,
            tame,
            stick: inverse(&wn),
            slip: Reduced::new(&wn),
        }
    }

    /// A power of two near the mean diagonal of `W`, the compliance scale of this contact.
    pub fn scale(&self) -> f64 {
        self.scale
    }

    /// The reaction under the free velocity `b`.
    #[inline]
    pub fn solve(&self, b: &Vector<D>, mu: f64) -> SingleSolution<D> {
        if b[D - 1] >= 0.0 {
            return SingleSolution {
                r: [0.0; D],
                status: Status::Separate,
                solved: b.iter().all(|x| x.is_finite()),
            };
        }
        if !b.iter().all(|x| x.is_finite()) {
            return SingleSolution {
                r: [0.0; D],
                status: Status::Separate,
                solved: false,
            };
        }
        // Scaling by powers of two rounds nothing: what holds for the unit contact holds for this one.
        let size = power_of_two(max_abs(b));
        let (mut unit, inverse_size) = (*b, 1.0 / size);
        for x in &mut unit {
            *x *= inverse_size;
        }
        let mut s = self.solve_scaled(&unit, mu);
        let ratio = size / self.scale;
        for x in &mut s.r {
            // A ratio out of range does not mean that the reaction is.
            *x = if ratio.is_normal() {
                *x * ratio
            } else {
                *x * size / self.scale
            };
        }
        let largest = max_abs(&s.r);
        if !s.r.iter().all(|x| x.is_finite()) {
            s = SingleSolution {
                r: [0.0; D],
                status: s.status,
                solved: false,
            };
        } else if !(ratio.is_normal() && self.tame && largest >= f64::MIN_POSITIVE) {
            // The way back may have rounded: judge what is returned.
            s.solved &= self.residual_of(b, &s.r, mu) <= SOLVED;
        }
        s
    }

    #[inline]
    fn solve_scaled(&self, b: &Vector<D>, mu: f64) -> SingleSolution<D> {
        if D == 1 || mu == 0.0 {
            return self.frictionless(b);
        }
        if let Some(r) = self.stuck(b, mu)
            && self.residual(&r, b, mu) <= SOLVED
        {
            return SingleSolution {
                r,
                status: Status::Stick,
                solved: true,
            };
        }
        let r = if D == 2 {
            self.slide_plane(b, mu)
        } else {
            self.slide_space(b, mu)
        };
        let r = self.polish(r, b, mu);
        if self.residual(&r, b, mu) <= SOLVED {
            return SingleSolution {
                r,
                status: Status::Slip,
                solved: true,
            };
        }
        self.search(r, b, mu)
    }

    #[inline]
    fn frictionless(&self, b: &Vector<D>) -> SingleSolution<D> {
        let mut r = [0.0; D];
        let wnn = self.w[D - 1][D - 1];
        if wnn > 0.0 {
            r[D - 1] = -b[D - 1] / wnn;
        }
        let solved = self.residual(&r, b, 0.0) <= SOLVED;
        let status = if tangential_norm(&affine(&self.w, &r, b)) == 0.0 {
            Status::Stick
        } else {
            Status::Slip
        };
        SingleSolution { r, status, solved }
    }

    /// `-W^-1 b` if it lies in the cone; one step of refinement keeps it exact when `W` is ill-conditioned.
    #[inline]
    fn stuck(&self, b: &Vector<D>, mu: f64) -> Option<Vector<D>> {
        let inv = self.stick.as_ref()?;
        let mut r = times(inv, b);
        for x in &mut r {
            *x = -*x;
        }
        // Far outside: not worth refining.
        if tangential_norm(&r) > 2.0 * mu * r[D - 1].abs() {
            return None;
        }
        for _ in 0..2 {
            let step = times(inv, &affine(&self.w, &r, b));
            for i in 0..D {
                r[i] -= step[i];
            }
            if max_abs(&step) <= 1e-15 * max_abs(&r) {
                break;
            }
        }
        (tangential_norm(&r) <= mu * r[D - 1]).then_some(r)
    }

    #[inline]
    fn slide_plane(&self, b: &Vector<D>, mu: f64) -> Vector<D> {
        let n = D - 1;
        let mut r = [0.0; D];
        // Friction opposes the velocity that the tangent would take without it.
        let sign = -(b[0] - self.w[0][n] * b[n] * self.slip.inv_wnn).signum();
        let denominator = self.w[n][n] + sign * mu * self.w[n][0];
        if denominator > 0.0 {
            r[n] = -b[n] / denominator;
            r[0] = sign * mu * r[n];
        }
        r
    }

    #[inline]
    fn slide_space(&self, b: &Vector<D>, mu: f64) -> Vector<D> {
        let n = D - 1;
        let s = &self.slip;
        let c = [
            b[0] - self.w[0][n] * b[n] * s.inv_wnn,
            b[1] - self.w[1][n] * b[n] * s.inv_wnn,
        ];
        let p = [
            s.w[1][1] * c[0] - s.w[0][1] * c[1],
            s.w[0][0] * c[1] - s.w[1][0] * c[0],
        ];
        let wc = self.w[n][0] * c[0] + self.w[n][1] * c[1];
        let wp = self.w[n][0] * p[0] + self.w[n][1] * p[1];
        let k = mu * s.inv_wnn;
        let root = SlipRoot {
            p,
            c,
            k0: k * (wp - b[n] * s.det),
            k1: k * (wc - b[n] * s.trace),
            k2: -k * b[n],
        };
        let a = root.find();
        let v = [p[0] + a * c[0], p[1] + a * c[1]];
        let length = (v[0] * v[0] + v[1] * v[1]).sqrt();
        let det = s.det + a * (s.trace + a);
        let mut r = [0.0; D];
        if det > 0.0 && length > 0.0 {
            r[n] = (-b[n] + (self.w[n][0] * v[0] + self.w[n][1] * v[1]) / det) * s.inv_wnn;
            for i in 0..2 {
                r[i] = -mu * r[n] * v[i] / length;
            }
        }
        if r.iter().all(|x| x.is_finite()) {
            r
        } else {
            [0.0; D]
        }
    }

    /// Scale-free residual: `F` with `rho = 1` over the largest of `b`, `r`, `u`.
    #[inline]
    fn residual(&self, r: &Vector<D>, b: &Vector<D>, mu: f64) -> f64 {
        residual(mu, &affine(&self.w, r, b), r)
    }

    /// [`single_residual`] of a reaction in the units of the problem.
    fn residual_of(&self, b: &Vector<D>, r: &Vector<D>, mu: f64) -> f64 {
        let size = power_of_two(max_abs(b));
        let ratio = self.scale / size;
        let (mut unit, mut reaction) = (*b, *r);
        for i in 0..D {
            unit[i] /= size;
            reaction[i] = if ratio.is_normal() {
                r[i] * ratio
            } else {
                r[i] / size * self.scale
            };
        }
        // No reaction: u = b, even where W over its scale overflows.
        let free = max_abs(&reaction) == 0.0;
        let u = if free {
            unit
        } else {
            affine(&self.w, &reaction, &unit)
        };
        residual(mu, &u, &reaction)
    }

    /// Newton on `u_n = 0, r_t = -mu r_n direction` until it stops paying.
    #[inline]
    fn polish(&self, start: Vector<D>, b: &Vector<D>, mu: f64) -> Vector<D> {
        let mut best = (self.residual(&start, b, mu), start);
        for _ in 0..4 {
            if best.0 <= 4e-16 {
                break;
            }
            let Some(r) = self.slip_step(&best.1, b, mu) else {
                break;
            };
            let error = self.residual(&r, b, mu);
            if error >= best.0 {
                break;
            }
            best = (error, r);
        }
        best.1
    }

    fn slip_step(&self, r: &Vector<D>, b: &Vector<D>, mu: f64) -> Option<Vector<D>> {
        let n = D - 1;
        let u = affine(&self.w, r, b);
        let mut e = [0.0; D];
        for i in 0..n {
            e[i] = r[i] - u[i];
        }
        let length = tangential_norm(&e);
        if length == 0.0 || length.is_nan() {
            return None;
        }
        for x in &mut e {
            *x /= length;
        }
        let turn = mu * r[n] / length;
        let (mut a, mut rhs) = ([[0.0; D]; D], [0.0; D]);
        a[n] = self.w[n];
        rhs[n] = -u[n];
        for i in 0..n {
            rhs[i] = mu * r[n] * e[i] - r[i];
            a[i][n] -= mu * e[i];
            a[i][i] += 1.0;
            for k in 0..n {
                let across = turn * (f64::from(u8::from(i == k)) - e[i] * e[k]);
                a[i][k] -= across;
                for j in 0..D {
                    a[i][j] += across * self.w[k][j];
                }
            }
        }
        let mut next = solve_small(&a, &rhs)?;
        for i in 0..D {
            next[i] += r[i];
        }
        Some(next)
    }

    /// Last resort for `W` that is not positive definite: projections from several starts, each polished.
    #[cold]
    fn search(&self, start: Vector<D>, b: &Vector<D>, mu: f64) -> SingleSolution<D> {
        let mut best = (self.residual(&[0.0; D], b, mu), [0.0; D]);
        let mut consider = |r: Vector<D>| {
            let r = cone::project(mu, &r);
            let error = self.residual(&r, b, mu);
            if error < best.0 {
                best = (error, r);
            }
        };
        let mut push = [0.0; D];
        push[D - 1] = 1.0;
        consider(start);
        for first in [[0.0; D], start, push] {
            for rho in [0.2, 1.0] {
                let mut r = first;
                for _ in 0..200 {
                    let f = natural_map(mu, rho, &affine(&self.w, &r, b), &r);
                    for i in 0..D {
                        r[i] -= f[i];
                    }
                }
                if r.iter().all(|x| x.is_finite()) {
                    consider(r);
                    consider(self.polish(r, b, mu));
                }
            }
        }
        let u = affine(&self.w, &best.1, b);
        let status = crate::law::status(mu, 1.0, &u, &best.1);
        SingleSolution {
            r: best.1,
            status,
            solved: best.0 <= SOLVED,
        }
    }
}

#[inline(always)]
fn residual<const D: usize>(mu: f64, u: &Vector<D>, r: &Vector<D>) -> f64 {
    let f = natural_map(mu, 1.0, u, r);
    let size = 1.0_f64.max(max_abs(r)).max(max_abs(u));
    // The maximum forgets NaN, the sum does not.
    let finite = (f.iter().sum::<f64>() + u.iter().sum::<f64>()).is_finite();
    if finite { max_abs(&f) / size } else { f64::MAX }
}

/// The largest power of two not above `x > 0`.
#[inline(always)]
fn power_of_two(x: f64) -> f64 {
    f64::from_bits(x.max(f64::MIN_POSITIVE).to_bits() & 0x7ff0_0000_0000_0000)
}

impl Reduced {
    fn new<const D: usize>(w: &Matrix<D>) -> Self {
        let n = D - 1;
        let inv_wnn = 1.0 / w[n][n];
        let mut s = Reduced {
            inv_wnn,
            ..Reduced::default()
        };
        for i in 0..n {
            for j in 0..n {
                s.w[i][j] = w[i][j] - w[i][n] * w[n][j] * inv_wnn;
            }
        }
        s.trace = s.w[0][0] + s.w[1][1];
        s.det = s.w[0][0] * s.w[1][1] - s.w[0][1] * s.w[1][0];
        s
    }
}

/// The exact reaction of one contact: `u = W r + b`.
///
/// `w` by rows and `b`, normal last; `mu >= 0` [-]. For positive definite `w` the answer is exact to rounding; otherwise
/// `solved` tells. Never NaN. For many solutions with the same `w` keep a [`SingleContact`].
pub fn solve_single<const D: usize>(w: &Matrix<D>, b: &Vector<D>, mu: f64) -> SingleSolution<D> {
    let sound = mu >= 0.0 && mu.is_finite() && w.iter().flatten().all(|x| x.is_finite());
    if !sound {
        return SingleSolution {
            r: [0.0; D],
            status: Status::Separate,
            solved: false,
        };
    }
    SingleContact::new(w).solve(b, mu)
}

/// Scale-free residual of one contact: `F` with `rho = 1 / w`, `w` near the mean diagonal, over the largest of `b`, `w r`, `u`.
pub fn single_residual<const D: usize>(
    w: &Matrix<D>,
    b: &Vector<D>,
    mu: f64,
    r: &Vector<D>,
) -> f64 {
    SingleContact::new(w).residual_of(b, r, mu)
}

#[cfg(test)]
mod tests;
