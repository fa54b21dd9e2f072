//! A law at a material point: the curve of uniaxial tension, with the lateral stretch that leaves the sides free.
//!
//! `cargo run -p hyperelastic --example material_point`

use hyperelastic::nalgebra::Matrix3;
use hyperelastic::{
    BlatzKo, ElasticConstants, Inverted, Material, NeoHookean, SaintVenantKirchhoff, ThreeE,
    cauchy, first_piola, right_cauchy_green,
};

/// Newton steps after which the lateral stretch counts as not found; from the stretch before, four are enough.
const MAX_STEPS: usize = 50;
/// Largest lateral stress, relative to the modulus \[-\].
const FREE: f64 = 1e-12;

/// The lateral stretch at which `S_22 = S_33 = 0` under the axial stretch `axial`, from the guess `lateral`.
///
/// `C_22 = C_33 = c`, and `dS_22 = (D_22 + D_23) dE` with `dE = dc/2`: Newton's method in one unknown.
fn lateral_stretch(law: &impl Material, axial: f64, lateral: f64) -> Result<f64, Inverted> {
    let mut c = lateral * lateral;
    for _ in 0..MAX_STEPS {
        let f = stretched(axial, c.sqrt());
        let response = law.response(&right_cauchy_green(&f))?;
        let stiffness = response.tangent[(1, 1)] + response.tangent[(1, 2)];
        if response.stress[1].abs() <= FREE * stiffness.abs() {
            break;
        }
        // A step that would turn the matter inside out is cut.
        c = (c - 2.0 * response.stress[1] / stiffness).max(0.25 * c);
    }
    Ok(c.sqrt())
}

fn stretched(axial: f64, lateral: f64) -> Matrix3<f64> {
    Matrix3::from_diagonal(&[axial, lateral, lateral].into())
}

/// One column of the table: force per reference area and per deformed area \[Pa\], and the change of volume.
fn curve(name: &str, law: &impl Material) -> Result<(), Inverted> {
    let moduli = law.small_strain_moduli();
    println!(
        "\n{name}: E = {:.3} MPa, nu = {:.3}",
        moduli.young_modulus() * 1e-6,
        moduli.poisson_ratio()
    );
    println!("  stretch  lateral   P_11 [MPa]  sigma_11 [MPa]       J");
    let mut lateral = 1.0;
    for percent in (100..=200).step_by(10) {
        let axial = f64::from(percent) * 1e-2;
        lateral = lateral_stretch(law, axial, lateral)?;
        let f = stretched(axial, lateral);
        let (_, stress) = law.stress(&right_cauchy_green(&f))?;
        println!(
            "  {axial:7.2}  {lateral:7.4}  {:11.4}  {:14.4}  {:6.4}",
            first_piola(&f, &stress)[(0, 0)] * 1e-6,
            cauchy(&f, &stress)[0] * 1e-6,
            f.determinant(),
        );
    }
    Ok(())
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let rubber = ElasticConstants::from_young_poisson(10.0e6, 0.25)?;
    let a = [0.0, 0.0, 0.0, 1.0e6, 1.0e6];
    curve(
        "Saint Venant-Kirchhoff",
        &SaintVenantKirchhoff::new(rubber)?,
    )?;
    curve("3e", &ThreeE::new(rubber, a)?)?;
    curve("neo-Hookean", &NeoHookean::new(rubber)?)?;
    curve("Blatz-Ko", &BlatzKo::new(rubber.shear_modulus())?)?;
    println!(
        "\nThe force of Blatz-Ko has its maximum at a stretch of 6^(2/5) = {:.3}.",
        6.0_f64.powf(0.4)
    );
    Ok(())
}
