//! From text to a checked scene.

use std::ops::Range;

use ron::error::{Error as RonError, Position, SpannedError};
use ron::extensions::Extensions;

use super::check::check;
use super::overrides::{Override, apply, near_names};
use super::{Fault, Node, NodeKind, Scene, SceneError, SpanTree};

/// A scene with the text it came from, so that whatever is built from it can still point into the file.
#[derive(Clone, Debug)]
pub struct LoadedScene {
    /// The scene.
    pub scene: Scene,
    /// Its text.
    pub source: Source,
}

/// Text of a scene after the overrides.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Source {
    /// File, or name of a built-in scene.
    pub name: String,
    /// RON text.
    pub text: String,
    /// Overrides applied to it, their paths in full.
    pub sets: Vec<Override>,
}

impl LoadedScene {
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
    faults.extend(
        check(&scene)
            .into_iter()
            .map(|issue| source.fault(&issue.path, issue.message)),
    );
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
pub(super) fn deserialize(source: &Source) -> Result<Scene, SceneError> {
    // A plain value is accepted where the scene has an optional one: `min_dt: 1e-6` and `min_dt: Some(1e-6)`.
    let options = ron::Options::default().with_default_extension(Extensions::IMPLICIT_SOME);
    options
        .from_str(&source.text)
        .map_err(|error| SceneError::Faults {
            faults: vec![source.syntax_fault(&error)],
            source_text: source.clone(),
        })
}

impl Source {
    /// A fault at the value of a path; at the closest outer value when the text leaves the field to its default.
    pub(super) fn fault(&self, path: &str, message: String) -> Fault {
        let tree = SpanTree::scan(&self.text);
        let (span, value) = match tree.as_ref().map(|tree| tree.deepest(path)) {
            Ok((node, missing)) if missing.is_empty() => {
                (node.span.clone(), shorten(&self.text[node.span.clone()]))
            }
            Ok((node, _)) => (node.span.start..node.span.start + 1, String::new()),
            Err(_) => (0..0, String::new()),
        };
        self.fault_at(span, path.to_owned(), value, message)
    }

    fn fault_at(&self, span: Range<usize>, path: String, value: String, message: String) -> Fault {
        let (line, column) = line_column(&self.text, span.start);
        let inside = |set: &&Override| {
            path == set.path
                || path
                    .strip_prefix(&set.path)
                    .is_some_and(|rest| rest.starts_with('.'))
        };
        let set_by = self.sets.iter().rev().find(inside).cloned();
        Fault {
            file: self.name.clone(),
            line,
            column,
            span,
            path,
            value,
            message,
            set_by,
        }
    }

    fn duplicates(&self) -> Vec<Fault> {
        let Ok(tree) = SpanTree::scan(&self.text) else {
            return Vec::new();
        };
        let twice = tree.duplicates().into_iter();
        let message = "this name stands twice; names are unique";
        twice
            .map(|(path, span)| self.fault_at(span, path, String::new(), message.into()))
            .collect()
    }

    fn syntax_fault(&self, error: &SpannedError) -> Fault {
        let start = offset(&self.text, error.span.start);
        let end = offset(&self.text, error.span.end).max(start);
        match SpanTree::scan(&self.text) {
            Ok(tree) => self.type_fault(&error.code, &tree, start, end),
            Err(scan) if scan.offset < start => {
                let message = format!("expected {} (noticed later: {})", scan.expected, error.code);
                self.fault_at(
                    scan.offset..scan.offset,
                    String::new(),
                    String::new(),
                    message,
                )
            }
            Err(_) => self.fault_at(
                start..end,
                String::new(),
                String::new(),
                error.code.to_string(),
            ),
        }
    }

