//! What a hyperelastic law is: energy, stress and tangent as functions of `C`.

use std::fmt::Debug;

use crate::elastic_constants::ElasticConstants;
use crate::real::Real;

/// Energy, stress and tangent at one state.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Response {
    /// `W`, strain energy per reference volume \[J/m^3\].
    pub energy: f64,
    /// `S = 2 dW/dC`, second Piola-Kirchhoff stress \[Pa\]: tensor components 11 22 33 12 13 23.
    pub stress: [f64; 6],
    /// `D = dS/dE` \[Pa\]: tensor components `D_ijkl`, so that `dS = D (dE_11, dE_22, dE_33, 2 dE_12, 2 dE_13, 2 dE_23)`.
    /// Symmetric to the last bit.
    pub tangent: [[f64; 6]; 6],
}

/// A hyperelastic law `C -> (W, S, D)`.
///
/// `C = F^T F` holds the tensor components 11 22 33 12 13 23; shear components are not doubled.
/// A law is a pure function: it never returns NaN, and it has no history.
///
/// # Writing a law
/// Write `energy` with the operators of [`Real`], and `stress` and `response` from its derivatives by hand.
/// Then let `conformance::check` compare them. Compute the energy from `C - I` where you can: the
/// differences of the invariants lose all digits of a small strain (see [`StretchInvariants`](crate::StretchInvariants)).
pub trait Material: Clone + Debug + Send + Sync + 'static {
    /// Strain energy `W` per reference volume \[J/m^3\].
    ///
    /// # Errors
    /// [`Inverted`] if the law has no energy at `C`.
    fn energy<T: Real>(&self, c: &[T; 6]) -> Result<T, Inverted>;

    /// Energy `W` \[J/m^3\] and second Piola-Kirchhoff stress `S` \[Pa\].
    ///
    /// # Errors
    /// [`Inverted`] if the law has no energy at `C`.
    fn stress(&self, c: &[f64; 6]) -> Result<(f64, [f64; 6]), Inverted>;

    /// Energy `W` \[J/m^3\], stress `S` \[Pa\] and tangent `D` \[Pa\].
    ///
    /// # Errors
    /// [`Inverted`] if the law has no energy at `C`.
    fn response(&self, c: &[f64; 6]) -> Result<Response, Inverted>;

    /// The moduli of the linear law that this one tends to at `F = I` \[Pa\]: for wave speeds and contact scales.
    fn small_strain_moduli(&self) -> ElasticConstants;
}

/// The law has no energy at this state: the matter is inverted, collapsed, or the state is not a number.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error("{}; cut the step, or refine the mesh where it happens", self.description())]
pub struct Inverted {
    /// `det C = J^2` of the state that was refused; NaN or infinite if `C` was [-].
    pub det_c: f64,
}

impl Inverted {
    fn description(&self) -> String {
        let det_c = self.det_c;
        if !det_c.is_finite() {
            format!("the strain is not finite (det C = {det_c})")
        } else if det_c <= 0.0 {
            format!("the matter is inverted or flat (det C = {det_c:e})")
        } else {
            format!(
                "the strain cannot be that of matter: det C = {det_c:e}, C not positive definite or out of all bounds"
            )
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn refusals_say_what_happened() {
        let message = |det_c| Inverted { det_c }.to_string();
        assert!(message(f64::NAN).contains("not finite"));
        assert!(message(-0.25).contains("inverted or flat (det C = -2.5e-1)"));
        assert!(message(2.0).contains("not positive definite"));
        assert!(message(0.0).contains("cut the step"));
    }
}
