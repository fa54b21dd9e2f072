//! Coulomb's cone, its projection and the bi-potential.
//!
//! `K = { r : |r_t| <= mu r_n }` holds the admissible reactions, its dual `K* = { v : v_n >= mu |v_t| }` the modified
//! velocities `u + mu |u_t| n`. Contact and friction together say `r in K`, `u + mu |u_t| n in K*`, orthogonal
//! \[deSaxce1998\]: one equation, `r = Proj_K(r - rho (u + mu |u_t| n))` for any `rho > 0` [Hu2022, eq. 31].

use std::ops::Range;

use nalgebra::Vector3;

use crate::error::ContactError;
use crate::local::{Vector, local_axes, tangential_norm};

/// How many components a contact has, and where they stand in flat vectors.
///
/// A flat vector holds [`dim`](Self::dim) entries a contact, contact after contact, normal last.
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
    #[must_use]
    pub const fn dim(self) -> usize {
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

    /// Where the entries of contact `k` stand in a flat vector.
    #[inline]
    #[must_use]
    pub const fn range(self, k: usize) -> Range<usize> {
        self.dim() * k..self.dim() * (k + 1)
    }

    /// Where the tangential entries of contact `k` stand in a flat vector.
    #[inline]
    #[must_use]
    pub const fn tangents(self, k: usize) -> Range<usize> {
        self.dim() * k..self.normal(k)
    }

    /// Where the normal entry of contact `k` stands in a flat vector.
    #[inline]
    #[must_use]
    pub const fn normal(self, k: usize) -> usize {
        self.dim() * k + self.dim() - 1
    }

    /// The contact of an entry of a flat vector.
    #[inline]
    #[must_use]
    pub const fn contact(self, entry: usize) -> usize {
        entry / self.dim()
    }

    /// Which of `(t1, t2, n)` the entries of a contact are.
    #[inline]
    #[must_use]
    pub const fn axes(self) -> &'static [usize] {
        local_axes(self.dim())
    }

    /// The entries of one contact in `(t1, t2, n)`; tangents that the cone does not have are zero.
    #[inline]
    #[must_use]
    pub fn spatial(self, entries: &[f64]) -> Vector3<f64> {
        let mut x = Vector3::zeros();
        for (v, axis) in entries.iter().zip(self.axes()) {
            x[*axis] = *v;
        }
        x
    }
}

/// Where a point lies with respect to `K` and its polar cone.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Region {
    /// In the polar cone: projects on the apex.
    Polar,
    /// In `K`: projects on itself.
    Inside,
    /// Elsewhere: projects on the surface of `K`.
    Surface,
}

