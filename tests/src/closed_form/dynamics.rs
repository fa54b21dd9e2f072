//! Bars, blocks and what moves.

use std::f64::consts::PI;

/// A contact of bars.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BarImpact {
    /// How long it lasts \[s\].
    pub duration: f64,
    /// Constant force \[N\].
    pub force: f64,
}

/// A bar of a length \[m\], wave speed \[m/s\], density \[kg/m^3\], velocity \[m/s\] and area \[m^2\] that hits a rigid
/// wall: the wave runs to the free end and back.
pub fn bar_on_wall(length: f64, c: f64, density: f64, velocity: f64, area: f64) -> BarImpact {
    BarImpact {
        duration: 2.0 * length / c,
        force: density * c * velocity * area,
    }
}

/// The same against an equal bar that is clamped at its far end; `z = rho c A` is the impedance \[kg/s\]. The wave in
/// the struck bar comes back when that of the striker does and takes its place, and both run once more.
pub fn bar_on_clamped_bar(length: f64, c: f64, z: f64, velocity: f64) -> BarImpact {
    BarImpact {
        duration: 4.0 * length / c,
        force: 0.5 * z * velocity,
    }
}

/// A bar of impedance `z1` against a free one of impedance `z2` \[kg/s\], not smaller, in which a wave takes as long
/// there and back.
pub fn bar_exchange(length: f64, c: f64, z1: f64, z2: f64, velocity: f64) -> BarImpact {
    BarImpact {
        duration: 2.0 * length / c,
        force: velocity * z1 * z2 / (z1 + z2),
    }
}

/// Where and when friction has stopped a block.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stop {
    /// Way \[m\].
    pub way: f64,
    /// Time \[s\].
    pub time: f64,
}

/// A rigid block with the velocity `v0` \[m/s\] on a level plane, gravity `g` \[m/s^2\].
pub fn sliding_stop(v0: f64, mu: f64, g: f64) -> Stop {
    Stop {
        way: v0 * v0 / (2.0 * mu * g),
        time: v0 / (mu * g),
    }
}

/// Height \[m\] to which a rigid block that fell from `h` \[m\] comes after the `n`-th bounce with restitution `e`.
pub fn bounce_height(h: f64, e: f64, n: i32) -> f64 {
    h * e.powi(2 * n)
}

/// When a rigid block that fell from `h` \[m\] has made all its bounces \[s\].
pub fn bounce_rest_time(h: f64, e: f64, g: f64) -> f64 {
    (2.0 * h / g).sqrt() * (1.0 + e) / (1.0 - e)
}

/// Period of the first longitudinal vibration of a free bar \[s\], length \[m\] and wave speed \[m/s\].
pub fn free_bar_period(length: f64, c: f64) -> f64 {
    2.0 * length / c
}

/// Period \[s\] that the trapezoidal rule with the step `dt` \[s\] gives a linear vibration of the period `t` \[s\]:
/// `tan(omega' dt/2) = omega dt/2`.
pub fn trapezoidal_period(t: f64, dt: f64) -> f64 {
    PI * dt / (PI * dt / t).atan()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Characteristics on a lattice of half cells: what two bars do to each other, without a formula for it.
    fn lattice(cells: [usize; 2], z: [f64; 2], clamped: bool) -> (Vec<f64>, usize) {
        // Right and left going parts of the particle velocity, stress force = z (left - right) in compression
        // right - left.
        let (n, m) = (cells[0], cells[1]);
        let mut right = [vec![1.0; n], vec![0.0; m]];
        let mut left = [vec![0.0; n], vec![0.0; m]];
        right[0].fill(0.5);
        left[0].fill(0.5);
        let mut force = Vec::new();
        for _ in 0..10 * n {
            let (to, from) = (right[0][n - 1], left[1][0]);
            // Compression of the contact with both ends moving together.
            let f = 2.0 * z[0] * z[1] / (z[0] + z[1]) * (to - from);
            if f <= 1e-12 {
                break;
            }
            force.push(f);
            let (back, on) = (to - f / z[0], from + f / z[1]);
            let ends = [left[0][0], right[1][m - 1]];
            left[0].rotate_left(1);
            left[0][n - 1] = back;
            right[0].rotate_right(1);
            right[0][0] = ends[0];
            right[1].rotate_right(1);
            right[1][0] = on;
            left[1].rotate_left(1);
            left[1][m - 1] = if clamped { -ends[1] } else { ends[1] };
        }
        (force, 2 * n)
    }

    #[test]
    fn bars_do_what_their_characteristics_do() {
        let check = |(force, round_trip): (Vec<f64>, usize), exact: BarImpact| {
            let steps = exact.duration / 2.0 * round_trip as f64;
            assert!((force.len() as f64 - steps).abs() <= 1.0, "{}", force.len());
            assert!(
                force.iter().all(|f| (f - exact.force).abs() < 1e-12),
                "{force:?}"
            );
        };
        check(
            lattice([16, 16], [3.0, 3.0], true),
            bar_on_clamped_bar(1.0, 1.0, 3.0, 1.0),
        );
        check(
            lattice([16, 16], [3.0, 3.0], false),
            bar_exchange(1.0, 1.0, 3.0, 3.0, 1.0),
        );
        check(
            lattice([16, 16], [3.0, 12.0], false),
            bar_exchange(1.0, 1.0, 3.0, 12.0, 1.0),
        );
        check(
            lattice([16, 16], [3.0, 1e15], false),
            bar_on_wall(1.0, 1.0, 3.0, 1.0, 1.0),
        );
    }

    #[test]
    fn the_trapezoidal_rule_swings_as_slowly_as_told() {
        let (t, dt) = (1.0, 0.05);
        let omega = 2.0 * PI / t;
        let (mut u, mut v, mut angle) = (1.0_f64, 0.0_f64, 0.0);
        for _ in 0..100 {
            let next = (u * (1.0 - (0.5 * omega * dt).powi(2)) + dt * v)
                / (1.0 + (0.5 * omega * dt).powi(2));
            let (from, w) = (
                (v / omega).atan2(u),
                v - 0.5 * dt * omega * omega * (u + next),
            );
            angle += (from - (w / omega).atan2(next)).rem_euclid(2.0 * PI);
            (u, v) = (next, w);
        }
        let period = 100.0 * dt * 2.0 * PI / angle;
        assert!(
            (period - trapezoidal_period(t, dt)).abs() < 1e-12,
            "{period}"
        );
    }

    #[test]
    fn bounces_add_up_to_the_time_of_rest() {
        let (h, e, g) = (1.0, 0.6, 10.0);
        let fall = |n: i32| (2.0 * bounce_height(h, e, n) / g).sqrt();
        let sum = fall(0) + (1..200).map(|n| 2.0 * fall(n)).sum::<f64>();
        assert!((sum - bounce_rest_time(h, e, g)).abs() < 1e-12);
    }
}
