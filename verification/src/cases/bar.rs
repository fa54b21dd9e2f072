//! An elastic bar against a rigid wall.

use crate::curve::{Curve, mean};
use crate::{Case, Found, Ladder, Ran, closed_form};

/// Bar on a rigid wall: contact time `2 L / c`, force `rho c v A`.
pub fn on_a_wall() -> Case {
    let steps = [0.02, 0.01, 0.005];
    Case {
        name: "bar-impact",
        about: "An elastic bar hits a rigid wall: contact lasts 2 L/c = 2 s with the force rho c v A = 1 N, and no energy is \
                lost. The force is its mean over the middle 80 % of the contact.",
        scene: "bar-impact",
        sets: Vec::new(),
        ladders: vec![
            Ladder::over_dt("step, velocity level", &steps, &[]),
            Ladder::over_dt("step, position level", &steps, &["time.contact=Position"]),
            Ladder::over_dt(
                "step, backward Euler",
                &steps,
                &["time.contact=Position", "time.theta=1.0", "time.xi=1.0"],
            ),
        ],
        measure,
    }
}

fn measure(ran: &Ran) -> Result<Vec<Found>, String> {
    let exact = closed_form::bar_on_wall(1.0, 1.0, 1.0e8, 1.0e-4, 1.0e-4);
    let force = ran.curve("t", "force.wall.x")?;
    let total = ran.column("energy.kinetic")?[0];
    let (kinetic, strain) = (ran.end("energy.kinetic")?, ran.end("energy.strain")?);
    let (from, to) = (0.1 * exact.duration, 0.9 * exact.duration);
    let middle: Curve = force
        .iter()
        .copied()
        .filter(|p| p.0 >= from && p.0 <= to)
        .collect();
    let plateau = mean(&middle).unwrap_or(f64::NAN);
    Ok(vec![
        Found::exact("contact time", "s", duration(&force), exact.duration),
        Found::exact("force", "N", plateau, exact.force),
        Found::exact("energy at the end", "J", kinetic + strain, total),
    ])
}

/// Last time with a force.
fn duration(force: &[(f64, f64)]) -> f64 {
    let pressed = force.iter().rev().find(|p| p.1 > 0.0);
    pressed.map_or(f64::NAN, |p| p.0)
}
