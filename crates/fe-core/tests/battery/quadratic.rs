//! Meshes of quadratic cells, areas of their faces, their lumped mass.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use fe_core::{
    AnnulusMesh, BoxMesh, CellKind, DiscMesh, Element, Facet, FacetKind, HalfBallMesh,
    HalfDiscMesh, Mesh, MeshError, Pole, Quad9, QuarterDiscMesh, RectangleMesh, Surface, Symmetry,
    Tri6,
};
use nalgebra::Vector3;

use crate::common::{KINDS, PLANE_KINDS, blatz_ko, distorted_box, distorted_rectangle, solid};

const CENTER: [f64; 2] = [2.5, -1.5];
const RADIUS: f64 = 0.75;
const PLANE: [CellKind; 2] = [CellKind::Quad9, CellKind::Tri6];

fn rounds(cells: usize, kind: CellKind) -> [(Mesh, &'static [&'static str], f64); 4] {
    let (center, radius) = (CENTER, RADIUS);
    let disc = DiscMesh {
        center,
        radius,
        cells,
        kind,
    };
    let half = HalfDiscMesh {
        center,
        radius,
        cells,
        pole: Pole::Down,
        kind,
    };
    let quarter = QuarterDiscMesh {
        center,
        radius,
        cells,
        pole: Pole::Up,
        kind,
    };
    let ring = AnnulusMesh {
        center,
        inner: 0.5,
        outer: radius,
        cells: [4 * cells, 2],
        grading: 2.0,
        kind,
    };
    let full = PI * radius * radius;
    [
        (disc.generate("b").unwrap(), &["rim"], full),
        (half.generate("b").unwrap(), &["dome", "base"], full / 2.0),
        (
            quarter.generate("b").unwrap(),
            &["dome", "base", "axis"],
            full / 4.0,
        ),
        (
            ring.generate("b").unwrap(),
            &["inner", "outer"],
            full - PI * 0.25,
        ),
    ]
}

fn half_ball(cells: usize) -> Mesh {
    let shape = HalfBallMesh {
        center: Vector3::new(2.5, -1.5, 0.5),
        radius: RADIUS,
        cells,
        pole: Pole::Down,
        kind: CellKind::Hex27,
    };
    shape.generate("b").unwrap()
}

/// Valid, and closed by the facets of its sides, whose nodes are those of the node sets.
fn check(mesh: &Mesh, sides: &[&str]) {
    mesh.validate().unwrap();
    assert_eq!(mesh.node_sets["all"].len(), mesh.points.len());
    let mut covered = Vec::new();
    for side in sides {
        let facets = &mesh.facet_sets[*side];
        covered.extend(facets.iter().map(sorted));
        let surface = Surface::new(facets.clone()).unwrap();
        assert_eq!(surface.nodes, mesh.node_sets[*side], "{side}");
    }
    covered.sort_unstable();
    let mut boundary: Vec<_> = mesh.boundary_facets().iter().map(sorted).collect();
    boundary.sort_unstable();
    assert_eq!(boundary, covered);
}

fn sorted(facet: &Facet) -> Vec<u32> {
    let mut nodes = facet.nodes().to_vec();
    nodes.sort_unstable();
    nodes
}

fn volume(mesh: Mesh) -> f64 {
    solid(mesh, blatz_ko(), 1.0).consistent_mass().total()
}

/// Nodes of the rim lie on it, so volumes converge with the fourth power of the size.
#[test]
fn round_meshes_are_round() {
    for kind in PLANE {
        for cells in [1, 2, 3, 8] {
            for (mesh, sides, _) in rounds(cells, kind) {
                check(&mesh, sides);
                let rim = if sides[0] == "inner" {
                    "outer"
                } else {
                    sides[0]
                };
                for &n in mesh.node_set(rim).unwrap() {
                    let x = mesh.points[n as usize];
                    let r = (x[0] - CENTER[0]).hypot(x[1] - CENTER[1]);
                    assert!((r - RADIUS).abs() < 1e-14, "{kind:?} {cells} {x:?}");
                }
            }
        }
        for shape in 0..4 {
            let error = |n| {
                let (mesh, _, exact) = rounds(n, kind)[shape].clone();
                (volume(mesh) / exact - 1.0).abs()
            };
            let slope = (error(4) / error(8)).log2();
            assert!((slope - 4.0).abs() < 0.2, "{kind:?} {shape} {slope}");
        }
    }
    for cells in [1, 2, 4] {
        check(&half_ball(cells), &["dome", "base"]);
    }
    let exact = 2.0 / 3.0 * PI * RADIUS.powi(3);
    let error = |n| (volume(half_ball(n)) / exact - 1.0).abs();
    let slope = (error(2) / error(4)).log2();
    assert!((slope - 4.0).abs() < 0.3, "{slope}");
}

