//! Siconos `.dat`: whitespace-separated numbers, of a local problem (`W`, `q`, `mu`) or a global one (`M`, `H`, `q`,
//! `b`, `mu`).

mod words;

use std::path::Path;

use contact_bipotential::{Cone, ContactProblem, Delassus, GlobalProblem, SparseEntries};

use super::{FclibError, normal_last, turned, turned_entries};

use words::Words;

type Entries = Vec<(usize, usize, f64)>;

/// Parses the text of a problem; `path` is only for messages. A global problem (`M v = H r + q`, `u = H^T v + b`) is
/// reduced to a local one. What follows the last number is refused.
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
    let first = matrix(&mut words, "W", None)?;
    if first.rows != first.columns {
        return Err(words.error(format!(
            "the first matrix has {} rows and {} columns: W of a local problem is square, and so is M of a global one",
            first.rows, first.columns
        )));
    }
    if is_global(&words, &first, dim * contacts) {
        global(words, first, dim, contacts)
    } else {
        local(words, first, dim, contacts)
    }
}

/// `q` and `mu` after `W`.
fn local(
    mut words: Words<'_>,
    w: SparseEntries,
    dim: usize,
    contacts: usize,
) -> Result<ContactProblem, FclibError> {
    let size = dim * contacts;
    if w.rows != size {
        return Err(words.error(format!(
            "W has {} rows where {dim} times {contacts} contacts are needed, and no H of {} rows and {size} columns \
             follows it, as in a global problem",
            w.rows, w.rows
        )));
    }
    let mut entries = w.entries;
    turned_entries(&mut entries, dim);
    let q = words.numbers("q", size)?;
    let mu = words.numbers("mu", contacts)?;
    words.end("mu")?;
    let cone = Cone::from_dim(dim).map_err(|e| words.problem(e))?;
    let w = Delassus::from_entries(contacts, dim, &entries).map_err(|e| words.problem(e))?;
    ContactProblem::new(w, turned(&q, dim), mu, cone).map_err(|e| words.problem(e))
}

/// `H`, `q`, `b` and `mu` after `M`.
fn global(
    mut words: Words<'_>,
    m: SparseEntries,
    dim: usize,
    contacts: usize,
) -> Result<ContactProblem, FclibError> {
    let (rows, size) = (m.rows, dim * contacts);
    if words.left() == size + contacts {
        return Err(words.error(format!(
            "the {size} numbers of q and {contacts} of mu that follow W begin like the header of an H, as in a global \
             problem: write them with a decimal point"
        )));
    }
    let mut h = matrix(&mut words, "H", Some([rows, size]))?;
    for e in &mut h.entries {
        e.1 = normal_last(e.1, dim);
    }
    let q = words.numbers("q", rows)?;
    let b = words.numbers("b", size)?;
    let mu = words.numbers("mu", contacts)?;
    words.end("mu")?;
    let cone = Cone::from_dim(dim).map_err(|e| words.problem(e))?;
    let global = GlobalProblem::new(m, h, q, turned(&b, dim), mu, cone);
    global.reduce().map_err(|e| words.problem(e))
}

/// Whether the header of an `H` follows: three integers, the last two of which are known.
fn is_global(words: &Words<'_>, m: &SparseEntries, size: usize) -> bool {
    let mut ahead = words.clone();
    let mut next = || ahead.integer("header of H").ok();
    next().is_some_and(|storage| storage <= 2) && next() == Some(m.rows) && next() == Some(size)
}

