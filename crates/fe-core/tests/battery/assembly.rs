//! Solid, pattern and mass against dense assembly; the same bits for any number of threads.

use fe_core::{
    BoxMesh, CellKind, FeError, MassMatrix, Mesh, Solid, SymmetricPattern, Symmetry,
    node_adjacency, solid_block,
};
use fe_core::{tangent_index, tangent_len};
use proptest::prelude::*;

use crate::common::{self, blatz_ko, distorted_box, distorted_rectangle, neo_hookean};

/// Two blocks of different kinds that share no node, and a third body.
fn mixed() -> Solid {
    let mut mesh = distorted_box([2, 2, 1], CellKind::Hex8, 0.2, true);
    let mut tets = distorted_box([1, 2, 1], CellKind::Tet4, 0.2, true);
    tets.points.iter_mut().for_each(|x| x[0] += 5.0);
    mesh.append("tets", tets.clone()).unwrap();
    tets.points.iter_mut().for_each(|x| x[0] += 5.0);
    mesh.append("more", tets).unwrap();
    common::solid(mesh, blatz_ko(), 2.0)
}

/// The same in the plane, as rings.
fn mixed_plane() -> Solid {
    let mut mesh = distorted_rectangle([2, 2], CellKind::Quad4, 0.2, true);
    let mut triangles = distorted_rectangle([1, 2], CellKind::Tri3, 0.2, true);
    triangles.points.iter_mut().for_each(|x| x[0] += 5.0);
    mesh.append("triangles", triangles.clone()).unwrap();
    triangles.points.iter_mut().for_each(|x| x[0] += 5.0);
    mesh.append("more", triangles).unwrap();
    mesh.symmetry = Symmetry::Axisymmetric;
    common::solid(mesh, blatz_ko(), 2.0)
}

/// `K` as a full matrix, element by element.
fn dense_tangent(solid: &Solid, u: &[f64]) -> Vec<Vec<f64>> {
    let (n, dim) = (solid.dof_count(), solid.dim());
    let mut dense = vec![vec![0.0; n]; n];
    for block in solid.blocks() {
        let (count, nodes) = (block.element_count(), block.nodes_per_element());
        let entries = tangent_len(dim, nodes);
        let (mut f, mut w) = (vec![0.0; dim * nodes * count], vec![0.0; count]);
        let mut k = vec![0.0; entries * count];
        block.tangent(u, &mut f, &mut w, &mut k).unwrap();
        for (element, cell) in block.connectivity().chunks(nodes).enumerate() {
            for p in 0..dim * nodes {
                for q in 0..dim * nodes {
                    let (a, i, b, j) = (p / dim, p % dim, q / dim, q % dim);
                    let place = tangent_index(dim, nodes, (a, i), (b, j));
                    dense[dim * cell[a] as usize + i][dim * cell[b] as usize + j] +=
                        k[element * entries + place];
                }
            }
        }
    }
    dense
}

/// `M` as a full matrix.
fn dense_mass(mass: &MassMatrix) -> Vec<Vec<f64>> {
    let dim = mass.dim();
    let n = dim * mass.node_count();
    let mut dense = vec![vec![0.0; n]; n];
    for a in 0..mass.node_count() {
        for z in mass.offsets()[a]..mass.offsets()[a + 1] {
            for i in 0..dim {
                dense[dim * a + i][dim * mass.columns()[z] as usize + i] += mass.values()[z];
            }
        }
    }
    dense
}

fn times(dense: &[Vec<f64>], x: &[f64]) -> Vec<f64> {
    let row = |row: &Vec<f64>| row.iter().zip(x).map(|(k, x)| k * x).sum();
    dense.iter().map(row).collect()
}

fn assert_close(found: &[f64], expected: &[f64], scale: f64) {
    assert_eq!(found.len(), expected.len());
    for (p, (x, y)) in found.iter().zip(expected).enumerate() {
        assert!((x - y).abs() <= 1e-12 * scale, "entry {p}: {x} {y}");
    }
}

fn largest(dense: &[Vec<f64>]) -> f64 {
    dense.iter().flatten().fold(0.0, |m, k| m.max(k.abs()))
}

