//! Stiff blocks against what is known of rigid ones.

use fe_core::{Solid, solid_block};
use hyperelastic::{ElasticConstants, SaintVenantKirchhoff};
use scenarios::build;

use crate::common::{Run, run, scene, scene_text, try_run_built};

/// A block of one material that can meet the plane z = 0, with room for what differs.
fn block(
    size: [f64; 3],
    cells: [usize; 3],
    bottom: f64,
    young: f64,
    sets: &str,
    time: &str,
) -> String {
    let [x, y, z] = size;
    format!(
        r#"(
    title: "block",
    materials: {{"m": (law: SaintVenantKirchhoff(E: {young:e}, nu: 0.2), density: 1000.0)}},
    bodies: {{"block": (mesh: Box(min: (0.0, 0.0, {bottom:e}), max: ({x:e}, {y:e}, {:e}), cells: {cells:?}), material: "m", {sets})}},
    interfaces: {{"ground": (slave: "block.z_min", master: Plane(point: (0.0, 0.0, 0.0), normal: (0.0, 0.0, 1.0)), mu: 0.3, restitution: 0.0)}},
    loads: {{"weight": Gravity((0.0, 0.0, 0.0))}},
    time: ({time}),
)"#,
        bottom + z
    )
    .replace("cells: [", "cells: (")
    .replace("])", "))")
    .replace("], material", "), material")
}

/// Mean velocity of all matter \[m/s\].
fn mean_velocity(run: &Run, state: &nscd::State) -> [f64; 3] {
    run.momentum(state)
        .map(|p| p / run.built.model.mass.total())
}

/// Slides at 1 m/s under g = 10 m/s^2 with mu = .3: stops after 1/3 s and 1/6 m.
fn sliding(scheme: &str) {
    const DT: f64 = 0.002;
    let time = format!("end: 0.5, dt: {DT}, {scheme}");
    let text = block(
        [1.0, 1.0, 0.2],
        [2, 2, 1],
        0.0,
        1e9,
        "velocity: (1.0, 0.0, 0.0)",
        &time,
    )
    .replace("Gravity((0.0, 0.0, 0.0))", "Gravity((0.0, 0.0, -10.0))");
    let run = run(&scene_text(&text, &[]));
    let scale = run.totals.initial_energy;
    run.assert_audited(scale, 1e-9);
    let velocity: Vec<f64> = run
        .steps
        .iter()
        .map(|s| mean_velocity(&run, &s.state)[0])
        .collect();
    for (step, v) in run.steps.iter().zip(&velocity) {
        assert!(
            *v > -1e-4,
            "{scheme}: slides back at {v} m/s at t = {}",
            step.report.time
        );
        let weight = 200.0 * 10.0;
        let [x, _, n]: [f64; 3] = step.report.interfaces[0].force.into();
        assert!(
            x.abs() <= 0.3 * n * (1.0 + 1e-8) + 1e-8 * weight,
            "{scheme}: {x} N against {n} N"
        );
    }
    let stops = run
        .steps
        .iter()
        .zip(&velocity)
        .find(|(_, v)| v.abs() < 1e-4)
        .unwrap()
        .0
        .report
        .time;
    assert!(
        (stops - 1.0 / 3.0).abs() <= 1.5 * DT,
        "{scheme}: stops at {stops} s"
    );
    let way =
        run.last().state.u.iter().step_by(3).sum::<f64>() / (run.last().state.u.len() / 3) as f64;
    assert!(
        (way - 1.0 / 6.0).abs() <= 1.5 * DT,
        "{scheme}: slides {way} m"
    );
    // A backward Euler step of friction loses (mu g dt)^2/2 a kilogram in the scheme instead of in the contact.
    let friction = run.totals.energy.friction / scale;
    let expected = 1.0 - 0.3 * 10.0 * DT;
    assert!(
        (friction - expected).abs() < 1e-3,
        "{scheme}: {friction} of the energy goes into friction"
    );
    let lost = friction + run.totals.energy.integration_error() / scale;
    assert!(
        (lost - 1.0).abs() < 1e-3,
        "{scheme}: {lost} of the energy is lost"
    );
}

#[test]
fn sliding_block_stops_where_a_rigid_one_does_velocity_level() {
    sliding("contact: Velocity, theta: 1.0, xi: 1.0");
}

#[test]
fn sliding_block_stops_where_a_rigid_one_does_position_level() {
    sliding("contact: Position, theta: 1.0, xi: 1.0");
}

