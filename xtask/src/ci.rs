//! The gate.

use std::fs;
use std::io::{BufRead as _, BufReader};
use std::path::PathBuf;
use std::process::{Command, Stdio};
use std::time::Instant;

use crate::{Outcome, regress, root, stress, tidy};

/// One cargo command of the gate.
struct Step {
    name: &'static str,
    /// Arguments of cargo, between spaces.
    arguments: &'static str,
    /// Variable of the environment.
    environment: Option<(&'static str, &'static str)>,
    /// Tests that have to pass at least; 0 for what runs no tests.
    tests: usize,
}

const fn step(name: &'static str, arguments: &'static str) -> Step {
    Step {
        name,
        arguments,
        environment: None,
        tests: 0,
    }
}

const fn tests(name: &'static str, arguments: &'static str, tests: usize) -> Step {
    Step {
        tests,
        ..step(name, arguments)
    }
}

/// The numbers of tests are those that the batteries had when they became features: a feature that silently leaves
/// tests out fails here.
const STEPS: &[Step] = &[
    step("format", "fmt --all --check"),
    step(
        "lints",
        "clippy --workspace --all-targets --all-features -- -D warnings",
    ),
    tests("the README's test command", "test --workspace", 540),
    tests(
        "laws alone, with their battery",
        "test -p hyperelastic --features conformance",
        52,
    ),
    tests(
        "contact solvers without a mesh, with their batteries",
        "test -p contact-bipotential --no-default-features --features conformance",
        58,
    ),
    tests(
        "elements, with their batteries",
        "test -p fe-core --features conformance",
        100,
    ),
    Step {
        environment: Some(("RUSTDOCFLAGS", "-D warnings")),
        ..step("documentation", "doc --workspace --no-deps --all-features")
    },
    step("benches compile", "bench --workspace --no-run"),
    step(
        "packages",
        "package -p hyperelastic -p fe-core -p contact-bipotential -p nscd -p scenarios --no-verify --offline --allow-dirty",
    ),
    step(
        "examples compile",
        "build --workspace --examples --all-features",
    ),
    step("the README's main command", "run --release -- run impact"),
];

/// What a build may not depend on: arguments of `cargo tree`, names of packages.
const WITHOUT: &[(&str, &[&str])] = &[
    (
        "tree -p contact-bipotential --no-default-features -e normal --prefix none",
        &["fe-core", "parry3d-f64", "hyperelastic"],
    ),
    (
        "tree -p scenarios -e normal --prefix none",
        &["num-dual", "proptest", "criterion"],
    ),
    (
        "tree -p hyperelastic -e normal --prefix none",
        &["num-dual", "faer"],
    ),
];

/// Runs every step and stops at the first that fails.
pub(crate) fn run() -> Outcome {
    println!("==> tidy");
    tidy::run()?;
    println!("==> dependencies");
    WITHOUT
        .iter()
        .try_for_each(|(tree, names)| lacks(tree, names))?;
    STEPS.iter().try_for_each(run_step)?;
    println!("==> examples");
    run_examples()?;
    println!("==> regress");
    regress::run(&[], false)?;
    println!("==> a tenth of the stress runs");
    stress::run(&stress::Options::tenth())
}

fn cargo(arguments: &str) -> Command {
    let mut command = Command::new(env!("CARGO"));
    command
        .current_dir(root())
        .args(arguments.split_whitespace());
    command
}

fn run_step(step: &Step) -> Outcome {
    println!("==> {}: cargo {}", step.name, step.arguments);
    let start = Instant::now();
    let failed = |why: String| format!("{}: {why}", step.name);
    let mut child = cargo(step.arguments)
        .envs(step.environment)
        .stdout(Stdio::piped())
        .spawn()
        .map_err(|e| failed(format!("cargo did not start: {e}")))?;
    let output = child
        .stdout
        .take()
        .ok_or_else(|| failed("no output".to_owned()))?;
    let mut passed = 0;
    for line in BufReader::new(output).lines() {
        let line = line.map_err(|e| failed(e.to_string()))?;
        passed += passed_in(&line);
        println!("{line}");
    }
    let status = child.wait().map_err(|e| failed(e.to_string()))?;
    if !status.success() {
        return Err(failed("failed".to_owned()));
    }
    if passed < step.tests {
        let least = step.tests;
        return Err(failed(format!(
            "{passed} tests passed, at least {least} have to run"
        )));
    }
    println!("    {:.0} s", start.elapsed().as_secs_f64());
    Ok(())
}

/// Tests that a line of `cargo test` reports as passed.
fn passed_in(line: &str) -> usize {
    let counts = line.strip_prefix("test result: ok. ");
    let passed = counts.and_then(|rest| rest.split_once(" passed"));
    passed.and_then(|(n, _)| n.parse().ok()).unwrap_or(0)
}

fn lacks(tree: &str, names: &[&str]) -> Outcome {
    let output = cargo(tree)
        .output()
        .map_err(|e| format!("cargo {tree}: {e}"))?;
    if !output.status.success() {
        return Err(format!("cargo {tree} failed"));
    }
    let text = String::from_utf8_lossy(&output.stdout);
    let found = text.lines().filter_map(|l| l.split_whitespace().next());
    match found.into_iter().find(|package| names.contains(package)) {
        Some(package) => Err(format!("cargo {tree}: {package} must not be there")),
        None => Ok(()),
    }
}

/// Runs all examples of the crates; each ends by itself and writes no file outside the temporary folder.
fn run_examples() -> Outcome {
    let target = std::env::var_os("CARGO_TARGET_DIR").map_or(root().join("target"), PathBuf::from);
    let built = target.join("debug").join("examples");
    for example in examples()? {
        let name = example.file_stem().unwrap_or_default();
        println!(
            "    {}",
            example.strip_prefix(root()).unwrap_or(&example).display()
        );
        let output = Command::new(built.join(name))
            .current_dir(root())
            .output()
            .map_err(|e| format!("{}: {e}", example.display()))?;
        if !output.status.success() || output.stdout.is_empty() {
            let text = String::from_utf8_lossy(&output.stderr).into_owned();
            return Err(format!("{} failed: {text}", example.display()));
        }
    }
    Ok(())
}

fn examples() -> Result<Vec<PathBuf>, String> {
    let mut found = Vec::new();
    let crates = fs::read_dir(root().join("crates")).map_err(|e| format!("crates: {e}"))?;
    for folder in crates
        .filter_map(Result::ok)
        .map(|e| e.path().join("examples"))
    {
        // A crate without examples fails, as one that lost them would.
        let files = fs::read_dir(&folder).map_err(|e| format!("{}: {e}", folder.display()))?;
        let files = files.filter_map(Result::ok).map(|e| e.path());
        found.extend(files.filter(|f| f.extension().is_some_and(|e| e == "rs")));
    }
    found.sort();
    Ok(found)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn passed_tests_are_counted() {
        let line = "test result: ok. 49 passed; 0 failed; 1 ignored; 0 measured; 0 filtered out";
        assert_eq!(passed_in(line), 49);
        assert_eq!(passed_in("test a ... ok"), 0);
    }
}
