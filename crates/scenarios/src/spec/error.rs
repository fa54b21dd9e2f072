//! Errors of the input, with the place in the file.

use std::fmt;
use std::ops::Range;
use std::path::PathBuf;

use thiserror::Error;

use super::{Source, overrides::Override};

/// One thing wrong in a scene.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Fault {
    /// File, or name of a built-in scene.
    pub file: String,
    /// Line, from 1.
    pub line: usize,
    /// Column in characters, from 1.
    pub column: usize,
    /// Bytes of the offending value.
    pub span: Range<usize>,
    /// Dotted path of the field; may be empty when the text cannot be read at all.
    pub path: String,
    /// The value as it stands there, shortened; empty when the value is absent or not the point.
    pub value: String,
    /// What is wrong and what is allowed.
    pub message: String,
    /// The `--set` that put the value there.
    pub set_by: Option<Override>,
}

impl Fault {
    /// Path, value and what is allowed, without the place.
    pub fn what(&self) -> String {
        let mut what = self.path.clone();
        if !self.value.is_empty() && !what.is_empty() {
            what += " = ";
        }
        what += &self.value;
        if !what.is_empty() {
            what += ": ";
        }
        what += &self.message;
        if let Some(set) = &self.set_by {
            what += &format!(" (from --set {}={})", set.path, set.value);
        }
        what
    }
}

impl fmt::Display for Fault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "{}:{}:{}: {}",
            self.file,
            self.line,
            self.column,
            self.what()
        )
    }
}

/// Why a scene cannot be used.
#[derive(Debug, Error)]
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

impl miette::SourceCode for Source {
    fn read_span<'a>(
        &'a self,
        span: &miette::SourceSpan,
        before: usize,
        after: usize,
    ) -> Result<Box<dyn miette::SpanContents<'a> + 'a>, miette::MietteError> {
        let found = self.text.read_span(span, before, after)?;
        Ok(Box::new(miette::MietteSpanContents::new_named(
            self.name.clone(),
            found.data(),
            *found.span(),
            found.line(),
            found.column(),
            found.line_count(),
        )))
    }
}
