use super::*;
use crate::conformance::half_space;
use crate::rcc::{Adhesion, Bond, Update};
use crate::solve::SolveStatus;

/// Bonds of stretched pairs, stiff against the half-space of unit modulus, over a step in which they soften.
fn bonds(problem: &ContactProblem, update: Update, pull: f64, rate: f64) -> Vec<BondStep> {
    let law = Adhesion {
        update,
        bonded_friction: Some(0.8),
        ..Adhesion::new(40.0, 25.0, 40.0 * 1e-4, 1.0)
    };
    let count = problem.contacts();
    let one = |c: usize| {
        let start = Bond {
            intensity: 0.2 + 0.8 * ((c as f64 * 0.7).sin().abs()),
            gap: 0.0,
            separation: [pull * (c as f64).cos(), 0.3 * pull],
        };
        BondStep::new(&law, 1.0 / count as f64, rate, start, 1e-13)
    };
    (0..count).map(one).collect()
}

#[test]
fn all_ways_to_a_bonded_solution_agree() {
    for update in [Update::SecondOrder, Update::EnergyConsistent] {
        for (depth, drag, pull) in [(1e-2, 3e-3, 0.0), (1e-3, 2e-2, 2e-3), (5e-3, 1e-3, 5e-3)] {
            let problem = half_space(5, 0.3, depth, drag);
            let bonds = bonds(&problem, update, pull, 3.0);
            let (mut newton, mut swept, mut settled) = (Vec::new(), Vec::new(), Vec::new());
            let settings = SolveSettings::default();
            let outcome = solve_bonded(&problem, &bonds, &mut newton, &settings);
            assert!(
                outcome.is_converged()
                    && outcome.work.newton_steps <= 10
                    && outcome.work.sweeps == FEW,
                "{update:?} {depth}: {:?}",
                outcome.work
            );
            let measure = ErrorMeasure::bonded(&problem, &bonds);
            let mut x = Iterate::new(&measure, &vec![0.0; problem.q.len()]);
            let sweeper = Sweeper::<3>::bonded(&problem, &bonds, Kernel::Exact);
            sweeper.run_accelerated(&measure, &mut x, 1e-10, 2000, &mut Work::default());
            swept.extend_from_slice(&x.r);
            assert!(x.is_within(1e-10), "{:?}", x.errors);
            let proximal = settings.with_method(Method::Proximal);
            let other = solve_bonded(&problem, &bonds, &mut settled, &proximal);
            assert_eq!(
                other.status,
                SolveStatus::Converged,
                "{} {:?}",
                other.error_scale_free,
                other.work
            );
            let size = newton.iter().fold(0.0_f64, |m, r| m.max(r.abs()));
            for ((a, b), c) in newton.iter().zip(&swept).zip(&settled) {
                assert!(
                    (a - b).abs() < 1e-7 * size && (a - c).abs() < 1e-7 * size,
                    "{a} {b} {c}"
                );
            }
        }
    }
}

#[test]
fn bonds_hold_what_contact_alone_lets_go() {
    let mut problem = half_space(4, 0.3, 1e-3, 0.0);
    // Lifted clear of the surface.
    problem
        .q
        .iter_mut()
        .skip(2)
        .step_by(3)
        .for_each(|gap| *gap += 3e-3);
    let (mut with, mut without) = (Vec::new(), Vec::new());
    let outcome = solve_bonded(
        &problem,
        &bonds(&problem, Update::SecondOrder, 0.0, 0.1),
        &mut with,
        &SolveSettings::default(),
    );
    assert!(outcome.is_converged());
    assert!(solve(&problem, &mut without, &SolveSettings::default()).is_converged());
    assert!(without.iter().all(|r| *r == 0.0));
    assert!(with.chunks(3).all(|r| r[2] < 0.0));
}

#[test]
fn sweeps_that_lead_nowhere_end_early() {
    let problem = half_space(4, 0.3, 1e-2, 3e-3);
    let bonds = bonds(&problem, Update::SecondOrder, 0.0, 3.0);
    let settings = SolveSettings {
        // Below rounding.
        tolerance: 1e-18,
        ..SolveSettings::default()
    };
    let mut r = Vec::new();
    let outcome = solve_bonded(&problem, &bonds, &mut r, &settings);
    assert!(!outcome.is_converged() && outcome.error_scale_free < 1e-12);
    assert!(
        outcome.work.sweeps >= FEW + 10 * FEW + PATIENCE * LONGEST
            && outcome.work.sweeps < settings.max_iterations / 4,
        "{:?}",
        outcome.work
    );
}

#[test]
fn a_list_of_bonds_of_another_length_is_refused() {
    let problem = half_space(3, 0.3, 1e-3, 0.0);
    let bonds = bonds(&problem, Update::SecondOrder, 0.0, 0.1);
    let outcome = solve_bonded(
        &problem,
        &bonds[1..],
        &mut Vec::new(),
        &SolveSettings::default(),
    );
    assert!(outcome.refusal.is_some() && !outcome.is_converged());
}
