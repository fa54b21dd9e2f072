//! `--set path=value`: the text of one value is replaced, everything around it stays.

use std::str::FromStr;

use super::locate::{NodeKind, SpanTree};
use super::near::distance;

/// A changed value.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Override {
    /// Dotted path, or any ending of one that no other field has: `interfaces.blocks.mu`, `blocks.mu`, `mu`.
    pub path: String,
    /// The value as RON; a text may stand without quotes.
    pub value: String,
}

impl Override {
    /// Whether nothing is left of `earlier` when both have full paths: it changes the same value, or one inside.
    #[must_use]
    pub fn undoes(&self, earlier: &Override) -> bool {
        is_within(&earlier.path, &self.path)
    }
}

/// Whether a dotted path is `outer` or leads to something inside of it.
pub(super) fn is_within(path: &str, outer: &str) -> bool {
    let rest = path.strip_prefix(outer);
    rest.is_some_and(|rest| rest.is_empty() || rest.starts_with('.'))
}

impl FromStr for Override {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        match text.split_once('=') {
            Some((path, value)) if !path.trim().is_empty() && !value.trim().is_empty() => {
                Ok(Override {
                    path: path.trim().to_owned(),
                    value: value.trim().to_owned(),
                })
            }
            _ => Err("expected path=value, as in mu=0.2 or bodies.lower.mesh.cells=(8,8,4)".into()),
        }
    }
}

/// The full path that an abbreviation means.
pub(super) fn resolve(paths: &[String], asked: &str) -> Result<String, String> {
    if paths.iter().any(|path| path == asked) {
        return Ok(asked.to_owned());
    }
    let ending = format!(".{asked}");
    let found: Vec<&String> = paths
        .iter()
        .filter(|path| path.ends_with(&ending))
        .collect();
    match found[..] {
        [path] => Ok(path.clone()),
        [] => {
            let near = near_paths(paths, asked);
            let hint = if near.is_empty() {
                String::new()
            } else {
                format!("; near: {}", near.join(", "))
            };
            Err(format!("no field of this scene is called so{hint}"))
        }
        _ => {
            let list: Vec<&str> = found.iter().map(|path| path.as_str()).collect();
            Err(format!(
                "several fields end so, say which: {}",
                list.join(", ")
            ))
        }
    }
}

/// Paths that an error proposes at most.
const MOST_NEAR: usize = 5;

/// Paths one of whose endings looks like `asked`; two slips are allowed, and one more for every six letters.
fn near_paths(paths: &[String], asked: &str) -> Vec<String> {
    let depth = asked.split('.').count();
    let ending = |path: &str| {
        let segments: Vec<&str> = path.split('.').collect();
        segments[segments.len().saturating_sub(depth)..].join(".")
    };
    let mut near: Vec<(usize, &String)> = paths
        .iter()
        .map(|path| (distance(&ending(path), asked), path))
        .filter(|(d, _)| *d <= 2 + asked.len() / 6)
        .collect();
    near.sort_by_key(|(d, _)| *d);
    near.into_iter()
        .take(MOST_NEAR)
        .map(|(_, path)| path.clone())
        .collect()
}

/// Texts to try for a value: as given when it is one RON value, then as a string.
pub(super) fn spellings(value: &str) -> Vec<String> {
    let quoted = format!("\"{}\"", value.replace('\\', "\\\\").replace('"', "\\\""));
    // Anything around the value, as a comment, could swallow what follows in the file.
    let alone = SpanTree::scan(value).is_ok_and(|tree| tree.root().span == (0..value.len()));
    if alone {
        vec![value.to_owned(), quoted]
    } else {
        vec![quoted]
    }
}

/// The text with the value at `path` replaced, or inserted where the text leaves it to its default.
pub(super) fn replace(text: &str, path: &str, value: &str) -> Result<String, String> {
    let tree = SpanTree::scan(text).map_err(|e| e.to_string())?;
    let (node, missing) = tree.deepest(path);
    let [first, inner @ ..] = &missing[..] else {
        return Ok(format!(
            "{}{value}{}",
            &text[..node.span.start],
            &text[node.span.end..]
        ));
    };
    let NodeKind::Struct { open, .. } = node.content().kind else {
        return Err(format!(
            "{path} has its default; set the whole of {}",
            outer(path, missing.len())
        ));
    };
    if missing
        .iter()
        .any(|segment| segment.parse::<usize>().is_ok())
    {
        let whole = missing
            .iter()
            .position(|s| s.parse::<usize>().is_ok())
            .unwrap_or(0);
        return Err(format!(
            "{path} has its default; set the whole of {}",
            outer(path, missing.len() - whole)
        ));
    }
    let nested = inner.iter().rev().fold(value.to_owned(), |value, field| {
        format!("({field}: {value})")
    });
    Ok(format!(
        "{}{first}: {nested}, {}",
        &text[..open],
        &text[open..]
    ))
}

/// `path` without its last `count` segments.
fn outer(path: &str, count: usize) -> String {
    let segments: Vec<&str> = path.split('.').collect();
    segments[..segments.len().saturating_sub(count)].join(".")
}
