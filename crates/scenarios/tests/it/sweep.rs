//! `setae sweep`: folders, table, what is refused, and that runs side by side are the runs alone.

use std::fs;
use std::path::Path;
use std::process::{Command, Output};

use crate::fresh_folder;

fn setae(arguments: &[&str], folder: &Path) -> Output {
    Command::new(env!("CARGO_BIN_EXE_setae"))
        .args(arguments)
        .current_dir(folder)
        .output()
        .unwrap()
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

/// Rows of a table by the names of the columns.
fn table(path: &Path) -> Vec<std::collections::BTreeMap<String, String>> {
    let mut reader = csv::Reader::from_path(path).unwrap();
    reader.deserialize().map(|row| row.unwrap()).collect()
}

const SMALL: [&str; 6] = [
    "--set",
    "lower.mesh.cells=(2, 2, 1)",
    "--set",
    "end=0.4",
    "--set",
    "fields_every=Steps(20)",
];

#[test]
fn all_combinations_run_as_they_run_alone() {
    let folder = fresh_folder("sweep");
    let vary = [
        "--vary",
        "mu=0.1,0.5",
        "--vary",
        "upper.mesh.cells=(1, 1, 1),(2, 2, 2)",
    ];
    let all = [
        &["sweep", "impact", "--threads", "3"],
        &vary[..],
        &SMALL[..],
    ]
    .concat();
    let out = setae(&all, &folder);
    assert_eq!(out.status.code(), Some(0), "{}", text(&out.stderr));
    let progress = text(&out.stderr);
    assert_eq!(progress.lines().count(), 4, "a line a run: {progress}");
    assert!(
        progress.contains("[4/4]")
            && progress.contains("mu=0.5, upper.mesh.cells=(1, 1, 1): completed")
    );
    let printed = text(&out.stdout);
    assert!(printed.contains("4 of 4 runs completed"), "{printed}");

    let folders = [
        "1_mu=0.1_upper.mesh.cells=1-1-1",
        "2_mu=0.1_upper.mesh.cells=2-2-2",
        "3_mu=0.5_upper.mesh.cells=1-1-1",
        "4_mu=0.5_upper.mesh.cells=2-2-2",
    ];
    let rows = table(&folder.join("out/impact-sweep/sweep.csv"));
    assert_eq!(
        rows.iter()
            .map(|r| r["folder"].as_str())
            .collect::<Vec<_>>(),
        folders
    );
    assert_eq!(rows[2]["interfaces.blocks.mu"], "0.5");
    assert_eq!(rows[2]["bodies.upper.mesh.cells"], "(1, 1, 1)");

    for (row, (mu, cells)) in rows.iter().zip([
        ("0.1", "(1,1,1)"),
        ("0.1", "(2,2,2)"),
        ("0.5", "(1,1,1)"),
        ("0.5", "(2,2,2)"),
    ]) {
        let (mu, cells) = (format!("mu={mu}"), format!("upper.mesh.cells={cells}"));
        let sets = ["--set", &mu, "--set", &cells, "--out", "alone", "--quiet"];
        let one = [&["run", "impact"], &SMALL[..], &sets[..]].concat();
        assert_eq!(setae(&one, &folder).status.code(), Some(0));
        let swept = folder.join("out/impact-sweep").join(&row["folder"]);
        for file in [
            "history.csv",
            "fields/step_000040.vtu",
            "energy.svg",
            "fields.pvd",
        ] {
            let (a, b) = (
                fs::read(swept.join(file)),
                fs::read(folder.join("alone").join(file)),
            );
            assert!(a.unwrap() == b.unwrap(), "{file} of {}", row["folder"]);
        }
        same_as_the_files(row, &swept);
    }
}

/// The table against `summary.json` and `history.csv`.
fn same_as_the_files(row: &std::collections::BTreeMap<String, String>, run: &Path) {
    let summary: serde_json::Value =
        serde_json::from_slice(&fs::read(run.join("summary.json")).unwrap()).unwrap();
    assert_eq!(summary["status"], row["status"].as_str());
    for count in [
        "steps",
        "rejected_steps",
        "newton_iterations",
        "factorizations",
        "contacts_max",
    ] {
        assert_eq!(summary[count].to_string(), row[count], "{count}");
    }
    for (key, column) in [
        ("final", "energy.final"),
        ("friction_dissipation", "dissipation.friction"),
    ] {
        let value: f64 = row[column].parse().unwrap();
        let written = summary["energy"][key].as_f64().unwrap();
        assert!((written - value).abs() <= 1e-15 * value.abs());
    }
    let cpu: f64 = row["cpu_s"].parse().unwrap();
    let written = summary["cpu_s"].as_f64().unwrap();
    assert!(cpu > 0.0 && (written - cpu).abs() <= 1e-15 * cpu);
    let history: Vec<std::collections::BTreeMap<String, String>> = table(&run.join("history.csv"));
    let number = |line: &std::collections::BTreeMap<String, String>, name: &str| {
        line[name].parse::<f64>().unwrap()
    };
    let norm = |line| {
        let squares =
            ["x", "y", "z"].map(|axis| number(line, &format!("force.blocks.{axis}")).powi(2));
        squares.iter().sum::<f64>().sqrt()
    };
    let peak = history.iter().map(norm).fold(0.0, f64::max);
    assert!(peak > 0.0 && number(row, "peak.force.blocks") == peak);
    let first = history.iter().find(|line| norm(line) == peak).unwrap();
    assert_eq!(number(row, "peak.force.blocks.t"), number(first, "t"));
    let z = || history.iter().map(|line| number(line, "force.blocks.z"));
    assert_eq!(
        number(row, "peak.force.blocks.z.max"),
        z().fold(f64::MIN, f64::max)
    );
    assert_eq!(
        number(row, "peak.force.blocks.z.min"),
        z().fold(f64::MAX, f64::min)
    );
    let last = history.last().unwrap();
    assert_eq!(
        row["probe.corner.velocity.z"],
        last["probe.corner.velocity.z"]
    );
}

#[test]
fn bad_combinations_are_told_before_anything_runs() {
    let folder = fresh_folder("sweep-bad");
    let cases: &[(&[&str], &str)] = &[
        (&["--vary", "mu=0.2,-1"], "run 2 of 2 (mu=-1): impact.ron:"),
        (&["--vary", "dt=0.1,2"], "time.dt = 2: must not exceed"),
        (
            &["--vary", "end=1,0.05", "--vary", "dt=0.01,0.1"],
            "run 4 of 4 (end=0.05, dt=0.1)",
        ),
        (&["--vary", "nothing=1"], "no field of this scene"),
        (&["--vary", "cells=(1,1,1)"], "several fields end so"),
        (&["--vary", "mu=soon"], "does not fit interfaces.blocks.mu"),
        (&["--vary", "mu=1", "--vary", "blocks.mu=2"], "varied twice"),
        (&["--vary", "mu=1,"], "expected path=value"),
        (&["--set", "mu=1"], "--vary"),
    ];
    for (arguments, words) in cases {
        let out = setae(&[&["sweep", "impact"], *arguments].concat(), &folder);
        assert_eq!(out.status.code(), Some(2), "{arguments:?}");
        let error = text(&out.stderr);
        assert!(error.contains(words), "{arguments:?}: {error}");
        assert!(out.stdout.is_empty());
    }
    assert_eq!(fs::read_dir(&folder).unwrap().count(), 0);
}

#[test]
fn a_run_that_stops_does_not_stop_the_others() {
    let folder = fresh_folder("sweep-stops");
    let vary = ["--vary", "max_newton=40,1", "--out", "here"];
    let all = [&["sweep", "impact"], &SMALL[..], &vary[..]].concat();
    let out = setae(&all, &folder);
    assert_eq!(out.status.code(), Some(1), "{}", text(&out.stderr));
    assert!(
        text(&out.stderr).contains("error: ["),
        "{}",
        text(&out.stderr)
    );
    assert!(text(&out.stdout).contains("1 of 2 runs completed"));
    let rows = table(&folder.join("here/sweep.csv"));
    assert_eq!(
        (rows[0]["status"].as_str(), rows[0]["reason"].as_str()),
        ("completed", "")
    );
    assert_eq!(rows[1]["status"], "stopped");
    assert!(
        rows[1]["reason"].contains("equilibrium not reached"),
        "{}",
        rows[1]["reason"]
    );
    assert!(!rows[1]["steps"].is_empty());
}

/// The first interrupt ends a run with all its results, and says so once.
#[cfg(unix)]
#[test]
fn an_interrupted_run_keeps_its_results() {
    let folder = fresh_folder("interrupted");
    let child = Command::new(env!("CARGO_BIN_EXE_setae"))
        .args(["run", "impact", "--set", "dt=1e-5", "--out", "here"])
        .current_dir(&folder)
        .stdout(std::process::Stdio::piped())
        .stderr(std::process::Stdio::piped())
        .spawn()
        .unwrap();
    let history = folder.join("here/history.csv");
    let rows = || fs::read_to_string(&history).map_or(0, |text| text.lines().count());
    for _ in 0..600 {
        if rows() > 2 {
            break;
        }
        std::thread::sleep(std::time::Duration::from_millis(50));
    }
    let signal = Command::new("kill")
        .args(["-INT", &child.id().to_string()])
        .status();
    assert!(signal.unwrap().success());
    let out = child.wait_with_output().unwrap();
    assert_eq!(out.status.code(), Some(1));
    let error = text(&out.stderr);
    assert_eq!(error.matches("interrupted at t = ").count(), 1, "{error}");
    assert!(!text(&out.stdout).contains("interrupted"), "told once");
    let summary: serde_json::Value =
        serde_json::from_slice(&fs::read(folder.join("here/summary.json")).unwrap()).unwrap();
    assert_eq!(summary["status"], "stopped");
    assert!(
        summary["reason"]
            .as_str()
            .unwrap()
            .starts_with("interrupted at t = ")
    );
    assert_eq!(summary["steps"], rows() - 1);
    assert!(folder.join("here/energy.svg").is_file());
}
