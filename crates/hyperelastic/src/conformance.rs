//! The battery that every law has to pass: its formulas are its energy's derivatives, and the energy is physical.
//!
//! A law's test is a few lines:
//! ```
//! use hyperelastic::{ElasticConstants, NeoHookean, conformance};
//!
//! let law = NeoHookean::new(ElasticConstants::from_shear_lame(2.1e6, 2.1e6)?)?;
//! conformance::check(&law, &conformance::Options::default())?;
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//! Add the law's closed forms with [`check_homogeneous`], and drive [`check_state`] from a property test to search where
//! the fixed states of [`check`] do not look. All of it is deterministic, and nothing panics: a failure is a [`Violation`].

mod derivatives;
mod probe;
mod states;
mod violation;

use crate::material::Material;
use crate::tensor;
use probe::Probe;
pub use states::{cauchy, first_piola, right_cauchy_green, rotation};
pub use violation::{Component, Property, Violation};

/// What the battery demands.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Options {
    /// Number of general states, beside the special ones (reference, equal stretches, tiny strains).
    pub states: usize,
    /// Smallest and largest principal stretch of the general states.
    pub stretches: [f64; 2],
    /// Whether `W(Q C Q^T) = W(C)`, and Hooke's law with two moduli at the reference, are demanded.
    pub isotropic: bool,
    /// Allowed relative difference of what agrees up to round-off: hand-written and dual-number derivatives, rotated states [-].
    pub tolerance: f64,
    /// Allowed relative difference from central differences [-].
    pub difference_tolerance: f64,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            states: 200,
            stretches: [0.3, 3.0],
            isotropic: true,
            tolerance: 1e-10,
            difference_tolerance: 1e-5,
        }
    }
}

/// Stress known for a homogeneous deformation \[Pa\].
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ClosedForm {
    /// `P = F S`: force per reference area, `P_ij` on the face with normal `j`.
    FirstPiola([[f64; 3]; 3]),
    /// `sigma = F S F^T/J`: force per deformed area, 11 22 33 12 13 23.
    Cauchy([f64; 6]),
}

/// Runs the whole battery on a fixed set of states.
///
/// # Errors
/// The first [`Violation`] found.
pub fn check<M: Material>(material: &M, options: &Options) -> Result<(), Violation> {
    check_refusals(material)?;
    check_reference(material, options)?;
    for (stretches, rotation) in states::all(options) {
        check_state(material, stretches, &rotation, options)?;
    }
    Ok(())
}

/// Derivatives, symmetries and isotropy at `C = Q diag(l_1^2, l_2^2, l_3^2) Q^T`.
///
/// # Errors
/// The first [`Violation`] found.
pub fn check_state<M: Material>(
    material: &M,
    stretches: [f64; 3],
    rotation: &[[f64; 3]; 3],
    options: &Options,
) -> Result<(), Violation> {
    let principal = [
        stretches[0].powi(2),
        stretches[1].powi(2),
        stretches[2].powi(2),
        0.0,
        0.0,
        0.0,
    ];
    let probe = Probe::new(material, states::rotate(&principal, rotation))?;
    probe.check_methods(options)?;
    probe.check_derivatives(options)?;
    if options.isotropic {
        Probe::new(material, principal)?.check_isotropy(&probe, rotation, options)
    } else {
        Ok(())
    }
}

/// Compares with the closed form of a homogeneous deformation `F`, to `tolerance` times the largest component of `S` and `D`.
///
/// # Errors
/// The first [`Violation`] found.
pub fn check_homogeneous<M: Material>(
    material: &M,
    f: &[[f64; 3]; 3],
    expected: &ClosedForm,
    tolerance: f64,
) -> Result<(), Violation> {
    let probe = Probe::new(material, right_cauchy_green(f))?;
    let scale = tolerance * probe.scale;
    let stress = &probe.response.stress;
    match expected {
        ClosedForm::FirstPiola(expected) => probe.same_stresses(
            Property::ClosedForm,
            first_piola(f, stress).as_flattened(),
            expected.as_flattened(),
            scale,
        ),
        ClosedForm::Cauchy(expected) => {
            probe.same_stresses(Property::ClosedForm, &cauchy(f, stress), expected, scale)
        }
    }
}

fn check_refusals<M: Material>(material: &M) -> Result<(), Violation> {
    for i in 0..6 {
        for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            let mut c = [1.1, 0.9, 1.2, 0.1, -0.1, 0.2];
            c[i] = bad;
            let refused = material.energy(&c).is_err()
                && material.stress(&c).is_err()
                && material.response(&c).is_err();
            if !refused {
                return Err(Violation::Accepted {
                    property: Property::RefusesWhatIsNotFinite,
                    c,
                });
            }
        }
    }
    // Impossible or extreme states may be refused or not, but must not give NaN.
    for c in states::impossible() {
        if let Ok(response) = material.response(&c) {
            Probe {
                material,
                c,
                response,
                scale: f64::INFINITY,
            }
            .check_finite()?;
        }
    }
    Ok(())
}

fn check_reference<M: Material>(material: &M, options: &Options) -> Result<(), Violation> {
    let reference = Probe::new(material, tensor::IDENTITY)?;
    let allowed = 1e-14 * reference.scale;
    reference.same(
        Property::ReferenceHasNoEnergy,
        Component::Energy,
        reference.response.energy,
        0.0,
        allowed,
    )?;
    reference.same_stresses(
        Property::ReferenceHasNoStress,
        &reference.response.stress,
        &[0.0; 6],
        allowed,
    )?;
    let tangent = &reference.response.tangent;
    if options.isotropic {
        let moduli = material.small_strain_moduli();
        let hooke = tensor::isotropic(moduli.lame_modulus(), moduli.shear_modulus());
        reference.same_tangents(
            Property::SmallStrainModuli,
            tangent,
            &hooke,
            options.tolerance * reference.scale,
        )?;
    }
    for c in states::small_strains() {
        let e = tensor::green_lagrange(&c);
        let engineering = [e[0], e[1], e[2], 2.0 * e[3], 2.0 * e[4], 2.0 * e[5]];
        let linear = 0.5 * states::dot(&engineering, &states::times(tangent, &engineering));
        let probe = Probe::new(material, c)?;
        let property = Property::EnergyResolvesSmallStrain;
        probe.same(
            property,
            Component::Energy,
            probe.response.energy,
            linear,
            1e-4 * linear,
        )?;
    }
    Ok(())
}
