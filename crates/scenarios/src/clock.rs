//! CPU and wall time of a run.

use std::time::{Duration, Instant};

use cpu_time::{ProcessTime, ThreadTime};

/// Runs from its creation.
#[derive(Clone, Copy, Debug)]
pub struct Stopwatch {
    cpu: Duration,
    wall: Instant,
}

impl Stopwatch {
    /// Starts now.
    #[must_use]
    pub fn start() -> Self {
        Stopwatch {
            cpu: spent(),
            wall: Instant::now(),
        }
    }

    /// CPU time since the start \[s\]: of all threads of the process, or of the pool in which both calls are made. Runs
    /// that share the process have a pool each, so they do not count each other's time.
    #[must_use]
    pub fn cpu_s(&self) -> f64 {
        spent().saturating_sub(self.cpu).as_secs_f64()
    }

    /// Wall time since the start \[s\].
    #[must_use]
    pub fn wall_s(&self) -> f64 {
        self.wall.elapsed().as_secs_f64()
    }
}

fn spent() -> Duration {
    if rayon::current_thread_index().is_none() {
        return ProcessTime::now().as_duration();
    }
    let threads = rayon::broadcast(|_| ThreadTime::now().as_duration());
    threads.into_iter().sum()
}
