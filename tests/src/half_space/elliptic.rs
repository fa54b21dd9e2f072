//! Displacement of a half-space under a disc of constant traction, and the elliptic integrals in it.

use std::f64::consts::PI;

/// Displacement at the radius `r` by a unit traction on a disc of radius `c`, `E* = 1`.
pub(super) fn disc(r: f64, c: f64) -> f64 {
    if r <= c {
        let (_, e) = elliptic(r / c);
        return 4.0 * c / PI * e;
    }
    let (k, e) = elliptic(c / r);
    4.0 * r / PI * (e - (1.0 - (c / r).powi(2)) * k)
}

/// Complete elliptic integrals of the first and the second kind of the modulus `k` \[-\], 0 <= k < 1, by the
/// arithmetic-geometric mean; at `k = 1` the second only, the first being infinite.
fn elliptic(modulus: f64) -> (f64, f64) {
    if modulus == 1.0 {
        return (f64::INFINITY, 1.0);
    }
    let (mut a, mut b) = (1.0, (1.0 - modulus * modulus).sqrt());
    let (mut sum, mut power) = (0.5 * modulus * modulus, 0.5);
    while (a - b).abs() > 1e-15 * a {
        let c = 0.5 * (a - b);
        (a, b) = (0.5 * (a + b), (a * b).sqrt());
        power *= 2.0;
        sum += power * c * c;
    }
    let first = 0.5 * PI / a;
    (first, first * (1.0 - sum))
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    #[test]
    fn elliptic_integrals_take_their_closed_values() {
        assert_relative_eq!(
            elliptic(0.5_f64.sqrt()).0,
            1.854_074_677_301_371_9,
            epsilon = 1e-14
        );
        assert_eq!(elliptic(0.0), (0.5 * PI, 0.5 * PI));
        for k in [0.1_f64, 0.5, 0.9, 0.999] {
            let ((k1, e1), (k2, e2)) = (elliptic(k), elliptic((1.0 - k * k).sqrt()));
            assert_relative_eq!(e1 * k2 + e2 * k1 - k1 * k2, 0.5 * PI, epsilon = 1e-12);
        }
    }
}
