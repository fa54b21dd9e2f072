//! Elements and blocks: the conformance battery, the papers' matrices as an oracle, refusals.

use fe_core::conformance::{self, Violation};
use fe_core::{Block, ElementState, tangent_index, tangent_len};
use fe_core::{
    BoxMesh, CellKind, Element, FeError, Hex8, Hex27, Mesh, Motion, Quad4, Quad9, Rotation, Solid,
    SolidBlock, Symmetry, Table, Tet4, Tet10, Tri3, Tri6, solid_block,
};
use fe_core::{corner_points, reference_gradients};
use fe_core::{deformation_gradient, linear_strain_matrix, nonlinear_strain_matrix};
use hyperelastic::tensor::to_matrix;
use hyperelastic::{Material, SaintVenantKirchhoff, right_cauchy_green};
use nalgebra::{Matrix3, Vector3};
use proptest::prelude::*;

use crate::common::{self, KINDS, blatz_ko, distorted_box, neo_hookean};

#[test]
fn elements_pass_the_battery() {
    conformance::check_element::<Hex8, 8>().unwrap();
    conformance::check_element::<Tet4, 4>().unwrap();
    conformance::check_element::<Quad4, 4>().unwrap();
    conformance::check_element::<Tri3, 3>().unwrap();
    conformance::check_element::<Hex27, 27>().unwrap();
    conformance::check_element::<Tet10, 10>().unwrap();
    conformance::check_element::<Quad9, 9>().unwrap();
    conformance::check_element::<Tri6, 6>().unwrap();
}

#[test]
fn patch_test_on_distorted_meshes() {
    let gradient = Matrix3::new(0.2, 0.3, -0.1, 0.1, -0.2, 0.05, 0.0, 0.1, 0.3);
    for kind in KINDS {
        let mesh = distorted_box([3, 4, 3], kind, 0.25, false);
        conformance::check_patch(&common::solid(mesh.clone(), blatz_ko(), 1.0), &gradient).unwrap();
        let curved = common::curved(mesh, 0.02);
        conformance::check_patch(&common::solid(curved, neo_hookean(), 1.0), &gradient).unwrap();
    }
}

#[test]
fn patch_test_without_nodes_inside_is_refused() {
    let solid = common::solid(
        distorted_box([2, 1, 1], CellKind::Hex8, 0.0, false),
        blatz_ko(),
        1.0,
    );
    let gradient = Matrix3::from_diagonal(&Vector3::new(0.1, 0.0, 0.0));
    let result = conformance::check_patch(&solid, &gradient);
    assert!(matches!(result, Err(Violation::Input { .. })));
}

#[test]
fn masses_have_their_totals() {
    for kind in KINDS {
        let mesh = distorted_box([3, 2, 4], kind, 0.2, false);
        conformance::check_mass(&common::solid(mesh, blatz_ko(), 250.0), 250.0 * 0.96).unwrap();
    }
}

/// Quadrature of the mass is exact: the inertia of the velocity field x about the origin is known.
#[test]
fn consistent_mass_integrates_linear_fields_exactly() {
    for kind in KINDS {
        let mesh = distorted_box([3, 3, 3], kind, 0.2, false);
        let v: Vec<f64> = mesh.points.iter().flatten().copied().collect();
        let mass = common::solid(mesh, blatz_ko(), 3.0).consistent_mass();
        let exact = 3.0 * 0.96 * (1.0 + 1.44 + 0.64) / 3.0;
        assert!((mass.quadratic(&v) - exact).abs() < 1e-13);
    }
}

fn states(block: &dyn Block, u: &[f64]) -> Vec<ElementState> {
    let mut states = vec![ElementState::default(); block.element_count()];
    block.stress_state(u, &mut states).unwrap();
    states
}

