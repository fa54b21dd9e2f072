//! Plane strain and axisymmetric blocks: the battery, the solid sheet as an oracle, closed forms.

use std::f64::consts::{PI, TAU};

use fe_core::conformance;
use fe_core::{Block, ElementState, tangent_index, tangent_len};
use fe_core::{
    BoxMesh, CellKind, DeadTraction, Dirichlet, FeError, Gravity, Mesh, MeshError, Motion,
    RectangleMesh, Solid, Surface, SymmetricPattern, Symmetry, Table, solid_block,
};
use hyperelastic::{BlatzKo, ElasticConstants, Material, SaintVenantKirchhoff};
use nalgebra::{Matrix3, Vector3};
use proptest::prelude::*;

use crate::common::{self, PLANE_KINDS, blatz_ko, distorted_rectangle, neo_hookean};

const SYMMETRIES: [Symmetry; 2] = [Symmetry::PlaneStrain, Symmetry::Axisymmetric];

fn with_symmetry(mesh: &Mesh, symmetry: Symmetry) -> Mesh {
    let mut mesh = mesh.clone();
    mesh.symmetry = symmetry;
    mesh
}

fn states(block: &dyn Block, u: &[f64]) -> Vec<ElementState> {
    let mut states = vec![ElementState::default(); block.element_count()];
    block.stress_state(u, &mut states).unwrap();
    states
}

/// Displacement of the map `x -> (stretch[0] x, stretch[1] y)`.
fn stretched(mesh: &Mesh, stretch: [f64; 2]) -> Vec<f64> {
    let moved = |x: &Vector3<f64>| [(stretch[0] - 1.0) * x[0], (stretch[1] - 1.0) * x[1]];
    mesh.points.iter().flat_map(moved).collect()
}

fn force(solid: &Solid, u: &[f64]) -> Vec<f64> {
    let mut f = vec![0.0; solid.dof_count()];
    solid
        .internal_force(u, &mut solid.workspace(), &mut f)
        .unwrap();
    f
}

/// Sum of one component over a node set.
fn resultant(solid: &Solid, f: &[f64], set: &str, component: usize) -> f64 {
    let nodes = solid.mesh().node_set(set).unwrap();
    nodes.iter().map(|&n| f[2 * n as usize + component]).sum()
}

