//! The words of a text file and what they may say.

use std::path::Path;

use contact_bipotential::ContactError;

use super::super::{FclibError, LARGEST_SIZE};

/// The words of a text with the line each stands on.
#[derive(Clone)]
pub(super) struct Words<'a> {
    path: &'a Path,
    rest: &'a str,
    line: usize,
}

impl<'a> Words<'a> {
    pub(super) fn new(path: &'a Path, bytes: &'a [u8]) -> Result<Self, FclibError> {
        let text = std::str::from_utf8(bytes).map_err(|e| {
            let line = 1 + bytes[..e.valid_up_to()]
                .iter()
                .filter(|b| **b == b'\n')
                .count();
            FclibError::Text {
                path: path.to_owned(),
                line,
                reason: "not text".to_owned(),
            }
        })?;
        Ok(Words {
            path,
            rest: text,
            line: 1,
        })
    }

    pub(super) fn error(&self, reason: String) -> FclibError {
        FclibError::Text {
            path: self.path.to_owned(),
            line: self.line,
            reason,
        }
    }

    pub(super) fn problem(&self, source: ContactError) -> FclibError {
        FclibError::Problem {
            path: self.path.to_owned(),
            source,
        }
    }

    pub(super) fn next(&mut self, what: &str) -> Result<&'a str, FclibError> {
        let start = self.rest.find(|c: char| !c.is_ascii_whitespace());
        let Some(start) = start else {
            return Err(self.error(format!("the file ends where {what} should stand")));
        };
        self.line += self.rest.as_bytes()[..start]
            .iter()
            .filter(|b| **b == b'\n')
            .count();
        let rest = &self.rest[start..];
        let end = rest
            .find(|c: char| c.is_ascii_whitespace())
            .unwrap_or(rest.len());
        self.rest = &rest[end..];
        Ok(&rest[..end])
    }

    /// The word after `marker`.
    pub(super) fn after(&mut self, marker: &str) -> Result<&'a str, FclibError> {
        while self.next(marker)? != marker {}
        self.next(marker)
    }

    pub(super) fn signed(&mut self, what: &str) -> Result<i64, FclibError> {
        let word = self.next(what)?;
        word.parse()
            .map_err(|_| self.error(format!("{what} is '{}', not an integer", shown(word))))
    }

    pub(super) fn integer(&mut self, what: &str) -> Result<usize, FclibError> {
        let value = self.signed(what)?;
        match usize::try_from(value) {
            Ok(n) if n <= LARGEST_SIZE => Ok(n),
            _ => Err(self.error(format!("{what} is {value}, outside of 0..={LARGEST_SIZE}"))),
        }
    }

    /// An integer that can only be `expected`.
    pub(super) fn size(&mut self, what: &str, expected: usize) -> Result<usize, FclibError> {
        let found = self.integer(what)?;
        if found == expected {
            Ok(found)
        } else {
            Err(self.error(format!("{what}: {found} where {expected} is needed")))
        }
    }

    pub(super) fn number(&mut self, what: &str) -> Result<f64, FclibError> {
        let word = self.next(what)?;
        match word.parse::<f64>() {
            Ok(x) if x.is_finite() => Ok(x),
            Ok(x) => Err(self.error(format!("{what} holds {x}: every number must be finite"))),
            Err(_) => Err(self.error(format!("{what} holds '{}', not a number", shown(word)))),
        }
    }

    /// Number of words that are left.
    pub(super) fn left(&self) -> usize {
        self.rest.split_ascii_whitespace().count()
    }

    /// Refuses whatever follows the last number of a problem, `last`, but the flag 0 or 1 with which some versions end
    /// their files.
    pub(super) fn end(&mut self, last: &str) -> Result<(), FclibError> {
        let left = self.left();
        if left == 0 {
            return Ok(());
        }
        let word = self.next(last)?;
        if left == 1 && matches!(word, "0" | "1") {
            return Ok(());
        }
        Err(self.error(format!(
            "'{}' and {} more words follow {last}, with which a problem ends (but for a flag, 0 or 1)",
            shown(word),
            left - 1
        )))
    }

    /// Refuses a count that the rest of the file is too short for, before anything is reserved.
    fn fits(&self, what: &str, count: usize) -> Result<(), FclibError> {
        if count > self.rest.len() {
            return Err(self.error(format!(
                "{what} needs {count} numbers, the file ends {} bytes on",
                self.rest.len()
            )));
        }
        Ok(())
    }

    pub(super) fn numbers(&mut self, what: &str, count: usize) -> Result<Vec<f64>, FclibError> {
        self.fits(what, count)?;
        (0..count).map(|_| self.number(what)).collect()
    }

    pub(super) fn integers(&mut self, what: &str, count: usize) -> Result<Vec<usize>, FclibError> {
        self.fits(what, count)?;
        (0..count).map(|_| self.integer(what)).collect()
    }
}

/// Characters of a wrong word that an error repeats, as long as any number: a file may be one endless word.
const LONGEST_SHOWN: usize = 24;

fn shown(word: &str) -> String {
    word.chars().take(LONGEST_SHOWN).collect()
}
