//! The program from outside: what it prints and its exit codes.

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

#[test]
fn list_names_every_scene_on_a_line() {
    let out = setae(&["list"], &fresh_folder("list"));
    assert_eq!(out.status.code(), Some(0));
    let listed = text(&out.stdout);
    let names: Vec<&str> = listed
        .lines()
        .filter_map(|line| line.split_whitespace().next())
        .collect();
    assert_eq!(
        names,
        scenarios::catalog::SCENES
            .iter()
            .map(|entry| entry.name)
            .collect::<Vec<_>>()
    );
}

#[test]
fn a_shown_scene_is_a_scene_with_its_comments() {
    let folder = fresh_folder("show");
    let shown = setae(&["show", "impact"], &folder).stdout;
    assert!(text(&shown).contains("// [kg/m^3]"));
    std::fs::write(folder.join("mine.ron"), shown).unwrap();
    let out = setae(&["check", "mine.ron"], &folder);
    assert_eq!(out.status.code(), Some(0));
    let described = text(&out.stdout);
    for word in [
        "body lower",
        "256 elements",
        "interface blocks",
        "mu = 0.2",
        "dofs",
        "1590",
        "100 of 0.01 s to 1 s",
    ] {
        assert!(described.contains(word), "{word} in\n{described}");
    }
}

#[test]
fn bad_input_ends_with_2_and_leaves_nothing() {
    let folder = fresh_folder("bad");
    std::fs::write(folder.join("broken.ron"), "(title: \"x\",\n  oops: 1)").unwrap();
    let cases: &[(&[&str], &str)] = &[
        (&["run", "missing.ron"], "cannot read the scene missing.ron"),
        (&["run", "impct"], "did you mean `impact`?"),
        (&["run", "broken.ron"], "broken.ron:2:3"),
        (&["check", "broken.ron"], "broken.ron:2:3"),
        (&["run", "impact", "--set", "dt=0"], "time.dt = 0"),
        (
            &["run", "impact", "--set", "mu=-1"],
            "interfaces.blocks.mu = -1",
        ),
        (
            &["run", "impact", "--set", "density=-1"],
            "materials.soft.density = -1",
        ),
        (
            &["run", "impact", "--set", "nothing=1"],
            "no field of this scene",
        ),
        (&["run", "impact", "--set", "mu"], "expected path=value"),
        (&["run", "impact", "--threads", "0"], "--threads"),
        (
            &["run", "impact", "--out", "broken.ron"],
            "cannot write into the output folder",
        ),
        (&["run"], "Usage"),
    ];
    for (arguments, words) in cases {
        let out = setae(arguments, &folder);
        assert_eq!(out.status.code(), Some(2), "{arguments:?}");
        let error = text(&out.stderr);
        assert!(error.contains(words), "{arguments:?}: {error}");
        assert!(out.stdout.is_empty(), "{arguments:?}");
    }
    let left: Vec<_> = std::fs::read_dir(&folder)
        .unwrap()
        .map(|entry| entry.unwrap().file_name())
        .collect();
    assert_eq!(left, ["broken.ron"]);
}
