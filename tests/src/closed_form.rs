//! Closed forms, in SI units. `e_star` is `E / (1 - nu^2)`: an elastic body on a rigid one.

mod adhesion;
mod cone_strain;
mod dynamics;
mod oblique;
mod partial_slip;

use std::f64::consts::PI;

pub use adhesion::{DMT, JKR, bond_ramp, maugis_dugdale, maugis_parameter, peel_force};
pub use cone_strain::{
    Cubic, Gradient, cone_strain_slope, cubic_of_neo_hookean, cubic_of_saint_venant_kirchhoff,
};
pub use dynamics::{
    BarImpact, Stop, bar_exchange, bar_on_clamped_bar, bar_on_wall, bounce_height,
    bounce_rest_time, free_bar_period, sliding_stop, trapezoidal_period,
};
pub use oblique::{Oblique, Rebound};
pub use partial_slip::{PartialSlip, under_ball, under_cylinder};

/// Load \[N\], contact radius \[m\] and largest pressure \[Pa\] of a contact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pressed {
    /// Load \[N\]; per metre of thickness in the plane \[N/m\].
    pub force: f64,
    /// Radius or half-width of the contact \[m\].
    pub radius: f64,
    /// Largest pressure \[Pa\].
    pub pressure: f64,
}

/// Hertz: a sphere of radius `r` \[m\] pressed into a half-space by `depth` \[m\].
pub fn hertz_sphere(e_star: f64, r: f64, depth: f64) -> Pressed {
    let radius = (r * depth).sqrt();
    let force = 4.0 / 3.0 * e_star * radius * depth;
    Pressed {
        force,
        radius,
        pressure: 1.5 * force / (PI * radius * radius),
    }
}

/// Hertz: a cylinder of radius `r` \[m\] pressed on a half-space by `force` \[N/m\].
pub fn hertz_cylinder(e_star: f64, r: f64, force: f64) -> Pressed {
    let radius = (4.0 * force * r / (PI * e_star)).sqrt();
    Pressed {
        force,
        radius,
        pressure: 2.0 * force / (PI * radius),
    }
}

/// `int_0^1 w/s ds + int_1^inf (w - 1)/s ds` minus Euler's constant, `w = (cosh 2s - 1)/(sinh 2s + 2s)`: the depth of
/// an elastic layer on a smooth rigid base under a line load, beyond its logarithm \[-\].
const LAYER: f64 = -0.351_675_392_623_691;

/// Hertz: a cylinder of radius `r` \[m\] pressed by `depth` \[m\] into a layer of `thickness` \[m\], large against the
/// contact, on a smooth rigid base: `d = 2 F/(pi E*) (ln(2 H/a) + 1/2 + LAYER)`.
///
/// The surface of the layer under the pressure `cos k x` moves by `2 w(k H)/(E* k) cos k x`. Superposed for a line load
/// this is the logarithm of the half-plane with a constant, and the mean of the logarithm over the pressure of Hertz is
/// `ln(a/2) - 1/2`.
pub fn hertz_cylinder_on_layer(e_star: f64, r: f64, thickness: f64, depth: f64) -> Pressed {
    let force = |a: f64| PI * e_star * a * a / (4.0 * r);
    let depth_of =
        |a: f64| 2.0 * force(a) / (PI * e_star) * ((2.0 * thickness / a).ln() + 0.5 + LAYER);
    let (mut low, mut high) = (0.0, thickness);
    for _ in 0..200 {
        let middle = 0.5 * (low + high);
        if depth_of(middle) < depth {
            low = middle;
        } else {
            high = middle;
        }
    }
    hertz_cylinder(e_star, r, force(low))
}

/// Boussinesq and Love: force \[N\] on a cone of semi-apex angle `alpha` \[rad\] at `depth` \[m\] \[Feng2007, eq. 61,
/// corrected\].
pub fn cone_force(e_star: f64, alpha: f64, depth: f64) -> f64 {
    2.0 / PI * e_star * alpha.tan() * depth * depth
}

/// Radius of contact \[m\] of a cone.
pub fn cone_radius(alpha: f64, depth: f64) -> f64 {
    2.0 / PI * depth * alpha.tan()
}

/// Pressure \[Pa\] under a cone at the distance `s` \[m\] from its axis, inside the radius `a` \[m\] \[Feng2007, eq.
/// 60\].
pub fn cone_pressure(e_star: f64, alpha: f64, a: f64, s: f64) -> f64 {
    0.5 * e_star / alpha.tan() * (a / s).acosh()
}

/// Force \[N\] on a flat punch of radius `a` \[m\] at `depth` \[m\].
pub fn punch_force(e_star: f64, a: f64, depth: f64) -> f64 {
    2.0 * a * e_star * depth
}

/// Pressure \[Pa\] under a flat punch of radius `a` \[m\] with a force \[N\], at the distance `r` \[m\] from its axis.
pub fn punch_pressure(force: f64, a: f64, r: f64) -> f64 {
    force / (2.0 * PI * a * (a * a - r * r).sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    #[test]
    fn hertz_has_its_table_values() {
        let ball = hertz_sphere(1.0, 1.0, 0.008_254_82);
        assert_relative_eq!(ball.force, 1e-3, max_relative = 1e-5);
        assert_relative_eq!(ball.radius, 0.090_856, max_relative = 1e-5);
        assert_relative_eq!(ball.pressure, 0.057_840_7, max_relative = 1e-5);
        let cylinder = hertz_cylinder(1.0, 1.0, 1e-3);
        assert_relative_eq!(cylinder.radius, 0.035_682_5, max_relative = 1e-5);
        assert_relative_eq!(cylinder.pressure, 0.017_841_2, max_relative = 1e-5);
    }

    #[test]
    fn a_layer_is_pressed_as_its_waves_say() {
        let w = |s: f64| {
            if s > 20.0 {
                1.0
            } else {
                ((2.0 * s).cosh() - 1.0) / ((2.0 * s).sinh() + 2.0 * s)
            }
        };
        let n = 100_000;
        let sum = |from: f64, to: f64, f: &dyn Fn(f64) -> f64| -> f64 {
            let h = (to - from) / f64::from(n);
            (0..n).map(|k| f(from + h * (f64::from(k) + 0.5)) * h).sum()
        };
        let euler = 0.577_215_664_901_532_9;
        let found = sum(0.0, 1.0, &|s| w(s) / s) + sum(1.0, 30.0, &|s| (w(s) - 1.0) / s) - euler;
        assert!((found - LAYER).abs() < 1e-7, "{found}");
        let deep = hertz_cylinder_on_layer(1e9, 1.0, 0.1, 2.723_325e-6);
        assert_relative_eq!(deep.radius, 1e-3, max_relative = 1e-6);
    }

    #[test]
    fn the_pressure_under_a_cone_adds_up_to_its_force() {
        let (e_star, alpha, depth) = (2.0, 1.2, 0.3);
        let a = cone_radius(alpha, depth);
        // Midpoints, which keep off the logarithm at the apex.
        let n = 200_000;
        let rings = (0..n).map(|k| {
            let s = a * (f64::from(k) + 0.5) / f64::from(n);
            2.0 * PI * s * cone_pressure(e_star, alpha, a, s) * a / f64::from(n)
        });
        let sum: f64 = rings.sum();
        assert_relative_eq!(sum, cone_force(e_star, alpha, depth), max_relative = 1e-6);
    }
}
