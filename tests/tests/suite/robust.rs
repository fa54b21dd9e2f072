//! Scenes at the edge of what the program takes, most of them found by the stress runs.

use nscd::{NoClock, NscdError, Side, State, StepFailure, Stepper};
use scenarios::build;
use scenarios::spec::LoadedScene;

use crate::common::{run, scene, scene_text, try_run};

/// A soft block above a stiffer one; `first` says what drives it.
fn pair(first: &str, master: &str, inertia: &str) -> String {
    format!(
        r#"(
    title: "pair",
    materials: {{"soft": (law: NeoHookean(E: 1.0e6, nu: 0.3), density: 1000.0)}},
    bodies: {{
        "first": (mesh: Rectangle(min: (-0.004, 0.0), max: (0.004, 0.004), cells: (2, 2)), material: "soft"),
        "second": (mesh: Rectangle(min: (-0.008, -0.004), max: (0.008, 0.0), cells: (5, 2)), material: "soft"),
    }},
    motions: {{
        "drive": (nodes: "{first}", components: "xy", motion: Move(translation: ([(0.0, 0.0), (1.0, 1.0e-4)], [(0.0, 0.0), (1.0, -2.0e-4)], 0.0))),
        "bottom": (nodes: "second.y_min", components: "xy"),
    }},
    interfaces: {{"contact": (slave: "first.y_min", master: {master}, mu: 0.3)}},
    time: (end: 1.0, dt: 0.1, theta: 1.0, xi: 1.0, inertia: {inertia}),
)"#
    )
}

/// A body without unknowns presses like any other.
#[test]
fn a_body_whose_nodes_are_all_driven_presses_like_a_rigid_one() {
    let facets = "Facets(\"second.y_max\")";
    let force = |first: &str, inertia: &str| {
        let run = run(&scene_text(&pair(first, facets, inertia), &[]));
        run.assert_audited(run.totals.largest_energy, 1e-10);
        run.contact_force(1).last().copied().unwrap()
    };
    let (all, dynamic) = (
        force("first.all", "QuasiStatic"),
        force("first.all", "Dynamic"),
    );
    // Slow against the waves: inertia changes little. Two soft blocks give way more than one.
    assert!((dynamic / all - 1.0).abs() < 0.01, "{dynamic} {all}");
    let face = force("first.y_max", "QuasiStatic");
    assert!(face > 0.3 * all && face < 0.9 * all, "{face} {all}");
}

#[test]
fn two_driven_sides_that_overlap_are_told_apart_from_a_hard_problem() {
    let plane = "Plane(point: (0.0, 0.0, 0.0), normal: (0.0, 1.0, 0.0))";
    let run = try_run(&scene_text(&pair("first.all", plane, "QuasiStatic"), &[]));
    let Err(NscdError::Stopped { failure, .. }) = run.end else {
        panic!("{:?}", run.end)
    };
    assert!(
        matches!(failure, StepFailure::Immovable { .. }),
        "{failure}"
    );
    let text = failure.to_string();
    assert!(
        text.contains("node") && text.contains("free some of them"),
        "{text}"
    );
    assert_eq!(run.counters.contact_iterations, 0);
}

/// At the velocity level a node may sink in although no contact was predicted for it; the report says how deep.
#[test]
fn the_velocity_level_reports_penetrations_that_it_did_not_foresee() {
    let radius = 0.02;
    let text = format!(
        r#"(
    title: "unforeseen",
    symmetry: Some(Axisymmetric),
    materials: {{"soft": (law: BlatzKo(G: 4.4e5), density: 260.0)}},
    bodies: {{"block": (mesh: Rectangle(min: (0.0, 5.7e-5), max: (0.0062, 0.01), cells: (2, 5), element: Tri3), material: "soft")}},
    motions: {{
        "axis": (nodes: "block.x_min", components: "x"),
        "drive": (nodes: "block.y_max", components: "xy", motion: Move(translation: (0.0, [(0.0, 0.0), (5.52e-4, -5.0e-4)], 0.0))),
    }},
    interfaces: {{"contact": (slave: "block.y_min", master: Sphere(center: (0.0, -{radius}, 0.0), radius: {radius}), mu: 0.2)}},
    time: (end: 6.0e-4, dt: 6.0e-5, contact: Velocity),
)"#
    );
    let run = run(&scene_text(&text, &[]));
    let model = &run.built.model;
    let mut unforeseen = 0;
    for step in &run.steps {
        let x = model.positions(&step.state.u);
        let depth = |n: &u32| {
            let at = &x[2 * *n as usize..];
            radius - at[0].hypot(at[1] + radius)
        };
        let slaves = model.interfaces[0].slave.iter();
        let deepest = slaves.map(depth).fold(0.0, f64::max);
        assert!(
            (step.report.penetration - deepest).abs() < 1e-15,
            "{} {deepest}",
            step.report.penetration
        );
        let known = |s: &State| s.contacts.iter().map(|c| -c.gap).fold(0.0, f64::max);
        unforeseen += usize::from(deepest > 1e-9 + known(&step.state));
    }
    assert!(unforeseen > 0, "the scene shows nothing any more");
}

