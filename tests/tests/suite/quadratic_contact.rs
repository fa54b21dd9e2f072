//! Contact of quadratic faces: uniform pressure, matching meshes, bonds on triangles.

use fe_core::{ElementState, Surface};

use crate::common::{Run, run, scene_text};

/// Pressed by 5 % of its height on a rigid plane, free to widen.
fn on_plane(mesh: &str, symmetry: &str) -> Run {
    let space = symmetry == "None";
    let (up, axis) = if space { ("z", 2) } else { ("y", 1) };
    let sides = if space {
        r#""y": (nodes: "block.y_min", components: "y"),"#
    } else {
        ""
    };
    let [normal, down] = ["1.0", "[(0.0, 0.0), (2.0, -0.05)]"].map(|value| {
        let mut components = ["0.0"; 3];
        components[axis] = value;
        format!("({})", components.join(", "))
    });
    let text = format!(
        r#"(
    title: "pressed on a plane",
    symmetry: {symmetry},
    materials: {{"m": (law: NeoHookean(E: 100.0, nu: 0.3), density: 1.0)}},
    bodies: {{"block": (mesh: {mesh}, material: "m")}},
    motions: {{
        "x": (nodes: "block.x_min", components: "x"), {sides}
        "top": (nodes: "block.{up}_max", components: "{up}", motion: Move(translation: {down})),
    }},
    interfaces: {{"ground": (slave: "block.{up}_min", master: Plane(point: (0.0, 0.0, 0.0), normal: {normal}))}},
    time: (end: 2.0, dt: 1.0, inertia: QuasiStatic),
    output: (fields_every: Never),
)"#
    );
    run(&scene_text(&text, &[]))
}

/// Cauchy stress of all elements \[Pa\].
fn stresses(run: &Run) -> Vec<[f64; 6]> {
    let u = &run.last().state.u;
    let blocks = run.built.model.solid.blocks().iter();
    let states = blocks.flat_map(|block| {
        let mut states = vec![ElementState::default(); block.element_count()];
        block.stress_state(u, &mut states).unwrap();
        states
    });
    states.map(|state| state.cauchy.into()).collect()
}

/// All elements have the stress of the first, to round-off.
fn assert_uniform(run: &Run, shown: &str) {
    let all = stresses(run);
    let scale = all[0].iter().fold(0.0_f64, |m, s| m.max(s.abs()));
    assert!(scale > 0.0, "{shown}");
    for stress in &all {
        for (s, first) in stress.iter().zip(&all[0]) {
            assert!((s - first).abs() < 1e-8 * scale, "{shown}: {stress:?}");
        }
    }
}

/// Contact force along the axis `up` at each slave node of the first interface \[N\], and its share of the sum if the
/// pressure is uniform \[-\].
fn forces_and_shares(run: &Run, set: &str, up: usize) -> (Vec<f64>, Vec<f64>) {
    let mesh = run.built.model.solid.mesh();
    let surface = Surface::new(mesh.facet_set(set).unwrap().to_vec()).unwrap();
    let slave = &run.built.model.interfaces[0].slave;
    assert_eq!(slave, &surface.nodes);
    let force = |&n: &u32| run.last().state.contact_force[mesh.dim * n as usize + up];
    let shares = surface.shape_integrals(mesh);
    let area: f64 = shares.iter().sum();
    let shares = shares.iter().map(|share| share / area).collect();
    (slave.iter().map(force).collect(), shares)
}

fn assert_uniform_pressure(run: &Run, set: &str, up: usize, shown: &str) {
    assert_uniform(run, shown);
    let (forces, shares) = forces_and_shares(run, set, up);
    let total: f64 = forces.iter().sum();
    assert!(total > 1.0, "{shown}: {total} N");
    for (force, share) in forces.iter().zip(&shares) {
        let expected = total * share;
        assert!(
            (force - expected).abs() < 1e-8 * total,
            "{shown}: {force} N of {expected} N"
        );
    }
}

