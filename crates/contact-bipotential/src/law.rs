//! Contact and friction at one point: the natural map and the status.

use crate::cone::{self, Region};
use crate::local::{Vector, tangential_dot, tangential_norm};

/// What a contact does.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Status {
    /// Free: no reaction.
    Separate,
    /// Closed, no relative motion.
    Stick,
    /// Closed, sliding; the friction force is at its limit.
    Slip,
}

/// `F = r - Proj_K(r - rho (u + mu |u_t| n))`, in the unit of `r`; zero exactly where the law holds.
///
/// ```
/// use contact_bipotential::natural_map;
/// use contact_bipotential::nalgebra::Vector2;
///
/// // An open contact, (t, n), without force, and one that pulls.
/// let u = Vector2::new(0.3, 0.2);
/// assert_eq!(natural_map(0.5, 1.0, &u, &Vector2::zeros()), Vector2::zeros());
/// assert_eq!(natural_map(0.5, 1.0, &u, &Vector2::new(0.0, -1.0)), Vector2::new(0.0, -1.0));
/// ```
#[inline]
#[must_use]
pub fn natural_map<const D: usize>(mu: f64, rho: f64, u: &Vector<D>, r: &Vector<D>) -> Vector<D> {
    r - cone::project(mu, &predictor(mu, rho, u, r))
}

/// By how much velocity and reaction of one contact, in one unit, break the law, part by part. No parameter scales a
/// part away, as a large `mu` does with the [`natural_map`]; all vanish exactly where the law holds.
///
/// Together they are the residual of Alart and Curnier \[Alart1991\], `min(r_n, u_n)` and
/// `r_t - Proj(r_t - u_t)` on the disc of radius `mu r_n`.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(crate) struct Breach {
    /// `max(0, -u_n)`.
    pub(crate) penetration: f64,
    /// Distance of `r` from the cone along its axes: a pull, and friction above its limit.
    pub(crate) cone: f64,
    /// `min(r_n, u_n)` where both are positive.
    pub(crate) complementarity: f64,
    /// `|r_t - Proj(r_t - u_t)|` with `r_t` brought into the disc first.
    pub(crate) slip: f64,
}

impl Breach {
    #[inline]
    pub(crate) fn of<const D: usize>(mu: f64, u: &Vector<D>, r: &Vector<D>) -> Self {
        let (un, rn) = (u[D - 1], r[D - 1]);
        let pressed = rn.max(0.0);
        let radius = mu * pressed;
        let friction = tangential_norm(r);
        let excess = (friction - radius).max(0.0);
        let pull = rn - pressed;
        Breach {
            penetration: (-un).max(0.0),
            cone: (pull * pull + excess * excess).sqrt(),
            complementarity: pressed.min(un).max(0.0),
            slip: slip_breach(radius, friction, u, r),
        }
    }

    /// Sum of the squares of all parts.
    pub(crate) fn square(&self) -> f64 {
        let parts = [self.penetration, self.cone, self.complementarity, self.slip];
        parts.iter().map(|x| x * x).sum()
    }
}

/// Distance that the friction force, brought into the disc, still moves against the slip within the disc.
#[inline]
fn slip_breach<const D: usize>(radius: f64, friction: f64, u: &Vector<D>, r: &Vector<D>) -> f64 {
    let shrink = |length: f64| {
        if length > radius {
            radius / length
        } else {
            1.0
        }
    };
    let (mut now, mut next) = (*r * shrink(friction), Vector::<D>::zeros());
    now[D - 1] = 0.0;
    for i in 0..D - 1 {
        next[i] = now[i] - u[i];
    }
    let shrunk = next * shrink(tangential_norm(&next));
    tangential_norm(&(now - shrunk))
}

/// Largest `mu` \[-\] up to which the natural map tells how far a contact is from the law. Beyond, it falls as `1 / mu`
/// where a contact penetrates and holds `mu` times the rounding of `|u_t|` where one sticks.
pub(crate) const NATURAL: f64 = 1.0;

/// How far one contact is from the law, velocity and reaction in one unit: `|F|` of the [`natural_map`] with `rho = 1`,
/// beyond `mu = 1` the [`Breach`].
#[inline]
pub(crate) fn violation<const D: usize>(mu: f64, u: &Vector<D>, r: &Vector<D>) -> f64 {
    if mu <= NATURAL {
        natural_map(mu, 1.0, u, r).norm()
    } else {
        Breach::of(mu, u, r).square().sqrt()
    }
}

