//! The text of a scene, and what is wrong in it with the place.

use std::fmt;
use std::ops::Range;

use ron::error::{Error as RonError, Position, SpannedError};

use super::locate::{Node, NodeKind, SpanTree};
use super::near::near_names;
use super::overrides::{Override, is_within};

/// Text of a scene after the overrides.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct Source {
    /// File, or name of a built-in scene.
    pub name: String,
    /// RON text.
    pub text: String,
    /// Overrides applied to it, their paths in full.
    pub sets: Vec<Override>,
}

/// One thing wrong in a scene.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
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

impl Source {
    /// The first override that another one after it undoes: of the same value, or of one around it.
    pub fn undone(&self) -> Option<(&Override, &Override)> {
        let mut later = self.sets.iter().enumerate();
        later.find_map(|(i, set)| {
            let undone = |earlier: &&Override| set.undoes(earlier);
            Some((self.sets[..i].iter().find(undone)?, set))
        })
    }

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
        let inside = |set: &&Override| is_within(&path, &set.path);
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

    /// Names that stand twice in one map or struct.
    pub(super) fn duplicates(&self) -> Vec<Fault> {
        let Ok(tree) = SpanTree::scan(&self.text) else {
            return Vec::new();
        };
        let twice = tree.duplicates().into_iter();
        let message = "this name stands twice; names are unique";
        twice
            .map(|(path, span)| self.fault_at(span, path, String::new(), message.into()))
            .collect()
    }

    /// What ron has to say, in the words of a scene.
    pub(super) fn syntax_fault(&self, error: &SpannedError) -> Fault {
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
                let what = match error {
                    RonError::NoSuchStructField { .. } => "there is no field",
                    _ => "there is no choice",
                };
                let (path, _) = innermost(tree, name);
                let message = format!("{what} {}", unknown(found, expected));
                self.fault_at(name..name + found.len(), path, String::new(), message)
            }
            RonError::MissingStructField { field, .. } => {
                let (path, _) = around(tree, start, |kind| matches!(kind, NodeKind::Struct { .. }));
                let message = format!("the field `{field}` is missing");
                self.fault_at(start..start, path, String::new(), message)
            }
            RonError::ExpectedDifferentLength { .. } => {
                let sequence = |kind: &NodeKind| matches!(kind, NodeKind::Sequence(_));
                let (path, node) = around(tree, start, sequence);
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

/// A name that is not among those expected, with the nearest of them.
fn unknown(found: &str, expected: &[&str]) -> String {
    let near = near_names(found, expected.iter().copied());
    let hint = near
        .first()
        .map(|name| format!("; did you mean `{name}`?"))
        .unwrap_or_default();
    let all: Vec<String> = expected.iter().map(|name| format!("`{name}`")).collect();
    format!("`{found}` here{hint} (allowed: {})", all.join(", "))
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

/// Longest value that an error repeats \[characters\]: with its sentence it stays on two lines of a terminal.
const LONGEST_SHOWN: usize = 60;
/// Stands for the rest of a longer one.
const DOTS: &str = "...";

pub(super) fn shorten(text: &str) -> String {
    let line = text.split_whitespace().collect::<Vec<_>>().join(" ");
    if line.chars().count() <= LONGEST_SHOWN {
        return line;
    }
    let kept = line.chars().take(LONGEST_SHOWN - DOTS.len());
    kept.chain(DOTS.chars()).collect()
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