/// Nodal forces are those of a uniform pressure: 1/6, 4/6, 1/6 of an edge, nothing at corners of quadratic triangles.
#[test]
fn blocks_on_a_plane_feel_a_uniform_pressure() {
    for element in ["Quad4", "Tri3", "Quad9", "Tri6"] {
        for symmetry in ["PlaneStrain", "Axisymmetric"] {
            let mesh = format!(
                "Rectangle(min: (0.0, 0.0), max: (2.0, 1.0), cells: (4, 2), grading: (2.0, 1.0), element: {element})"
            );
            let run = on_plane(&mesh, symmetry);
            assert_uniform_pressure(&run, "block.y_min", 1, &format!("{element} {symmetry}"));
        }
    }
    for element in ["Hex27", "Tet10"] {
        let mesh = format!(
            "Box(min: (0.0, 0.0, 0.0), max: (2.0, 1.0, 1.0), cells: (3, 2, 2), grading: (2.0, 1.0, 1.0), element: {element})"
        );
        let run = on_plane(&mesh, "None");
        assert_uniform_pressure(&run, "block.z_min", 2, element);
    }
    // The three nodes of the first edge, and the middle of the next.
    let one = "Rectangle(min: (0.0, 0.0), max: (2.0, 1.0), cells: (2, 1), element: Quad9)";
    let run = on_plane(one, "PlaneStrain");
    let (forces, _) = forces_and_shares(&run, "block.y_min", 1);
    let total: f64 = forces.iter().sum();
    let mut parts: Vec<f64> = forces.iter().map(|f| 12.0 * f / total).collect();
    parts.sort_by(f64::total_cmp);
    for (part, expected) in parts.iter().zip([1.0, 1.0, 2.0, 4.0, 4.0]) {
        assert!((part - expected).abs() < 1e-7, "{parts:?}");
    }
}

/// Two blocks whose meshes fit: slave nodes sit on master nodes, between which the master is cut into linear pieces.
#[test]
fn stacked_quadratic_blocks_pass_the_patch_test() {
    let meshes = [
        (
            1,
            r#""low": (mesh: Rectangle(min: (0.0, 0.0), max: (1.0, 1.0), cells: (3, 2), grading: (2.0, 1.5), element: Quad9), material: "m"),
               "high": (mesh: Rectangle(min: (0.0, 1.0), max: (1.0, 2.0), cells: (3, 3), grading: (2.0, 1.0), element: Quad9), material: "m"),"#,
        ),
        (
            2,
            r#""low": (mesh: Box(min: (0.0, 0.0, 0.0), max: (1.0, 1.0, 1.0), cells: (2, 2, 1), grading: (2.0, 1.0, 1.0), element: Hex27), material: "m"),
               "high": (mesh: Box(min: (0.0, 0.0, 1.0), max: (1.0, 1.0, 2.0), cells: (2, 2, 2), grading: (2.0, 1.0, 1.0), element: Hex27), material: "m"),"#,
        ),
    ];
    for (up, bodies) in meshes {
        for mu in [0.0, 0.5] {
            let side = |c: &str| {
                format!(
                    r#""low-{c}": (nodes: "low.{c}_min", components: "{c}"), "high-{c}": (nodes: "high.{c}_min", components: "{c}"),"#
                )
            };
            let sides: String = ["x", "y"][..up].iter().map(|c| side(c)).collect();
            let axis = ["x", "y", "z"][up];
            let mut down = ["0.0"; 3];
            down[up] = "[(0.0, 0.0), (2.0, -0.1)]";
            let down = down.join(", ");
            let text = format!(
                r#"(
    title: "stacked",
    materials: {{"m": (law: NeoHookean(E: 100.0, nu: 0.3), density: 1.0)}},
    bodies: {{{bodies}}},
    motions: {{
        {sides}
        "bottom": (nodes: "low.{axis}_min", components: "{axis}"),
        "top": (nodes: "high.{axis}_max", components: "{axis}", motion: Move(translation: ({down}))),
    }},
    interfaces: {{"joint": (slave: "high.{axis}_min", master: Facets("low.{axis}_max"), mu: {mu})}},
    time: (end: 2.0, dt: 1.0, inertia: QuasiStatic),
    output: (fields_every: Never),
)"#
            );
            let run = run(&scene_text(&text, &[]));
            assert_uniform_pressure(&run, &format!("high.{axis}_min"), up, &format!("{up} {mu}"));
        }
    }
}

