//! Invariants of the house that a program can check.

mod copies;
mod functions;
mod modules;

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

use crate::{Outcome, root};
use modules::Modules;

/// Crates in the order of the arrows and what each may depend on.
const ARROWS: &[(&str, &[&str])] = &[
    ("hyperelastic", &[]),
    ("fe-core", &["hyperelastic"]),
    ("contact-bipotential", &["fe-core"]),
    ("nscd", &["fe-core", "contact-bipotential"]),
    (
        "scenarios",
        &["hyperelastic", "fe-core", "contact-bipotential", "nscd"],
    ),
];

/// Longest file that is still one room.
const LONGEST_FILE: usize = 500;

/// Widest line of a comment in columns, indentation included.
const WIDEST_COMMENT: usize = 120;

/// Largest picture of the docs in bytes.
const HEAVIEST_PICTURE: usize = 200_000;

/// What only the crate `scenarios` may do.
const OUTSIDE_WORLD: &[&str] = &[
    "std::fs",
    "std::time",
    "std::env",
    "println!",
    "eprintln!",
    "HashMap",
];

pub(crate) fn run() -> Outcome {
    let mut faults = Vec::new();
    check_arrows(&mut faults)?;
    let references = bibliography_keys()?;
    let mut product = Vec::new();
    for (name, _) in ARROWS {
        let crate_root = root().join("crates").join(name);
        for file in files(&crate_root, "rs")? {
            let text = read(&file)?;
            let shown = shown(&file, &root());
            check_file(&shown, name, &text, &mut faults);
            check_references(&shown, &text, &references, &mut faults);
            check_units(&shown, &text, &mut faults);
            if is_product(&shown) {
                faults.extend(functions::too_long(&shown, &text)?);
                product.push((shown, text));
            }
        }
        for name in ["src/lib.rs", "src/main.rs"] {
            let file = crate_root.join(name);
            if file.exists() {
                let modules = Modules::read(&file)?;
                faults.extend(modules.circles(&root()));
                faults.extend(modules.scattered_impls(&root()));
            }
        }
    }
    faults.extend(copies::copies(&product));
    for folder in ["crates", "xtask", "tests", "benches"] {
        for file in files(&root().join(folder), "rs")? {
            check_comments(&shown(&file, &root()), &read(&file)?, &mut faults);
        }
    }
    check_pictures(&mut faults)?;
    if faults.is_empty() {
        Ok(())
    } else {
        Err(format!(
            "{} faults\n  {}",
            faults.len(),
            faults.join("\n  ")
        ))
    }
}

/// Each crate depends on the crates below it only; tests may look anywhere.
fn check_arrows(faults: &mut Vec<String>) -> Outcome {
    for (name, allowed) in ARROWS {
        let manifest = read(&root().join("crates").join(name).join("Cargo.toml"))?;
        let dependencies = section(&manifest, "[dependencies]");
        for (other, _) in ARROWS {
            let depends = dependencies
                .lines()
                .any(|l| l.split(['.', ' ', '=']).next() == Some(*other));
            if depends && !allowed.contains(other) {
                faults.push(format!(
                    "crates/{name}/Cargo.toml: {name} must not depend on {other}"
                ));
            }
        }
    }
    Ok(())
}

fn section<'a>(manifest: &'a str, title: &str) -> &'a str {
    let start = manifest
        .find(title)
        .map_or(manifest.len(), |i| i + title.len());
    let rest = &manifest[start..];
    rest.find("\n[").map_or(rest, |end| &rest[..end])
}

/// Comments of all packages have one width.
fn check_comments(shown: &str, text: &str, faults: &mut Vec<String>) {
    for (i, line) in text.lines().enumerate() {
        let width = line.chars().count();
        if line.trim_start().starts_with("//") && width > WIDEST_COMMENT {
            faults.push(format!(
                "{shown}:{}: a comment of {width} columns; {WIDEST_COMMENT} at most",
                i + 1
            ));
        }
    }
}

/// A picture of the docs has to open at once.
fn check_pictures(faults: &mut Vec<String>) -> Outcome {
    for file in files(&root().join("docs"), "svg")? {
        let bytes = read(&file)?.len();
        if bytes > HEAVIEST_PICTURE {
            let shown = shown(&file, &root());
            faults.push(format!(
                "{shown}: {bytes} bytes; {HEAVIEST_PICTURE} at most"
            ));
        }
    }
    Ok(())
}

