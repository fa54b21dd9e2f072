//! Compressible neo-Hookean law with the squared logarithm of `J`.

use crate::elastic_constants::ElasticConstants;
use crate::inverted::Inverted;
use crate::material::{Material, Response};
use crate::parameter::{ParameterError, inside_closed};
use crate::real::Real;
use crate::stretch::StretchInvariants;
use crate::tensor::{self, Symmetric, Tangent};

/// `W = G/2 (I_1 - 3 - 2 ln J) + lambda/2 (ln J)^2`, `S = G (I - C^-1) + lambda ln J C^-1`.
///
/// `D = lambda C^-1 (x) C^-1 + 2 (G - lambda ln J) C^-1 (.) C^-1`. The energy grows without bound as matter collapses.
/// The part in `ln J` is convex in `J` only up to `J = e`: not for large increases of volume.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NeoHookean {
    elastic: ElasticConstants,
}

impl NeoHookean {
    /// The law with these moduli.
    ///
    /// # Errors
    /// If `lambda < 0` (`nu < 0`): the energy would fall without bound as matter collapses.
    pub fn new(elastic: ElasticConstants) -> Result<Self, ParameterError> {
        let reason =
            "with nu < 0 this energy falls without bound as J -> 0; choose nu >= 0 or another law";
        inside_closed(
            "Lame's lambda",
            elastic.lame_modulus(),
            [0.0, f64::INFINITY],
            reason,
        )?;
        Ok(Self { elastic })
    }

    #[inline]
    fn energy_of<T: Real>(&self, invariants: &StretchInvariants<T>, ln_det_c: T) -> T {
        (invariants.excess[0] - ln_det_c) * (0.5 * self.elastic.shear_modulus())
            + ln_det_c * ln_det_c * (0.125 * self.elastic.lame_modulus())
    }

    #[inline]
    fn stress_of(&self, ln_det_c: f64, inverse: &Symmetric) -> Symmetric {
        let shear = self.elastic.shear_modulus();
        let along_inverse = 0.5 * self.elastic.lame_modulus() * ln_det_c;
        let ([unit], [inverse]) = (&tensor::IDENTITY.data.0, &inverse.data.0);
        tensor::by_component(|i| shear * (unit[i] - inverse[i]) + along_inverse * inverse[i])
    }

    #[inline]
    fn tangent_of(&self, ln_det_c: f64, inverse: &Symmetric) -> Tangent {
        let lambda = self.elastic.lame_modulus();
        let along_inverse = self.elastic.shear_modulus() - 0.5 * lambda * ln_det_c;
        let [b] = &inverse.data.0;
        let scaled = tensor::by_component(|i| along_inverse * b[i]);
        let mut d = tensor::symmetric_product(inverse, &scaled);
        tensor::add_dyad(&mut d, lambda, inverse);
        d
    }
}

impl Material for NeoHookean {
    #[inline]
    fn energy<T: Real>(&self, c: &Symmetric<T>) -> Result<T, Inverted> {
        let invariants = StretchInvariants::new(c)?;
        Ok(self.energy_of(&invariants, invariants.ln_det_c()))
    }

    #[inline]
    fn stress(&self, c: &Symmetric) -> Result<(f64, Symmetric), Inverted> {
        let invariants = StretchInvariants::new(c)?;
        let ln_det_c = invariants.ln_det_c();
        let stress = self.stress_of(ln_det_c, &invariants.inverse());
        Ok((self.energy_of(&invariants, ln_det_c), stress))
    }

    #[inline]
    fn response(&self, c: &Symmetric) -> Result<Response, Inverted> {
        let invariants = StretchInvariants::new(c)?;
        let ln_det_c = invariants.ln_det_c();
        let inverse = invariants.inverse();
        Ok(Response::new(
            self.energy_of(&invariants, ln_det_c),
            self.stress_of(ln_det_c, &inverse),
            self.tangent_of(ln_det_c, &inverse),
        ))
    }

    fn small_strain_moduli(&self) -> ElasticConstants {
        self.elastic
    }
}
