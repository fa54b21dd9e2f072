//! Scenes: what is read.

use scenarios::catalog::{self, SCENES};
use scenarios::spec::{
    Interpolation, LoadedScene, Motion, SceneError, SpanTree, Table, field_paths, parse,
};

/// Three lines a field, so that lines are easy to count.
pub(crate) const SMALL: &str = r#"(
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

pub(crate) fn changed(from: &str, to: &str) -> Result<LoadedScene, SceneError> {
    assert!(SMALL.contains(from), "the small scene has no `{from}`");
    parse("small.ron", &SMALL.replace(from, to), &[])
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
