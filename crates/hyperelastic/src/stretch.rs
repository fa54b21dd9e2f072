//! Invariants of `C` for the laws of `J`, and what they refuse.

use crate::inverted::Inverted;
use crate::real::Real;
use crate::tensor::{Symmetric, cofactors, determinant, trace};

/// Beyond this `|C_ij|` (a stretch of 1e12), a state is a numerical blow-up.
const LARGEST_C: f64 = 1e24;
/// Below this `det C` (`J = 1e-12`), matter is flat. With `LARGEST_C` it keeps every intermediate result finite.
const SMALLEST_DET_C: f64 = 1e-24;

/// Where `ln det C` is taken from `det C - 1` \[-\]; farther from the reference `det C` itself has the better digits.
const NEAR_REFERENCE: f64 = 0.5;

/// Refuses what is not finite, for laws that are defined for any finite `C`.
///
/// # Errors
/// [`Inverted`] if a component is NaN, infinite, or beyond any deformation (1e24).
///
/// ```
/// use hyperelastic::{Inverted, Symmetric, require_finite, tensor};
///
/// /// `W/G = E : E`, a law of strain only.
/// fn energy(c: &Symmetric) -> Result<f64, Inverted> {
///     require_finite(c)?;
///     Ok(tensor::norm_squared(&tensor::green_lagrange(c)))
/// }
/// assert_eq!(energy(&tensor::IDENTITY)?, 0.0);
/// assert!(energy(&(tensor::IDENTITY * f64::NAN)).is_err());
/// # Ok::<(), Inverted>(())
/// ```
#[inline]
pub fn require_finite<T: Real>(c: &Symmetric<T>) -> Result<(), Inverted> {
    let [components] = &c.data.0;
    let within = components
        .iter()
        .fold(true, |within, x| within & (x.re().abs() <= LARGEST_C));
    if within {
        Ok(())
    } else {
        Err(Inverted::new(determinant(c).re()))
    }
}

/// What the laws of `J` need: cofactors and determinant of `C`, and the invariants of `C - I`.
///
/// Energies near the reference are differences of numbers that cancel: `I_1 - 3 - 2 ln J` computed as it is
/// written is wrong by 1e-16, which is all of it at a strain of 1e-8, and `(W1 - W0)/|E1 - E0|`, which
/// energy-conserving schemes use, is then noise long before. From the invariants of `A = C - I` nothing of first
/// order in the strain has to cancel: `I_1 = 3 + A_1`, `I_2 = 3 + 2 A_1 + A_2`, `I_3 = 1 + A_1 + A_2 + A_3`.
#[derive(Clone, Copy, Debug)]
#[non_exhaustive]
pub struct StretchInvariants<T> {
    /// `det(C) C^-1`.
    pub cofactors: Symmetric<T>,
    /// `I_3 = det C = J^2`.
    pub det_c: T,
    /// `A_1, A_2, A_3`: invariants of `A = C - I`.
    pub excess: [T; 3],
    /// `J = sqrt(det C)`.
    pub j: T,
    /// `J - 1`, exact to round-off of `C` for small strains.
    pub j_minus_1: T,
}

impl<T: Real> StretchInvariants<T> {
    /// Invariants of `C` (11 22 33 12 13 23).
    ///
    /// # Errors
    /// [`Inverted`] unless `C` is finite, positive definite and neither collapsed (`J < 1e-12`) nor blown up.
    #[inline]
    pub fn new(c: &Symmetric<T>) -> Result<Self, Inverted> {
        let cofactors = cofactors(c);
        let det_c = c[0] * cofactors[0] + c[3] * cofactors[3] + c[4] * cofactors[4];
        // Sylvester's criterion. Comparisons are written so that NaN fails.
        let positive =
            (c[0].re() > 0.0) & (cofactors[2].re() > 0.0) & (det_c.re() >= SMALLEST_DET_C);
        if !(positive & (trace(c).re() <= LARGEST_C)) {
            return Err(Inverted::new(det_c.re()));
        }
        let a = Symmetric::new(c[0] - 1.0, c[1] - 1.0, c[2] - 1.0, c[3], c[4], c[5]);
        let a2 =
            a[0] * a[1] + a[0] * a[2] + a[1] * a[2] - (a[3] * a[3] + a[4] * a[4] + a[5] * a[5]);
        let excess = [trace(&a), a2, determinant(&a)];
        let j = det_c.sqrt();
        let j_minus_1 = (excess[0] + excess[1] + excess[2]) / (j + 1.0);
        Ok(Self {
            cofactors,
            det_c,
            excess,
            j,
            j_minus_1,
        })
    }

    /// `ln det C = 2 ln J`, exact to round-off of `C` for small strains.
    #[inline]
    #[must_use]
    pub fn ln_det_c(&self) -> T {
        let excess = self.excess[0] + self.excess[1] + self.excess[2];
        if excess.re().abs() < NEAR_REFERENCE {
            excess.ln_1p()
        } else {
            self.det_c.ln()
        }
    }

    /// `C^-1`.
    #[inline]
    #[must_use]
    pub fn inverse(&self) -> Symmetric<T> {
        let scale = self.det_c.recip();
        let [[a, b, c, d, e, f]] = self.cofactors.data.0;
        Symmetric::new(
            a * scale,
            b * scale,
            c * scale,
            d * scale,
            e * scale,
            f * scale,
        )
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    proptest! {
        #[test]
        fn stretch_invariants_are_those_of_c(l in [0.3..3.0, 0.3..3.0, 0.3..3.0]) {
            let c = Symmetric::new(l[0] * l[0], l[1] * l[1], l[2] * l[2], 0.0, 0.0, 0.0);
            let invariants = StretchInvariants::new(&c).unwrap();
            let j: f64 = l.iter().product();
            prop_assert!((invariants.j - j).abs() < 1e-14 * j);
            prop_assert!((invariants.j_minus_1 - (j - 1.0)).abs() < 1e-12 * (1.0 + j));
            prop_assert!((invariants.ln_det_c() - 2.0 * j.ln()).abs() < 1e-12);
            prop_assert!((invariants.inverse()[1] - 1.0 / c[1]).abs() < 1e-13 / c[1]);
        }
    }

    #[test]
    fn change_of_volume_is_exact_for_small_strain() {
        // 2^-30 and its small multiples are exact in binary, so that J of this simple extension is known exactly.
        let change = 2.0_f64.powi(-30);
        let invariants =
            StretchInvariants::new(&Symmetric::new(1.0 + change, 1.0, 1.0, 0.0, 0.0, 0.0)).unwrap();
        let expected = change / 2.0 - change * change / 8.0;
        assert!((invariants.j_minus_1 / expected - 1.0).abs() < 1e-15);
        assert!((invariants.ln_det_c() / change.ln_1p() - 1.0).abs() < 1e-15);
    }
}
