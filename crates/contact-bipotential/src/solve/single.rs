//! The exact solution of one contact: `u = W r + b` with the law between `u` and `r`.
//!
//! Free if `b_n >= 0`, stuck if `-W^-1 b` lies in the cone; else the contact slides with `u_t = -a r_t`, `u_n = 0`, and
//! `a > 0` solves `|r_t(a)| = mu r_n(a)`, whose square is the quartic of Bonnefon and Daviet \[Bonnefon2011\]. The
//! unsquared equation is kept here: the right side times the determinant is a quadratic in `a`, the left the length of
//! a vector linear in `a`, and for positive definite `W` the ends of `[0, a_max]` always bracket a root. Newton inside
//! the bracket cannot fail and never meets the spurious roots that squaring brings.

mod slip_root;

use crate::cone;
use crate::law::{NATURAL, Status, natural_map, violation};
use crate::local::{Matrix, Vector, inverse, solve_small, tangential_norm};

use slip_root::SlipRoot;

/// Largest accepted scale-free residual of a contact that is called solved \[-\].
const SOLVED: f64 = 1e-13;
/// Scale-free residual that rounding leaves anyway \[-\]: two units in the last place.
const ROUNDED: f64 = 4e-16;
/// Change of a refined reaction that is rounding \[-\].
const REFINED: f64 = 1e-15;
/// Entries over the mean diagonal up to which scaling back cannot round the solution away \[-\].
const LARGEST_ENTRY: f64 = 1e20;
/// Newton steps on the slip equations: two are the rule.
const POLISHING_STEPS: usize = 4;
/// Projections from each start of the last resort.
const PROJECTIONS: usize = 200;
/// Their steps `rho` over the inverse mean diagonal of `W` \[-\]: one that still contracts where the largest eigenvalue
/// is several times the mean, and the natural one.
const PROJECTION_STEPS: [f64; 2] = [0.2, 1.0];
/// Friction force over its limit \[-\] beyond which no refinement brings a stuck contact back into the cone.
const FAR_OUTSIDE: f64 = 2.0;
/// Steps of refinement of a stuck contact at most: one is the rule.
const REFINEMENTS: usize = 2;

/// One solved contact.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct SingleSolution<const D: usize> {
    /// Reaction, always finite.
    pub r: Vector<D>,
    /// What the contact does.
    pub status: Status,
    /// False where no solution was found (only for `W` singular or not positive definite): `r` is then the best point
    /// met.
    pub solved: bool,
}

impl<const D: usize> SingleSolution<D> {
    /// No reaction.
    #[inline(always)]
    fn free(solved: bool) -> Self {
        SingleSolution {
            r: Vector::zeros(),
            status: Status::Separate,
            solved,
        }
    }
}

/// The compliance of one contact with everything that does not depend on `b`, ready for many solutions.
#[derive(Debug, Clone)]
pub struct SingleContact<const D: usize> {
    /// `W` divided by `scale`.
    w: Matrix<D>,
    scale: f64,
    /// No entry is far above the diagonal.
    balanced: bool,
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
    #[must_use]
    pub fn new(w: &Matrix<D>) -> Self {
        let mean = w.trace() / D as f64;
        let scale = if mean.is_finite() && mean > 0.0 {
            power_of_two(mean)
        } else {
            1.0
        };
        let wn = w * (1.0 / scale);
        SingleContact {
            w: wn,
            scale,
            balanced: wn.iter().all(|x| x.abs() <= LARGEST_ENTRY),
            stick: inverse(&wn),
            slip: Reduced::new(&wn),
        }
    }

    /// A power of two near the mean diagonal of `W`, the compliance scale of this contact.
    #[must_use]
    pub fn scale(&self) -> f64 {
        self.scale
    }

