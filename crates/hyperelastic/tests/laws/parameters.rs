use hyperelastic::{Material, ParameterError};
use proptest::prelude::*;

use super::*;

fn elastic(shear: f64, bulk: f64) -> ElasticConstants {
    ElasticConstants::from_shear_bulk(shear, bulk).unwrap()
}

#[test]
fn refusals_name_parameter_value_and_bound() {
    let message = |a| ThreeE::new(elastic(2.0, 3.0), a).unwrap_err().to_string();
    let text = message([5.0, 0.0, 0.0, 0.0, 4.0]);
    assert!(
        text.contains("a1 = 5") && text.contains("-4 and 4") && text.contains("eq. 17"),
        "{text}"
    );
    let text = message([0.0, -19.0, 0.0, 12.0, 0.0]);
    assert!(
        text.contains("a2 = -19") && text.contains("-18 and 18"),
        "{text}"
    );
    for (i, name) in [(2, "a3"), (3, "a4"), (4, "a5")] {
        let mut a = [0.0; 5];
        a[i] = -0.5;
        let text = message(a);
        assert!(
            text.contains(name) && text.contains("-0.5") && text.contains("0 and inf"),
            "{text}"
        );
    }
}

#[test]
fn parameters_that_are_not_numbers_are_refused() {
    for i in 0..5 {
        for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            let mut a = [0.0, 0.0, 1.0, 1.0, 1.0];
            a[i] = bad;
            let refused = ThreeE::new(elastic(1.0, 1.0), a);
            assert!(
                matches!(refused, Err(ParameterError::NotFinite { .. })),
                "a{} = {bad}",
                i + 1
            );
        }
    }
    for bad in [f64::NAN, f64::INFINITY, 0.0, -1.0] {
        assert!(BlatzKo::new(bad).is_err(), "G = {bad}");
    }
}

#[test]
fn neo_hookean_refuses_negative_poisson_ratio() {
    let auxetic = ElasticConstants::from_young_poisson(1.0, -0.2).unwrap();
    let message = NeoHookean::new(auxetic).unwrap_err().to_string();
    assert!(
        message.contains("lambda = -0.17") && message.contains("nu < 0"),
        "{message}"
    );
    assert!(NeoHookean::new(ElasticConstants::from_young_poisson(1.0, 0.0).unwrap()).is_ok());
    assert!(SaintVenantKirchhoff::new(auxetic).is_ok());
}

#[test]
fn small_strain_moduli_are_those_given() {
    let given = elastic(2.0, 3.0);
    assert_eq!(
        SaintVenantKirchhoff::new(given)
            .unwrap()
            .small_strain_moduli(),
        given
    );
    assert_eq!(NeoHookean::new(given).unwrap().small_strain_moduli(), given);
    assert_eq!(
        ThreeE::new(given, [0.0; 5]).unwrap().small_strain_moduli(),
        given
    );
    let foam = blatz_ko(4.0).small_strain_moduli();
    assert_eq!((foam.shear_modulus(), foam.lame_modulus()), (4.0, 4.0));
    assert!((foam.young_modulus() - 10.0).abs() < 1e-14);
    assert!((foam.poisson_ratio() - 0.25).abs() < 1e-16);
}

proptest! {
    #[test]
    fn three_e_accepts_exactly_what_is_inside(
        shear in 0.1..10.0, bulk in 0.1..10.0, f1 in -2.0..2.0_f64, f2 in -2.0..2.0_f64,
        a3 in -1.0..5.0, a4 in 0.0..5.0, a5 in 0.0..5.0,
    ) {
        let a = within_bounds(shear, bulk, [f1, f2, a3, a4, a5]);
        let inside = f1.abs() <= 1.0 && f2.abs() <= 1.0 && a3 >= 0.0;
        prop_assume!((f1.abs() - 1.0).abs() > 1e-12 && (f2.abs() - 1.0).abs() > 1e-12);
        prop_assert_eq!(ThreeE::new(elastic(shear, bulk), a).is_ok(), inside);
    }

    #[test]
    fn three_e_refuses_negative_fourth_order(shear in 0.1..10.0, a4 in -5.0..-1e-9, a5 in -5.0..-1e-9) {
        prop_assert!(ThreeE::new(elastic(shear, 1.0), [0.0, 0.0, 0.0, a4, 0.0]).is_err());
        prop_assert!(ThreeE::new(elastic(shear, 1.0), [0.0, 0.0, 0.0, 0.0, a5]).is_err());
    }
}
