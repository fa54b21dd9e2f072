//! Runs beside and after each other in one folder, and what a scene says that no run can do.

use std::fs::{self, File};
use std::path::Path;
use std::process::{Command, Output};

use scenarios::output::Folder;
use scenarios::spec::parse;

use crate::fresh_folder;
use crate::scene::SMALL;

fn setae(arguments: &[&str], folder: &Path) -> Output {
    let mut program = Command::new(env!("CARGO_BIN_EXE_setae"));
    program.args(arguments).current_dir(folder);
    program.output().unwrap()
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

const SHORT: [&str; 8] = [
    "run",
    "impact",
    "--set",
    "end=0.02",
    "--set",
    "lower.mesh.cells=(2, 2, 1)",
    "--out",
    "here",
];

#[test]
fn a_second_run_into_a_folder_waits_for_its_turn() {
    let folder = fresh_folder("one-at-a-time");
    let here = folder.join("here");
    let first = Folder::create(&here).unwrap();
    let out = setae(&SHORT, &folder);
    assert_eq!(out.status.code(), Some(2));
    let error = text(&out.stderr);
    assert!(
        error.contains("another run is writing into the output folder here"),
        "{error}"
    );
    drop(first);
    // What a kill leaves behind holds nobody up.
    fs::write(here.join(".setae-lock"), "").unwrap();
    let out = setae(&SHORT, &folder);
    assert_eq!(out.status.code(), Some(0), "{}", text(&out.stderr));
    assert!(!here.join(".setae-lock").exists());
    assert!(!text(&out.stderr).contains("replaces"));
    let again = text(&setae(&SHORT, &folder).stderr);
    assert!(
        again.contains("replaces a run (completed, 2 steps to t = 2e-2 s) in here"),
        "{again}"
    );
}

#[test]
fn a_summary_tells_from_the_start_how_far_a_run_has_come() {
    let folder = fresh_folder("running");
    let scene = parse("small.ron", SMALL, &[]).unwrap();
    let read = || -> serde_json::Value {
        serde_json::from_slice(&fs::read(folder.join("summary.json")).unwrap()).unwrap()
    };
    let mut seen = Vec::new();
    let summary = scenarios::run(&scene, &folder, &mut |_| seen.push(read())).unwrap();
    assert_eq!(seen[0]["status"], "running");
    assert_eq!(
        (&seen[0]["steps"], &seen[0]["dofs"]),
        (&0.into(), &81.into())
    );
    assert_eq!(read()["status"], summary.status.word());
}

#[test]
fn folders_of_an_earlier_sweep_do_not_stay_beside_the_new_ones() {
    let folder = fresh_folder("sweep-again");
    let sweep = |values: &str| {
        let cells = ["--set", "lower.mesh.cells=(2, 2, 1)", "--set", "end=0.01"];
        let all = [
            &["sweep", "impact", "--out", "here", "--vary", values],
            &cells[..],
        ]
        .concat();
        setae(&all, &folder)
    };
    assert_eq!(sweep("mu=0.1,0.2,0.3").status.code(), Some(0));
    let here = folder.join("here");
    fs::write(here.join("2_mu=0.2/notes.txt"), "mine").unwrap();
    fs::create_dir(here.join("9_mine=1")).unwrap();
    let out = sweep("mu=0.5,0.6");
    assert!(text(&out.stderr).contains("replaces a sweep of 3 runs in here"));
    let mut left: Vec<String> = fs::read_dir(&here)
        .unwrap()
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect();
    left.sort();
    assert_eq!(
        left,
        ["1_mu=0.5", "2_mu=0.2", "2_mu=0.6", "9_mine=1", "sweep.csv"]
    );
    let kept: Vec<_> = fs::read_dir(here.join("2_mu=0.2")).unwrap().collect();
    assert_eq!(kept.len(), 1, "only what somebody else wrote");
}

#[cfg(target_os = "linux")]
#[test]
fn what_cannot_be_said_is_no_success_and_no_panic() {
    let folder = fresh_folder("unheard");
    let full = || File::options().write(true).open("/dev/full").unwrap();
    for arguments in [&["list"][..], &["show", "impact"], &["--help"], &SHORT] {
        let mut program = Command::new(env!("CARGO_BIN_EXE_setae"));
        program.args(arguments).current_dir(&folder).stdout(full());
        let out = program.output().unwrap();
        assert_eq!(out.status.code(), Some(2), "{arguments:?}");
        assert!(
            !text(&out.stderr).contains("panicked"),
            "{}",
            text(&out.stderr)
        );
    }
    for arguments in [&["run", "missing.ron"][..], &SHORT] {
        let mut program = Command::new(env!("CARGO_BIN_EXE_setae"));
        program.args(arguments).current_dir(&folder).stderr(full());
        // The second run says that it replaces the first.
        assert_eq!(
            program.output().unwrap().status.code(),
            Some(2),
            "{arguments:?}"
        );
    }
}

#[test]
fn overrides_that_cannot_be_meant_are_refused() {
    let folder = fresh_folder("overrides");
    let cases: &[(&[&str], &str)] = &[
        (&["run", "impact", "--set", "dt=1ms"], "without `ms`"),
        (&["run", "impact", "--set", "dt=1e-3 s"], "without `s`"),
        (&["run", "impact", "--set", "mu=5%"], "without `%`"),
        (
            &["run", "impact", "--set", "mu=1", "--set", "blocks.mu=2"],
            "is undone by --set interfaces.blocks.mu=2",
        ),
        (
            &[
                "check",
                "impact",
                "--set",
                "lower.mesh.cells=(1,1,1)",
                "--set",
                "lower.mesh.cells=(2,2,2)",
            ],
            "is undone by",
        ),
        (
            &["sweep", "impact", "--set", "mu=1", "--vary", "blocks.mu=2"],
            "--vary interfaces.blocks.mu undoes --set interfaces.blocks.mu=1",
        ),
    ];
    for (arguments, words) in cases {
        let out = setae(arguments, &folder);
        assert_eq!(out.status.code(), Some(2), "{arguments:?}");
        let error = text(&out.stderr);
        assert!(error.contains(words), "{arguments:?}: {error}");
    }
}

#[test]
fn a_contact_problem_of_a_step_that_is_not_there_is_an_error() {
    let folder = fresh_folder("dump-beyond");
    let out = setae(&[&SHORT[..], &["--dump-contact", "99"]].concat(), &folder);
    assert_eq!(out.status.code(), Some(1));
    let error = text(&out.stderr);
    assert!(
        error.contains("--dump-contact 99") && error.contains("2 steps"),
        "{error}"
    );
}

#[test]
fn a_check_refuses_what_a_run_refuses() {
    let folder = fresh_folder("check-refuses");
    fs::write(folder.join("small.ron"), SMALL).unwrap();
    let inside = "upper.mesh.min=(0.2, 0.2, 0.1)";
    let huge = "lower.mesh.cells=(220, 220, 220)";
    for arguments in [["impact", "--set", inside], ["impact", "--set", huge]] {
        let checked = setae(&[&["check"], &arguments[..]].concat(), &folder);
        let run = setae(&[&["run"], &arguments[..]].concat(), &folder);
        assert_eq!(
            (checked.status.code(), run.status.code()),
            (Some(2), Some(2))
        );
        assert_eq!(text(&checked.stderr), text(&run.stderr));
    }
    let error = text(&setae(&["check", "impact", "--set", huge], &folder).stderr);
    assert!(
        error.contains("of memory") && error.contains("take fewer cells"),
        "{error}"
    );
    let error = text(&setae(&["check", "impact", "--set", inside], &folder).stderr);
    assert!(error.contains("is of body `upper`"), "{error}");
    let described = text(&setae(&["check", "small.ron"], &folder).stdout);
    assert!(
        described.contains("memory") && described.contains("of CPU"),
        "{described}"
    );
}

#[test]
fn a_mark_of_utf8_is_no_part_of_a_scene() {
    let scene = parse("marked.ron", &format!("\u{feff}{SMALL}"), &[]).unwrap();
    assert_eq!(scene.source.text, SMALL);
}

#[test]
fn names_that_no_file_can_have_are_refused() {
    let name = "g".repeat(250);
    let error = parse(
        "long.ron",
        &SMALL.replace("\"ground\"", &format!("{name:?}")),
        &[],
    );
    let error = error.unwrap_err().to_string();
    assert!(error.contains("250 letters, at most 100"), "{error}");
}

#[test]
fn a_probe_far_from_its_body_is_refused() {
    let probe = |node: &str| {
        let output = format!(
            "output: (probes: {{\"p\": (body: \"block\", node: {node}, quantities: [gap])}}),\n    time:"
        );
        let scene = parse("probe.ron", &SMALL.replace("time:", &output), &[]).unwrap();
        scenarios::build(&scene).map(|built| built.probes)
    };
    assert!(probe("(0.5, 0.3, 0.2)").is_ok() && probe("(1.2, 1.0, 1.0)").is_ok());
    let error = probe("(9, 1, 1)").unwrap_err().to_string();
    assert!(
        error.contains("output.probes.p.node")
            && error.contains("lies 8e0 m")
            && error.contains("(1, 1, 1)"),
        "{error}"
    );
}
