//! Frames of an interface: deterministic, right-handed and continuous in the normal.

use crate::geometry::vec3::{Vec3, axpy, cross, dot, reject, unit};

/// A rule that completes a unit normal to a frame, continuous in the normal.
///
/// No rule is continuous on the whole sphere, so each interface carries an anchor, a frame about its typical
/// normal `N`, and turns the anchor by the smallest rotation that takes `N` to `n`. The one exception, `n = -N`,
/// is as far from the interface's normals as it can be. A fixed normal gives a fixed frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FrameRule {
    anchor: Option<[Vec3; 3]>,
}

impl FrameRule {
    /// The rule in space, anchored at the typical normal of an interface.
    ///
    /// `typical` need not be a unit vector; a closed surface has none, and then zero is welcome.
    pub fn spatial(typical: [f64; 3]) -> Self {
        // A direction no mesh is aligned with: the opposite normal is then as good as never met.
        let fallback = [0.365_148, 0.547_723, 0.752_772];
        let n = unit(typical)
            .or_else(|| unit(fallback))
            .unwrap_or([0.0, 0.0, 1.0]);
        // Cyclic choice, so that coordinate normals get coordinate tangents: e_z -> (e_x, e_y), e_x -> (e_y, e_z) ..
        let [ax, ay, az] = n.map(f64::abs);
        let seed = if az >= ax && az >= ay {
            [1.0, 0.0, 0.0]
        } else if ax >= ay {
            [0.0, 1.0, 0.0]
        } else {
            [0.0, 0.0, 1.0]
        };
        let t1 = unit(reject(seed, n)).unwrap_or(seed);
        Self {
            anchor: Some([t1, cross(n, t1), n]),
        }
    }

    /// The rule of plane problems: `t1` in the plane, `t2 = -e_z`.
    pub fn planar() -> Self {
        Self { anchor: None }
    }

    /// Rows `t1`, `t2`, `n` of the frame at a unit normal; orthonormal to round-off and right-handed.
    pub fn at(&self, n: [f64; 3]) -> [[f64; 3]; 3] {
        let Some([a1, a2, a]) = self.anchor else {
            return [[n[1], -n[0], 0.0], [0.0, 0.0, -1.0], n];
        };
        if n == a {
            return [a1, a2, a];
        }
        let c = 1.0 + dot(a, n);
        // At the antipode the limit depends on the way there: half a turn about a1 is as good as any.
        let turned = if c > 1e-8 {
            let s = -dot(a1, n) / c;
            axpy(axpy(a1, s, a), s, n)
        } else {
            a1
        };
        let t1 = unit(reject(turned, n)).unwrap_or(a1);
        [t1, cross(n, t1), n]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::vec3::{norm, sub};
    use proptest::prelude::*;

    fn direction() -> impl Strategy<Value = Vec3> {
        [-1.0f64..1.0, -1.0f64..1.0, -1.0f64..1.0].prop_filter_map("no direction", |a| {
            if norm(a) > 0.1 { unit(a) } else { None }
        })
    }

    fn assert_right_handed(f: [Vec3; 3]) {
        for i in 0..3 {
            for j in 0..3 {
                let expected = if i == j { 1.0 } else { 0.0 };
                assert!((dot(f[i], f[j]) - expected).abs() < 1e-14, "{f:?}");
            }
        }
        assert!(dot(cross(f[0], f[1]), f[2]) > 0.999);
    }

    proptest! {
        #[test]
        fn frames_are_orthonormal_and_right_handed(a in direction(), n in direction()) {
            assert_right_handed(FrameRule::spatial(a).at(n));
            let flat = unit([n[0], n[1] + 2.0, 0.0]).unwrap();
            assert_right_handed(FrameRule::planar().at(flat));
        }

        #[test]
        fn frames_are_continuous_away_from_the_antipode(a in direction(), n in direction(), d in direction()) {
            prop_assume!(dot(a, n) > -0.9);
            let m = unit(axpy(n, 1e-7, d)).unwrap();
            let rule = FrameRule::spatial(a);
            let (f, g) = (rule.at(n), rule.at(m));
            // The tangents turn at most 2 / (1 + cos) times as fast as the normal.
            for i in 0..2 {
                prop_assert!(norm(sub(f[i], g[i])) < 1e-7 * 25.0);
            }
        }
    }

    #[test]
    fn coordinate_normals_get_coordinate_tangents() {
        for k in 0..3 {
            let mut n = [0.0; 3];
            n[k] = 1.0;
            let f = FrameRule::spatial(n).at(n);
            assert_eq!(f[0][(k + 1) % 3], 1.0);
            assert_eq!(f[1][(k + 2) % 3], 1.0);
        }
        assert_right_handed(FrameRule::spatial([0.0, 0.0, 1.0]).at([0.0, 0.0, -1.0]));
    }
}
