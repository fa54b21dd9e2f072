//! Projected dilatation: the battery, what it must not change, and what it must mend.

use fe_core::conformance;
use fe_core::{Block, ElementState, tangent_index, tangent_len};
use fe_core::{
    CellKind, Dilatation, FeError, RectangleMesh, Solid, Symmetry, ValidMesh, solid_block_with,
};
use hyperelastic::{ElasticConstants, Material, SaintVenantKirchhoff, ThreeE};
use nalgebra::{Matrix3, Vector3};
use proptest::prelude::*;

use crate::common::{self, blatz_ko, distorted_box, distorted_rectangle, neo_hookean};

/// Element and symmetry of each kind of block, with the number of its rigid motions.
const BLOCKS: [(CellKind, Symmetry, usize); 8] = [
    (CellKind::Quad4, Symmetry::PlaneStrain, 3),
    (CellKind::Quad4, Symmetry::Axisymmetric, 1),
    (CellKind::Quad9, Symmetry::PlaneStrain, 3),
    (CellKind::Quad9, Symmetry::Axisymmetric, 1),
    (CellKind::Tri6, Symmetry::PlaneStrain, 3),
    (CellKind::Hex8, Symmetry::None, 6),
    (CellKind::Hex27, Symmetry::None, 6),
    (CellKind::Tet10, Symmetry::None, 6),
];

/// Curved cells if they can be.
fn distorted(kind: CellKind, symmetry: Symmetry, cells: usize, boundary: bool) -> ValidMesh {
    let mut mesh = if kind.dim() == 3 {
        distorted_box([cells, 1, 1], kind, 0.15, boundary)
    } else {
        distorted_rectangle([cells, cells], kind, 0.2, boundary)
    };
    mesh.symmetry = symmetry;
    common::curved(mesh, 0.02).validated().unwrap()
}

fn projected<M: Material>(mesh: &ValidMesh, material: M) -> Box<dyn Block> {
    solid_block_with(mesh, 0, material, 1.0, Dilatation::Projected).unwrap()
}

fn laws(mesh: &ValidMesh, dilatation: Dilatation) -> [Box<dyn Block>; 4] {
    let elastic = ElasticConstants::from_shear_poisson(1.0, 0.45).unwrap();
    let metal = SaintVenantKirchhoff::new(elastic).unwrap();
    let foam = ThreeE::new(elastic, [0.5, 0.4, 0.3, 0.6, 0.2]).unwrap();
    [
        solid_block_with(mesh, 0, blatz_ko(), 1.0, dilatation).unwrap(),
        solid_block_with(mesh, 0, neo_hookean(), 1.0, dilatation).unwrap(),
        solid_block_with(mesh, 0, metal, 1.0, dilatation).unwrap(),
        solid_block_with(mesh, 0, foam, 1.0, dilatation).unwrap(),
    ]
}

fn states(block: &dyn Block, u: &[f64]) -> Vec<ElementState> {
    let mut states = vec![ElementState::default(); block.element_count()];
    block.stress_state(u, &mut states).unwrap();
    states
}

/// Forces, energies and tangents at `u`.
fn evaluate(block: &dyn Block, u: &[f64]) -> [Vec<f64>; 3] {
    let (count, nodes, dim) = (
        block.element_count(),
        block.nodes_per_element(),
        block.dim(),
    );
    let mut f = vec![0.0; count * nodes * dim];
    let mut w = vec![0.0; count];
    let mut k = vec![0.0; count * tangent_len(dim, nodes)];
    block.tangent(u, &mut f, &mut w, &mut k).unwrap();
    [f, w, k]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(8))]

    /// Force against the energy, tangent against the whole force, symmetry, rigid motion.
    #[test]
    fn blocks_pass_the_battery_at_random_deformations(u in prop::collection::vec(-1.0..1.0_f64, 150)) {
        for (kind, symmetry, _) in BLOCKS {
            let mesh = distorted(kind, symmetry, if kind.degree() == 1 { 2 } else { 1 }, true);
            let size = if kind.degree() == 1 { 0.12 } else { 0.03 };
            let u = u.iter().map(|u| size * u).cycle();
            let u: Vec<f64> = u.take(mesh.dim * mesh.points.len()).collect();
            for block in laws(&mesh, Dilatation::Projected) {
                conformance::check_block(block.as_ref(), &mesh.points, &u).unwrap();
            }
        }
    }
}