    /// The reaction under the free velocity `b`.
    #[inline]
    #[must_use]
    pub fn solve(&self, b: &Vector<D>, mu: f64) -> SingleSolution<D> {
        if b[D - 1] >= 0.0 {
            return SingleSolution::free(b.iter().all(|x| x.is_finite()));
        }
        if !b.iter().all(|x| x.is_finite()) {
            return SingleSolution::free(false);
        }
        // Scaling by powers of two rounds nothing: what holds for the unit contact holds for this one.
        let size = power_of_two(b.amax());
        let mut s = self.solve_scaled(&(b * (1.0 / size)), mu);
        let ratio = size / self.scale;
        // A ratio out of range does not mean that the reaction is.
        s.r = if ratio.is_normal() {
            s.r * ratio
        } else {
            s.r * size / self.scale
        };
        let largest = s.r.amax();
        if !s.r.iter().all(|x| x.is_finite()) {
            s.r = Vector::zeros();
            s.solved = false;
        } else if !(ratio.is_normal() && self.balanced && largest >= f64::MIN_POSITIVE) {
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
        let mut r = Vector::zeros();
        let wnn = self.w[(D - 1, D - 1)];
        if wnn > 0.0 {
            r[D - 1] = -b[D - 1] / wnn;
        }
        let solved = self.residual(&r, b, 0.0) <= SOLVED;
        let status = if tangential_norm(&self.u(&r, b)) == 0.0 {
            Status::Stick
        } else {
            Status::Slip
        };
        SingleSolution { r, status, solved }
    }

    /// `W r + b`, scaled.
    #[inline(always)]
    fn u(&self, r: &Vector<D>, b: &Vector<D>) -> Vector<D> {
        self.w * r + b
    }

    /// `-W^-1 b` if it lies in the cone; one step of refinement keeps it exact when `W` is ill-conditioned.
    #[inline]
    fn stuck(&self, b: &Vector<D>, mu: f64) -> Option<Vector<D>> {
        let inv = self.stick.as_ref()?;
        let mut r = -(inv * b);
        if tangential_norm(&r) > FAR_OUTSIDE * mu * r[D - 1].abs() {
            return None;
        }
        for _ in 0..REFINEMENTS {
            let step = inv * self.u(&r, b);
            r -= step;
            if step.amax() <= REFINED * r.amax() {
                break;
            }
        }
        (tangential_norm(&r) <= mu * r[D - 1]).then_some(r)
    }

    #[inline]
    fn slide_plane(&self, b: &Vector<D>, mu: f64) -> Vector<D> {
        let n = D - 1;
        let mut r = Vector::zeros();
        // Friction opposes the velocity that the tangent would take without it.
        let sign = -(b[0] - self.w[(0, n)] * b[n] * self.slip.inv_wnn).signum();
        let denominator = self.w[(n, n)] + sign * mu * self.w[(n, 0)];
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
            b[0] - self.w[(0, n)] * b[n] * s.inv_wnn,
            b[1] - self.w[(1, n)] * b[n] * s.inv_wnn,
        ];
        let p = [
            s.w[1][1] * c[0] - s.w[0][1] * c[1],
            s.w[0][0] * c[1] - s.w[1][0] * c[0],
        ];
        let wc = self.w[(n, 0)] * c[0] + self.w[(n, 1)] * c[1];
        let wp = self.w[(n, 0)] * p[0] + self.w[(n, 1)] * p[1];
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
        let mut r = Vector::<D>::zeros();
        if det > 0.0 && length > 0.0 {
            r[n] = (-b[n] + (self.w[(n, 0)] * v[0] + self.w[(n, 1)] * v[1]) / det) * s.inv_wnn;
            for i in 0..2 {
                r[i] = -mu * r[n] * v[i] / length;
            }
        }
        if r.iter().all(|x| x.is_finite()) {
            r
        } else {
            Vector::zeros()
        }
    }

    /// Scale-free residual: how far `r` is from the law with `rho = 1`, over the largest of `b`, `r`, `u`.
    #[inline]
    fn residual(&self, r: &Vector<D>, b: &Vector<D>, mu: f64) -> f64 {
        residual(mu, &self.u(r, b), r)
    }

    /// The same of a reaction in the units of the problem: `rho = 1 / w`, `w` near the mean diagonal of `W`, over the
    /// largest of `b`, `w r`, `u` \[-\].
    fn residual_of(&self, b: &Vector<D>, r: &Vector<D>, mu: f64) -> f64 {
        let size = power_of_two(b.amax());
        let ratio = self.scale / size;
        let unit = b / size;
        let reaction = if ratio.is_normal() {
            r * ratio
        } else {
            r / size * self.scale
        };
        // No reaction: u = b, even where W over its scale overflows.
        let free = reaction.amax() == 0.0;
        let u = if free { unit } else { self.u(&reaction, &unit) };
        residual(mu, &u, &reaction)
    }