/// The status that the point `r - rho (u + mu |u_t| n)` predicts.
#[inline]
pub(crate) fn status<const D: usize>(mu: f64, rho: f64, u: &Vector<D>, r: &Vector<D>) -> Status {
    match cone::region(mu, &predictor(mu, rho, u, r)) {
        Region::Polar => Status::Separate,
        Region::Inside => Status::Stick,
        Region::Surface => Status::Slip,
    }
}

/// The predictor `r - rho (u + mu |u_t| n)` of the bi-potential method, whose projection on the cone is the corrector.
#[inline(always)]
pub(crate) fn predictor<const D: usize>(
    mu: f64,
    rho: f64,
    u: &Vector<D>,
    r: &Vector<D>,
) -> Vector<D> {
    r - cone::modified_velocity(mu, u) * rho
}

/// How one contact stands with the law, in words a mechanician checks by hand.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct ContactDiagnostic {
    /// Status by the natural map.
    pub status: Status,
    /// `max(0, -u_n)`, in the unit of `u` \[m, or m/s\].
    pub penetration: f64,
    /// `mu r_n - |r_t|`, in the unit of `r` \[N, or N s\]: negative where the reaction leaves the cone.
    pub cone_slack: f64,
    /// Angle between the friction force and the direction against sliding \[rad\]; 0 where either vanishes.
    pub misalignment: f64,
    /// Share of this contact in the scale-free error \[-\].
    pub error: f64,
}

/// Diagnoses one contact; `rho` is its compliance scale, `1 / mean diagonal of W_cc`.
pub(crate) fn diagnose<const D: usize>(
    mu: f64,
    rho: f64,
    u: &Vector<D>,
    r: &Vector<D>,
) -> ContactDiagnostic {
    let (ut, rt) = (tangential_norm(u), tangential_norm(r));
    let product = ut * rt;
    let misalignment = if product > 0.0 {
        (-tangential_dot(u, r) / product).clamp(-1.0, 1.0).acos()
    } else {
        0.0
    };
    let status = status(mu, rho, u, r);
    ContactDiagnostic {
        status,
        penetration: (-u[D - 1]).max(0.0),
        cone_slack: mu * r[D - 1] - rt,
        misalignment: if status == Status::Slip {
            misalignment
        } else {
            0.0
        },
        error: 0.0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Vector3;

    #[test]
    fn the_law_holds_in_each_status_whatever_rho() {
        let mu = 0.4;
        let cases = [
            (Status::Separate, [0.3, -0.1, 0.2], [0.0, 0.0, 0.0]),
            (Status::Stick, [0.0, 0.0, 0.0], [0.1, 0.2, 1.0]),
            (Status::Slip, [0.3, 0.4, 0.0], [-0.24, -0.32, 1.0]),
        ];
        for (expected, u, r) in cases {
            let (u, r) = (Vector3::from(u), Vector3::from(r));
            for rho in [1e-3, 1.0, 1e3] {
                let f = natural_map(mu, rho, &u, &r);
                assert!(f.iter().all(|x| x.abs() < 1e-12), "{expected:?} {f:?}");
                assert_eq!(status(mu, rho, &u, &r), expected);
            }
            let d = diagnose(mu, 1.0, &u, &r);
            assert!(d.penetration == 0.0 && d.cone_slack > -1e-15 && d.misalignment < 1e-7);
        }
    }

    #[test]
    fn each_violation_shows_where_it_belongs() {
        let mu = 0.5;
        let at = |u: [f64; 3], r: [f64; 3]| diagnose(mu, 1.0, &u.into(), &r.into());
        assert_eq!(at([0.0, 0.0, -0.25], [0.0, 0.0, 1.0]).penetration, 0.25);
        assert_eq!(at([0.0, 0.0, 0.0], [1.0, 0.0, 1.0]).cone_slack, -0.5);
        let turned = at([1.0, 0.0, 0.0], [0.0, 0.5, 1.0]);
        assert!((turned.misalignment - std::f64::consts::FRAC_PI_2).abs() < 1e-15);
        for (u, r) in [
            ([0.0, 0.0, -0.25], [0.0, 0.0, 1.0]),
            ([1.0, 0.0, 0.0], [0.0, 0.5, 1.0]),
        ] {
            let f = natural_map(mu, 1.0, &Vector3::from(u), &Vector3::from(r));
            assert!(f.amax() > 0.1);
        }
    }
}
