//! Functions of the exponential update that lose no digits near zero.

/// Argument \[-\] below which series are taken: their first missing term is then below 4e-10 of the value, while the
/// closed forms lose digit after digit towards zero.
const SERIES: f64 = 0.1;

/// `(1 - e^-z) / z`.
pub(super) fn decay_mean(z: f64) -> f64 {
    if z == 0.0 { 1.0 } else { -(-z).exp_m1() / z }
}

/// Derivative of [`decay_mean`].
pub(super) fn decay_mean_slope(z: f64) -> f64 {
    if z.abs() < SERIES {
        -0.5 + z * (1.0 / 3.0 - z * (0.125 - z * (1.0 / 30.0 - z * (1.0 / 144.0 - z / 840.0))))
    } else {
        ((-z).exp() - decay_mean(z)) / z
    }
}

/// `1 / (1 - e^-z) - 1 / z`: weight of the end value that makes the exponential exact for large `z` too; 1/2 at zero.
pub(super) fn blend(z: f64) -> f64 {
    if z.abs() < SERIES {
        0.5 + z * (1.0 / 12.0 - z * z * (1.0 / 720.0 - z * z / 30_240.0))
    } else {
        -1.0 / (-z).exp_m1() - 1.0 / z
    }
}

/// Derivative of [`blend`].
pub(super) fn blend_slope(z: f64) -> f64 {
    if z.abs() < SERIES {
        1.0 / 12.0 - z * z * (1.0 / 240.0 - z * z / 6048.0)
    } else {
        let e = (-z).exp_m1();
        1.0 / (z * z) - (-z).exp() / (e * e)
    }
}
