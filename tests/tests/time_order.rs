//! Orders of the time integration: smooth motion, and motion with impacts.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

use tests::{Plan, Ran, compute, slope};

/// Speed of a bar relative to that of its waves, small enough to be linear \[-\].
const V: f64 = 1e-6;

/// A bar of one element and unit length, mass and wave speed: two masses of a half and a spring between.
fn bar(holds: &str) -> String {
    format!(
        r#"(
    title: "one element",
    materials: {{ "m": (law: SaintVenantKirchhoff(E: 1.0, nu: 0.0), density: 1.0) }},
    bodies: {{ "bar": (mesh: Rectangle(min: (0.0, 0.0), max: (1.0, 1.0), cells: (1, 1)), material: "m", velocity: (-{V:e}, 0.0, 0.0)) }},
    {holds}
    time: (end: 4.0, dt: 0.05, theta: 0.5, xi: 0.5),
    mass: Lumped,
    output: (probes: {{
        "low": (body: "bar", node: (0.0, 0.0, 0.0), quantities: [displacement, velocity]),
        "high": (body: "bar", node: (1.0, 0.0, 0.0), quantities: [displacement, velocity]),
    }}),
)"#
    )
}

fn run(scene: &str, sets: &[String]) -> Ran {
    let plan = Plan::new("order", scene, sets.iter().cloned());
    compute(plan)
        .and_then(Ran::completed)
        .unwrap_or_else(|e| panic!("{e}"))
}

fn scheme(theta: f64, level: &str, dt: f64) -> Vec<String> {
    vec![
        format!("time.theta={theta:e}"),
        format!("time.xi={theta:e}"),
        format!("time.contact={level}"),
        format!("time.dt={dt:e}"),
    ]
}

fn assert_order(what: &str, theory: f64, steps: &[f64], errors: &[f64]) {
    let order = slope(steps, errors);
    println!("{what}: order {order:.3}, errors {errors:?}");
    assert!(
        (order - theory).abs() < 0.1,
        "{what}: order {order}, not {theory}; {errors:?}"
    );
}