#[test]
fn patch_test_on_distorted_meshes() {
    let shear = Matrix3::new(0.2, 0.3, 0.0, 0.1, -0.2, 0.0, 0.0, 0.0, 0.0);
    let diagonal = Matrix3::from_diagonal(&Vector3::new(0.2, -0.15, 0.0));
    for (kind, symmetry, _) in BLOCKS {
        let mesh = if kind.dim() == 3 {
            distorted_box([2, 2, 2], kind, 0.2, false)
                .validated()
                .unwrap()
        } else {
            distorted(kind, symmetry, 4, false)
        };
        let gradient = if symmetry == Symmetry::Axisymmetric {
            diagonal
        } else {
            shear
        };
        let block = projected(&mesh, neo_hookean());
        let solid = Solid::new(mesh, vec![block]).unwrap();
        conformance::check_patch(&solid, &gradient).unwrap();
    }
}

/// Where the dilatation of an element is uniform, projecting it changes neither energy, force nor stress.
#[test]
fn homogeneous_states_are_those_of_the_pointwise_dilatation() {
    for (kind, symmetry, _) in BLOCKS {
        let mesh = distorted(kind, symmetry, 2, true);
        let map = |x: &Vector3<f64>| [0.3 * x[0], -0.2 * x[1], 0.1 * x[2]];
        let u = mesh
            .points
            .iter()
            .flat_map(|x| map(x).into_iter().take(mesh.dim));
        let u: Vec<f64> = u.collect();
        let pairs = laws(&mesh, Dilatation::Projected)
            .into_iter()
            .zip(laws(&mesh, Dilatation::Pointwise));
        for (projected, pointwise) in pairs {
            let [f, w, _] = evaluate(projected.as_ref(), &u);
            let [g, v, _] = evaluate(pointwise.as_ref(), &u);
            assert!(f.iter().zip(&g).all(|(f, g)| (f - g).abs() < 1e-13));
            assert!(w.iter().zip(&v).all(|(w, v)| (w - v).abs() < 1e-13));
            let found = states(projected.as_ref(), &u);
            for (a, b) in found.iter().zip(states(pointwise.as_ref(), &u)) {
                assert!((0..6).all(|v| (a.cauchy[v] - b.cauchy[v]).abs() < 1e-12));
                assert!((a.det_f_max - b.det_f_max).abs() < 1e-14);
            }
        }
    }
}

#[test]
fn dilatation_of_linear_elements_is_their_mean() {
    for (kind, symmetry, _) in BLOCKS.into_iter().filter(|(kind, ..)| kind.degree() == 1) {
        let mesh = distorted(kind, symmetry, 2, true);
        let u = common::wave(&mesh, 0.1);
        let found = states(projected(&mesh, neo_hookean()).as_ref(), &u);
        let spread = states(laws(&mesh, Dilatation::Pointwise)[1].as_ref(), &u);
        for (mean, points) in found.iter().zip(&spread) {
            assert!((mean.det_f_max - mean.det_f_min).abs() < 1e-14);
            assert!(
                points.det_f_min + 1e-4 < mean.det_f_min,
                "{points:?} {mean:?}"
            );
            assert!(mean.det_f_max < points.det_f_max - 1e-4);
        }
    }
}

