//! What the program says, to whom it may concern.

use std::io::{self, Write};
use std::sync::atomic::{AtomicBool, Ordering};

/// The standard output and the standard error. A stream that is closed or full is no reason to panic, but the program
/// does not end as if all had been heard.
#[derive(Debug, Default)]
pub(crate) struct Console {
    unheard: AtomicBool,
}

impl Console {
    /// To the standard output.
    pub(crate) fn say(&self, text: &str) {
        let mut out = io::stdout().lock();
        let said = out.write_all(text.as_bytes()).and_then(|()| out.flush());
        if let Err(error) = said {
            // Once is enough.
            if !self.unheard.swap(true, Ordering::Relaxed) {
                self.tell(&format!(
                    "error: cannot write to the standard output: {error}\n"
                ));
            }
        }
    }

    /// To the standard error.
    pub(crate) fn tell(&self, text: &str) {
        if io::stderr().lock().write_all(text.as_bytes()).is_err() {
            self.unheard.store(true, Ordering::Relaxed);
        }
    }

    /// Whether something could not be written.
    pub(crate) fn is_unheard(&self) -> bool {
        self.unheard.load(Ordering::Relaxed)
    }
}
