//! `setae contact` and `--dump-contact`: problem files good and bad, exit codes, and what is dumped is what was solved.

use std::path::Path;
use std::process::{Command, Output};

use contact_bipotential::{Cone, SolveSettings, solve};
use serde_json::Value;

use crate::fresh_folder;

/// One contact that slides, and one that opens.
const SLIDING: &str = "3 1 0 3 3\n3 3\n2 0 0\n0 1 0\n0 0 1\n-1 2 3\n0.1\n";
const OPEN: &str = "2 1 0 2 2\n2 2\n1 0 0 1\n1 0\n0.5\n";

fn setae(arguments: &[&str], folder: &Path) -> Output {
    Command::new(env!("CARGO_BIN_EXE_setae"))
        .args(arguments)
        .current_dir(folder)
        .output()
        .unwrap()
}

fn rows(output: &Output) -> Vec<Value> {
    serde_json::from_slice(&output.stdout).unwrap()
}

#[test]
fn a_folder_of_problems_is_solved_and_tabulated() {
    let folder = fresh_folder("contact_good");
    std::fs::write(folder.join("b.dat"), SLIDING).unwrap();
    std::fs::write(folder.join("a.dat"), OPEN).unwrap();
    std::fs::write(folder.join("notes.txt"), "no problem").unwrap();
    let out = setae(&["contact", "."], &folder);
    let text = String::from_utf8(out.stdout).unwrap();
    assert_eq!(out.status.code(), Some(0), "{text}");
    let lines: Vec<&str> = text.lines().collect();
    assert!(lines[0].starts_with("file") && lines[0].ends_with("norm_u"));
    assert!(lines[1].starts_with("a.dat") && lines[2].starts_with("b.dat"));
    assert!(lines[3].starts_with("2 of 2 solved"), "{text}");

    let out = setae(
        &["contact", "a.dat", "b.dat", "--json", "--tol", "1e-12"],
        &folder,
    );
    let rows = rows(&out);
    let expected = [
        "complementarity",
        "cone_slack",
        "contacts",
        "cpu_s",
        "error",
        "error_scale_free",
        "file",
        "iterations",
        "method",
        "norm_u",
        "penetration",
        "slip_misalignment",
        "status",
    ];
    let mut keys: Vec<&String> = rows[0].as_object().unwrap().keys().collect();
    keys.sort();
    assert_eq!(keys, expected);
    assert_eq!(rows[1]["file"], "b.dat");
    assert_eq!(rows[1]["status"], "converged");
    assert!(rows[1]["error"].as_f64().unwrap() <= 1e-12);
    assert!(rows[1]["cpu_s"].as_f64().unwrap() > 0.0);
    // The open contact keeps its free velocity.
    assert_eq!(rows[0]["norm_u"], 1.0);
    // r_n = 1/2 holds the normal; friction of 1/20 takes that much off a tangential speed of sqrt(13).
    let expected = 13.0_f64.sqrt() - 0.05;
    assert!((rows[1]["norm_u"].as_f64().unwrap() - expected).abs() < 1e-12);
}

#[test]
fn a_global_problem_is_solved_as_one() {
    let folder = fresh_folder("contact_global");
    // M = diag(1, 2, 2), H = I, q = (-1, 1, 0), b = 0, normal first: it slides with u = (0, .35, 0).
    let matrices = "0 3 3 3 3\n1 0 0 0 2 0 0 0 2\n0 3 3 3 3\n1 0 0 0 1 0 0 0 1\n";
    let text = format!("3 1\n{matrices}-1 1 0\n0 0 0\n.3\n");
    std::fs::write(folder.join("global.dat"), &text).unwrap();
    std::fs::write(folder.join("more.dat"), text + "7\n").unwrap();
    let out = setae(&["contact", "global.dat", "more.dat", "--json"], &folder);
    assert_eq!(out.status.code(), Some(2));
    let rows = rows(&out);
    assert_eq!(rows[0]["status"], "converged");
    assert!((rows[0]["norm_u"].as_f64().unwrap() - 0.35).abs() < 1e-12);
    let reason = rows[1]["reason"].as_str().unwrap();
    assert!(reason.contains("more.dat, line 9: '7'"), "{reason}");
}

