//! Cone and flat punch against their closed forms.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

use verification::cases::indenters::{NEO_HOOKEAN, cone, cone_at, punch};
use verification::{Case, Measured};

fn run(case: &Case, sets: &[&str]) -> Measured {
    let measured = case.run(sets).unwrap();
    let found: Vec<String> = measured
        .found
        .iter()
        .map(|f| format!("{} {:+.4} %", f.name, 100.0 * f.error(None)))
        .collect();
    let (dofs, cpu) = (measured.dofs, measured.cpu_s);
    println!(
        "{} {sets:?}: {dofs} dofs, {cpu:.1} s: {}",
        case.name,
        found.join(", ")
    );
    measured
}

fn at(degrees: f64, more: &[&str]) -> Measured {
    let sets = cone_at(degrees);
    let sets: Vec<&str> = sets
        .iter()
        .map(String::as_str)
        .chain(more.iter().copied())
        .collect();
    run(&cone(), &sets)
}

/// The error of the force on a cone of small strains.
fn error(measured: &Measured) -> f64 {
    measured.error("P/d^2")
}

#[test]
fn a_blunt_cone_needs_the_force_of_love() {
    let fine = at(85.0, &[NEO_HOOKEAN]);
    assert!(error(&fine).abs() < 5e-3);
    assert!(fine.error("pressure").abs() < 1e-2);
    assert!(fine.error("spread of P/d^2") < 2e-3);
}

#[test]
fn the_law_of_the_paper_softens_by_as_much_as_the_cone_is_steep() {
    let steepness = |degrees: f64| 1.0 / degrees.to_radians().tan();
    let found = [85.0, 87.5, 89.0].map(|d| (steepness(d), error(&at(d, &[]))));
    let [far, middle, near] = found;
    let slope = |a: (f64, f64), b: (f64, f64)| (a.1 - b.1) / (a.0 - b.0);
    let limit = near.1 - slope(middle, near) * near.0;
    println!(
        "slopes {} {}, limit {limit}",
        slope(far, middle),
        slope(middle, near)
    );
    assert!(limit.abs() < 5e-3, "{limit}");
    assert!((slope(far, middle) / slope(middle, near) - 1.0).abs() < 0.1);
}

#[test]
fn a_cone_has_no_length_scale() {
    let steep = at(80.0, &["refine=1", "time.dt=0.05"]);
    let paper = at(60.0, &["refine=1", "time.dt=0.05"]);
    assert!(steep.error("spread of P/d^2") < 1e-2);
    assert!(paper.error("spread of P/d^2") < 2e-2);
}

#[test]
fn a_flat_punch_needs_its_force_and_pressure() {
    let case = punch();
    let rungs = |ladder: usize| {
        let rungs = case.ladders[ladder].rungs.iter().take(2);
        let sets = rungs.map(|rung| rung.sets.iter().map(String::as_str).collect::<Vec<&str>>());
        sets.map(|sets| run(&case, &sets))
            .collect::<Vec<Measured>>()
    };
    let (graded, equal) = (rungs(0), rungs(1));
    assert!(graded[0].error("force").abs() < 5e-3);
    assert!(graded[0].error("pressure").abs() < 5e-3);
    let order = (equal[0].error("force") / equal[1].error("force")).log2();
    assert!((order - 1.0).abs() < 0.1, "{order}");
}

#[test]
fn nothing_locks_near_incompressibility() {
    let softer = |law: &str| error(&at(85.0, &["refine=1", law]));
    let near = softer("materials.block.law=NeoHookean(E: 1.0e7, nu: 0.4999)");
    assert!((near - softer(NEO_HOOKEAN)).abs() < 5e-3);
}
