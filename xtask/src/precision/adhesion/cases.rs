//! The scenes, their meshes and steps, and the numbers taken from them.

use super::curve::{Curve, falls_below, mean, peak};
use super::runs::Sample;
use super::{Case, Level, Quantity};

pub(super) const ALL: &[Case] = &[INDENTATION, WHEEL, PLATE_CYLINDER, SLOW, TWIST];

const fn rung(mesh: &'static str, dt: &'static str, sets: &'static [&'static str]) -> Level {
    Level {
        mesh,
        dt,
        sets,
        default: false,
        ladder: true,
    }
}

/// A level beside the ladder.
const fn aside(mesh: &'static str, dt: &'static str, sets: &'static [&'static str]) -> Level {
    Level {
        ladder: false,
        ..rung(mesh, dt, sets)
    }
}

/// The mesh and the step of the scene.
const fn as_it_is(level: Level) -> Level {
    Level {
        default: true,
        ..level
    }
}

fn curve(samples: &[Sample], from: f64, y: impl Fn(&Sample) -> f64) -> Curve {
    let later = samples.iter().filter(|s| s.time >= from * (1.0 - 1e-9));
    later.map(|s| (s.time, y(s))).collect()
}

const fn quantity(
    name: &'static str,
    unit: &'static str,
    scale: f64,
    read: fn(&[Sample]) -> Option<f64>,
) -> Quantity {
    Quantity {
        name,
        unit,
        scale,
        read,
    }
}

/// Time of withdrawal \[s\].
const UP: f64 = 2.0;

const INDENTATION: Case = Case {
    title: "indentation",
    about: "Pull-off force, its time, and the time at which the bond 2 mm from the axis falls below a half. \
            The force is the small difference of pull and pressure and drops whenever a ring of nodes lets go: its largest value \
            depends on the mesh, and on the step where that falls between two rings.",
    scene: "indentation",
    sets: &[],
    levels: &[
        rung("60 x 10", "0.04", &["cells=(60, 10)"]),
        as_it_is(rung("120 x 20", "0.02", &[])),
        rung("240 x 40", "0.01", &["refine=2"]),
        aside("60 x 20", "0.02", &["cells=(60, 20)"]),
        aside("60 x 20", "0.005", &["cells=(60, 20)"]),
        aside("120 x 20", "0.01", &[]),
        aside("240 x 40", "0.02", &["refine=2"]),
    ],
    quantities: &[
        quantity("pull-off force", "N", 1.0, |s| Some(pull_off(s)?.1)),
        quantity("time of pull-off", "s", 1.0, |s| Some(pull_off(s)?.0)),
        quantity("beta(2 mm) < 1/2", "s", 1.0, |s| {
            falls_below(&curve(s, UP, |s| s.beta[6]), 0.5)
        }),
    ],
};

fn pull_off(samples: &[Sample]) -> Option<(f64, f64)> {
    peak(&curve(samples, UP, |s| s.force[0][1]))
}

const WHEEL: Case = Case {
    title: "wheel, first 20 ms",
    about: "A node of the rim 28.1 degrees from the lowest: its largest pull and the time at which its bond falls below a tenth. \
            Largest vertical and mean horizontal force on the lower side, the latter from 10 to 20 ms. A bond grows by w dt / b in each step of contact, so that the \
            intensity with which it lets go, and the pull with its square, is known to a step. The nodes make the \
            patch of contact longer by a part of their distance: bonds have more time to form, roughly in first order of the mesh.",
    scene: "wheel",
    sets: &["end=0.02", "probes.b.node=(0.0023570, -0.0044096, 0.0)"],
    levels: &[
        rung("16 a quarter", "1e-4", &["mesh.cells=16"]),
        rung("32 a quarter", "5e-5", &[]),
        rung("64 a quarter", "2.5e-5", &["refine=2"]),
        as_it_is(aside("32 a quarter", "1e-4", &[])),
        aside("32 a quarter", "2.5e-5", &[]),
        aside("64 a quarter", "5e-5", &["refine=2"]),
    ],
    quantities: &[
        quantity("largest pull", "MPa", 1e-6, |s| {
            Some(peak(&curve(s, 0.0, |s| s.pull[1]))?.1)
        }),
        quantity("beta < 1/10", "ms", 1e3, |s| {
            falls_below(&curve(s, 0.0, |s| s.beta[1]), 0.1)
        }),
        quantity("largest force", "N/m", 1.0, |s| {
            Some(peak(&curve(s, 0.0, |s| s.force[0][1]))?.1)
        }),
        quantity("mean force", "N/m", 1.0, |s| {
            mean(&curve(s, 0.01, |s| s.force[0][0]))
        }),
    ],
};