fn check_file(shown: &str, krate: &str, text: &str, faults: &mut Vec<String>) {
    if shown.ends_with("mod.rs") {
        faults.push(format!(
            "{shown}: name the module after its folder instead of mod.rs"
        ));
    }
    let lines = text.lines().count();
    if lines > LONGEST_FILE && !shown.contains("tests") {
        faults.push(format!("{shown}: {lines} lines; is it still one room?"));
    }
    if krate == "scenarios" || !is_product(shown) {
        return;
    }
    let product = text.split("#[cfg(test)]").next().unwrap_or(text);
    for word in OUTSIDE_WORLD {
        let used = |l: &&str| l.contains(word) && !l.trim_start().starts_with("//");
        if let Some(line) = product.lines().find(used) {
            faults.push(format!(
                "{shown}: `{word}` belongs to the crate scenarios only: {}",
                line.trim()
            ));
        }
    }
}

/// Whether the file is neither a test nor an example.
fn is_product(shown: &str) -> bool {
    !["/tests/", "/examples/"].iter().any(|f| shown.contains(f)) && !shown.ends_with("tests.rs")
}

/// `#[cfg(test)]`, alone or with other conditions.
fn is_test(attributes: &[syn::Attribute]) -> bool {
    attributes.iter().any(|a| {
        a.path().is_ident("cfg")
            && a.meta.require_list().is_ok_and(|list| {
                let condition = list.tokens.to_string();
                condition == "test" || condition.starts_with("all (test")
            })
    })
}

fn shown(file: &Path, root: &Path) -> String {
    file.strip_prefix(root)
        .unwrap_or(file)
        .display()
        .to_string()
}

/// `[Key, eq. 3]` in a comment must name a key of docs/references.bib.
fn check_references(shown: &str, text: &str, keys: &BTreeSet<String>, faults: &mut Vec<String>) {
    for line in text.lines().filter(|l| l.trim_start().starts_with("//")) {
        for piece in line.split('[').skip(1) {
            let Some((inside, _)) = piece.split_once(']') else {
                continue;
            };
            let Some((key, place)) = inside.split_once(',') else {
                continue;
            };
            if place.trim_start().starts_with("eq") && !keys.contains(key.trim()) {
                faults.push(format!(
                    "{shown}: reference [{inside}] is not in docs/references.bib"
                ));
            }
        }
    }
}

/// A public f64 field with a physical name says its unit in its comment.
fn check_units(shown: &str, text: &str, faults: &mut Vec<String>) {
    let mut comment = String::new();
    for line in text.lines().map(str::trim) {
        if let Some(words) = line.strip_prefix("///") {
            comment.push_str(words);
            continue;
        }
        let field = line.strip_prefix("pub ").and_then(|l| l.split_once(": "));
        if let Some((name, kind)) = field
            && kind.trim_end_matches(',') == "f64"
            && !comment.contains('[')
        {
            faults.push(format!(
                "{shown}: public field `{name}` has no unit in its comment, e.g. [Pa] or [-]"
            ));
        }
        if !line.starts_with("#[") {
            comment.clear();
        }
    }
}

fn bibliography_keys() -> Result<BTreeSet<String>, String> {
    let text = read(&root().join("docs/references.bib"))?;
    let entries = text.lines().filter(|l| l.starts_with('@'));
    Ok(entries
        .filter_map(|l| l.split_once('{'))
        .map(|(_, key)| key.trim_end_matches(',').to_owned())
        .collect())
}

/// Files below a folder with this ending, without what is built.
fn files(folder: &Path, ending: &str) -> Result<Vec<PathBuf>, String> {
    let mut files = Vec::new();
    let mut folders = vec![folder.to_path_buf()];
    while let Some(next) = folders.pop() {
        let entries = fs::read_dir(&next).map_err(|e| format!("{}: {e}", next.display()))?;
        for path in entries.filter_map(Result::ok).map(|e| e.path()) {
            if path.is_dir() && !path.ends_with("target") {
                folders.push(path);
            } else if path.extension().is_some_and(|e| e == ending) {
                files.push(path);
            }
        }
    }
    files.sort();
    Ok(files)
}

fn read(path: &Path) -> Result<String, String> {
    fs::read_to_string(path).map_err(|e| format!("{}: {e}", path.display()))
}
