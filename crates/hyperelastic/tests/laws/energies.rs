use hyperelastic::{Material, Tangent};
use proptest::prelude::*;

use super::*;

fn state(l: [f64; 3], q: &Matrix3<f64>) -> Symmetric {
    right_cauchy_green(&turned_and_stretched(l, q))
}

fn quadratic_form(d: &Tangent, e: [f64; 6]) -> f64 {
    let e = Symmetric::from(e);
    e.dot(&(d * e))
}

proptest! {
    #[test]
    fn strained_matter_has_energy(
        law in any_three_e(), g in 0.1..10.0, lame in 0.0..10.0, l in any_stretches(), q in any_rotation(),
    ) {
        prop_assume!(l.iter().any(|l| (l - 1.0).abs() > 1e-6));
        let c = state(l, &q);
        prop_assert!(law.energy(&c).unwrap() > 0.0);
        prop_assert!(saint_venant_kirchhoff(g, g).energy(&c).unwrap() > 0.0);
        prop_assert!(blatz_ko(g).energy(&c).unwrap() > 0.0);
        prop_assert!(neo_hookean(g, lame).energy(&c).unwrap() > 0.0);
    }

    /// The bounds are those of convexity, and nothing is lost by using them to the last bit.
    #[test]
    fn three_e_is_convex_up_to_its_bounds(
        f1 in prop_oneof![Just(-1.0), Just(1.0), -1.0..1.0], f2 in prop_oneof![Just(-1.0), Just(1.0), -1.0..1.0],
        a4 in 0.0..5.0, a5 in 0.0..5.0, l in any_stretches(), q in any_rotation(),
        e in [-1.0..1.0, -1.0..1.0, -1.0..1.0, -1.0..1.0, -1.0..1.0, -1.0..1.0],
    ) {
        let law = three_e(2.0, 3.0, within_bounds(2.0, 3.0, [f1, f2, 0.0, a4, a5]));
        let d = law.response(&state(l, &q)).unwrap().tangent;
        prop_assert!(quadratic_form(&d, e) >= -1e-12 * d.amax());
    }
}

/// Just outside a bound, convexity is lost somewhere: so the bounds are sharp. At the double root of the second
/// derivative in `z`, `z = -a2/(3 a4)`, and in the plane of the deviator at the radius `|a1|/a5`.
#[test]
fn three_e_bounds_are_sharp() {
    // Both laws are at their bounds; D vanishes in one direction there.
    let law = three_e(
        2.0,
        3.0,
        within_bounds(2.0, 3.0, [0.0, -1.0, 0.0, 300.0, 0.0]),
    );
    let z = -law.parameters()[1] / (3.0 * law.parameters()[3]);
    let c = 1.0 + 2.0 * z / 3.0_f64.sqrt();
    let d = law.response(&diagonal([c; 3])).unwrap().tangent;
    assert!(quadratic_form(&d, [1.0, 1.0, 1.0, 0.0, 0.0, 0.0]).abs() < 1e-12 * d.amax());

    let law = three_e(
        2.0,
        3.0,
        within_bounds(2.0, 3.0, [1.0, 0.0, 0.0, 0.0, 400.0]),
    );
    let radius = law.parameters()[0] / law.parameters()[4];
    // x > 0, y = 0 would be soft across for a1 > 0: there the second derivative along y is 2G - 2 a1 x + a5 x^2.
    let unit = [2.0, -1.0, -1.0].map(|x| x / 6.0_f64.sqrt());
    let c = unit.map(|x| 1.0 + 2.0 * radius * x);
    let d = law.response(&diagonal(c)).unwrap().tangent;
    assert!(quadratic_form(&d, [0.0, 1.0, -1.0, 0.0, 0.0, 0.0]).abs() < 1e-12 * d.amax());
}

/// The paper claims convexity for every `a3 >= 0`; its coupling term alone is not convex.
#[test]
fn three_e_with_coupling_is_not_convex_at_large_strain() {
    let law = three_e(1.0, 1.0, [0.0, 0.0, 20.0, 0.0, 0.0]);
    let d = law.response(&diagonal([9.0, 1.0, 1.0])).unwrap().tangent;
    // In (x, z), det = (2G + a3 z^2/2)(3K + a3 x^2/2) - (a3 x z)^2 < 0: soft along dx = -dz.
    let (x, z) = (1.0 / 6.0_f64.sqrt(), -1.0 / 3.0_f64.sqrt());
    let soft = (0..101).map(|i| f64::from(i) / 50.0).any(|ratio| {
        let e = [
            2.0 * x + ratio * z,
            -x + ratio * z,
            -x + ratio * z,
            0.0,
            0.0,
            0.0,
        ];
        quadratic_form(&d, e) < 0.0
    });
    assert!(soft);
}

/// What energy-conserving schemes divide: `(W1 - W0)/|E1 - E0|` stays a derivative for steps far below the square root
/// of round-off.
#[test]
fn energy_differences_are_derivatives_near_the_reference() {
    fn error(law: &impl Material) -> f64 {
        let (strain, step) = (1e-5, 1e-9);
        let at = |e: f64| {
            law.stress(&Symmetric::new(1.0 + 2.0 * e, 1.0, 1.0, e, 0.0, 0.0))
                .unwrap()
        };
        let ((w0, s0), (w1, s1)) = (at(strain), at(strain + step));
        // E_11 and 2 E_12 both change by the step.
        let mean = 0.5 * (s0[0] + s1[0] + s0[3] + s1[3]);
        ((w1 - w0) / step - mean).abs() / mean
    }
    assert!(error(&saint_venant_kirchhoff(1.0, 1.0)) < 1e-6);
    assert!(error(&three_e(1.0, 1.0, [0.5, 0.5, 0.5, 0.5, 0.5])) < 1e-6);
    assert!(error(&blatz_ko(1.0)) < 1e-6);
    assert!(error(&neo_hookean(1.0, 1.0)) < 1e-6);
}