const QUARTER: &[&str] = &["cylinder.mesh.cells=10", "plate.mesh.cells=(38, 2)"];
const HALF: &[&str] = &["cylinder.mesh.cells=20", "plate.mesh.cells=(75, 3)"];

const PLATE_CYLINDER: Case = Case {
    title: "plate-cylinder, descent in 1 ms",
    about: "Largest horizontal force, largest intensity at the pole, and the time at which it falls below half of that.",
    scene: "plate-cylinder",
    sets: &[],
    levels: &[
        rung("10 a quarter", "1.6e-4", QUARTER),
        rung("20 a quarter", "8e-5", HALF),
        as_it_is(rung("40 a quarter", "4e-5", &[])),
        rung("80 a quarter", "2e-5", &["refine=2"]),
        aside("20 a quarter", "4e-5", HALF),
        aside("40 a quarter", "2e-5", &[]),
    ],
    quantities: DRAGGED,
};

const SLOW: Case = Case {
    title: "plate-cylinder, descent in 5 ms",
    about: "The same for a slow descent.",
    sets: &[
        "drive.motion.translation=([(0.005, 0.0), (0.013, 0.008)], [(0.0, 0.0), (0.005, -0.001)], 0.0)",
        "end=0.013",
    ],
    levels: &[
        rung("10 a quarter", "1.6e-4", QUARTER),
        rung("20 a quarter", "8e-5", HALF),
        as_it_is(rung("40 a quarter", "4e-5", &[])),
        aside("20 a quarter", "4e-5", HALF),
    ],
    ..PLATE_CYLINDER
};

const DRAGGED: &[Quantity] = &[
    quantity("largest force", "N/m", 1.0, |s| {
        Some(peak(&curve(s, 0.0, |s| s.force[0][0].abs()))?.1)
    }),
    quantity("largest beta", "-", 1.0, pole),
    quantity("beta < half", "ms", 1e3, |s| {
        falls_below(&curve(s, 0.0, |s| s.beta[0]), 0.5 * pole(s)?)
    }),
];

/// Largest intensity; a parabola would leave the bound of 1.
fn pole(samples: &[Sample]) -> Option<f64> {
    samples.iter().map(|s| s.beta[0]).reduce(f64::max)
}

const TWIST: Case = Case {
    title: "twist",
    about: "Largest moment, and the times at which the mean intensity falls below .9 and below a half. \
            From rung to rung mesh and step shrink by the square root of 2.",
    scene: "twist",
    sets: &[],
    levels: &[
        rung("10 x 10 x 3", "2e-4", &["cells=(10, 10, 3)"]),
        rung("14 x 14 x 4", "1.4e-4", &["cells=(14, 14, 4)"]),
        as_it_is(rung("20 x 20 x 6", "1e-4", &[])),
        rung("28 x 28 x 8", "7e-5", &["cells=(28, 28, 8)"]),
    ],
    quantities: &[
        quantity("largest moment", "N mm", 1e3, |s| {
            Some(peak(&curve(s, 5e-3, |s| s.moment[0][2].abs()))?.1)
        }),
        quantity("mean beta < .9", "ms", 1e3, |s| {
            falls_below(&curve(s, 5e-3, |s| s.mean[0]), 0.9)
        }),
        quantity("mean beta < .5", "ms", 1e3, |s| {
            falls_below(&curve(s, 5e-3, |s| s.mean[0]), 0.5)
        }),
    ],
};
