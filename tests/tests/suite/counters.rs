//! What was skipped, shown by counters. The bounds are what the code does now with a little room; lower them when it
//! does better.

use contact_bipotential::{Cone, Detector};

use crate::common::{run, scene};

#[test]
fn nothing_but_box_tests_happens_before_contact() {
    let run = run(&scene("impact", &["end=0.12", "output.plots=[]"]));
    let c = &run.counters;
    // One factor a body, to learn how large round-off may be.
    assert!(c.newton_iterations <= 1 && c.factorizations <= 2, "{c:?}");
    assert_eq!(
        (
            c.condensations,
            c.contact_solves,
            c.contact_iterations,
            c.contacts_max
        ),
        (0, 0, 0, 0)
    );
    assert_eq!(c.force_evaluations, c.steps + c.newton_iterations);
    assert_eq!(c.detections, c.force_evaluations);
    let model = &run.built.model;
    let at_rest = model.positions(&vec![0.0; model.dof_count()]);
    let mut detector = Detector::new(model.interfaces.clone(), &at_rest, 3, Cone::Spatial).unwrap();
    // Far means farther than the search distance; the block moves up here.
    let mut far = vec![0.0; model.dof_count()];
    model.interfaces[0]
        .slave
        .iter()
        .for_each(|&n| far[3 * n as usize + 2] = 2.0);
    let before = detector.counters();
    assert!(
        detector
            .detect(&model.positions(&far), 0.0, 0.1)
            .contacts
            .is_empty()
    );
    let after = detector.counters();
    assert_eq!(after.facet_projections, before.facet_projections);
    assert_eq!(after.box_rejections, before.box_rejections + 1);
}

#[test]
fn a_frictionless_run_has_one_row_a_contact() {
    let run = run(&scene("impact", &["mu=0", "end=0.4", "output.plots=[]"]));
    let contacts = run.steps.iter().flat_map(|s| &s.state.contacts);
    let pressed: Vec<_> = contacts.filter(|c| c.force[2] > 0.0).collect();
    assert!(!pressed.is_empty());
    // The block slides at 1.5 m/s; the slip of a contact is zero only because its row does not exist.
    assert!(
        pressed
            .iter()
            .all(|c| c.slip == [0.0; 2] && c.force[0] == 0.0 && c.force[1] == 0.0)
    );
}

#[test]
fn impact_does_not_do_more_than_it_did() {
    let position = run(&scene("impact", &[])).counters;
    assert!(position.newton_iterations <= 570, "{position:?}");
    // Fewer than steps and a few for each of the contacts that open and close.
    assert!(position.factorizations <= 125, "{position:?}");
    assert!(position.contact_solves <= 370, "{position:?}");
    assert_eq!(position.contacts_max, 25);
    assert_eq!(position.indefinite_tangents, 0);
    let velocity = run(&scene("impact", &["contact=Velocity"])).counters;
    assert!(velocity.newton_iterations <= 490, "{velocity:?}");
    assert!(velocity.factorizations <= 100, "{velocity:?}");
    // Moreau-Jean looks for contacts once before a step, and for the gaps after it where any was found.
    assert!(velocity.detections <= 2 * velocity.steps, "{velocity:?}");
}

#[test]
fn contact_work_is_done_only_while_something_touches() {
    let run = run(&scene("impact", &[]));
    let mut before = nscd::Counters::default();
    for step in &run.steps {
        let now = step.counters;
        if step.report.time < 0.25 - 1e-9 {
            assert_eq!(now.contact_solves, 0);
        }
        // A step with no pressed node at either end and all gaps wide open solves no contact problem.
        let wide = step
            .state
            .contacts
            .iter()
            .all(|c| c.gap > 0.05 && c.force[2] == 0.0);
        if wide && step.report.time > 0.8 {
            assert_eq!(
                now.contact_solves, before.contact_solves,
                "t = {}",
                step.report.time
            );
            assert_eq!(
                now.condensations, before.condensations,
                "t = {}",
                step.report.time
            );
        }
        before = now;
    }
}
