//! Hyperelastic laws: strain energy `W`, stress `S` and tangent `D` from the right Cauchy-Green tensor `C`.
//!
//! A law is a pure function of `C = F^T F`, so it is objective by construction, and knows nothing of elements, meshes
//! or time. Everything is closed-form on `nalgebra`'s matrices of fixed size, which are re-exported as [`nalgebra`].
//!
//! | law | energy | parameters | valid |
//! |---|---|---|---|
//! | [`SaintVenantKirchhoff`] | `K/2 (tr E)^2 + G tr(E_d^2)` | two moduli | large rotation, small strain |
//! | [`ThreeE`] | quartic in `E` \[Feng2007, eq. 16\] | two moduli, `a1 .. a5` | moderate strain |
//! | [`BlatzKo`] | `G/2 (I_2/I_3 + 2J - 5)` \[Hu2022, eq. 37\] | `G` (`nu = 1/4`) | large strain, foams |
//! | [`NeoHookean`] | `G/2 (I_1 - 3 - 2 ln J) + lambda/2 (ln J)^2` | two moduli, `nu >= 0` | large strain |
//!
//! The first two are convex in `E` and not polyconvex: under uniaxial strain their resistance to compression falls
//! below a stretch of `1/sqrt 3` (near .58 for 3e) and vanishes for flat matter. Meshes compressed so far collapse; the
//! other two laws resist ever more, and refuse `J <= 0` with [`Inverted`].
//!
//! # Conventions
//! SI units; moduli and stresses in \[Pa\], energies in \[J/m^3\] of reference volume. Symmetric tensors are six
//! *tensor* components in the order 11 22 33 12 13 23, shear not doubled. The tangent `D_ijkl = dS_ij/dE_kl` is a
//! symmetric 6x6 matrix in the same order, and multiplies engineering shear:
//! `dS = D (dE_11, dE_22, dE_33, 2 dE_12, 2 dE_13, 2 dE_23)`.
//!
//! # Example
//! ```
//! use hyperelastic::{BlatzKo, Material, Symmetric};
//!
//! let foam = BlatzKo::new(10.0e6)?;
//! // Pulled to 1.5 times its length while its width is held: C = diag(l^2, 1, 1).
//! let l: f64 = 1.5;
//! let response = foam.response(&Symmetric::new(l * l, 1.0, 1.0, 0.0, 0.0, 0.0))?;
//! // Force per reference area is l S_11 = G (1 - l^-3).
//! assert!((l * response.stress[0] - 10.0e6 * (1.0 - l.powi(-3))).abs() < 1.0);
//!
//! let moduli = foam.small_strain_moduli();
//! assert!((moduli.poisson_ratio() - 0.25).abs() < 1e-15);
//!
//! // Inverted matter is an error, never a NaN.
//! assert!(foam.response(&Symmetric::new(-1.0, 1.0, 1.0, 0.0, 0.0, 0.0)).is_err());
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # Adding a law
//! One file with an implementation of [`Material`], and a test that calls the battery `conformance::check` (feature
//! `conformance`, off by default).

pub mod tensor;

#[cfg(feature = "conformance")]
pub mod conformance;

/// The example of the README is a doc test.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;

mod blatz_ko;
mod deformation;
mod elastic_constants;
mod inverted;
mod material;
mod neo_hookean;
mod parameter;
mod real;
mod saint_venant_kirchhoff;
mod stretch;
mod three_e;

pub use blatz_ko::BlatzKo;
pub use deformation::{cauchy, first_piola, right_cauchy_green, von_mises};
pub use elastic_constants::ElasticConstants;
pub use inverted::Inverted;
pub use material::{Material, Response};
pub use nalgebra;
pub use neo_hookean::NeoHookean;
pub use parameter::ParameterError;
pub use real::Real;
pub use saint_venant_kirchhoff::SaintVenantKirchhoff;
pub use stretch::{StretchInvariants, require_finite};
pub use tensor::{Symmetric, Tangent};
pub use three_e::ThreeE;

/// Relative difference \[-\] below which two numbers are the same: 64 units in the last place. A sum of a few dozen
/// terms, or a chain of as many operations, stays within it; what differs by more differs for another reason than
/// rounding.
pub const ROUND_OFF: f64 = 64.0 * f64::EPSILON;
