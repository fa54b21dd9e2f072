//! Time per element of the kernels on one thread. Run with
//! `cargo test --release -p fe-core --test kernel_speed -- --ignored --nocapture`.

#![allow(clippy::unwrap_used, reason = "a measurement may panic")]

use std::time::Instant;

use fe_core::{Block, tangent_len};
use fe_core::{BoxMesh, CellKind, RectangleMesh, Solid, SymmetricPattern, Symmetry, solid_block};
use hyperelastic::{BlatzKo, ElasticConstants, Material, NeoHookean, SaintVenantKirchhoff};
use nalgebra::Vector3;

const REPEATS: usize = 200;

/// Shortest time of some repetitions, in ns per item.
fn best(items: usize, mut run: impl FnMut()) -> f64 {
    let times = (0..REPEATS).map(|_| {
        let start = Instant::now();
        run();
        start.elapsed().as_secs_f64()
    });
    times.fold(f64::INFINITY, f64::min) * 1e9 / items as f64
}

fn block<M: Material>(kind: CellKind, material: M) -> (Box<dyn Block>, Vec<f64>) {
    let mesh = BoxMesh::uniform([0.0; 3], [1.0; 3], [8 / kind.degree(); 3])
        .with_kind(kind)
        .generate("box")
        .unwrap();
    let wave = |x: &Vector3<f64>| {
        [
            0.05 * (x[1] * 3.0).sin(),
            0.04 * (x[2] * 2.0).cos(),
            0.03 * x[0] * x[1],
        ]
    };
    let u = mesh.points.iter().flat_map(wave).collect();
    let mesh = mesh.validated().unwrap();
    (solid_block(&mesh, 0, material, 1.0).unwrap(), u)
}

fn plane_block<M: Material>(
    kind: CellKind,
    symmetry: Symmetry,
    material: M,
) -> (Box<dyn Block>, Vec<f64>) {
    let mut mesh = RectangleMesh::uniform([0.0; 2], [1.0; 2], [24 / kind.degree(); 2])
        .with_kind(kind)
        .generate("plate")
        .unwrap();
    mesh.symmetry = symmetry;
    let wave = |x: &Vector3<f64>| [0.05 * x[0] * (x[1] * 3.0).sin(), 0.04 * (x[0] * 2.0).cos()];
    let u = mesh.points.iter().flat_map(wave).collect();
    let mesh = mesh.validated().unwrap();
    (solid_block(&mesh, 0, material, 1.0).unwrap(), u)
}

fn measure<M: Material>(name: &str, kind: CellKind, material: M) {
    let (block, u) = block(kind, material);
    measure_block(&format!("{name}, {kind:?}"), block.as_ref(), &u);
}

fn measure_block(name: &str, block: &dyn Block, u: &[f64]) {
    let dim = block.dim();
    let (count, nodes) = (block.element_count(), block.nodes_per_element());
    let mut forces = vec![0.0; dim * nodes * count];
    let mut energies = vec![0.0; count];
    let mut tangents = vec![0.0; tangent_len(dim, nodes) * count];
    let force = best(count, || {
        block.internal_force(u, &mut forces, &mut energies).unwrap();
    });
    let tangent = best(count, || {
        block
            .tangent(u, &mut forces, &mut energies, &mut tangents)
            .unwrap();
    });
    println!("{name:36}: force {force:7.0} ns, tangent {tangent:7.0} ns per element");
}

#[test]
#[ignore = "a measurement"]
fn kernels() {
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(1)
        .build()
        .unwrap();
    let elastic = ElasticConstants::from_shear_lame(1.0, 1.0).unwrap();
    pool.install(|| {
        for kind in [
            CellKind::Hex8,
            CellKind::Tet4,
            CellKind::Hex27,
            CellKind::Tet10,
        ] {
            measure("Blatz-Ko", kind, BlatzKo::new(1.0).unwrap());
            measure("neo-Hookean", kind, NeoHookean::new(elastic).unwrap());
            measure(
                "Saint Venant-Kirchhoff",
                kind,
                SaintVenantKirchhoff::new(elastic).unwrap(),
            );
        }
    });
}

#[test]
#[ignore = "a measurement"]
fn plane_kernels() {
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(1)
        .build()
        .unwrap();
    let elastic = ElasticConstants::from_shear_lame(1.0, 1.0).unwrap();
    pool.install(|| {
        for kind in [
            CellKind::Quad4,
            CellKind::Tri3,
            CellKind::Quad9,
            CellKind::Tri6,
        ] {
            for symmetry in [Symmetry::PlaneStrain, Symmetry::Axisymmetric] {
                let name = |law: &str| format!("{law}, {kind:?}, {symmetry:?}");
                let (block, u) = plane_block(kind, symmetry, BlatzKo::new(1.0).unwrap());
                measure_block(&name("Blatz-Ko"), block.as_ref(), &u);
                let law = SaintVenantKirchhoff::new(elastic).unwrap();
                let (block, u) = plane_block(kind, symmetry, law);
                measure_block(&name("Saint Venant"), block.as_ref(), &u);
            }
        }
    });
}

#[test]
#[ignore = "a measurement"]
fn assembly() {
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(1)
        .build()
        .unwrap();
    pool.install(|| {
        let mesh = BoxMesh::uniform([0.0; 3], [0.01, 0.01, 0.003], [20, 20, 6])
            .generate("box")
            .unwrap();
        let mesh = mesh.validated().unwrap();
        let block = solid_block(&mesh, 0, BlatzKo::new(1.0).unwrap(), 1.0).unwrap();
        let solid = Solid::new(mesh, vec![block]).unwrap();
        let n = solid.dof_count();
        let equation: Vec<u32> = (0..n as u32).collect();
        let (u, mut f, mut y) = (vec![0.0; n], vec![0.0; n], vec![0.0; n]);
        let mut work = solid.workspace();
        let ms = |run: &mut dyn FnMut()| best(1_000_000, run);
        let pattern_time = ms(&mut || {
            SymmetricPattern::new(&solid, &equation, n).unwrap();
        });
        let pattern = SymmetricPattern::new(&solid, &equation, n).unwrap();
        let mut values = vec![0.0; pattern.nonzeros()];
        let force = ms(&mut || {
            solid.internal_force(&u, &mut work, &mut f).unwrap();
        });
        let tangent = ms(&mut || {
            solid.tangent(&u, &mut work, &mut f).unwrap();
        });
        let gather = ms(&mut || pattern.gather_tangent(&work, 1.0, &mut values));
        let times = ms(&mut || solid.tangent_times(&work, &u, &mut y));
        let mass = solid.consistent_mass();
        let add_mass = ms(&mut || pattern.add_mass(&mass, 1.0, &mut values));
        let mass_times = ms(&mut || mass.times(&u, &mut y));
        println!(
            "{} elements, {} nonzeros, times in ms",
            solid.element_count(),
            values.len()
        );
        println!(
            "pattern {pattern_time:.2}, force {force:.2}, tangent {tangent:.2}, gather {gather:.2}"
        );
        println!("K x {times:.2}, add mass {add_mass:.2}, M v {mass_times:.2}");
    });
}
