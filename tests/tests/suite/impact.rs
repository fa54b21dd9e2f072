//! Oblique impact of two soft blocks [Feng2007, 4.2].

use contact_bipotential::{Cone, Detector};

use crate::common::{Run, chatter, run, scene};

/// Kinetic energy at the start \[J\]: a block of 1 m^3 and 100 kg/m^3 at (0, 1.5, -1) m/s.
const E0: f64 = 162.5;

fn impact(sets: &[&str]) -> Run {
    // The pictures ask for times that a shorter run does not reach.
    run(&scene("impact", &[&["output.plots=[]"], sets].concat()))
}

/// What holds for every friction coefficient and both contact levels.
fn assert_sound(run: &Run) {
    assert!((run.totals.initial_energy - E0).abs() < 1e-10 * E0);
    run.assert_audited(E0, 1e-9);
    for step in &run.steps {
        let (t, report) = (step.report.time, &step.report);
        // Free flight has no force to compare a residual with, and the last touch hardly any.
        if report.contacts_closed > 0 {
            assert!(
                report.residual <= 1e-10,
                "t = {t}: residual {:e}",
                report.residual
            );
        }
        assert!(
            report.energy.friction >= -1e-12 * E0,
            "t = {t}: friction gives {:e} J",
            report.energy.friction
        );
    }
    assert!(
        (first_contact(run) - 0.25).abs() < 1e-9,
        "first contact at {}",
        first_contact(run)
    );
    let gained = run.last().energy() - E0;
    assert!(
        gained <= -run.totals.energy.integration_error().min(0.0),
        "gains {gained} J"
    );
}

/// End of the first step in which a gap is closed. The blocks fly up to each other in whole steps, so that the gap of
/// that step is round-off, and whether the position level sees a force already is a matter of its sign.
fn first_contact(run: &Run) -> f64 {
    let closed = |s: &&crate::common::Step| {
        s.report.contacts_closed > 0 || s.state.contacts.iter().any(|c| c.gap < 1e-10)
    };
    run.steps.iter().find(closed).unwrap().report.time
}

fn lost(run: &Run) -> f64 {
    E0 - run.last().energy()
}

#[test]
fn position_level_converges_and_closes_its_audit_for_all_friction_coefficients() {
    let runs: Vec<Run> = ["mu=0", "mu=0.2", "mu=0.5", "mu=0.8"]
        .iter()
        .map(|mu| impact(&[mu]))
        .collect();
    for run in &runs {
        assert_sound(run);
        assert!(
            run.totals.max_penetration < 1e-10,
            "penetration {:e} m",
            run.totals.max_penetration
        );
        // The energy never rises above the start by more than what the audit books as integration error so far.
        let mut booked = 0.0;
        for step in &run.steps {
            booked += step.report.energy.integration_error();
            let gain = step.energy() - E0;
            assert!(
                gain <= -booked.min(0.0) + 1e-9 * E0,
                "t = {}: {gain} J against {booked} J",
                step.report.time
            );
        }
    }
    let friction: Vec<f64> = runs.iter().map(|r| r.totals.energy.friction).collect();
    assert_eq!(friction[0], 0.0);
    assert!(
        friction[1] > 1.0 && friction[3] < friction[1],
        "friction dissipates {friction:?} J"
    );
    let share = lost(&runs[0]) / E0;
    assert!(
        (0.0..0.03).contains(&share),
        "{share} of the energy is lost without friction"
    );
}

#[test]
fn first_contact_is_in_the_step_that_reaches_a_quarter_second_at_other_steps_too() {
    let run = impact(&["mu=0.5", "dt=0.005", "end=0.3"]);
    assert!(
        (first_contact(&run) - 0.25).abs() < 1e-9,
        "first contact at {}",
        first_contact(&run)
    );
}

#[test]
fn velocity_level_is_free_of_the_two_step_chatter() {
    let loaded = |level: &str| impact(&["mu=0.2", "end=0.65", level]);
    let (position, velocity) = (loaded("contact=Position"), loaded("contact=Velocity"));
    assert_sound(&velocity);
    let (rough, smooth) = (
        chatter(&position.contact_force(2)),
        chatter(&velocity.contact_force(2)),
    );
    assert!(
        smooth < 0.25 * rough,
        "second differences sum to {smooth} N, {rough} N at the position level"
    );
    // The impulse is what both must agree on.
    let impulse = |run: &Run| {
        run.steps
            .iter()
            .map(|s| s.report.dt * s.report.interfaces[0].force[2])
            .sum::<f64>()
    };
    let (a, b) = (impulse(&position), impulse(&velocity));
    assert!((a - b).abs() < 0.03 * a.abs(), "impulses {a} and {b} N s");
}

#[test]
fn velocity_level_penetrates_by_less_than_a_step_of_travel() {
    let run = impact(&["mu=0.2", "contact=Velocity"]);
    let model = &run.built.model;
    let at_rest = model.positions(&vec![0.0; model.dof_count()]);
    let mut detector = Detector::new(model.interfaces.clone(), &at_rest, 3, Cone::Spatial).unwrap();
    for step in &run.steps {
        let t = step.report.time;
        let map = detector.detect(&model.positions(&step.state.u), t, t);
        let deepest = map.contacts.iter().map(|c| -c.gap).fold(0.0, f64::max);
        // The block comes down at 1 m/s: a closing step can leave no more than its own travel.
        assert!(deepest < 0.01, "t = {t}: {deepest} m deep");
    }
}

#[test]
fn velocity_level_reports_the_gap_at_the_end_of_the_step() {
    let run = impact(&["mu=0.2", "contact=Velocity", "end=0.25"]);
    let model = &run.built.model;
    let at_rest = model.positions(&vec![0.0; model.dof_count()]);
    let mut detector = Detector::new(model.interfaces.clone(), &at_rest, 3, Cone::Spatial).unwrap();
    let step = run.last();
    let map = detector.detect(
        &model.positions(&step.state.u),
        step.report.time,
        step.report.time,
    );
    assert!(!step.state.contacts.is_empty());
    for contact in &step.state.contacts {
        let exact = map
            .contacts
            .iter()
            .find(|c| c.slave == contact.node)
            .unwrap()
            .gap;
        assert!(
            (contact.gap - exact).abs() < 1e-4,
            "node {}: {} m, reported {} m",
            contact.node,
            exact,
            contact.gap
        );
    }
}

#[test]
#[ignore = "half a minute in release; cargo test --release -p tests -- --ignored refined_together"]
fn frictionless_loss_shrinks_when_mesh_and_step_are_refined_together() {
    let coarse = lost(&impact(&["mu=0"]));
    let fine = lost(&impact(&["mu=0", "refine=2", "dt=0.005"]));
    assert!(
        fine < coarse && coarse < 0.03 * E0,
        "lost {coarse} J, refined {fine} J"
    );
}

#[test]
fn contact_force_balances_the_support_and_the_momentum() {
    let run = impact(&["mu=0.5", "end=0.5"]);
    let mut before = run.momentum(&run.start);
    for step in &run.steps {
        let after = run.momentum(&step.state);
        for c in 0..3 {
            // Contact forces are internal; the base is all that changes the total momentum. Its own nodes carry mass
            // but are held, so that their inertia is part of the support force.
            let impulse = step.report.dt * step.report.supports[0].force[c];
            let miss = after[c] - before[c] - impulse;
            assert!(
                miss.abs() < 1e-8 * 150.0,
                "t = {}: {miss:e} N s of {impulse:e}",
                step.report.time
            );
        }
        before = after;
    }
}
