//! Parameters and their physical bounds.

/// A parameter outside its physical bounds.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ParameterError {
    /// NaN or infinite.
    #[error("{parameter} = {value} is not a finite number")]
    NotFinite {
        /// Name of the parameter.
        parameter: &'static str,
        /// What was given.
        value: f64,
    },
    /// Outside an open interval; its ends are refused too.
    #[error("{parameter} = {value} must lie strictly between {lower} and {upper}: {reason}")]
    OutsideOpen {
        /// Name of the parameter.
        parameter: &'static str,
        /// What was given.
        value: f64,
        /// Largest refused value below.
        lower: f64,
        /// Smallest refused value above.
        upper: f64,
        /// Why, and what to try.
        reason: &'static str,
    },
    /// Outside a closed interval; its ends are allowed.
    #[error("{parameter} = {value} must lie between {lower} and {upper}: {reason}")]
    OutsideClosed {
        /// Name of the parameter.
        parameter: &'static str,
        /// What was given.
        value: f64,
        /// Smallest allowed value.
        lower: f64,
        /// Largest allowed value.
        upper: f64,
        /// Why, and what to try.
        reason: &'static str,
    },
}

impl ParameterError {
    /// Name of the parameter; its last word is its letter, as in `shear modulus G`.
    #[must_use]
    pub const fn parameter(&self) -> &'static str {
        match *self {
            ParameterError::NotFinite { parameter, .. }
            | ParameterError::OutsideOpen { parameter, .. }
            | ParameterError::OutsideClosed { parameter, .. } => parameter,
        }
    }
}

pub(crate) fn finite(parameter: &'static str, value: f64) -> Result<f64, ParameterError> {
    if value.is_finite() {
        Ok(value)
    } else {
        Err(ParameterError::NotFinite { parameter, value })
    }
}

pub(crate) fn inside_open(
    parameter: &'static str,
    value: f64,
    [lower, upper]: [f64; 2],
    reason: &'static str,
) -> Result<f64, ParameterError> {
    finite(parameter, value)?;
    if lower < value && value < upper {
        Ok(value)
    } else {
        Err(ParameterError::OutsideOpen {
            parameter,
            value,
            lower,
            upper,
            reason,
        })
    }
}

pub(crate) fn inside_closed(
    parameter: &'static str,
    value: f64,
    [lower, upper]: [f64; 2],
    reason: &'static str,
) -> Result<f64, ParameterError> {
    finite(parameter, value)?;
    if lower <= value && value <= upper {
        Ok(value)
    } else {
        Err(ParameterError::OutsideClosed {
            parameter,
            value,
            lower,
            upper,
            reason,
        })
    }
}
