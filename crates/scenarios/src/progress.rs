//! What a run tells while it computes.

/// State of a run after an accepted step, for whoever watches.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct Progress {
    /// Time reached \[s\].
    pub time: f64,
    /// End of the run \[s\].
    pub end: f64,
    /// Accepted steps \[-\].
    pub steps: usize,
    /// Rejected steps \[-\].
    pub rejected_steps: usize,
    /// Newton iterations so far \[-\].
    pub newton_iterations: usize,
    /// Contacts in this step \[-\].
    pub contacts: usize,
}