/// In the plane a bond on a round obstacle stays in the plane, however far the body rolls round it.
#[test]
fn bonds_on_a_round_obstacle_stay_in_the_plane() {
    let text = r#"(
    title: "round",
    materials: {"soft": (law: NeoHookean(E: 1.0e6, nu: 0.3), density: 1000.0)},
    bodies: {"block": (mesh: Rectangle(min: (-0.004, 0.0), max: (0.004, 0.006), cells: (6, 4)), material: "soft")},
    motions: {"drive": (nodes: "block.y_max", components: "xy", motion: Move(
        translation: ([(0.0, 0.0), (0.4, 0.0), (1.0, 1.5e-3)], [(0.0, 0.0), (0.4, -6.0e-4)], 0.0),
        rotation: Some((point: (0.0, 0.006, 0.0), axis: (0.0, 0.0, 1.0), angle: [(0.0, 0.0), (0.4, 0.0), (1.0, -0.3)])),
    ))},
    interfaces: {"contact": (slave: "block.y_min", master: Sphere(center: (0.0, -0.004, 0.0), radius: 0.004), mu: 0.3,
        adhesion: Some((C_n: 2.0e8, C_t: 2.0e8, w: 2.0, b: 1.0, beta: 1.0)))},
    time: (end: 1.0, dt: 0.05, inertia: QuasiStatic),
)"#;
    let run = try_run(&scene_text(text, &[]));
    assert!(run.end.is_ok(), "{:?}", run.end);
    let mut stretched = 0;
    for contact in run.steps.iter().flat_map(|s| &s.state.contacts) {
        let Some(bond) = contact.bond else { continue };
        assert!(
            bond.separation[1].abs() < 1e-18 && bond.force[1].abs() < 1e-12,
            "{contact:?}"
        );
        stretched +=
            usize::from(bond.separation[0].abs() > 1e-6 && contact.frame.column(2)[0].abs() > 0.1);
    }
    assert!(stretched > 10, "no bond is stretched on a slope");
}

/// A node that a fast, small ball overtakes in one step is not believed, though both ends of its way lie outside.
#[test]
fn a_ball_that_jumps_through_a_node_is_noticed() {
    let text = |dt: f64| {
        format!(
            r#"(
    title: "jump",
    materials: {{"soft": (law: NeoHookean(E: 1.0e6, nu: 0.3), density: 1000.0)}},
    bodies: {{"block": (mesh: Rectangle(min: (-0.01, 0.0), max: (0.01, 0.01), cells: (2, 1)), material: "soft")}},
    motions: {{"held": (nodes: "block.y_max", components: "xy")}},
    interfaces: {{"contact": (slave: "block.y_min", master: Sphere(center: (0.0, -0.002, 0.0), radius: 0.001),
        motion: Move(translation: (0.0, [(0.0, 0.0), (1.0, 0.004)], 0.0)))}},
    time: (end: 1.0, dt: {dt:?}, min_dt: Some({dt:?}), inertia: QuasiStatic),
)"#
        )
    };
    let jumped = try_run(&scene_text(&text(1.0), &[]));
    let Err(NscdError::Stopped { failure, .. }) = jumped.end else {
        panic!("{:?}", jumped.end)
    };
    assert!(matches!(failure, StepFailure::Passed { .. }), "{failure}");
    let slow = try_run(&scene_text(&text(0.05), &[]));
    assert!(slow.end.is_ok(), "{:?}", slow.end);
    assert!(slow.contact_force(1).iter().any(|f| *f > 1.0));
}

