//! Bonds against closed forms, on meshes that take seconds.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

use tests::cases::adhesion::{self, HALF_SPACE, LARGE, SMALL};
use tests::closed_form::{DMT, JKR, maugis_dugdale};
use tests::curve::peak;
use tests::{Plan, compute};

/// The pull-off force falls from DMT towards JKR, above Maugis's since the bonds' stress has a tail; at the small end
/// it is within 1 % of -2 pi w R, and everywhere of an independent computation.
#[test]
fn the_pull_off_of_a_ball_goes_from_dmt_towards_jkr() {
    let mut last = DMT;
    let wide = "mesh.x=(from: 0.0, pieces: [Cells(to: 2.5e-3, cells: 40), Growing(to: 22.0e-3, growth: 1.08)])";
    let fine = "mesh.x=(from: 0.0, pieces: [Cells(to: 1.12e-3, cells: 50), Growing(to: 22.0e-3, growth: 1.1)])";
    let meshes = [SMALL[1], wide, wide, fine];
    for ((lambda, exact), mesh) in HALF_SPACE.iter().zip(meshes) {
        let stiffness = format!("C_n={:e}", 3.391e9 * lambda * lambda);
        let sets = [&stiffness, mesh, "time.dt=0.05", "time.end=2.0"];
        let measured = adhesion::pull_off().run(&sets).unwrap();
        let pull = measured.found[0].value;
        println!(
            "lambda = {lambda}: {pull} of {exact}, {:.1} s",
            measured.cpu_s
        );
        assert!((pull / exact - 1.0).abs() < 0.01, "{lambda}: {pull}");
        assert!(pull < last && pull > JKR, "{lambda}: {pull} after {last}");
        assert!(pull > maugis_dugdale(*lambda), "{lambda}: {pull}");
        if *lambda == 0.1 {
            assert!((pull / DMT - 1.0).abs() < 0.01, "{pull}");
        }
        last = pull;
    }
}

/// At large Maugis parameters the ball jumps into contact and out of it. A little viscosity of the bonds makes branches
/// of both, and hardly any pull.
#[test]
fn sticky_balls_jump_into_contact_and_out_of_it() {
    let coarse = [
        "mesh.x=(from: 0.0, pieces: [Cells(to: 0.45e-3, cells: 26), Cells(to: 0.85e-3, cells: 64), Growing(to: 22.0e-3, growth: 1.2)])",
        "mesh.y=(from: 0.0, pieces: [Cells(to: -2.6e-5, cells: 4), Growing(to: -22.0e-3, growth: 1.4)])",
        "C_n=1.3564e10",
    ];
    // Behind the largest pull the fine mesh takes long.
    let fine = ["C_n=3.0519e10", "time.end=0.9"];
    let runs: [(usize, &[&str]); 2] = [(4, &coarse), (5, &fine)];
    for (k, sets) in runs {
        let (lambda, exact) = HALF_SPACE[k];
        let sets = LARGE.iter().chain(sets).copied();
        let ran = compute(Plan::new("pull-off", "pull-off", sets)).unwrap();
        let ran = ran.completed().unwrap();
        let pull = (adhesion::pull_off_large().measure)(&ran).unwrap()[0].value;
        println!(
            "lambda = {lambda}: {pull} of {exact}, {:.1} s",
            ran.summary.cpu_s
        );
        assert!((pull / exact - 1.0).abs() < 0.01, "{lambda}: {pull}");
        assert!(pull > maugis_dugdale(lambda) && pull < HALF_SPACE[k - 1].1);
        let force = ran.curve("t", "force.contact.y").unwrap();
        let largest = peak(&force).unwrap().1;
        // On the way in the pull goes once from little to most of what it will be.
        let share = |f: f64| f / largest;
        let way_in: Vec<f64> = force
            .iter()
            .filter(|p| p.0 <= 0.4)
            .map(|p| share(p.1))
            .collect();
        let between = way_in
            .windows(2)
            .filter(|p| p[0] < 0.3 && p[1] > 0.3)
            .count();
        assert!(
            way_in[1] < 0.1 && way_in[way_in.len() - 1] > 0.75 && between == 1,
            "{way_in:?}"
        );
        if ran.summary.time > 1.0 {
            assert!(share(force[force.len() - 1].1) < 0.1);
        }
    }
}

#[test]
fn a_strip_peels_at_the_energy_of_its_bonds() {
    let error = |b: &str| {
        let measured = adhesion::peel().run(&[b]).unwrap();
        measured.error("force")
    };
    let (sticky, quick) = (error("adhesion.b=1.2"), error("adhesion.b=0.3"));
    assert!(quick > 0.0 && quick < 1e-2, "{quick}");
    // What viscosity adds is proportional to it: nothing is left without.
    let limit = quick - (sticky - quick) / 3.0;
    assert!(limit.abs() < 5e-3, "{sticky} {quick} {limit}");
}

#[test]
fn a_row_of_bonds_follows_the_ramp_of_one() {
    let errors = [4e-3, 2e-3].map(|dt| {
        let measured = adhesion::plate_pull()
            .run(&[&format!("time.dt={dt:e}")])
            .unwrap();
        assert!(measured.error("largest force").abs() < 2e-3, "{measured:?}");
        assert!(measured.error("work").abs() < 1e-3, "{measured:?}");
        measured.error("beta").abs()
    });
    assert!(
        errors[1] < 2e-4 && ((errors[0] / errors[1]).log2() - 2.0).abs() < 0.1,
        "{errors:?}"
    );
}

/// Without viscosity the largest force is s0 A and the work w A, but for what the bonds still hold at the end: 1/2
/// (x0/x)^2.
#[test]
fn without_viscosity_a_plate_takes_strength_and_energy() {
    let measured = adhesion::plate_pull().run(&["b=0.0"]).unwrap();
    let value = |k: usize| measured.found[k].value;
    assert!((value(1) / 4000.0 - 1.0).abs() < 1e-4, "{measured:?}");
    assert!((value(2) / 0.4 - 0.995).abs() < 1e-4, "{measured:?}");
}
