//! Scenes without adhesion that have no closed form: what mesh, step, tolerance and scheme change.

use crate::curve::peak;
use crate::{Case, Found, Ladder, Ran};

/// Tolerances of Newton's method and of the contact law, the latter a hundred times as large.
fn over_tolerance(name: &str, tolerances: &[f64]) -> Ladder {
    let with = |ladder: Ladder, tolerance: &f64| {
        let newton = format!("solver.newton_tolerance={tolerance:e}");
        let contact = format!("solver.contact_tolerance={:e}", 100.0 * tolerance);
        ladder.rung(format!("{tolerance:e}"), *tolerance, &[&newton, &contact])
    };
    tolerances.iter().fold(Ladder::new(name), with)
}

/// Oblique impact of two blocks with friction \[Feng2007, 4.2\].
pub fn impact() -> Case {
    let coarse = [
        "lower.mesh.cells=(4, 4, 2)",
        "upper.mesh.cells=(2, 2, 2)",
        "time.dt=0.02",
    ];
    let ladder = Ladder::new("mesh and step")
        .rung("4 x 4 x 2, 0.02 s", 2.0, &coarse)
        .rung("8 x 8 x 4, 0.01 s (the scene)", 1.0, &[])
        .rung("16 x 16 x 8, 0.005 s", 0.5, &["refine=2", "time.dt=0.005"]);
    let steps = [0.02, 0.01, 0.005, 0.0025, 0.00125];
    Case {
        name: "impact",
        about: "Two blocks meet obliquely with mu = .2: velocity of the centre of the upper one after the impact, energy that friction \
                takes, and the energy left in all. The steps of a scheme are compared with its own finest. [Feng2007, 4.2]",
        scene: "impact",
        sets: vec![
            "output.probes={\"middle\": (body: \"upper\", node: (1.0, 0.5, 1.75), quantities: [velocity, displacement])}".to_owned(),
        ],
        ladders: vec![
            ladder,
            Ladder::over_dt("step", &steps, &[]),
            Ladder::over_dt("step, velocity", &steps, &["time.contact=Velocity"]),
            Ladder::over_dt("step, Euler", &steps, &["time.theta=1.0", "time.xi=1.0"]),
            over_tolerance("tolerance", &[1e-4, 1e-6, 1e-8, 1e-10, 1e-12]),
        ],
        measure: |ran| {
            Ok(vec![
                Found::open("friction", "J", ran.end("dissipation.friction")?),
                Found::open("displacement", "m", ran.end("probe.middle.displacement.y")?),
                Found::open("energy at the end", "J", ran.end("energy.kinetic")? + ran.end("energy.strain")?),
            ])
        },
    }
}

/// A block pressed and twisted slowly on a rigid plane.
pub fn press_twist() -> Case {
    let cells = [(5, 2), (10, 3), (20, 6), (30, 9)];
    let meshes = cells.iter().fold(Ladder::new("mesh"), |ladder, (n, m)| {
        let set = format!("cells=({n}, {n}, {m})");
        ladder.rung(format!("{n} x {n} x {m}"), 20.0 / f64::from(*n), &[&set])
    });
    Case {
        name: "press-twist",
        about: "Force and moment at the end. The edge of the block is singular, so that the mesh converges slowly. Steps and \
                tolerances on the mesh 10 x 10 x 3.",
        scene: "press-twist",
        sets: Vec::new(),
        ladders: vec![
            meshes,
            Ladder::over_dt("step", &[5.0, 2.5, 1.0, 0.5, 0.25], &["cells=(10, 10, 3)"]),
            Ladder {
                rungs: over_tolerance("", &[1e-4, 1e-6, 1e-8, 1e-10, 1e-12])
                    .rungs
                    .into_iter()
                    .map(|mut rung| {
                        rung.sets.push("cells=(10, 10, 3)".to_owned());
                        rung
                    })
                    .collect(),
                ..Ladder::new("tolerance")
            },
        ],
        measure: |ran| {
            Ok(vec![
                Found::open("moment", "N mm", 1e3 * ran.end("moment.ground.z")?.abs()),
                Found::open("force", "N", ran.end("force.ground.z")?),
            ])
        },
    }
}

/// A dry block that is pressed and turned fast.
pub fn twist_dry() -> Case {
    Case {
        name: "twist-dry",
        about: "Largest moment of the dry interface and the energy that friction takes. [Hu2022, 4.4] without bonds",
        scene: "twist-dry",
        sets: Vec::new(),
        ladders: vec![
            Ladder::new("mesh and step")
                .rung(
                    "5 x 5 x 2, 0.4 ms",
                    4.0,
                    &["cells=(5, 5, 2)", "time.dt=4e-4"],
                )
                .rung(
                    "10 x 10 x 3, 0.2 ms",
                    2.0,
                    &["cells=(10, 10, 3)", "time.dt=2e-4"],
                )
                .rung("20 x 20 x 6, 0.1 ms (the scene)", 1.0, &[]),
            Ladder::over_dt(
                "step, 10 x 10 x 3",
                &[4e-4, 2e-4, 1e-4, 5e-5],
                &["cells=(10, 10, 3)"],
            ),
        ],
        measure: |ran: &Ran| {
            let moment = ran.curve("t", "moment.ground.z")?;
            let sizes: Vec<(f64, f64)> = moment.into_iter().map(|(t, m)| (t, m.abs())).collect();
            let top = peak(&sizes).map_or(f64::NAN, |p| p.1);
            Ok(vec![
                Found::open("friction", "mJ", 1e3 * ran.end("dissipation.friction")?),
                Found::open("largest moment", "N mm", 1e3 * top),
            ])
        },
    }
}
