//! A rubber block pressed on a rigid plane with friction, without inertia. Prints forces and energies over the press.

use std::error::Error;

use hyperelastic::{ElasticConstants, NeoHookean};
use nscd::contact_bipotential::{Interface, Master, Obstacle, Shape};
use nscd::fe_core::{
    BoxMesh, Dirichlet, Interpolation, Motion, Solid, Surface, Table, solid_block,
};
use nscd::nalgebra::Vector3;
use nscd::{Model, NoClock, Observer, Scheme, Span, State, StepReport, Stepper, Totals, march};

/// Prints a line a step.
struct Printer;

impl Observer for Printer {
    fn accepted(
        &mut self,
        _: &Stepper<'_>,
        state: &State,
        report: &StepReport,
        totals: &Totals,
    ) -> Result<(), Box<dyn Error + Send + Sync>> {
        let [floor, top] = [report.interfaces[0].force, report.supports[0].force];
        println!(
            "{:5.2} {:12.3} {:12.3} {:10.5} {:10.5} {:10.5} {:9.1e}",
            state.time,
            floor[2],
            top[2],
            state.strain_energy,
            totals.energy.load_work,
            totals.energy.friction,
            totals.energy.imbalance(),
        );
        Ok(())
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    // The block: 0.1 m a side, soft rubber.
    let mesh = BoxMesh::uniform([0.0; 3], [0.1; 3], [4, 4, 4])
        .generate("block")?
        .validated()?;
    let base = Surface::new(mesh.facet_set("z_min")?.to_vec())?;
    let area = base.tributary_areas(&mesh);
    let law = NeoHookean::new(ElasticConstants::from_shear_lame(4e5, 1.6e6)?)?;
    let block = solid_block(&mesh, 0, law, 1000.0)?;

    // Its top is pressed down by 5 mm in one second.
    let down = Table::new(vec![(0.0, 0.0), (1.0, -0.005)], Interpolation::Linear)?;
    let press = Dirichlet::clamped("top", mesh.node_set("z_max")?.to_vec())
        .with_motion(Motion::translation([Table::zero(), Table::zero(), down]));

    // It stands on a rigid plane.
    let plane = Shape::Plane {
        point: Vector3::zeros(),
        normal: Vector3::z(),
    };
    let floor = Master::Obstacle(Obstacle::new(plane, Motion::still())?);
    let interface = Interface::new("floor", base.nodes, area, floor, 0.01).with_friction(0.2);

    let model = Model::new(Solid::new(mesh, vec![block])?)
        .with_support(press)
        .with_interface(interface)
        .with_scheme(Scheme::quasi_static());
    let mut stepper = Stepper::new(&model, Box::new(NoClock))?;
    let mut state = stepper.initial_state(vec![0.0; model.dof_count()])?;
    let mut totals = Totals::default();

    println!("  t [s]  floor F_z [N]  top F_z [N]  strain [J]   work [J]  friction [J]  open [J]");
    let span = Span::new(1.0, 0.1);
    march(&mut stepper, &mut state, span, &mut totals, &mut Printer)?;

    println!("\nEnergy terms of the run:");
    for (name, energy) in totals.energy.named() {
        println!("  {name:<14} {energy:12.3e} J");
    }
    println!("\n{:#?}", stepper.counters());
    Ok(())
}
