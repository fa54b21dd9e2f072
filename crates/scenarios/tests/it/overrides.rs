//! `--set`.

use scenarios::catalog;
use scenarios::spec::{LoadedScene, Override, SceneError, Table};

fn with(sets: &[&str]) -> Result<LoadedScene, SceneError> {
    let sets: Vec<Override> = sets.iter().map(|set| set.parse().unwrap()).collect();
    catalog::load("impact", &sets)
}

#[test]
fn full_and_abbreviated_paths_change_the_same_value() {
    for path in ["interfaces.blocks.mu", "blocks.mu", "mu"] {
        let loaded = with(&[&format!("{path}=.5")]).unwrap();
        assert_eq!(loaded.scene.interfaces["blocks"].mu, 0.5);
        assert_eq!(loaded.source.sets[0].path, "interfaces.blocks.mu");
    }
    let scene = with(&[
        "dt=1e-3",
        "refine=2",
        "law.G=6000",
        "upper.mesh.cells=(1,2,3)",
    ])
    .unwrap()
    .scene;
    assert_eq!((scene.time.dt, scene.refine), (1e-3, 2));
    assert_eq!(scene.size().elements, 16 * 16 * 8 + 2 * 4 * 6);
}

#[test]
fn comments_and_lines_survive() {
    let before = with(&[]).unwrap().source.text;
    let after = with(&["mu=0.75"]).unwrap().source.text;
    assert_eq!(after, before.replace("mu: 0.2,", "mu: 0.75,"));
    let error = with(&["mu=0.75", "dt=-1"]).unwrap_err();
    let line = before
        .lines()
        .position(|line| line.contains("dt: 0.01"))
        .unwrap()
        + 1;
    assert_eq!(error.faults()[0].line, line);
    assert!(
        error.to_string().ends_with("(from --set time.dt=-1)"),
        "{error}"
    );
}

#[test]
fn absent_fields_are_inserted() {
    let loaded = with(&[
        "restitution=.5",
        "contact=Velocity",
        "stiffness=1e-4",
        "max_newton=7",
    ])
    .unwrap();
    assert_eq!(loaded.scene.interfaces["blocks"].restitution, 0.5);
    assert_eq!(loaded.scene.damping.stiffness, 1e-4);
    assert_eq!(loaded.scene.solver.max_newton, Some(7));
    let before = with(&[]).unwrap().source.text;
    assert_eq!(loaded.source.text.lines().count(), before.lines().count());
    // The inserted field can be set again.
    assert_eq!(
        with(&["max_newton=7", "max_newton=8"])
            .unwrap()
            .scene
            .solver
            .max_newton,
        Some(8)
    );
}

#[test]
fn texts_need_no_quotes() {
    assert_eq!(
        with(&["title=Two blocks"]).unwrap().scene.title,
        "Two blocks"
    );
    assert_eq!(with(&["title=blocks"]).unwrap().scene.title, "blocks");
    assert_eq!(with(&["title=a // b"]).unwrap().scene.title, "a // b");
    assert_eq!(
        with(&["blocks.slave=upper.x_min"])
            .unwrap()
            .scene
            .interfaces["blocks"]
            .slave,
        "upper.x_min"
    );
}

#[test]
fn values_of_any_kind_can_be_set() {
    let scene = with(&["base.motion=Move(translation: (0, 0, Smooth([(0, 0), (1, .1)])))"])
        .unwrap()
        .scene;
    let motion = &scene.motions["base"].motion;
    let scenarios::spec::Motion::Move { translation, .. } = motion else {
        panic!()
    };
    assert!(matches!(&translation[2], Table::Points(..)));
    let scene = with(&["plots=[Energy]", "fields_every=Never"])
        .unwrap()
        .scene;
    assert_eq!(scene.output.plots.len(), 1);
}

#[test]
fn unclear_paths_are_refused_with_help() {
    let ambiguous = with(&["cells=(1,1,1)"]).unwrap_err().to_string();
    assert!(
        ambiguous.contains("bodies.lower.mesh.cells, bodies.upper.mesh.cells"),
        "{ambiguous}"
    );
    let unknown = with(&["theat=1"]).unwrap_err().to_string();
    assert!(unknown.contains("near: time.theta"), "{unknown}");
    let wrong = with(&["dt=soon"]).unwrap_err().to_string();
    assert!(
        wrong.starts_with("--set dt=soon: the value does not fit time.dt"),
        "{wrong}"
    );
    assert!(wrong.contains("it is 0.01 in impact.ron:"), "{wrong}");
    let inner = with(&["lower.mesh.grading.0=2"]).unwrap_err().to_string();
    assert!(
        inner.contains("set the whole of bodies.lower.mesh.grading"),
        "{inner}"
    );
    for bad in ["mu", "=3", "mu="] {
        assert!(bad.parse::<Override>().is_err(), "{bad}");
    }
}

#[test]
fn a_value_cannot_break_out_of_its_place() {
    for value in ["1) evil: (", "1, restitution: 1", "1 /*", "\"", "(1", "1}"] {
        let error = with(&[&format!("mu={value}")]).unwrap_err();
        assert!(matches!(error, SceneError::Set { .. }), "{value}: {error}");
    }
}
