//! Times of the contact solver alone: `cargo bench -p benches --bench contact`.

#![allow(clippy::unwrap_used, reason = "a bench may panic")]
#![allow(
    missing_docs,
    reason = "the macros of criterion write undocumented functions"
)]

use std::hint::black_box;
use std::time::Duration;

use contact_bipotential::conformance::{brick_wall, half_space};
use contact_bipotential::{
    ContactProblem, Method, SequenceSolver, SingleContact, SolveSettings, Status, solve,
    solve_single,
};
use criterion::measurement::WallTime;
use criterion::{
    BatchSize, BenchmarkGroup, BenchmarkId, Criterion, Throughput, criterion_group, criterion_main,
};
use nalgebra::{Matrix3, Vector3};
use nscd::{NoClock, Stepper};

/// Compliance of the single contact \[-\].
const W: Matrix3<f64> = Matrix3::new(2.0, 0.1, 0.2, 0.1, 1.5, -0.1, 0.2, -0.1, 1.0);
const MU: f64 = 0.4;
/// Sweeps of one measurement of the cost of a sweep: enough to hide what comes before and after.
const SWEEPS: usize = 50;

/// A full-rank problem, as finite elements make it.
fn indenter(side: usize) -> ContactProblem {
    half_space(side, MU, 1e-2, 3e-3)
}

/// Four unknowns for each degree of freedom of the bricks.
fn wall(rows: usize, columns: usize) -> ContactProblem {
    brick_wall(rows, columns, 0.6, 0.5)
}

fn with(method: Method) -> SolveSettings {
    SolveSettings::default().with_method(method)
}

fn group<'a>(c: &'a mut Criterion, name: &str) -> BenchmarkGroup<'a, WallTime> {
    let mut group = c.benchmark_group(name);
    group
        .sample_size(10)
        .warm_up_time(Duration::from_millis(500))
        .measurement_time(Duration::from_secs(2));
    group
}

fn single(c: &mut Criterion) {
    let contact = SingleContact::new(&W);
    let mut group = c.benchmark_group("single");
    for (status, b) in [
        (Status::Separate, [0.3, 0.1, 0.5]),
        (Status::Stick, [0.01, 0.02, -1.0]),
        (Status::Slip, [2.0, -1.0, -0.5]),
    ] {
        let b = Vector3::from(b);
        assert_eq!(contact.solve(&b, MU).status, status);
        group.bench_function(BenchmarkId::new("prepared", format!("{status:?}")), |t| {
            t.iter(|| contact.solve(black_box(&b), MU));
        });
        group.bench_function(BenchmarkId::new("unprepared", format!("{status:?}")), |t| {
            t.iter(|| solve_single(black_box(&W), black_box(&b), MU));
        });
    }
    // Of one contact the processor soon knows the branches; of many in no order it does not.
    let many: Vec<Vector3<f64>> = (0..4096)
        .map(|k| Vector3::new(1.0, 2.3, 3.7).map(|f| (f64::from(k) * f + f).sin()))
        .collect();
    group.throughput(Throughput::Elements(many.len() as u64));
    group.bench_function("prepared/mixed", |t| {
        t.iter(|| {
            let solved = many.iter().map(|b| contact.solve(black_box(b), MU).r[2]);
            solved.sum::<f64>()
        });
    });
    group.finish();
}

/// Time by contact and sweep: that of a dense `W` grows with the contacts, that of a sparse one does not.
fn sweep(c: &mut Criterion) {
    let mut group = group(c, "sweep");
    for (name, problem) in [
        ("half-space", indenter(3)),
        ("half-space", indenter(10)),
        ("half-space", indenter(20)),
        ("wall", wall(4, 3)),
        ("wall", wall(11, 11)),
    ] {
        for method in [
            Method::GaussSeidel,
            Method::GaussSeidelBipotential,
            Method::JoliFeng,
        ] {
            let settings = with(method).with_tolerance(0.0).with_max_iterations(SWEEPS);
            let sweeps = solve(&problem, &mut Vec::new(), &settings).work.sweeps;
            group.throughput(Throughput::Elements((sweeps * problem.contacts()) as u64));
            let id = format!("{name}/{}", method.name());
            group.bench_function(BenchmarkId::new(id, problem.contacts()), |t| {
                t.iter(|| solve(black_box(&problem), &mut Vec::new(), &settings));
            });
        }
    }
    group.finish();
}

