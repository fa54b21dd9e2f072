use super::*;
use crate::cases::adhesion::HALF_SPACE;
use crate::closed_form::{DMT, JKR, maugis_dugdale};
use approx::assert_relative_eq;

/// Stress that stays until the bond breaks, but for a slope that Newton's method needs.
fn constant(strength: f64, gap: f64) -> (f64, f64) {
    let (length, share) = (ENERGY / strength, 0.25);
    let slope = -strength / (2.0 * share * length);
    match gap / length - 1.0 {
        near if near < -share => (strength, 0.0),
        far if far > share => (0.0, 0.0),
        _ => (slope * (gap - (1.0 + share) * length), slope),
    }
}

#[test]
fn bonds_of_constant_stress_give_the_force_of_maugis() {
    for (lambda, rings) in [(0.1, 80), (0.3, 120), (1.0, 160), (2.0, 240), (3.0, 300)] {
        let (pull, exact) = (
            pull_off(lambda, rings, constant).unwrap(),
            maugis_dugdale(lambda),
        );
        println!("lambda = {lambda}, {rings} rings: {pull} of {exact}");
        assert_relative_eq!(pull, exact, max_relative = 3e-3);
    }
}

#[test]
fn long_bonds_of_the_program_give_the_force_of_dmt() {
    let pull = pull_off(0.04, 40, recoverable).unwrap();
    println!("lambda = .04: {pull}");
    assert_relative_eq!(pull, DMT, max_relative = 3e-3);
}

#[test]
fn the_force_converges_over_the_rings() {
    for lambda in [1.0, 3.0] {
        let pulls = [100, 200, 400].map(|n| pull_off(lambda, n, recoverable).unwrap());
        println!("lambda = {lambda}: {pulls:?}");
        let [coarse, fine] = [0, 1].map(|k| (pulls[k + 1] - pulls[k]).abs());
        assert!(fine < 0.5 * coarse && fine < 4e-3 * pulls[2], "{pulls:?}");
    }
}

/// The reference of the case, in the digits that it is given with.
#[test]
fn the_table_is_what_the_rings_say() {
    let rings = [100, 200, 200, 200, 400, 400];
    for ((lambda, told), rings) in HALF_SPACE.into_iter().zip(rings) {
        let pull = pull_off(lambda, rings, recoverable).unwrap();
        println!("lambda = {lambda}, {rings} rings: {pull:.4}");
        assert!((pull - told).abs() < 1e-3, "{lambda}: {pull} {told}");
        assert!(pull > maugis_dugdale(lambda) && pull < DMT);
    }
    // What is above the force of JKR falls with the parameter.
    let above = [3, 5].map(|k: usize| HALF_SPACE[k].0 * (HALF_SPACE[k].1 - JKR));
    assert_relative_eq!(above[0], above[1], max_relative = 0.02);
}
