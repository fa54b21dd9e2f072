//! An own law, Mooney-Rivlin with a volumetric term, and the battery that compares its formulas with its energy.
//!
//! `cargo run -p hyperelastic --features conformance --example own_law`

use hyperelastic::conformance::{self, ClosedForm, Options};
use hyperelastic::nalgebra::Matrix3;
use hyperelastic::{ElasticConstants, Inverted, Material, Real, Response};
use hyperelastic::{StretchInvariants, Symmetric, tensor};

/// `W = c1 (I_1 - 3) + c2 (I_2 - 3) - (2 c1 + 4 c2) ln J + k/2 (ln J)^2`, moduli in \[Pa\].
#[derive(Clone, Debug)]
struct MooneyRivlin {
    c1: f64,
    c2: f64,
    k: f64,
    /// At the reference `D = (4 c2 + k) I (x) I + (4 c1 + 4 c2) I4`.
    elastic: ElasticConstants,
}

impl MooneyRivlin {
    /// The factor of `C^-1` in the stress \[Pa\]: without its constants the reference would not be free of stress.
    fn along_inverse(&self, ln_det_c: f64) -> f64 {
        0.5 * self.k * ln_det_c - 2.0 * self.c1 - 4.0 * self.c2
    }
}

impl Material for MooneyRivlin {
    fn energy<T: Real>(&self, c: &Symmetric<T>) -> Result<T, Inverted> {
        let invariants = StretchInvariants::new(c)?;
        // I_1 - 3 = A_1 and I_2 - 3 = 2 A_1 + A_2 with the invariants of A = C - I: small strains keep their digits.
        let ([a1, a2, _], ln_det_c) = (invariants.excess, invariants.ln_det_c());
        Ok((a1 - ln_det_c) * (self.c1 + 2.0 * self.c2)
            + a2 * self.c2
            + ln_det_c * ln_det_c * (0.125 * self.k))
    }

    /// `S = 2 c1 I + 2 c2 (I_1 I - C) + (k ln J - 2 c1 - 4 c2) C^-1`.
    fn stress(&self, c: &Symmetric) -> Result<(f64, Symmetric), Inverted> {
        let invariants = StretchInvariants::new(c)?;
        let along_unit = 2.0 * self.c1 + 2.0 * self.c2 * tensor::trace(c);
        let stress = tensor::IDENTITY * along_unit - c * (2.0 * self.c2)
            + invariants.inverse() * self.along_inverse(invariants.ln_det_c());
        Ok((self.energy(c)?, stress))
    }

    /// Loops over the indices of the textbook would do as well: `D` has to be symmetric to round-off only.
    fn response(&self, c: &Symmetric) -> Result<Response, Inverted> {
        let (energy, stress) = self.stress(c)?;
        let invariants = StretchInvariants::new(c)?;
        let inverse = invariants.inverse();
        let mut tangent = tensor::isotropic(4.0 * self.c2, -2.0 * self.c2)
            - tensor::symmetric_product(&inverse, &inverse)
                * self.along_inverse(invariants.ln_det_c());
        tensor::add_dyad(&mut tangent, self.k, &inverse);
        Ok(Response::new(energy, stress, tangent))
    }

    fn small_strain_moduli(&self) -> ElasticConstants {
        self.elastic
    }
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let (c1, c2, k) = (0.4e6, 0.1e6, 5.0e6);
    let elastic = ElasticConstants::from_shear_lame(2.0 * (c1 + c2), 4.0 * c2 + k)?;
    let law = MooneyRivlin { c1, c2, k, elastic };

    // Stress and tangent against dual numbers and differences of the energy, at 200 states and the special ones.
    conformance::check(&law, &Options::default())?;
    println!("{law:?}\nconforms: stress and tangent are the derivatives of the energy");

    // Simple shear by g: sigma_12 = G g, and beside it the normal stresses of second order (Poynting's effect).
    let (g, modulus) = (0.7, elastic.shear_modulus());
    let shear = Matrix3::new(1.0, g, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0);
    let (s11, s33, s12) = (modulus * g * g, 2.0 * c2 * g * g, modulus * g);
    let known = ClosedForm::Cauchy(Symmetric::new(s11, 0.0, s33, s12, 0.0, 0.0));
    conformance::check_homogeneous(&law, &shear, &known, 1e-13)?;
    println!("simple shear by {g}: sigma_12 = {s12:.3e} Pa, sigma_11 = {s11:.3e} Pa");

    // What the battery says of a mistake: without c2 the tangent at the reference is not that of the moduli it names.
    let forgetful = MooneyRivlin { c2: 0.0, ..law };
    match conformance::check(&forgetful, &Options::default()) {
        Err(violation) => println!("a wrong law is found:\n  {violation}"),
        Ok(()) => return Err("the battery missed a mistake".into()),
    }
    Ok(())
}
