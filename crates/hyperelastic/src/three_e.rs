//! The 3e law of Laine, Vallee and Fortune: a quartic in the strain, in invariants of equal eigenvectors.

use crate::elastic_constants::ElasticConstants;
use crate::inverted::Inverted;
use crate::material::{Material, Response};
use crate::parameter::{ParameterError, inside_closed};
use crate::real::Real;
use crate::stretch::require_finite;
use crate::tensor::{self, Symmetric, Tangent};

const SQRT_3: f64 = 1.732_050_807_568_877_2;
const SQRT_6: f64 = 2.449_489_742_783_178;

/// `W = (G + a3/4 z^2)(x^2 + y^2) + 3K/2 z^2 + a1/3 (x^3 - 3 x y^2) + a2/3 z^3 + a4/4 z^4 + a5/4 (x^2 + y^2)^2`
/// \[Feng2007, eq. 16\].
///
/// `z = tr(E)/sqrt 3`, and `(x, y)` are the polar coordinates of the deviator `E_d`: radius `sqrt(tr E_d^2)`, angle the
/// Lode angle \[Feng2007, eqs. 10, 11\]. Neither `x` nor `y` is ever computed: the energy only holds
/// `q = x^2 + y^2 = tr(E_d^2)` and `x^3 - 3 x y^2 = 3 sqrt(6) det(E_d)`, polynomials, so that states with equal
/// principal strains, the reference among them, are no exception.
///
/// Stress and tangent are the derivatives of this energy with all five parameters; the paper's eqs. 20 and 22
/// leave out `a3` and halve the terms in `a5`.
///
/// # Validity
/// Within the bounds of \[Feng2007, eq. 17\] and with `a3 = 0` the energy is convex in `E`. A positive `a3` couples
/// volume and shear by a term that is not convex by itself, and the bounds do not make up for it at large strains. Like
/// [`SaintVenantKirchhoff`](crate::SaintVenantKirchhoff), with which it agrees when all `a` are zero, it does not
/// resist the collapse of matter: compressed in one direction the force falls below a stretch near .58. No `C` is
/// refused but one that is not finite.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ThreeE {
    elastic: ElasticConstants,
    a: [f64; 5],
}

/// The invariants `z`, `q = x^2 + y^2`, and the deviator they come from.
struct Invariants<T> {
    z: T,
    q: T,
    deviator: Symmetric<T>,
}

impl<T: Real> Invariants<T> {
    #[inline]
    fn new(c: &Symmetric<T>) -> Result<Self, Inverted> {
        require_finite(c)?;
        let e = tensor::green_lagrange(c);
        let trace = tensor::trace(&e);
        let mean = trace / 3.0;
        let deviator = Symmetric::new(e[0] - mean, e[1] - mean, e[2] - mean, e[3], e[4], e[5]);
        Ok(Self {
            z: trace / SQRT_3,
            q: tensor::norm_squared(&deviator),
            deviator,
        })
    }
}

impl ThreeE {
    /// The law with the moduli `G` and `K` and the parameters `a = [a1, a2, a3, a4, a5]` \[Pa\].
    ///
    /// # Errors
    /// Outside the bounds of \[Feng2007, eq. 17\]: `a3, a4, a5 >= 0`, `|a1| <= sqrt(2 G a5)`, `|a2| <= 3 sqrt(K a4)`.
    pub fn new(elastic: ElasticConstants, a: [f64; 5]) -> Result<Self, ParameterError> {
        let not_negative = [0.0, f64::INFINITY];
        let reason = "the energy has to grow with the strain [Feng2007, eq. 17]";
        inside_closed("a3", a[2], not_negative, reason)?;
        let a4 = inside_closed("a4", a[3], not_negative, reason)?;
        let a5 = inside_closed("a5", a[4], not_negative, reason)?;
        let a1_max = (2.0 * elastic.shear_modulus() * a5).sqrt();
        let a2_max = 3.0 * (elastic.bulk_modulus() * a4).sqrt();
        let reason =
            "convex only for |a1| <= sqrt(2 G a5) [Feng2007, eq. 17]; raise a5 or lower |a1|";
        inside_closed("a1", a[0], [-a1_max, a1_max], reason)?;
        let reason =
            "convex only for |a2| <= 3 sqrt(K a4) [Feng2007, eq. 17]; raise a4 or lower |a2|";
        inside_closed("a2", a[1], [-a2_max, a2_max], reason)?;
        Ok(Self { elastic, a })
    }

