//! Every number a user may turn, with its default, in one place.

/// Tolerances and limits of a run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Settings {
    /// Largest residual force relative to the largest force in play (default 1e-12). Round-off of
    /// the residual itself is always accepted. Larger values save the last iteration of a step and
    /// open the energy audit by the same relative amount [-].
    pub newton_tolerance: f64,
    /// Iterations before a step is cut (default 40).
    pub newton_iterations: usize,
    /// Relative error of the contact law in an accepted step (default 1e-10) [-].
    pub contact_tolerance: f64,
    /// Iterations of one contact solve, in the unit of its method (default 20000).
    pub contact_iterations: usize,
    /// Smallest step as a fraction of the nominal one (default 1/1024); below it the run stops [-].
    pub smallest_step: f64,
    /// Accepted steps before a cut step is doubled again (default 2); twice as many, up to sixteen times, after each doubling
    /// that did not last as long.
    pub growth_after: usize,
    /// Cost of refactoring relative to an iteration is estimated from operation counts; this factor
    /// scales it (default 1). Larger values keep an old tangent longer [-].
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
