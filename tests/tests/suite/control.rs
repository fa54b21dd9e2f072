//! Steps that cannot converge.

use nscd::{NscdError, StepFailure};

use crate::common::{Run, scene_text, try_run};

fn crushed(law: &str, held: &str, pushed: &str) -> Run {
    let text = format!(
        r#"(
    title: "crushed",
    materials: {{"m": (law: {law}, density: 1.0)}},
    bodies: {{"block": (mesh: Box(min: (0.0, 0.0, 0.0), max: (1.0, 1.0, 1.0), cells: (2, 2, 2)), material: "m")}},
    motions: {{{held}}},
    interfaces: {{{pushed}}},
    time: (end: 2.0, dt: 0.5, inertia: QuasiStatic, min_dt: Some(0.05)),
    output: (),
)"#
    );
    try_run(&scene_text(&text, &[]))
}

const PATH: &str = "Move(translation: (0.0, 0.0, [(0.0, 0.0), (1.0, -0.1), (2.0, -1.5)]))";

fn pushed() -> String {
    format!(
        r#""press": (slave: "block.z_max", master: Plane(point: (0.0, 0.0, 1.0), normal: (0.0, 0.0, -1.0)), mu: 0.2, motion: {PATH})"#
    )
}

/// The run stopped between the harmless part and the end, and kept what it had.
fn assert_stopped(run: &Run) -> &StepFailure {
    let Err(NscdError::Stopped {
        time,
        smallest,
        failure,
    }) = &run.end
    else {
        panic!("{:?}", run.end)
    };
    assert!((1.0..2.0).contains(time), "stopped at {time}");
    assert!(*smallest < 0.11, "smallest step {smallest}");
    assert!(run.steps.len() >= 2);
    assert_eq!(run.last().report.time, *time);
    run.assert_audited(run.totals.energy.load_work.abs(), 1e-9);
    assert!(!run.totals.rejections.is_empty(), "no rejection is kept");
    // The last failure at a time may be followed by no shorter one; all others are.
    for pair in run
        .totals
        .rejections
        .windows(2)
        .filter(|p| p[0].time == p[1].time)
    {
        assert!(pair[1].dt < pair[0].dt, "{pair:?}");
    }
    failure
}

#[test]
fn a_block_crushed_by_its_own_faces_stops_with_its_element() {
    let held = format!(
        r#""bottom": (nodes: "block.z_min"), "top": (nodes: "block.z_max", motion: {PATH})"#
    );
    for law in ["NeoHookean(E: 100.0, nu: 0.3)", "BlatzKo(G: 40.0)"] {
        let run = crushed(law, &held, "");
        let failure = assert_stopped(&run).to_string();
        assert!(
            failure.contains("element") || failure.contains("node"),
            "{failure}"
        );
        assert!(run.end.as_ref().unwrap_err().to_string().contains("t = "));
    }
}

#[test]
fn a_block_crushed_by_an_obstacle_stops_with_its_contact_or_element() {
    let pushed = pushed();
    let run = crushed(
        "NeoHookean(E: 100.0, nu: 0.3)",
        r#""bottom": (nodes: "block.z_min")"#,
        &pushed,
    );
    let failure = assert_stopped(&run).to_string();
    assert!(
        ["element", "interface", "node"]
            .iter()
            .any(|w| failure.contains(w)),
        "{failure}"
    );
    // Ten percent of compression is nothing special: those steps are there and sound.
    assert!(
        run.steps
            .iter()
            .any(|s| (s.report.time - 1.0).abs() < 1e-9 && s.report.contacts_closed == 9)
    );
}

#[test]
fn a_step_that_is_too_long_is_cut_and_grown_again() {
    // The whole way in one step turns elements inside out in the predictor; in pieces it does not.
    let text = r#"(
    title: "cut",
    materials: {"m": (law: SaintVenantKirchhoff(E: 100.0, nu: 0.3), density: 1.0)},
    bodies: {"block": (mesh: Box(min: (0.0, 0.0, 0.0), max: (1.0, 1.0, 1.0), cells: (2, 2, 2)), material: "m")},
    motions: {
        "bottom": (nodes: "block.z_min"),
        "top": (nodes: "block.z_max", motion: Move(rotation: Some((point: (0.5, 0.5, 0.0), axis: (0.0, 0.0, 1.0), angle: [(0.0, 0.0), (8.0, 6.0)])))),
    },
    time: (end: 8.0, dt: 4.0, inertia: QuasiStatic),
    solver: (max_newton: Some(12)),
)"#;
    let run = try_run(&scene_text(text, &["law=NeoHookean(E: 100.0, nu: 0.3)"]));
    if let Err(error) = &run.end {
        panic!("{error}");
    }
    assert!((run.last().report.time - 8.0).abs() < 1e-12);
    assert!(!run.totals.rejections.is_empty());
    let dt: Vec<f64> = run.steps.iter().map(|s| s.report.dt).collect();
    assert!(
        dt.windows(2).any(|w| w[1] > 1.5 * w[0]),
        "never grown again: {dt:?}"
    );
    assert!((dt.iter().sum::<f64>() - 8.0).abs() < 1e-9);
}
