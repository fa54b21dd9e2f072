//! Which runs a sweep makes.

use std::str::FromStr;

use thiserror::Error;

use super::{Planned, Sweep};
use crate::catalog;
use crate::spec::{Override, SceneError};

/// Values that a field takes one after the other.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Vary {
    /// Dotted path, or any ending of one that no other field has.
    pub path: String,
    /// The values as RON, in the order of the runs.
    pub values: Vec<String>,
}

impl FromStr for Vary {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let wrong =
            "expected path=value,value,.., as in mu=0.2,0.4 or mesh.cells=(10, 10, 3),(20, 20, 6)";
        let (path, values) = text.split_once('=').ok_or(wrong)?;
        let vary = Vary {
            path: path.trim().to_owned(),
            values: split(values),
        };
        let fine = !vary.path.is_empty() && vary.values.iter().all(|value| !value.is_empty());
        if fine { Ok(vary) } else { Err(wrong.into()) }
    }
}

/// Pieces between the commas that are inside of no bracket and no text.
fn split(text: &str) -> Vec<String> {
    let (mut depth, mut quoted, mut escaped) = (0_i32, false, false);
    let mut pieces = vec![String::new()];
    for c in text.chars() {
        match c {
            _ if escaped => escaped = false,
            '\\' if quoted => escaped = true,
            '"' => quoted = !quoted,
            '(' | '[' | '{' if !quoted => depth += 1,
            ')' | ']' | '}' if !quoted => depth -= 1,
            _ => {}
        }
        if c == ',' && depth == 0 && !quoted {
            pieces.push(String::new());
        } else if let Some(piece) = pieces.last_mut() {
            piece.push(c);
        }
    }
    pieces.iter().map(|piece| piece.trim().to_owned()).collect()
}

/// Why a sweep is refused before anything is computed.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum SweepError {
    /// Two `--vary` of the same field.
    #[error("--vary {path}: this field is varied twice; give all its values in one --vary")]
    Twice {
        /// Full path of the field.
        path: String,
    },
    /// A `--vary` of what a `--set` gives, or two `--set` of which one undoes the other.
    #[error("--{kind} {path} undoes --set {set}; give one of the two")]
    Undone {
        /// What undoes: `set` or `vary`.
        kind: &'static str,
        /// Full path of its field.
        path: String,
        /// The `--set`, with its path in full.
        set: String,
    },
    /// The product of the numbers of values is out of hand.
    #[error("these values make {runs} runs; at most {MAX_RUNS}")]
    TooMany {
        /// Number of combinations, or the largest number when it is larger.
        runs: usize,
    },
    /// A combination that is no scene.
    #[error("run {number} of {runs} ({which}): {source}")]
    Scene {
        /// Number of the run, from 1.
        number: usize,
        /// Number of runs.
        runs: usize,
        /// Its values.
        which: String,
        /// What is wrong.
        source: Box<SceneError>,
    },
}

/// More runs than this are a slip in the values.
const MAX_RUNS: usize = 10_000;
/// Letters of a folder's name at most; file systems take 255 bytes.
const LONGEST_NAME: usize = 120;

impl Sweep {
    /// Reads and checks the scenes of all combinations.
    ///
    /// # Errors
    /// [`SweepError`]; the first combination that is no scene.
    pub fn plan(
        name_or_file: &str,
        sets: &[Override],
        varied: &[Vary],
    ) -> Result<Sweep, SweepError> {
        let count = |vary: &Vary| vary.values.len();
        let runs = varied.iter().map(count).fold(1, usize::saturating_mul);
        if runs > MAX_RUNS {
            return Err(SweepError::TooMany { runs });
        }
        let digits = runs.to_string().len();
        let mut sweep = Sweep {
            names: varied.iter().map(|vary| vary.path.clone()).collect(),
            paths: Vec::new(),
            runs: Vec::with_capacity(runs),
        };
        for index in 0..runs {
            let values = combination(varied, index);
            let which = pairs(&sweep.names, &values).join(", ");
            let (number, given) = (index + 1, values.iter().zip(&sweep.names));
            let mut all = sets.to_vec();
            all.extend(given.map(|(value, path)| Override {
                path: path.clone(),
                value: value.clone(),
            }));
            let scene = catalog::load(name_or_file, &all).map_err(|source| SweepError::Scene {
                number,
                runs,
                which,
                source: source.into(),
            })?;
            let full = scene.source.sets.iter().skip(sets.len());
            sweep.paths = full.map(|set| set.path.clone()).collect();
            refuse_undone(&scene.source.sets, sets.len())?;
            let plain: Vec<String> = values.iter().map(|value| in_file_name(value)).collect();
            let name = pairs(&sweep.names, &plain).join("_");
            let name: String = name.chars().take(LONGEST_NAME).collect();
            sweep.runs.push(Planned {
                folder: format!("{number:0digits$}_{name}"),
                values,
                scene,
            });
        }
        Ok(sweep)
    }

