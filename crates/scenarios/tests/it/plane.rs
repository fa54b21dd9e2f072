//! Plane scenes: schema, what is refused, and their pictures.

mod refusals;

use fe_core::CellKind;
use nalgebra::Vector3;
use scenarios::build;
use scenarios::output::{Array, Cells, Frame, History, Status, Values, deformed_svg};
use scenarios::spec::{LoadedScene, SceneError, Symmetry, parse};

use crate::fresh_folder;
use crate::vtu_reader::Vtu;

/// A disc that rolls between a rectangle and a rigid plane.
const PLANE: &str = r#"(
    title: "plane",
    materials: { "m": (law: NeoHookean(E: 1e6, nu: 0.3), density: 1000) },
    bodies: {
        "wheel": (mesh: Disc(center: (1, 1), radius: 1, cells: 4), material: "m", velocity: (1, 0, 0)),
        "plate": (mesh: Rectangle(min: (0, 2), max: (4, 3), cells: (8, 2)), material: "m"),
    },
    motions: {
        "top": (nodes: "plate.y_max", motion: Move(translation: (1, [(0, 0), (1, -0.1)], 0))),
    },
    loads: { "weight": Gravity((0, -9.81, 0)) },
    interfaces: {
        "ground": (slave: "wheel.rim", master: Plane(point: (0, 0, 0), normal: (0, 1, 0)), mu: 0.4),
        "roof": (slave: "wheel.rim", master: Facets("plate.y_min")),
    },
    time: (end: 1, dt: 0.1),
    output: (probes: { "hub": (body: "wheel", node: (1, 1, 0), quantities: [displacement]) }),
)
"#;

fn changed(from: &str, to: &str) -> Result<LoadedScene, SceneError> {
    assert!(PLANE.contains(from), "{from}");
    parse("plane.ron", &PLANE.replace(from, to), &[])
}

#[test]
fn a_plane_scene_has_two_unknowns_a_node() {
    let scene = parse("plane.ron", PLANE, &[]).unwrap().scene;
    assert!(scene.is_plane());
    assert_eq!(scene.symmetry, None);
    let plate = scene.bodies["plate"].mesh.size(1);
    assert_eq!((plate.nodes, plate.elements, plate.dofs), (27, 16, 54));
    assert_eq!(scene.bodies["plate"].mesh.size(3).elements, 9 * 16);
}