/// Without inertia a block that only rests on a plane, guided from the side, carries its load; without a plane to rest
/// on it is told that nothing holds it.
#[test]
fn contact_alone_may_hold_a_quasi_static_body() {
    let text = |gap: f64| {
        format!(
            r#"(
    title: "rests",
    materials: {{"soft": (law: NeoHookean(E: 1.0e6, nu: 0.3), density: 1000.0)}},
    bodies: {{"block": (mesh: Rectangle(min: (0.0, {gap:?}), max: (0.01, 0.02), cells: (2, 2)), material: "soft")}},
    motions: {{"guide": (nodes: "block.x_min", components: "x")}},
    loads: {{"top": Traction(facets: "block.y_max", traction: (0.0, -1.0e4, 0.0), factor: [(0.0, 0.0), (1.0, 1.0)])}},
    interfaces: {{"contact": (slave: "block.y_min", master: Plane(point: (0.0, 0.0, 0.0), normal: (0.0, 1.0, 0.0)))}},
    time: (end: 1.0, dt: 0.25, inertia: QuasiStatic),
)"#
        )
    };
    let rests = run(&scene_text(&text(0.0), &[]));
    let force = rests.contact_force(1);
    assert!((force[3] / 100.0 - 1.0).abs() < 1e-9, "{force:?}");
    assert!(rests.steps.iter().all(|s| s.report.penetration < 1e-9));
    let pulled = text(0.0).replace("-1.0e4", "1.0e4");
    let lost = try_run(&scene_text(&pulled, &[]));
    let Err(NscdError::Stopped { failure, .. }) = lost.end else {
        panic!("{:?}", lost.end)
    };
    assert!(matches!(failure, StepFailure::Adrift { .. }), "{failure}");
}

/// An overlap deeper than the search is refused before the first step, with the node; a node that only lies on a side
/// of the other body, or above it, is not taken for one.
#[test]
fn an_overlap_that_the_search_does_not_see_is_refused() {
    let pair = |space: bool, shift: [f64; 2]| {
        let [x, y] = shift;
        let (mesh, last, cells) = if space {
            ("Box", ", 0.0", ", 2")
        } else {
            ("Rectangle", "", "")
        };
        let block = |x: f64, y: f64, width: f64, n: usize| {
            let (right, top) = (x + width, y + 1.0);
            let thick = last.replace("0.0", "1.0");
            format!(
                "{mesh}(min: ({x:?}, {y:?}{last}), max: ({right:?}, {top:?}{thick}), cells: ({n}, 2{cells}))"
            )
        };
        let (a, b) = (block(x, y, 1.0, 2), block(-1.0, -1.0, 3.0, 5));
        let components = if space { "xyz" } else { "xy" };
        let text = format!(
            r#"(
    title: "overlap",
    materials: {{"soft": (law: NeoHookean(E: 1.0e6, nu: 0.3), density: 1000.0)}},
    bodies: {{"first": (mesh: {a}, material: "soft"), "second": (mesh: {b}, material: "soft")}},
    motions: {{"held": (nodes: "second.y_min", components: "{components}"), "top": (nodes: "first.y_max", components: "{components}")}},
    interfaces: {{"contact": (slave: "first.y_min", master: Facets("second.y_max"), search_distance: Some(0.2))}},
    time: (end: 1.0, dt: 0.5, inertia: QuasiStatic),
)"#
        );
        let built = build(&scene_text(&text, &[])).unwrap();
        Stepper::new(&built.model, Box::new(NoClock)).map(|_| ())
    };
    for space in [false, true] {
        for fine in [
            [0.0, 0.05],
            [0.0, 0.0],
            [0.0, -0.15],
            [0.0, 5.0],
            [2.0, -0.5],
            [2.0, -1.0],
        ] {
            let end = pair(space, fine);
            assert!(end.is_ok(), "{space} {fine:?} {end:?}");
        }
        for (deep, node) in [([0.0, -0.25], 0), ([0.0, -0.6], 0), ([1.75, -0.5], 0)] {
            let end = pair(space, deep);
            let Err(error @ NscdError::Overlap { node: found, .. }) = &end else {
                panic!("{space} {deep:?} {end:?}")
            };
            assert!(space || *found == node, "{error}");
            assert!(
                error.to_string().contains("search_distance: 2e-1 m"),
                "{error}"
            );
        }
    }
}

