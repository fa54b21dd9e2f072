//! Hyperelastic laws: strain energy `W`, stress `S` and tangent `D` from the right Cauchy-Green tensor `C`.
//!
//! A law is a pure function of `C = F^T F`, so it is objective by construction, and knows nothing of elements, meshes or time.
//! Everything is closed-form on fixed-size arrays.
//!
//! | law | energy | parameters | valid |
//! |---|---|---|---|
//! | [`SaintVenantKirchhoff`] | `K/2 (tr E)^2 + G tr(E_d^2)` | two moduli | large rotation, small strain |
//! | [`ThreeE`] | quartic in `E` \[Feng2007, eq. 16\] | two moduli, `a1 .. a5` | moderate strain |
//! | [`BlatzKo`] | `G/2 (I_2/I_3 + 2J - 5)` \[Hu2022, eq. 37\] | `G` (`nu = 1/4`) | large strain, foams |
//! | [`NeoHookean`] | `G/2 (I_1 - 3 - 2 ln J) + lambda/2 (ln J)^2` | two moduli, `nu >= 0` | large strain |
//!
//! The first two are convex in `E` and not polyconvex: under uniaxial strain their resistance to compression falls below a
//! stretch of `1/sqrt 3` (near .58 for 3e) and vanishes for flat matter. Meshes compressed so far collapse; the other two laws
//! resist ever more, and refuse `J <= 0` with [`Inverted`].
//!
//! # Conventions
//! SI units; moduli and stresses in \[Pa\], energies in \[J/m^3\] of reference volume. Symmetric tensors are six *tensor* components in the
//! order 11 22 33 12 13 23, shear not doubled. The tangent `D_ijkl = dS_ij/dE_kl` is a symmetric 6x6 matrix in the
//! same order, and multiplies engineering shear: `dS = D (dE_11, dE_22, dE_33, 2 dE_12, 2 dE_13, 2 dE_23)`.
//!
//! # Example
//! ```
//! use hyperelastic::{BlatzKo, Material};
//!
//! let foam = BlatzKo::new(10.0e6)?;
//! // Pulled to 1.5 times its length while its width is held: C = diag(l^2, 1, 1).
//! let l: f64 = 1.5;
//! let response = foam.response(&[l * l, 1.0, 1.0, 0.0, 0.0, 0.0])?;
//! // Force per reference area is l S_11 = G (1 - l^-3).
//! assert!((l * response.stress[0] - 10.0e6 * (1.0 - l.powi(-3))).abs() < 1.0);
//!
//! let moduli = foam.small_strain_moduli();
//! assert!((moduli.poisson_ratio() - 0.25).abs() < 1e-15);
//!
//! // Inverted matter is an error, never a NaN.
//! assert!(foam.response(&[-1.0, 1.0, 1.0, 0.0, 0.0, 0.0]).is_err());
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # Adding a law
//! One file with an implementation of [`Material`], and a test that calls the battery `conformance::check` (feature `conformance`, on by default).

pub mod tensor;

#[cfg(feature = "conformance")]
pub mod conformance;

mod blatz_ko;
mod elastic_constants;
mod material;
mod neo_hookean;
mod parameter;
mod real;
mod saint_venant_kirchhoff;
mod three_e;

pub use blatz_ko::BlatzKo;
pub use elastic_constants::ElasticConstants;
pub use material::{Inverted, Material, Response};
pub use neo_hookean::NeoHookean;
pub use parameter::ParameterError;
pub use real::Real;
pub use saint_venant_kirchhoff::SaintVenantKirchhoff;
pub use tensor::StretchInvariants;
pub use three_e::ThreeE;
