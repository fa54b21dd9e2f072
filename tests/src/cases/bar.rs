//! Elastic bars against a rigid wall and against each other.

use crate::closed_form::{BarImpact, bar_exchange, bar_on_clamped_bar, bar_on_wall};
use crate::curve::{Curve, mean};
use crate::{Case, Found, Ladder, Ran};

/// Bar on a rigid wall: contact time `2 L / c`, force `rho c v A`.
pub fn on_a_wall() -> Case {
    let steps = [0.02, 0.01, 0.005];
    Case {
        name: "bar-impact",
        about: "An elastic bar hits a rigid wall: contact lasts 2 L/c = 2 s with the force rho c v A = 1 N, and no energy is \
                lost. The force is its mean over the middle 80 % of the contact, its scatter the largest deviation there. The wave \
                front that ends the contact is some elements wide: half of the force is where it is, the last force where it ends.",
        scene: "bar-impact",
        sets: Vec::new(),
        ladders: vec![
            Ladder::over_dt("step, velocity level", &steps, &[]),
            Ladder::over_dt("step, position level", &steps, &["time.contact=Position"]),
            Ladder::over_dt(
                "step, backward Euler",
                &steps,
                &["time.contact=Position", "time.theta=1.0", "time.xi=1.0"],
            ),
            Ladder::new("mesh with step h/2c, velocity level")
                .rung("50", 2.0, &["cells=(50, 1, 1)", "time.dt=0.01"])
                .rung("100", 1.0, &["cells=(100, 1, 1)", "time.dt=0.005"])
                .rung("200", 0.5, &["cells=(200, 1, 1)", "time.dt=0.0025"]),
        ],
        measure: |ran| {
            measure(
                ran,
                "force.wall.x",
                bar_on_wall(1.0, 1.0, 1.0e8, 1.0e-4, 1.0e-4),
            )
        },
    }
}

/// Bar on an equal bar that is clamped at its far end: contact time `4 L / c`, half the force.
pub fn on_a_clamped_bar() -> Case {
    Case {
        name: "bar-on-bar",
        about: "An elastic bar hits an equal one that is clamped at its far end: contact lasts 4 L/c = 4 s with the force \
                rho c v A / 2 = 50 N, then the bar flies back with all the energy. Measured as for the rigid wall; the velocity is the mean over the bar.",
        scene: "bar-on-bar",
        sets: Vec::new(),
        ladders: vec![
            mesh_ladder("mesh with step h/2c, velocity level", &[]),
            mesh_ladder(
                "mesh with step h/2c, position level",
                &["time.contact=Position"],
            ),
            mesh_ladder(
                "mesh with step h/2c, backward Euler",
                &["time.theta=1.0", "time.xi=1.0"],
            ),
        ],
        measure: |ran| {
            let exact = bar_on_clamped_bar(1.0, 1.0, 1.0e6, 1.0e-4);
            let mut found = measure(ran, "force.joint.x", exact)?;
            let [back, _] = mean_velocities(ran);
            found.push(Found::exact("striker flies back", "m/s", back, -1.0e-4));
            Ok(found)
        },
    }
}

/// Two equal free bars: contact time `2 L / c`, then they have exchanged their velocities.
pub fn exchange() -> Case {
    Case {
        name: "bar-exchange",
        about: "An elastic bar hits an equal free one: after 2 L/c = 2 s with the force rho c v A / 2 = 50 N the first is at rest \
                and the second flies at v. Mean velocities, from the momenta.",
        scene: "bar-on-bar",
        sets: ["motions={}", "time.end=3.0"].map(str::to_owned).to_vec(),
        ladders: vec![mesh_ladder("mesh with step h/2c, velocity level", &[])],
        measure: |ran| {
            let exact = bar_exchange(1.0, 1.0, 1.0e6, 1.0e6, 1.0e-4);
            let mut found = measure(ran, "force.joint.x", exact)?;
            let [striker, struck] = mean_velocities(ran);
            found.push(Found::zero("striker at the end", "m/s", striker, 1.0e-4));
            found.push(Found::exact("struck at the end", "m/s", struck, 1.0e-4));
            Ok(found)
        },
    }
}

