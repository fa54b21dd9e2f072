//! What a plane scene refuses.

use scenarios::spec::parse;

use super::{PLANE, changed};

/// The change makes one fault, at this path and with these words.
fn refused(from: &str, to: &str, path: &str, words: &[&str]) {
    let error = changed(from, to).expect_err(to);
    let [fault] = error.faults() else {
        panic!("{to}: not one fault but\n{error}")
    };
    assert_eq!(fault.path, path, "{to}: {fault}");
    for word in words {
        assert!(
            fault.message.contains(word),
            "`{word}` is missing in: {fault}"
        );
    }
}

#[test]
fn plane_and_solid_bodies_are_not_mixed() {
    let solid = "Box(min: (0, 0, 0), max: (1, 1, 1), cells: (1, 1, 1))";
    let plate = "Rectangle(min: (0, 2), max: (4, 3), cells: (8, 2))";
    let error = changed(plate, solid).unwrap_err();
    let fault = error
        .faults()
        .iter()
        .find(|f| f.path == "bodies.plate.mesh");
    let message = &fault.unwrap().message;
    assert!(
        message.contains("is a solid mesh, but body `wheel` is plane"),
        "{message}"
    );
    let text = format!(
        r#"(title: "x", symmetry: PlaneStrain, materials: {{ "m": (law: BlatzKo(G: 1), density: 1) }},
        bodies: {{ "a": (mesh: {solid}, material: "m") }}, time: (end: 1, dt: 1))"#
    );
    let error = parse("x.ron", &text, &[]).unwrap_err().to_string();
    assert!(
        error.contains("symmetry") && error.contains("leave it out"),
        "{error}"
    );
}

#[test]
fn axes_of_grids_are_checked_piece_by_piece() {
    let plate = "Rectangle(min: (0, 2), max: (4, 3), cells: (8, 2))";
    let grid = |x: &str| format!("Grid(x: {x}, y: (from: 2, pieces: [Cells(to: 3, cells: 2)]))");
    let start = "Cells(to: 1, cells: 4)";
    let good = grid(&format!(
        "(from: 0, pieces: [{start}, Growing(to: 4, growth: 1.2)])"
    ));
    changed(plate, &good).unwrap();
    let cases: &[(&str, &str, &[&str])] = &[
        ("Growing(to: 4, growth: 0.9)", "1.growth", &["1 or more"]),
        (
            "Growing(to: 0.5, growth: 1.2)",
            "1.to",
            &["1 [m]", "same way"],
        ),
        ("Cells(to: 4, cells: 0)", "1.cells", &["1 or more"]),
        (
            "Cells(to: 4, cells: 2, grading: 0)",
            "1.grading",
            &["between 1e-9 and 1e9"],
        ),
        (
            "Cells(to: 4, cells: 2, grading: 1e300)",
            "1.grading",
            &["between 1e-9 and 1e9"],
        ),
        ("Growing(to: 4, growth: inf)", "1.growth", &["at most 1e9"]),
        ("Cells(to: 1, cells: 2)", "1.to", &["must differ"]),
    ];
    for (piece, path, words) in cases {
        let mesh = grid(&format!("(from: 0, pieces: [{start}, {piece}])"));
        refused(
            plate,
            &mesh,
            &format!("bodies.plate.mesh.x.pieces.{path}"),
            words,
        );
    }
    let path = "bodies.plate.mesh.x.pieces";
    let first = grid("(from: 0, pieces: [Growing(to: 4, growth: 1.2)])");
    refused(plate, &first, &format!("{path}.0"), &["begin with Cells"]);
    refused(plate, &grid("(from: 0, pieces: [])"), path, &["a piece"]);
}

