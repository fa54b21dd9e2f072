//! An elastic bar against a rigid wall: contact force 1 N for 2 s, exactly.
//!
//! 100 elements, lumped mass, step `h/2c`, gap zero at the start. The rows of the table come from an independent
//! one-dimensional program.

use crate::common::{Run, run, scene, statistics};

const E0: f64 = 5e-5;

fn bar(sets: &[&str]) -> Run {
    let touching = ["mass=Lumped", "wall.master.point=(0, 0, 0)"];
    let run = run(&scene("bar-impact", &[&touching, sets].concat()));
    run.assert_audited(E0, 1e-9);
    assert!((run.totals.initial_energy - E0).abs() < 1e-12 * E0);
    run
}

struct Row {
    energy: f64,
    contact_time: f64,
    mean: f64,
    deviation: f64,
}

fn row(run: &Run) -> Row {
    let last_closed = run
        .steps
        .iter()
        .rev()
        .find(|s| s.report.interfaces[0].force[0] > 1e-6)
        .unwrap();
    let plateau: Vec<f64> = run
        .steps
        .iter()
        .filter(|s| (0.2..=1.8).contains(&s.report.time))
        .map(|s| s.report.interfaces[0].force[0])
        .collect();
    let (mean, deviation) = statistics(&plateau);
    Row {
        energy: run.last().energy() / E0,
        contact_time: last_closed.report.time,
        mean,
        deviation,
    }
}

fn assert_row(found: &Row, expected: &Row, slack: [f64; 4]) {
    let values = [
        ("E_end/E0", found.energy, expected.energy),
        ("contact time", found.contact_time, expected.contact_time),
        ("mean force", found.mean, expected.mean),
        ("deviation", found.deviation, expected.deviation),
    ];
    for ((name, found, expected), slack) in values.into_iter().zip(slack) {
        assert!(
            (found - expected).abs() <= slack,
            "{name} {found}, expected {expected} within {slack}"
        );
    }
}

#[test]
fn position_level_with_the_trapezoid_chatters() {
    let expected = Row {
        energy: 0.993,
        contact_time: 2.015,
        mean: 1.003,
        deviation: 0.88,
    };
    assert_row(
        &row(&bar(&["contact=Position"])),
        &expected,
        [1e-3, 6e-3, 2e-3, 0.02],
    );
}

#[test]
fn backward_euler_is_calm_and_loses_energy() {
    let expected = Row {
        energy: 0.873,
        contact_time: 2.005,
        mean: 0.999,
        deviation: 0.005,
    };
    assert_row(
        &row(&bar(&["contact=Position", "theta=1", "xi=1"])),
        &expected,
        [2e-3, 6e-3, 1e-3, 2e-3],
    );
}

#[test]
fn velocity_level_is_calm_and_keeps_the_energy() {
    let expected = Row {
        energy: 0.994,
        contact_time: 2.015,
        mean: 1.000,
        deviation: 0.001,
    };
    assert_row(&row(&bar(&[])), &expected, [1e-3, 6e-3, 1e-3, 1e-3]);
}

#[test]
fn the_bar_flies_back_as_fast_as_it_came() {
    let run = bar(&[]);
    let velocity = run.momentum(&run.last().state)[0] / run.built.model.mass.total();
    assert!(
        (velocity - 1e-4).abs() < 0.02e-4,
        "mean velocity {velocity} m/s"
    );
}