#[test]
fn stress_state_of_a_stretched_and_turned_bar() {
    // Confined stretch l of Blatz-Ko: P = G (1 - l^-3) along the bar, so does the Cauchy stress.
    let mesh = BoxMesh::uniform([0.0; 3], [2.0, 1.0, 1.0], [2, 1, 1])
        .generate("bar")
        .unwrap();
    let mesh = mesh.validated().unwrap();
    let block = solid_block(&mesh, 0, blatz_ko(), 1.0).unwrap();
    let quarter = Table::constant(std::f64::consts::FRAC_PI_2);
    let turn = Rotation::new([0.0; 3], [0.0, 0.0, 1.0], quarter).unwrap();
    let turn = Motion::still().with_rotation(turn);
    let stretch = 1.4;
    let moved = |x: &Vector3<f64>| {
        let y = turn.position(Vector3::new(stretch * x[0], x[1], x[2]), 0.0);
        <[f64; 3]>::from(y - x)
    };
    let u: Vec<f64> = mesh.points.iter().flat_map(moved).collect();
    for state in states(block.as_ref(), &u) {
        let along = 1.5 * (1.0 - stretch.powi(-3));
        let across = 1.5 * (1.0 - 1.0 / stretch);
        let expected = [across, along, across, 0.0, 0.0, 0.0];
        for v in 0..6 {
            assert!((state.cauchy[v] - expected[v]).abs() < 1e-13, "{state:?}");
        }
        assert!((state.von_mises - (across - along).abs()).abs() < 1e-13);
        assert!((state.det_f_min - stretch).abs() < 1e-13);
        assert!((state.det_f_max - stretch).abs() < 1e-13);
    }
}

/// The papers' element: `f = (B_L + B_NL)^T S`, `K = (B_L + B_NL)^T D (B_L + B_NL) + S dN dN`, with dense
/// matrices.
fn dense_element<E, M, const N: usize>(
    mesh: &Mesh,
    cell: &[u32],
    material: &M,
    u: &[f64],
) -> (Vec<f64>, Vec<Vec<f64>>)
where
    E: Element<Nodal = [f64; N]>,
    M: Material,
{
    let x = corner_points::<N>(&mesh.points, cell);
    let local: [[f64; N]; 3] =
        std::array::from_fn(|i| std::array::from_fn(|a| u[3 * cell[a] as usize + i]));
    let mut force = vec![0.0; 3 * N];
    let mut tangent = vec![vec![0.0; 3 * N]; 3 * N];
    for point in E::rule() {
        let (g, det_j) = reference_gradients::<E, N>(&x, &point.xi);
        let w = point.weight * det_j;
        let f = deformation_gradient(&local, &g);
        let h = f - Matrix3::identity();
        let (linear, nonlinear) = (linear_strain_matrix(&g), nonlinear_strain_matrix(&h, &g));
        let b = |p: usize, v: usize| linear[p / 3][(v, p % 3)] + nonlinear[p / 3][(v, p % 3)];
        let response = material.response(&right_cauchy_green(&f)).unwrap();
        let s = to_matrix(&response.stress);
        for p in 0..3 * N {
            force[p] += (0..6)
                .map(|v| w * b(p, v) * response.stress[v])
                .sum::<f64>();
            for q in 0..3 * N {
                for v in 0..6 {
                    for y in 0..6 {
                        tangent[p][q] += w * b(p, v) * response.tangent[(v, y)] * b(q, y);
                    }
                }
                if p % 3 == q % 3 {
                    for j in 0..3 {
                        for l in 0..3 {
                            tangent[p][q] += w * g[j][p / 3] * s[(j, l)] * g[l][q / 3];
                        }
                    }
                }
            }
        }
    }
    (force, tangent)
}

