//! From a scene to the files of its results.

use std::path::PathBuf;

use scenarios::output::{Status, Summary};
use scenarios::spec::LoadedScene;

use crate::common::{scene, scene_text};

/// An empty folder that is removed in the end.
struct Folder(PathBuf);

impl Folder {
    fn new(name: &str) -> Self {
        let path = std::env::temp_dir().join(format!("setae-{}-{name}", std::process::id()));
        let _ = std::fs::remove_dir_all(&path);
        std::fs::create_dir_all(&path).unwrap();
        Self(path)
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(&self.0);
    }
}

/// A run into the folder `out` as the program makes it. (The program itself, its messages and exit codes are tested
/// where it is built, in the package `scenarios`.)
fn run_into(loaded: &LoadedScene, folder: &Folder) -> Summary {
    scenarios::run(loaded, &folder.0.join("out"), &mut |_| ()).unwrap()
}

fn summary(folder: &Folder) -> serde_json::Value {
    serde_json::from_str(&std::fs::read_to_string(folder.0.join("out/summary.json")).unwrap())
        .unwrap()
}

#[test]
fn impact_runs_to_its_end_and_writes_what_it_computed() {
    let folder = Folder::new("impact");
    assert_eq!(
        run_into(&scene("impact", &["mu=0.5"]), &folder).status,
        Status::Completed
    );
    let summary = summary(&folder);
    assert_eq!(summary["steps"], 100);
    assert_eq!(summary["rejected_steps"], 0);
    assert!(summary["max_contact_error"].as_f64().unwrap() <= 1e-10);
    // Every row of the history closes the audit by its own columns.
    let history = std::fs::read_to_string(folder.0.join("out/history.csv")).unwrap();
    let mut lines = history.lines();
    let names: Vec<&str> = lines.next().unwrap().split(',').collect();
    let rows: Vec<Vec<f64>> = lines
        .map(|l| l.split(',').map(|x| x.parse().unwrap()).collect())
        .collect();
    assert_eq!(rows.len(), 100);
    let column = |name: &str| {
        names
            .iter()
            .position(|n| *n == name)
            .unwrap_or_else(|| panic!("{name} in {names:?}"))
    };
    let stored = ["energy.kinetic", "energy.strain", "energy.adhesive"].map(column);
    let lost = [
        "dissipation.friction",
        "dissipation.bond",
        "dissipation.damping",
        "dissipation.impact",
        "error.integration",
    ];
    let (lost, work, time) = (lost.map(column), column("work.load"), column("t"));
    for (k, row) in rows.iter().enumerate() {
        assert!((row[time] - 0.01 * (k + 1) as f64).abs() < 1e-9);
        let sum: f64 = stored.iter().chain(&lost).map(|c| row[*c]).sum();
        assert!(
            (sum - row[work] - 162.5).abs() < 1e-8 * 162.5,
            "row {k} leaves {} J",
            sum - row[work] - 162.5
        );
    }
    for axis in ["x", "y", "z"] {
        column(&format!("force.blocks.{axis}"));
        column(&format!("moment.base.{axis}"));
    }
}

#[test]
fn a_run_that_stops_says_why_and_keeps_its_results() {
    let folder = Folder::new("stops");
    let scene = r#"(
    title: "crushed",
    materials: {"m": (law: NeoHookean(E: 100.0, nu: 0.3), density: 1.0)},
    bodies: {"block": (mesh: Box(min: (0.0, 0.0, 0.0), max: (1.0, 1.0, 1.0), cells: (2, 2, 2)), material: "m")},
    motions: {
        "bottom": (nodes: "block.z_min"),
        "top": (nodes: "block.z_max", motion: Move(translation: (0.0, 0.0, [(0.0, 0.0), (1.0, -0.1), (2.0, -1.5)]))),
    },
    time: (end: 2.0, dt: 0.5, inertia: QuasiStatic, min_dt: Some(0.05)),
)"#;
    assert_eq!(
        run_into(&scene_text(scene, &[]), &folder).status,
        Status::Stopped
    );
    let summary = summary(&folder);
    let reason = summary["reason"].as_str().unwrap();
    assert!(
        reason.contains("stopped at t = ")
            && (reason.contains("element") || reason.contains("node")),
        "{reason}"
    );
    let reached = summary["time"].as_f64().unwrap();
    assert!((1.0..2.0).contains(&reached));
    let history = std::fs::read_to_string(folder.0.join("out/history.csv")).unwrap();
    let last: f64 = history
        .lines()
        .last()
        .unwrap()
        .split(',')
        .next()
        .unwrap()
        .parse()
        .unwrap();
    assert_eq!(last, reached);
}
