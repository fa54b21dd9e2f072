//! Pictures: what must be in them. How they look is for eyes: they stay in the folder of the test.

use fe_core::CellKind;
use nalgebra::Vector3;
use scenarios::catalog;
use scenarios::output::{Array, Cells, Energies, Force, Frame, Results, Row, Summary, Values};

use crate::fresh_folder;

/// A bent block of n x n x n cells standing on a larger one.
fn blocks(n: usize) -> (Vec<Vector3<f64>>, Vec<u32>, Vec<f64>, Vec<f64>) {
    let mut points = Vec::new();
    let mut cells = Vec::new();
    let mut bend = Vec::new();
    for (low, size) in [
        ([0.0, 0.0, 0.0], [2.0, 2.0, 1.0]),
        ([0.5, 0.3, 1.0], [1.0, 1.0, 1.0]),
    ] {
        let first = points.len() as u32;
        let m = n as u32 + 1;
        for k in 0..=n {
            for j in 0..=n {
                for i in 0..=n {
                    let s = [i, j, k].map(|i| i as f64 / n as f64);
                    let x: [f64; 3] = std::array::from_fn(|c| low[c] + size[c] * s[c]);
                    points.push(x);
                    let swing = if low[2] > 0.0 {
                        0.35 * s[2] * s[2]
                    } else {
                        0.05 * s[2]
                    };
                    bend.extend([
                        0.0,
                        swing,
                        -0.12 * s[2] * (if low[2] > 0.0 { 1.0 } else { 0.3 }),
                    ]);
                }
            }
        }
        let id = |i: u32, j: u32, k: u32| first + i + m * (j + m * k);
        for k in 0..n as u32 {
            for j in 0..n as u32 {
                for i in 0..n as u32 {
                    cells.extend([
                        id(i, j, k),
                        id(i + 1, j, k),
                        id(i + 1, j + 1, k),
                        id(i, j + 1, k),
                    ]);
                    cells.extend([
                        id(i, j, k + 1),
                        id(i + 1, j, k + 1),
                        id(i + 1, j + 1, k + 1),
                        id(i, j + 1, k + 1),
                    ]);
                }
            }
        }
    }
    let center = |cell: &[u32], c: usize| {
        cell.iter()
            .map(|node| points[*node as usize][c])
            .sum::<f64>()
            / 8.0
    };
    let stress = cells.chunks_exact(8).map(|cell| {
        let d2 = (center(cell, 0) - 1.0).powi(2)
            + (center(cell, 1) - 0.8).powi(2)
            + (center(cell, 2) - 1.0).powi(2);
        1330.0 * (-1.5 * d2).exp()
    });
    let stress = stress.collect();
    (
        points.into_iter().map(Vector3::from).collect(),
        cells,
        bend,
        stress,
    )
}

#[test]
fn every_asked_picture_is_drawn() {
    let folder = fresh_folder("pictures");
    let scene = catalog::load("impact", &["plots=[Energy,Deformed,DeformedAt(0.4),Force(\"blocks\"),Moment(\"base\"),Probe(\"corner\")]".parse().unwrap()]).unwrap().scene;
    let mut results = Results::create(&folder, &scene).unwrap();
    let (points, cells, bend, stress) = blocks(6);
    for step in 0..=100_usize {
        let t = step as f64 / 100.0;
        let hit = ((t - 0.25) / 0.4).clamp(0.0, 1.0);
        let strain = 40.0 * (std::f64::consts::PI * hit).sin();
        let friction = 30.0 * hit;
        let row = Row {
            time: t,
            energies: Energies {
                kinetic: 162.5 - strain - friction,
                strain,
                friction_dissipation: friction,
                ..Energies::default()
            },
            forces: vec![
                Force {
                    force: [0.0, -80.0 * strain / 40.0, 400.0 * strain / 40.0],
                    moment: [1e-4 * strain, 0.0, 2e-5],
                },
                Force {
                    force: [0.0; 3],
                    moment: [1e-7 * strain, -2e-7 * hit, 0.0],
                },
            ],
            probes: vec![0.0, 1.5 * t, -t, 0.0, 1.5 - hit, 2.0 * hit - 1.0],
            ..Row::default()
        };
        if step == 0 {
            results.start(&row);
        } else {
            results.record(&row).unwrap();
        }
        if results.wants_frame(step, t, step == 100) {
            let u: Vec<f64> = bend.iter().map(|b| b * (1.0 + t)).collect();
            let frame = Frame {
                time: t,
                points: &points,
                cells: vec![Cells {
                    kind: CellKind::Hex8,
                    connectivity: &cells,
                }],
                point_data: vec![Array {
                    name: "displacement",
                    values: Values::Vector(&u),
                }],
                cell_data: vec![Array {
                    name: "von_mises",
                    values: Values::Scalar(&stress),
                }],
            };
            results.frame(step, &frame, step == 100).unwrap();
        }
    }
    results.finish(&Summary::default()).unwrap();
    let read = |name: &str| {
        std::fs::read_to_string(folder.join(name)).unwrap_or_else(|e| panic!("{name}: {e}"))
    };
    let energy = read("energy.svg");
    for word in [
        "kinetic energy",
        "friction dissipation",
        "total energy",
        "Energy [J]",
        "Time [s]",
    ] {
        assert!(energy.contains(word), "{word}");
    }
    assert!(
        !energy.contains("bond dissipation"),
        "what is zero throughout is left out"
    );
    assert!(read("moment_base.svg").contains("Moment [10⁻⁶ N m]"));
    assert!(read("deformed_0.4.svg").contains("t = 0.4 s"));
    assert!(read("deformed.svg").contains("von Mises [Pa]"));
    for name in [
        "force_blocks.svg",
        "probe_corner_displacement.svg",
        "probe_corner_velocity.svg",
    ] {
        assert!(read(name).starts_with("<svg width=\"900\""), "{name}");
    }
    assert!(read("fields.pvd").contains("fields/step_000100.vtu"));
}

#[test]
fn a_frame_without_cells_or_stress_is_drawn_too() {
    let frame = Frame {
        time: 0.0,
        points: &[],
        cells: vec![],
        point_data: vec![],
        cell_data: vec![],
    };
    assert!(scenarios::output::deformed_svg("empty", &frame).is_ok());
    let points = [
        [0.0, 0.0, 0.0],
        [1.0, 0.0, 0.0],
        [0.0, 1.0, 0.0],
        [0.0, 0.0, 1.0],
    ]
    .map(Vector3::from);
    let frame = Frame {
        time: 1e-7,
        points: &points,
        cells: vec![Cells {
            kind: CellKind::Tet4,
            connectivity: &[0, 1, 2, 3],
        }],
        point_data: vec![],
        cell_data: vec![],
    };
    let svg = scenarios::output::deformed_svg("one < tetrahedron", &frame).unwrap();
    assert!(svg.contains("t = 1e-7 s") && svg.contains("one &lt; tetrahedron"));
}
