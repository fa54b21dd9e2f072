//! Adhesion: pull-off of a ball, a bond under a ramp.

use std::f64::consts::PI;

/// DMT: the pull-off force of a rigid ball over `pi w R` \[-\] where the half-space hardly deforms \[Derjaguin1975\].
pub const DMT: f64 = 2.0;
/// JKR: the same where bonds are short against the deformation \[Johnson1971\].
pub const JKR: f64 = 1.5;

/// Maugis parameter \[-\] of a ball of radius `r` \[m\], bonds of energy `w` \[J/m^2\] and stiffness `c` \[N/m^3\] on a
/// half-space of `e_star` \[Pa\]: `2 s0 (9 R / (16 pi w E*^2))^(1/3)`, `s0 = sqrt(w C)`.
pub fn maugis_parameter(e_star: f64, r: f64, w: f64, c: f64) -> f64 {
    2.0 * (w * c).sqrt() * (9.0 * r / (16.0 * PI * w * e_star * e_star)).cbrt()
}

/// Maugis: the pull-off force over `pi w R` \[-\] where bonds carry the same stress until they break, for a Maugis
/// parameter > 0 \[Maugis1992\].
pub fn maugis_dugdale(lambda: f64) -> f64 {
    // The pull over the ratio m > 1 of the outer and the inner radius of the ring of bonds; x = ln(m - 1).
    let pull = |x: f64| {
        let m = 1.0 + x.exp();
        let (root, angle) = ((m * m - 1.0).sqrt(), (1.0 / m).acos());
        let square = 0.5 * lambda * (root + (m * m - 2.0) * angle);
        let linear = 4.0 / 3.0 * lambda * lambda * (root * angle - m + 1.0);
        let radius = 2.0 / (linear + (linear * linear + 4.0 * square).sqrt());
        lambda * radius * radius * (root + m * m * angle) - radius.powi(3)
    };
    let places = (0..=400).map(|k| -8.0 + 0.05 * f64::from(k));
    let largest = |best: f64, x: f64| if pull(x) > pull(best) { x } else { best };
    let around = places.fold(-8.0, largest);
    let (mut low, mut high) = (around - 0.05, around + 0.05);
    for _ in 0..60 {
        let (a, b) = (low + (high - low) / 3.0, high - (high - low) / 3.0);
        if pull(a) < pull(b) {
            low = a;
        } else {
            high = b;
        }
    }
    pull(0.5 * (low + high))
}

/// Intensity \[-\] of a bond that was whole and is stretched at a constant rate from zero, at `s` times the stretch at
/// which bonds start to break; `de = b v / (w x0)` \[-\] \[Raous1999\]: `beta = exp((1 - s^3)/(3 De)) + int_1^s
/// exp((r^3 - s^3)/(3 De)) dr / De`.
pub fn bond_ramp(de: f64, s: f64) -> f64 {
    if s <= 1.0 {
        return 1.0;
    }
    if de == 0.0 {
        return 1.0 / (s * s);
    }
    let weight = |r: f64| ((r - s) * (r * r + r * s + s * s) / (3.0 * de)).exp();
    // Beyond exp(-45) nothing is left of the past.
    let start = (s - 45.0 * de / (s * s).max(1.0)).max(1.0);
    let start = if weight(start) > 1e-18 { 1.0 } else { start };
    let panels = 4000;
    let h = (s - start) / f64::from(panels);
    let node = |k: i32| {
        let simpson = match k {
            0 => 1.0,
            _ if k == panels => 1.0,
            _ if k % 2 == 1 => 4.0,
            _ => 2.0,
        };
        simpson * weight(start + h * f64::from(k))
    };
    weight(1.0) + (0..=panels).map(node).sum::<f64>() * h / (3.0 * de)
}

/// Steady force per width \[N/m\] that peels a strip of `stiffness` `E' t` \[N/m\] and bonds of energy `w` \[J/m^2\]
/// off at a right angle: the end moves by `1 + F / (E' t)` per length, half of the stretch stays in the strip
/// \[Kendall1975\].
pub fn peel_force(w: f64, stiffness: f64) -> f64 {
    2.0 * w / (1.0 + (1.0 + 2.0 * w / stiffness).sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    #[test]
    fn maugis_lies_between_the_limits() {
        for (lambda, told) in [(0.1, 1.95), (0.6, 1.68), (2.0, 1.53)] {
            assert_relative_eq!(maugis_dugdale(lambda), told, epsilon = 0.006);
        }
        assert_relative_eq!(maugis_dugdale(1e-3), DMT, epsilon = 2e-3);
        assert_relative_eq!(maugis_dugdale(30.0), JKR, epsilon = 2e-3);
    }

    #[test]
    fn a_slow_ramp_is_the_rate_independent_limit() {
        assert_relative_eq!(bond_ramp(1.0, 2.0), 0.404831811977178, epsilon = 1e-12);
        assert_relative_eq!(bond_ramp(1e-5, 3.0), 1.0 / 9.0, epsilon = 1e-5);
        assert_relative_eq!(bond_ramp(0.3, 1.0 + 1e-9), 1.0, epsilon = 1e-8);
        // b beta' = w - k beta: De dbeta/ds = 1 - s^2 beta.
        let (h, s) = (1e-4, 1.7);
        let slope = (bond_ramp(0.2, s + h) - bond_ramp(0.2, s - h)) / (2.0 * h);
        assert_relative_eq!(0.2 * slope, 1.0 - s * s * bond_ramp(0.2, s), epsilon = 1e-6);
    }
}
