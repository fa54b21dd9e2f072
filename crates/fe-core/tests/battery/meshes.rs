//! Generated meshes and the validation of any mesh.

use std::collections::BTreeSet;

use fe_core::{BoxMesh, CellKind, Facet, FacetKind, Mesh, MeshError, RectangleMesh, Symmetry};
use nalgebra::Vector3;
use proptest::prelude::*;

use crate::common::KINDS;

/// Area vector of a flat facet, as fans of triangles.
fn area(mesh: &Mesh, facet: &Facet) -> Vector3<f64> {
    let mut sum = Vector3::zeros();
    for piece in facet.pieces() {
        let x = |m: usize| mesh.points[piece.nodes()[m] as usize];
        for m in 1..piece.nodes().len() - 1 {
            sum += 0.5 * (x(m) - x(0)).cross(&(x(m + 1) - x(0)));
        }
    }
    sum
}

/// Corners of a facet from the lowest, in its sense of rotation.
fn canonical(facet: &Facet) -> Vec<u32> {
    let corners = match facet.kind {
        FacetKind::Quad4 | FacetKind::Quad9 => 4,
        _ => 3,
    };
    let mut nodes = facet.nodes()[..corners].to_vec();
    let lowest = (0..nodes.len()).min_by_key(|&m| nodes[m]).unwrap();
    nodes.rotate_left(lowest);
    nodes
}

fn any_box() -> impl Strategy<Value = BoxMesh> {
    let grading = prop::array::uniform3(0.2..5.0_f64);
    (prop::array::uniform3(1..4_usize), grading, 0..KINDS.len()).prop_map(
        |(cells, grading, kind)| BoxMesh {
            min: Vector3::new(-1.0, 0.5, 2.0),
            max: Vector3::new(1.0, 1.5, 5.0),
            cells,
            grading,
            kind: KINDS[kind],
        },
    )
}

proptest! {
    #[test]
    fn boxes_are_valid_and_closed_by_their_facet_sets(shape in any_box()) {
        let mesh = shape.generate("box").unwrap();
        mesh.validate().unwrap();
        prop_assert_eq!(mesh.node_sets["all"].len(), mesh.points.len());
        let areas = [3.0, 6.0, 2.0];
        let mut sets = BTreeSet::new();
        for (side, name) in ["x_min", "x_max", "y_min", "y_max", "z_min", "z_max"].iter().enumerate() {
            let (axis, sign) = (side / 2, if side % 2 == 0 { -1.0 } else { 1.0 });
            let plane = if side % 2 == 0 { shape.min[axis] } else { shape.max[axis] };
            let mut total = 0.0;
            for facet in &mesh.facet_sets[*name] {
                let a = area(&mesh, facet);
                prop_assert!(a[axis] * sign > 0.0);
                prop_assert!(facet.nodes().iter().all(|&n| mesh.points[n as usize][axis] == plane));
                total += a[axis] * sign;
                sets.insert(canonical(facet));
            }
            prop_assert!((total - areas[axis]).abs() < 1e-12);
            let on_plane = (0..mesh.points.len() as u32)
                .filter(|&n| mesh.points[n as usize][axis] == plane);
            prop_assert!(on_plane.eq(mesh.node_sets[*name].iter().copied()));
        }
        // Facets that belong to one cell only: the same, with the same sense. So the split conforms.
        let boundary: BTreeSet<Vec<u32>> = mesh.boundary_facets().iter().map(canonical).collect();
        prop_assert!(boundary == sets);
    }

    #[test]
    fn grading_is_the_ratio_of_last_to_first_cell(ratio in 0.1..10.0_f64, cells in 2..20_usize) {
        let shape = BoxMesh {
            grading: [ratio, 1.0, 1.0],
            ..BoxMesh::uniform([0.0; 3], [3.0, 1.0, 1.0], [cells, 1, 1])
        };
        let mesh = shape.generate("box").unwrap();
        let x: Vec<f64> = mesh.points[..=cells].iter().map(|x| x[0]).collect();
        let sizes: Vec<f64> = x.windows(2).map(|pair| pair[1] - pair[0]).collect();
        prop_assert!((sizes[cells - 1] / sizes[0] / ratio - 1.0).abs() < 1e-9);
        let growth = sizes[1] / sizes[0];
        prop_assert!(sizes.windows(2).all(|pair| (pair[1] / pair[0] / growth - 1.0).abs() < 1e-9));
        prop_assert!(x[0] == 0.0 && x[cells] == 3.0);
    }
}