/// The region of `v`.
#[inline]
pub(crate) fn region<const D: usize>(mu: f64, v: &Vector<D>) -> Region {
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
///
/// ```
/// use contact_bipotential::cone::project;
/// use contact_bipotential::nalgebra::Vector2;
///
/// // (t, n) beside a cone with mu = 1, and below its apex.
/// assert_eq!(project(1.0, &Vector2::new(2.0, 0.0)), Vector2::new(1.0, 1.0));
/// assert_eq!(project(1.0, &Vector2::new(0.5, -1.0)), Vector2::zeros());
/// ```
#[inline]
#[must_use]
pub fn project<const D: usize>(mu: f64, v: &Vector<D>) -> Vector<D> {
    let (t, n) = (tangential_norm(v), v[D - 1]);
    let mut p = Vector::zeros();
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
///
/// ```
/// use contact_bipotential::cone::{project, project_dual};
/// use contact_bipotential::nalgebra::Vector3;
///
/// // Moreau: every vector is a modified velocity less a reaction, at a right angle to each other.
/// let v = Vector3::new(1.0, -2.0, 0.5);
/// let (velocity, reaction) = (project_dual(0.3, &v), project(0.3, &-v));
/// assert!((velocity - reaction - v).amax() < 1e-14 && velocity.dot(&reaction).abs() < 1e-14);
/// ```
#[inline]
#[must_use]
pub fn project_dual<const D: usize>(mu: f64, v: &Vector<D>) -> Vector<D> {
    // Moreau: v = Proj_K*(v) - Proj_K(-v).
    project(mu, &-v) + v
}

/// The modified velocity `u + mu |u_t| n`.
#[inline(always)]
#[must_use]
pub fn modified_velocity<const D: usize>(mu: f64, u: &Vector<D>) -> Vector<D> {
    let mut v = *u;
    v[D - 1] += mu * tangential_norm(u);
    v
}

/// Bi-potential gap `u.r + mu r_n |u_t|` [J, or the unit of `u.r`].
///
/// For `r` in `K` and `u_n >= 0` it is never negative, and zero exactly where `u` and `r` obey contact and friction
/// \[deSaxce1998\]; outside those sets the bi-potential is infinite, so check them too.
///
/// ```
/// use contact_bipotential::cone::bipotential_gap;
/// use contact_bipotential::nalgebra::Vector3;
///
/// // Sliding along t1 with mu = 0.5: friction at its limit against the slip, then half of it.
/// let u = Vector3::new(2.0, 0.0, 0.0);
/// assert_eq!(bipotential_gap(0.5, &u, &Vector3::new(-0.5, 0.0, 1.0)), 0.0);
/// assert_eq!(bipotential_gap(0.5, &u, &Vector3::new(-0.25, 0.0, 1.0)), 0.5);
/// ```
#[inline]
#[must_use]
pub fn bipotential_gap<const D: usize>(mu: f64, u: &Vector<D>, r: &Vector<D>) -> f64 {
    modified_velocity(mu, u).dot(r)
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{Vector1, Vector2};
    use proptest::prelude::*;

    fn inside<const D: usize>(mu: f64, v: &Vector<D>) -> bool {
        tangential_norm(v) <= mu * v[D - 1] + 1e-12
    }

    fn is_projection<const D: usize>(mu: f64, v: &Vector<D>) {
        // Characterisation without the formula: p in K, v - p in the polar cone, orthogonal.
        let p = project(mu, v);
        let rest = p - v;
        let scale = 1.0 + v.dot(v);
        assert!(inside(mu, &p), "{v:?} {p:?}");
        assert!(p.dot(&rest).abs() <= 1e-13 * scale);
        assert!(rest[D - 1] >= mu * tangential_norm(&rest) - 1e-13 * scale);
        let d = project_dual(mu, v);
        assert!(d[D - 1] >= mu * tangential_norm(&d) - 1e-13 * scale);
        let q = project(mu, &p);
        assert!((p - q).amax() <= 1e-13 * scale, "projecting twice moves");
        let expected = match region(mu, v) {
            Region::Inside => rest.dot(&rest) == 0.0,
            Region::Polar => p.dot(&p) == 0.0,
            Region::Surface => (tangential_norm(&p) - mu * p[D - 1]).abs() <= 1e-13 * scale,
        };
        assert!(expected, "{v:?} {p:?}");
    }

    proptest! {
        #[test]
        fn projection_is_characterised_by_moreau(
            mu in prop_oneof![Just(0.0), 0.0..5.0], v in prop::array::uniform3(-10.0..10.0_f64)
        ) {
            is_projection::<3>(mu, &v.into());
            is_projection::<2>(mu, &Vector2::new(v[0], v[1]));
            is_projection::<1>(mu, &Vector1::new(v[0]));
        }

        #[test]
        fn gap_is_not_negative_and_vanishes_on_the_law(
            mu in 0.0..3.0, a in prop::array::uniform3(-1.0..1.0_f64), n in 0.0..1.0_f64, slip in 0.0..2.0_f64
        ) {
            let r = project(mu, &Vector3::from(a));
            let u = Vector3::new(a[1], -a[2], n);
            prop_assert!(bipotential_gap(mu, &u, &r) >= -1e-14);
            let sliding = Vector3::new(slip * a[0], slip * a[1], 0.0);
            let t = tangential_norm(&sliding);
            prop_assume!(t > 1e-6);
            let friction = Vector3::new(-mu * n * sliding[0] / t, -mu * n * sliding[1] / t, n);
            prop_assert!(bipotential_gap(mu, &sliding, &friction).abs() < 1e-14);
        }
    }

    #[test]
    fn apex_surface_and_inside_by_hand() {
        let space = |mu, v: [f64; 3]| <[f64; 3]>::from(project(mu, &Vector3::from(v)));
        assert_eq!(space(0.5, [0.0, 0.0, -1.0]), [0.0; 3]);
        assert_eq!(space(0.5, [0.1, 0.0, 1.0]), [0.1, 0.0, 1.0]);
        assert_eq!(
            project(1.0, &Vector2::new(2.0, 0.0)),
            Vector2::new(1.0, 1.0)
        );
        assert_eq!(space(0.0, [3.0, 4.0, 2.0]), [0.0, 0.0, 2.0]);
        assert_eq!(project(7.0, &Vector1::new(-2.0)), Vector1::zeros());
        assert_eq!(space(0.0, [0.0, 0.0, 0.0]), [0.0; 3]);
    }

    #[test]
    fn entries_of_flat_vectors_are_counted_by_contacts() {
        for cone in [Cone::Frictionless, Cone::Planar, Cone::Spatial] {
            let d = cone.dim();
            assert_eq!(cone.range(2), 2 * d..3 * d);
            assert_eq!(cone.normal(2), 3 * d - 1);
            assert_eq!(cone.tangents(2), 2 * d..3 * d - 1);
            assert!(cone.range(2).all(|entry| cone.contact(entry) == 2));
            assert_eq!(cone.axes().last(), Some(&2));
        }
        assert_eq!(
            Cone::Planar.spatial(&[1.0, 2.0]),
            Vector3::new(1.0, 0.0, 2.0)
        );
    }
}