/// One end held: the other swings as `sin(sqrt(2) t)`. Errors of displacement and velocity at the end.
#[test]
fn a_linear_vibration_is_of_second_order_and_of_first_with_backward_euler() {
    let text = bar(r#"motions: { "wall": (nodes: "bar.x_min") },"#);
    let omega = 2.0_f64.sqrt();
    for (theta, order) in [(0.5, 2.0), (1.0, 1.0)] {
        let steps = [0.02, 0.01, 0.005, 0.0025];
        let errors = steps.map(|dt| {
            let ran = run(&text, &scheme(theta, "Position", dt));
            let (phase, at) = (omega * 4.0, |q: &str| {
                ran.end(&format!("probe.high.{q}.x")).unwrap() / V
            });
            let u = (at("displacement") + phase.sin() / omega).abs();
            [u, (at("velocity") + phase.cos()).abs()]
        });
        assert_order(
            &format!("displacement, theta {theta}"),
            order,
            &steps,
            &errors.map(|e| e[0]),
        );
        assert_order(
            &format!("velocity, theta {theta}"),
            order,
            &steps,
            &errors.map(|e| e[1]),
        );
    }
}

/// Large rotation and strain: all nodes at five times against a step eight times finer than the finest.
#[test]
fn a_turning_body_is_of_second_order_and_of_first_with_backward_euler() {
    let coarse = ["time.end=0.5", "cells=(6, 1)"].map(str::to_owned);
    let states = |theta: f64, dt: f64| {
        let sets = [scheme(theta, "Position", dt), coarse.to_vec()].concat();
        let plan = Plan::new("order", "free-body", sets).keeping(&[0.1, 0.2, 0.3, 0.4, 0.5]);
        compute(plan).and_then(Ran::completed).unwrap().snapshots
    };
    let reference = states(0.5, 0.000078125);
    let distance = |a: &[f64], b: &[f64]| -> f64 {
        a.iter()
            .zip(b)
            .map(|(a, b)| (a - b).powi(2))
            .sum::<f64>()
            .sqrt()
    };
    for (theta, order, steps) in [
        (0.5, 2.0, [0.0025, 0.00125, 0.000625]),
        (1.0, 1.0, [0.000625, 0.0003125, 0.00015625]),
    ] {
        let errors = steps.map(|dt| {
            let found = states(theta, dt);
            let pairs = || found.iter().zip(&reference);
            [
                pairs().map(|(a, b)| distance(&a.u, &b.u)).sum::<f64>(),
                pairs().map(|(a, b)| distance(&a.v, &b.v)).sum(),
            ]
        });
        assert_order(
            &format!("displacement, theta {theta}"),
            order,
            &steps,
            &errors.map(|e| e[0]),
        );
        let velocities = errors.map(|e| e[1]);
        if theta < 1.0 {
            assert_order("velocity, theta 0.5", order, &steps, &velocities);
        } else {
            // Backward Euler damps the fastest vibrations of the sudden start for as long as a step does not resolve
            // them.
            println!("velocity, theta 1: order {:.3}", slope(&steps, &velocities));
            assert!(velocities[2] < 0.4 * velocities[0], "{velocities:?}");
        }
    }
}

/// Displacements and velocities of both ends over `V`, a time `s` after the impact: the low end stops dead, the high
/// one swings until it comes back, then the bar flies at half the speed and vibrates.
fn after_impact(s: f64) -> [f64; 4] {
    let (omega, flight) = (2.0_f64.sqrt(), 2.0);
    let r = s - std::f64::consts::PI / omega;
    if s < 0.0 {
        [-s, -s, -1.0, -1.0]
    } else if r < 0.0 {
        [0.0, -(omega * s).sin() / omega, 0.0, -(omega * s).cos()]
    } else {
        let (sin, cos) = (flight * r).sin_cos();
        let (u, w) = (0.5 * sin / flight, 0.5 * cos);
        [0.5 * r - u, 0.5 * r + u, 0.5 - w, 0.5 + w]
    }
}

/// Mean over time, ends and eight places of the impact in its step: error of displacement and of velocity. A velocity
/// that jumps a step too late is wrong by all of it for a step: the mean over time is what can be of first order.
fn mean_errors(text: &str, theta: f64, level: &str, dt: f64) -> [f64; 2] {
    let mut sum = [0.0; 2];
    let places = 8;
    for place in 0..places {
        let impact = dt * (1.0 + (f64::from(place) + 0.5) / f64::from(places));
        let gap = format!("wall.master.point=({:e}, 0.0, 0.0)", -V * impact);
        let ran = run(text, &[scheme(theta, level, dt), vec![gap]].concat());
        let column = |name: &str| ran.column(name).unwrap();
        let (t, mut steps) = (column("t"), 0.0);
        let [low, high] = ["low", "high"]
            .map(|end| ["displacement", "velocity"].map(|q| column(&format!("probe.{end}.{q}.x"))));
        let mut own = [0.0; 2];
        for (k, t) in t.iter().enumerate() {
            let exact = after_impact(t - impact);
            own[0] += (low[0][k] / V + impact - exact[0]).abs()
                + (high[0][k] / V + impact - exact[1]).abs();
            own[1] += (low[1][k] / V - exact[2]).abs() + (high[1][k] / V - exact[3]).abs();
            steps += 1.0;
        }
        for (sum, own) in sum.iter_mut().zip(own) {
            *sum += own / (2.0 * steps * f64::from(places));
        }
    }
    sum
}

#[test]
fn with_an_impact_the_order_is_one() {
    let text = bar(
        r#"interfaces: { "wall": (slave: "bar.x_min", master: Plane(point: (0.0, 0.0, 0.0), normal: (1.0, 0.0, 0.0)), search_distance: Some(1e-4)) },"#,
    );
    let steps = [0.04, 0.02, 0.01, 0.005];
    for (theta, level) in [(0.5, "Velocity"), (1.0, "Velocity"), (1.0, "Position")] {
        let errors = steps.map(|dt| mean_errors(&text, theta, level, dt));
        assert_order(
            &format!("displacement, {level}, theta {theta}"),
            1.0,
            &steps,
            &errors.map(|e| e[0]),
        );
        assert_order(
            &format!("velocity, {level}, theta {theta}"),
            1.0,
            &steps,
            &errors.map(|e| e[1]),
        );
    }
    // A mass that touches at the position level comes to rest only with theta > 1/2; else it leaves with any velocity.
    let errors = [0.02, 0.005].map(|dt| mean_errors(&text, 0.5, "Position", dt));
    println!("Position, theta 0.5: {errors:?}");
    assert!(
        errors.iter().all(|e| e[0] > 0.05 && e[1] > 0.05),
        "{errors:?}"
    );
}
