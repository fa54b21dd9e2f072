//! The gate.

use std::process::Command;
use std::time::Instant;

use crate::{Outcome, regress, root, stress, tidy};

struct Step {
    name: &'static str,
    arguments: &'static [&'static str],
    environment: &'static [(&'static str, &'static str)],
}

const STEPS: &[Step] = &[
    Step {
        name: "format",
        arguments: &["fmt", "--all", "--check"],
        environment: &[],
    },
    Step {
        name: "lints",
        arguments: &[
            "clippy",
            "--workspace",
            "--all-targets",
            "--",
            "-D",
            "warnings",
        ],
        environment: &[],
    },
    Step {
        name: "the README's test command",
        arguments: &["test", "--workspace"],
        environment: &[],
    },
    Step {
        name: "documentation",
        arguments: &["doc", "--workspace", "--no-deps"],
        environment: &[("RUSTDOCFLAGS", "-D warnings")],
    },
    Step {
        name: "benches compile",
        arguments: &["bench", "--workspace", "--no-run"],
        environment: &[],
    },
    Step {
        name: "the README's main command",
        arguments: &["run", "--release", "--", "run", "impact"],
        environment: &[],
    },
];

/// Runs every step and stops at the first that fails.
pub(crate) fn run() -> Outcome {
    println!("==> tidy");
    tidy::run()?;
    for step in STEPS {
        println!("==> {}: cargo {}", step.name, step.arguments.join(" "));
        let start = Instant::now();
        let status = Command::new(env!("CARGO"))
            .current_dir(root())
            .args(step.arguments)
            .envs(step.environment.iter().copied())
            .status()
            .map_err(|e| format!("{}: cargo did not start: {e}", step.name))?;
        if !status.success() {
            return Err(format!("{} failed", step.name));
        }
        println!("    {:.0} s", start.elapsed().as_secs_f64());
    }
    println!("==> regress");
    regress::run(&[], false)?;
    println!("==> a tenth of the stress runs");
    stress::run(&stress::Options::tenth())
}
