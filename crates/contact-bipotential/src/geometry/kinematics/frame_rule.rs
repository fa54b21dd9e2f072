//! Frames of an interface: deterministic, right-handed and continuous in the normal.

use nalgebra::{Matrix3, Vector3};

use crate::geometry::vector::{reject, unit};

/// A direction no mesh is aligned with, for interfaces without a typical normal: its opposite, where the rule is not
/// continuous, is then as good as never met.
const UNALIGNED: Vector3<f64> = Vector3::new(0.365_148, 0.547_723, 0.752_772);
/// Least `1 + cos` of the angle between anchor and normal \[-\] for which the smallest rotation between them is told
/// from round-off: nearer to the antipode than 1e-4 rad half a turn stands for it.
const ANTIPODE: f64 = 1e-8;

/// A rule that completes a unit normal to a frame, continuous in the normal.
///
/// No rule is continuous on the whole sphere, so each interface carries an anchor, a frame about its typical
/// normal `N`, and turns the anchor by the smallest rotation that takes `N` to `n`. The one exception, `n = -N`,
/// is as far from the interface's normals as it can be. A fixed normal gives a fixed frame.
///
/// ```
/// use contact_bipotential::FrameRule;
/// use contact_bipotential::nalgebra::{Matrix3, Vector3};
///
/// let floor = FrameRule::spatial(Vector3::z());
/// assert_eq!(floor.at(Vector3::z()), Matrix3::identity());
/// // In the plane the tangent lies in it.
/// let t1 = FrameRule::planar().at(Vector3::y()).column(0).into_owned();
/// assert_eq!(t1, Vector3::x());
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FrameRule {
    anchor: Option<Matrix3<f64>>,
}

impl FrameRule {
    /// The rule in space, anchored at the typical normal of an interface.
    ///
    /// `typical` need not be a unit vector; a closed surface has none, and then zero is welcome.
    #[must_use]
    pub fn spatial(typical: Vector3<f64>) -> Self {
        let n = unit(typical)
            .or_else(|| unit(UNALIGNED))
            .unwrap_or_else(Vector3::z);
        // Cyclic choice, so that coordinate normals get coordinate tangents: e_z -> (e_x, e_y), e_x -> (e_y, e_z) ..
        let [ax, ay, az]: [f64; 3] = n.abs().into();
        let seed = if az >= ax && az >= ay {
            Vector3::x()
        } else if ax >= ay {
            Vector3::y()
        } else {
            Vector3::z()
        };
        let t1 = unit(reject(seed, n)).unwrap_or(seed);
        Self {
            anchor: Some(Matrix3::from_columns(&[t1, n.cross(&t1), n])),
        }
    }

    /// The rule of plane problems: `t1` in the plane, `t2 = -e_z`.
    #[must_use]
    pub fn planar() -> Self {
        Self { anchor: None }
    }

    /// The frame at a unit normal, columns `t1`, `t2`, `n`: orthonormal to round-off and right-handed.
    #[must_use]
    pub fn at(&self, n: Vector3<f64>) -> Matrix3<f64> {
        let Some(anchor) = self.anchor else {
            return in_plane(n);
        };
        let (a1, a) = (anchor.column(0).into_owned(), anchor.column(2).into_owned());
        if n == a {
            return anchor;
        }
        let c = 1.0 + a.dot(&n);
        // At the antipode the limit depends on the way there: half a turn about a1 is as good as any.
        let turned = if c > ANTIPODE {
            let s = -a1.dot(&n) / c;
            a1 + s * a + s * n
        } else {
            a1
        };
        let t1 = unit(reject(turned, n)).unwrap_or(a1);
        Matrix3::from_columns(&[t1, n.cross(&t1), n])
    }
}

/// The frame in the plane z = 0 on the unit normal `n`: `t1 = (n_y, -n_x, 0)`, `t2 = -e_z`.
fn in_plane(n: Vector3<f64>) -> Matrix3<f64> {
    Matrix3::from_columns(&[
        Vector3::new(n[1], -n[0], 0.0),
        Vector3::new(0.0, 0.0, -1.0),
        n,
    ])
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn direction() -> impl Strategy<Value = Vector3<f64>> {
        prop::array::uniform3(-1.0f64..1.0).prop_filter_map("no direction", |a| {
            let a = Vector3::from(a);
            if a.norm() > 0.1 { unit(a) } else { None }
        })
    }

    fn assert_right_handed(f: Matrix3<f64>) {
        assert!((f.tr_mul(&f) - Matrix3::identity()).amax() < 1e-14, "{f}");
        let across = f.column(0).cross(&f.column(1));
        assert!((across - f.column(2)).amax() < 1e-14, "{f}");
    }

    proptest! {
        #[test]
        fn frames_are_orthonormal_and_right_handed(a in direction(), n in direction()) {
            assert_right_handed(FrameRule::spatial(a).at(n));
            let flat = unit(Vector3::new(n[0], n[1] + 2.0, 0.0)).unwrap();
            assert_right_handed(FrameRule::planar().at(flat));
        }

        #[test]
        fn frames_are_right_handed_and_orthonormal_at_their_anchor(n in direction()) {
            let f = FrameRule::spatial(n).at(n);
            assert_right_handed(f);
            let w = Vector3::new(0.3, -1.0, 2.0);
            prop_assert!((f * f.tr_mul(&w) - w).amax() < 1e-14);
            prop_assume!(n[0].hypot(n[1]) > 1e-3);
            assert_right_handed(FrameRule::planar().at(unit(Vector3::new(n[0], n[1], 0.0)).unwrap()));
        }

        #[test]
        fn frames_are_continuous_away_from_the_antipode(a in direction(), n in direction(), d in direction()) {
            prop_assume!(a.dot(&n) > -0.9);
            let m = unit(n + 1e-7 * d).unwrap();
            let rule = FrameRule::spatial(a);
            let (f, g) = (rule.at(n), rule.at(m));
            // The tangents turn at most 2 / (1 + cos) times as fast as the normal.
            for i in 0..2 {
                prop_assert!((f.column(i) - g.column(i)).norm() < 1e-7 * 25.0);
            }
        }
    }

    #[test]
    fn coordinate_normals_get_coordinate_tangents() {
        for k in 0..3 {
            let mut n = Vector3::zeros();
            n[k] = 1.0;
            let f = FrameRule::spatial(n).at(n);
            assert_eq!(f[((k + 1) % 3, 0)], 1.0);
            assert_eq!(f[((k + 2) % 3, 1)], 1.0);
        }
        assert_right_handed(FrameRule::spatial(Vector3::z()).at(-Vector3::z()));
    }

    #[test]
    fn poles_are_regular() {
        for pole in [Vector3::z(), -Vector3::z()] {
            assert_right_handed(FrameRule::spatial(pole).at(pole));
            assert_right_handed(FrameRule::spatial(Vector3::zeros()).at(pole));
        }
    }
}
