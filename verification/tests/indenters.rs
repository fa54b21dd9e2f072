//! Cone and flat punch against their closed forms.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

use verification::cases::indenters::{NEO_HOOKEAN, block_of, cone, cone_at, punch};
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

/// Steps as short as those of the scene would be dear here.
const LONG: &str = "time.dt=0.05";

#[test]
fn a_blunt_cone_needs_the_force_of_love() {
    let fine = at(85.0, &[NEO_HOOKEAN, LONG]);
    // Of which .6 % are the strains, see below: they go with the cotangent of the angle.
    assert!(error(&fine).abs() < 7e-3);
    assert!(fine.error("pressure").abs() < 1.2e-2);
    assert!(fine.error("spread of P/d^2") < 2e-3);
}

#[test]
fn the_law_of_the_paper_softens_by_as_much_as_the_cone_is_steep() {
    let steepness = |degrees: f64| 1.0 / degrees.to_radians().tan();
    let [far, middle, near] =
        [85.0, 87.5, 89.0].map(|d| (steepness(d), error(&at(d, &["refine=1", LONG]))));
    let slope = |a: (f64, f64), b: (f64, f64)| (a.1 - b.1) / (a.0 - b.0);
    let slopes = [slope(far, middle), slope(middle, near)];
    let limit = near.1 - slopes[1] * near.0;
    println!("slopes {slopes:?}, limit {limit}");
    assert!((slopes[0] / slopes[1] - 1.0).abs() < 0.1);
    // Without strains it is 2/pi.
    assert!(limit.abs() < 5e-3, "{limit}");
}

#[test]
fn a_cone_has_no_length_scale() {
    let coarse = ["refine=1", LONG];
    assert!(at(80.0, &coarse).error("spread of P/d^2") < 1e-2);
    // Under 60 degrees the law gives way in every new element: P/d^2 falls a little.
    let [x, y] = block_of(20.0);
    assert!(at(60.0, &["refine=1", &x, &y]).error("spread of P/d^2") < 3e-2);
}

#[test]
fn a_flat_punch_needs_its_force_and_pressure() {
    let case = punch();
    let rungs = |ladder: usize| {
        let rungs = case.ladders[ladder].rungs.iter().take(2);
        let sets = rungs.map(|rung| rung.sets.iter().map(String::as_str).collect());
        sets.map(|sets: Vec<&str>| run(&case, &sets))
            .collect::<Vec<Measured>>()
    };
    let (graded, equal) = (rungs(0), rungs(1));
    assert!(graded[0].error("force").abs() < 6e-3);
    assert!(graded[1].error("force").abs() < 2e-3);
    assert!(graded[1].error("pressure").abs() < 2e-3);
    // Both have the error of the smooth part; the rest is that of the singular edge.
    let edge = |k: usize| equal[k].error("force") - graded[k].error("force");
    let order = (edge(0) / edge(1)).log2();
    assert!((order - 1.0).abs() < 0.1, "{order}");
}

#[test]
fn nothing_locks_near_incompressibility() {
    let coarse = |law: &str| error(&at(85.0, &["refine=1", LONG, law]));
    let near = coarse("materials.block.law=NeoHookean(E: 1.0e7, nu: 0.4999)");
    assert!((near - coarse(NEO_HOOKEAN)).abs() < 5e-3);
}
