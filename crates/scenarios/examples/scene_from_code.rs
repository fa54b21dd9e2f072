//! A scene built in code instead of a file, run in memory: a rubber block falls on a rigid plane and bounces.
//! `cargo run -p scenarios --example scene_from_code`
//!
//! The checks are those of a file. Nothing is written; a probe tells where the lowest corner is.

use std::error::Error;

use nscd::{NoClock, Observer, State, StepReport, Stepper, Totals, march};
use scenarios::output::Row;
use scenarios::spec::{
    Body, ContactLevel, ElasticPair, Interface, Law, LoadedScene, Master, Material, Mesh, Probe,
    Quantity, RectangleMesh, Scene, Time,
};
use scenarios::{Built, build, first_row, row};

/// Steps between two printed lines.
const EVERY: u64 = 20;

fn main() -> Result<(), Box<dyn Error>> {
    let loaded = LoadedScene::new("falling-block", falling_block())?;
    let (scene, built) = (&loaded.scene, build(&loaded)?);
    let mut stepper = Stepper::new(&built.model, Box::new(NoClock))?;
    let mut state = stepper.initial_state(built.velocity.clone())?;
    println!("    t [s]  corner y [mm]  corner v_y [m/s]  force [N]  energy [J]");
    print(&first_row(scene, &built, &state));
    let (span, built, mut totals) = (built.span, &built, Totals::default());
    let mut watcher = Watcher { scene, built };
    march(&mut stepper, &mut state, span, &mut totals, &mut watcher)?;
    let (steps, depth) = (stepper.counters().steps, totals.max_penetration);
    println!("\n{steps} steps, deepest penetration {depth:.1e} m");
    Ok(())
}

fn print(row: &Row) {
    // Displacement x, y, z, then velocity x, y, z.
    let (height, velocity) = (1e3 * row.probes[1], row.probes[4]);
    let (time, force, energy) = (row.time, row.forces[0].force[1], row.energies.stored());
    println!("{time:9.4}  {height:13.3}  {velocity:16.4}  {force:9.1}  {energy:10.6}");
}

/// A square of 10 cm that falls at 1 m/s from 1 mm above the plane.
fn falling_block() -> Scene {
    let rubber = Material {
        law: Law::NeoHookean(ElasticPair::young_poisson(1e6, 0.4)),
        density: 1000.0,
    };
    let square = RectangleMesh::uniform([0.0, 0.0], [0.1, 0.1], [4, 4]);
    let mut block = Body::new(Mesh::Rectangle(square), "rubber");
    block.velocity = [0.0, -1.0, 0.0];
    let plane = Master::Plane {
        point: [0.0, -1e-3, 0.0],
        normal: [0.0, 1.0, 0.0],
    };
    let mut ground = Interface::new("block.y_min", plane);
    ground.mu = 0.3;
    let corner = Probe {
        body: "block".into(),
        node: [0.0; 3],
        quantities: vec![Quantity::Displacement, Quantity::Velocity],
    };
    let mut time = Time::new(0.02, 1e-4);
    time.contact = ContactLevel::Velocity;
    let mut scene = Scene::new("A rubber block falls on a rigid plane", time);
    scene.materials.insert("rubber".into(), rubber);
    scene.bodies.insert("block".into(), block);
    scene.interfaces.insert("ground".into(), ground);
    scene.output.probes.insert("corner".into(), corner);
    scene
}

/// Prints some rows of what `history.csv` would say.
struct Watcher<'a> {
    scene: &'a Scene,
    built: &'a Built,
}

impl Observer for Watcher<'_> {
    fn accepted(
        &mut self,
        stepper: &Stepper<'_>,
        state: &State,
        report: &StepReport,
        totals: &Totals,
    ) -> Result<(), Box<dyn Error + Send + Sync>> {
        if stepper.counters().steps.is_multiple_of(EVERY) {
            print(&row(self.scene, self.built, state, report, totals));
        }
        Ok(())
    }
}
