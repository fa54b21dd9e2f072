//! What the battery reports.

use std::fmt;

use crate::inverted::Inverted;
use crate::tensor::Symmetric;

/// What a law can get wrong.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Property {
    /// A result is NaN or infinite where a value or [`Inverted`] is due.
    Finite,
    /// `energy`, `stress` and `response` agree on `W` and `S`.
    SameFromAllMethods,
    /// `S = 2 dW/dC`, by dual numbers.
    StressIsDerivativeOfEnergy,
    /// `S = 2 dW/dC`, by central differences.
    StressIsDifferenceOfEnergy,
    /// `D = 4 d2W/dC2`, by dual numbers.
    TangentIsSecondDerivativeOfEnergy,
    /// `D = 2 dS/dC`, by central differences.
    TangentIsDifferenceOfStress,
    /// `D_ijkl = D_klij`, to round-off.
    TangentIsSymmetric,
    /// `W(Q C Q^T) = W(C)`.
    EnergyIsIsotropic,
    /// `S(Q C Q^T) = Q S(C) Q^T`.
    StressIsIsotropic,
    /// `D(Q C Q^T)` is `D(C)`, rotated.
    TangentIsIsotropic,
    /// `W(I) = 0`.
    ReferenceHasNoEnergy,
    /// `S(I) = 0`.
    ReferenceHasNoStress,
    /// `D(I) = lambda I (x) I + 2G I4` with the moduli of `small_strain_moduli`.
    SmallStrainModuli,
    /// `W = E:D:E/2` at a strain of 1e-7: the energy is not the noise of large numbers that cancel.
    EnergyResolvesSmallStrain,
    /// NaN and infinity in `C` are refused.
    RefusesWhatIsNotFinite,
    /// A homogeneous state has the stress of its closed form.
    ClosedForm,
}

/// A demand that a law does not meet, with the state where it was seen.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Violation {
    /// A wrong number.
    #[error(
        "{property:?} fails at C = {c:?}: component {component} is {found:e}, expected {expected:e} within {allowed:e}"
    )]
    Differs {
        /// Which demand.
        property: Property,
        /// The state, 11 22 33 12 13 23.
        c: Symmetric,
        /// Which component, e.g. `S[0]` or `D[1][2]`.
        component: Component,
        /// What the law gave.
        found: f64,
        /// What was expected.
        expected: f64,
        /// Allowed absolute difference.
        allowed: f64,
    },
    /// The law refused a state that it has to accept.
    #[error("refuses C = {c:?}: {source}")]
    Refused {
        /// The state, 11 22 33 12 13 23.
        c: Symmetric,
        /// What the law answered.
        source: Inverted,
    },
    /// The law accepted a state that it has to refuse.
    #[error("{property:?} fails: accepts C = {c:?}")]
    Accepted {
        /// Which demand.
        property: Property,
        /// The state, 11 22 33 12 13 23.
        c: Symmetric,
    },
}

/// Which number of a response.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Component {
    /// `W`.
    Energy,
    /// `S_i`, `i` from 0 to 5; of a closed form `P_ij` or `sigma_i` in the order of its entries.
    Stress(usize),
    /// `D_ij`, `i` and `j` from 0 to 5.
    Tangent(usize, usize),
}

impl fmt::Display for Component {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Energy => write!(f, "W"),
            Self::Stress(i) => write!(f, "S[{i}]"),
            Self::Tangent(i, j) => write!(f, "D[{i}][{j}]"),
        }
    }
}
