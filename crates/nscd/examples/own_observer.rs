//! A cube thrown at a rigid wall under two schemes; an observer of one's own keeps the curves, which are printed side by side.

use std::error::Error;

use hyperelastic::{ElasticConstants, NeoHookean};
use nscd::contact_bipotential::{Interface, Master, Obstacle, Shape};
use nscd::fe_core::{BoxMesh, Motion, Solid, Surface, solid_block};
use nscd::nalgebra::Vector3;
use nscd::{
    ContactLevel, Model, NoClock, NscdError, Observer, Rejection, Scheme, Span, State, StepReport,
    Stepper, Totals, march,
};

/// Speed of the throw \[m/s\].
const SPEED: f64 = 2.0;

/// Keeps a curve: time \[s\], force of the wall \[N\], energy over the energy at the start \[-\].
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
        let energy = state.kinetic_energy + state.strain_energy;
        let force = report.interfaces[0].force[2];
        self.points
            .push([state.time, force, energy / totals.initial_energy]);
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
    let plane = Shape::Plane {
        point: Vector3::new(0.0, 0.0, -1e-3),
        normal: Vector3::z(),
    };
    let wall = Master::Obstacle(Obstacle::new(plane, Motion::still())?);
    let interface = Interface::new("wall", base.nodes, area, wall, 0.02);
    let model = Model::new(Solid::new(mesh, vec![block])?);
    Ok(model.with_interface(interface).with_scheme(scheme))
}

fn throw(model: &Model) -> Result<(Curve, Totals), NscdError> {
    let mut stepper = Stepper::new(model, Box::new(NoClock))?;
    let velocity = [0.0, 0.0, -SPEED].repeat(model.dof_count() / 3);
    let mut state = stepper.initial_state(velocity)?;
    let (mut curve, mut totals) = (Curve::default(), Totals::default());
    let span = Span {
        end: 0.02,
        dt: 2.5e-4,
    };
    march(&mut stepper, &mut state, span, &mut totals, &mut curve)?;
    Ok((curve, totals))
}

fn main() -> Result<(), Box<dyn Error>> {
    let trapezoidal = Scheme::dynamic(0.5, 0.5);
    let schemes = [
        ("position", trapezoidal),
        ("velocity", trapezoidal.with_contact(ContactLevel::Velocity)),
    ];
    let mut runs = Vec::new();
    for (name, scheme) in schemes {
        let (curve, totals) = throw(&cube(scheme)?)?;
        println!(
            "contact at the {name} level: loss of the impacts {:.2e} J of {:.2} J, deepest penetration {:.1e} m, open {:.0e} J, \
             rejected steps {}",
            totals.energy.impact,
            totals.initial_energy,
            totals.max_penetration,
            totals.energy.imbalance(),
            curve.rejected,
        );
        runs.push(curve.points);
    }
    println!("\n  t [ms]   position: F [N]  E/E0    velocity: F [N]  E/E0");
    for (a, b) in runs[0].iter().zip(&runs[1]).step_by(4) {
        println!(
            "{:8.2} {:16.1} {:6.3} {:18.1} {:6.3}",
            1e3 * a[0],
            a[1],
            a[2],
            b[1],
            b[2]
        );
    }
    Ok(())
}