fn cold(
    group: &mut BenchmarkGroup<'_, WallTime>,
    id: BenchmarkId,
    problem: &ContactProblem,
    settings: &SolveSettings,
) {
    // The time of a failure says nothing.
    let outcome = solve(problem, &mut Vec::new(), settings);
    if !outcome.is_converged() {
        let (name, error) = (settings.method.name(), outcome.error_scale_free);
        println!("{name} leaves an error of {error:.0e}: left out");
        return;
    }
    group.bench_function(id, |t| {
        t.iter(|| solve(black_box(problem), &mut Vec::new(), settings));
    });
}

fn whole(c: &mut Criterion) {
    let mut group = group(c, "whole");
    for side in [3, 10, 31] {
        let problem = indenter(side);
        let id = BenchmarkId::new("half-space", problem.contacts());
        cold(&mut group, id, &problem, &SolveSettings::default());
    }
    for (rows, columns) in [(2, 1), (4, 3), (11, 11)] {
        let problem = wall(rows, columns);
        let id = BenchmarkId::new("wall", problem.contacts());
        cold(&mut group, id, &problem, &SolveSettings::default());
    }
    group.finish();
}

fn methods(c: &mut Criterion) {
    let mut group = group(c, "methods");
    for (name, problem) in [("half-space", indenter(10)), ("wall", wall(4, 3))] {
        for method in Method::ALL {
            let id = BenchmarkId::new(name, method.name());
            cold(&mut group, id, &problem, &with(method));
        }
    }
    group.finish();
}

/// From zero, from the solution of the problem before, and with its factors too.
fn starts(
    group: &mut BenchmarkGroup<'_, WallTime>,
    name: &str,
    before: &ContactProblem,
    problem: &ContactProblem,
) {
    let settings = SolveSettings::default();
    let (mut start, mut sequence) = (vec![0.0; before.q.len()], SequenceSolver::default());
    assert!(
        sequence
            .solve(before, &[], &mut start, &settings)
            .is_converged()
    );
    cold(group, BenchmarkId::new(name, "cold"), problem, &settings);
    group.bench_function(BenchmarkId::new(name, "warm"), |t| {
        let solve = |mut r| solve(black_box(problem), &mut r, &settings);
        t.iter_batched(|| start.clone(), solve, BatchSize::SmallInput);
    });
    group.bench_function(BenchmarkId::new(name, "sequence"), |t| {
        let solve = |mut r| sequence.solve(black_box(problem), &[], &mut r, &settings);
        t.iter_batched(|| start.clone(), solve, BatchSize::SmallInput);
    });
}

/// Problems of two successive steps of `press-twist` on a coarse mesh, when the block turns.
fn press_twist() -> (ContactProblem, ContactProblem) {
    let coarse = "cells=(10, 10, 3)".parse().unwrap();
    let loaded = scenarios::catalog::load("press-twist", &[coarse]).unwrap();
    let built = scenarios::build(&loaded).unwrap();
    let mut stepper = Stepper::new(&built.model, Box::new(NoClock)).unwrap();
    let mut state = stepper.initial_state(built.velocity.clone()).unwrap();
    let mut advance = |steps| {
        for _ in 0..steps {
            state = stepper.step(&state, 1.0).unwrap().0;
        }
        stepper.last_contact_problem().unwrap()
    };
    (advance(14), advance(1))
}

fn start(c: &mut Criterion) {
    let mut group = group(c, "start");
    let before = indenter(10);
    starts(
        &mut group,
        "half-space",
        &before,
        &half_space(10, MU, 1.03e-2, 3.3e-3),
    );
    let (before, problem) = press_twist();
    starts(&mut group, "press-twist", &before, &problem);
    group.finish();
}

criterion_group!(benches, single, sweep, whole, methods, start);
criterion_main!(benches);
