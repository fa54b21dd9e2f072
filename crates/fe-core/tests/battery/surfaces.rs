//! Areas, normals and neighbours of surfaces.

use fe_core::current_positions;
use fe_core::{BoxMesh, CellKind, Facet, Mesh, Motion, Rotation, Surface, Symmetry, Table};
use nalgebra::Vector3;
use proptest::prelude::*;

use crate::common::KINDS;

fn unit_box(kind: CellKind, cells: [usize; 3]) -> Mesh {
    BoxMesh {
        grading: [3.0, 0.5, 1.0],
        ..BoxMesh::uniform([0.0; 3], [2.0, 1.0, 3.0], cells)
    }
    .with_kind(kind)
    .generate("box")
    .unwrap()
}

fn flat(mesh: &Mesh) -> Vec<f64> {
    mesh.points.iter().flatten().copied().collect()
}

#[test]
fn areas_integrate_linear_fields() {
    for kind in KINDS {
        let mesh = unit_box(kind, [4, 3, 2]);
        let top = Surface::new(mesh.facet_sets["z_max"].clone()).unwrap();
        assert_eq!(top.nodes, mesh.node_sets["z_max"]);
        let areas = top.tributary_areas(&mesh);
        let moment = |i: usize| -> f64 {
            let x = top.nodes.iter().map(|&n| mesh.points[n as usize][i]);
            x.zip(&areas).map(|(x, a)| x * a).sum()
        };
        assert!((areas.iter().sum::<f64>() - 2.0).abs() < 1e-14);
        // Centroid of the face: partition into nodal areas keeps it.
        assert!((moment(0) - 2.0).abs() < 1e-14);
        assert!((moment(1) - 1.0).abs() < 1e-14);
        // Corners of quadratic triangles have none.
        let least = areas.iter().copied().fold(f64::INFINITY, f64::min);
        assert!(least > 0.0 || least == 0.0 && kind == CellKind::Tet10);
    }
}

#[test]
fn flat_faces_have_their_normal_and_corners_the_diagonal() {
    for kind in KINDS {
        let mesh = unit_box(kind, [3, 2, 2]);
        let whole = Surface::new(mesh.boundary_facets()).unwrap();
        let normals = whole.vertex_normals(&flat(&mesh));
        let top = Surface::new(mesh.facet_sets["y_max"].clone()).unwrap();
        for n in top.vertex_normals(&flat(&mesh)) {
            assert!(n[0].abs() + (n[1] - 1.0).abs() + n[2].abs() < 1e-14);
        }
        for (&node, n) in whole.nodes.iter().zip(&normals) {
            // Sides that meet at the node, each with weight one whatever its triangles are.
            let x = mesh.points[node as usize];
            let side =
                |x: f64, high: f64| f64::from(u8::from(x == high)) - f64::from(u8::from(x == 0.0));
            let sum = [side(x[0], 2.0), side(x[1], 1.0), side(x[2], 3.0)];
            let length = sum.iter().map(|s| s * s).sum::<f64>().sqrt();
            for i in 0..3 {
                assert!((n[i] - sum[i] / length).abs() < 1e-14, "{x:?} {n:?}");
            }
        }
    }
}

proptest! {
    #[test]
    fn normals_turn_with_the_body(angle in -3.0..3.0_f64, axis in prop::array::uniform3(0.1..1.0_f64)) {
        let mesh = unit_box(CellKind::Tet4, [2, 2, 2]);
        let surface = Surface::new(mesh.boundary_facets()).unwrap();
        let turn = Rotation::new([1.0, 2.0, 3.0], axis, Table::constant(angle)).unwrap();
        let turn = Motion::still().with_rotation(turn);
        let u: Vec<f64> = mesh.points.iter().flat_map(|&x| <[f64; 3]>::from(turn.displacement(x, 0.0))).collect();
        let mut moved = Vec::new();
        current_positions(&mesh.points, 3, &u, &mut moved);
        let (before, after) = (surface.vertex_normals(&flat(&mesh)), surface.vertex_normals(&moved));
        for (before, after) in before.into_iter().zip(after) {
            let turned = turn.rotate(before, 0.0);
            prop_assert!((0..3).all(|i| (turned[i] - after[i]).abs() < 1e-13));
        }
    }
}

#[test]
fn facets_around_nodes_are_those_that_have_them() {
    let mesh = unit_box(CellKind::Tet4, [2, 3, 2]);
    let surface = Surface::new(mesh.boundary_facets()).unwrap();
    assert!(surface.nodes.windows(2).all(|pair| pair[0] < pair[1]));
    for (index, &node) in surface.nodes.iter().enumerate() {
        assert_eq!(surface.index_of(node), Some(index));
        let expected: Vec<u32> = (0..surface.facets.len() as u32)
            .filter(|&f| surface.facets[f as usize].nodes().contains(&node))
            .collect();
        assert_eq!(surface.facets_around(index), expected);
    }
    for (f, facet) in surface.facets.iter().enumerate() {
        let nodes: Vec<u32> = surface
            .corners(f)
            .iter()
            .map(|&c| surface.nodes[c as usize])
            .collect();
        assert_eq!(nodes, facet.nodes());
    }
    assert_eq!(surface.index_of(u32::MAX), None);
}

#[test]
fn plane_surfaces_are_edges() {
    // Lower side of a body above it: from left to right, the body to the left of the way.
    let points = [0.0, 1.0, 3.0].map(|x| Vector3::new(x, 0.0, 0.0));
    let mut mesh = Mesh::new(Symmetry::PlaneStrain, points.to_vec(), Vec::new());
    let surface = Surface::new(vec![Facet::edge([0, 1]), Facet::edge([1, 2])]).unwrap();
    assert_eq!(surface.dim(), 2);
    assert_eq!(surface.tributary_areas(&mesh), [0.5, 1.5, 1.0]);
    // Rings: the integral of shape function times circumference.
    mesh.symmetry = Symmetry::Axisymmetric;
    let rings = [1.0, 1.0 * 2.0 + 5.0 * 2.0, 7.0 * 2.0].map(|x| x * std::f64::consts::PI / 3.0);
    let areas = surface.tributary_areas(&mesh);
    for (found, expected) in areas.iter().zip(rings) {
        assert!((found - expected).abs() < 1e-14, "{areas:?}");
    }
    assert!((areas.iter().sum::<f64>() - 9.0 * std::f64::consts::PI).abs() < 1e-13);
    let normals = surface.vertex_normals(&[0.0, 0.0, 1.0, 0.0, 3.0, 0.0]);
    assert!(normals.iter().all(|n| *n == -Vector3::y()));
}

#[test]
fn impossible_surfaces_are_refused() {
    assert!(Surface::new(Vec::new()).is_err());
    assert!(Surface::new(vec![Facet::edge([0, 1]), Facet::triangle([0, 1, 2])]).is_err());
}