/// Equal cells have the nodes of a grid twice as fine, whatever they are.
#[test]
fn boxes_and_rectangles_have_the_nodes_of_the_finer_grid() {
    let places = |mesh: &Mesh| {
        let mut places: Vec<_> = mesh
            .points
            .iter()
            .map(|x| [0, 1, 2].map(|i| (1e6 * x[i]).round() as i64))
            .collect();
        places.sort_unstable();
        places
    };
    let fine = RectangleMesh::uniform([0.0; 2], [3.0, 2.0], [6, 4]);
    let fine = fine.generate("b").unwrap();
    for kind in PLANE {
        let mesh = RectangleMesh::uniform([0.0; 2], [3.0, 2.0], [3, 2]).with_kind(kind);
        let mesh = mesh.generate("b").unwrap();
        check(&mesh, &["x_min", "x_max", "y_min", "y_max"]);
        assert_eq!(places(&mesh), places(&fine));
        for (set, nodes) in &fine.node_sets {
            assert_eq!(mesh.node_sets[set].len(), nodes.len(), "{set}");
        }
    }
    let fine = BoxMesh::uniform([0.0; 3], [3.0, 2.0, 1.0], [6, 4, 2]);
    let fine = fine.generate("b").unwrap();
    for kind in [CellKind::Hex27, CellKind::Tet10] {
        let mesh = BoxMesh::uniform([0.0; 3], [3.0, 2.0, 1.0], [3, 2, 1]).with_kind(kind);
        let mesh = mesh.generate("b").unwrap();
        check(
            &mesh,
            &["x_min", "x_max", "y_min", "y_max", "z_min", "z_max"],
        );
        assert_eq!(places(&mesh), places(&fine));
        for (set, nodes) in &fine.node_sets {
            assert_eq!(mesh.node_sets[set].len(), nodes.len(), "{set}");
        }
    }
}

#[test]
fn a_half_ball_of_tetrahedra_is_refused() {
    let shape = HalfBallMesh {
        center: Vector3::zeros(),
        radius: 1.0,
        cells: 2,
        pole: Pole::Up,
        kind: CellKind::Tet10,
    };
    let refused = shape.generate("b");
    assert!(
        matches!(refused, Err(MeshError::Kind { .. })),
        "{refused:?}"
    );
}

/// Flat faces with known integrals, in units of a ninth, sixth or third of their area.
#[test]
fn integrals_of_shape_functions_on_flat_faces() {
    let mesh = |symmetry, points: &[[f64; 3]]| {
        let points = points.iter().map(|&x| x.into()).collect();
        Mesh::new(symmetry, points, Vec::new())
    };
    let close = |found: &[f64], expected: &[f64]| {
        for (found, expected) in found.iter().zip(expected) {
            assert!((found - expected).abs() < 1e-14, "{found} {expected}");
        }
    };
    let surface = |kind: FacetKind| {
        let nodes = 0..kind.node_count() as u32;
        Surface::new(vec![Facet::new(kind, nodes)]).unwrap()
    };
    let placed = |nodes: &[[f64; 3]], place: fn(&[f64; 3]) -> [f64; 3]| -> Vec<[f64; 3]> {
        nodes.iter().map(place).collect()
    };
    let square = placed(Quad9::reference_nodes(), |x| [1.5 * x[0], 3.0 * x[1], 7.0]);
    let quad = surface(FacetKind::Quad9);
    let square = mesh(Symmetry::None, &square);
    let expected = [0.5, 0.5, 0.5, 0.5, 2.0, 2.0, 2.0, 2.0, 8.0];
    close(&quad.shape_integrals(&square), &expected);
    assert_eq!(quad.shape_integrals(&square), quad.tributary_areas(&square));
    let corner = placed(Tri6::reference_nodes(), |x| [0.0, 2.0 * x[0], 3.0 * x[1]]);
    let (triangle, corner) = (surface(FacetKind::Tri6), mesh(Symmetry::None, &corner));
    close(
        &triangle.shape_integrals(&corner),
        &[0.0, 0.0, 0.0, 1.0, 1.0, 1.0],
    );
    assert_eq!(triangle.tributary_areas(&corner)[..3], [0.0; 3]);
    close(
        &triangle.tributary_areas(&corner),
        &[0.0, 0.0, 0.0, 1.0, 1.0, 1.0],
    );
    // A ring between the radii 0 and 1, and one between 1 and 3: int N_a 2 pi r dr.
    let ring = |a: f64, b: f64| {
        let points = [[a, 0.0, 0.0], [b, 0.0, 0.0], [0.5 * (a + b), 0.0, 0.0]];
        (
            mesh(Symmetry::Axisymmetric, &points),
            mesh(Symmetry::PlaneStrain, &points),
        )
    };
    let edge = surface(FacetKind::Edge3);
    let (disc, strip) = ring(0.0, 1.0);
    close(
        &edge.shape_integrals(&strip),
        &[1.0 / 6.0, 1.0 / 6.0, 4.0 / 6.0],
    );
    close(&edge.shape_integrals(&disc), &[0.0, PI / 3.0, TAU / 3.0]);
    assert_eq!(edge.tributary_areas(&disc)[0], 0.0);
    let (outer, _) = ring(1.0, 3.0);
    close(
        &edge.shape_integrals(&outer),
        &[TAU / 3.0, TAU, TAU * 8.0 / 3.0],
    );
}

