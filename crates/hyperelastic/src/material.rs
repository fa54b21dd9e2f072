//! What a hyperelastic law is: energy, stress and tangent as functions of `C`.

use std::fmt::Debug;

use crate::elastic_constants::ElasticConstants;
use crate::inverted::Inverted;
use crate::real::Real;
use crate::tensor::{Symmetric, Tangent};

/// Energy, stress and tangent at one state.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Response {
    /// `W`, strain energy per reference volume \[J/m^3\].
    pub energy: f64,
    /// `S = 2 dW/dC`, second Piola-Kirchhoff stress \[Pa\]: tensor components 11 22 33 12 13 23.
    pub stress: Symmetric,
    /// `D = dS/dE` \[Pa\]: tensor components `D_ijkl`, so that
    /// `dS = D (dE_11, dE_22, dE_33, 2 dE_12, 2 dE_13, 2 dE_23)`.
    ///
    /// Symmetric to round-off: `|D_ij - D_ji|` is a few units in the last place of the largest component of `S` and
    /// `D`, and no more is demanded of a law. Who needs both triangles to hold the same bits symmetrises, or reads one
    /// of them.
    pub tangent: Tangent,
}

impl Response {
    /// Energy `W` \[J/m^3\], stress `S` \[Pa\] and tangent `D` \[Pa\] of one state.
    #[must_use]
    #[inline]
    pub fn new(energy: f64, stress: Symmetric, tangent: Tangent) -> Self {
        Self {
            energy,
            stress,
            tangent,
        }
    }
}

/// A hyperelastic law `C -> (W, S, D)`.
///
/// `C = F^T F` holds the tensor components 11 22 33 12 13 23; shear components are not doubled.
/// A law is a pure function: it never returns NaN, and it has no history.
///
/// # Writing a law
/// Write `energy` with the operators of [`Real`], and `stress` and `response` from its derivatives by hand. Then let
/// `conformance::check` compare them. Compute the energy from `C - I` where you can: the differences of the invariants
/// lose all digits of a small strain (see [`StretchInvariants`](crate::StretchInvariants)). The tangent has to be
/// symmetric to round-off, not to the last bit: loops over the components will do. `examples/own_law.rs` is a law of a
/// page.
pub trait Material: Clone + Debug + Send + Sync + 'static {
    /// Strain energy `W` per reference volume \[J/m^3\].
    ///
    /// # Errors
    /// [`Inverted`] if the law has no energy at `C`.
    fn energy<T: Real>(&self, c: &Symmetric<T>) -> Result<T, Inverted>;

    /// Energy `W` \[J/m^3\] and second Piola-Kirchhoff stress `S` \[Pa\].
    ///
    /// # Errors
    /// [`Inverted`] if the law has no energy at `C`.
    fn stress(&self, c: &Symmetric) -> Result<(f64, Symmetric), Inverted>;

    /// Energy `W` \[J/m^3\], stress `S` \[Pa\] and tangent `D` \[Pa\].
    ///
    /// # Errors
    /// [`Inverted`] if the law has no energy at `C`.
    fn response(&self, c: &Symmetric) -> Result<Response, Inverted>;

    /// The moduli of the linear law that this one tends to at `F = I` \[Pa\]: for wave speeds and contact scales.
    fn small_strain_moduli(&self) -> ElasticConstants;
}
