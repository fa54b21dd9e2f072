//! Siconos `.dat`: whitespace-separated numbers.

use std::path::Path;

use contact_bipotential::{Cone, ContactProblem, Delassus};

use super::{FclibError, LARGEST_SIZE, turned, turned_entries};

type Entries = Vec<(usize, usize, f64)>;

/// Parses the text of a problem; `path` is only for messages.
///
/// # Errors
/// [`FclibError::Text`] with the line, [`FclibError::Problem`] for numbers that make no problem.
pub fn parse(path: &Path, bytes: &[u8]) -> Result<ContactProblem, FclibError> {
    let mut words = Words::new(path, bytes)?;
    let dim = words.integer("dimension")?;
    if !(1..=3).contains(&dim) {
        return Err(words.error(format!("dimension {dim}: give 1, 2 or 3")));
    }
    let contacts = words.integer("number of contacts")?;
    let storage = words.integer("storage")?;
    let size = words.size("rows of W", dim * contacts)?;
    words.size("columns of W", size)?;
    let mut entries = match storage {
        0 => dense(&mut words, size)?,
        1 => blocks(&mut words, contacts, dim)?,
        2 => printed(&mut words, size)?,
        _ => {
            return Err(words.error(format!(
                "storage {storage}: 0 (dense), 1 (blocks) and 2 (sparse) are known"
            )));
        }
    };
    turned_entries(&mut entries, dim);
    let q = words.numbers("q", size)?;
    let mu = words.numbers("mu", contacts)?;
    let problem = |source| FclibError::Problem {
        path: path.to_owned(),
        source,
    };
    let cone = Cone::from_dim(dim).map_err(problem)?;
    let w = Delassus::from_entries(contacts, dim, &entries).map_err(problem)?;
    ContactProblem::new(w, turned(&q, dim), mu, cone).map_err(problem)
}

/// `size0 size1`, then all values by columns.
fn dense(words: &mut Words<'_>, size: usize) -> Result<Entries, FclibError> {
    words.size("rows of the dense W", size)?;
    words.size("columns of the dense W", size)?;
    let values = words.numbers("W", size.saturating_mul(size))?;
    Ok(values
        .iter()
        .enumerate()
        .filter(|(_, x)| **x != 0.0)
        .map(|(k, &x)| (k % size, k / size, x))
        .collect())
}

/// Compressed rows of blocks.
fn blocks(words: &mut Words<'_>, contacts: usize, dim: usize) -> Result<Entries, FclibError> {
    let count = words.integer("number of blocks")?;
    words.size("rows of blocks", contacts)?;
    words.size("columns of blocks", contacts)?;
    for what in ["row sizes", "column sizes"] {
        for c in 1..=contacts {
            words.size(what, c * dim)?;
        }
    }
    words.size("length of the row pointers", contacts + 1)?;
    words.size("length of the column indices", count)?;
    let pointers = words.integers("row pointers", contacts + 1)?;
    let columns = words.integers("columns of blocks", count)?;
    if pointers[0] != 0 || pointers[contacts] != count || pointers.windows(2).any(|p| p[0] > p[1]) {
        return Err(words.error(format!(
            "row pointers do not rise from 0 to the {count} blocks"
        )));
    }
    if let Some(c) = columns.iter().find(|c| **c >= contacts) {
        return Err(words.error(format!("block column {c} of {contacts} contacts")));
    }
    let mut entries = Vec::new();
    for row in 0..contacts {
        for k in pointers[row]..pointers[row + 1] {
            words.size("index of a block", k)?;
            for j in 0..dim {
                for i in 0..dim {
                    let value = words.number("block of W")?;
                    entries.push((row * dim + i, columns[k] * dim + j, value));
                }
            }
        }
    }
    Ok(entries)
}

/// A print-out of a sparse matrix by columns: `col j : locations a to b`, then `row : value` for each.
fn printed(words: &mut Words<'_>, size: usize) -> Result<Entries, FclibError> {
    let kind = words.integer("kind of sparse matrix")?;
    if kind != 2 {
        return Err(words.error(format!(
            "sparse matrix of kind {kind}: only 2 (compressed columns) is known"
        )));
    }
    let count = words.after("nnz:")?.trim_end_matches(',').parse::<usize>();
    let count = count.map_err(|_| words.error("nnz: is not followed by a count".to_owned()))?;
    let mut entries = Entries::new();
    words.after("1-norm:")?;
    for column in 0..size {
        for expected in ["col", "", ":", "locations"] {
            let word = words.next("column of W")?;
            if !expected.is_empty() && word != expected {
                return Err(words.error(format!(
                    "'{word}' where '{expected}' of column {column} should stand"
                )));
            }
        }
        let first = words.integer("first location")?;
        words.next("to")?;
        let end = words.signed("last location")? + 1;
        if first != entries.len() || end < first as i64 || end > count as i64 {
            return Err(words.error(format!(
                "column {column} lies at {first} to {end} of {count} entries"
            )));
        }
        for _ in first..end as usize {
            let row = words.integer("row of W")?;
            if row >= size {
                return Err(words.error(format!("row {row} of {size}")));
            }
            words.next(":")?;
            let value = words.number("W")?;
            entries.push((row, column, value));
        }
    }
    Ok(entries)
}

/// The words of a text with the line each stands on.
struct Words<'a> {
    path: &'a Path,
    rest: &'a str,
    line: usize,
}

impl<'a> Words<'a> {
    fn new(path: &'a Path, bytes: &'a [u8]) -> Result<Self, FclibError> {
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

    fn error(&self, reason: String) -> FclibError {
        FclibError::Text {
            path: self.path.to_owned(),
            line: self.line,
            reason,
        }
    }

    fn next(&mut self, what: &str) -> Result<&'a str, FclibError> {
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
    fn after(&mut self, marker: &str) -> Result<&'a str, FclibError> {
        while self.next(marker)? != marker {}
        self.next(marker)
    }