#[test]
fn patch_test_on_distorted_meshes() {
    let shear = Matrix3::new(0.2, 0.3, 0.0, 0.1, -0.2, 0.0, 0.0, 0.0, 0.0);
    let diagonal = Matrix3::from_diagonal(&Vector3::new(0.2, -0.15, 0.0));
    for kind in PLANE_KINDS {
        let flat = distorted_rectangle([4, 5], kind, 0.25, false);
        let rings = with_symmetry(&flat, Symmetry::Axisymmetric);
        for (mesh, gradient) in [(flat, shear), (rings, diagonal)] {
            let soft = common::solid(mesh.clone(), blatz_ko(), 1.0);
            conformance::check_patch(&soft, &gradient).unwrap();
            let curved = common::curved(mesh, 0.01);
            conformance::check_patch(&common::solid(curved, neo_hookean(), 1.0), &gradient)
                .unwrap();
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    #[test]
    fn blocks_pass_the_battery_at_random_deformations(u in prop::collection::vec(-0.06..0.06_f64, 30)) {
        let elastic = neo_hookean().small_strain_moduli();
        for kind in PLANE_KINDS {
            let mesh = distorted_rectangle([2, 1], kind, 0.1, true);
            // Nodes stand twice as close.
            let size = 1.0 / kind.degree() as f64;
            let u: Vec<f64> = u[..2 * mesh.points.len()].iter().map(|u| size * u).collect();
            for symmetry in SYMMETRIES {
                let mesh = with_symmetry(&mesh, symmetry).validated().unwrap();
                let metal = SaintVenantKirchhoff::new(elastic).unwrap();
                for block in [
                    solid_block(&mesh, 0, blatz_ko(), 1.0).unwrap(),
                    solid_block(&mesh, 0, neo_hookean(), 1.0).unwrap(),
                    solid_block(&mesh, 0, metal, 1.0).unwrap(),
                ] {
                    prop_assert_eq!((block.dim(), block.symmetry()), (2, symmetry));
                    conformance::check_block(block.as_ref(), &mesh.points, &u).unwrap();
                }
            }
        }
    }
}

/// The corners of cells on the axis have no radius; what they compute must be finite and consistent there.
#[test]
fn cells_on_the_axis_pass_the_battery() {
    for kind in PLANE_KINDS {
        let mut mesh = RectangleMesh::uniform([0.0; 2], [1.0; 2], [2, 2])
            .with_kind(kind)
            .generate("bar")
            .unwrap();
        mesh.symmetry = Symmetry::Axisymmetric;
        let mut u = common::wave(&mesh, 0.05);
        for &n in mesh.node_set("x_min").unwrap() {
            u[2 * n as usize] = 0.0;
        }
        let mesh = mesh.validated().unwrap();
        let block = solid_block(&mesh, 0, blatz_ko(), 1.0).unwrap();
        conformance::check_block(block.as_ref(), &mesh.points, &u).unwrap();
        conformance::check_mass(&common::solid(mesh.into_inner(), blatz_ko(), 3.0), 3.0 * PI)
            .unwrap();
    }
}

#[test]
fn masses_have_their_totals_and_integrate_linear_fields() {
    for kind in PLANE_KINDS {
        let flat = distorted_rectangle([3, 4], kind, 0.2, false);
        let rings = with_symmetry(&flat, Symmetry::Axisymmetric);
        // Moments of x^p over the interval [0.3, 1.3], and of y^p over [0, 1.2].
        let x = |p: i32| (1.3_f64.powi(p + 1) - 0.3_f64.powi(p + 1)) / f64::from(p + 1);
        let y = |p: i32| 1.2_f64.powi(p + 1) / f64::from(p + 1);
        let plane = (x(0) * y(0), x(2) * y(0) + x(0) * y(2));
        let ring = (TAU * x(1) * y(0), TAU * (x(3) * y(0) + x(1) * y(2)));
        for (mesh, (volume, inertia)) in [(flat, plane), (rings, ring)] {
            let v: Vec<f64> = mesh.points.iter().flat_map(|x| [x[0], x[1]]).collect();
            let solid = common::solid(mesh, blatz_ko(), 250.0);
            conformance::check_mass(&solid, 250.0 * volume).unwrap();
            let found = solid.consistent_mass().quadratic(&v);
            assert!((found / (250.0 * inertia) - 1.0).abs() < 1e-13, "{kind:?}");
        }
    }
}

/// One layer of hexahedra between planes that hold z, one metre thick.
pub(crate) fn sheet(plane: &Mesh) -> Mesh {
    let lifted = |z: f64| {
        plane
            .points
            .iter()
            .map(move |x| Vector3::new(x[0], x[1], z))
    };
    let above = plane.points.len() as u32;
    let cells = plane.blocks[0].iter();
    let mut mesh = BoxMesh::uniform([0.0; 3], [1.0; 3], [1; 3])
        .generate("sheet")
        .unwrap();
    mesh.points = lifted(0.0).chain(lifted(1.0)).collect();
    mesh.blocks[0].cells = cells
        .flat_map(|cell| {
            cell.iter()
                .copied()
                .chain(cell.iter().map(|n| n + above))
                .collect::<Vec<_>>()
        })
        .collect();
    mesh.node_sets.clear();
    mesh.facet_sets.clear();
    mesh
}

#[test]
fn plane_strain_is_a_sheet_of_hexahedra_with_z_held() {
    let plane = distorted_rectangle([3, 4], CellKind::Quad4, 0.2, true);
    let sheet = sheet(&plane);
    let nodes = plane.points.len();
    let u = common::wave(&plane, 0.08);
    let in_space: Vec<f64> = u
        .chunks(2)
        .map(|u| [u[0], u[1], 0.0])
        .collect::<Vec<_>>()
        .concat();
    let in_space = [in_space.clone(), in_space].concat();
    let flat = common::solid(plane, neo_hookean(), 7.0);
    let thick = common::solid(sheet, neo_hookean(), 7.0);
    let (mut work, mut thick_work) = (flat.workspace(), thick.workspace());
    let (mut f, mut g) = (vec![0.0; 2 * nodes], vec![0.0; 6 * nodes]);
    let w = flat.tangent(&u, &mut work, &mut f).unwrap();
    let thick_w = thick.tangent(&in_space, &mut thick_work, &mut g).unwrap();
    assert!((w - thick_w).abs() < 1e-14 * w);
    // Both layers move alike, so forces, products with the tangent, and masses of the two add up.
    let same = |flat: &[f64], thick: &[f64]| {
        for n in 0..nodes {
            for i in 0..2 {
                let sum = thick[3 * n + i] + thick[3 * (n + nodes) + i];
                assert!((flat[2 * n + i] - sum).abs() < 1e-13, "node {n}: {sum}");
            }
        }
    };
    same(&f, &g);
    let (mut y, mut z) = (vec![0.0; 2 * nodes], vec![0.0; 6 * nodes]);
    flat.tangent_times(&work, &u, &mut y);
    thick.tangent_times(&thick_work, &in_space, &mut z);
    same(&y, &z);
    flat.consistent_mass().times(&u, &mut y);
    thick.consistent_mass().times(&in_space, &mut z);
    same(&y, &z);
    let found = states(flat.blocks()[0].as_ref(), &u);
    let expected = states(thick.blocks()[0].as_ref(), &in_space);
    for (a, b) in found.iter().zip(&expected) {
        assert!((0..6).all(|v| (a.cauchy[v] - b.cauchy[v]).abs() < 1e-13));
        assert!((a.von_mises - b.von_mises).abs() < 1e-13);
        assert!((a.det_f_min - b.det_f_min).abs() < 1e-14);
        assert!((a.det_f_max - b.det_f_max).abs() < 1e-14);
    }
}

/// Blatz-Ko with shear modulus 1.5 stretched by `l`, free across: plane strain `P = G (l^(-1/3) - l^-3)`.
#[test]
fn plane_tension_of_blatz_ko() {
    for kind in PLANE_KINDS {
        let mesh = distorted_rectangle([3, 3], kind, 0.2, false);
        let solid = common::solid(mesh, blatz_ko(), 1.0);
        for l in [0.6_f64, 1.3, 2.0] {
            let f = force(&solid, &stretched(solid.mesh(), [l, l.powf(-1.0 / 3.0)]));
            let p = 1.5 * (l.powf(-1.0 / 3.0) - l.powi(-3));
            assert!((resultant(&solid, &f, "x_max", 0) - 1.2 * p).abs() < 1e-13);
            assert!((resultant(&solid, &f, "x_min", 0) + 1.2 * p).abs() < 1e-13);
            for n in 0..solid.node_count() {
                assert!(f[2 * n + 1].abs() < 1e-13, "free across");
            }
        }
    }
}

/// A bar of radius 0.5 and length 1.2 pulled along its axis, and blown up across it.
#[test]
fn bars_of_blatz_ko_in_uniaxial_and_equibiaxial_tension() {
    for kind in PLANE_KINDS {
        let mut mesh = RectangleMesh::uniform([0.0; 2], [0.5, 1.2], [3, 4])
            .with_kind(kind)
            .generate("bar")
            .unwrap();
        mesh.symmetry = Symmetry::Axisymmetric;
        let solid = common::solid(mesh, blatz_ko(), 1.0);
        for l in [0.6_f64, 1.3, 2.0] {
            let u = stretched(solid.mesh(), [l.powf(-0.25), l]);
            let f = force(&solid, &u);
            let p = 1.5 * (l.powf(-0.5) - l.powi(-3));
            assert!((resultant(&solid, &f, "y_max", 1) - 0.25 * PI * p).abs() < 1e-13);
            assert!(resultant(&solid, &f, "x_max", 0).abs() < 1e-13);
            for state in states(solid.blocks()[0].as_ref(), &u) {
                let axial = p * l.powf(0.5);
                let expected = [0.0, axial, 0.0, 0.0, 0.0, 0.0];
                assert!((0..6).all(|v| (state.cauchy[v] - expected[v]).abs() < 1e-12));
                assert!((state.von_mises - axial.abs()).abs() < 1e-12);
            }

            let u = stretched(solid.mesh(), [l, l.powf(-2.0 / 3.0)]);
            let f = force(&solid, &u);
            let p = 1.5 * (l.powf(1.0 / 3.0) - l.powi(-3));
            let area = TAU * 0.5 * 1.2;
            assert!((resultant(&solid, &f, "x_max", 0) - area * p).abs() < 1e-12);
            assert!(resultant(&solid, &f, "y_max", 1).abs() < 1e-12);
            for state in states(solid.blocks()[0].as_ref(), &u) {
                assert!((state.cauchy[0] - state.cauchy[2]).abs() < 1e-12, "hoop");
                assert!((state.cauchy[2] - p * l.powf(-1.0 / 3.0)).abs() < 1e-12);
            }
        }
    }
}

/// Solves `a x = b` for a small dense matrix without zero pivots.
fn eliminate(mut a: Vec<Vec<f64>>, mut b: Vec<f64>) -> Vec<f64> {
    let n = b.len();
    for k in 0..n {
        for row in k + 1..n {
            let factor = a[row][k] / a[k][k];
            for column in k..n {
                a[row][column] -= factor * a[k][column];
            }
            b[row] -= factor * b[k];
        }
    }
    for k in (0..n).rev() {
        let known: f64 = (k + 1..n).map(|j| a[k][j] * b[j]).sum();
        b[k] = (b[k] - known) / a[k][k];
    }
    b
}

/// Radial displacement of the inner rim of a tube of radii 1 and 2 under the inner pressure 1, its ends held axially,
/// at small strain; from the tangent at rest.
fn tube(kind: CellKind, cells: usize, elastic: ElasticConstants) -> Vec<(f64, f64)> {
    let mut mesh = RectangleMesh::uniform([1.0, 0.0], [2.0, 0.5], [cells, cells / 2])
        .with_kind(kind)
        .generate("tube")
        .unwrap();
    mesh.symmetry = Symmetry::Axisymmetric;
    let inner = mesh.facet_set("x_min").unwrap().to_vec();
    let pressure = DeadTraction::new(inner, Vector3::x(), Table::constant(1.0));
    let load = pressure.nodal_forces(&mesh).unwrap();
    assert!((load.iter().sum::<f64>() - TAU * 0.5).abs() < 1e-14);
    let solid = common::solid(mesh, SaintVenantKirchhoff::new(elastic).unwrap(), 1.0);
    let nodes = solid.node_count();
    // Radial unknowns only.
    let equation: Vec<u32> = (0..2 * nodes as u32)
        .map(|dof| if dof % 2 == 0 { dof / 2 } else { u32::MAX })
        .collect();
    let pattern = SymmetricPattern::new(&solid, &equation, nodes).unwrap();
    let mut work = solid.workspace();
    solid
        .tangent(&vec![0.0; 2 * nodes], &mut work, &mut vec![0.0; 2 * nodes])
        .unwrap();
    let mut values = vec![0.0; pattern.nonzeros()];
    pattern.gather_tangent(&work, 1.0, &mut values);
    let mut k = vec![vec![0.0; nodes]; nodes];
    for column in 0..nodes {
        for z in pattern.column_pointers()[column]..pattern.column_pointers()[column + 1] {
            let row = pattern.row_indices()[z];
            k[row][column] = values[z];
            k[column][row] = values[z];
        }
    }
    let u = eliminate(k, load.iter().step_by(2).copied().collect());
    let radii = solid.mesh().points.iter().map(|x| x[0]);
    radii.zip(u).collect()
}

/// Lame: `u = (1 + nu)/E a^2 p/(b^2 - a^2) ((1 - 2 nu) r + b^2/r)`.
#[test]
fn thick_tube_converges_to_lame_with_the_square_of_the_size() {
    let elastic = ElasticConstants::from_shear_lame(10.0, 15.0).unwrap();
    let nu = elastic.poisson_ratio();
    let exact = |r: f64| 1.0 / (2.0 * 10.0) / 3.0 * ((1.0 - 2.0 * nu) * r + 4.0 / r);
    for kind in [CellKind::Quad4, CellKind::Tri3] {
        let errors = [4, 8, 16, 32].map(|cells| {
            let found = tube(kind, cells, elastic);
            let squares: f64 = found.iter().map(|(r, u)| (u - exact(*r)).powi(2)).sum();
            (squares / found.len() as f64).sqrt()
        });
        assert!(errors[3] < 1e-3 * exact(1.0), "{kind:?} {errors:?}");
        for pair in errors[1..].windows(2) {
            let slope = (pair[0] / pair[1]).log2();
            assert!((slope - 2.0).abs() < 0.15, "{kind:?} {errors:?}");
        }
    }
}

#[test]
fn matter_behind_the_axis_is_inverted() {
    let mut mesh = RectangleMesh::uniform([0.0; 2], [1.0; 2], [2, 2])
        .generate("bar")
        .unwrap();
    mesh.symmetry = Symmetry::Axisymmetric;
    // Mirrored at the axis: both factors of det F are negative, their product is 1.
    let u = stretched(&mesh, [-1.0, 1.0]);
    let solid = common::solid(
        mesh,
        SaintVenantKirchhoff::new(neo_hookean().small_strain_moduli()).unwrap(),
        1.0,
    );
    let mut f = vec![0.0; u.len()];
    let error = solid
        .internal_force(&u, &mut solid.workspace(), &mut f)
        .unwrap_err();
    assert!(
        matches!(error, FeError::Inverted { element: 0, det_f, .. } if det_f < 0.0),
        "{error}"
    );
    let mut states = vec![ElementState::default(); 4];
    assert!(solid.blocks()[0].stress_state(&u, &mut states).is_err());
}

#[test]
fn blocks_of_another_symmetry_are_refused() {
    let mesh = distorted_rectangle([2, 2], CellKind::Quad4, 0.0, false);
    let rings = with_symmetry(&mesh, Symmetry::Axisymmetric);
    let in_space = with_symmetry(&mesh, Symmetry::None);
    let (mesh, rings) = (mesh.validated().unwrap(), rings.validated().unwrap());
    let block = solid_block(&mesh, 0, blatz_ko(), 1.0).unwrap();
    let error = Solid::new(rings, vec![block]).unwrap_err();
    assert!(
        matches!(error, FeError::Mesh(MeshError::Symmetry { .. })),
        "{error}"
    );
    assert!(matches!(
        in_space.validated(),
        Err(MeshError::Dimension { dim: 2, .. })
    ));
}

#[test]
fn loads_and_supports_have_two_components() {
    let flat = distorted_rectangle([3, 3], CellKind::Tri3, 0.2, false);
    for (symmetry, area, volume) in [
        (Symmetry::PlaneStrain, 1.0, 1.2),
        (
            Symmetry::Axisymmetric,
            PI * (1.69 - 0.09),
            1.2 * PI * (1.69 - 0.09),
        ),
    ] {
        let mesh = with_symmetry(&flat, symmetry);
        let (top, once) = (mesh.facet_sets["y_max"].clone(), Table::constant(1.0));
        let pull = DeadTraction::new(top, [2.0, -3.0, 99.0], once.clone());
        let f = pull.nodal_forces(&mesh).unwrap();
        for i in 0..2 {
            let total: f64 = f.iter().skip(i).step_by(2).sum();
            assert!((total - area * pull.traction[i]).abs() < 1e-13);
        }
        let held = Dirichlet::clamped("base", mesh.node_sets["y_min"].clone())
            .with_components([false, true, true])
            .with_motion(Motion::translation([1.0, 2.0, 3.0].map(Table::constant)));
        let mut u = vec![0.0; 2 * mesh.points.len()];
        held.set_displacement(&mesh, 0.0, &mut u);
        let dofs: Vec<usize> = held.dofs(2).collect();
        assert_eq!(dofs, [1, 3, 5, 7]);
        assert!((0..u.len()).all(|dof| u[dof] == if dofs.contains(&dof) { 2.0 } else { 0.0 }));
        let solid = common::solid(mesh, BlatzKo::new(1.0).unwrap(), 40.0);
        let gravity = Gravity::new([0.5, -9.81, 99.0], once);
        let weight = gravity.nodal_forces(&solid.lumped_mass()).unwrap();
        assert_eq!(weight.len(), 2 * solid.node_count());
        let total: f64 = weight.iter().skip(1).step_by(2).sum();
        assert!((total + 40.0 * volume * 9.81).abs() < 1e-9 * total.abs());
    }
}

/// `tangent_index` and the batteries read the same layout: the work of the tangent's columns in a pure shift is zero.
#[test]
fn plane_tangents_have_no_force_under_a_shift() {
    let mesh = distorted_rectangle([2, 2], CellKind::Quad4, 0.2, true);
    let mesh = mesh.validated().unwrap();
    let block = solid_block(&mesh, 0, neo_hookean(), 1.0).unwrap();
    let u = common::wave(&mesh, 0.05);
    let (mut f, mut w) = (vec![0.0; 32], vec![0.0; 4]);
    let mut k = vec![0.0; 4 * tangent_len(2, 4)];
    block.tangent(&u, &mut f, &mut w, &mut k).unwrap();
    for k in k.chunks(tangent_len(2, 4)) {
        for row in 0..8 {
            for component in 0..2 {
                let sum: f64 = (0..4)
                    .map(|b| k[tangent_index(2, 4, (row / 2, row % 2), (b, component))])
                    .sum();
                assert!(sum.abs() < 1e-13);
            }
        }
    }
}

#[test]
fn normals_of_plane_bodies_point_outward() {
    let mesh = distorted_rectangle([3, 3], CellKind::Quad4, 0.2, false);
    let flat: Vec<f64> = mesh.points.iter().flat_map(|x| [x[0], x[1]]).collect();
    for (set, normal) in [
        ("x_min", [-1.0, 0.0, 0.0]),
        ("x_max", [1.0, 0.0, 0.0]),
        ("y_min", [0.0, -1.0, 0.0]),
        ("y_max", [0.0, 1.0, 0.0]),
    ] {
        let surface = Surface::new(mesh.facet_sets[set].clone()).unwrap();
        assert_eq!(surface.dim(), 2);
        assert_eq!(surface.nodes, mesh.node_sets[set]);
        for n in surface.vertex_normals(&flat) {
            assert!((0..3).all(|i| (n[i] - normal[i]).abs() < 1e-14));
        }
    }
}
