//! The same bits for any number of threads.

use crate::common::{Run, run, scene};

fn bits(run: &Run) -> Vec<u64> {
    let last = run.last();
    let (state, report) = (&last.state, &last.report);
    let forces = report
        .interfaces
        .iter()
        .chain(&report.supports)
        .flat_map(|r| r.force.iter().chain(r.moment.iter()).copied());
    let contacts = state
        .contacts
        .iter()
        .flat_map(|c| <[f64; 3]>::from(c.force).into_iter().chain([c.gap]));
    let fields = [
        &state.u,
        &state.v,
        &state.internal_force,
        &state.support_force,
        &state.contact_force,
    ];
    fields
        .into_iter()
        .flatten()
        .copied()
        .chain([
            state.strain_energy,
            state.kinetic_energy,
            report.residual,
            report.contact_error,
        ])
        .chain(forces)
        .chain(contacts)
        .map(f64::to_bits)
        .collect()
}

fn assert_same_bits(name: &str, sets: &[&str]) {
    let with_threads = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .unwrap();
        pool.install(|| run(&scene(name, sets)))
    };
    let one = with_threads(1);
    assert!(
        one.steps.iter().any(|s| s.report.contacts_closed > 0),
        "nothing touches: the test shows too little"
    );
    for threads in [2, 8] {
        let other = with_threads(threads);
        assert_eq!(bits(&one), bits(&other), "{threads} threads");
        assert_eq!(one.counters, other.counters, "{threads} threads");
    }
}

#[test]
fn impact_is_the_same_with_any_number_of_threads() {
    assert_same_bits("impact", &["end=0.32", "mu=0.5", "output.plots=[]"]);
}

#[test]
fn twist_is_the_same_with_any_number_of_threads() {
    assert_same_bits("twist-dry", &["end=0.001", "cells=(10, 10, 4)"]);
}