    fn signed(&mut self, what: &str) -> Result<i64, FclibError> {
        let word = self.next(what)?;
        word.parse()
            .map_err(|_| self.error(format!("{what} is '{}', not an integer", shown(word))))
    }

    fn integer(&mut self, what: &str) -> Result<usize, FclibError> {
        let value = self.signed(what)?;
        match usize::try_from(value) {
            Ok(n) if n <= LARGEST_SIZE => Ok(n),
            _ => Err(self.error(format!("{what} is {value}, outside of 0..={LARGEST_SIZE}"))),
        }
    }

    /// An integer that can only be `expected`.
    fn size(&mut self, what: &str, expected: usize) -> Result<usize, FclibError> {
        let found = self.integer(what)?;
        if found == expected {
            Ok(found)
        } else {
            Err(self.error(format!("{what}: {found} where {expected} is needed")))
        }
    }

    fn number(&mut self, what: &str) -> Result<f64, FclibError> {
        let word = self.next(what)?;
        match word.parse::<f64>() {
            Ok(x) if x.is_finite() => Ok(x),
            Ok(x) => Err(self.error(format!("{what} holds {x}: every number must be finite"))),
            Err(_) => Err(self.error(format!("{what} holds '{}', not a number", shown(word)))),
        }
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

    fn numbers(&mut self, what: &str, count: usize) -> Result<Vec<f64>, FclibError> {
        self.fits(what, count)?;
        (0..count).map(|_| self.number(what)).collect()
    }

    fn integers(&mut self, what: &str, count: usize) -> Result<Vec<usize>, FclibError> {
        self.fits(what, count)?;
        (0..count).map(|_| self.integer(what)).collect()
    }
}

/// Characters of a wrong word that an error repeats, as long as any number: a file may be one endless word.
const LONGEST_SHOWN: usize = 24;

fn shown(word: &str) -> String {
    word.chars().take(LONGEST_SHOWN).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    const DENSE: &str = "3\n1\n0\n3\n3\n3 3\n15 -1 -2\n-1 14 1\n-2 1 16\n-1 2 3\n0.1\n";
    const BLOCKS: &str = "2 2 1 4 4 3 2 2 2 4 2 4 3 3 0 2 3 0 1 1\n0 1 2 3 4\n1 5 6 7 8\n2 9 0 0 9\n-1 2 -3 4\n.5 .25";
    const PRINTED: &str = "2\n1\n2\n2\n2\n2\nPrinter 1\n2-by-2, nzmax: 3 nnz: 3, 1-norm: 9\n\
                           col 0 : locations 0 to 1\n0 : 3\n1 : 1\ncol 1 : locations 2 to 2\n1 : 4\n-1 2\n.3\n";

    fn read(text: &str) -> Result<ContactProblem, FclibError> {
        parse(Path::new("x.dat"), text.as_bytes())
    }

    fn fails(text: &str, expected: &str) {
        let message = read(text).unwrap_err().to_string();
        assert!(message.contains(expected), "{message}");
    }

    #[test]
    fn each_storage_is_turned() {
        let p = read(DENSE).unwrap();
        assert_eq!(p.q, [2.0, 3.0, -1.0]);
        let w = p.w.to_dense();
        assert_eq!(
            [w[(2, 2)], w[(0, 0)], w[(1, 2)], w[(1, 0)]],
            [15.0, 14.0, -2.0, 1.0]
        );
        let p = read(BLOCKS).unwrap();
        let w = p.w.to_dense();
        // Block (0, 1) holds 5 6 7 8 by columns, normal first.
        assert_eq!(
            [w[(1, 3)], w[(0, 3)], w[(1, 2)], w[(0, 2)]],
            [5.0, 6.0, 7.0, 8.0]
        );
        assert_eq!(p.mu, [0.5, 0.25]);
        let w = read(PRINTED).unwrap().w.to_dense();
        assert_eq!(
            [w[(1, 1)], w[(0, 1)], w[(0, 0)], w[(1, 0)]],
            [3.0, 1.0, 4.0, 0.0]
        );
    }

    #[test]
    fn every_truncation_is_an_error() {
        for text in [DENSE, BLOCKS, PRINTED] {
            let words: Vec<&str> = text.split_ascii_whitespace().collect();
            for k in 0..words.len() {
                assert!(read(&words[..k].join(" ")).is_err(), "{k} words of {text}");
            }
        }
    }

    #[test]
    fn the_place_is_named() {
        fails(&DENSE.replace("14", "nan"), "line 8: W holds NaN");
        fails(&DENSE.replace("14", "1e999"), "line 8: W holds inf");
        fails(&DENSE.replace("14", "x"), "line 8: W holds 'x'");
        fails("7 1 0 7 7", "dimension 7");
        fails(
            "3 5000000 0 15000000 15000000 15000000 15000000 1",
            "needs 225000000000000 numbers",
        );
        fails("3 99999999999 0", "outside of 0..=");
        fails("3 -1 0", "outside of 0..=");
        fails(&BLOCKS.replace("0 1 1\n", "0 7 1\n"), "block column 7 of 2");
        fails(&BLOCKS.replace("0 2 3 0 1", "0 9 3 0 1"), "row pointers");
        fails(&PRINTED.replace("1 : 4", "6 : 4"), "row 6 of 2");
        fails(&DENSE.replace("0.1", "-0.1"), "friction coefficient -0.1");
        let binary = parse(Path::new("b.dat"), &[51, 10, 255, 254, 0])
            .unwrap_err()
            .to_string();
        assert_eq!(binary, "b.dat, line 2: not text");
    }
}