#[test]
fn one_stiff_element_rebounds_with_the_coefficient_of_restitution() {
    for e in [0.0, 0.3, 0.7, 1.0] {
        let time = "end: 0.1, dt: 0.01, contact: Velocity, theta: 1.0, xi: 1.0";
        let text = block(
            [1.0; 3],
            [1; 3],
            0.045,
            1e13,
            "velocity: (0.0, 0.0, -1.0)",
            time,
        );
        let run = run(&scene_text(&text, &[&format!("restitution={e}"), "mu=0"]));
        let v = mean_velocity(&run, &run.last().state);
        assert!((v[2] - e).abs() < 1e-6, "e = {e}: rebounds at {} m/s", v[2]);
        assert!(v[0].abs().max(v[1].abs()) < 1e-9);
    }
}

#[test]
fn free_flight_keeps_momentum_and_energy_and_costs_nothing() {
    let time = "end: 1.0, dt: 0.01, theta: 0.5, xi: 0.5";
    let text = block(
        [1.0; 3],
        [3; 3],
        10.0,
        1e6,
        "velocity: (1.0, 2.0, -3.0)",
        time,
    );
    let run = run(&scene_text(&text, &[]));
    let (p, l, energy) = (
        run.momentum(&run.start),
        run.angular_momentum(&run.start),
        run.totals.initial_energy,
    );
    for step in &run.steps {
        let (p1, l1) = (run.momentum(&step.state), run.angular_momentum(&step.state));
        for c in 0..3 {
            assert!((p1[c] - p[c]).abs() < 1e-10 * 3000.0);
            assert!((l1[c] - l[c]).abs() < 1e-10 * 3e4, "{l1:?} {l:?}");
        }
        assert!((step.energy() - energy).abs() < 1e-11 * energy);
    }
    let c = &run.counters;
    // The first correction is made of round-off: only a factor tells how large that may be.
    assert!(c.newton_iterations <= 1 && c.factorizations <= 1, "{c:?}");
    assert_eq!((c.condensations, c.contact_solves), (0, 0));
    assert_eq!(c.force_evaluations, c.steps + c.newton_iterations);
}

#[test]
fn a_block_falls_like_a_stone() {
    let time = "end: 1.0, dt: 0.05, theta: 0.5, xi: 0.5";
    let text = block([1.0; 3], [2; 3], 100.0, 1e6, "", time)
        .replace("Gravity((0.0, 0.0, 0.0))", "Gravity((0.0, 0.0, -10.0))");
    let run = run(&scene_text(&text, &[]));
    let state = &run.last().state;
    // The trapezoidal rule integrates a constant force exactly.
    for u in state.u.chunks_exact(3) {
        assert!(
            (u[2] + 5.0).abs() < 1e-9 && u[0].abs() + u[1].abs() < 1e-9,
            "{u:?}"
        );
    }
    assert!((run.totals.energy.load_work / 5e4 - 1.0).abs() < 1e-9);
}

/// The block of `sliding-block` turned onto a plane that is inclined by `angle` \[rad\], from rest.
fn on_a_slope(angle: f64, end: f64) -> Run {
    let (sin, cos) = angle.sin_cos();
    let normal = format!("ground.master.normal=({sin:e}, {cos:e}, 0.0)");
    let end = format!("time.end={end:e}");
    let sets = [normal.as_str(), "block.velocity=(0.0, 0.0, 0.0)", &end];
    let mut built = build(&scene("sliding-block", &sets)).unwrap();
    let model = &mut built.model;
    let mut mesh = model.solid.mesh().clone();
    for x in &mut mesh.points {
        *x = [cos * x[0] + sin * x[1], cos * x[1] - sin * x[0], 0.0].into();
    }
    let elastic = ElasticConstants::from_young_poisson(1e11, 0.2).unwrap();
    let law = SaintVenantKirchhoff::new(elastic).unwrap();
    let mesh = mesh.validated().unwrap();
    let block = solid_block(&mesh, 0, law, 1000.0).unwrap();
    model.solid = Solid::new(mesh, vec![block]).unwrap();
    try_run_built(built)
}

#[test]
fn a_block_slides_down_an_inclined_plane_only_beyond_the_angle_of_friction() {
    let (mu, g, end) = (0.25, 10.0, 0.1);
    for tangent in [0.2, 0.249, 0.251, 0.4] {
        let (sin, cos) = f64::atan(tangent).sin_cos();
        let run = on_a_slope(f64::atan(tangent), end);
        assert!(run.end.is_ok() && run.totals.rejections.is_empty());
        let exact = (g * (sin - mu * cos) * end).max(0.0);
        for v in run.last().state.v.chunks_exact(2) {
            let (along, off) = (cos * v[0] - sin * v[1], sin * v[0] + cos * v[1]);
            assert!(
                (along - exact).abs() < 1e-6 && off.abs() < 1e-9,
                "tan {tangent}: {along} m/s along and {off} m/s off, not {exact} m/s"
            );
        }
    }
}
