//! A cube thrown at a rigid wall under two schemes; an observer of one's own keeps the curves, printed side by side.

use std::error::Error;

use hyperelastic::{ElasticConstants, NeoHookean};
use nscd::contact_bipotential::{Interface, Master, Obstacle, Shape};
use nscd::fe_core::{BoxMesh, Motion, Solid, Surface, solid_block};
use nscd::nalgebra::Vector3;
use nscd::{ContactLevel, Model, NoClock, Observer, Rejection, Scheme, Span};
use nscd::{State, StepReport, Stepper, Totals, march};

/// Keeps a curve: time \[ms\], force of the wall \[N\], energy over the energy at the start \[-\].
#[derive(Default)]
struct Curve {
    points: Vec<[f64; 3]>,
    rejected: usize,
}

impl Observer for Curve {
    fn accepted(
        &mut self,
        _: &Stepper<'_>,
        state: &State,
        report: &StepReport,
        totals: &Totals,
    ) -> Result<(), Box<dyn Error + Send + Sync>> {
        let energy = (state.kinetic_energy + state.strain_energy) / totals.initial_energy;
        let force = report.interfaces[0].force;
        self.points.push([1e3 * state.time, force.z, energy]);
        Ok(())
    }

    fn rejected(&mut self, _: &Rejection) {
        self.rejected += 1;
    }
}

fn cube(scheme: Scheme) -> Result<Model, Box<dyn Error>> {
    let mesh = BoxMesh::uniform([0.0; 3], [0.1; 3], [3, 3, 3])
        .generate("cube")?
        .validated()?;
    let base = Surface::new(mesh.facet_set("z_min")?.to_vec())?;
    let area = base.tributary_areas(&mesh);
    let law = NeoHookean::new(ElasticConstants::from_shear_lame(4e5, 6e5)?)?;
    let block = solid_block(&mesh, 0, law, 1000.0)?;
    let (point, normal) = (Vector3::new(0.0, 0.0, -1e-3), Vector3::z());
    let wall = Obstacle::new(Shape::Plane { point, normal }, Motion::still())?;
    let interface = Interface::new("wall", base.nodes, area, Master::Obstacle(wall), 0.02);
    let model = Model::new(Solid::new(mesh, vec![block])?);
    Ok(model.with_interface(interface).with_scheme(scheme))
}

/// Throws the cube at 2 m/s and prints the balance.
fn throw(name: &str, scheme: Scheme) -> Result<Curve, Box<dyn Error>> {
    let model = cube(scheme)?;
    let mut stepper = Stepper::new(&model, Box::new(NoClock))?;
    let mut state = stepper.initial_state([0.0, 0.0, -2.0].repeat(model.dof_count() / 3))?;
    let (mut curve, mut totals) = (Curve::default(), Totals::default());
    let (end, dt) = (0.02, 2.5e-4);
    let span = Span::new(end, dt);
    march(&mut stepper, &mut state, span, &mut totals, &mut curve)?;
    println!(
        "contact at the {name} level, rejected steps: {}",
        curve.rejected
    );
    println!("  deepest penetration {:.1e} m", totals.max_penetration);
    println!("  energy at the start {:.2} J", totals.initial_energy);
    println!("  loss of the impacts {:.2e} J", totals.energy.impact);
    println!("  left open {:.0e} J", totals.energy.imbalance());
    Ok(curve)
}

fn main() -> Result<(), Box<dyn Error>> {
    let position = Scheme::dynamic(0.5, 0.5);
    let velocity = position.with_contact(ContactLevel::Velocity);
    let (a, b) = (throw("position", position)?, throw("velocity", velocity)?);
    println!("\n  t [ms]   position: F [N]  E/E0    velocity: F [N]  E/E0");
    for ([t, f, e], [_, g, h]) in a.points.iter().zip(&b.points).step_by(4) {
        println!("{t:8.2} {f:16.1} {e:6.3} {g:18.1} {h:6.3}");
    }
    Ok(())
}