#[test]
fn every_mesh_is_built_with_its_counts_and_sets() {
    let meshes = [
        "Rectangle(min: (0, 0), max: (1, 1), cells: (N, 2), grading: (2, 1), element: Tri3)",
        "Rectangle(min: (0, 0), max: (1, 1), cells: (1, N))",
        "Disc(center: (1, 0), radius: 1, cells: N, element: Tri3)",
        "Disc(center: (1, 0), radius: 1, cells: N)",
        "HalfDisc(center: (1, 0), radius: 1, cells: N, pole: Down)",
        "QuarterDisc(center: (0, 0), radius: 1, cells: N, pole: Up)",
        "Annulus(center: (1, 0), inner: 0.5, outer: 1, cells: (8, N))",
        "HalfBall(center: (1, 0, 0), radius: 1, cells: N, pole: Up)",
        "Box(min: (0, 0, 0), max: (1, 1, 1), cells: (N, 1, 2), element: Tet4)",
        "Rectangle(min: (0, 0), max: (1, 1), cells: (N, 2), element: Tri6)",
        "Disc(center: (1, 0), radius: 1, cells: N, element: Quad9)",
        "HalfDisc(center: (1, 0), radius: 1, cells: N, pole: Down, element: Tri6)",
        "QuarterDisc(center: (0, 0), radius: 1, cells: N, pole: Up, element: Quad9)",
        "Annulus(center: (1, 0), inner: 0.5, outer: 1, cells: (8, N), element: Tri6)",
        "HalfBall(center: (1, 0, 0), radius: 1, cells: N, pole: Up, element: Hex27)",
        "Box(min: (0, 0, 0), max: (1, 1, 1), cells: (N, 1, 2), element: Tet10)",
        "Box(min: (0, 0, 0), max: (1, 1, 1), cells: (N, 1, 2), element: Hex27)",
        "Grid(x: (from: 0, pieces: [Cells(to: 1, cells: N), Growing(to: 9, growth: 1.3)]), \
            y: (from: 0, pieces: [Cells(to: -1, cells: 2, grading: 3)]), element: Tri3)",
        "SolidGrid(x: (from: 0, pieces: [Cells(to: 1, cells: 1)]), y: (from: 0, pieces: [Cells(to: 1, cells: 2)]), \
            z: (from: 0, pieces: [Cells(to: -1, cells: N), Growing(to: -4, growth: 2)]))",
        "Grid(x: (from: 0, pieces: [Cells(to: 1, cells: N), Growing(to: 9, growth: 1.3)]), \
            y: (from: 0, pieces: [Cells(to: -1, cells: 2, grading: 3)]), element: Quad9)",
        "SolidGrid(x: (from: 0, pieces: [Cells(to: 1, cells: 1)]), y: (from: 0, pieces: [Cells(to: 1, cells: 2)]), \
            z: (from: 0, pieces: [Cells(to: -1, cells: N), Growing(to: -4, growth: 2)]), element: Tet10)",
    ];
    for mesh in meshes {
        let solid = ["Box", "HalfBall", "SolidGrid"]
            .iter()
            .any(|name| mesh.starts_with(name));
        let symmetries = if solid {
            &["None"][..]
        } else {
            &["PlaneStrain", "Axisymmetric", "None"]
        };
        for (cells, refine) in [(1, 1), (2, 1), (3, 1), (4, 1), (3, 2), (7, 1)] {
            for symmetry in symmetries {
                let mesh = mesh.replace('N', &cells.to_string());
                let loaded = one_body(&mesh, &format!("symmetry: {symmetry}, refine: {refine},"));
                counts_and_sets(&loaded, &mesh);
            }
        }
    }
}

fn one_body(mesh: &str, more: &str) -> LoadedScene {
    let text = format!(
        r#"(title: "x", {more} materials: {{ "m": (law: BlatzKo(G: 1), density: 1) }},
        bodies: {{ "a": (mesh: {mesh}, material: "m") }}, time: (end: 1, dt: 1))"#
    );
    parse("x.ron", &text, &[]).unwrap_or_else(|e| panic!("{text}: {e}"))
}

fn counts_and_sets(loaded: &LoadedScene, shown: &str) {
    let scene = &loaded.scene;
    let mesh = &scene.bodies["a"].mesh;
    let built = build(loaded).unwrap_or_else(|e| panic!("{shown}: {e}"));
    let solid = &built.model.solid;
    assert_eq!(scene.size().nodes, solid.node_count(), "{shown}");
    assert_eq!(scene.size().elements, solid.element_count(), "{shown}");
    assert_eq!(scene.size().dofs, solid.dof_count(), "{shown}");
    let names = |sets: &[&str]| {
        let mut names: Vec<String> = sets.iter().map(|set| format!("a.{set}")).collect();
        names.sort();
        names
    };
    let built = solid.mesh();
    assert_eq!(
        names(&mesh.node_sets()),
        built.node_sets.keys().cloned().collect::<Vec<_>>()
    );
    assert_eq!(
        names(mesh.facet_sets()),
        built.facet_sets.keys().cloned().collect::<Vec<_>>()
    );
    let symmetry = match (mesh.is_plane(), scene.symmetry) {
        (false, _) => fe_core::Symmetry::None,
        (true, Some(Symmetry::Axisymmetric)) => fe_core::Symmetry::Axisymmetric,
        (true, _) => fe_core::Symmetry::PlaneStrain,
    };
    assert_eq!(built.symmetry, symmetry, "{shown}");
}

