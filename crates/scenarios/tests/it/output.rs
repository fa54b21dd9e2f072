//! Files of a run, read back.

use std::fs;

use fe_core::CellKind;
use nalgebra::Vector3;
use proptest::prelude::*;
use scenarios::catalog;
use scenarios::output::{
    Array, Cells, Energies, EnergySummary, Folder, Force, Frame, History, Results, Row, Status,
    Summary, Values, vtu_bytes,
};
use scenarios::spec::Override;

use crate::fresh_folder;
use crate::vtu_reader::Vtu;

const HEX: [u32; 8] = [0, 1, 2, 3, 4, 5, 6, 7];
const TET: [u32; 4] = [4, 5, 6, 8];

fn points() -> Vec<Vector3<f64>> {
    let corners = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)];
    let layer = |z: f64| corners.map(|(x, y)| Vector3::new(x, y, z));
    let mut points = [layer(0.0), layer(1.0)].concat();
    points.push(Vector3::new(0.5, 0.5, 2.0));
    points
}

proptest! {
    #[test]
    fn fields_read_back_equal_bit_by_bit(
        vector in prop::collection::vec(any::<f64>(), 27),
        stress in prop::collection::vec(any::<f64>(), 12),
        status in prop::collection::vec(any::<i32>(), 9),
        time in any::<f64>(),
    ) {
        let points = points();
        let frame = Frame {
            time,
            points: &points,
            cells: vec![
                Cells { kind: CellKind::Hex8, connectivity: &HEX },
                Cells { kind: CellKind::Tet4, connectivity: &TET },
            ],
            point_data: vec![
                Array { name: "displacement", values: Values::Vector(&vector) },
                Array { name: "contact_status", values: Values::Integer(&status) },
            ],
            cell_data: vec![
                Array { name: "von_mises", values: Values::Scalar(&stress[..2]) },
                Array { name: "cauchy_stress", values: Values::SymmetricTensor(&stress) },
            ],
        };
        let vtu = Vtu::read(&vtu_bytes(&frame).unwrap());
        let bits = |values: &[f64]| values.iter().map(|v| v.to_bits()).collect::<Vec<_>>();
        prop_assert!(vtu.head.contains("NumberOfPoints=\"9\" NumberOfCells=\"2\""));
        prop_assert_eq!(bits(&vtu.floats("Points")), bits(&points.iter().flatten().copied().collect::<Vec<_>>()));
        prop_assert_eq!(bits(&vtu.floats("displacement")), bits(&vector));
        prop_assert_eq!(bits(&vtu.floats("TimeValue")), bits(&[time]));
        prop_assert_eq!(vtu.integers("contact_status"), status.iter().map(|s| i64::from(*s)).collect::<Vec<_>>());
        prop_assert_eq!(vtu.integers("connectivity"), [0, 1, 2, 3, 4, 5, 6, 7, 4, 5, 6, 8]);
        prop_assert_eq!(vtu.integers("offsets"), [8, 12]);
        prop_assert_eq!(vtu.integers("types"), [12, 10]);
        // 11 22 33 12 13 23 becomes XX YY ZZ XY YZ XZ.
        let s = &stress;
        let vtk = [s[0], s[1], s[2], s[3], s[5], s[4], s[6], s[7], s[8], s[9], s[11], s[10]];
        prop_assert_eq!(bits(&vtu.floats("cauchy_stress")), bits(&vtk));
        prop_assert_eq!(vtu.attribute("cauchy_stress", "ComponentName5"), Some("XZ"));
    }
}

#[test]
fn long_arrays_of_several_blocks_read_back() {
    // 131072 bytes a block: less than one, exactly two, two and a bit.
    for count in [1, 32_768, 40_001] {
        let points: Vec<Vector3<f64>> = (0..count)
            .map(|i| Vector3::new(i as f64, (i as f64).sin(), -1.0))
            .collect();
        let values: Vec<f64> = (0..count).map(|i| (i as f64).cos()).collect();
        let frame = Frame {
            time: 0.0,
            points: &points,
            cells: Vec::new(),
            point_data: vec![Array {
                name: "value",
                values: Values::Scalar(&values),
            }],
            cell_data: Vec::new(),
        };
        let vtu = Vtu::read(&vtu_bytes(&frame).unwrap());
        assert_eq!(vtu.floats("value"), values);
        assert_eq!(
            vtu.floats("Points"),
            points.iter().flatten().copied().collect::<Vec<_>>()
        );
        assert!(vtu.integers("connectivity").is_empty());
    }
}

fn results(name: &str, sets: &[&str]) -> (Results, std::path::PathBuf) {
    let folder = fresh_folder(name);
    let sets: Vec<Override> = sets.iter().map(|set| set.parse().unwrap()).collect();
    let scene = catalog::load("impact", &sets).unwrap().scene;
    (Results::create(&folder, &scene).unwrap(), folder)
}

