//! Partial slip of Cattaneo and Mindlin, for contacts whose pressure does not depend on the friction.

use std::f64::consts::PI;

/// Two bodies under a constant load and a smaller sideways load `T = q mu P`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PartialSlip {
    /// Radius of the part that sticks over the radius of contact \[-\].
    pub stick: f64,
    /// Energy lost in a cycle between -T and T \[J\]; per metre of thickness in the plane \[J/m\].
    pub loss: f64,
}

/// Under a ball of `radius` of contact \[m\], pressed by `force` \[N\]: `1/G* = (2 - nu_1)/G_1 + (2 - nu_2)/G_2`. Exact
/// for two bodies of one material with `nu = 0` \[Johnson1985, eq. 7.40 and 7.57\].
pub fn under_ball(g_star: f64, mu: f64, force: f64, radius: f64, q: f64) -> PartialSlip {
    let left = 1.0 - q;
    let braces = 1.0 - left.powf(5.0 / 3.0) - 5.0 * q / 6.0 * (1.0 + left.powf(2.0 / 3.0));
    PartialSlip {
        stick: left.cbrt(),
        loss: 0.9 * (mu * force).powi(2) / (g_star * radius) * braces,
    }
}

/// Under a cylinder pressed by `force` \[N/m\]. Exact where Dundurs' second constant is zero, as for two bodies of one
/// material.
///
/// In the plane the sideways compliance is that of the depth, `dd/dP = -ln(P)/(pi E*)` up to a constant, so that by the
/// superposition of two Hertz contacts `delta(T) = mu (d(P) - d(P - T/mu))`. A cycle has the area `4 T delta - 8 int
/// delta dT`, in which the constant, an elastic spring, drops out.
pub fn under_cylinder(e_star: f64, mu: f64, force: f64, q: f64) -> PartialSlip {
    let left = 1.0 - q;
    PartialSlip {
        stick: left.sqrt(),
        loss: (mu * force).powi(2) / (PI * e_star)
            * (4.0 * left * left.ln() + 4.0 * q - 2.0 * q * q),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    /// Area of the cycle whose first loading is `delta(q)` in units of `T_full = mu P`: its branches are the curve
    /// twice as large.
    fn area(delta: impl Fn(f64) -> f64, q: f64) -> f64 {
        let n = 20_000;
        let step = q / f64::from(n);
        let below: f64 = (0..n)
            .map(|k| delta(step * (f64::from(k) + 0.5)) * step)
            .sum();
        4.0 * q * delta(q) - 8.0 * below
    }

    #[test]
    fn losses_are_the_area_of_the_cycle() {
        let (mu, p, q) = (0.3, 2.0, 0.7);
        let (g_star, a) = (5.0, 0.1);
        let ball = |q: f64| 3.0 * mu * p / (16.0 * g_star * a) * (1.0 - (1.0 - q).powf(2.0 / 3.0));
        let exact = under_ball(g_star, mu, p, a, q).loss;
        assert_relative_eq!(mu * p * area(ball, q), exact, max_relative = 1e-6);
        let e_star = 4.0;
        let depth = |p: f64| -p * p.ln() / (PI * e_star);
        let cylinder = |q: f64| mu * (depth(p) - depth(p * (1.0 - q)));
        let exact = under_cylinder(e_star, mu, p, q).loss;
        assert_relative_eq!(mu * p * area(cylinder, q), exact, max_relative = 1e-6);
    }
}
