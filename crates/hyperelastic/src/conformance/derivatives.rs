//! Stress and tangent from the energy alone, in two independent ways.

use num_dual::HyperDual64;

use crate::inverted::Inverted;
use crate::material::Material;
use crate::tensor::{Symmetric, Tangent};

pub(super) struct Derivatives {
    pub(super) stress: Symmetric,
    pub(super) tangent: Tangent,
}

// C_12 stands for C_12 and C_21, so that dW/dC_12 in six components is twice that in nine.
const TO_STRESS: [f64; 6] = [2.0, 2.0, 2.0, 1.0, 1.0, 1.0];

/// `S = 2 dW/dC` and `D = 4 d2W/dC2`, exact to round-off.
pub(super) fn by_dual_numbers<M: Material>(
    material: &M,
    c: &Symmetric,
) -> Result<Derivatives, Inverted> {
    let mut stress = Symmetric::zeros();
    let mut tangent = Tangent::zeros();
    for i in 0..6 {
        for j in i..6 {
            let mut seeded = c.map(HyperDual64::from_re);
            seeded[i].eps1 = 1.0;
            seeded[j].eps2 = 1.0;
            let w = material.energy(&seeded)?;
            stress[i] = TO_STRESS[i] * w.eps1;
            tangent[(i, j)] = TO_STRESS[i] * TO_STRESS[j] * w.eps1eps2;
            tangent[(j, i)] = tangent[(i, j)];
        }
    }
    Ok(Derivatives { stress, tangent })
}

/// Step of the central differences in a component of `C` \[-\]: the cube root of round-off, where truncation and
/// round-off are about equal.
const STEP: f64 = 1e-5;

/// `S` from differences of `energy`, `D` from differences of `stress`.
pub(super) fn by_differences<M: Material>(
    material: &M,
    c: &Symmetric,
) -> Result<Derivatives, Inverted> {
    let mut stress = Symmetric::zeros();
    let mut tangent = Tangent::zeros();
    for j in 0..6 {
        let (mut below, mut above) = (*c, *c);
        below[j] -= STEP;
        above[j] += STEP;
        let per_strain = TO_STRESS[j] / (above[j] - below[j]);
        stress[j] = (material.energy(&above)? - material.energy(&below)?) * per_strain;
        let (_, s_above) = material.stress(&above)?;
        let (_, s_below) = material.stress(&below)?;
        for i in 0..6 {
            tangent[(i, j)] = (s_above[i] - s_below[i]) * per_strain;
        }
    }
    Ok(Derivatives { stress, tangent })
}