/// Areas of curved faces are theirs, not those of the pieces they are cut into.
#[test]
fn areas_of_curved_faces() {
    let dome = half_ball(4);
    let surface = Surface::new(dome.facet_sets["dome"].clone()).unwrap();
    let areas = surface.tributary_areas(&dome);
    assert!(areas.iter().all(|area| *area > 0.0));
    let exact = TAU * RADIUS * RADIUS;
    let (found, shapes) = (
        areas.iter().sum::<f64>(),
        surface.shape_integrals(&dome).iter().sum::<f64>(),
    );
    assert!(
        (found / exact - 1.0).abs() < 2e-4,
        "{}",
        found / exact - 1.0
    );
    assert!((found - shapes).abs() < 1e-14);
    let shape = QuarterDiscMesh {
        center: [0.0, 0.0],
        radius: RADIUS,
        cells: 4,
        pole: Pole::Up,
        kind: CellKind::Quad9,
    };
    let mut ball = shape.generate("b").unwrap();
    ball.symmetry = Symmetry::Axisymmetric;
    let surface = Surface::new(ball.facet_sets["dome"].clone()).unwrap();
    let areas = surface.tributary_areas(&ball);
    let found: f64 = areas.iter().sum();
    assert!(
        (found / exact - 1.0).abs() < 1e-4,
        "{}",
        found / exact - 1.0
    );
    // Only the node on the axis has none.
    let none: Vec<u32> = surface
        .nodes
        .iter()
        .zip(&areas)
        .filter(|(_, area)| **area == 0.0)
        .map(|(node, _)| *node)
        .collect();
    assert_eq!(none.len(), 1);
    assert_eq!(ball.points[none[0] as usize][0], 0.0);
}

/// Where row sums are positive, on rectangles and boxes, quadratic cells are lumped to them.
#[test]
fn lumped_masses_are_positive_and_row_sums_on_boxes() {
    for kind in KINDS {
        let masses = solid(distorted_box([2; 3], kind, 0.2, true), blatz_ko(), 2.0);
        let (lumped, whole) = (masses.lumped_mass(), masses.consistent_mass().total());
        assert!(lumped.values().iter().all(|m| *m > 0.0), "{kind:?}");
        assert!((lumped.total() / whole - 1.0).abs() < 1e-13);
    }
    for kind in PLANE_KINDS {
        let mut mesh = distorted_rectangle([3, 2], kind, 0.2, true);
        mesh.symmetry = Symmetry::Axisymmetric;
        let lumped = solid(mesh, blatz_ko(), 2.0).lumped_mass();
        assert!(lumped.values().iter().all(|m| *m > 0.0), "{kind:?}");
    }
    for kind in [CellKind::Hex27, CellKind::Hex8] {
        let body = solid(distorted_box([2; 3], kind, 0.0, true), blatz_ko(), 2.0);
        let rows = body.consistent_mass().row_sums();
        for (lumped, row) in body.lumped_mass().values().iter().zip(rows) {
            assert!((lumped / row - 1.0).abs() < 1e-12);
        }
    }
}

/// Equal steps of the angle, also between the nodes of the corners.
#[test]
fn nodes_of_a_rim_have_equal_steps() {
    let (half, _, _) = rounds(4, CellKind::Quad9)[1].clone();
    let mut angles: Vec<f64> = half.node_sets["dome"]
        .iter()
        .map(|&n| half.points[n as usize])
        .map(|x| (CENTER[1] - x[1] + 0.0).atan2(x[0] - CENTER[0]))
        .collect();
    angles.sort_by(f64::total_cmp);
    assert_eq!(angles.len(), 17);
    for pair in angles.windows(2) {
        assert!((pair[1] - pair[0] - FRAC_PI_2 / 8.0).abs() < 1e-13);
    }
}