#[test]
fn appended_meshes_keep_their_shape_and_get_prefixed_sets() {
    let a = BoxMesh::uniform([0.0; 3], [1.0; 3], [2; 3])
        .generate("a")
        .unwrap();
    let b = BoxMesh::uniform([5.0; 3], [6.0; 3], [1; 3])
        .with_kind(CellKind::Tet4)
        .generate("b")
        .unwrap();
    let mut both = Mesh::default();
    both.append("first", a.clone()).unwrap();
    both.append("second", b.clone()).unwrap();
    both.validate().unwrap();
    assert_eq!(both.dim, 3);
    assert_eq!(both.blocks[0], a.blocks[0]);
    assert_eq!(both.blocks[1].name, "b");
    let shifted: Vec<u32> = b.node_sets["x_max"].iter().map(|n| n + 27).collect();
    assert_eq!(both.node_set("second.x_max").unwrap(), shifted);
    let facet = both.facet_set("second.z_min").unwrap()[0];
    assert_eq!(facet.nodes[3], u32::MAX);
    assert!(
        facet
            .nodes()
            .iter()
            .all(|&n| both.points[n as usize][2] == 5.0)
    );
    let error = both.node_set("x_max").unwrap_err().to_string();
    assert!(
        error.contains("first.all") && error.contains("`x_max`"),
        "{error}"
    );
}

#[test]
fn defects_are_found_and_named() {
    let good = BoxMesh::uniform([0.0; 3], [1.0; 3], [2, 1, 1])
        .generate("bar")
        .unwrap();
    let defect = |change: &dyn Fn(&mut Mesh)| {
        let mut mesh = good.clone();
        change(&mut mesh);
        mesh.validate().unwrap_err()
    };
    assert!(matches!(
        defect(&|m| m.dim = 1),
        MeshError::Dimension { dim: 1, .. }
    ));
    assert!(matches!(
        defect(&|m| (m.dim, m.symmetry) = (2, Symmetry::PlaneStrain)),
        MeshError::CellDimension { .. }
    ));
    assert!(matches!(
        defect(&|m| m.symmetry = Symmetry::Axisymmetric),
        MeshError::Dimension { dim: 3, .. }
    ));
    assert!(matches!(
        defect(&|m| m.blocks.clear()),
        MeshError::Empty { .. }
    ));
    assert!(matches!(
        defect(&|m| m.points.clear()),
        MeshError::Empty { .. }
    ));
    assert!(matches!(
        defect(&|m| m.points[3][1] = f64::NAN),
        MeshError::PointNotFinite { node: 3, .. }
    ));
    assert!(matches!(
        defect(&|m| m.points.push(Vector3::repeat(9.0))),
        MeshError::OrphanNode { node: 12 }
    ));
    let truncated = defect(&|m| m.blocks[0].cells.truncate(11));
    assert!(matches!(
        truncated,
        MeshError::Connectivity { length: 11, .. }
    ));
    let outside = defect(&|m| m.blocks[0].cells[9] = 40);
    assert!(matches!(
        outside,
        MeshError::NodeOutOfRange {
            element: 1,
            node: 40,
            ..
        }
    ));
    let twice = defect(&|m| m.blocks[0].cells[9] = m.blocks[0].cells[8]);
    assert!(matches!(twice, MeshError::RepeatedNode { element: 1, .. }));
    let inverted = defect(&|m| m.blocks[0].cells[8..].swap(0, 1));
    assert!(
        matches!(inverted, MeshError::Jacobian { element: 1, .. }),
        "{inverted}"
    );
    let unsorted = defect(&|m| m.node_sets.get_mut("all").unwrap().swap(0, 1));
    assert!(matches!(unsorted, MeshError::NodeSet { .. }));
    let far = defect(&|m| m.node_sets.get_mut("all").unwrap().push(99));
    assert!(matches!(far, MeshError::NodeSet { node: 99, .. }));
    let facet = defect(&|m| m.facet_sets.get_mut("x_min").unwrap()[0].kind = FacetKind::Edge2);
    assert!(matches!(facet, MeshError::FacetSet { facet: 0, .. }));
    let facet = defect(&|m| m.facet_sets.get_mut("x_min").unwrap()[0].nodes[0] = 77);
    assert!(matches!(facet, MeshError::FacetSet { .. }));
}