/// Nodes that lie on a side of the other body as well, because both bodies are as wide, are no exception; a body that
/// another interface pushes out is.
#[test]
fn overlaps_of_bodies_with_a_side_in_common_are_seen_and_press_fits_are_let_through() {
    let start = |loaded: &LoadedScene| {
        let built = build(loaded).unwrap();
        Stepper::new(&built.model, Box::new(NoClock)).map(|_| ())
    };
    let bars = start(&scene("bar-on-bar", &["striker.mesh.max.0=0.5"]));
    assert!(
        matches!(
            bars,
            Err(NscdError::Overlap {
                side: Side::Master,
                ..
            })
        ),
        "{bars:?}"
    );
    assert!(start(&scene("bar-on-bar", &[])).is_ok());
    let collar = r#"(
    title: "collar",
    symmetry: Some(Axisymmetric),
    materials: {"m": (law: NeoHookean(E: 1.0e6, nu: 0.3), density: 1000.0)},
    bodies: {
        "shaft": (mesh: Rectangle(min: (0.0, 0.0), max: (0.51, 1.0), cells: (5, 10)), material: "m"),
        "ring": (mesh: Rectangle(min: (0.5, 0.8), max: (1.0, 1.4), cells: (5, 7)), material: "m"),
    },
    motions: {
        "axis": (nodes: "shaft.x_min", components: "x"),
        "bottom": (nodes: "shaft.y_min", components: "y"),
        "top": (nodes: "ring.y_max", components: "y"),
    },
    interfaces: {
        "fit": (slave: "shaft.x_max", master: Facets("ring.x_min"), mu: 0.2),
        "edge": (slave: "ring.y_min", master: Facets("shaft.y_max")),
    },
    time: (end: 1.0, dt: 0.25, inertia: QuasiStatic),
)"#;
    let fit = run(&scene_text(collar, &[]));
    assert!(fit.totals.overlap.is_none() && fit.totals.max_penetration < 1e-12);
}

/// A bar so soft that it bulges over the rim of the one that it hits goes on beside and through it: nothing holds it
/// there, but the end of the run says so.
#[test]
fn nodes_that_came_in_through_a_side_are_told_at_the_end() {
    let text = r#"(
    title: "past the rim",
    materials: {
        "soft": (law: NeoHookean(E: 1.0e6, nu: 0.3), density: 1000.0),
        "hard": (law: NeoHookean(E: 1.0e8, nu: 0.3), density: 1000.0),
    },
    bodies: {
        "a": (mesh: Rectangle(min: (-1.0, 0.0), max: (0.0, 0.2), cells: (10, 1)), material: "soft", velocity: (5.0, 0.0, 0.0)),
        "b": (mesh: Rectangle(min: (0.0, 0.0), max: (1.0, 0.2), cells: (10, 1)), material: "hard"),
    },
    motions: {"end": (nodes: "b.x_max", components: "xy")},
    interfaces: {"c": (slave: "a.x_max", master: Facets("b.x_min"))},
    time: (end: 0.034, dt: 0.002),
)"#;
    let run = try_run(&scene_text(text, &[]));
    assert!(run.end.is_ok(), "{:?}", run.end);
    let overlap = run.totals.overlap.unwrap();
    assert_eq!(overlap.nodes, 2);
    // Half of the bar is .1 m thick.
    assert!(overlap.depth > 0.03 && overlap.depth < 0.1, "{overlap:?}");
    assert!(run.totals.max_penetration >= overlap.depth);
}

/// Gravity that pulls two blocks through each other at the velocity level, which keeps overlaps: a corner that slips in
/// round the rim and comes to lie under its master is noticed.
#[test]
fn a_contact_that_is_lost_inside_its_master_stops_the_run() {
    let text = r#"(
    title: "lost",
    symmetry: Some(Axisymmetric),
    materials: {"soft": (law: NeoHookean(E: 1.1e6, nu: 0.308), density: 1000.0)},
    bodies: {
        "first": (mesh: Rectangle(min: (0.0, 1.54e-4), max: (0.0075, 0.0098), cells: (4, 5)), material: "soft"),
        "second": (mesh: Rectangle(min: (0.0, -0.0097), max: (0.0075, 0.0), cells: (4, 5)), material: "soft"),
    },
    motions: {
        "axis": (nodes: "first.x_min", components: "x"),
        "drive": (nodes: "first.y_max", components: "xy", motion: Move(translation: (0.0, [(0.0, 0.0), (4.8e-4, -0.00157)], 0.0))),
        "bottom": (nodes: "second.y_min", components: "xy"),
        "second-axis": (nodes: "second.x_min", components: "x"),
    },
    loads: {"gravity": Gravity((0.0, 140540.0, 0.0))},
    interfaces: {"contact": (slave: "first.y_min", master: Facets("second.y_max"), mu: 0.2)},
    time: (end: 1.2e-3, dt: 6.0e-5, contact: Velocity),
    mass: Lumped,
)"#;
    let run = try_run(&scene_text(text, &[]));
    let Err(NscdError::Stopped { failure, .. }) = run.end else {
        panic!("{:?}", run.end)
    };
    assert!(matches!(failure, StepFailure::Lost { .. }), "{failure}");
    assert!(
        failure.to_string().contains("position-level contact"),
        "{failure}"
    );
}
