//! From text to a checked scene.

use ron::extensions::Extensions;

use super::Scene;
use super::check::check;
use super::error::SceneError;
use super::locate::SpanTree;
use super::overrides::{Override, replace, resolve, spellings};
use super::paths::field_paths;
use super::source::{Fault, Source};

/// A scene with the text it came from, so that whatever is built from it can still point into the file.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct LoadedScene {
    /// The scene.
    pub scene: Scene,
    /// Its text.
    pub source: Source,
}

impl LoadedScene {
    /// Checks a scene that code has built; `name` appears in errors, which have paths but no lines.
    ///
    /// # Errors
    /// [`SceneError::Faults`] with every value that is not allowed.
    pub fn new(name: &str, scene: Scene) -> Result<LoadedScene, SceneError> {
        let source = Source {
            name: name.to_owned(),
            text: String::new(),
            sets: Vec::new(),
        };
        checked(scene, source, Vec::new())
    }

    /// An error at the value of a dotted path, for what only the built model can tell.
    pub fn refuse(&self, path: &str, message: impl Into<String>) -> SceneError {
        SceneError::Faults {
            faults: vec![self.source.fault(path, message.into())],
            source_text: self.source.clone(),
        }
    }
}

/// Reads a scene: syntax, overrides one by one, then all checks of the values. `name` appears in errors.
///
/// # Errors
/// [`SceneError::Faults`] with every value that is not allowed, [`SceneError::Set`] for an override that does not
/// fit.
pub fn parse(name: &str, text: &str, sets: &[Override]) -> Result<LoadedScene, SceneError> {
    // Some editors mark UTF-8 by three bytes in front.
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    let mut source = Source {
        name: name.to_owned(),
        text: text.to_owned(),
        sets: Vec::new(),
    };
    let mut scene = deserialize(&source)?;
    for set in sets {
        (source, scene) = apply(&source, &scene, set)?;
    }
    let mut faults = source.duplicates();
    faults.extend(components_out_of_plane(&scene, &source));
    checked(scene, source, faults)
}

/// The scene if none of its values and nothing before is at fault.
fn checked(
    scene: Scene,
    source: Source,
    mut faults: Vec<Fault>,
) -> Result<LoadedScene, SceneError> {
    let issues = check(&scene).into_iter();
    faults.extend(issues.map(|issue| source.fault(&issue.path, issue.message)));
    if faults.is_empty() {
        return Ok(LoadedScene { scene, source });
    }
    faults.sort_by_key(|fault| fault.span.start);
    Err(SceneError::Faults {
        faults,
        source_text: source,
    })
}

/// Syntax and types only.
fn deserialize(source: &Source) -> Result<Scene, SceneError> {
    // A plain value is accepted where the scene has an optional one: `min_dt: 1e-6` and `min_dt: Some(1e-6)`.
    let options = ron::Options::default().with_default_extension(Extensions::IMPLICIT_SOME);
    options
        .from_str(&source.text)
        .map_err(|error| SceneError::Faults {
            faults: vec![source.syntax_fault(&error)],
            source_text: source.clone(),
        })
}

/// Motions of a plane scene that ask for z beside x or y; those that leave the components to their default ask for all
/// there are.
fn components_out_of_plane(scene: &Scene, source: &Source) -> Vec<Fault> {
    let Ok(tree) = SpanTree::scan(&source.text) else {
        return Vec::new();
    };
    let message =
        "must be some of the letters xy: a plane scene has no z; without this field it is both";
    let motions = scene.motions.iter().filter(|(name, given)| {
        let path = format!("motions.{name}.components");
        let [x, y, z] = given.mask();
        scene.is_plane() && z && (x || y) && tree.find(&path).is_some()
    });
    motions
        .map(|(name, _)| source.fault(&format!("motions.{name}.components"), message.into()))
        .collect()
}

/// A word for a value that looks like a number with its unit.
fn unit_advice(value: &str) -> String {
    let digits = |c: char| c.is_ascii_digit() || matches!(c, '.' | '-' | '+' | ' ');
    let unit = value.trim_start_matches(digits);
    let exponent = |c: char| matches!(c, 'e' | 'E');
    let number = value[..value.len() - unit.len()].trim_end();
    let rest = unit.trim_start_matches(exponent).trim_start_matches(digits);
    let (number, unit) = match unit.starts_with(exponent) && rest.len() + 1 < unit.len() {
        true => (value[..value.len() - rest.len()].trim_end(), rest),
        false => (number, unit),
    };
    if number.parse::<f64>().is_err() || !unit.starts_with(|c: char| c.is_alphabetic() || c == '%')
    {
        return String::new();
    }
    format!(
        "; units are not written: give the number alone, in the unit of the field, without `{unit}`"
    )
}

/// Applies one override to a text that is a scene already; the scene it gives.
fn apply(source: &Source, scene: &Scene, set: &Override) -> Result<(Source, Scene), SceneError> {
    let refuse = |reason: String| SceneError::Set {
        path: set.path.clone(),
        value: set.value.clone(),
        reason,
    };
    let path = resolve(&field_paths(scene), &set.path).map_err(&refuse)?;
    let mut failure = None;
    for value in spellings(&set.value) {
        let mut changed = source.clone();
        changed.text = replace(&source.text, &path, &value).map_err(&refuse)?;
        changed.sets.push(Override {
            path: path.clone(),
            value: set.value.clone(),
        });
        match deserialize(&changed) {
            Ok(scene) => return Ok((changed, scene)),
            Err(error) => failure = failure.or(Some(error)),
        }
    }
    let why = match &failure {
        Some(error) => error
            .faults()
            .first()
            .map(|f| f.message.clone())
            .unwrap_or_default(),
        None => String::new(),
    };
    let place = source.fault(&path, String::new());
    let now = if place.value.is_empty() {
        "it has its default".into()
    } else {
        format!("it is {}", place.value)
    };
    let advice = unit_advice(&set.value);
    Err(refuse(format!(
        "the value does not fit {path}: {why} ({now} in {}:{}:{}){advice}",
        place.file, place.line, place.column
    )))
}
