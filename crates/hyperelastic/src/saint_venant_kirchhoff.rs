//! Saint Venant-Kirchhoff: Hooke's law between `S` and `E`.

use crate::elastic_constants::ElasticConstants;
use crate::inverted::Inverted;
use crate::material::{Material, Response};
use crate::parameter::ParameterError;
use crate::real::Real;
use crate::stretch::require_finite;
use crate::tensor::{self, Symmetric};

/// `W = lambda/2 (tr E)^2 + G E:E = K/2 (tr E)^2 + G tr(E_d^2)` \[Feng2007, eq. 19, with the trace of the square\].
///
/// For large rotations and small strains. The energy is convex in `E` but not polyconvex: compressed in one
/// direction, the force has its maximum at a stretch `1/sqrt 3 = .577` and then falls, to zero for flat matter:
/// nothing resists inversion, and no `C` is refused but one that is not finite.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SaintVenantKirchhoff {
    elastic: ElasticConstants,
}

impl SaintVenantKirchhoff {
    /// The law with these moduli.
    ///
    /// # Errors
    /// None beyond those of [`ElasticConstants`]; the signature is that of all laws.
    pub fn new(elastic: ElasticConstants) -> Result<Self, ParameterError> {
        Ok(Self { elastic })
    }

    #[inline]
    fn energy_of_strain<T: Real>(&self, e: &Symmetric<T>) -> T {
        let trace = tensor::trace(e);
        trace * trace * (0.5 * self.elastic.lame_modulus())
            + tensor::norm_squared(e) * self.elastic.shear_modulus()
    }
}

impl Material for SaintVenantKirchhoff {
    #[inline]
    fn energy<T: Real>(&self, c: &Symmetric<T>) -> Result<T, Inverted> {
        require_finite(c)?;
        Ok(self.energy_of_strain(&tensor::green_lagrange(c)))
    }

    #[inline]
    fn stress(&self, c: &Symmetric) -> Result<(f64, Symmetric), Inverted> {
        require_finite(c)?;
        let e = tensor::green_lagrange(c);
        let pressure = self.elastic.lame_modulus() * tensor::trace(&e);
        let [s11, s22, s33, s12, s13, s23] =
            e.data.0[0].map(|e| 2.0 * self.elastic.shear_modulus() * e);
        let stress = Symmetric::new(
            s11 + pressure,
            s22 + pressure,
            s33 + pressure,
            s12,
            s13,
            s23,
        );
        Ok((self.energy_of_strain(&e), stress))
    }

    #[inline]
    fn response(&self, c: &Symmetric) -> Result<Response, Inverted> {
        let (energy, stress) = self.stress(c)?;
        let tangent = tensor::isotropic(self.elastic.lame_modulus(), self.elastic.shear_modulus());
        Ok(Response::new(energy, stress, tangent))
    }

    fn small_strain_moduli(&self) -> ElasticConstants {
        self.elastic
    }
}
