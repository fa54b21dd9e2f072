//! Errors of the input, with the place in the file.

use std::path::PathBuf;

use thiserror::Error;

use super::source::{Fault, Source};

/// Why a scene cannot be used.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum SceneError {
    /// Neither a built-in scene nor a file.
    #[error(
        "`{name}` is neither a built-in scene nor a file{near}; built in: {known}; a file ends in .ron"
    )]
    Unknown {
        /// As asked for.
        name: String,
        /// Names that look like it, as a question; may be empty.
        near: String,
        /// All built-in names.
        known: String,
    },
    /// The file cannot be read.
    #[error("cannot read the scene {}: {source}", path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// Why.
        source: std::io::Error,
    },
    /// The text is not a scene, or says something impossible.
    #[error("{}", faults.iter().map(Fault::to_string).collect::<Vec<_>>().join("\n"))]
    Faults {
        /// All that is wrong, at least one.
        faults: Vec<Fault>,
        /// The text that the places refer to.
        source_text: Source,
    },
    /// A `--set` that names no field, several fields, or whose value does not fit.
    #[error("--set {path}={value}: {reason}")]
    Set {
        /// Path as given.
        path: String,
        /// Value as given.
        value: String,
        /// What is wrong and what to try.
        reason: String,
    },
}

impl SceneError {
    /// The faults, when the error is about the text.
    pub fn faults(&self) -> &[Fault] {
        match self {
            SceneError::Faults { faults, .. } => faults,
            _ => &[],
        }
    }
}

impl miette::Diagnostic for SceneError {
    fn source_code(&self) -> Option<&dyn miette::SourceCode> {
        match self {
            SceneError::Faults { source_text, .. } => Some(source_text),
            _ => None,
        }
    }

    fn labels(&self) -> Option<Box<dyn Iterator<Item = miette::LabeledSpan> + '_>> {
        let labels = self.faults().iter().map(|fault| {
            let label = if fault.value.is_empty() {
                "here"
            } else {
                "this value"
            };
            miette::LabeledSpan::new(Some(label.into()), fault.span.start, fault.span.len())
        });
        Some(Box::new(labels))
    }
}
