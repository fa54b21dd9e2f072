//! Which error for which time: of the contact methods, and of the scenes with adhesion.

mod adhesion;
mod contact;

use clap::ValueEnum;

use crate::Outcome;

/// A study of its own.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Study {
    /// All methods on contact problems: `contact_precision.md` and its picture
    Contact,
    /// The scenes with adhesion on coarser and finer meshes and steps: `adhesion.md` and its picture
    Adhesion,
}

/// Makes the named studies, or all.
pub(crate) fn run(studies: &[Study]) -> Outcome {
    let wanted = |study| studies.is_empty() || studies.contains(&study);
    if wanted(Study::Contact) {
        contact::run()?;
    }
    if wanted(Study::Adhesion) {
        adhesion::run()?;
    }
    Ok(())
}