/// Storage, numbers of rows and columns, then the matrix as that storage writes it; `known` are the sizes that it can
/// only have.
fn matrix(
    words: &mut Words<'_>,
    name: &str,
    known: Option<[usize; 2]>,
) -> Result<SparseEntries, FclibError> {
    let storage = words.integer(&format!("storage of {name}"))?;
    let mut sizes = [0; 2];
    for (k, what) in ["rows", "columns"].iter().enumerate() {
        let what = format!("{what} of {name}");
        sizes[k] = match known {
            Some(known) => words.size(&what, known[k])?,
            None => words.integer(&what)?,
        };
    }
    let [rows, columns] = sizes;
    let entries = match storage {
        0 => dense(words, name, rows, columns)?,
        1 => blocks(words, name, rows, columns)?,
        2 => printed(words, name, rows, columns)?,
        _ => {
            return Err(words.error(format!(
                "storage {storage} of {name}: 0 (dense), 1 (blocks) and 2 (sparse) are known"
            )));
        }
    };
    Ok(SparseEntries::new(rows, columns, entries))
}

/// `size0 size1`, then all values by columns.
fn dense(
    words: &mut Words<'_>,
    name: &str,
    rows: usize,
    columns: usize,
) -> Result<Entries, FclibError> {
    words.size(&format!("rows of the dense {name}"), rows)?;
    words.size(&format!("columns of the dense {name}"), columns)?;
    let values = words.numbers(name, rows.saturating_mul(columns))?;
    Ok(values
        .iter()
        .enumerate()
        .filter(|(_, x)| **x != 0.0)
        .map(|(k, &x)| (k % rows, k / rows, x))
        .collect())
}

/// Compressed rows of blocks.
fn blocks(
    words: &mut Words<'_>,
    name: &str,
    rows: usize,
    columns: usize,
) -> Result<Entries, FclibError> {
    let count = words.integer("number of blocks")?;
    let (high, wide) = (
        words.integer("rows of blocks")?,
        words.integer("columns of blocks")?,
    );
    let row_ends = ends(words, &format!("row sizes of {name}"), high, rows)?;
    let column_ends = ends(words, &format!("column sizes of {name}"), wide, columns)?;
    words.size("length of the row pointers", high + 1)?;
    words.size("length of the column indices", count)?;
    let pointers = words.integers("row pointers", high + 1)?;
    let places = words.integers("columns of blocks", count)?;
    if pointers[0] != 0 || pointers[high] != count || pointers.windows(2).any(|p| p[0] > p[1]) {
        return Err(words.error(format!(
            "row pointers do not rise from 0 to the {count} blocks"
        )));
    }
    if let Some(c) = places.iter().find(|c| **c >= wide) {
        return Err(words.error(format!("block column {c} of {wide}")));
    }
    let mut entries = Vec::new();
    for row in 0..high {
        for k in pointers[row]..pointers[row + 1] {
            words.size("index of a block", k)?;
            for j in column_ends[places[k]]..column_ends[places[k] + 1] {
                for i in row_ends[row]..row_ends[row + 1] {
                    let value = words.number(&format!("block of {name}"))?;
                    entries.push((i, j, value));
                }
            }
        }
    }
    Ok(entries)
}

/// Where blocks end, from 0 on: sums that rise to `all`.
fn ends(
    words: &mut Words<'_>,
    what: &str,
    count: usize,
    all: usize,
) -> Result<Vec<usize>, FclibError> {
    let mut ends = vec![0];
    ends.extend(words.integers(what, count)?);
    if ends.windows(2).any(|e| e[0] >= e[1]) || ends[count] != all {
        return Err(words.error(format!("{what} do not rise from 0 to {all}")));
    }
    Ok(ends)
}

/// A print-out of a sparse matrix by columns: `col j : locations a to b`, then `row : value` for each.
fn printed(
    words: &mut Words<'_>,
    name: &str,
    rows: usize,
    columns: usize,
) -> Result<Entries, FclibError> {
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
    for column in 0..columns {
        for expected in ["col", "", ":", "locations"] {
            let word = words.next(&format!("column of {name}"))?;
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
            let row = words.integer(&format!("row of {name}"))?;
            if row >= rows {
                return Err(words.error(format!("row {row} of {rows}")));
            }
            words.next(":")?;
            let value = words.number(name)?;
            entries.push((row, column, value));
        }
    }
    if entries.len() < count {
        return Err(words.error(format!(
            "{} entries of {name} where {count} are announced",
            entries.len()
        )));
    }
    Ok(entries)
}

