//! One contact with its bond while the others are held.

use crate::local::{Matrix, Vector, from_spatial, solve_small, spatial};
use crate::rcc::BondStep;
use crate::solve::single::SingleContact;

/// Evaluations for the intensity of one contact: bisection alone would need 50.
const EVALUATIONS: usize = 60;
/// Error of an intensity that is rounding \[-\].
const ROUNDED: f64 = 1e-15;

/// Force of a bond of intensity `beta` at the end position `u`.
pub(crate) fn bond_force<const D: usize>(bond: &BondStep, beta: f64, u: &Vector<D>) -> Vector<D> {
    let (d, shift) = spring::<D>(bond, beta);
    -d.component_mul(&(u + shift))
}

/// [`BondStep::spring`] in the components of a local vector.
pub(crate) fn spring<const D: usize>(bond: &BondStep, beta: f64) -> (Vector<D>, Vector<D>) {
    let (stiffness, shift) = bond.spring(beta);
    (from_spatial(&stiffness), from_spatial(&shift))
}

/// The whole reaction of one bonded contact with `x = W r + b`: the exact solution for each intensity, and the
/// intensity from its scalar equation, whose root always lies in \[0, 1\].
pub(crate) fn bonded_contact<const D: usize>(
    w: &Matrix<D>,
    b: &Vector<D>,
    mu: f64,
    bond: &BondStep,
) -> Vector<D> {
    let at = |beta| at_intensity(w, b, mu, bond, beta);
    // Regula falsi with halved weights (Illinois), from the bracket [0, 1].
    let (mut low, mut high) = (0.0, 1.0);
    let ((mut g_low, mut r), (mut g_high, r_high)) = (at(low), at(high));
    if g_high >= 0.0 {
        return r_high;
    }
    for _ in 0..EVALUATIONS {
        if g_low <= 0.0 || high - low < ROUNDED {
            break;
        }
        let beta = (low * g_high - high * g_low) / (g_high - g_low);
        let (g, found) = at(beta.clamp(low, high));
        r = found;
        if g.abs() < ROUNDED {
            break;
        }
        if g > 0.0 {
            (low, g_low) = (beta, g);
            g_high *= 0.5;
        } else {
            (high, g_high) = (beta, g);
            g_low *= 0.5;
        }
    }
    r
}

/// For a bond that keeps the intensity `beta`: what the end position would make of the intensity, less `beta`, and the
/// whole reaction.
fn at_intensity<const D: usize>(
    w: &Matrix<D>,
    b: &Vector<D>,
    mu: f64,
    bond: &BondStep,
    beta: f64,
) -> (f64, Vector<D>) {
    let (d, shift) = spring::<D>(bond, beta);
    let (mut softened, mut moved, mut compliance) = (Matrix::zeros(), *b, Matrix::<D>::zeros());
    for i in 0..D {
        for j in 0..D {
            softened[(i, j)] = w[(i, j)] * d[j] + f64::from(u8::from(i == j));
            moved[i] -= w[(i, j)] * d[j] * shift[j];
        }
    }
    let moved = solve_small(&softened, &moved).unwrap_or(moved);
    for j in 0..D {
        let column = w.column(j).into_owned();
        compliance.set_column(j, &solve_small(&softened, &column).unwrap_or(column));
    }
    let dry = SingleContact::new(&compliance)
        .solve(&moved, bond.friction(mu, beta))
        .r;
    let x = compliance * dry + moved;
    let intensity = bond.intensity(&spatial(&x)).0;
    (intensity - beta, dry + bond_force(bond, beta, &x))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cone::Cone;
    use crate::delassus::Delassus;
    use crate::error_measure::ErrorMeasure;
    use crate::problem::ContactProblem;
    use crate::rcc::{Adhesion, Bond, Update};
    use faer::Mat;
    use nalgebra::{Matrix3, Vector3};
    use proptest::prelude::*;

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(500))]

        /// The single bonded contact satisfies law and bond at once, for steps short enough to be unique.
        #[test]
        fn one_bonded_contact_is_exact(
            w in prop::array::uniform9(-1.0..1.0_f64), b in prop::array::uniform3(-1e-2..1e-2_f64), mu in 0.0..1.5_f64,
            beta in 0.0..1.0_f64, u in prop::array::uniform2(-5e-3..5e-3_f64), pair in any::<bool>(), stiff in -1.0..3.0_f64,
        ) {
            let a = Matrix3::from_row_slice(&w);
            let (compliance, b) = (a * a.transpose() + 0.1 * Matrix3::identity(), Vector3::from(b));
            let c = 10.0_f64.powf(stiff);
            let update = if pair { Update::EnergyConsistent } else { Update::SecondOrder };
            let law = Adhesion { update, ..Adhesion::new(c, 0.6 * c, c * 1e-5, c) };
            let start = Bond { intensity: beta, gap: 0.0, separation: u };
            let step = BondStep::new(&law, 1.0, 1.0, start, 1e-15);
            let r = bonded_contact(&compliance, &b, mu, &step);
            let problem = ContactProblem {
                w: Delassus::Dense(Mat::from_fn(3, 3, |i, j| compliance[(i, j)])),
                q: b.as_slice().to_vec(),
                mu: vec![mu],
                cone: Cone::Spatial,
            };
            let steps = [step];
            let mut x = vec![0.0; 3];
            let errors = ErrorMeasure::bonded(&problem, &steps).evaluate(r.as_slice(), &mut x);
            prop_assert!(errors.worst() < 1e-9, "{errors:?} {x:?}");
        }
    }
}
