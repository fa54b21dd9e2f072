//! Scenes: what is read, and what is refused where.

use scenarios::catalog::{self, SCENES};
use scenarios::spec::{
    Interpolation, LoadedScene, Motion, SceneError, SpanTree, Table, field_paths, parse,
};

/// Three lines a field, so that lines are easy to count.
const SMALL: &str = r#"(
    title: "small", // line 2
    materials: {
        "rubber": (law: BlatzKo(G: 2.0e6), density: 1000.0), // line 4
    },
    bodies: {
        "block": (
            mesh: Box(min: (0, 0, 0), max: (1, 1, 1), cells: (2, 2, 2)), // line 8
            material: "rubber",
        ),
    },
    motions: {
        "top": (nodes: "block.z_max", motion: Move(translation: (0, 0, [(0, 0), (1, -0.1)]))), // line 13
    },
    interfaces: {
        "ground": (slave: "block.z_min", master: Plane(point: (0, 0, 0), normal: (0, 0, 1)), mu: 0.4), // line 16
    },
    time: (end: 1, dt: 0.1), // line 18
)
"#;

fn changed(from: &str, to: &str) -> Result<LoadedScene, SceneError> {
    assert!(SMALL.contains(from), "the small scene has no `{from}`");
    parse("small.ron", &SMALL.replace(from, to), &[])
}

/// Each change is refused with one fault at the start of `place` in the changed text, with this path and words.
fn refused(from: &str, to: &str, place: &str, path: &str, words: &[&str]) {
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
fn the_small_scene_is_fine_and_defaults_hold() {
    let scene = parse("small.ron", SMALL, &[]).unwrap().scene;
    assert_eq!(
        (scene.refine, scene.time.theta, scene.time.xi),
        (1, 0.5, 0.5)
    );
    assert_eq!(scene.size().elements, 8);
    assert_eq!(scene.size().dofs, 81);
    assert_eq!(scene.step_count(), 10);
    let Motion::Move {
        translation,
        rotation: None,
    } = &scene.motions["top"].motion
    else {
        panic!()
    };
    assert_eq!(
        translation[2],
        Table::Points(Interpolation::Linear, vec![(0.0, 0.0), (1.0, -0.1)])
    );
}

#[test]
fn every_built_in_scene_passes_its_checks() {
    for entry in SCENES {
        let loaded = catalog::load(entry.name, &[]).unwrap_or_else(|e| panic!("{e}"));
        assert!(!loaded.scene.description.is_empty());
        assert!(!loaded.scene.source.is_empty());
    }
}

#[test]
fn impact_is_the_papers_problem() {
    let scene = catalog::load("impact", &[]).unwrap().scene;
    let upper = &scene.bodies["upper"];
    let volume = 1.0;
    let speed2: f64 = upper.velocity.iter().map(|v| v * v).sum();
    assert_eq!(
        0.5 * scene.materials["soft"].density * volume * speed2,
        162.5
    );
    assert_eq!(scene.size().elements, 8 * 8 * 4 + 4 * 4 * 4);
    assert_eq!(scene.step_count(), 100);
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
fn elastic_constants_come_in_pairs() {
    let law = |text: &str| {
        changed("BlatzKo(G: 2.0e6)", text).map(|l| l.scene.materials["rubber"].law.clone())
    };
    // E = 10, nu = 0.25: G = 4, K = 20/3, lambda = 4.
    let pairs = [
        "E: 10, nu: 0.25",
        "E: 10, G: 4",
        "G: 4, lambda: 4",
        "nu: 0.25, G: 4",
        "G: 4, K: 6.666666666666667",
        "nu: 0.25, K: 6.666666666666667",
    ];
    for pair in pairs {
        for name in ["NeoHookean", "SaintVenantKirchhoff"] {
            let elastic = law(&format!("{name}({pair})"))
                .unwrap()
                .elastic_constants()
                .unwrap();
            assert!((elastic.shear_modulus() - 4.0).abs() < 1e-12, "{pair}");
            assert!(
                (elastic.bulk_modulus() - 20.0 / 3.0).abs() < 1e-12,
                "{pair}"
            );
        }
    }
    for wrong in ["E: 10", "E: 10, nu: 0.25, G: 4", ""] {
        let error = law(&format!("NeoHookean({wrong})")).unwrap_err();
        assert!(error.to_string().contains("exactly two"), "{error}");
    }
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

#[test]
fn tables_have_four_spellings() {
    let table = |text: &str| {
        let scene = changed("[(0, 0), (1, -0.1)]", text).unwrap().scene;
        let Motion::Move { translation, .. } = scene.motions["top"].motion.clone() else {
            panic!()
        };
        translation[2].clone()
    };
    let points = vec![(0.0, 0.0), (0.5, 2.0)];
    assert_eq!(table(".5"), Table::Constant(0.5));
    assert_eq!(table("/* up */ 1 // m\n"), Table::Constant(1.0));
    assert_eq!(
        table("[(0, 0), (.5, 2)]"),
        Table::Points(Interpolation::Linear, points.clone())
    );
    assert_eq!(
        table("Linear([(0, 0), (.5, 2)])"),
        Table::Points(Interpolation::Linear, points.clone())
    );
    assert_eq!(
        table("Smooth([(0, 0), (.5, 2)])"),
        Table::Points(Interpolation::Smooth, points)
    );
}

#[test]
fn every_path_of_a_text_is_a_path_of_the_scene() {
    for entry in SCENES {
        let scene = catalog::load(entry.name, &[]).unwrap().scene;
        let known = field_paths(&scene);
        for (path, _) in SpanTree::scan(entry.text).unwrap().paths() {
            assert!(known.contains(&path), "{}: {path}", entry.name);
        }
        assert!(
            known.contains(&"solver.max_newton".to_owned()),
            "defaults are paths too"
        );
    }
}

#[test]
fn what_only_the_model_knows_can_point_into_the_text() {
    let loaded = parse("small.ron", SMALL, &[]).unwrap();
    let error = loaded.refuse("materials.rubber.law.G", "is too soft");
    assert_eq!(
        error.to_string(),
        "small.ron:4:36: materials.rubber.law.G = 2.0e6: is too soft"
    );
    let absent = loaded.refuse("solver.max_newton", "is too small");
    assert_eq!(
        absent.to_string(),
        "small.ron:1:1: solver.max_newton: is too small"
    );
}