#[test]
fn plane_strain_is_a_sheet_of_hexahedra_with_z_held() {
    let plane = distorted_rectangle([3, 4], CellKind::Quad4, 0.2, true);
    let (nodes, sheet) = (plane.points.len(), crate::plane::sheet(&plane));
    let (plane, sheet) = (plane.validated().unwrap(), sheet.validated().unwrap());
    let u = common::wave(&plane, 0.08);
    let layer: Vec<f64> = u.chunks(2).flat_map(|u| [u[0], u[1], 0.0]).collect();
    let in_space = [layer.clone(), layer].concat();
    let (flat, thick) = (
        projected(&plane, neo_hookean()),
        projected(&sheet, neo_hookean()),
    );
    let found = states(flat.as_ref(), &u);
    for (a, b) in found.iter().zip(states(thick.as_ref(), &in_space)) {
        assert!((0..6).all(|v| (a.cauchy[v] - b.cauchy[v]).abs() < 1e-13));
        assert!((a.det_f_min - b.det_f_min).abs() < 1e-14);
    }
    let flat = Solid::new(plane, vec![flat]).unwrap();
    let thick = Solid::new(sheet, vec![thick]).unwrap();
    let (mut work, mut thick_work) = (flat.workspace(), thick.workspace());
    let (mut f, mut g) = (vec![0.0; 2 * nodes], vec![0.0; 6 * nodes]);
    let w = flat.tangent(&u, &mut work, &mut f).unwrap();
    let thick_w = thick.tangent(&in_space, &mut thick_work, &mut g).unwrap();
    assert!((w - thick_w).abs() < 1e-14 * w);
    // Both layers move alike, so forces and products with the tangent of the two add up.
    let same = |flat: &[f64], thick: &[f64]| {
        for (n, i) in (0..nodes).flat_map(|n| [(n, 0), (n, 1)]) {
            let sum = thick[3 * n + i] + thick[3 * (n + nodes) + i];
            assert!((flat[2 * n + i] - sum).abs() < 1e-13, "node {n}: {sum}");
        }
    };
    same(&f, &g);
    flat.tangent_times(&work, &u, &mut f);
    thick.tangent_times(&thick_work, &in_space, &mut g);
    same(&f, &g);
}

/// A dilatation that is linear in space is its own projection in cells with straight edges: nothing is lost.
#[test]
fn linear_dilatation_passes_second_order_cells_unchanged() {
    for (mesh, symmetry) in [
        (
            distorted_rectangle([2, 2], CellKind::Quad9, 0.2, true),
            Symmetry::PlaneStrain,
        ),
        (
            distorted_box([2, 1, 1], CellKind::Hex27, 0.15, true),
            Symmetry::None,
        ),
    ] {
        let mesh = mesh.validated().unwrap();
        // J = 1 + .2 x - .1 y
        let map = |x: &Vector3<f64>| [0.1 * x[0] * x[0] - 0.1 * x[0] * x[1], 0.0, 0.0];
        let u: Vec<f64> = (mesh.points.iter())
            .flat_map(|x| map(x).into_iter().take(symmetry.dim()))
            .collect();
        let pairs = laws(&mesh, Dilatation::Projected).into_iter();
        for (projected, pointwise) in pairs.zip(laws(&mesh, Dilatation::Pointwise)) {
            let [_, w, _] = evaluate(projected.as_ref(), &u);
            let [_, v, _] = evaluate(pointwise.as_ref(), &u);
            assert!(w.iter().zip(&v).all(|(w, v)| (w - v).abs() < 1e-14));
            let found = states(projected.as_ref(), &u);
            for (a, b) in found.iter().zip(states(pointwise.as_ref(), &u)) {
                assert!((0..6).all(|v| (a.cauchy[v] - b.cauchy[v]).abs() < 1e-12));
                assert!((a.det_f_max - b.det_f_max).abs() < 1e-14);
                assert!((a.det_f_min - b.det_f_min).abs() < 1e-14);
            }
        }
    }
}