#[test]
fn a_plane_run_writes_history_fields_and_pictures() {
    // A free block that falls, then lies on a rigid plane: 1 m wide and high, 1 m thick.
    let text = r#"(
        title: "falling square",
        materials: { "m": (law: NeoHookean(E: 1e5, nu: 0.25), density: 1000) },
        bodies: { "block": (mesh: Rectangle(min: (0, 0.01), max: (1, 1.01), cells: (3, 3)), material: "m", velocity: (0.5, 0, 0)) },
        loads: { "weight": Gravity((0, -10, 0)) },
        interfaces: { "ground": (slave: "block.y_min", master: Plane(point: (0, 0, 0), normal: (0, 1, 0)), mu: 0.5) },
        time: (end: 1.5, dt: 0.01, theta: 1, xi: 1),
        output: (
            fields_every: Steps(50),
            plots: [Energy, Deformed, Force("ground"), Probe("corner")],
            probes: { "corner": (body: "block", node: (0, 0, 0), quantities: [displacement, velocity, contact_force, gap, normal_force, tangential_force, von_mises]) },
        ),
    )"#;
    let folder = fresh_folder("falling-square");
    let loaded = parse("falling.ron", text, &[]).unwrap();
    let summary = scenarios::run(&loaded, &folder, &mut |_| ()).unwrap();
    assert_eq!(summary.status, Status::Completed, "{:?}", summary.reason);
    assert_eq!((summary.dofs, summary.elements), (32, 9));
    // Of 1 m of thickness, in the summary, in the table and on the axes; there is no force along z.
    assert_eq!(
        (&*summary.units.force, &*summary.units.energy),
        ("N/m", "J/m")
    );
    assert!(scenarios::report::closing_table(&summary).contains("Energy [J/m]"));
    let picture = |name: &str| std::fs::read_to_string(folder.join(name)).unwrap();
    assert!(picture("energy.svg").contains("J/m]"));
    let force = picture("force_ground.svg");
    assert!(force.contains("N/m]"));
    let legend = |axis: &str| force.lines().any(|line| line.trim() == axis);
    assert!(legend("x") && legend("y") && !legend("z"));
    // Half of m v^2 with m = 1000 kg.
    assert!((summary.energy.initial - 125.0).abs() < 1e-9);
    assert!(
        summary.energy.unexplained().abs() < 1e-6,
        "{}",
        summary.energy.unexplained()
    );
    let history = History::read(&folder.join("history.csv")).unwrap();
    let column = |name: &str| history.column(name).unwrap_or_else(|| panic!("{name}"));
    for name in [
        "probe.corner.displacement.z",
        "probe.corner.contact_force.z",
        "force.ground.z",
        "moment.ground.x",
    ] {
        assert!(column(name).iter().all(|value| *value == 0.0), "{name}");
    }
    // It moves on freely at first, and rests on the plane by its weight in the end.
    assert!((column("probe.corner.velocity.x")[1] - 0.5).abs() < 1e-12);
    let last = column("t").len() - 1;
    // Two periods, 4 sqrt(density / M) each with the modulus M of plane strain.
    let force = column("force.ground.y");
    let weight = force[last - 72..].iter().sum::<f64>() / 73.0;
    assert!((weight - 1e4).abs() < 500.0, "{weight}");
    assert!(
        column("force.ground.x")[..last].iter().any(|x| *x < -100.0),
        "it rubs"
    );
    for i in 0..=last {
        let [normal, friction] =
            ["normal_force", "tangential_force"].map(|q| column(&format!("probe.corner.{q}"))[i]);
        assert!(
            (normal - column("probe.corner.contact_force.y")[i]).abs() <= 1e-9 * (1.0 + normal)
        );
        assert!(friction <= 0.5 * normal * (1.0 + 1e-6) + 1e-9);
    }
    let vtu = Vtu::read(&std::fs::read(folder.join("fields/step_000150.vtu")).unwrap());
    assert_eq!(vtu.integers("types"), [9; 9]);
    assert_eq!(vtu.floats("displacement").len(), 3 * 16);
    assert!(vtu.floats("displacement").chunks(3).all(|u| u[2] == 0.0));
    assert_eq!(
        vtu.floats("displacement")[1].to_bits(),
        column("probe.corner.displacement.y")[last].to_bits()
    );
    assert!(
        vtu.floats("cauchy_stress").chunks(6).all(|s| s[2] != 0.0),
        "plane strain has a stress along z"
    );
    for name in [
        "energy.svg",
        "deformed.svg",
        "force_ground.svg",
        "probe_corner_gap.svg",
    ] {
        assert!(folder.join(name).is_file(), "{name}");
    }
}

