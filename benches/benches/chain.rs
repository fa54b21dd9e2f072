//! Times of the parts of a step: `cargo bench -p benches`.

#![allow(clippy::unwrap_used, reason = "a bench may panic")]
#![allow(
    missing_docs,
    reason = "the macros of criterion write undocumented functions"
)]

use std::hint::black_box;
use std::time::Duration;

use contact_bipotential::conformance::half_space;
use contact_bipotential::{Method, SingleContact, SolveSettings, solve};
use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use fe_core::tangent_len;
use fe_core::{BoxMesh, Solid, SymmetricPattern, ValidMesh, solid_block};
use hyperelastic::{
    BlatzKo, ElasticConstants, Material, NeoHookean, SaintVenantKirchhoff, Symmetric, ThreeE,
};
use nalgebra::{Matrix3, Vector3};
use nscd::{NoClock, Stepper};

fn mesh() -> (ValidMesh, Vec<f64>) {
    let mesh = BoxMesh::uniform([0.0; 3], [1.0; 3], [8; 3])
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
    (mesh.validated().unwrap(), u)
}

fn elastic() -> ElasticConstants {
    ElasticConstants::from_shear_lame(1.0, 1.0).unwrap()
}

fn kernel<M: Material>(c: &mut Criterion, name: &str, material: M) {
    let (mesh, u) = mesh();
    let block = solid_block(&mesh, 0, material, 1.0).unwrap();
    let (count, nodes) = (block.element_count(), block.nodes_per_element());
    let mut forces = vec![0.0; 3 * nodes * count];
    let mut energies = vec![0.0; count];
    let mut tangents = vec![0.0; tangent_len(3, nodes) * count];
    let mut group = c.benchmark_group("hex8");
    group.throughput(Throughput::Elements(count as u64));
    group.bench_function(BenchmarkId::new("force", name), |b| {
        b.iter(|| {
            block
                .internal_force(black_box(&u), &mut forces, &mut energies)
                .unwrap()
        });
    });
    group.bench_function(BenchmarkId::new("tangent", name), |b| {
        b.iter(|| {
            block
                .tangent(black_box(&u), &mut forces, &mut energies, &mut tangents)
                .unwrap()
        });
    });
}

/// Stress, and stress with tangent, of a law at one material point.
fn material_point<M: Material>(c: &mut Criterion, name: &str, material: M) {
    let stretch = Symmetric::new(1.3, 0.9, 1.1, 0.2, -0.1, 0.15);
    let mut group = c.benchmark_group("law");
    group.bench_function(BenchmarkId::new("stress", name), |b| {
        b.iter(|| material.stress(black_box(&stretch)).unwrap());
    });
    group.bench_function(BenchmarkId::new("response", name), |b| {
        b.iter(|| material.response(black_box(&stretch)).unwrap());
    });
}

fn each_law<M: Material>(c: &mut Criterion, name: &str, material: M) {
    material_point(c, name, material.clone());
    kernel(c, name, material);
}

fn laws_and_kernels(c: &mut Criterion) {
    let three_e = ThreeE::new(elastic(), [0.01, 0.01, 0.0, 0.1, 0.01]).unwrap();
    each_law(
        c,
        "Saint Venant-Kirchhoff",
        SaintVenantKirchhoff::new(elastic()).unwrap(),
    );
    each_law(c, "3e", three_e);
    each_law(c, "Blatz-Ko", BlatzKo::new(1.0).unwrap());
    each_law(c, "neo-Hookean", NeoHookean::new(elastic()).unwrap());
}

fn assembly(c: &mut Criterion) {
    let (mesh, u) = mesh();
    let block = solid_block(&mesh, 0, NeoHookean::new(elastic()).unwrap(), 1.0).unwrap();
    let solid = Solid::new(mesh, vec![block]).unwrap();
    let n = solid.dof_count();
    let equations: Vec<u32> = (0..n as u32).collect();
    let pattern = SymmetricPattern::new(&solid, &equations, n).unwrap();
    let (mut work, mut f) = (solid.workspace(), vec![0.0; n]);
    solid.tangent(&u, &mut work, &mut f).unwrap();
    let mut values = vec![0.0; pattern.nonzeros()];
    c.bench_function("assembly/gather tangent", |b| {
        b.iter(|| pattern.gather_tangent(black_box(&work), 1.0, &mut values));
    });
    c.bench_function("assembly/internal force", |b| {
        b.iter(|| {
            solid
                .internal_force(black_box(&u), &mut work, &mut f)
                .unwrap()
        });
    });
}

fn single(c: &mut Criterion) {
    let contact = SingleContact::new(&Matrix3::new(2.0, 0.1, 0.2, 0.1, 1.5, -0.1, 0.2, -0.1, 1.0));
    for (status, q) in [
        ("separate", [0.3, 0.1, 0.5]),
        ("stick", [0.01, 0.02, -1.0]),
        ("slip", [2.0, -1.0, -0.5]),
    ] {
        let q = Vector3::from(q);
        c.bench_function(&format!("single contact/{status}"), |b| {
            b.iter(|| contact.solve(black_box(&q), 0.4))
        });
    }
}

fn contact(c: &mut Criterion) {
    let mut group = c.benchmark_group("contacts");
    group
        .sample_size(10)
        .measurement_time(Duration::from_secs(3));
    for side in [3, 10, 20] {
        let problem = half_space(side, 0.4, 1.0, 0.3);
        let runs = [
            ("sweep", Method::GaussSeidel, 1),
            ("solve", Method::Auto, 20_000),
        ];
        for (name, method, max_iterations) in runs {
            let settings = SolveSettings::default()
                .with_method(method)
                .with_max_iterations(max_iterations);
            group.bench_function(BenchmarkId::new(name, problem.contacts()), |b| {
                b.iter(|| {
                    let mut r = Vec::new();
                    solve(black_box(&problem), &mut r, &settings)
                });
            });
        }
    }
}

/// A step of `impact` in full contact, with the factors that the steps before have left.
fn step(c: &mut Criterion) {
    let loaded = scenarios::catalog::load("impact", &[]).unwrap();
    let built = scenarios::build(&loaded).unwrap();
    let mut stepper = Stepper::new(&built.model, Box::new(NoClock)).unwrap();
    let mut state = stepper.initial_state(built.velocity.clone()).unwrap();
    for _ in 0..35 {
        state = stepper.step(&state, 0.01).unwrap().0;
    }
    let mut group = c.benchmark_group("step");
    group.sample_size(20);
    group.bench_function("impact", |b| {
        b.iter(|| stepper.step(black_box(&state), 0.01).unwrap())
    });
}

criterion_group!(benches, laws_and_kernels, assembly, single, contact, step);
criterion_main!(benches);