fn compare_with_the_papers<E, M, const N: usize>(mesh: Mesh, material: M, u: &[f64])
where
    E: Element<Nodal = [f64; N]>,
    M: Material,
{
    let mesh = &mesh.validated().unwrap();
    let block = SolidBlock::<E, M>::new(mesh, 0, material.clone(), 1.0).unwrap();
    let count = block.element_count();
    let entries = tangent_len(3, N);
    let (mut forces, mut energies) = (vec![0.0; 3 * N * count], vec![0.0; count]);
    let mut tangents = vec![0.0; entries * count];
    block
        .tangent(u, &mut forces, &mut energies, &mut tangents)
        .unwrap();
    for (element, cell) in mesh.blocks[0].iter().enumerate() {
        let (force, tangent) = dense_element::<E, M, N>(mesh, cell, &material, u);
        let scale = tangent
            .iter()
            .flatten()
            .fold(0.0_f64, |m, k| m.max(k.abs()));
        for p in 0..3 * N {
            assert!((forces[element * 3 * N + p] - force[p]).abs() < 1e-12 * scale);
            for q in 0..3 * N {
                let place = tangent_index(3, N, (p / 3, p % 3), (q / 3, q % 3));
                let found = tangents[element * entries + place];
                assert!(
                    (found - tangent[p][q]).abs() < 1e-12 * scale,
                    "{element} {p} {q}"
                );
            }
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    #[test]
    fn blocks_pass_the_battery_at_random_deformations(u in common::displacement(45, 0.06)) {
        for kind in KINDS {
            let mesh = distorted_box([2, 1, 1], kind, 0.1, true).validated().unwrap();
            // Nodes stand twice as close.
            let size = 1.0 / kind.degree() as f64;
            let u: Vec<f64> = u[..3 * mesh.points.len()].iter().map(|u| size * u).collect();
            let soft = solid_block(&mesh, 0, blatz_ko(), 1.0).unwrap();
            conformance::check_block(soft.as_ref(), &mesh.points, &u).unwrap();
            let rubber = solid_block(&mesh, 0, neo_hookean(), 1.0).unwrap();
            conformance::check_block(rubber.as_ref(), &mesh.points, &u).unwrap();
            let elastic = neo_hookean().small_strain_moduli();
            let metal = SaintVenantKirchhoff::new(elastic).unwrap();
            let metal = solid_block(&mesh, 0, metal, 1.0).unwrap();
            conformance::check_block(metal.as_ref(), &mesh.points, &u).unwrap();
        }
    }

    #[test]
    fn kernels_agree_with_the_papers_matrices(u in common::displacement(12, 0.08)) {
        let mesh = distorted_box([2, 1, 1], CellKind::Hex8, 0.1, true);
        compare_with_the_papers::<Hex8, _, 8>(mesh, blatz_ko(), &u);
        let mesh = distorted_box([2, 1, 1], CellKind::Tet4, 0.1, true);
        compare_with_the_papers::<Tet4, _, 4>(mesh, neo_hookean(), &u);
    }
}

/// The battery must be able to fail: a block whose tangent or force is a little wrong.
#[derive(Debug)]
struct Wrong {
    inner: Box<dyn Block>,
    force: f64,
    tangent: f64,
    skew: f64,
}

impl Block for Wrong {
    fn name(&self) -> &str {
        self.inner.name()
    }
    fn symmetry(&self) -> Symmetry {
        self.inner.symmetry()
    }
    fn element_count(&self) -> usize {
        self.inner.element_count()
    }
    fn nodes_per_element(&self) -> usize {
        self.inner.nodes_per_element()
    }
    fn connectivity(&self) -> &[u32] {
        self.inner.connectivity()
    }
    fn internal_force(&self, u: &[f64], f: &mut [f64], w: &mut [f64]) -> Result<(), FeError> {
        self.inner.internal_force(u, f, w)?;
        f.iter_mut().for_each(|f| *f *= 1.0 + self.force);
        Ok(())
    }
    fn tangent(
        &self,
        u: &[f64],
        f: &mut [f64],
        w: &mut [f64],
        k: &mut [f64],
    ) -> Result<(), FeError> {
        self.inner.tangent(u, f, w, k)?;
        f.iter_mut().for_each(|f| *f *= 1.0 + self.force);
        k.iter_mut().for_each(|k| *k *= 1.0 + self.tangent);
        k[1] *= 1.0 + self.skew;
        Ok(())
    }
    fn mass(&self, masses: &mut [f64]) {
        self.inner.mass(masses);
    }
    fn stress_state(&self, u: &[f64], states: &mut [ElementState]) -> Result<(), FeError> {
        self.inner.stress_state(u, states)
    }
}

#[test]
fn battery_finds_small_mistakes() {
    let mesh = distorted_box([2, 1, 1], CellKind::Hex8, 0.1, true);
    let mesh = mesh.validated().unwrap();
    let u = common::wave(&mesh, 0.05);
    let verdict = |force, tangent, skew| {
        let inner = solid_block(&mesh, 0, blatz_ko(), 1.0).unwrap();
        let wrong = Wrong {
            inner,
            force,
            tangent,
            skew,
        };
        conformance::check_block(&wrong, &mesh.points, &u)
    };
    assert!(verdict(0.0, 0.0, 0.0).is_ok());
    let property = |result| match result {
        Err(Violation::Differs { property, .. }) => property,
        other => panic!("{other:?}"),
    };
    assert!(property(verdict(0.0, 1e-4, 0.0)).contains("derivative of the force"));
    assert!(property(verdict(0.0, 0.0, 1e-4)).contains("symmetry"));
    // A force with its own consistent tangent, but not the energy's derivative.
    assert!(property(verdict(1e-3, 1e-3, 0.0)).contains("derivative of the energy"));
}

#[test]
fn inverted_elements_are_reported_lowest_first() {
    let mesh = BoxMesh::uniform([0.0; 3], [1.0; 3], [6; 3])
        .generate("cube")
        .unwrap();
    let mesh = mesh.validated().unwrap();
    let block = solid_block(&mesh, 0, blatz_ko(), 1.0).unwrap();
    let mut u = vec![0.0; 3 * mesh.points.len()];
    for element in [70, 133, 200] {
        let node = mesh.blocks[0].cells[8 * element + 6] as usize;
        (0..3).for_each(|i| u[3 * node + i] = -1.0);
    }
    let solid = Solid::new(mesh, vec![block]).unwrap();
    let mut f = vec![0.0; u.len()];
    let mut work = solid.workspace();
    for threads in [1, 4] {
        let error = common::pool(threads)
            .install(|| solid.internal_force(&u, &mut work, &mut f))
            .unwrap_err();
        let again = solid.tangent(&u, &mut work, &mut f).unwrap_err();
        assert_eq!(error, again);
        let FeError::Inverted {
            block,
            element,
            det_f,
            ..
        } = &error
        else {
            panic!("{error}");
        };
        assert_eq!((block.as_str(), *element), ("cube", 70));
        assert!(*det_f <= 0.0);
        assert!(error.to_string().contains("block `cube`, element 70"));
    }
    u.fill(0.0);
    u[11] = f64::NAN;
    let error = solid.internal_force(&u, &mut work, &mut f).unwrap_err();
    assert!(matches!(error, FeError::Inverted { det_f, .. } if det_f.is_nan()));
}

#[test]
fn impossible_blocks_are_refused() {
    let mesh = distorted_box([1, 1, 1], CellKind::Hex8, 0.0, false);
    let mesh = mesh.validated().unwrap();
    for density in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let error = solid_block(&mesh, 0, blatz_ko(), density).unwrap_err();
        assert!(error.to_string().contains("density [kg/m^3]"), "{error}");
        assert!(error.to_string().contains("positive"), "{error}");
    }
    let missing = solid_block(&mesh, 1, blatz_ko(), 1.0).unwrap_err();
    assert!(matches!(missing, FeError::Index { index: 1, .. }));
    let kind = SolidBlock::<Tet4, _>::new(&mesh, 0, blatz_ko(), 1.0).unwrap_err();
    assert!(matches!(kind, FeError::CellKind { .. }));
    let mut flipped = mesh.into_inner();
    flipped.blocks[0].cells.swap(0, 6);
    let error = flipped.validated().unwrap_err();
    assert!(
        error
            .to_string()
            .contains("block `box`, element 0: Jacobian"),
        "{error}"
    );
}
