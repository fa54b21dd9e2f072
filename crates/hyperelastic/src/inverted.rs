//! The refusal of a state.

/// The law has no energy at this state: the matter is inverted, collapsed, or the state is not a number.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error("{}; cut the step, or refine the mesh where it happens", self.description())]
#[non_exhaustive]
pub struct Inverted {
    /// `det C = J^2` \[-\] of the state that was refused; NaN or infinite if `C` was.
    pub det_c: f64,
}

impl Inverted {
    /// The refusal of a state with this `det C` \[-\].
    #[must_use]
    pub const fn new(det_c: f64) -> Inverted {
        Inverted { det_c }
    }

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