#[test]
fn what_is_not_solved_is_said() {
    let folder = fresh_folder("contact_unsolved");
    // Nothing can push this contact out: no reaction moves it.
    let stuck = "3 1 0 3 3\n3 3\n0 0 0\n0 0 0\n0 0 0\n-1 0 0\n0.1\n";
    std::fs::write(folder.join("stuck.dat"), stuck).unwrap();
    let out = setae(&["contact", "stuck.dat", "--json"], &folder);
    assert_eq!(out.status.code(), Some(1));
    let rows = rows(&out);
    assert_eq!(rows[0]["status"], "not converged");
    assert!(
        rows[0]["reason"].as_str().unwrap().contains("contact 0"),
        "{}",
        rows[0]
    );
}

#[test]
fn friction_without_bound_holds_what_is_pressed() {
    let folder = fresh_folder("contact_friction");
    for mu in ["1e9", "1e30", "1e300"] {
        let text = format!("3 1 0 3 3\n3 3\n1 0 0\n0 1 0\n0 0 1\n-1 0.5 0\n{mu}\n");
        std::fs::write(folder.join("held.dat"), text).unwrap();
        let out = setae(&["contact", "held.dat", "--json"], &folder);
        assert_eq!(out.status.code(), Some(0));
        // r = (1, -.5, 0) leaves nothing of u = q.
        assert_eq!(rows(&out)[0]["norm_u"], 0.0, "{mu}");
    }
    let none = [
        "contact",
        "held.dat",
        "--method",
        "uzawa",
        "--max-iterations",
        "1",
    ];
    let out = setae(&none, &folder);
    assert_eq!(out.status.code(), Some(1));
    assert!(String::from_utf8_lossy(&out.stdout).contains("; penetration "));
}

#[test]
fn friction_without_bound_keeps_bodies_apart() {
    for mu in ["1e14", "1e30"] {
        let folder = fresh_folder(&format!("contact_sticks_{mu}"));
        let mu = format!("mu={mu}");
        let run = ["run", "impact", "--out", "out", "--quiet"];
        let out = setae(
            &[&run[..], &["--set", &mu, "--set", "end=0.7"]].concat(),
            &folder,
        );
        assert_eq!(out.status.code(), Some(0), "{mu}");
        let text = std::fs::read_to_string(folder.join("out/summary.json")).unwrap();
        let summary: Value = serde_json::from_str(&text).unwrap();
        // They once were .35 m inside of each other.
        let depth = summary["max_penetration"].as_f64().unwrap();
        assert!(depth < 1e-9, "{mu} {depth:e}");
        assert!(!text.contains("\"contacts_max\": 0"), "{mu}");
    }
}

#[test]
fn every_method_has_its_name() {
    let folder = fresh_folder("contact_methods");
    std::fs::write(folder.join("a.dat"), SLIDING).unwrap();
    for method in contact_bipotential::Method::ALL {
        let out = setae(&["contact", "a.dat", "--method", method.name()], &folder);
        assert_eq!(out.status.code(), Some(0), "{}", method.name());
    }
    for wrong in [
        ["--method", "magic"],
        ["--tol", "0"],
        ["--tol", "nan"],
        ["--max-iterations", "0"],
    ] {
        let out = setae(&["contact", "a.dat", wrong[0], wrong[1]], &folder);
        assert_eq!(out.status.code(), Some(2), "{wrong:?}");
        assert!(String::from_utf8_lossy(&out.stderr).contains(wrong[0]));
    }
}

