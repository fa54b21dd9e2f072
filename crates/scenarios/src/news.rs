//! How a run goes on: a bar on a terminal, a line now and then in a log.

use std::io::IsTerminal as _;
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressStyle};
use scenarios::Progress;

use crate::console::Console;

/// Ticks of the progress bar for the whole run.
const TICKS: u64 = 10_000;
/// Between two lines of a log: often enough to see that a run is alive, and a run of a day fits into some pages.
const BETWEEN: Duration = Duration::from_secs(5);

/// Tells how a run goes on.
pub(crate) enum News<'a> {
    /// Nothing is told.
    Silent,
    /// A bar on a terminal.
    Bar(ProgressBar),
    /// Lines, and when the last one was written.
    Lines(&'a Console, Instant),
}

impl<'a> News<'a> {
    /// What fits the standard error.
    pub(crate) fn new(console: &'a Console, quiet: bool) -> Self {
        if quiet {
            return News::Silent;
        }
        if !std::io::stderr().is_terminal() {
            return News::Lines(console, Instant::now());
        }
        let bar = ProgressBar::new(TICKS);
        let style =
            ProgressStyle::with_template("[{bar:30}] {percent:>3}%  {msg}  {elapsed} + {eta}");
        bar.set_style(
            style
                .unwrap_or_else(|_| ProgressStyle::default_bar())
                .progress_chars("=> "),
        );
        News::Bar(bar)
    }

    /// After a step.
    pub(crate) fn tell(&mut self, progress: &Progress) {
        match self {
            News::Silent => {}
            News::Bar(bar) => {
                let done = if progress.end > 0.0 {
                    progress.time / progress.end
                } else {
                    0.0
                };
                bar.set_position((done.clamp(0.0, 1.0) * TICKS as f64) as u64);
                bar.set_message(words(progress));
            }
            News::Lines(console, last) => {
                if last.elapsed() >= BETWEEN {
                    *last = Instant::now();
                    console.tell(&line(progress));
                }
            }
        }
    }

    /// When the run has ended.
    pub(crate) fn end(&self) {
        if let News::Bar(bar) = self {
            bar.finish_and_clear();
        }
    }
}

fn line(progress: &Progress) -> String {
    format!("{} of {:e} s\n", words(progress), progress.end)
}

fn words(progress: &Progress) -> String {
    let rejected = match progress.rejected_steps {
        0 => String::new(),
        n => format!(" ({n} cut)"),
    };
    format!(
        "step {}{rejected}  iterations {}  contacts {}  t = {:.4e}",
        progress.steps, progress.newton_iterations, progress.contacts, progress.time
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_has_time_steps_cuts_and_contacts() {
        let mut progress = Progress::default();
        (progress.time, progress.end) = (0.25, 1.0);
        (progress.steps, progress.rejected_steps, progress.contacts) = (12, 3, 9);
        let line = line(&progress);
        for word in ["t = 2.5000e-1 of 1e0 s", "step 12 (3 cut)", "contacts 9"] {
            assert!(line.contains(word), "{word} in {line}");
        }
    }
}