/// A free bar of four times the impedance of the striker: `v Z1 Z2 / (Z1 + Z2)` until the waves from the far ends are
/// back.
pub fn impedances() -> Case {
    Case {
        name: "bar-impedance",
        about: "An elastic bar hits a free one of four times its impedance and twice its wave speed, twice as long: the force is \
                v Z1 Z2 / (Z1 + Z2) = 80 N until the waves from both far ends are back after 2 s and end the contact.",
        scene: "bar-on-bar",
        sets: [
            "motions={}",
            "time.end=3.0",
            "struck.law=SaintVenantKirchhoff(E: 8.0e8, nu: 0.0)",
            "materials.struck.density=2.0e8",
            "struck.mesh.max=(2.0, 0.01)",
        ]
        .map(str::to_owned)
        .to_vec(),
        ladders: vec![mesh_ladder("mesh with step h/2c, velocity level", &[])],
        measure: |ran| {
            measure(
                ran,
                "force.joint.x",
                bar_exchange(1.0, 1.0, 1.0e6, 4.0e6, 1.0e-4),
            )
        },
    }
}

fn mesh_ladder(name: &str, sets: &[&str]) -> Ladder {
    let rungs = [(50, 0.01, 4.0), (100, 0.005, 2.0), (200, 0.0025, 1.0)];
    rungs
        .iter()
        .fold(Ladder::new(name), |ladder, (cells, dt, size)| {
            let own = [
                format!("striker.mesh.cells=({cells}, 1)"),
                format!("struck.mesh.cells=({cells}, 1)"),
                format!("time.dt={dt:e}"),
            ];
            let own = own.iter().map(String::as_str);
            let sets: Vec<&str> = own.chain(sets.iter().copied()).collect();
            ladder.rung(format!("{cells}"), *size, &sets)
        })
}

fn measure(ran: &Ran, force: &str, exact: BarImpact) -> Result<Vec<Found>, String> {
    let force: Curve = ran.curve("t", force)?;
    let force: Curve = force.into_iter().map(|(t, f)| (t, f.abs())).collect();
    let total = ran.column("energy.kinetic")?[0];
    let (kinetic, strain) = (ran.end("energy.kinetic")?, ran.end("energy.strain")?);
    let (from, to) = (0.1 * exact.duration, 0.9 * exact.duration);
    let middle: Curve = force
        .iter()
        .copied()
        .filter(|p| p.0 >= from && p.0 <= to)
        .collect();
    let plateau = mean(&middle).unwrap_or(f64::NAN);
    let deviation = middle.iter().map(|p| (p.1 - exact.force).abs());
    let scatter = deviation.fold(0.0, f64::max);
    Ok(vec![
        Found::exact(
            "contact time",
            "s",
            last_above(&force, 0.5 * exact.force),
            exact.duration,
        ),
        Found::exact(
            "last force",
            "s",
            last_above(&force, 1e-6 * exact.force),
            exact.duration,
        ),
        Found::exact("force", "N", plateau, exact.force),
        Found::zero("scatter of the force", "N", scatter, exact.force),
        Found::exact("energy at the end", "J", kinetic + strain, total),
    ])
}

/// When a force falls below a value for the last time \[s\].
fn last_above(force: &[(f64, f64)], value: f64) -> f64 {
    let mut pairs = force.windows(2).rev();
    let found = pairs.find(|w| w[0].1 > value && w[1].1 <= value);
    found.map_or(f64::NAN, |w| {
        let ((t0, f0), (t1, f1)) = (w[0], w[1]);
        t0 + (t1 - t0) * (f0 - value) / (f0 - f1)
    })
}

/// Mean velocity along x of each of two bodies at the end \[m/s\].
fn mean_velocities(ran: &Ran) -> [f64; 2] {
    let model = &ran.built.model;
    let momentum = |body: &[u32], v: &[f64]| -> f64 {
        let mut p = vec![0.0; v.len()];
        model.mass.times(v, &mut p);
        body.iter().map(|n| p[2 * *n as usize]).sum()
    };
    let unit: Vec<f64> = (0..ran.last.v.len())
        .map(|i| f64::from(i % 2 == 0))
        .collect();
    let bodies = model.solid.bodies();
    [0, 1].map(|b| momentum(&bodies[b], &ran.last.v) / momentum(&bodies[b], &unit))
}
