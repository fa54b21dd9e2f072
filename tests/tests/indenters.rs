//! Cone and flat punch against their closed forms.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

use tests::cases::indenters::{NEO_HOOKEAN, OF_THE_PAPER, block_of, cone, cone_at, punch};
use tests::closed_form::{
    cone_strain_slope, cubic_of_neo_hookean, cubic_of_saint_venant_kirchhoff,
};
use tests::{Case, Measured};

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
    for (law, bound) in [
        // Its strains alone are .68 %.
        (NEO_HOOKEAN, 7e-3),
        ("materials.block.law=NeoHookean(E: 1.0e7, nu: 0.45)", 5e-3),
    ] {
        let fine = at(85.0, &[law, LONG]);
        assert!(error(&fine).abs() < bound);
        assert!(fine.error("P/d^2 with finite strain").abs() < 2e-3);
        assert!(fine.error("pressure").abs() < 1.2e-2);
        assert!(fine.error("spread of P/d^2") < 2e-3);
    }
}

/// The value at zero of the parabola through three points.
fn at_zero(points: [(f64, f64); 3]) -> f64 {
    let part = |i: usize| {
        let others = (0..3).filter(|&j| j != i);
        others.fold(points[i].1, |value, j| {
            value * points[j].0 / (points[j].0 - points[i].0)
        })
    };
    (0..3).map(part).sum()
}

#[test]
fn without_strains_two_laws_need_the_force_of_love_and_with_them_what_their_energies_say() {
    let steepness = |degrees: f64| 1.0 / degrees.to_radians().tan();
    let angles = [85.0, 87.5, 89.0];
    let errors =
        |law: &str| angles.map(|d| (steepness(d), error(&at(d, &["refine=1", LONG, law]))));
    let (soft, mild) = (errors(OF_THE_PAPER), errors(NEO_HOOKEAN));
    let limits = [at_zero(soft), at_zero(mild)];
    println!("limits {limits:?}");
    assert!(limits.iter().all(|limit| limit.abs() < 5e-3), "{limits:?}");
    assert!((limits[0] - limits[1]).abs() < 1e-3, "{limits:?}");
    // What the mesh and the block do is in both.
    let slopes = [0, 1, 2].map(|k| (soft[k].0, (soft[k].1 - mild[k].1) / soft[k].0));
    let slope = at_zero(slopes);
    let expected = cone_strain_slope(cubic_of_saint_venant_kirchhoff, 0.495)
        - cone_strain_slope(cubic_of_neo_hookean, 0.495);
    println!("slope {slope}, from the energies {expected}");
    assert!((slope / expected - 1.0).abs() < 0.03, "{slope} {expected}");
}

#[test]
fn a_cone_has_no_length_scale() {
    let coarse = ["refine=1", LONG];
    assert!(at(80.0, &coarse).error("spread of P/d^2") < 1e-2);
    // The scene itself. The surface would buckle if no cone held it: that alone would cut every step.
    let [x, y] = block_of(20.0);
    for (law, spread) in [(OF_THE_PAPER, 1e-2), (NEO_HOOKEAN, 3e-2)] {
        let steep = at(60.0, &[law, LONG, &x, &y]);
        assert!(steep.steps[1] <= 2);
        assert!(steep.error("spread of P/d^2") < spread);
    }
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
