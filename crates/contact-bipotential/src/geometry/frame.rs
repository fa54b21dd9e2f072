//! Local frames: rows `t1`, `t2`, `n`, normal **last**, right-handed.

/// Rows `t1`, `t2`, `n` of a local frame.
pub type Frame = [[f64; 3]; 3];

/// A right-handed orthonormal frame on the unit normal `n`; a smooth function of `n` but across `n_z = 0` \[Duff2017\].
pub fn frame_from_normal(n: [f64; 3]) -> Frame {
    let sign = 1.0_f64.copysign(n[2]);
    let a = -1.0 / (sign + n[2]);
    let b = n[0] * n[1] * a;
    [
        [1.0 + sign * n[0] * n[0] * a, sign * b, -sign * n[0]],
        [b, sign + n[1] * n[1] * a, -n[1]],
        n,
    ]
}

/// The frame in the plane `z = 0` on the unit normal `n`: `t1 = (n_y, -n_x, 0)`, `t2 = -e_z`.
pub fn frame_in_plane(n: [f64; 2]) -> Frame {
    [[n[1], -n[0], 0.0], [0.0, 0.0, -1.0], [n[0], n[1], 0.0]]
}

/// Components of the global vector `v` in `frame`: `(v.t1, v.t2, v.n)`.
#[inline]
pub fn to_local(frame: &Frame, v: [f64; 3]) -> [f64; 3] {
    [0, 1, 2].map(|i| frame[i][0] * v[0] + frame[i][1] * v[1] + frame[i][2] * v[2])
}

/// The global vector with local components `x`.
#[inline]
pub fn to_global(frame: &Frame, x: [f64; 3]) -> [f64; 3] {
    [0, 1, 2].map(|k| frame[0][k] * x[0] + frame[1][k] * x[1] + frame[2][k] * x[2])
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn is_right_handed_orthonormal(f: &Frame) {
        for i in 0..3 {
            for j in 0..3 {
                let d: f64 = (0..3).map(|k| f[i][k] * f[j][k]).sum();
                assert!((d - f64::from(u8::from(i == j))).abs() < 1e-14, "{f:?}");
            }
        }
        let [a, b, c] = f;
        let cross = [
            a[1] * b[2] - a[2] * b[1],
            a[2] * b[0] - a[0] * b[2],
            a[0] * b[1] - a[1] * b[0],
        ];
        for k in 0..3 {
            assert!((cross[k] - c[k]).abs() < 1e-14, "{f:?}");
        }
    }

    proptest! {
        #[test]
        fn frames_are_right_handed_and_orthonormal(v in prop::array::uniform3(-1.0..1.0_f64)) {
            let length = v.iter().map(|x| x * x).sum::<f64>().sqrt();
            prop_assume!(length > 1e-3);
            let n = v.map(|x| x / length);
            let f = frame_from_normal(n);
            is_right_handed_orthonormal(&f);
            let w = [0.3, -1.0, 2.0];
            let back = to_global(&f, to_local(&f, w));
            for k in 0..3 {
                prop_assert!((back[k] - w[k]).abs() < 1e-14);
            }
            let flat = (v[0] * v[0] + v[1] * v[1]).sqrt();
            prop_assume!(flat > 1e-3);
            is_right_handed_orthonormal(&frame_in_plane([v[0] / flat, v[1] / flat]));
        }
    }

    #[test]
    fn poles_are_regular() {
        for z in [1.0, -1.0] {
            is_right_handed_orthonormal(&frame_from_normal([0.0, 0.0, z]));
        }
    }
}
