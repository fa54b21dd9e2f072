//! Scenes: what is refused, where, and with which words.

use scenarios::spec::parse;

use crate::scene::{SMALL, changed};

/// Each change is refused with one fault at the start of `place` in the changed text, with this path and words.
pub(crate) fn refused(from: &str, to: &str, place: &str, path: &str, words: &[&str]) {
    let text = SMALL.replace(from, to);
    let error = changed(from, to).expect_err(to);
    let [fault] = error.faults() else {
        panic!("{to}: not one fault but\n{error}")
    };
    let start = text.find(to).unwrap()
        + to.find(place)
            .unwrap_or_else(|| panic!("`{place}` is not in `{to}`"));
    let line = text[..start].matches('\n').count() + 1;
    let column = start - text[..start].rfind('\n').unwrap();
    assert_eq!((fault.line, fault.column), (line, column), "{to}: {fault}");
    assert_eq!(fault.path, path, "{to}: {fault}");
    let shown = error.to_string();
    assert!(
        shown.starts_with(&format!("small.ron:{line}:{column}: {path}")),
        "{shown}"
    );
    for word in words {
        assert!(shown.contains(word), "`{word}` is missing in: {shown}");
    }
}

#[test]
fn impossible_values_are_refused_with_their_place() {
    let cases: &[(&str, &str, &str, &str, &[&str])] = &[
        (
            "density: 1000.0",
            "density: -5",
            "-5",
            "materials.rubber.density",
            &["= -5", "greater than 0", "kg/m^3"],
        ),
        (
            "BlatzKo(G: 2.0e6)",
            "BlatzKo(G: 0)",
            "0",
            "materials.rubber.law.G",
            &["strictly between 0"],
        ),
        ("dt: 0.1", "dt: 0", "0", "time.dt", &["greater than 0 [s]"]),
        (
            "dt: 0.1",
            "dt: 2",
            "2",
            "time.dt",
            &["must not exceed time.end = 1"],
        ),
        (
            "end: 1,",
            "end: inf,",
            "inf",
            "time.end",
            &["greater than 0"],
        ),
        (
            "dt: 0.1",
            "dt: 0.1, theta: 0.4",
            "0.4",
            "time.theta",
            &["from 0.5 to 1"],
        ),
        (
            "dt: 0.1",
            "dt: 0.1, xi: 1.5",
            "1.5",
            "time.xi",
            &["from 0.5 to 1"],
        ),
        (
            "dt: 0.1",
            "dt: 0.1, min_dt: 0.2",
            "0.2",
            "time.min_dt",
            &["at most time.dt = 0.1"],
        ),
        (
            "mu: 0.4",
            "mu: -0.4",
            "-0.4",
            "interfaces.ground.mu",
            &["0 or more"],
        ),
        (
            "dt: 0.1",
            "dt: 0.1, min_dt: 1e-20",
            "1e-20",
            "time.min_dt",
            &["round-off of time.end"],
        ),
        (
            "time: (",
            "solver: (contact_tolerance: 0.999), time: (",
            "0.999",
            "solver.contact_tolerance",
            &["from 1e-15 to 1e-2", "guessed"],
        ),
        (
            "Plane(point: (0, 0, 0), normal: (0, 0, 1))",
            "Facets(\"block.z_max\")",
            "Facets",
            "interfaces.ground.master",
            &["a side of body `block`", "not supported"],
        ),
        (
            "mu: 0.4",
            "mu: NaN",
            "NaN",
            "interfaces.ground.mu",
            &["0 or more"],
        ),
        (
            "mu: 0.4",
            "restitution: 0.5",
            "0.5",
            "interfaces.ground.restitution",
            &["time.contact: Velocity"],
        ),
        (
            "\"block.z_min\"",
            "\"block.zmin\"",
            "\"block.zmin\"",
            "interfaces.ground.slave",
            &["`z_min`", "x_min"],
        ),
        (
            "\"block.z_min\"",
            "\"blok.z_min\"",
            "\"blok.z_min\"",
            "interfaces.ground.slave",
            &["no body", "`block`"],
        ),
        (
            "\"block.z_min\"",
            "\"\"",
            "\"\"",
            "interfaces.ground.slave",
            &["names no facet set"],
        ),
        (
            "\"block.z_max\"",
            "\"z_max\"",
            "\"z_max\"",
            "motions.top.nodes",
            &["body.set"],
        ),
        (
            "material: \"rubber\"",
            "material: \"gum\"",
            "\"gum\"",
            "bodies.block.material",
            &["`gum`", "`rubber`"],
        ),
        (
            "max: (1, 1, 1)",
            "max: (1, 0, 1)",
            "0",
            "bodies.block.mesh.max.1",
            &["inverted"],
        ),
        (
            "cells: (2, 2, 2)",
            "cells: (2, 0, 2)",
            "0",
            "bodies.block.mesh.cells.1",
            &["1 or more"],
        ),
        (
            "[(0, 0), (1, -0.1)]",
            "[(0, 0), (0, 1)]",
            "0, 1",
            "motions.top.motion.translation.2.1.0",
            &["increase"],
        ),
        (
            "[(0, 0), (1, -0.1)]",
            "[]",
            "[]",
            "motions.top.motion.translation.2",
            &["at least one point"],
        ),
        (
            "normal: (0, 0, 1)",
            "normal: (0, 0, 0)",
            "(0, 0, 0)",
            "interfaces.ground.master.normal",
            &["zero vector"],
        ),
        (
            "motion: Move",
            "components: \"xq\", motion: Move",
            "\"xq\"",
            "motions.top.components",
            &["xyz"],
        ),
        ("title", "refine: 0, title", "0", "refine", &["1 or more"]),
        (
            "material: \"rubber\"",
            "material: \"rubber\", velocity: (inf, 0, 0)",
            "(inf",
            "bodies.block.velocity",
            &["finite"],
        ),
        (
            "material: \"rubber\"",
            "material: \"rubber\", spin: (0, inf, 0)",
            "(0, inf",
            "bodies.block.spin",
            &["finite"],
        ),
        (
            "time: (",
            "output: (plots: [Energy, Force(\"no\")]), time: (",
            "Force",
            "output.plots.1",
            &["`ground`", "`top`"],
        ),
        (
            "time: (",
            "damping: (mass: -1), time: (",
            "-1",
            "damping.mass",
            &["0 or more"],
        ),
        (
            "time: (",
            "solver: (max_newton: 0), time: (",
            "0",
            "solver.max_newton",
            &["1 or more"],
        ),
        (
            "\"ground\": (slave",
            "\"top\": (slave",
            "(slave",
            "interfaces.top",
            &["names must differ"],
        ),
    ];
    for (from, to, place, path, words) in cases {
        refused(from, to, place, path, words);
    }
}

