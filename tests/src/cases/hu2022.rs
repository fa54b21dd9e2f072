//! The scenes with adhesion of \[Hu2022\], for which there is no closed form: mesh and step are halved together, the
//! finest run is the reference, and further runs halve one of the two.
//!
//! Peaks are those of the parabola through the largest value and its neighbours, times those of the line between two
//! steps, so that the steps do not quantise them.

use crate::curve::{Curve, falls_below, mean, peak};
use crate::{Case, Found, Ladder, Ran};

const TOGETHER: &str = "mesh and step";
const APART: &str = "one of them";

/// Rungs as `(label, relative size, sets)`.
fn ladders(together: &[(&str, f64, &[&str])], apart: &[(&str, f64, &[&str])]) -> Vec<Ladder> {
    let ladder = |name: &str, rungs: &[(&str, f64, &[&str])]| {
        let empty = Ladder::new(name);
        let add =
            |l: Ladder, (label, size, sets): &(&str, f64, &[&str])| l.rung(*label, *size, sets);
        rungs.iter().fold(empty, add)
    };
    vec![
        ladder(TOGETHER, together),
        ladder(APART, apart).against_first(),
    ]
}

fn later(curve: Curve, from: f64) -> Curve {
    curve
        .into_iter()
        .filter(|p| p.0 >= from * (1.0 - 1e-9))
        .collect()
}

fn absolute(curve: Curve) -> Curve {
    curve.into_iter().map(|(t, y)| (t, y.abs())).collect()
}

/// What does not come about is told as NaN.
fn time_of(point: Option<(f64, f64)>) -> f64 {
    point.map_or(f64::NAN, |p| p.0)
}

fn value_of(point: Option<(f64, f64)>) -> f64 {
    point.map_or(f64::NAN, |p| p.1)
}

/// Adhesive indentation.
pub fn indentation() -> Case {
    Case {
        name: "indentation",
        about: "Pull-off force, its time, and the time at which the bond 2 mm from the axis falls below a half. \
                The force is the small difference of pull and pressure and drops whenever a ring of nodes lets go: its largest value \
                depends on the mesh, and on the step where that falls between two rings. Pictures: [Hu2022, 4.1].",
        scene: "indentation",
        sets: Vec::new(),
        ladders: ladders(
            &[
                ("59 x 10, 0.04 s", 2.0, &["cells=(59, 10)", "dt=0.04"]),
                ("118 x 20, 0.02 s (the scene)", 1.0, &[]),
                ("236 x 40, 0.01 s", 0.5, &["refine=2", "dt=0.01"]),
            ],
            &[
                ("59 x 20, 0.005 s", 2.0, &["cells=(59, 20)", "dt=0.005"]),
                ("118 x 20, 0.01 s", 1.0, &["dt=0.01"]),
                ("236 x 40, 0.02 s", 0.5, &["refine=2"]),
            ],
        ),
        measure: |ran| {
            // Withdrawn from 2 s on.
            let pull = peak(&later(ran.curve("t", "force.contact.y")?, 2.0));
            let bond = later(ran.curve("t", "probe.n3.beta")?, 2.0);
            Ok(vec![
                Found::open("pull-off force", "N", value_of(pull)),
                Found::open("time of pull-off", "s", time_of(pull)),
                Found::open(
                    "beta(2 mm) < 1/2",
                    "s",
                    falls_below(&bond, 0.5).unwrap_or(f64::NAN),
                ),
            ])
        },
    }
}

/// The wheel that rolls.
pub fn wheel() -> Case {
    Case {
        name: "wheel",
        about: "The first 20 ms. A node of the rim 28.1 degrees from the lowest: its largest pull and the time at which its bond falls \
                below a tenth. Largest vertical and mean horizontal force on the lower side, the latter from 10 to 20 ms. A bond \
                grows by w dt / b in each step of contact, so that the intensity with which it lets go, and the pull with its square, \
                is known to a step. The nodes make the patch of contact longer by a part of their distance: bonds have more time to \
                form, roughly in first order of the mesh. [Hu2022, 4.2]",
        scene: "wheel",
        sets: ["end=0.02", "probes.b.node=(0.0023570, -0.0044096, 0.0)"]
            .map(str::to_owned)
            .into(),
        ladders: ladders(
            &[
                ("16 a quarter, 0.1 ms", 2.0, &["mesh.cells=16"]),
                ("32 a quarter, 0.05 ms", 1.0, &["dt=5e-5"]),
                ("64 a quarter, 0.025 ms", 0.5, &["refine=2", "dt=2.5e-5"]),
            ],
            &[
                ("32 a quarter, 0.1 ms (the scene)", 1.0, &[]),
                ("32 a quarter, 0.025 ms", 1.0, &["dt=2.5e-5"]),
                ("64 a quarter, 0.05 ms", 0.5, &["refine=2", "dt=5e-5"]),
            ],
        ),
        measure: |ran| {
            let pull = ran.column("t")?.into_iter().zip(ran.traction("b")?);
            let pull = absolute(pull.collect());
            let bond = ran.curve("t", "probe.b.beta")?;
            let up = peak(&ran.curve("t", "force.lower.y")?);
            let along = mean(&later(ran.curve("t", "force.lower.x")?, 0.01));
            Ok(vec![
                Found::open("largest force", "N/m", value_of(up)),
                Found::open("largest pull", "MPa", 1e-6 * value_of(peak(&pull))),
                Found::open(
                    "beta < 1/10",
                    "ms",
                    1e3 * falls_below(&bond, 0.1).unwrap_or(f64::NAN),
                ),
                Found::open("mean force along", "N/m", along.unwrap_or(f64::NAN)),
            ])
        },
    }
}

