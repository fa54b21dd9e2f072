//! What a stepper did so far: counted, and timed with the clock of its caller.

use crate::report::{Clock, Counters, Phase, Phases};

/// Counters, seconds by phase, and the clock that tells them.
pub(crate) struct Tally {
    pub(crate) counters: Counters,
    pub(crate) phases: Phases,
    clock: Box<dyn Clock>,
}

impl Tally {
    pub(crate) fn new(clock: Box<dyn Clock>) -> Self {
        Self {
            counters: Counters::default(),
            phases: Phases::default(),
            clock,
        }
    }

    /// The clock now \[s\].
    pub(crate) fn seconds(&self) -> f64 {
        self.clock.seconds()
    }

    /// Books the time since `start` \[s\] on a phase.
    pub(crate) fn book(&mut self, phase: Phase, start: f64) {
        self.phases[phase as usize] += self.clock.seconds() - start;
    }
}