#[test]
fn slips_in_the_text_are_refused_with_their_place() {
    let cases: &[(&str, &str, &str, &str, &[&str])] = &[
        (
            "density",
            "densty",
            "densty",
            "materials.rubber",
            &["no field `densty`", "did you mean `density`"],
        ),
        (
            "BlatzKo",
            "BlatzKoh",
            "BlatzKoh",
            "materials.rubber.law",
            &["no choice", "did you mean `BlatzKo`"],
        ),
        (
            "dt: 0.1",
            "dt: abc",
            "abc",
            "time.dt",
            &["must be a number"],
        ),
        (
            "cells: (2, 2, 2)",
            "cells: (2, 2)",
            "(2, 2)",
            "bodies.block.mesh.cells",
            &["length 3"],
        ),
        (
            "cells: (2, 2, 2)",
            "cells: (2, 2.5, 2)",
            "2.5",
            "bodies.block.mesh.cells.1",
            &["whole number"],
        ),
        (
            "cells: (2, 2, 2)",
            "cells: (2, -2, 2)",
            "-2",
            "bodies.block.mesh.cells.1",
            &["whole number"],
        ),
        (
            "[(0, 0), (1, -0.1)]",
            "Smoth([(0, 0)])",
            "Smoth",
            "motions.top.motion.translation.2",
            &["a table"],
        ),
    ];
    for (from, to, place, path, words) in cases {
        refused(from, to, place, path, words);
    }
}

#[test]
fn a_missing_field_is_named() {
    let error = changed(", dt: 0.1", "").unwrap_err();
    assert_eq!(error.faults()[0].line, 18);
    assert!(
        error
            .to_string()
            .contains("time: the field `dt` is missing"),
        "{error}"
    );
}

#[test]
fn all_faults_are_told_at_once_in_the_order_of_the_text() {
    let text = SMALL
        .replace("density: 1000.0", "density: 0")
        .replace("mu: 0.4", "mu: -1")
        .replace("dt: 0.1", "dt: -1");
    let error = parse("small.ron", &text, &[]).unwrap_err();
    let lines: Vec<usize> = error.faults().iter().map(|fault| fault.line).collect();
    assert_eq!(lines, [4, 16, 18]);
}

#[test]
fn a_name_that_stands_twice_is_refused() {
    let twice = "\"rubber\": (law: BlatzKo(G: 1), density: 1), \"rubber\": (law: BlatzKo";
    let error = changed("\"rubber\": (law: BlatzKo", twice).unwrap_err();
    assert!(
        error
            .to_string()
            .contains("materials.rubber: this name stands twice"),
        "{error}"
    );
}

#[test]
fn parameters_outside_the_bounds_of_a_law_are_refused_at_the_parameter() {
    let law = "BlatzKo(G: 2.0e6)";
    let refused =
        |to: &str, place: &str, path: &str, words: &[&str]| refused(law, to, place, path, words);
    let three = |a: &str| format!("ThreeE(G: 5000, K: 3333, {a})");
    refused(
        &three("a1: 2e3, a5: 100"),
        "2e3",
        "materials.rubber.law.a1",
        &["1000", "eq. 17"],
    );
    refused(
        &three("a3: -1"),
        "-1",
        "materials.rubber.law.a3",
        &["eq. 17"],
    );
    refused(
        "NeoHookean(E: 10, nu: 0.5)",
        "0.5",
        "materials.rubber.law.nu",
        &["-1", "0.5"],
    );
    refused(
        "NeoHookean(E: 10, nu: -0.5)",
        "NeoHookean",
        "materials.rubber.law",
        &["nu >= 0"],
    );
    refused(
        "SaintVenantKirchhoff(E: -1, nu: 0)",
        "-1",
        "materials.rubber.law.E",
        &["between 0"],
    );
}
