//! Which error for which time: of the contact methods, and of the scenes with a reference.

mod cases;
mod contact;

use crate::Outcome;

/// Makes the named studies, or all: `contact`, and the cases of the package `tests` by name.
pub(crate) fn run(names: &[String]) -> Outcome {
    let wanted = |name: &str| names.is_empty() || names.iter().any(|n| n == name);
    let known: Vec<&str> = std::iter::once("contact")
        .chain(tests::cases::all().iter().map(|case| case.name))
        .collect();
    if let Some(unknown) = names.iter().find(|n| !known.contains(&n.as_str())) {
        return Err(format!(
            "no study `{unknown}`; there are {}",
            known.join(", ")
        ));
    }
    if wanted("contact") {
        contact::run()?;
    }
    let cases = tests::cases::all().into_iter();
    cases
        .filter(|case| wanted(case.name))
        .try_for_each(|case| cases::study(&case))
}