    /// The brackets are right, so a value is not what its field takes.
    fn type_fault(&self, error: &RonError, tree: &SpanTree, start: usize, end: usize) -> Fault {
        // ron may stand before the space in front of a value.
        let gap = self.text[start..].len() - self.text[start..].trim_start().len();
        let start = start + gap;
        let (path, node) = innermost(tree, start);
        let value = shorten(&self.text[node.span.clone()]);
        match error {
            RonError::NoSuchStructField {
                found, expected, ..
            }
            | RonError::NoSuchEnumVariant {
                found, expected, ..
            } => {
                // ron stands behind the name when it reports; the name itself is the place.
                let name = self.text[..end].rfind(found.as_str()).unwrap_or(start);
                let near = near_names(found, expected.iter().copied());
                let hint = near
                    .first()
                    .map(|name| format!("; did you mean `{name}`?"))
                    .unwrap_or_default();
                let all: Vec<String> = expected.iter().map(|name| format!("`{name}`")).collect();
                let what = match error {
                    RonError::NoSuchStructField { .. } => "there is no field",
                    _ => "there is no choice",
                };
                let message = format!("{what} `{found}` here{hint} (allowed: {})", all.join(", "));
                let (path, _) = innermost(tree, name);
                self.fault_at(name..name + found.len(), path, String::new(), message)
            }
            RonError::MissingStructField { field, .. } => {
                let (path, _) = around(tree, start, |kind| matches!(kind, NodeKind::Struct { .. }));
                let message = format!("the field `{field}` is missing");
                self.fault_at(start..start, path, String::new(), message)
            }
            RonError::ExpectedDifferentLength { .. } => {
                let (path, node) =
                    around(tree, start, |kind| matches!(kind, NodeKind::Sequence(_)));
                let value = shorten(&self.text[node.span.clone()]);
                self.fault_at(node.span.clone(), path, value, error.to_string())
            }
            RonError::ExpectedComma if node.kind == NodeKind::Scalar => {
                let message = "does not fit here; is a whole number expected?".to_owned();
                self.fault_at(node.span.clone(), path, value, message)
            }
            _ if node.kind == NodeKind::Scalar || matches!(error, RonError::Message(_)) => {
                let message = match error {
                    RonError::ExpectedFloat => "must be a number".to_owned(),
                    RonError::ExpectedInteger => "must be a whole number".to_owned(),
                    RonError::IntegerOutOfBounds => "must be a whole number, 0 or more".to_owned(),
                    RonError::ExpectedString => "must be a text in quotes".to_owned(),
                    other => other.to_string(),
                };
                self.fault_at(node.span.clone(), path, value, message)
            }
            _ => self.fault_at(
                start..end.max(start),
                path,
                String::new(),
                error.to_string(),
            ),
        }
    }
}

/// Path of the smallest value around a byte, and the value.
fn innermost(tree: &SpanTree, at: usize) -> (String, &Node) {
    let paths = tree.paths().into_iter();
    let around = paths.filter(|(_, node)| node.span.start <= at && at <= node.span.end);
    around
        .min_by_key(|(_, node)| node.span.len())
        .unwrap_or_else(|| (String::new(), tree.root()))
}

/// The smallest value of a kind around a byte; the outermost value when there is none.
fn around(tree: &SpanTree, at: usize, kind: impl Fn(&NodeKind) -> bool) -> (String, &Node) {
    let paths = tree.paths().into_iter();
    let around = paths.filter(|(_, node)| {
        node.span.start <= at && at < node.span.end && kind(&node.content().kind)
    });
    around
        .min_by_key(|(_, node)| node.span.len())
        .unwrap_or_else(|| (String::new(), tree.root()))
}

fn shorten(text: &str) -> String {
    let line = text.split_whitespace().collect::<Vec<_>>().join(" ");
    if line.chars().count() <= 60 {
        return line;
    }
    line.chars().take(57).chain("...".chars()).collect()
}

/// Line and column from 1, the column in characters.
fn line_column(text: &str, at: usize) -> (usize, usize) {
    let before = &text[..at.min(text.len())];
    let start = before.rfind('\n').map_or(0, |i| i + 1);
    (
        before.matches('\n').count() + 1,
        before[start..].chars().count() + 1,
    )
}

fn offset(text: &str, position: Position) -> usize {
    let line_start: usize = text
        .split_inclusive('\n')
        .take(position.line - 1)
        .map(str::len)
        .sum();
    let line = text[line_start..].split('\n').next().unwrap_or_default();
    let in_line = line
        .char_indices()
        .nth(position.col.saturating_sub(1))
        .map_or(line.len(), |(i, _)| i);
    line_start + in_line
}
