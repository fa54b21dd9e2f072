//! CPU time of two programs on the same scenes, run in turn: old, new, old again.
//!
//! Old against old again is the noise of the machine; what differs by less is not told apart.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use serde_json::Value;

use crate::{Outcome, root};

/// Scenes of the table in `docs/verification/speed.md`.
const SCENES: [&str; 5] = ["impact", "impact:refine=2", "press-twist", "twist", "wheel"];

/// What is compared.
#[derive(clap::Args)]
pub(crate) struct Options {
    /// The program to compare with, a `setae` of an older commit
    #[arg(long)]
    old: PathBuf,
    /// The program that is judged; target/release/setae without it
    #[arg(long)]
    new: Option<PathBuf>,
    /// Rounds of old, new, old again
    #[arg(long, default_value_t = 5)]
    rounds: usize,
    /// Scenes or files, with changed values after colons: impact:refine=2
    scenes: Vec<String>,
}

pub(crate) fn run(options: &Options) -> Outcome {
    let built = root().join("target/release/setae");
    let new = options.new.as_deref().unwrap_or(&built);
    let given: Vec<&str> = options.scenes.iter().map(String::as_str).collect();
    let scenes = if given.is_empty() {
        &SCENES
    } else {
        &given[..]
    };
    println!("| scene | old s | new s | old again s | new / old | old again / old |");
    println!("|---|---|---|---|---|---|");
    for scene in scenes {
        let mut seconds = [const { Vec::new() }; 3];
        for _ in 0..options.rounds.max(1) {
            for (program, all) in [&options.old, new, &options.old].iter().zip(&mut seconds) {
                all.push(cpu_seconds(program, scene)?);
            }
        }
        let [old, new, again] = seconds.map(median);
        println!(
            "| {} | {old:.3} | {new:.3} | {again:.3} | {:.3} | {:.3} |",
            scene.replace(':', " "),
            2.0 * new / (old + again),
            again / old
        );
    }
    Ok(())
}

/// CPU seconds that the program tells of a run on one thread.
fn cpu_seconds(program: &Path, scene: &str) -> Result<f64, String> {
    let folder = root().join("target/speed");
    let mut words = scene.split(':');
    let mut command = Command::new(program);
    command.arg("run").args(words.next());
    for value in words {
        command.args(["--set", value]);
    }
    command.args(["--threads", "1", "--quiet", "--out"]);
    let run = command.arg(&folder).stdout(Stdio::null()).output();
    let run = run.map_err(|e| format!("{}: {e}", program.display()))?;
    if !run.status.success() {
        let reason = String::from_utf8_lossy(&run.stderr).into_owned();
        return Err(format!("{}, {scene}: {reason}", program.display()));
    }
    let file = folder.join("summary.json");
    let text = fs::read_to_string(&file).map_err(|e| format!("{}: {e}", file.display()))?;
    let summary: Value = serde_json::from_str(&text).map_err(|e| e.to_string())?;
    let found = summary.get("cpu_s").and_then(Value::as_f64);
    found.ok_or_else(|| format!("{}: no cpu_s", file.display()))
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    let middle = values.len() / 2;
    if values.len() % 2 == 1 {
        values[middle]
    } else {
        0.5 * (values[middle - 1] + values[middle])
    }
}