/// Eigenvalues of a symmetric matrix by Jacobi rotations, sorted.
fn eigenvalues(mut a: Vec<Vec<f64>>) -> Vec<f64> {
    let n = a.len();
    for _ in 0..12 {
        for p in 0..n {
            for q in p + 1..n {
                let angle = 0.5 * (2.0 * a[p][q]).atan2(a[q][q] - a[p][p]);
                let (s, c) = angle.sin_cos();
                for k in 0..n {
                    let (x, y) = (a[k][p], a[k][q]);
                    (a[k][p], a[k][q]) = (c * x - s * y, s * x + c * y);
                }
                for k in 0..n {
                    let (x, y) = (a[p][k], a[q][k]);
                    (a[p][k], a[q][k]) = (c * x - s * y, s * x + c * y);
                }
            }
        }
    }
    let mut values: Vec<f64> = (0..n).map(|i| a[i][i]).collect();
    values.sort_by(f64::total_cmp);
    values
}

/// A distorted element, the first of its mesh, resists everything but rigid motion.
#[test]
fn no_deformation_is_without_energy() {
    let elastic = ElasticConstants::from_shear_poisson(1.0, 0.3).unwrap();
    for (kind, symmetry, rigid) in BLOCKS {
        let mesh = distorted(kind, symmetry, 1, true);
        let law = SaintVenantKirchhoff::new(elastic).unwrap();
        let block = projected(&mesh, law);
        let (dim, nodes) = (block.dim(), block.nodes_per_element());
        let [_, _, k] = evaluate(block.as_ref(), &vec![0.0; dim * mesh.points.len()]);
        let entry = |p: usize, q: usize| {
            k[tangent_index(dim, nodes, (p / dim, p % dim), (q / dim, q % dim))]
        };
        let rows = (0..dim * nodes).map(|p| (0..dim * nodes).map(|q| entry(p, q)).collect());
        let values = eigenvalues(rows.collect());
        let largest = values[values.len() - 1];
        assert!(
            values[..rigid].iter().all(|v| v.abs() < 1e-13 * largest),
            "{kind:?} {values:?}"
        );
        assert!(
            values[rigid] > 1e-8 * largest,
            "{kind:?} {symmetry:?} {values:?}"
        );
    }
}

#[test]
fn cells_on_the_axis_pass_the_battery() {
    let mut mesh = RectangleMesh::uniform([0.0; 2], [1.0; 2], [2, 2])
        .generate("bar")
        .unwrap();
    mesh.symmetry = Symmetry::Axisymmetric;
    let mesh = mesh.validated().unwrap();
    let mut u = common::wave(&mesh, 0.05);
    for &n in mesh.node_set("x_min").unwrap() {
        u[2 * n as usize] = 0.0;
    }
    conformance::check_block(projected(&mesh, blatz_ko()).as_ref(), &mesh.points, &u).unwrap();
}

#[test]
fn elements_of_one_point_cannot_be_projected() {
    for (kind, mesh) in [
        (
            CellKind::Tri3,
            distorted(CellKind::Tri3, Symmetry::PlaneStrain, 1, false),
        ),
        (
            CellKind::Tet4,
            distorted_box([1; 3], CellKind::Tet4, 0.0, false)
                .validated()
                .unwrap(),
        ),
    ] {
        let error = solid_block_with(&mesh, 0, blatz_ko(), 1.0, Dilatation::Projected).unwrap_err();
        assert!(matches!(&error, FeError::Unprojectable { kind: found, .. } if *found == kind));
        assert!(error.to_string().contains("use Quad4"), "{error}");
    }
}

/// The mean of an element may be positive where a point is turned inside out: that is an error all the same.
#[test]
fn inverted_points_are_reported() {
    let mesh = distorted(CellKind::Quad4, Symmetry::PlaneStrain, 1, false);
    let mut u = vec![0.0; 8];
    // The corner at (1.3, 1.2) moves across the diagonal.
    (u[6], u[7]) = (-0.8, -0.9);
    let block = projected(&mesh, neo_hookean());
    let error = block
        .internal_force(&u, &mut [0.0; 8], &mut [0.0])
        .unwrap_err();
    assert!(
        matches!(error, FeError::Inverted { det_f, .. } if det_f <= 0.0),
        "{error}"
    );
}