    /// `a1 .. a5` \[Pa\].
    pub fn parameters(&self) -> [f64; 5] {
        self.a
    }

    #[inline]
    fn energy_of<T: Real>(&self, invariants: &Invariants<T>) -> T {
        let Invariants { z, q, ref deviator } = *invariants;
        let [a1, a2, a3, a4, a5] = self.a;
        let z2 = z * z;
        (z2 * (a3 / 4.0) + q * (a5 / 4.0) + self.elastic.shear_modulus()) * q
            + (z * (a2 / 3.0) + z2 * (a4 / 4.0) + 1.5 * self.elastic.bulk_modulus()) * z2
            + tensor::determinant(deviator) * (SQRT_6 * a1)
    }

    #[inline]
    fn stress_of(&self, invariants: &Invariants<f64>) -> Symmetric {
        let Invariants {
            z,
            q,
            deviator: ref e_d,
        } = *invariants;
        let [a1, a2, a3, a4, a5] = self.a;
        let dw_dz = z * (3.0 * self.elastic.bulk_modulus() + 0.5 * a3 * q + z * (a2 + a4 * z));
        let two_dw_dq = 2.0 * self.elastic.shear_modulus() + 0.5 * a3 * z * z + a5 * q;
        let cubic = SQRT_6 * a1;
        let on_diagonal = dw_dz / SQRT_3 - cubic * q / 3.0;
        let ([e_d], [square]) = (&e_d.data.0, &tensor::square(e_d).data.0);
        let mut s = tensor::by_component(|i| two_dw_dq * e_d[i] + cubic * square[i]);
        tensor::add_spherical(&mut s, on_diagonal);
        s
    }

    #[inline]
    fn tangent_of(&self, invariants: &Invariants<f64>) -> Tangent {
        let Invariants {
            z,
            q,
            deviator: ref e_d,
        } = *invariants;
        let [a1, a2, a3, a4, a5] = self.a;
        let d2w_dz2 =
            3.0 * self.elastic.bulk_modulus() + 0.5 * a3 * q + z * (2.0 * a2 + 3.0 * a4 * z);
        let two_dw_dq = 2.0 * self.elastic.shear_modulus() + 0.5 * a3 * z * z + a5 * q;
        let cubic = SQRT_6 * a1;
        // I (x) (..) + (..) (x) I holds the coupling of a3 and the trace removed from d(E_d^2).
        let mixed = a3 * z / SQRT_3 - 2.0 / 3.0 * cubic;
        let [deviator] = &e_d.data.0;
        let mixed = deviator.map(|x| mixed * x);
        let mut tangent =
            tensor::derivative_of_square(&tensor::by_component(|i| cubic * deviator[i]));
        let d = &mut tangent.data.0;
        for i in 0..3 {
            for j in 0..3 {
                d[i][j] += (d2w_dz2 - two_dw_dq) / 3.0 + (mixed[i] + mixed[j]);
                d[i][j + 3] += mixed[j + 3];
                d[j + 3][i] += mixed[j + 3];
            }
            d[i][i] += two_dw_dq;
            d[i + 3][i + 3] += 0.5 * two_dw_dq;
        }
        tensor::add_dyad(&mut tangent, 2.0 * a5, e_d);
        tangent
    }
}

impl Material for ThreeE {
    #[inline]
    fn energy<T: Real>(&self, c: &Symmetric<T>) -> Result<T, Inverted> {
        Ok(self.energy_of(&Invariants::new(c)?))
    }

    #[inline]
    fn stress(&self, c: &Symmetric) -> Result<(f64, Symmetric), Inverted> {
        let invariants = Invariants::new(c)?;
        Ok((self.energy_of(&invariants), self.stress_of(&invariants)))
    }

    #[inline]
    fn response(&self, c: &Symmetric) -> Result<Response, Inverted> {
        let invariants = Invariants::new(c)?;
        Ok(Response::new(
            self.energy_of(&invariants),
            self.stress_of(&invariants),
            self.tangent_of(&invariants),
        ))
    }

    fn small_strain_moduli(&self) -> ElasticConstants {
        self.elastic
    }
}
