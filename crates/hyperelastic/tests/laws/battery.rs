use hyperelastic::conformance::{Options, Property, Violation, check, check_state};
use hyperelastic::{Inverted, Material, Real, Response, Tangent, tensor};
use proptest::prelude::*;

use super::*;

#[test]
fn saint_venant_kirchhoff_conforms() {
    check(&saint_venant_kirchhoff(3.8e6, 8.3e6), &Options::default()).unwrap();
    check(
        &saint_venant_kirchhoff(5.0e3, 1.0e4 / 3.0),
        &Options::default(),
    )
    .unwrap();
}

#[test]
fn three_e_conforms() {
    check(&three_e(2.0, 3.0, [0.0; 5]), &Options::default()).unwrap();
    check(
        &three_e(2.0, 3.0, [1.1, -2.9, 0.7, 0.9, 0.6]),
        &Options::default(),
    )
    .unwrap();
    // One parameter at a time, so that none can hide behind another.
    check(
        &three_e(2.0, 3.0, [0.0, 0.0, 4.0, 0.0, 0.0]),
        &Options::default(),
    )
    .unwrap();
    check(
        &three_e(2.0, 3.0, [0.0, 5.0, 0.0, 4.0, 0.0]),
        &Options::default(),
    )
    .unwrap();
    check(
        &three_e(2.0, 3.0, [-3.9, 0.0, 0.0, 0.0, 4.0]),
        &Options::default(),
    )
    .unwrap();
}

#[test]
fn blatz_ko_conforms() {
    check(&blatz_ko(10.0e6), &Options::default()).unwrap();
    check(
        &blatz_ko(1.0),
        &Options::default()
            .with_stretches([0.1, 10.0])
            .with_tolerance(1e-8)
            .with_difference_tolerance(1e-3),
    )
    .unwrap();
}

#[test]
fn neo_hookean_conforms() {
    check(&neo_hookean(2.1e6, 2.1e6), &Options::default()).unwrap();
    check(&neo_hookean(1.0, 0.0), &Options::default()).unwrap();
    check(&neo_hookean(1.0, 200.0), &Options::default()).unwrap();
}

proptest! {
    #[test]
    fn saint_venant_kirchhoff_conforms_anywhere(
        shear in 0.1..10.0, bulk in 0.1..10.0, stretches in any_stretches(), rotation in any_rotation(),
    ) {
        check_state(&saint_venant_kirchhoff(shear, bulk), stretches, &rotation, &Options::default())?;
    }

    #[test]
    fn three_e_conforms_anywhere(law in any_three_e(), stretches in any_stretches(), rotation in any_rotation()) {
        check_state(&law, stretches, &rotation, &Options::default())?;
    }

    #[test]
    fn blatz_ko_conforms_anywhere(shear in 0.1..10.0, stretches in any_stretches(), rotation in any_rotation()) {
        check_state(&blatz_ko(shear), stretches, &rotation, &Options::default())?;
    }

    #[test]
    fn neo_hookean_conforms_anywhere(
        shear in 0.1..10.0, lame in 0.0..100.0, stretches in any_stretches(), rotation in any_rotation(),
    ) {
        check_state(&neo_hookean(shear, lame), stretches, &rotation, &Options::default())?;
    }
}

/// A law with one planted mistake: the battery has to find each of them.
#[derive(Clone, Debug)]
struct Faulty {
    law: hyperelastic::BlatzKo,
    fault: Fault,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Fault {
    None,
    StressComponent,
    TangentComponent,
    TangentUnsymmetric,
    EnergyAnisotropic,
    EnergyOffset,
    EnergyRounded,
    Prestress,
    Moduli,
    AcceptsNan,
    StressMethodDiffers,
}

impl Material for Faulty {
    fn energy<T: Real>(&self, c: &Symmetric<T>) -> Result<T, Inverted> {
        let w = match self.law.energy(c) {
            Err(_) if self.fault == Fault::AcceptsNan => return Ok(c[0] * 0.0 + 1.0),
            other => other?,
        };
        Ok(match self.fault {
            Fault::EnergyAnisotropic => w + (c[0] - 1.0) * (c[0] - 1.0),
            Fault::EnergyOffset => w + 0.1,
            Fault::EnergyRounded => w + 1e3 - 1e3,
            Fault::Prestress => w + (c[0] + c[1] + c[2] - 3.0) * 0.5,
            _ => w,
        })
    }