#[test]
fn impossible_boxes_are_refused_with_the_bound() {
    let unit = BoxMesh::uniform([0.0; 3], [1.0; 3], [1; 3]);
    let refuse = |shape: BoxMesh, word: &str| {
        let message = shape.generate("box").unwrap_err().to_string();
        assert!(message.contains(word), "{message}");
    };
    refuse(
        BoxMesh {
            cells: [1, 0, 1],
            ..unit
        },
        "at least 1",
    );
    refuse(
        BoxMesh {
            max: Vector3::new(1.0, 0.0, 1.0),
            ..unit
        },
        "axis 1",
    );
    refuse(
        BoxMesh {
            min: Vector3::new(f64::NAN, 0.0, 0.0),
            ..unit
        },
        "finite",
    );
    refuse(
        BoxMesh {
            grading: [1.0, 1.0, 0.0],
            ..unit
        },
        "grading",
    );
    refuse(
        BoxMesh {
            grading: [1.0, 1.0, -2.0],
            ..unit
        },
        "positive",
    );
    refuse(
        BoxMesh {
            cells: [2000; 3],
            ..unit
        },
        "2^32",
    );
}

#[test]
fn defects_of_plane_meshes_are_found() {
    let good = RectangleMesh::uniform([0.0; 2], [1.0; 2], [2, 1])
        .generate("plate")
        .unwrap();
    let defect = |change: &dyn Fn(&mut Mesh)| {
        let mut mesh = good.clone();
        change(&mut mesh);
        mesh.validate().unwrap_err()
    };
    assert!(matches!(
        defect(&|m| m.dim = 3),
        MeshError::Dimension { dim: 3, .. }
    ));
    let clockwise = defect(&|m| m.blocks[0].cells[4..].reverse());
    assert!(matches!(clockwise, MeshError::Jacobian { element: 1, .. }));
    let facet = defect(&|m| m.facet_sets.get_mut("x_min").unwrap()[0] = Facet::triangle([0, 1, 2]));
    assert!(matches!(facet, MeshError::FacetSet { facet: 0, .. }));
    let mut moved = good.clone();
    moved.points.iter_mut().for_each(|x| x[0] -= 0.1);
    moved.validate().unwrap();
    moved.symmetry = Symmetry::Axisymmetric;
    assert!(matches!(
        moved.validate(),
        Err(MeshError::NegativeRadius { node: 0, .. })
    ));
    // The third coordinate means nothing in the plane.
    let mut lifted = good;
    lifted
        .points
        .iter_mut()
        .for_each(|x| x[2] = x[0] * 7.0 - x[1]);
    lifted.validate().unwrap();
}

#[test]
fn meshes_of_different_symmetry_do_not_mix() {
    let cube = BoxMesh::uniform([0.0; 3], [1.0; 3], [1; 3])
        .generate("a")
        .unwrap();
    let plate = RectangleMesh::uniform([2.0; 2], [3.0; 2], [1; 2])
        .generate("b")
        .unwrap();
    let mut ring = plate.clone();
    ring.symmetry = Symmetry::Axisymmetric;
    for (mut first, second) in [(cube, plate.clone()), (plate.clone(), ring.clone())] {
        let before = first.clone();
        let error = first.append("more", second).unwrap_err();
        assert!(matches!(error, MeshError::Symmetry { .. }), "{error}");
        assert_eq!(first, before);
    }
    let mut both = Mesh::default();
    both.append("one", ring.clone()).unwrap();
    both.append("two", ring).unwrap();
    assert_eq!((both.dim, both.symmetry), (2, Symmetry::Axisymmetric));
    assert_eq!(both.facet_set("two.x_min").unwrap()[0].nodes(), [6, 4]);
    both.validate().unwrap();
}