fn row(time: f64) -> Row {
    Row {
        time,
        energies: Energies {
            kinetic: 1.0 / 3.0,
            strain: 1e-30,
            friction_dissipation: 2e20,
            ..Energies::default()
        },
        forces: vec![
            Force {
                force: [time, 0.1, -0.2],
                moment: [1.0, 2.0, 3.0],
            },
            Force::default(),
        ],
        probes: (0..6).map(f64::from).collect(),
        ..Row::default()
    }
}

#[test]
fn history_has_the_promised_columns_and_keeps_bits() {
    let (mut results, folder) = results("history", &[]);
    results.start(&row(0.0));
    results.record(&row(0.01)).unwrap();
    // Read while the run is still going: nothing waits in a buffer.
    let text = fs::read_to_string(folder.join("history.csv")).unwrap();
    let mut lines = text.lines();
    let header: Vec<&str> = lines.next().unwrap().split(',').collect();
    let start = [
        "t",
        "energy.kinetic",
        "energy.strain",
        "energy.adhesive",
        "work.load",
        "dissipation.friction",
        "dissipation.bond",
        "dissipation.damping",
        "dissipation.impact",
        "error.integration",
        "contact.closed",
        "contact.penetration",
        "contact.error",
        "force.blocks.x",
        "force.blocks.y",
        "force.blocks.z",
        "moment.blocks.x",
        "moment.blocks.y",
        "moment.blocks.z",
        "force.base.x",
    ];
    assert_eq!(header[..start.len()], start);
    assert_eq!(header.last(), Some(&"probe.corner.velocity.z"));
    let values: Vec<f64> = lines
        .next()
        .unwrap()
        .split(',')
        .map(|v| v.parse().unwrap())
        .collect();
    assert_eq!(values.len(), header.len());
    assert_eq!(values[..6], [0.01, 1.0 / 3.0, 1e-30, 0.0, 0.0, 2e20]);
    assert_eq!(lines.next(), None, "the initial state is no accepted step");
    assert_eq!(
        results.history().column("force.blocks.x"),
        Some(vec![0.0, 0.01])
    );
}

#[test]
fn a_row_with_missing_numbers_keeps_its_columns() {
    let (results, _) = results("short-row", &[]);
    let short = Row {
        time: 1.0,
        ..Row::default()
    };
    let short = short.numbers(results.layout());
    assert_eq!(short.len(), results.layout().header().len());
    assert!(short.last().unwrap().is_nan());
}

#[test]
fn fields_come_when_asked_for() {
    let steps = |every: &str| {
        let (mut results, _) = results("schedule", &[&format!("fields_every={every}"), "plots=[]"]);
        let points = points();
        let mut written = Vec::new();
        for step in 0..=10 {
            let time = 0.1 * f64::from(step);
            let step = step as usize;
            let last = step == 10;
            if results.wants_frame(step, time, last) {
                let frame = Frame {
                    time,
                    points: &points,
                    cells: vec![],
                    point_data: vec![],
                    cell_data: vec![],
                };
                results.frame(step, &frame, last).unwrap();
                written.push(step);
                assert!(
                    !results.wants_frame(step, time, last),
                    "step {step} is not written twice"
                );
            }
        }
        written
    };
    assert_eq!(steps("Steps(4)"), [0, 4, 8, 10]);
    assert_eq!(steps("Interval(0.3)"), [0, 3, 6, 9, 10]);
    assert_eq!(steps("Interval(0.25)"), [0, 3, 5, 8, 10]);
    assert_eq!(steps("Never"), [0_usize; 0]);
}

/// A block twisted in steps that have to be cut.
const TWISTED: &str = r#"(
    title: "twisted",
    materials: {"m": (law: NeoHookean(E: 100.0, nu: 0.3), density: 1.0)},
    bodies: {"block": (mesh: Box(min: (0.0, 0.0, 0.0), max: (1.0, 1.0, 1.0), cells: (2, 2, 2)), material: "m")},
    motions: {
        "bottom": (nodes: "block.z_min"),
        "top": (
            nodes: "block.z_max",
            motion: Move(rotation: (point: (0.5, 0.5, 0.0), axis: (0.0, 0.0, 1.0), angle: [(0.0, 0.0), (8.0, 4.0)])),
        ),
    },
    time: (end: 8.0, dt: 1.0, inertia: QuasiStatic),
    solver: (max_newton: 5),
    output: (fields_every: Interval(1.0), plots: [DeformedAt(2.6)]),
)"#;