#[test]
fn bad_files_name_the_place_and_do_not_hide_good_ones() {
    let folder = fresh_folder("contact_bad");
    let problem = scenarios::fclib::dat::parse(Path::new("s"), SLIDING.as_bytes()).unwrap();
    let good = scenarios::fclib::write::local(Path::new("s"), &problem).unwrap();
    let nan = {
        // The first 64-bit 3.0 is an entry of q.
        let three = 3.0_f64.to_le_bytes();
        let at = good.windows(8).position(|w| w == three).unwrap();
        let mut bytes = good.clone();
        bytes[at..at + 8].copy_from_slice(&f64::NAN.to_le_bytes());
        bytes
    };
    let cases: [(&str, Vec<u8>, &str); 9] = [
        (
            "cut.dat",
            SLIDING.as_bytes()[..30].to_vec(),
            "cut.dat, line 5: the file ends where W should stand",
        ),
        (
            "nan.dat",
            SLIDING.replace("-1", "nan").into_bytes(),
            "nan.dat, line 6: q holds NaN",
        ),
        (
            "binary.dat",
            vec![0x33, 0x0a, 0xff, 0x00, 0xfe],
            "binary.dat, line 2: not text",
        ),
        (
            "huge.dat",
            b"3 5000000 0 15000000 15000000 15000000 15000000 1".to_vec(),
            "huge.dat, line 1: W needs",
        ),
        ("empty.dat", Vec::new(), "empty.dat, line 1: the file ends"),
        ("cut.hdf5", good[..good.len() / 2].to_vec(), "cut.hdf5"),
        ("nan.hdf5", nan, "/fclib_local/vectors/q: entry"),
        (
            "binary.hdf5",
            (0..=255).cycle().take(4000).collect(),
            "binary.hdf5: ",
        ),
        ("empty.hdf5", Vec::new(), "empty.hdf5: "),
    ];
    for (name, bytes, _) in &cases {
        std::fs::write(folder.join(name), bytes).unwrap();
    }
    std::fs::write(folder.join("zz.hdf5"), &good).unwrap();
    let out = setae(&["contact", ".", "nowhere.dat", "--json"], &folder);
    assert_eq!(out.status.code(), Some(2));
    let rows = rows(&out);
    assert_eq!(rows.len(), cases.len() + 2);
    let row = |name: &str| {
        let mut found = rows.iter();
        found
            .find(|r| r["file"].as_str().unwrap().ends_with(name))
            .unwrap()
    };
    for (name, _, place) in &cases {
        assert_eq!(row(name)["status"], "unreadable", "{name}");
        let reason = row(name)["reason"].as_str().unwrap();
        assert!(reason.contains(place), "{name}: {reason}");
    }
    assert_eq!(row("nowhere.dat")["status"], "unreadable");
    assert_eq!(row("zz.hdf5")["status"], "converged");
    let empty = fresh_folder("contact_none");
    let out = setae(&["contact", "."], &empty);
    assert_eq!(out.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&out.stdout).contains("a folder without"));
}

/// Size of the force in `history.csv` after a step.
fn force(folder: &Path, interface: &str, step: usize) -> f64 {
    let mut reader = csv::Reader::from_path(folder.join("history.csv")).unwrap();
    let heads = reader.headers().unwrap().clone();
    let record = reader.records().nth(step - 1).unwrap().unwrap();
    let names = ["x", "y", "z"].map(|axis| format!("force.{interface}.{axis}"));
    let squares = names.iter().map(|name| {
        let k = heads.iter().position(|h| h == name).unwrap();
        record[k].parse::<f64>().unwrap().powi(2)
    });
    squares.sum::<f64>().sqrt()
}

fn dumped(scene: &str, interface: &str, step: usize, expected: Cone, tolerance: f64) {
    let folder = fresh_folder(&format!("dump_{scene}"));
    let number = step.to_string();
    let arguments = [
        "run",
        scene,
        "--out",
        "out",
        "--quiet",
        "--dump-contact",
        &number,
    ];
    let out = setae(&arguments, &folder);
    assert_eq!(
        out.status.code(),
        Some(0),
        "{}",
        String::from_utf8_lossy(&out.stderr)
    );
    let path = folder.join(format!("out/contact_step_{step}.hdf5"));
    let problem = scenarios::fclib::read(&path).unwrap();
    assert_eq!(problem.cone, expected);
    let mut r = Vec::new();
    let settings = SolveSettings::default().with_tolerance(1e-12);
    assert!(solve(&problem, &mut r, &settings).is_converged());
    // All normals are nearly parallel here, so the reactions add up to the force of the step.
    let dim = problem.cone.dim();
    let sums = (0..dim).map(|k| r.iter().skip(k).step_by(dim).sum::<f64>().powi(2));
    let (found, wanted) = (
        sums.sum::<f64>().sqrt(),
        force(&folder.join("out"), interface, step),
    );
    assert!(wanted > 0.0);
    assert!(
        (found - wanted).abs() <= tolerance * wanted,
        "{scene}: {found} for {wanted}"
    );
    let out = setae(&["contact", "out"], &folder);
    assert_eq!(out.status.code(), Some(0));
}

#[test]
fn a_dumped_problem_holds_the_forces_of_its_step() {
    dumped("impact", "blocks", 60, Cone::Spatial, 1e-3);
}

#[test]
fn a_dumped_problem_without_friction_is_written_in_space() {
    dumped("bar-impact", "wall", 100, Cone::Spatial, 1e-6);
}

#[test]
fn a_step_without_contact_dumps_nothing_and_says_so() {
    let folder = fresh_folder("dump_nothing");
    let out = setae(
        &["run", "impact", "--out", "out", "--dump-contact", "1"],
        &folder,
    );
    assert_eq!(out.status.code(), Some(0));
    assert!(!folder.join("out/contact_step_1.hdf5").exists());
    assert!(String::from_utf8_lossy(&out.stdout).contains("no contact problem to dump: step 1"));
}
