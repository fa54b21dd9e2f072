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
//! Add the law's closed forms with [`check_homogeneous`], and drive [`check_state`] from a property test to search
//! where the fixed states of [`check`] do not look. All of it is deterministic, and nothing panics: a failure is a
//! [`Violation`].

mod derivatives;
mod probe;
mod states;
mod violation;

use nalgebra::Matrix3;

use crate::ROUND_OFF;
use crate::deformation::{cauchy, first_piola, right_cauchy_green};
use crate::material::Material;
use crate::tensor::{self, Symmetric};
use probe::Probe;
pub use states::rotation;
pub use violation::{Component, Property, Violation};

/// What the battery demands.
///
/// ```
/// use hyperelastic::conformance::Options;
///
/// let foam = Options::default().with_stretches([0.1, 10.0]).with_tolerance(1e-8);
/// assert_eq!(foam.states, Options::default().states);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Options {
    /// Number of general states, beside the special ones (reference, equal stretches, tiny strains).
    pub states: usize,
    /// Smallest and largest principal stretch of the general states.
    pub stretches: [f64; 2],
    /// Whether `W(Q C Q^T) = W(C)`, and Hooke's law with two moduli at the reference, are demanded.
    pub isotropic: bool,
    /// Allowed relative difference of what agrees up to round-off: hand-written and dual-number derivatives, rotated
    /// states \[-\].
    pub tolerance: f64,
    /// Allowed relative difference from central differences \[-\].
    pub difference_tolerance: f64,
    /// Allowed `|D_ij - D_ji|`, relative to the largest component of `S` and `D` \[-\]: the round-off of some tens of
    /// terms that are summed in different orders, [`ROUND_OFF`].
    pub symmetry_tolerance: f64,
}

impl Options {
    /// With another number of general states.
    #[must_use]
    pub fn with_states(mut self, states: usize) -> Self {
        self.states = states;
        self
    }

    /// With another range of the principal stretches \[-\].
    #[must_use]
    pub fn with_stretches(mut self, stretches: [f64; 2]) -> Self {
        self.stretches = stretches;
        self
    }

    /// For a law that is not isotropic.
    #[must_use]
    pub fn anisotropic(mut self) -> Self {
        self.isotropic = false;
        self
    }

    /// With another tolerance of what agrees up to round-off \[-\].
    #[must_use]
    pub fn with_tolerance(mut self, tolerance: f64) -> Self {
        self.tolerance = tolerance;
        self
    }

    /// With another tolerance of central differences \[-\].
    #[must_use]
    pub fn with_difference_tolerance(mut self, tolerance: f64) -> Self {
        self.difference_tolerance = tolerance;
        self
    }

    /// With another tolerance of the symmetry of the tangent \[-\]: for laws whose terms cancel.
    #[must_use]
    pub fn with_symmetry_tolerance(mut self, tolerance: f64) -> Self {
        self.symmetry_tolerance = tolerance;
        self
    }
}

impl Default for Options {
    fn default() -> Self {
        Self {
            states: 200,
            stretches: [0.3, 3.0],
            isotropic: true,
            tolerance: 1e-10,
            difference_tolerance: 1e-5,
            symmetry_tolerance: ROUND_OFF,
        }
    }
}

/// Stress known for a homogeneous deformation \[Pa\].
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum ClosedForm {
    /// `P = F S`: force per reference area, `P_ij` on the face with normal `j`.
    FirstPiola(Matrix3<f64>),
    /// `sigma = F S F^T/J`: force per deformed area, 11 22 33 12 13 23.
    Cauchy(Symmetric),
}

/// Allowed energy and stress at the reference, relative to the largest modulus \[-\]: what should be zero is some
/// round-offs.
const REFERENCE_TOLERANCE: f64 = 1e-14;
/// Allowed relative difference from the linear law at a strain of 1e-7 \[-\]: a hundred times the second-order terms of
/// a law with moderate curvature, a hundredth of what an energy that has lost its digits shows.
const SMALL_STRAIN_TOLERANCE: f64 = 1e-4;

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
    rotation: &Matrix3<f64>,
    options: &Options,
) -> Result<(), Violation> {
    let [c1, c2, c3] = stretches.map(|l| l.powi(2));
    let principal = Symmetric::new(c1, c2, c3, 0.0, 0.0, 0.0);
    let probe = Probe::new(material, states::rotate(&principal, rotation))?;
    probe.check_methods(options)?;
    probe.check_symmetry(options)?;
    probe.check_derivatives(options)?;
    if options.isotropic {
        Probe::new(material, principal)?.check_isotropy(&probe, rotation, options)
    } else {
        Ok(())
    }
}

/// Compares with the closed form of a homogeneous deformation `F`, to `tolerance` times the largest component of `S`
/// and `D`.
///
/// # Errors
/// The first [`Violation`] found.
pub fn check_homogeneous<M: Material>(
    material: &M,
    f: &Matrix3<f64>,
    expected: &ClosedForm,
    tolerance: f64,
) -> Result<(), Violation> {
    let probe = Probe::new(material, right_cauchy_green(f))?;
    let scale = tolerance * probe.scale;
    let stress = &probe.response.stress;
    match expected {
        ClosedForm::FirstPiola(expected) => probe.same_stresses(
            Property::ClosedForm,
            first_piola(f, stress).transpose().as_slice(),
            expected.transpose().as_slice(),
            scale,
        ),
        ClosedForm::Cauchy(expected) => {
            let found = cauchy(f, stress);
            probe.same_stresses(
                Property::ClosedForm,
                found.as_slice(),
                expected.as_slice(),
                scale,
            )
        }
    }
}

fn check_refusals<M: Material>(material: &M) -> Result<(), Violation> {
    for i in 0..6 {
        for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            let mut c = Symmetric::new(1.1, 0.9, 1.2, 0.1, -0.1, 0.2);
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
    let allowed = REFERENCE_TOLERANCE * reference.scale;
    reference.same(
        Property::ReferenceHasNoEnergy,
        Component::Energy,
        reference.response.energy,
        0.0,
        allowed,
    )?;
    reference.same_stresses(
        Property::ReferenceHasNoStress,
        reference.response.stress.as_slice(),
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
        let strain = tensor::engineering(&tensor::green_lagrange(&c));
        let linear = 0.5 * strain.dot(&(tangent * strain));
        let probe = Probe::new(material, c)?;
        let property = Property::EnergyResolvesSmallStrain;
        probe.same(
            property,
            Component::Energy,
            probe.response.energy,
            linear,
            SMALL_STRAIN_TOLERANCE * linear,
        )?;
    }
    Ok(())
}