/// Nodes on nodes, but elements of different kinds, whose sides bulge differently: the corners overhang by round-off of
/// strains.
#[test]
fn tetrahedra_on_hexahedra_with_the_same_nodes_converge() {
    let text = r#"(
    title: "mixed",
    materials: {"m": (law: SaintVenantKirchhoff(E: 1.0e5, nu: 0.3), density: 1000.0)},
    bodies: {
        "low": (mesh: Box(min: (0.0, 0.0, 0.0), max: (1.0, 1.0, 1.0), cells: (2, 2, 2), element: Hex27), material: "m"),
        "high": (mesh: Box(min: (0.0, 0.0, 1.0), max: (1.0, 1.0, 2.0), cells: (2, 2, 2), element: Tet10), material: "m"),
    },
    motions: {
        "lx": (nodes: "low.x_min", components: "x"), "hx": (nodes: "high.x_min", components: "x"),
        "ly": (nodes: "low.y_min", components: "y"), "hy": (nodes: "high.y_min", components: "y"),
        "base": (nodes: "low.z_min", components: "z"),
        "top": (nodes: "high.z_max", components: "z", motion: Move(translation: (0.0, 0.0, [(0.0, 0.0), (1.0, -2.0e-5)]))),
    },
    interfaces: {"joint": (slave: "high.z_min", master: Facets("low.z_max"))},
    time: (end: 1.0, dt: 1.0, inertia: QuasiStatic),
    output: (fields_every: Never),
)"#;
    let run = run(&scene_text(text, &[]));
    assert_eq!(run.counters.rejected_steps, 0);
    assert!(run.last().report.contact_error < 1e-11);
    // The uniaxial stress E e of both halves over an area of one.
    let force = run.contact_force(2).last().copied().unwrap().abs();
    assert!((force - 1.0).abs() < 1e-2, "{force}");
}

/// Corners of quadratic triangles have no area, so no bond; what the middles of the edges carry is a uniform traction.
#[test]
fn bonds_of_quadratic_triangles_sit_in_the_middle_of_their_edges() {
    let text = r#"(
    title: "pulled off a plane",
    materials: {"m": (law: SaintVenantKirchhoff(E: 1.0e6, nu: 0.0), density: 1.0)},
    bodies: {"block": (mesh: Box(min: (0.0, 0.0, 0.0), max: (1.0, 1.0, 1.0), cells: (2, 2, 1), element: Tet10), material: "m")},
    motions: {
        "top": (nodes: "block.z_max", components: "xyz", motion: Move(translation: (0.0, 0.0, [(0.0, 0.0), (1.0, 0.001)]))),
    },
    interfaces: {"joint": (slave: "block.z_min", master: Plane(point: (0.0, 0.0, 0.0), normal: (0.0, 0.0, 1.0)),
        adhesion: Some((C_n: 1e5, C_t: 1e5, w: 10.0, b: 5.0, beta: 1.0)))},
    time: (end: 1.0, dt: 0.5, inertia: QuasiStatic),
    output: (fields_every: Never),
)"#;
    let run = run(&scene_text(text, &[]));
    let interface = &run.built.model.interfaces[0];
    let mesh = run.built.model.solid.mesh();
    for bonds in [&run.start.bonds[0], &run.last().state.bonds[0]] {
        for ((bond, &node), area) in bonds.iter().zip(&interface.slave).zip(&interface.area) {
            // Corners are the nodes of the grid of half a metre.
            let corner = mesh.points[node as usize]
                .iter()
                .take(2)
                .all(|x| (2.0 * x).fract() == 0.0);
            assert_eq!(*area == 0.0, corner);
            assert_eq!(bond.intensity > 0.9, !corner, "{bond:?}");
        }
    }
    assert_uniform(&run, "Tet10");
    // A spring of 1e5 N/m and the block of 1e6 N/m in series.
    let pull = -run.last().report.interfaces[0].force[2];
    assert!(
        (pull / (1e-3 / (1e-5 + 1e-6)) - 1.0).abs() < 2e-3,
        "{pull} N"
    );
}
