//! Runs of lines that stand in two files.

use std::collections::BTreeMap;

/// Lines in a row that two files may not share.
const LONGEST_COPY: usize = 10;

/// A line that counts: its text and its number in the file.
type Line<'a> = (&'a str, usize);

/// One line for each pair of files and place where a run of [`LONGEST_COPY`] lines stands twice. Blank lines, comments,
/// `use` lines and tables of numbers do not count.
pub(super) fn copies(files: &[(String, String)]) -> Vec<String> {
    let lines: Vec<Vec<Line<'_>>> = files.iter().map(|(_, text)| counted(text)).collect();
    let mut places: BTreeMap<Vec<&str>, Vec<(usize, usize)>> = BTreeMap::new();
    for (file, lines) in lines.iter().enumerate() {
        for (at, run) in lines.windows(LONGEST_COPY).enumerate() {
            let run: Vec<&str> = run.iter().map(|(text, _)| *text).collect();
            places.entry(run).or_default().push((file, at));
        }
    }
    let mut faults = BTreeMap::new();
    for found in places.values() {
        let (first, line) = found[0];
        for (second, other) in found.iter().filter(|(file, _)| *file != first) {
            faults.entry((first, *second)).or_insert_with(|| {
                format!(
                    "{}:{} and {}:{} share {LONGEST_COPY} lines or more",
                    files[first].0,
                    lines[first][line].1,
                    files[*second].0,
                    lines[*second][*other].1
                )
            });
        }
    }
    faults.into_values().collect()
}

fn counted(text: &str) -> Vec<Line<'_>> {
    let product = text.split("#[cfg(test)]").next().unwrap_or(text);
    let mut inside_use = false;
    let mut lines = Vec::new();
    for (i, line) in product.lines().map(str::trim).enumerate() {
        if line.starts_with("use ") || line.starts_with("pub use ") {
            inside_use = true;
        }
        let skipped = inside_use || line.is_empty() || line.starts_with("//") || is_table(line);
        if inside_use && line.ends_with(';') {
            inside_use = false;
        }
        if !skipped {
            lines.push((line, i + 1));
        }
    }
    lines
}

/// A row of a table of numbers.
fn is_table(line: &str) -> bool {
    let number = |c: char| c.is_ascii_digit() || "[](){},.-+_e ".contains(c);
    line.contains(|c: char| c.is_ascii_digit()) && line.chars().all(number)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_copied_run_is_seen_and_a_table_is_not() {
        let run: String = (0..LONGEST_COPY)
            .map(|i| format!("let x{i} = f({i});\n"))
            .collect();
        let files =
            |a: &str, b: &str| [("a.rs", a), ("b.rs", b)].map(|(n, t)| (n.into(), t.into()));
        assert_eq!(
            copies(&files(&run, &format!("// b\nlet y = 0;\n{run}"))).len(),
            1
        );
        let table = "[1.0, -2.5e-3],\n".repeat(2 * LONGEST_COPY);
        assert!(copies(&files(&table, &table)).is_empty());
        let uses = "use std::fmt;\n".repeat(2 * LONGEST_COPY);
        assert!(copies(&files(&uses, &uses)).is_empty());
    }
}
