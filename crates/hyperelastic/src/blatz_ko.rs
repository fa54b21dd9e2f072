//! Blatz-Ko: compressible foam-like rubber with a single parameter.

use crate::elastic_constants::ElasticConstants;
use crate::inverted::Inverted;
use crate::material::{Material, Response};
use crate::parameter::ParameterError;
use crate::real::Real;
use crate::stretch::StretchInvariants;
use crate::tensor::{self, Symmetric, Tangent};

/// `W = G/2 (I_2/I_3 + 2 sqrt(I_3) - 5)` \[Hu2022, eq. 37\], `S = G (J C^-1 - C^-2)` \[Hu2022, eq. 39\].
///
/// `D = G [J C^-1 (x) C^-1 - 2J C^-1 (.) C^-1 + 2 (C^-1 (.) C^-2 + C^-2 (.) C^-1)]`, which the paper does not give. At
/// `F = I` it is Hooke's law with `nu = 1/4`, `E = 5G/2`. The energy grows without bound as matter collapses. A bar in
/// tension softens: the nominal stress `G (l^(-1/2) - l^-3)` has its maximum at the stretch `l = 6^(2/5) = 2.05`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BlatzKo {
    elastic: ElasticConstants,
}

impl BlatzKo {
    /// The law with the shear modulus `G` \[Pa\].
    ///
    /// # Errors
    /// Unless `G` is positive and finite.
    pub fn new(shear_modulus: f64) -> Result<Self, ParameterError> {
        let elastic = ElasticConstants::from_shear_lame(shear_modulus, shear_modulus)?;
        Ok(Self { elastic })
    }

    // I_2/I_3 + 2J - 5 with the parts of zeroth and first order in the strain cancelled by hand.
    #[inline]
    fn energy_of<T: Real>(&self, invariants: &StretchInvariants<T>) -> T {
        let StretchInvariants {
            det_c,
            excess,
            j,
            j_minus_1,
            ..
        } = *invariants;
        let second_order = (j * 2.0 + 1.0) * (j_minus_1 * j_minus_1) - excess[1] - excess[2] * 2.0;
        second_order / det_c * (0.5 * self.elastic.shear_modulus())
    }

    #[inline]
    fn stress_of(&self, j: f64, inverse: &Symmetric, inverse_squared: &Symmetric) -> Symmetric {
        let ([inverse], [squared]) = (&inverse.data.0, &inverse_squared.data.0);
        let shear = self.elastic.shear_modulus();
        tensor::by_component(|i| shear * (j * inverse[i] - squared[i]))
    }

    #[inline]
    fn tangent_of(&self, j: f64, inverse: &Symmetric, inverse_squared: &Symmetric) -> Tangent {
        let shear = self.elastic.shear_modulus();
        // The three products (.) share a factor C^-1, and so are one.
        let ([b], [squared]) = (&inverse.data.0, &inverse_squared.data.0);
        let other = tensor::by_component(|i| shear * (2.0 * squared[i] - j * b[i]));
        let mut d = tensor::symmetric_product(inverse, &other);
        tensor::add_dyad(&mut d, shear * j, inverse);
        d
    }
}

impl Material for BlatzKo {
    #[inline]
    fn energy<T: Real>(&self, c: &Symmetric<T>) -> Result<T, Inverted> {
        Ok(self.energy_of(&StretchInvariants::new(c)?))
    }

    #[inline]
    fn stress(&self, c: &Symmetric) -> Result<(f64, Symmetric), Inverted> {
        let invariants = StretchInvariants::new(c)?;
        let inverse = invariants.inverse();
        let stress = self.stress_of(invariants.j, &inverse, &tensor::square(&inverse));
        Ok((self.energy_of(&invariants), stress))
    }

    #[inline]
    fn response(&self, c: &Symmetric) -> Result<Response, Inverted> {
        let invariants = StretchInvariants::new(c)?;
        let inverse = invariants.inverse();
        let inverse_squared = tensor::square(&inverse);
        Ok(Response::new(
            self.energy_of(&invariants),
            self.stress_of(invariants.j, &inverse, &inverse_squared),
            self.tangent_of(invariants.j, &inverse, &inverse_squared),
        ))
    }

    fn small_strain_moduli(&self) -> ElasticConstants {
        self.elastic
    }
}
