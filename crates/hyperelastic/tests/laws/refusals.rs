use hyperelastic::Material;
use proptest::prelude::*;

use super::*;

fn refuses(law: &impl Material, c: &Symmetric) -> bool {
    law.energy(c).is_err() && law.stress(c).is_err() && law.response(c).is_err()
}

proptest! {
    /// A symmetric tensor with a principal value that is not positive; a pair of negative ones leaves det C > 0.
    #[test]
    fn laws_of_j_refuse_what_is_not_positive_definite(
        l in any_stretches(), q in any_rotation(), negative in 1..8_u8, flat in any::<bool>(),
    ) {
        let signed = [0, 1, 2].map(|i| {
            let sign = if negative >> i & 1 == 1 { -1.0 } else { 1.0 };
            sign * l[i] * if flat && sign < 0.0 { 1e-9 } else { 1.0 }
        });
        let entry = |i: usize, j: usize| (0..3).map(|k| q[(i, k)] * signed[k] * q[(j, k)]).sum::<f64>();
        let c = Symmetric::new(entry(0, 0), entry(1, 1), entry(2, 2), entry(0, 1), entry(0, 2), entry(1, 2));
        prop_assert!(refuses(&blatz_ko(1.0), &c));
        prop_assert!(refuses(&neo_hookean(1.0, 1.0), &c));
        prop_assert!(!refuses(&saint_venant_kirchhoff(1.0, 1.0), &c));
        prop_assert!(!refuses(&three_e(1.0, 1.0, [0.0; 5]), &c));
    }

    /// Whatever bits come in, no NaN goes out.
    #[test]
    fn no_nan_for_any_bits(c in any::<[u64; 6]>(), law in any_three_e()) {
        fn clean(law: &impl Material, c: &Symmetric) -> bool {
            law.response(c).is_err() || {
                let response = law.response(c).unwrap();
                response.energy.is_finite()
                    && response.stress.iter().chain(response.tangent.iter()).all(|x| x.is_finite())
            }
        }
        let c = Symmetric::from(c.map(f64::from_bits));
        // Also with a dominant diagonal, or hardly any state would be positive definite.
        let dominant = diagonal([c[0].abs(), c[1].abs(), c[2].abs()]);
        for c in [c, dominant] {
            prop_assert!(clean(&law, &c));
            prop_assert!(clean(&saint_venant_kirchhoff(1.0, 1.0), &c));
            prop_assert!(clean(&blatz_ko(1.0), &c));
            prop_assert!(clean(&neo_hookean(1.0, 1.0), &c));
        }
    }

    /// Diagonal states on a logarithmic scale, around the limits where the laws of J stop.
    #[test]
    fn no_nan_at_extreme_stretches(exponents in [-30.0..30.0, -30.0..30.0, -30.0..30.0]) {
        let state = diagonal(exponents.map(|x: f64| 10.0_f64.powf(x)));
        for response in [blatz_ko(1e12).response(&state), neo_hookean(1e12, 1e12).response(&state)].into_iter().flatten() {
            prop_assert!(response.energy.is_finite());
            prop_assert!(response.stress.iter().chain(response.tangent.iter()).all(|x| x.is_finite()));
        }
    }
}

#[test]
fn refusals_carry_the_determinant() {
    let refused = blatz_ko(1.0)
        .energy(&diagonal([-2.0, 1.0, 1.0]))
        .unwrap_err();
    assert_eq!(refused.det_c, -2.0);
    let refused = saint_venant_kirchhoff(1.0, 1.0)
        .energy(&diagonal([1.0, f64::NAN, 1.0]))
        .unwrap_err();
    assert!(refused.det_c.is_nan());
}
