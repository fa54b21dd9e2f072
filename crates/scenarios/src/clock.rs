//! CPU and wall time of a run.

use std::time::Instant;

use cpu_time::ProcessTime;

/// Runs from its creation.
#[derive(Clone, Copy, Debug)]
pub struct Stopwatch {
    cpu: ProcessTime,
    wall: Instant,
}

impl Stopwatch {
    /// Starts now.
    pub fn start() -> Self {
        Stopwatch {
            cpu: ProcessTime::now(),
            wall: Instant::now(),
        }
    }

    /// CPU time of all threads of the process since the start \[s\].
    pub fn cpu_s(&self) -> f64 {
        self.cpu.elapsed().as_secs_f64()
    }

    /// Wall time since the start \[s\].
    pub fn wall_s(&self) -> f64 {
        self.wall.elapsed().as_secs_f64()
    }
}