    fn stress(&self, c: &Symmetric) -> Result<(f64, Symmetric), Inverted> {
        let Response {
            energy, mut stress, ..
        } = self.response(c)?;
        if self.fault == Fault::StressMethodDiffers {
            stress[5] += 1e-3;
        }
        Ok((energy, stress))
    }

    fn response(&self, c: &Symmetric) -> Result<Response, Inverted> {
        let Response {
            mut stress,
            mut tangent,
            ..
        } = match self.law.response(c) {
            Err(_) if self.fault == Fault::AcceptsNan => {
                return Ok(Response::new(1.0, Symmetric::zeros(), Tangent::zeros()));
            }
            other => other?,
        };
        match self.fault {
            Fault::StressComponent => stress[3] *= 1.0 + 1e-6,
            Fault::TangentComponent => {
                tangent[(3, 5)] += 1e-6;
                tangent[(5, 3)] += 1e-6;
            }
            Fault::TangentUnsymmetric => tangent[(4, 1)] += 1e-12,
            Fault::EnergyAnisotropic => {
                stress[0] += 4.0 * (c[0] - 1.0);
                tangent[(0, 0)] += 8.0;
            }
            Fault::Prestress => stress.iter_mut().take(3).for_each(|x| *x += 1.0),
            _ => {}
        }
        Ok(Response::new(self.energy(c)?, stress, tangent))
    }

    fn small_strain_moduli(&self) -> ElasticConstants {
        match self.fault {
            Fault::Moduli => ElasticConstants::from_shear_bulk(1.0, 1.0).unwrap(),
            _ => self.law.small_strain_moduli(),
        }
    }
}

fn found(fault: Fault) -> Option<Property> {
    let law = Faulty {
        law: blatz_ko(1.0),
        fault,
    };
    match check(&law, &Options::default()) {
        Ok(()) => None,
        Err(Violation::Differs { property, .. } | Violation::Accepted { property, .. }) => {
            Some(property)
        }
        Err(other) => panic!("{other}"),
    }
}

#[test]
fn battery_finds_planted_mistakes() {
    assert_eq!(found(Fault::None), None);
    for (fault, property) in [
        (Fault::StressComponent, Property::StressIsDerivativeOfEnergy),
        (Fault::TangentComponent, Property::SmallStrainModuli),
        (Fault::TangentUnsymmetric, Property::TangentIsSymmetric),
        (Fault::EnergyAnisotropic, Property::SmallStrainModuli),
        (Fault::EnergyOffset, Property::ReferenceHasNoEnergy),
        (Fault::EnergyRounded, Property::EnergyResolvesSmallStrain),
        (Fault::Prestress, Property::ReferenceHasNoStress),
        (Fault::Moduli, Property::SmallStrainModuli),
        (Fault::AcceptsNan, Property::RefusesWhatIsNotFinite),
        (Fault::StressMethodDiffers, Property::SameFromAllMethods),
    ] {
        assert_eq!(found(fault), Some(property), "{fault:?}");
    }
}

#[test]
fn battery_finds_anisotropy_and_wrong_tangents_away_from_the_reference() {
    let at = |fault, options: &Options| {
        let law = Faulty {
            law: blatz_ko(1.0),
            fault,
        };
        check_state(
            &law,
            [0.5, 1.0, 1.7],
            &conformance::rotation([0.3, 0.2, 0.6]),
            options,
        )
    };
    let options = Options::default();
    let Err(Violation::Differs { property, .. }) = at(Fault::EnergyAnisotropic, &options) else {
        panic!()
    };
    assert_eq!(property, Property::EnergyIsIsotropic);
    at(Fault::EnergyAnisotropic, &options.anisotropic()).unwrap();
    let Err(Violation::Differs { property, .. }) = at(Fault::TangentComponent, &options) else {
        panic!()
    };
    assert_eq!(property, Property::TangentIsSecondDerivativeOfEnergy);
}

#[test]
fn violations_say_where() {
    let law = Faulty {
        law: blatz_ko(1.0),
        fault: Fault::EnergyOffset,
    };
    let message = check(&law, &Options::default()).unwrap_err().to_string();
    assert!(
        message.contains("ReferenceHasNoEnergy fails at C = [[1.0, 1.0, 1.0, 0.0, 0.0, 0.0]]"),
        "{message}"
    );
    assert!(
        message.contains("component W is 1e-1, expected 0e0"),
        "{message}"
    );
}

/// The neo-Hookean law with its tangent as sums over full indices, in an order that knows nothing of its symmetry.
#[derive(Clone, Debug)]
struct WrittenWithLoops {
    law: hyperelastic::NeoHookean,
    mistake: f64,
}

impl Material for WrittenWithLoops {
    fn energy<T: Real>(&self, c: &Symmetric<T>) -> Result<T, Inverted> {
        self.law.energy(c)
    }