/// Corners of the outlines of a path: the first of each, then the ways from corner to corner.
fn outlines(path: &str) -> Vec<Vec<[f64; 2]>> {
    let data = path.split(" d=\"").nth(1).unwrap();
    let closed = data.split('M').skip(1).map(|outline| {
        let numbers = outline.split('z').next().unwrap();
        let numbers = numbers.replace('l', " ").replace('-', " -");
        let numbers: Vec<f64> = numbers
            .split_whitespace()
            .map(|number| number.parse().unwrap())
            .collect();
        let mut corner = [0.0; 2];
        let corners = numbers.chunks(2).map(|way| {
            corner = [corner[0] + way[0], corner[1] + way[1]];
            corner
        });
        corners.collect()
    });
    closed.collect()
}

#[test]
fn a_plane_picture_is_flat_and_to_scale() {
    // A square of two triangles beside a square of 2 m: in the picture the second is twice as wide and high.
    let points = [
        [0.0, 0.0, 0.0],
        [1.0, 0.0, 0.0],
        [1.0, 1.0, 0.0],
        [0.0, 1.0, 0.0],
        [2.0, 0.0, 0.0],
        [4.0, 0.0, 0.0],
        [4.0, 2.0, 0.0],
        [2.0, 2.0, 0.0],
    ]
    .map(Vector3::from);
    let frame = Frame {
        time: 0.0,
        points: &points,
        cells: vec![
            Cells {
                kind: CellKind::Tri3,
                connectivity: &[0, 1, 2, 0, 2, 3],
            },
            Cells {
                kind: CellKind::Quad4,
                connectivity: &[4, 5, 6, 7],
            },
        ],
        point_data: vec![],
        cell_data: vec![Array {
            name: "von_mises",
            values: Values::Scalar(&[0.0, 1.0, 2.0]),
        }],
    };
    let svg = deformed_svg("plane", &frame).unwrap();
    let rims = svg
        .lines()
        .filter(|line| line.contains("stroke-opacity=\".45\""));
    let outlines: Vec<Vec<[f64; 2]>> = rims.flat_map(outlines).collect();
    assert_eq!(outlines.len(), 3, "one outline a cell");
    let extent = |outline: &[[f64; 2]], k: usize| {
        let along = outline.iter().map(|p| p[k]);
        along.clone().fold(f64::MIN, f64::max) - along.fold(f64::MAX, f64::min)
    };
    let large = outlines
        .iter()
        .max_by(|a, b| extent(a, 0).total_cmp(&extent(b, 0)))
        .unwrap();
    let (width, height) = (extent(large, 0), extent(large, 1));
    assert!(
        width > 500.0 && (width - height).abs() <= 1.0,
        "{width} x {height}"
    );
    for small in outlines.iter().filter(|o| o.len() == 3) {
        for k in [0, 1] {
            assert!((2.0 * extent(small, k) - width).abs() <= 2.0);
        }
    }
    // Only x and y are shown.
    assert!(svg.contains("von Mises [Pa]") && !svg.contains("\nz\n"));
}
