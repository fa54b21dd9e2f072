//! Coulomb's cone, its projection and the bi-potential.
//!
//! `K = { r : |r_t| <= mu r_n }` holds the admissible reactions, its dual `K* = { v : v_n >= mu |v_t| }` the modified
//! velocities `u + mu |u_t| n`. Contact and friction together say `r in K`, `u + mu |u_t| n in K*`, orthogonal
//! \[deSaxce1998\]: one equation, `r = Proj_K(r - rho (u + mu |u_t| n))` for any `rho > 0` [Hu2022, eq. 31].

use crate::error::ContactError;
use crate::local::{Vector, dot, tangential_norm};

/// How many components a contact has.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Cone {
    /// Normal component only: `(n)`.
    Frictionless,
    /// One tangent, plane problems: `(t, n)`.
    Planar,
    /// Two tangents: `(t1, t2, n)`.
    Spatial,
}

impl Cone {
    /// Entries a contact.
    #[inline]
    pub fn dim(self) -> usize {
        match self {
            Cone::Frictionless => 1,
            Cone::Planar => 2,
            Cone::Spatial => 3,
        }
    }

    /// The cone with `dim` entries a contact.
    ///
    /// # Errors
    /// [`ContactError::ConeDimension`] unless `dim` is 1, 2 or 3.
    pub fn from_dim(dim: usize) -> Result<Self, ContactError> {
        match dim {
            1 => Ok(Cone::Frictionless),
            2 => Ok(Cone::Planar),
            3 => Ok(Cone::Spatial),
            _ => Err(ContactError::ConeDimension { dim }),
        }
    }
}

/// Where a point lies with respect to `K` and its polar cone.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Region {
    /// In the polar cone: projects on the apex.
    Polar,
    /// In `K`: projects on itself.
    Inside,
    /// Elsewhere: projects on the surface of `K`.
    Surface,
}

/// The region of `v`.
#[inline]
pub fn region<const D: usize>(mu: f64, v: &Vector<D>) -> Region {
    let (t, n) = (tangential_norm(v), v[D - 1]);
    // The polar cone first: without friction the axis of the polar cone has `t <= mu n` too.
    if mu * t <= -n {
        Region::Polar
    } else if t <= mu * n {
        Region::Inside
    } else {
        Region::Surface
    }
}

/// Orthogonal projection on `K`.
#[inline]
pub fn project<const D: usize>(mu: f64, v: &Vector<D>) -> Vector<D> {
    let (t, n) = (tangential_norm(v), v[D - 1]);
    let mut p = [0.0; D];
    if mu * t <= -n {
        return p;
    }
    if t <= mu * n {
        return *v;
    }
    let height = (n + mu * t) / (1.0 + mu * mu);
    let shrink = mu * height / t;
    for i in 0..D - 1 {
        p[i] = v[i] * shrink;
    }
    p[D - 1] = height;
    p
}

/// Orthogonal projection on the dual cone `K*`.
#[inline]
pub fn project_dual<const D: usize>(mu: f64, v: &Vector<D>) -> Vector<D> {
    // Moreau: v = Proj_K*(v) - Proj_K(-v).
    let mut minus = *v;
    for x in &mut minus {
        *x = -*x;
    }
    let mut p = project(mu, &minus);
    for i in 0..D {
        p[i] += v[i];
    }
    p
}

/// The modified velocity `u + mu |u_t| n`.
#[inline(always)]
pub fn modified_velocity<const D: usize>(mu: f64, u: &Vector<D>) -> Vector<D> {
    let mut v = *u;
    v[D - 1] += mu * tangential_norm(u);
    v
}

/// Bi-potential gap `u.r + mu r_n |u_t|` [J, or the unit of `u.r`].
///
/// For `r` in `K` and `u_n >= 0` it is never negative, and zero exactly where `u` and `r` obey contact and friction
/// \[deSaxce1998\]; outside those sets the bi-potential is infinite, so check them too.
#[inline]
pub fn bipotential_gap<const D: usize>(mu: f64, u: &Vector<D>, r: &Vector<D>) -> f64 {
    dot(&modified_velocity(mu, u), r)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::local::difference;
    use proptest::prelude::*;

    fn inside<const D: usize>(mu: f64, v: &Vector<D>) -> bool {
        tangential_norm(v) <= mu * v[D - 1] + 1e-12
    }

    fn is_projection<const D: usize>(mu: f64, v: &Vector<D>) {
        // Characterisation without the formula: p in K, v - p in the polar cone, orthogonal.
        let p = project(mu, v);
        let rest = difference(&p, v);
        let scale = 1.0 + dot(v, v);
        assert!(inside(mu, &p), "{v:?} {p:?}");
        assert!(dot(&p, &rest).abs() <= 1e-13 * scale);
        assert!(rest[D - 1] >= mu * tangential_norm(&rest) - 1e-13 * scale);
        let d = project_dual(mu, v);
        assert!(d[D - 1] >= mu * tangential_norm(&d) - 1e-13 * scale);
        let q = project(mu, &p);
        for i in 0..D {
            assert!(
                (p[i] - q[i]).abs() <= 1e-13 * scale,
                "projecting twice moves"
            );
        }
        let expected = match region(mu, v) {
            Region::Inside => dot(&rest, &rest) == 0.0,
            Region::Polar => dot(&p, &p) == 0.0,
            Region::Surface => (tangential_norm(&p) - mu * p[D - 1]).abs() <= 1e-13 * scale,
        };
        assert!(expected, "{v:?} {p:?}");
    }

    proptest! {
        #[test]
        fn projection_is_characterised_by_moreau(
            mu in prop_oneof![Just(0.0), 0.0..5.0], v in prop::array::uniform3(-10.0..10.0_f64)
        ) {
            is_projection::<3>(mu, &v);
            is_projection::<2>(mu, &[v[0], v[1]]);
            is_projection::<1>(mu, &[v[0]]);
        }

        #[test]
        fn gap_is_not_negative_and_vanishes_on_the_law(
            mu in 0.0..3.0, a in prop::array::uniform3(-1.0..1.0_f64), n in 0.0..1.0_f64, slip in 0.0..2.0_f64
        ) {
            let r = project(mu, &a);
            let u = [a[1], -a[2], n];
            prop_assert!(bipotential_gap(mu, &u, &r) >= -1e-14);
            let sliding = [slip * a[0], slip * a[1], 0.0];
            let t = tangential_norm(&sliding);
            prop_assume!(t > 1e-6);
            let friction = [-mu * n * sliding[0] / t, -mu * n * sliding[1] / t, n];
            prop_assert!(bipotential_gap(mu, &sliding, &friction).abs() < 1e-14);
        }
    }

    #[test]
    fn apex_surface_and_inside_by_hand() {
        assert_eq!(project(0.5, &[0.0, 0.0, -1.0]), [0.0; 3]);
        assert_eq!(project(0.5, &[0.1, 0.0, 1.0]), [0.1, 0.0, 1.0]);
        assert_eq!(project(1.0, &[2.0, 0.0]), [1.0, 1.0]);
        assert_eq!(project(0.0, &[3.0, 4.0, 2.0]), [0.0, 0.0, 2.0]);
        assert_eq!(project(7.0, &[-2.0]), [0.0]);
        assert_eq!(project(0.0, &[0.0, 0.0, 0.0]), [0.0; 3]);
    }
}
