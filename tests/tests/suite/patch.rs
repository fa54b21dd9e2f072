//! Homogeneous states through the whole chain.

use crate::common::{Run, run, scene_text, try_run};

fn rollers(body: &str) -> String {
    ["x", "y"]
        .iter()
        .map(|c| format!(r#""{body}-{c}": (nodes: "{body}.{c}_min", components: "{c}"),"#))
        .collect()
}

/// Two blocks on top of each other with matching meshes, pressed together by `0.1 m` of 2 m.
fn pressed(law: &str, mu: f64) -> Run {
    let text = format!(
        r#"(
    title: "pressed",
    materials: {{"m": (law: {law}, density: 1.0)}},
    bodies: {{
        "low": (mesh: Box(min: (0.0, 0.0, 0.0), max: (1.0, 1.0, 1.0), cells: (3, 2, 2), grading: (2.0, 1.0, 1.5)), material: "m"),
        "high": (mesh: Box(min: (0.0, 0.0, 1.0), max: (1.0, 1.0, 2.0), cells: (3, 2, 3), grading: (2.0, 1.0, 1.0)), material: "m"),
    }},
    motions: {{
        {} {}
        "bottom": (nodes: "low.z_min", components: "z"),
        "top": (nodes: "high.z_max", components: "z", motion: Move(translation: (0.0, 0.0, [(0.0, 0.0), (4.0, -0.1)]))),
    }},
    interfaces: {{"joint": (slave: "high.z_min", master: Facets("low.z_max"), mu: {mu})}},
    time: (end: 4.0, dt: 1.0, inertia: QuasiStatic),
)"#,
        rollers("low"),
        rollers("high"),
    );
    // Steps are cut here now; an end is all that is asked for.
    let run = try_run(&scene_text(&text, &[]));
    assert!(run.end.is_ok(), "{:?}", run.end);
    run
}

#[test]
fn pressed_blocks_with_matching_meshes_pass_the_patch_test() {
    for law in [
        "NeoHookean(E: 100.0, nu: 0.3)",
        "BlatzKo(G: 40.0)",
        "SaintVenantKirchhoff(E: 100.0, nu: 0.3)",
    ] {
        for mu in [0.0, 0.5] {
            let run = pressed(law, mu);
            let state = &run.last().state;
            let empty = fe_core::ElementState::default();
            let mut all = Vec::new();
            for block in run.built.model.solid.blocks() {
                let mut states = vec![empty; block.element_count()];
                block.stress_state(&state.u, &mut states).unwrap();
                all.extend(states);
            }
            let axial = all[0].cauchy[2];
            assert!(axial < -3.0, "{law}: {axial} Pa");
            for element in &all {
                for (i, s) in element.cauchy.iter().enumerate() {
                    let expected = if i == 2 { axial } else { 0.0 };
                    assert!(
                        (s - expected).abs() < 1e-8 * axial.abs(),
                        "{law}, mu = {mu}: {:?}",
                        element.cauchy
                    );
                }
            }
            let areas = &run.built.model.interfaces[0].area;
            let total = run.last().report.interfaces[0].force[2];
            for contact in &state.contacts {
                let expected = total * areas[contact.slave_index];
                assert!(
                    (contact.force[2] - expected).abs() < 1e-8 * total,
                    "{law}: {} N of {expected} N",
                    contact.force[2]
                );
            }
            assert!((total - run.last().report.supports[4].force[2]).abs() < 1e-9 * total);
        }
    }
}

/// One block between rigid walls that only lets the top move.
fn confined(law: &str, stretch: f64) -> Run {
    let walls: String = [
        ("x_min", "x"),
        ("x_max", "x"),
        ("y_min", "y"),
        ("y_max", "y"),
        ("z_min", "z"),
    ]
    .iter()
    .map(|(set, c)| format!(r#""{set}": (nodes: "block.{set}", components: "{c}"),"#))
    .collect();
    let down = 2.0 * (stretch - 1.0);
    let text = format!(
        r#"(
    title: "confined",
    materials: {{"m": (law: {law}, density: 1.0)}},
    bodies: {{"block": (mesh: Box(min: (0.0, 0.0, 0.0), max: (1.0, 3.0, 2.0), cells: (2, 2, 2)), material: "m")}},
    motions: {{{walls} "top": (nodes: "block.z_max", components: "z", motion: Move(translation: (0.0, 0.0, [(0.0, 0.0), (4.0, {down:e})])))}},
    time: (end: 4.0, dt: 1.0, inertia: QuasiStatic),
)"#
    );
    run(&scene_text(&text, &[]))
}

#[test]
fn confined_compression_follows_the_closed_forms() {
    let (g, lambda) = (7.0, 11.0);
    for l in [0.5_f64, 0.8, 1.3] {
        let cases = [
            (format!("BlatzKo(G: {g})"), g * (1.0 - l.powi(-3))),
            (
                format!("NeoHookean(G: {g}, lambda: {lambda})"),
                g * (l - 1.0 / l) + lambda * l.ln() / l,
            ),
        ];
        for (law, stress) in cases {
            let run = confined(&law, l);
            let force = run.last().report.supports[5].force[2];
            assert!(
                (force - 3.0 * stress).abs() < 1e-9 * force.abs(),
                "{law} at {l}: {force} N, exact {} N",
                3.0 * stress
            );
            let work = run.totals.energy.load_work - run.totals.energy.integration_error();
            let strain = run.last().state.strain_energy;
            assert!(
                (work - strain).abs() < 1e-10 * strain,
                "{law} at {l}: work {work} J, energy {strain} J"
            );
        }
    }
}

#[test]
fn moments_of_a_turned_block_balance_and_do_the_work() {
    let text = r#"(
    title: "turned",
    materials: {"m": (law: NeoHookean(E: 100.0, nu: 0.3), density: 1.0)},
    bodies: {"block": (mesh: Box(min: (-0.5, -0.5, 0.0), max: (0.5, 0.5, 2.0), cells: (3, 3, 4)), material: "m")},
    motions: {
        "bottom": (nodes: "block.z_min"),
        "top": (nodes: "block.z_max", motion: Move(rotation: Some((point: (0.0, 0.0, 0.0), axis: (0.0, 0.0, 1.0), angle: [(0.0, 0.0), (10.0, 0.5)])))),
    },
    time: (end: 10.0, dt: 1.0, inertia: QuasiStatic),
)"#;
    let run = run(&scene_text(text, &[]));
    let mut work = 0.0;
    let mut last = 0.0;
    for step in &run.steps {
        let [bottom, top] = [&step.report.supports[0], &step.report.supports[1]];
        for c in 0..3 {
            assert!(
                (bottom.moment[c] + top.moment[c]).abs() < 1e-9,
                "{:?} {:?}",
                bottom.moment,
                top.moment
            );
            assert!((bottom.force[c] + top.force[c]).abs() < 1e-9);
        }
        assert!(top.moment[2] > last && top.moment[0].abs() < 1e-8);
        work += 0.5 * (last + top.moment[2]) * 0.05;
        last = top.moment[2];
    }
    let strain = run.last().state.strain_energy;
    assert!(
        (work / strain - 1.0).abs() < 2e-3,
        "moment times angle {work} J, strain energy {strain} J"
    );
}
