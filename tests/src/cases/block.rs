//! Stiff blocks that slide and bounce, against rigid ones.

use crate::closed_form::{bounce_height, bounce_rest_time, sliding_stop};
use crate::{Case, Found, Ladder, Ran};

/// Gravity of the scenes \[m/s^2\].
const G: f64 = 10.0;
/// Mass of a block \[kg\], of a metre of thickness.
const MASS: f64 = 200.0;

/// A block that friction stops.
pub fn sliding() -> Case {
    let steps = [0.008, 0.004, 0.002, 0.001];
    Case {
        name: "sliding-block",
        about: "A stiff block slides on a rigid plane and stops after v0/(mu g) = .4 s and v0^2/(2 mu g) = .2 m; friction takes all \
                of m v0^2/2 = 100 J. The sole is a node of the lower face, the fastest node any of the body; least velocity is that \
                of the sole over all times: negative is a reversal.",
        scene: "sliding-block",
        sets: Vec::new(),
        ladders: vec![
            Ladder::over_dt("backward Euler, velocity level", &steps, &[]).of_order(1.0),
            Ladder::over_dt(
                "backward Euler, position level",
                &steps,
                &["time.contact=Position"],
            )
            .of_order(1.0),
            Ladder::over_dt(
                "trapezoidal rule, velocity level",
                &steps,
                &["time.theta=0.5", "time.xi=0.5"],
            ),
            Ladder::over_dt(
                "trapezoidal rule, position level",
                &steps,
                &["time.theta=0.5", "time.xi=0.5", "time.contact=Position"],
            ),
        ],
        measure: measure_sliding,
    }
}

fn measure_sliding(ran: &Ran) -> Result<Vec<Found>, String> {
    let v0 = 1.0;
    let exact = sliding_stop(v0, 0.25, G);
    let sole = ran.curve("t", "probe.sole.velocity.x")?;
    let least = sole.iter().map(|p| p.1).fold(f64::INFINITY, f64::min);
    let moving = sole.iter().rposition(|p| p.1.abs() > 1e-9 * v0);
    let stopped = moving.and_then(|k| sole.get(k + 1));
    let stop = stopped.map_or(f64::INFINITY, |p| p.0);
    let fastest = ran.last.v.iter().fold(0.0_f64, |m, v| m.max(v.abs()));
    let end = ran.end("probe.sole.velocity.x")?;
    Ok(vec![
        Found::exact("way", "m", ran.end("probe.sole.displacement.x")?, exact.way),
        Found::exact("stop", "s", stop, exact.time),
        Found::exact(
            "friction",
            "J",
            ran.end("dissipation.friction")?,
            0.5 * MASS * v0 * v0,
        ),
        Found::zero("least velocity", "m/s", least.min(0.0), v0),
        Found::zero("sole at the end", "m/s", end, v0),
        Found::zero("fastest node at the end", "m/s", fastest, v0),
    ])
}

/// A block that bounces until it rests.
pub fn bouncing() -> Case {
    let steps = [0.002, 0.001, 0.0005, 0.00025];
    Case {
        name: "bouncing-block",
        about: "A stiff block falls from 1 m on a rigid plane with restitution e = .5: heights 1/4, 1/16, 1/64 m, at rest after \
                t0 (1 + e)/(1 - e) = 1.3416 s, infinitely many bounces later. Then the plane bears the weight of 2000 N. An impact is at \
                the end of the step in which it falls: errors have a part of first order that depends on where in the step it fell.",
        scene: "bouncing-block",
        sets: Vec::new(),
        ladders: vec![
            Ladder::over_dt("backward Euler", &steps, &[]),
            Ladder::over_dt("theta = 1/2, xi = 1", &steps, &["time.theta=0.5"]),
        ],
        measure: measure_bouncing,
    }
}

fn measure_bouncing(ran: &Ran) -> Result<Vec<Found>, String> {
    let (e, h) = (0.5, 1.0);
    let height: Vec<f64> = ran.column("probe.sole.displacement.y")?;
    let force = ran.column("force.ground.y")?;
    let times = ran.column("t")?;
    let speed = ran.column("probe.sole.velocity.y")?;
    let hits = (1..force.len()).filter(|&k| force[k] > 0.0 && force[k - 1] == 0.0);
    let hits: Vec<usize> = hits.chain([force.len()]).collect();
    let top = |n: usize| {
        let (from, to) = (hits.get(n).copied(), hits.get(n + 1).copied());
        let (from, to) = (from.unwrap_or(0), to.unwrap_or(0));
        let heights = height[from.min(to)..to].iter().map(|y| h + y);
        heights.fold(f64::NAN, f64::max)
    };
    let moving = speed.iter().rposition(|v| v.abs() > 1e-6);
    let rest = moving.and_then(|k| times.get(k + 1)).copied();
    let depth = height.iter().map(|y| -(h + y)).fold(0.0, f64::max);
    let exact = |n: i32| bounce_height(h, e, n);
    Ok(vec![
        Found::exact("first height", "m", top(0), exact(1)),
        Found::exact("second height", "m", top(1), exact(2)),
        Found::exact("third height", "m", top(2), exact(3)),
        Found::exact(
            "rest",
            "s",
            rest.unwrap_or(f64::INFINITY),
            bounce_rest_time(h, e, G),
        ),
        Found::exact(
            "force at the end",
            "N",
            ran.end("force.ground.y")?,
            MASS * G,
        ),
        Found::zero("penetration", "m", depth, h),
    ])
}