/// A permutation of the dofs with some left out, from random keys.
fn numbering(keys: &[u32]) -> (Vec<u32>, usize) {
    let mut order: Vec<usize> = (0..keys.len())
        .filter(|&dof| !keys[dof].is_multiple_of(5))
        .collect();
    order.sort_by_key(|&dof| (keys[dof], dof));
    let mut equation = vec![u32::MAX; keys.len()];
    for (number, &dof) in order.iter().enumerate() {
        equation[dof] = number as u32;
    }
    (equation, order.len())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(16))]

    #[test]
    fn pattern_gathers_what_dense_assembly_adds(
        u in common::displacement(42, 0.05),
        keys in prop::collection::vec(0..1000_u32, 126),
        stiffness in 0.1..2.0_f64,
        inertia in 0.1..2.0_f64,
    ) {
        for solid in [mixed(), mixed_plane()] {
            let dofs = solid.dof_count();
            let (u, keys) = (&u[..dofs], &keys[..dofs]);
            let (equation, n) = numbering(keys);
            let pattern = SymmetricPattern::new(&solid, &equation, n).unwrap();
            let mut work = solid.workspace();
            let mut f = vec![0.0; dofs];
            solid.tangent(u, &mut work, &mut f).unwrap();
            let k = dense_tangent(&solid, u);
            for mass in [solid.consistent_mass(), solid.lumped_mass()] {
                let m = dense_mass(&mass);
                let mut values = vec![f64::NAN; pattern.nonzeros()];
                pattern.gather_tangent(&work, stiffness, &mut values);
                pattern.add_mass(&mass, inertia, &mut values);
                let mut expected = vec![vec![0.0; n]; n];
                for p in 0..dofs {
                    for q in 0..dofs {
                        let (row, column) = (equation[p] as usize, equation[q] as usize);
                        if row < n && column < n && row >= column {
                            expected[column][row] = stiffness * k[p][q] + inertia * m[p][q];
                        }
                    }
                }
                let scale = largest(&expected);
                let (pointers, rows) = (pattern.column_pointers(), pattern.row_indices());
                prop_assert_eq!(pointers.len(), n + 1);
                for column in 0..n {
                    let range = pointers[column]..pointers[column + 1];
                    prop_assert_eq!(rows[range.start], column);
                    prop_assert!(rows[range.clone()].windows(2).all(|pair| pair[0] < pair[1]));
                    for z in range {
                        expected[column][rows[z]] -= values[z];
                    }
                }
                // What the pattern has not, must be zero.
                prop_assert!(largest(&expected) < 1e-13 * scale);
            }
        }
    }

    #[test]
    fn products_with_tangent_and_mass(u in common::displacement(42, 0.05), x in common::displacement(42, 1.0)) {
        for solid in [mixed(), mixed_plane()] {
            let dofs = solid.dof_count();
            let (u, x) = (&u[..dofs], &x[..dofs]);
            let (mut work, mut y) = (solid.workspace(), vec![0.0; dofs]);
            solid.tangent(u, &mut work, &mut y).unwrap();
            let k = dense_tangent(&solid, u);
            solid.tangent_times(&work, x, &mut y);
            assert_close(&y, &times(&k, x), 10.0 * largest(&k));
            for mass in [solid.consistent_mass(), solid.lumped_mass()] {
                let m = dense_mass(&mass);
                mass.times(x, &mut y);
                assert_close(&y, &times(&m, x), largest(&m));
                let quadratic: f64 = x.iter().zip(&y).map(|(x, y)| x * y).sum();
                prop_assert!((mass.quadratic(x) - quadratic).abs() < 1e-12 * quadratic);
            }
        }
    }

    #[test]
    fn whole_force_is_the_derivative_of_the_whole_energy(
        u in common::displacement(42, 0.05), d in common::displacement(42, 1.0),
    ) {
        let solid = mixed();
        let (mut work, mut f) = (solid.workspace(), vec![0.0; 126]);
        let mut energy = |h: f64, f: &mut [f64]| {
            let moved: Vec<f64> = u.iter().zip(&d).map(|(u, d)| u + h * d).collect();
            solid.internal_force(&moved, &mut work, f).unwrap()
        };
        let h = 1e-5;
        let difference = (energy(h, &mut f) - energy(-h, &mut f)) / (2.0 * h);
        energy(0.0, &mut f);
        let work_rate: f64 = f.iter().zip(&d).map(|(f, d)| f * d).sum();
        prop_assert!((work_rate - difference).abs() < 1e-6 * (1.0 + difference.abs()));
        // No resultant: internal forces balance.
        for i in 0..3 {
            let resultant: f64 = f.iter().skip(i).step_by(3).sum();
            prop_assert!(resultant.abs() < 1e-12);
        }
    }
}

fn bits(values: &[f64]) -> Vec<u64> {
    values.iter().map(|v| v.to_bits()).collect()
}

/// Everything that is computed in parallel, as bits.
fn everything(mesh: &Mesh) -> Vec<Vec<u64>> {
    let solid = common::solid(mesh.clone(), neo_hookean(), 1.3);
    let n = solid.dof_count();
    let u = common::wave(mesh, 0.05);
    let equation: Vec<u32> = (0..n as u32).rev().collect();
    let pattern = SymmetricPattern::new(&solid, &equation, n).unwrap();
    let (mut work, mut f, mut y) = (solid.workspace(), vec![0.0; n], vec![0.0; n]);
    let w = solid.internal_force(&u, &mut work, &mut f).unwrap();
    let mut out = vec![bits(&f), bits(&[w])];
    let w = solid.tangent(&u, &mut work, &mut f).unwrap();
    out.extend([bits(&f), bits(&[w]), bits(work.energies())]);
    let mut values = vec![0.0; pattern.nonzeros()];
    pattern.gather_tangent(&work, 0.7, &mut values);
    pattern.add_mass(&solid.consistent_mass(), 0.3, &mut values);
    out.push(bits(&values));
    solid.tangent_times(&work, &u, &mut y);
    out.push(bits(&y));
    let mass = solid.consistent_mass();
    mass.times(&u, &mut y);
    out.extend([bits(&y), bits(&[mass.quadratic(&u)])]);
    out
}

