//! Every number a user may turn, with its default, in one place.

/// Tolerances and limits of a run.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Settings {
    /// Largest residual force relative to the largest force in play (default 1e-12). Round-off of
    /// the residual itself is always accepted. Larger values save the last iteration of a step and
    /// open the energy audit by the same relative amount \[-\].
    pub newton_tolerance: f64,
    /// Iterations before a step is cut (default 40).
    pub newton_iterations: usize,
    /// Relative error of the contact law in an accepted step (default 1e-10) \[-\]. Where no iteration lessens it any
    /// more, a hundred times that, and 1e-8 at most, counts as round-off and is told.
    pub contact_tolerance: f64,
    /// Iterations of one contact solve, in the unit of its method (default 20000).
    pub contact_iterations: usize,
    /// Smallest step as a fraction of the nominal one (default 1/1024); below it the run stops \[-\].
    pub smallest_step: f64,
    /// Accepted steps before a cut step is doubled again (default 2); twice as many, up to sixteen times, after each
    /// doubling that did not last as long.
    pub growth_after: usize,
    /// Cost of refactoring relative to an iteration is estimated from operation counts; this factor
    /// scales it (default 1). Larger values keep an old tangent longer \[-\].
    pub lag: f64,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            newton_tolerance: 1e-12,
            newton_iterations: 40,
            contact_tolerance: 1e-10,
            contact_iterations: 20_000,
            smallest_step: 1.0 / 1024.0,
            growth_after: 2,
            lag: 1.0,
        }
    }
}

/// Error of the contact law over the tolerance up to which an iteration that does not lessen it has met round-off
/// \[-\].
const STAGNANT: f64 = 100.0;
/// Error of the contact law above which that is not believed \[-\].
const MOST_STAGNANT: f64 = 1e-8;

impl Settings {
    /// Error of the contact law that is accepted where no iteration lessens it any more \[-\].
    pub(crate) fn stagnant_contact_error(&self) -> f64 {
        let bounded = (STAGNANT * self.contact_tolerance).min(MOST_STAGNANT);
        bounded.max(self.contact_tolerance)
    }

    /// The same settings with another [`newton_tolerance`](Self::newton_tolerance).
    #[must_use]
    pub const fn with_newton_tolerance(self, newton_tolerance: f64) -> Self {
        Self {
            newton_tolerance,
            ..self
        }
    }

    /// The same settings with another [`newton_iterations`](Self::newton_iterations).
    #[must_use]
    pub const fn with_newton_iterations(self, newton_iterations: usize) -> Self {
        Self {
            newton_iterations,
            ..self
        }
    }

    /// The same settings with another [`contact_tolerance`](Self::contact_tolerance).
    #[must_use]
    pub const fn with_contact_tolerance(self, contact_tolerance: f64) -> Self {
        Self {
            contact_tolerance,
            ..self
        }
    }

    /// The same settings with another [`contact_iterations`](Self::contact_iterations).
    #[must_use]
    pub const fn with_contact_iterations(self, contact_iterations: usize) -> Self {
        Self {
            contact_iterations,
            ..self
        }
    }

    /// The same settings with another [`smallest_step`](Self::smallest_step).
    #[must_use]
    pub const fn with_smallest_step(self, smallest_step: f64) -> Self {
        Self {
            smallest_step,
            ..self
        }
    }

    /// The same settings with another [`growth_after`](Self::growth_after).
    #[must_use]
    pub const fn with_growth_after(self, growth_after: usize) -> Self {
        Self {
            growth_after,
            ..self
        }
    }

    /// The same settings with another [`lag`](Self::lag).
    #[must_use]
    pub const fn with_lag(self, lag: f64) -> Self {
        Self { lag, ..self }
    }
}