#[test]
fn nothing_leaves_the_plane() {
    let cases: &[(&str, &str, &str, &[&str])] = &[
        (
            "(1, 0, 0))",
            "(1, 0, 2))",
            "bodies.wheel.velocity.2",
            &["no z"],
        ),
        (
            "(1, 0, 0))",
            "(1, 0, 0), spin: (0, 1, 0))",
            "bodies.wheel.spin",
            &["along z"],
        ),
        (
            "-0.1)], 0)",
            "-0.1)], 1)",
            "motions.top.motion.translation.2",
            &["no z"],
        ),
        (
            "nodes: \"plate.y_max\"",
            "components: \"z\", nodes: \"plate.y_max\"",
            "motions.top.components",
            &["x or y"],
        ),
        (
            "nodes: \"plate.y_max\"",
            "components: \"xyz\", nodes: \"plate.y_max\"",
            "motions.top.components",
            &["letters xy", "no z"],
        ),
        (
            "-0.1)], 0)",
            "0)], 0), rotation: (point: (0, 0, 0), axis: (0, 1, 1), angle: 1)",
            "motions.top.motion.rotation.axis",
            &["along z"],
        ),
        ("-9.81, 0", "-9.81, 1", "loads.weight.2", &["no z"]),
        (
            "normal: (0, 1, 0)",
            "normal: (0, 1, 1)",
            "interfaces.ground.master.normal.2",
            &["no z"],
        ),
        (
            "Plane(point: (0, 0, 0), normal: (0, 1, 0))",
            "Sphere(center: (0, 0, 1), radius: 1)",
            "interfaces.ground.master.center.2",
            &["no z"],
        ),
        (
            "Plane(point: (0, 0, 0), normal: (0, 1, 0))",
            "Cylinder(point: (0, 0, 0), axis: (1, 0, 1), radius: 1)",
            "interfaces.ground.master.axis.2",
            &["no z"],
        ),
        (
            "Plane(point: (0, 0, 0), normal: (0, 1, 0))",
            "Punch(center: (0, 0, 0), axis: (0, 1, 1), radius: 1)",
            "interfaces.ground.master.axis.2",
            &["no z"],
        ),
        (
            "node: (1, 1, 0)",
            "node: (1, 1, 1)",
            "output.probes.hub.node.2",
            &["no z"],
        ),
        (
            "radius: 1",
            "radius: 0",
            "bodies.wheel.mesh.radius",
            &["greater than 0"],
        ),
        (
            "max: (4, 3)",
            "max: (4, 1)",
            "bodies.plate.mesh.max.1",
            &["inverted"],
        ),
        (
            "cells: 4",
            "cells: 0",
            "bodies.wheel.mesh.cells",
            &["1 or more"],
        ),
        (
            "wheel.rim\", master: Plane",
            "wheel.dome\", master: Plane",
            "interfaces.ground.slave",
            &["`rim`"],
        ),
    ];
    for (from, to, path, words) in cases {
        refused(from, to, path, words);
    }
    let cylinder = "Cylinder(point: (0, 0, 5), axis: (0, 0, 2), radius: 1)";
    changed("Plane(point: (0, 0, 0), normal: (0, 1, 0))", cylinder).unwrap();
}

#[test]
fn an_axisymmetric_scene_keeps_its_axis() {
    let end = "time: (end: 1, dt: 0.1)";
    changed(end, &format!("{end}, symmetry: Axisymmetric")).unwrap();
    let text = PLANE.replace(end, &format!("{end}, symmetry: Axisymmetric"));
    let refuse = |from: &str, to: &str, path: &str, words: &[&str]| {
        let error = parse("ring.ron", &text.replace(from, to), &[]).expect_err(to);
        let fault = &error.faults()[0];
        assert_eq!(
            (error.faults().len(), fault.path.as_str()),
            (1, path),
            "{error}"
        );
        assert!(
            words.iter().all(|word| fault.message.contains(word)),
            "{fault}"
        );
    };
    refuse(
        "min: (0, 2)",
        "min: (-1, 2)",
        "bodies.plate.mesh",
        &["x = -1", "radius"],
    );
    refuse(
        "center: (1, 1)",
        "center: (0, 1)",
        "bodies.wheel.mesh",
        &["x = -1"],
    );
    refuse("(0, -9.81", "(1, -9.81", "loads.weight.0", &["no symmetry"]);
    refuse(
        "-0.1)], 0)",
        "0)], 0), rotation: (point: (0, 0, 0), axis: (0, 0, 1), angle: 1)",
        "motions.top.motion.rotation",
        &["cannot turn"],
    );
    refuse(
        "normal: (0, 1, 0))",
        "normal: (0, 1, 0)), motion: Move(translation: (1, 0, 0))",
        "interfaces.ground.motion.translation.0",
        &["keeps its radius"],
    );
}
