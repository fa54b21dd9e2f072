//! An own law, Mooney-Rivlin with a volumetric term, and the battery that compares its formulas with its energy.
//!
//! `cargo run -p hyperelastic --features conformance --example own_law`

use hyperelastic::conformance::{self, ClosedForm, Options};
use hyperelastic::nalgebra::Matrix3;
use hyperelastic::tensor::{self, COMPONENTS};
use hyperelastic::{
    ElasticConstants, Inverted, Material, ParameterError, Real, Response, StretchInvariants,
    Symmetric, Tangent,
};

/// `W = c1 (I_1 - 3) + c2 (I_2 - 3) - (2 c1 + 4 c2) ln J + k/2 (ln J)^2`.
///
/// With `I_2 = ((tr C)^2 - tr C^2)/2` and the derivatives of `J`:
/// `S = 2 c1 I + 2 c2 (I_1 I - C) + (k ln J - 2 c1 - 4 c2) C^-1`.
#[derive(Clone, Debug)]
struct MooneyRivlin {
    c1: f64,
    c2: f64,
    k: f64,
    elastic: ElasticConstants,
}

impl MooneyRivlin {
    /// The law with the constants `c1`, `c2` and `k` \[Pa\]; at the reference `D = (4 c2 + k) I (x) I + (4 c1 + 4 c2) I4`.
    fn new(c1: f64, c2: f64, k: f64) -> Result<Self, ParameterError> {
        let elastic = ElasticConstants::from_shear_lame(2.0 * (c1 + c2), 4.0 * c2 + k)?;
        Ok(Self { c1, c2, k, elastic })
    }

    /// The factor of `C^-1` in the stress: the logarithm of `J` minus what makes the reference free of stress \[Pa\].
    fn along_inverse(&self, ln_det_c: f64) -> f64 {
        0.5 * self.k * ln_det_c - 2.0 * self.c1 - 4.0 * self.c2
    }
}

impl Material for MooneyRivlin {
    fn energy<T: Real>(&self, c: &Symmetric<T>) -> Result<T, Inverted> {
        let invariants = StretchInvariants::new(c)?;
        // In the invariants of A = C - I: I_1 - 3 = A_1 and I_2 - 3 = 2 A_1 + A_2, so that small strains keep their digits.
        let [a1, a2, _] = invariants.excess;
        let ln_det_c = invariants.ln_det_c();
        Ok((a1 - ln_det_c) * (self.c1 + 2.0 * self.c2)
            + a2 * self.c2
            + ln_det_c * ln_det_c * (0.125 * self.k))
    }

    fn stress(&self, c: &Symmetric) -> Result<(f64, Symmetric), Inverted> {
        let invariants = StretchInvariants::new(c)?;
        let along_unit = 2.0 * self.c1 + 2.0 * self.c2 * tensor::trace(c);
        let stress = tensor::IDENTITY * along_unit - c * (2.0 * self.c2)
            + invariants.inverse() * self.along_inverse(invariants.ln_det_c());
        Ok((self.energy(c)?, stress))
    }

    fn response(&self, c: &Symmetric) -> Result<Response, Inverted> {
        let (energy, stress) = self.stress(c)?;
        let invariants = StretchInvariants::new(c)?;
        let (unit, inverse) = (
            Matrix3::identity(),
            tensor::to_matrix(&invariants.inverse()),
        );
        let along_inverse = self.along_inverse(invariants.ln_det_c());
        // The formula of the textbook, index by index: symmetric to round-off, which is enough.
        let mut tangent = Tangent::zeros();
        for (row, (i, j)) in COMPONENTS.into_iter().enumerate() {
            for (column, (k, l)) in COMPONENTS.into_iter().enumerate() {
                let half = |m: &Matrix3<f64>| m[(i, k)] * m[(j, l)] + m[(i, l)] * m[(j, k)];
                tangent[(row, column)] = 4.0 * self.c2 * unit[(i, j)] * unit[(k, l)]
                    - 2.0 * self.c2 * half(&unit)
                    + self.k * inverse[(i, j)] * inverse[(k, l)]
                    - along_inverse * half(&inverse);
            }
        }
        Ok(Response::new(energy, stress, tangent))
    }

    fn small_strain_moduli(&self) -> ElasticConstants {
        self.elastic
    }
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let law = MooneyRivlin::new(0.4e6, 0.1e6, 5.0e6)?;
    let moduli = law.small_strain_moduli();
    println!(
        "Mooney-Rivlin, c1 = {:e} Pa, c2 = {:e} Pa, k = {:e} Pa: G = {:.2e} Pa, nu = {:.3}",
        law.c1,
        law.c2,
        law.k,
        moduli.shear_modulus(),
        moduli.poisson_ratio()
    );

    // Stress and tangent against dual numbers and differences of the energy, at 200 states and the special ones.
    conformance::check(&law, &Options::default())?;
    println!("conforms: stress and tangent are the derivatives of the energy");

    // Simple shear by k: sigma_12 = G k, and beside it the normal stresses of second order (Poynting's effect).
    let k = 0.7;
    let shear = Matrix3::new(1.0, k, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0);
    let modulus = moduli.shear_modulus();
    let sigma = Symmetric::new(
        modulus * k * k,
        0.0,
        2.0 * law.c2 * k * k,
        modulus * k,
        0.0,
        0.0,
    );
    conformance::check_homogeneous(&law, &shear, &ClosedForm::Cauchy(sigma), 1e-13)?;
    println!(
        "has the closed form of simple shear: sigma_12 = {:.3e} Pa, sigma_11 = {:.3e} Pa at k = {k}",
        sigma[3], sigma[0]
    );

    // What the battery says of a mistake.
    let wrong = Forgetful(law);
    match conformance::check(&wrong, &Options::default()) {
        Err(violation) => println!("a wrong tangent is found:\n  {violation}"),
        Ok(()) => return Err("the battery missed a wrong tangent".into()),
    }
    Ok(())
}

/// The law with a tangent that lacks a tenth of the stiffness against change of volume.
#[derive(Clone, Debug)]
struct Forgetful(MooneyRivlin);

impl Material for Forgetful {
    fn energy<T: Real>(&self, c: &Symmetric<T>) -> Result<T, Inverted> {
        self.0.energy(c)
    }

    fn stress(&self, c: &Symmetric) -> Result<(f64, Symmetric), Inverted> {
        self.0.stress(c)
    }

    fn response(&self, c: &Symmetric) -> Result<Response, Inverted> {
        let mut response = self.0.response(c)?;
        let inverse = StretchInvariants::new(c)?.inverse();
        tensor::add_dyad(&mut response.tangent, -0.1 * self.0.k, &inverse);
        Ok(response)
    }

    fn small_strain_moduli(&self) -> ElasticConstants {
        self.0.small_strain_moduli()
    }
}