    /// The varied fields of a run with their values, `mu=0.2, dt=1e-3`.
    #[must_use]
    pub fn which(&self, index: usize) -> String {
        pairs(&self.names, &self.runs[index].values).join(", ")
    }
}

fn pairs(names: &[String], values: &[String]) -> Vec<String> {
    let pairs = names.iter().zip(values);
    pairs
        .map(|(name, value)| format!("{name}={value}"))
        .collect()
}

/// Overrides with full paths, the first `fixed` of them of all runs, that others after them undo.
fn refuse_undone(all: &[Override], fixed: usize) -> Result<(), SweepError> {
    for (i, later) in all.iter().enumerate() {
        let mut before = all[..i].iter().enumerate();
        let Some((k, set)) = before.find(|(_, set)| later.undoes(set)) else {
            continue;
        };
        let path = later.path.clone();
        return Err(match (k < fixed, i < fixed) {
            (true, within) => SweepError::Undone {
                kind: if within { "set" } else { "vary" },
                path,
                set: format!("{}={}", set.path, set.value),
            },
            (false, _) => SweepError::Twice { path },
        });
    }
    Ok(())
}

/// The values of the combination of that number, the last field fastest.
fn combination(varied: &[Vary], index: usize) -> Vec<String> {
    let mut rest = index;
    let mut values: Vec<String> = Vec::new();
    for vary in varied.iter().rev() {
        values.push(vary.values[rest % vary.values.len()].clone());
        rest /= vary.values.len();
    }
    values.reverse();
    values
}

/// A value with only what every file system takes: `(10, 10, 3)` becomes `10-10-3`.
fn in_file_name(value: &str) -> String {
    let plain = |c: char| c.is_ascii_alphanumeric() || matches!(c, '.' | '-' | '+' | '_');
    let words = value.split(|c| !plain(c)).filter(|word| !word.is_empty());
    words.collect::<Vec<_>>().join("-")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_are_split_at_outer_commas_only() {
        let vary: Vary = "cells = (10, 10, 3),(20, 20, 6)".parse().unwrap();
        assert_eq!(vary.path, "cells");
        assert_eq!(vary.values, ["(10, 10, 3)", "(20, 20, 6)"]);
        let vary: Vary = r#"a="x, (\" y", [1, {2: 3, 4: 5}],b"#.parse().unwrap();
        assert_eq!(vary.values, [r#""x, (\" y""#, "[1, {2: 3, 4: 5}]", "b"]);
        for wrong in ["mu", "=1", "mu=", "mu=1,", "mu=,1", "mu=1,,2"] {
            assert!(wrong.parse::<Vary>().is_err(), "{wrong}");
        }
    }

    #[test]
    fn the_last_field_varies_fastest() {
        let varied: Vec<Vary> = ["a=1,2", "b=x,y,z"].map(|v| v.parse().unwrap()).into();
        let all: Vec<String> = (0..6).map(|i| combination(&varied, i).concat()).collect();
        assert_eq!(all, ["1x", "1y", "1z", "2x", "2y", "2z"]);
    }

    #[test]
    fn any_value_makes_a_name() {
        assert_eq!(in_file_name("(10, 10, 3)"), "10-10-3");
        assert_eq!(in_file_name("-2.0e-3"), "-2.0e-3");
        assert_eq!(in_file_name("\"../x\""), "..-x");
        assert_eq!(in_file_name("[]"), "");
    }
}