const QUARTER: &[&str] = &[
    "cylinder.mesh.cells=10",
    "plate.mesh.cells=(38, 2)",
    "dt=1.6e-4",
];
const HALF: &[&str] = &[
    "cylinder.mesh.cells=20",
    "plate.mesh.cells=(75, 3)",
    "dt=8e-5",
];
const HALF_MESH: &[&str] = &["cylinder.mesh.cells=20", "plate.mesh.cells=(75, 3)"];

/// A plate dragged over a half-cylinder.
pub fn plate_cylinder() -> Case {
    Case {
        name: "plate-cylinder",
        about: "Descent in 1 ms: largest horizontal force, largest intensity at the pole, and the time at which it falls below half of \
                that. [Hu2022, 4.3]",
        scene: "plate-cylinder",
        sets: Vec::new(),
        ladders: ladders(
            &[
                ("10 a quarter, 0.16 ms", 4.0, QUARTER),
                ("20 a quarter, 0.08 ms", 2.0, HALF),
                ("40 a quarter, 0.04 ms (the scene)", 1.0, &[]),
                ("80 a quarter, 0.02 ms", 0.5, &["refine=2", "dt=2e-5"]),
            ],
            &[
                ("20 a quarter, 0.04 ms", 2.0, HALF_MESH),
                ("40 a quarter, 0.02 ms", 1.0, &["dt=2e-5"]),
            ],
        ),
        measure: dragged,
    }
}

/// The same with a slow descent.
pub fn plate_cylinder_slow() -> Case {
    Case {
        name: "plate-cylinder-slow",
        about: "As plate-cylinder, with a descent in 5 ms.",
        sets: [
            "drive.motion.translation=([(0.005, 0.0), (0.013, 0.008)], [(0.0, 0.0), (0.005, -0.001)], 0.0)",
            "end=0.013",
        ]
        .map(str::to_owned)
        .into(),
        ladders: ladders(
            &[
                ("10 a quarter, 0.16 ms", 4.0, QUARTER),
                ("20 a quarter, 0.08 ms", 2.0, HALF),
                ("40 a quarter, 0.04 ms (the scene)", 1.0, &[]),
            ],
            &[("20 a quarter, 0.04 ms", 2.0, HALF_MESH)],
        ),
        ..plate_cylinder()
    }
}

fn dragged(ran: &Ran) -> Result<Vec<Found>, String> {
    let force = absolute(ran.curve("t", "force.contact.x")?);
    let bond = ran.curve("t", "probe.cylinder.beta")?;
    // A parabola would leave the bound of 1.
    let largest = bond.iter().map(|p| p.1).fold(0.0, f64::max);
    let breaks = falls_below(&bond, 0.5 * largest);
    Ok(vec![
        Found::open("largest force", "N/m", value_of(peak(&force))),
        Found::open("largest beta", "-", largest),
        Found::open("beta < half", "ms", 1e3 * breaks.unwrap_or(f64::NAN)),
    ])
}

/// A block pressed and twisted.
pub fn twist() -> Case {
    Case {
        name: "twist",
        about: "Largest moment, and the times at which the mean intensity falls below .9 and below a half. From rung to rung mesh and \
                step shrink by the square root of 2. [Hu2022, 4.4]",
        scene: "twist",
        sets: Vec::new(),
        ladders: vec![
            Ladder::new(TOGETHER)
                .rung(
                    "10 x 10 x 3, 0.2 ms",
                    2.0,
                    &["cells=(10, 10, 3)", "dt=2e-4"],
                )
                .rung(
                    "14 x 14 x 4, 0.14 ms",
                    1.4,
                    &["cells=(14, 14, 4)", "dt=1.4e-4"],
                )
                .rung("20 x 20 x 6, 0.1 ms (the scene)", 1.0, &[])
                .rung(
                    "28 x 28 x 8, 0.07 ms",
                    0.7,
                    &["cells=(28, 28, 8)", "dt=7e-5"],
                ),
        ],
        measure: |ran| {
            let moment = later(absolute(ran.curve("t", "moment.ground.z")?), 5e-3);
            let mean = later(ran.curve("t", "bond.ground.beta_mean")?, 5e-3);
            let below = |level| 1e3 * falls_below(&mean, level).unwrap_or(f64::NAN);
            Ok(vec![
                Found::open("largest moment", "N mm", 1e3 * value_of(peak(&moment))),
                Found::open("mean beta < .9", "ms", below(0.9)),
                Found::open("mean beta < .5", "ms", below(0.5)),
            ])
        },
    }
}