    fn stress(&self, c: &Symmetric) -> Result<(f64, Symmetric), Inverted> {
        self.law.stress(c)
    }

    /// `D_ijkl = lambda C^-1_ij C^-1_kl + (G - lambda ln J)(C^-1_ik C^-1_jl + C^-1_il C^-1_jk)`.
    fn response(&self, c: &Symmetric) -> Result<Response, Inverted> {
        let (energy, stress) = self.stress(c)?;
        let moduli = self.small_strain_moduli();
        let (shear, lame) = (moduli.shear_modulus(), moduli.lame_modulus());
        let full = tensor::to_matrix(c);
        let inverse = full.try_inverse().unwrap();
        let turning = shear - 0.5 * lame * full.determinant().ln();
        let mut tangent = Tangent::zeros();
        for (row, (i, j)) in tensor::COMPONENTS.into_iter().enumerate() {
            for (column, (k, l)) in tensor::COMPONENTS.into_iter().enumerate() {
                let both = turning * inverse[(i, k)] * inverse[(j, l)]
                    + turning * inverse[(i, l)] * inverse[(j, k)];
                tangent[(row, column)] = lame * inverse[(i, j)] * inverse[(k, l)] + both;
            }
        }
        tangent[(3, 0)] *= 1.0 + self.mistake;
        Ok(Response::new(energy, stress, tangent))
    }

    fn small_strain_moduli(&self) -> ElasticConstants {
        self.law.small_strain_moduli()
    }
}

#[test]
fn a_tangent_written_with_loops_conforms_and_a_wrong_one_does_not() {
    let law = |mistake| WrittenWithLoops {
        law: neo_hookean(2.1, 3.7),
        mistake,
    };
    // Symmetric to round-off, not to the last bit: at this state two entries differ.
    let c = right_cauchy_green(&turned_and_stretched(
        [0.6, 1.1, 1.9],
        &conformance::rotation([0.3, 0.2, 0.6]),
    ));
    let d = law(0.0).response(&c).unwrap().tangent;
    assert_ne!(d, d.transpose());
    check(&law(0.0), &Options::default()).unwrap();
    let Err(Violation::Differs { property, .. }) = check(&law(1e-9), &Options::default()) else {
        panic!()
    };
    assert_eq!(property, Property::TangentIsSymmetric);
    // To whom the symmetry is all the same, the comparison with the energy still finds it.
    let careless = Options::default().with_symmetry_tolerance(1.0);
    let Err(Violation::Differs { property, .. }) = check(&law(1e-8), &careless) else {
        panic!()
    };
    assert_eq!(property, Property::TangentIsSecondDerivativeOfEnergy);
}