#[cfg(test)]
mod tests {
    use super::*;

    const DENSE: &str = "3\n1\n0\n3\n3\n3 3\n15 -1 -2\n-1 14 1\n-2 1 16\n-1 2 3\n0.1\n";
    const BLOCKS: &str = "2 2 1 4 4 3 2 2 2 4 2 4 3 3 0 2 3 0 1 1\n0 1 2 3 4\n1 5 6 7 8\n2 9 0 0 9\n-1 2 -3 4\n.5 .25";
    /// `M = diag(1, 2, 4)`, `H` the identity in three storages: `M v = H r + q`, `u = H^T v + b`.
    const GLOBAL: [&str; 3] = [
        "3 1 0 3 3 3 3\n1 0 0 0 2 0 0 0 4\n0 3 3 3 3\n1 0 0 0 1 0 0 0 1\n-1 1 0\n0 0 8\n.3\n",
        "3 1 0 3 3 3 3\n1 0 0 0 2 0 0 0 4\n1 3 3 2 2 1 1 3 3 3 2 0 1 2 0 0\n0 1 0 0\n1 0 0 1 0 0 1\n-1 1 0\n0 0 8\n.3\n",
        "3 1 0 3 3 3 3\n1 0 0 0 2 0 0 0 4\n2 3 3 2\nPrinter\n3-by-3, nzmax: 3 nnz: 3, 1-norm: 1\n\
         col 0 : locations 0 to 0\n0 : 1\ncol 1 : locations 1 to 1\n1 : 1\ncol 2 : locations 2 to 2\n2 : 1\n\
         -1 1 0\n0 0 8\n.3\n",
    ];
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
    fn a_global_problem_is_reduced() {
        for text in GLOBAL {
            let p = read(text).unwrap();
            let w = p.w.to_dense();
            // Normal first in the file, last here: q = M^-1 (-1, 1, 0) + (0, 0, 8).
            assert_eq!(
                [w[(0, 0)], w[(1, 1)], w[(2, 2)]],
                [0.5, 0.25, 1.0],
                "{text}"
            );
            assert_eq!((p.q, p.mu), (vec![0.5, 8.0, -1.0], vec![0.3]));
        }
        // More unknowns than contact rows: a mass that the contact does not see.
        let wide = "1 1 0 2 2 2 2\n2 0 0 5\n0 2 1 2 1\n1 0\n-1 7\n0\n.3\n";
        let p = read(wide).unwrap();
        assert_eq!((p.w.to_dense()[(0, 0)], p.q[0]), (0.5, -0.5));
    }

    #[test]
    fn what_is_left_over_is_refused() {
        for text in [DENSE, BLOCKS, PRINTED].iter().chain(&GLOBAL) {
            let lines = text.lines().count() + usize::from(text.ends_with('\n'));
            fails(
                &format!("{text} 5 6"),
                &format!("line {lines}: '5' and 1 more words follow mu"),
            );
        }
        // Some versions end their files with a flag; nothing follows it.
        assert!(read(&format!("{DENSE}1\n")).is_ok());
        fails(&format!("{DENSE}1 1\n"), "'1' and 1 more words follow mu");
        // A global problem cut to the length of a local one.
        fails(&GLOBAL[0][..39], "write them with a decimal point");
        // A local W with one number too many before mu, and one that is not square.
        fails(&DENSE.replace("-1 2 3", "-1 2 3 4"), "follow mu");
        fails("1 1 0 2 1 2 1 1 1", "2 rows and 1 columns");
        fails(
            "1 1 0 2 2 2 2 1 0 0 1 1 2 .3",
            "no H of 2 rows and 1 columns",
        );
        fails(
            &PRINTED.replace("nnz: 3", "nnz: 4"),
            "3 entries of W where 4",
        );
    }

    #[test]
    fn every_truncation_is_an_error() {
        for text in [DENSE, BLOCKS, PRINTED].iter().chain(&GLOBAL) {
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