fn check_bits(mesh: &Mesh) {
    let one = common::pool(1).install(|| everything(mesh));
    for threads in [2, 8] {
        let many = common::pool(threads).install(|| everything(mesh));
        let kind = mesh.blocks[0].kind;
        assert!(one == many, "{kind:?} with {threads} threads");
    }
}

#[test]
fn same_bits_for_any_number_of_threads() {
    for kind in common::KINDS {
        check_bits(&distorted_box([12, 9, 7], kind, 0.2, true));
    }
    for kind in common::PLANE_KINDS {
        check_bits(&distorted_rectangle([25, 40], kind, 0.2, true));
    }
}

#[test]
fn bodies_are_connected_components() {
    let solid = mixed();
    let bodies: Vec<(u32, usize)> = solid.bodies().iter().map(|b| (b[0], b.len())).collect();
    assert_eq!(bodies, [(0, 18), (18, 12), (30, 12)]);
    for body in solid.bodies() {
        assert!(body.windows(2).all(|pair| pair[0] < pair[1]));
    }
}

#[test]
fn adjacency_is_the_graph_of_the_elements() {
    for solid in [mixed(), mixed_plane()] {
        check_adjacency(&solid);
    }
}

fn check_adjacency(solid: &Solid) {
    let (offsets, neighbours) = node_adjacency(solid);
    let mut expected = vec![std::collections::BTreeSet::new(); solid.node_count()];
    for block in solid.blocks() {
        for cell in block.connectivity().chunks(block.nodes_per_element()) {
            for &a in cell {
                expected[a as usize].extend(cell.iter().copied().filter(|&b| b != a));
            }
        }
    }
    for (node, expected) in expected.into_iter().enumerate() {
        let expected: Vec<u32> = expected.into_iter().collect();
        assert_eq!(neighbours[offsets[node]..offsets[node + 1]], expected);
    }
}

#[test]
fn lumped_mass_is_the_row_sum() {
    let solid = mixed();
    let (consistent, lumped) = (solid.consistent_mass(), solid.lumped_mass());
    assert!(lumped.is_diagonal() && !consistent.is_diagonal());
    assert_close(lumped.values(), &consistent.row_sums(), 1.0);
    let (mut x, mut y) = (vec![0.0; 126], vec![0.0; 126]);
    consistent.times(&[1.0; 126], &mut x);
    lumped.times(&[1.0; 126], &mut y);
    assert_close(&x, &y, 1.0);
}

#[test]
fn wrong_arrays_and_numberings_are_errors() {
    let solid = mixed();
    let (mut work, mut f) = (solid.workspace(), vec![0.0; 126]);
    let short = solid.internal_force(&[0.0; 3], &mut work, &mut f);
    assert!(matches!(
        short,
        Err(FeError::Length {
            expected: 126,
            actual: 3,
            ..
        })
    ));
    assert!(
        solid
            .tangent(&[0.0; 126], &mut work, &mut [0.0; 2])
            .is_err()
    );
    let mut equation = vec![u32::MAX; 126];
    equation[7] = 3;
    assert!(SymmetricPattern::new(&solid, &equation, 3).is_err());
    assert!(SymmetricPattern::new(&solid, &equation[1..], 4).is_err());
    equation[8] = 3;
    assert!(SymmetricPattern::new(&solid, &equation, 4).is_err());
    equation[8] = u32::MAX;
    // Equations without a degree of freedom still have their diagonal.
    let pattern = SymmetricPattern::new(&solid, &equation, 4).unwrap();
    assert_eq!(pattern.row_indices(), [0, 1, 2, 3]);
    let mut values = [f64::NAN; 4];
    solid.tangent(&[0.0; 126], &mut work, &mut f).unwrap();
    pattern.gather_tangent(&work, 1.0, &mut values);
    assert!(values[..3] == [0.0; 3] && values[3] > 0.0);
}

#[test]
fn nodes_without_block_are_an_error() {
    let mut mesh = distorted_box([1, 1, 1], CellKind::Hex8, 0.0, false);
    let other = BoxMesh::uniform([3.0; 3], [4.0; 3], [1; 3])
        .generate("other")
        .unwrap();
    mesh.append("other", other).unwrap();
    let mesh = mesh.validated().unwrap();
    let only = solid_block(&mesh, 0, blatz_ko(), 1.0).unwrap();
    assert!(matches!(
        Solid::new(mesh, vec![only]),
        Err(FeError::Mesh(_))
    ));
}
