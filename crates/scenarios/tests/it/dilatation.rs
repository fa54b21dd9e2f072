//! The choice of the dilatation: schema, warning, refusal, and a run whose audit closes.

use scenarios::build;
use scenarios::output::{History, Status};
use scenarios::report::description;
use scenarios::run;
use scenarios::spec::{Dilatation, LoadedScene, parse};

use crate::fresh_folder;

/// A block of rubber is pressed between its fixed base and a plate that sticks to it.
const PRESS: &str = r#"(
    title: "press",
    materials: { "rubber": (law: NeoHookean(G: 1e6, nu: 0.4999), density: 1000) },
    bodies: {
        "block": (mesh: Rectangle(min: (0, 0), max: (2, 1), cells: (8, 4)), material: "rubber", dilatation: Projected),
    },
    motions: {
        "base": (nodes: "block.y_min"),
        "plate": (nodes: "block.y_max", motion: Move(translation: (0, [(0, 0), (1, -0.2)], 0))),
    },
    time: (end: 1, dt: 0.1, inertia: QuasiStatic),
)
"#;

fn changed(from: &str, to: &str) -> LoadedScene {
    assert!(PRESS.contains(from), "{from}");
    parse("press.ron", &PRESS.replace(from, to), &[]).unwrap()
}

#[test]
fn nearly_incompressible_matter_with_a_pointwise_dilatation_is_warned_of() {
    let warned = |from: &str, to: &str| {
        let scene = changed(from, to).scene;
        let text = description("press", &scene);
        assert_eq!(
            scene.warnings().is_empty(),
            !text.contains("warning: "),
            "{text}"
        );
        scene.warnings()
    };
    assert!(warned("press", "press").is_empty());
    let pointwise = warned(", dilatation: Projected", "");
    assert!(pointwise[0].contains("`block`") && pointwise[0].contains("dilatation: Projected"));
    assert_eq!(
        warned("dilatation: Projected", "dilatation: Pointwise"),
        pointwise
    );
    let scene = changed("nu: 0.4999", "nu: 0.44").scene;
    assert_eq!(scene.bodies["block"].dilatation, Dilatation::Projected);
    let soft = PRESS
        .replace("nu: 0.4999", "nu: 0.44")
        .replace("Projected", "Pointwise");
    assert!(
        parse("press.ron", &soft, &[])
            .unwrap()
            .scene
            .warnings()
            .is_empty()
    );
}

#[test]
fn triangles_cannot_have_a_projected_dilatation() {
    let loaded = changed("cells: (8, 4)", "cells: (8, 4), element: Tri3");
    let error = build(&loaded).unwrap_err();
    assert_eq!(error.faults()[0].path, "bodies.block.dilatation");
    assert!(error.to_string().contains("use Quad4"), "{error}");
}

/// The plate needs far less force than with elements that lock, and the energy audit closes to the last digits.
#[test]
fn a_pressed_block_of_rubber_runs_and_its_audit_closes() {
    let force = |from: &str, to: &str| {
        let folder = fresh_folder(&format!("dilatation{}", to.len()));
        let loaded = changed(from, to);
        let summary = run(&loaded, &folder, &mut |_| {}).unwrap();
        assert_eq!(summary.status, Status::Completed);
        let energy = &summary.energy;
        assert!(
            energy.unexplained().abs() < 1e-9 * energy.terms.load_work,
            "{energy:?}"
        );
        assert_eq!(
            summary.warnings.is_empty(),
            to.contains("Projected"),
            "{:?}",
            summary.warnings
        );
        let history = History::read(&folder.join("history.csv")).unwrap();
        *history.column("force.plate.y").unwrap().last().unwrap()
    };
    let free = force("Projected", "Projected");
    let locked = force(", dilatation: Projected", "");
    assert!(locked / free > 1.5, "{locked} {free}");
}