    /// Newton on `u_n = 0, r_t = -mu r_n direction` until it stops paying.
    #[inline]
    fn polish(&self, start: Vector<D>, b: &Vector<D>, mu: f64) -> Vector<D> {
        let mut best = (self.residual(&start, b, mu), start);
        for _ in 0..POLISHING_STEPS {
            if best.0 <= ROUNDED {
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
        let u = self.u(r, b);
        let mut e = r - u;
        e[n] = 0.0;
        let length = tangential_norm(&e);
        if length == 0.0 || length.is_nan() {
            return None;
        }
        for i in 0..n {
            e[i] /= length;
        }
        let turn = mu * r[n] / length;
        let (mut a, mut rhs) = (Matrix::<D>::zeros(), Vector::<D>::zeros());
        a.set_row(n, &self.w.row(n));
        rhs[n] = -u[n];
        for i in 0..n {
            rhs[i] = mu * r[n] * e[i] - r[i];
            a[(i, n)] -= mu * e[i];
            a[(i, i)] += 1.0;
            for k in 0..n {
                let across = turn * (f64::from(u8::from(i == k)) - e[i] * e[k]);
                a[(i, k)] -= across;
                for j in 0..D {
                    a[(i, j)] += across * self.w[(k, j)];
                }
            }
        }
        Some(solve_small(&a, &rhs)? + r)
    }

    /// Last resort for `W` that is not positive definite: projections from several starts, each polished.
    #[cold]
    fn search(&self, start: Vector<D>, b: &Vector<D>, mu: f64) -> SingleSolution<D> {
        let mut best = (self.residual(&Vector::zeros(), b, mu), Vector::zeros());
        let mut consider = |r: Vector<D>| {
            let r = cone::project(mu, &r);
            let error = self.residual(&r, b, mu);
            if error < best.0 {
                best = (error, r);
            }
        };
        let mut push = Vector::zeros();
        push[D - 1] = 1.0;
        consider(start);
        for first in [Vector::zeros(), start, push] {
            for rho in PROJECTION_STEPS {
                let mut r = first;
                for _ in 0..PROJECTIONS {
                    r -= natural_map(mu, rho, &self.u(&r, b), &r);
                }
                if r.iter().all(|x| x.is_finite()) {
                    consider(r);
                    consider(self.polish(r, b, mu));
                }
            }
        }
        let u = self.u(&best.1, b);
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
    let f = if mu <= NATURAL {
        natural_map(mu, 1.0, u, r).amax()
    } else {
        violation(mu, u, r)
    };
    let size = 1.0_f64.max(r.amax()).max(u.amax());
    // The maximum forgets NaN, the sum does not.
    let finite = (f + r.sum() + u.sum()).is_finite();
    if finite { f / size } else { f64::MAX }
}

/// The largest power of two not above `x > 0`.
#[inline(always)]
fn power_of_two(x: f64) -> f64 {
    f64::from_bits(x.max(f64::MIN_POSITIVE).to_bits() & 0x7ff0_0000_0000_0000)
}

impl Reduced {
    fn new<const D: usize>(w: &Matrix<D>) -> Self {
        let n = D - 1;
        let inv_wnn = 1.0 / w[(n, n)];
        let mut s = Reduced {
            inv_wnn,
            ..Reduced::default()
        };
        for i in 0..n {
            for j in 0..n {
                s.w[i][j] = w[(i, j)] - w[(i, n)] * w[(n, j)] * inv_wnn;
            }
        }
        s.trace = s.w[0][0] + s.w[1][1];
        s.det = s.w[0][0] * s.w[1][1] - s.w[0][1] * s.w[1][0];
        s
    }
}

/// The exact reaction of one contact: `u = W r + b`.
///
/// `w` and `b`, normal last; `mu >= 0` \[-\]. For positive definite `w` the answer is exact to rounding; otherwise
/// `solved` tells. Never NaN. For many solutions with the same `w` keep a [`SingleContact`].
///
/// ```
/// use contact_bipotential::nalgebra::{Matrix3, Vector3};
/// use contact_bipotential::{Status, solve_single};
///
/// // A body of unit compliance is pressed by one unit and dragged along by ten: it slides at the friction limit.
/// let pressed = solve_single(&Matrix3::identity(), &Vector3::new(10.0, 0.0, -1.0), 0.3);
/// assert!(pressed.solved && pressed.status == Status::Slip);
/// assert!((pressed.r - Vector3::new(-0.3, 0.0, 1.0)).amax() < 1e-15);
/// ```
#[must_use]
pub fn solve_single<const D: usize>(w: &Matrix<D>, b: &Vector<D>, mu: f64) -> SingleSolution<D> {
    let sound = mu >= 0.0 && mu.is_finite() && w.iter().all(|x| x.is_finite());
    if !sound {
        return SingleSolution::free(false);
    }
    SingleContact::new(w).solve(b, mu)
}

#[cfg(test)]
mod tests;
