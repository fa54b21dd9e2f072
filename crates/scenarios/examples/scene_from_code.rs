//! A scene built in code instead of a file, run in memory: a rubber block falls on a rigid plane and bounces.
//!
//! ```text
//! cargo run -p scenarios --example scene_from_code
//! ```
//!
//! The checks are those of a file. Nothing is written; a probe tells where the lowest corner is.

use std::error::Error;

use indexmap::IndexMap;
use nscd::{NoClock, Observer, State, StepReport, Stepper, Totals, march};
use scenarios::output::Row;
use scenarios::spec::{
    Body, ContactLevel, Interface, Law, LoadedScene, Master, Material, Mesh, Output, Probe,
    Quantity, RectangleMesh, Scene, Time,
};
use scenarios::{Built, build};
use scenarios::{first_row, row};

/// Steps between two printed lines.
const EVERY: usize = 20;

fn main() -> Result<(), Box<dyn Error>> {
    let loaded = LoadedScene::new("falling-block", falling_block())?;
    let built = build(&loaded)?;
    let mut stepper = Stepper::new(&built.model, Box::new(NoClock))?;
    let mut state = stepper.initial_state(built.velocity.clone())?;
    let start = first_row(&loaded.scene, &built, &state);
    let mut watcher = Watcher {
        scene: &loaded.scene,
        built: &built,
        rows: vec![start],
    };
    let mut totals = Totals::default();
    march(
        &mut stepper,
        &mut state,
        built.span,
        &mut totals,
        &mut watcher,
    )?;

    println!("    t [s]  corner y [mm]  corner v_y [m/s]  force [N]  energy [J]");
    for row in watcher.rows.iter().step_by(EVERY) {
        // Displacement x, y, z, then velocity x, y, z.
        let (height, velocity) = (row.probes[1], row.probes[4]);
        println!(
            "{:9.4}  {:13.3}  {:16.4}  {:9.1}  {:10.6}",
            row.time,
            1e3 * height,
            velocity,
            row.forces[0].force[1],
            row.energies.stored()
        );
    }
    println!(
        "\n{} steps, deepest penetration {:.1e} m",
        watcher.rows.len() - 1,
        totals.max_penetration
    );
    Ok(())
}

/// A square of 10 cm that falls at 1 m/s from 1 mm above the plane.
fn falling_block() -> Scene {
    let rubber = Material {
        law: Law::NeoHookean {
            E: Some(1e6),
            nu: Some(0.4),
            G: None,
            K: None,
            lambda: None,
        },
        density: 1000.0,
    };
    let block = Body {
        mesh: Mesh::Rectangle(RectangleMesh::uniform([0.0, 0.0], [0.1, 0.1], [4, 4])),
        material: "rubber".into(),
        velocity: [0.0, -1.0, 0.0],
        spin: [0.0; 3],
        dilatation: Default::default(),
    };
    let ground = Interface {
        slave: "block.y_min".into(),
        master: Master::Plane {
            point: [0.0, -1e-3, 0.0],
            normal: [0.0, 1.0, 0.0],
        },
        motion: Default::default(),
        mu: 0.3,
        restitution: 0.0,
        search_distance: None,
        adhesion: None,
    };
    let corner = Probe {
        body: "block".into(),
        node: [0.0; 3],
        quantities: vec![Quantity::Displacement, Quantity::Velocity],
    };
    Scene {
        materials: one("rubber", rubber),
        bodies: one("block", block),
        interfaces: one("ground", ground),
        output: Output {
            probes: one("corner", corner),
            ..Output::default()
        },
        ..Scene::new(
            "A rubber block falls on a rigid plane",
            Time {
                contact: ContactLevel::Velocity,
                ..Time::new(0.02, 1e-4)
            },
        )
    }
}

fn one<T>(name: &str, value: T) -> IndexMap<String, T> {
    IndexMap::from([(name.to_owned(), value)])
}

/// Keeps what `history.csv` would say.
struct Watcher<'a> {
    scene: &'a Scene,
    built: &'a Built,
    rows: Vec<Row>,
}

impl Observer for Watcher<'_> {
    fn accepted(
        &mut self,
        _: &Stepper<'_>,
        state: &State,
        report: &StepReport,
        totals: &Totals,
    ) -> Result<(), Box<dyn Error + Send + Sync>> {
        self.rows
            .push(row(self.scene, self.built, state, report, totals));
        Ok(())
    }
}
