//! Rubber block pressed on a rough plane and turned: two independent codes give 19.33-19.37 N and 29.03-29.04 N mm.

use crate::common::{Run, run, scene};

fn resultants(run: &Run) -> (f64, f64) {
    let ground = &run.last().report.interfaces[0];
    (ground.force[2], ground.moment[2].abs() * 1e3)
}

#[test]
fn force_and_moment_are_those_of_two_other_codes() {
    let run = run(&scene("press-twist", &[]));
    run.assert_audited(1e-3, 1e-9);
    let (force, moment) = resultants(&run);
    assert!((force / 19.35 - 1.0).abs() < 5e-3, "{force} N");
    assert!((moment / 29.035 - 1.0).abs() < 5e-3, "{moment} N mm");
}

#[test]
fn a_coarse_block_closes_its_audit_and_balances_its_support() {
    let run = run(&scene("press-twist", &["cells=(8, 8, 3)"]));
    let scale = run.totals.energy.load_work;
    run.assert_audited(scale, 1e-9);
    for step in &run.steps {
        let (ground, top) = (&step.report.interfaces[0], &step.report.supports[0]);
        for c in 0..3 {
            let force = ground.force[c] + top.force[c];
            let moment = ground.moment[c] + top.moment[c];
            assert!(
                force.abs() < 1e-9 * 20.0,
                "t = {}: {force:e} N",
                step.report.time
            );
            assert!(
                moment.abs() < 1e-9 * 0.03,
                "t = {}: {moment:e} N m",
                step.report.time
            );
        }
        assert!(step.report.energy.friction >= -1e-12 * scale);
    }
    // Coarser is stiffer, by a few percent here.
    let (force, moment) = resultants(&run);
    assert!(
        (1.0..1.05).contains(&(force / 19.35)) && (1.0..1.10).contains(&(moment / 29.035)),
        "{force} N, {moment} N mm"
    );
}