#[test]
fn fields_have_the_times_that_were_asked_for_after_cut_steps_too() {
    let folder = fresh_folder("exact-times");
    let scene = scenarios::spec::parse("twisted", TWISTED, &[]).unwrap();
    let summary = scenarios::run(&scene, &folder, &mut |_| ()).unwrap();
    assert_eq!(summary.status, Status::Completed);
    assert!(summary.rejected_steps > 2, "nothing was cut");
    let pvd = fs::read_to_string(folder.join("fields.pvd")).unwrap();
    let times = pvd.split("timestep=\"").skip(1);
    let times: Vec<f64> = times
        .map(|rest| rest.split('"').next().unwrap().parse().unwrap())
        .collect();
    assert_eq!(times, (0..=8).map(f64::from).collect::<Vec<_>>());
    let history = History::read(&folder.join("history.csv")).unwrap();
    assert!(history.column("t").unwrap().contains(&2.6));
}

#[test]
fn wrong_fields_are_refused() {
    let (mut results, folder) = results("wrong-fields", &[]);
    let points = points();
    let mut frame = Frame {
        time: 0.5,
        points: &points,
        cells: vec![Cells {
            kind: CellKind::Hex8,
            connectivity: &[9; 8],
        }],
        point_data: vec![],
        cell_data: vec![],
    };
    let error = results.frame(0, &frame, false).unwrap_err().to_string();
    assert!(
        error.contains("t = 0.5") && error.contains("node 9"),
        "{error}"
    );
    frame.cells.clear();
    frame.point_data = vec![Array {
        name: "u",
        values: Values::Vector(&[0.0; 6]),
    }];
    let error = results.frame(0, &frame, false).unwrap_err().to_string();
    assert!(error.contains("`u` has 2 tuples for 9 points"), "{error}");
    assert!(!folder.join("fields.pvd").exists());
}

#[test]
fn summary_has_the_promised_keys() {
    let folder = Folder::create(&fresh_folder("summary")).unwrap();
    let mut summary = Summary::default();
    summary.status = Status::Completed;
    summary.steps = 100;
    summary.phases.insert("assembly".into(), 0.5);
    summary.write(&folder).unwrap();
    let text = fs::read_to_string(folder.file("summary.json")).unwrap();
    let json: serde_json::Value = serde_json::from_str(&text).unwrap();
    for key in [
        "status",
        "reason",
        "steps",
        "rejected_steps",
        "newton_iterations",
        "factorizations",
        "contact_solves",
        "contact_iterations",
        "dofs",
        "elements",
        "contacts_max",
        "cpu_s",
        "wall_s",
        "phases",
        "energy",
        "max_penetration",
        "max_contact_error",
    ] {
        assert!(json.get(key).is_some(), "{key}");
    }
    for key in [
        "initial",
        "final",
        "kinetic",
        "strain",
        "adhesive",
        "load_work",
        "friction_dissipation",
        "bond_dissipation",
        "damping_dissipation",
        "impact_loss",
        "integration_error",
    ] {
        assert!(json["energy"].get(key).is_some(), "energy.{key}");
    }
    assert_eq!(json["status"], "completed");
    assert_eq!(serde_json::from_str::<Summary>(&text).unwrap(), summary);
    let path = folder.path().to_owned();
    drop(folder);
    let left = fs::read_dir(path).unwrap().count();
    assert_eq!(left, 1, "no part of a file is left");
}

#[test]
fn the_audit_adds_up() {
    let end = Energies {
        kinetic: 5.0,
        strain: 2.0,
        load_work: 1.0,
        friction_dissipation: 3.0,
        impact_loss: 0.5,
        integration_error: 0.25,
        ..Energies::default()
    };
    assert_eq!(EnergySummary::new(9.75, &end).unexplained(), 0.0);
}

#[test]
fn results_of_an_earlier_run_are_removed_and_nothing_else() {
    let folder = fresh_folder("again");
    fs::create_dir_all(folder.join("fields")).unwrap();
    for ours in [
        "summary.json",
        "history.csv",
        "fields.pvd",
        "energy.svg",
        "fields/step_000010.vtu",
    ] {
        fs::write(folder.join(ours), "old").unwrap();
    }
    for other in ["notes.txt", "fields/mine.vtu"] {
        fs::write(folder.join(other), "keep").unwrap();
    }
    Folder::create(&folder).unwrap();
    assert!(
        !folder.join("summary.json").exists() && !folder.join("fields/step_000010.vtu").exists()
    );
    assert!(folder.join("notes.txt").exists() && folder.join("fields/mine.vtu").exists());
}

#[test]
fn a_folder_that_is_a_file_is_refused() {
    let path = fresh_folder("blocked").join("file");
    fs::write(&path, "").unwrap();
    let error = Folder::create(&path).unwrap_err().to_string();
    assert!(
        error.contains("cannot write into the output folder") && error.contains("--out"),
        "{error}"
    );
}
