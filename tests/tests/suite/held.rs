//! Bodies at rest that contacts, bonds and friction hold, and no support.

use nscd::{Counters, NscdError, StepFailure};

use crate::common::{Run, run, scene_text, try_run};

/// A ring of rubber that two plates squeeze to `height` \[m\]; `shape` has the height `tall` \[m\].
fn ring(shape: &str, tall: f64, squeeze: f64, dt: f64) -> String {
    let half = 0.5 * tall;
    format!(
        r#"(
    title: "ring",
    symmetry: Some(Axisymmetric),
    materials: {{"rubber": (law: NeoHookean(G: 2.0e6, nu: 0.4995), density: 1200.0)}},
    bodies: {{"ring": (mesh: {shape}, material: "rubber", dilatation: Projected)}},
    interfaces: {{
        "low": (slave: "ring.{}", master: Plane(point: (0.0, {:?}, 0.0), normal: (0.0, 1.0, 0.0)), mu: 0.2),
        "up": (slave: "ring.{}", master: Plane(point: (0.0, {half:?}, 0.0), normal: (0.0, -1.0, 0.0)), mu: 0.2,
            motion: Move(translation: (0.0, [(0.0, 0.0), (1.0, {:?})], 0.0))),
    }},
    time: (end: 1.0, dt: {dt:?}, inertia: QuasiStatic),
)"#,
        if shape.starts_with("Disc") {
            "rim"
        } else {
            "y_min"
        },
        -half,
        if shape.starts_with("Disc") {
            "rim"
        } else {
            "y_max"
        },
        -squeeze,
    )
}

/// Both plates carry the same force in every step, up to what the residual leaves of the balance of the body.
fn assert_balanced(run: &Run, last: f64) {
    let (low, up) = (run.contact_force(1), run_force(run, 1));
    let largest = low.iter().fold(0.0_f64, |m, f| m.max(f.abs()));
    assert!(largest > last, "{largest}");
    for (low, up) in low.iter().zip(&up) {
        assert!((low + up).abs() < 1e-9 * largest, "{low} {up}");
    }
}

/// Force of the second interface along an axis over the steps \[N\].
fn run_force(run: &Run, axis: usize) -> Vec<f64> {
    let steps = run.steps.iter();
    steps.map(|s| s.report.interfaces[1].force[axis]).collect()
}

fn iterations_per_step(counters: &Counters) -> f64 {
    counters.newton_iterations as f64 / counters.steps as f64
}

#[test]
fn a_ring_between_plates_is_held_by_them_alone() {
    let square = "Rectangle(min: (0.02, -0.001), max: (0.022, 0.001), cells: (4, 4))";
    let run = run(&scene_text(&ring(square, 2e-3, 5e-4, 0.1), &[]));
    assert_balanced(&run, 100.0);
    assert!(
        iterations_per_step(&run.counters) < 15.0,
        "{:?}",
        run.counters
    );
}

/// Under the plates the flanks come in one after the other: nodes that the free motion, without the forces of the
/// others, would lead far away.
#[test]
fn flanks_of_a_round_ring_come_to_lie_on_the_plates() {
    let round = "Disc(center: (0.02, 0.0), radius: 1.75e-3, cells: 12)";
    let run = run(&scene_text(&ring(round, 3.5e-3, 7e-4, 0.02), &[]));
    assert_balanced(&run, 100.0);
    assert!(
        iterations_per_step(&run.counters) < 20.0,
        "{:?}",
        run.counters
    );
}

