//! A bar that nothing holds.

use crate::closed_form::free_bar_period;
use crate::{Case, Found, Ladder, Ran};

/// Turns and vibrates at large strain: what the time integration does to momentum, angular momentum and energy.
pub fn turning() -> Case {
    let steps = [0.04, 0.02, 0.01, 0.005];
    Case {
        name: "free-body",
        about: "A free elastic bar starts to spin unstressed, turns once and vibrates (period .4 s): changes of energy, angular \
                momentum and momentum from start to end, relative to what there is (momentum: to that of half the bar). The last ladder \
                takes steps of .1 to 1 periods for 30 s.",
        scene: "free-body",
        sets: Vec::new(),
        ladders: vec![
            Ladder::over_dt("trapezoidal rule", &steps, &[]).of_order(2.0),
            Ladder::over_dt("backward Euler", &steps, &["time.theta=1.0", "time.xi=1.0"])
                .of_order(1.0),
            Ladder::over_dt(
                "trapezoidal rule, steps too large, 30 s",
                &[0.4, 0.2, 0.1, 0.05],
                &["time.end=30.0"],
            ),
        ],
        measure: |ran| {
            let energy = ran.column("energy.kinetic")?[0];
            let end = ran.end("energy.kinetic")? + ran.end("energy.strain")?;
            let (start, last) = (
                momenta(ran, &ran.built.velocity, None),
                momenta(ran, &ran.last.v, Some(&ran.last.u)),
            );
            let drift = (last[0] - start[0]).hypot(last[1] - start[1]);
            // Half the bar at the speed of its middle: 200 kg, 1 m/s.
            Ok(vec![
                Found::exact("energy", "J", end, energy),
                Found::exact("angular momentum", "N m s", last[2], start[2]),
                Found::zero("momentum", "N s", drift, 200.0),
            ])
        },
    }
}

/// Vibrates at small strain: the period of its first longitudinal mode.
pub fn vibrating() -> Case {
    let steps = [0.04, 0.02, 0.01, 0.005];
    let scheme = "time.theta=1.0";
    Case {
        name: "free-vibration",
        about: "The free bar with a hundredth of the spin vibrates about its stretch at small strain, with the period 2 L/c = .4 s of \
                its first longitudinal mode; mean over the whole run. The trapezoidal rule lengthens it by (omega dt)^2/12.",
        scene: "free-body",
        sets: ["spin=(0.0, 0.0, 0.02)", "cells=(80, 1)", "time.end=9.0"]
            .map(str::to_owned)
            .to_vec(),
        ladders: vec![
            Ladder::over_dt("trapezoidal rule", &steps, &[]).of_order(2.0),
            Ladder::over_dt("backward Euler", &steps, &[scheme, "time.xi=1.0"]),
        ],
        measure: |ran| {
            Ok(vec![Found::exact(
                "period",
                "s",
                period(ran)?,
                free_bar_period(2.0, 10.0),
            )])
        },
    }
}

/// Momentum along x and y \[N s\] and angular momentum about the origin \[N m s\].
fn momenta(ran: &Ran, v: &[f64], u: Option<&[f64]>) -> [f64; 3] {
    let model = &ran.built.model;
    let mut p = vec![0.0; v.len()];
    model.mass.times(v, &mut p);
    let points = model
        .solid
        .mesh()
        .points
        .iter()
        .zip(p.chunks_exact(2))
        .enumerate();
    let mut sum = [0.0; 3];
    for (n, (point, p)) in points {
        let at = |c: usize| point[c] + u.map_or(0.0, |u| u[2 * n + c]);
        sum[0] += p[0];
        sum[1] += p[1];
        sum[2] += at(0) * p[1] - at(1) * p[0];
    }
    sum
}

/// Mean period of the distance of the ends \[s\], from where it rises through its mean.
fn period(ran: &Ran) -> Result<f64, String> {
    let end = |side: &str, c: &str| ran.column(&format!("probe.{side}.displacement.{c}"));
    let (x, y) = (
        (end("left", "x")?, end("right", "x")?),
        (end("left", "y")?, end("right", "y")?),
    );
    let times = ran.column("t")?;
    let length: Vec<f64> = (0..times.len())
        .map(|k| (2.0 + x.1[k] - x.0[k]).hypot(y.1[k] - y.0[k]))
        .collect();
    let most = length.iter().copied().fold(0.0, f64::max);
    // It swings between that of the start and the longest.
    let middle = 0.5 * (length[0] + most);
    let rises: Vec<f64> = (1..times.len())
        .filter(|&k| length[k - 1] < middle && length[k] >= middle)
        .map(|k| {
            let part = (middle - length[k - 1]) / (length[k] - length[k - 1]);
            times[k - 1] + part * (times[k] - times[k - 1])
        })
        .collect();
    match rises[..] {
        [first, .., last] => Ok((last - first) / (rises.len() - 1) as f64),
        _ => Ok(f64::NAN),
    }
}