/// A hard block between two soft ones, pressed and then dragged: friction keeps it from turning.
#[test]
fn a_free_block_in_a_row_is_held_by_its_neighbours() {
    let text = r#"(
    title: "row",
    materials: {"soft": (law: NeoHookean(E: 1.0e6, nu: 0.3), density: 1000.0), "hard": (law: NeoHookean(E: 1.0e9, nu: 0.3), density: 1000.0)},
    bodies: {
        "low": (mesh: Rectangle(min: (-1.0, 0.0), max: (1.0, 0.5), cells: (10, 3)), material: "soft"),
        "mid": (mesh: Rectangle(min: (-0.5, 0.5), max: (0.5, 1.0), cells: (8, 4)), material: "hard"),
        "top": (mesh: Rectangle(min: (-1.0, 1.0), max: (1.0, 1.5), cells: (14, 3)), material: "soft"),
    },
    motions: {
        "base": (nodes: "low.y_min", components: "xy"),
        "press": (nodes: "top.y_max", components: "xy", motion: Move(translation: ([(1.0, 0.0), (2.0, 0.1)], [(0.0, 0.0), (1.0, -0.1)], 0.0))),
    },
    interfaces: {
        "a": (slave: "mid.y_min", master: Facets("low.y_max"), mu: 0.3),
        "b": (slave: "mid.y_max", master: Facets("top.y_min"), mu: 0.3),
    },
    time: (end: 2.0, dt: 0.2, inertia: QuasiStatic),
)"#;
    let run = run(&scene_text(text, &[]));
    assert_balanced(&run, 1e4);
    assert!(
        iterations_per_step(&run.counters) < 15.0,
        "{:?}",
        run.counters
    );
}

/// A block that hangs by its bonds: they carry its weight of 1000 kg/m3, 10 m/s2 and 1 cm2.
#[test]
fn a_block_hangs_by_its_bonds() {
    let text = |load: &str| {
        format!(
            r#"(
    title: "hangs",
    materials: {{"m": (law: NeoHookean(E: 2.0e6, nu: 0.3), density: 1000.0)}},
    bodies: {{
        "up": (mesh: Rectangle(min: (0.0, 0.01), max: (0.01, 0.02), cells: (2, 2)), material: "m"),
        "low": (mesh: Rectangle(min: (0.0, 0.0), max: (0.01, 0.01), cells: (2, 2)), material: "m"),
    }},
    motions: {{"top": (nodes: "up.y_max", components: "xy")}},
    loads: {{"weight": Gravity((0.0, {load}, 0.0))}},
    interfaces: {{"glue": (slave: "up.y_min", master: Facets("low.y_max"), adhesion: Some((C_n: 1e10, C_t: 1e10, w: 1e2, b: 0.1, beta: 1.0)))}},
    time: (end: 1.0, dt: 0.25, inertia: QuasiStatic),
)"#
        )
    };
    let hangs = run(&scene_text(&text("-10.0"), &[]));
    let pulls = hangs.contact_force(1);
    assert!(
        pulls.iter().all(|f| (f / -1.0 - 1.0).abs() < 1e-8),
        "{pulls:?}"
    );
}

/// What nothing holds and something pushes has no equilibrium, and is told so; what nothing pushes stays where it is.
#[test]
fn a_body_in_the_air_stays_until_it_is_pushed() {
    let text = |load: f64| {
        format!(
            r#"(
    title: "air",
    materials: {{"m": (law: NeoHookean(E: 2.0e6, nu: 0.3), density: 1000.0)}},
    bodies: {{"block": (mesh: Rectangle(min: (0.0, 0.001), max: (0.01, 0.01), cells: (2, 2)), material: "m")}},
    loads: {{"wind": Gravity(({load:?}, 0.0, 0.0))}},
    interfaces: {{"floor": (slave: "block.y_min", master: Plane(point: (0.0, 0.0, 0.0), normal: (0.0, 1.0, 0.0)), mu: 0.2)}},
    time: (end: 1.0, dt: 0.5, inertia: QuasiStatic),
)"#
        )
    };
    let still = run(&scene_text(&text(0.0), &[]));
    assert!(
        still
            .steps
            .last()
            .unwrap()
            .state
            .u
            .iter()
            .all(|u| u.abs() < 1e-15)
    );
    let pushed = try_run(&scene_text(&text(1.0), &[]));
    let Err(NscdError::Stopped { failure, .. }) = pushed.end else {
        panic!("{:?}", pushed.end)
    };
    assert!(matches!(failure, StepFailure::Adrift { .. }), "{failure}");
}
