//! An elastic block that meets a rigid ball obliquely.

use crate::closed_form::Oblique;
use crate::{Case, Found, Ladder, Ran};

/// Height of the middle of the block above the contact \[m\].
const LEVER: f64 = 0.02;
/// Velocity that gives `psi = 1` \[m/s\].
const UNIT: f64 = 0.3 * 1.7 / 1.4 * 0.0107;

/// A mesh with three cells a contact radius instead of five and twice the step: a run of a second.
pub const COARSE: [&str; 2] = [
    "block.mesh=SolidGrid(x: (from: -0.02, pieces: [Cells(to: -1.2e-3, cells: 5, grading: 0.02), Cells(to: 1.2e-3, cells: 6), \
     Cells(to: 0.02, cells: 5, grading: 50.0)]), y: (from: 0.0, pieces: [Cells(to: 1.2e-3, cells: 3), \
     Cells(to: 0.02, cells: 5, grading: 50.0)]), z: (from: 0.0, pieces: [Cells(to: 0.8e-3, cells: 2), \
     Cells(to: 0.04, cells: 6, grading: 70.0)]))",
    "time.dt=2e-5",
];

/// Maw, Barber and Fawcett: how the tangential velocity of the contact leaves, from sticking to sliding throughout.
pub fn oblique() -> Case {
    let at = |ladder: Ladder, psi: f64| {
        let velocity = format!("block.velocity=({:e}, 0.0, -0.0107)", psi * UNIT);
        ladder.rung(format!("psi = {psi}"), psi, &[&velocity])
    };
    let coarse = |ladder: Ladder, psi: f64| {
        let velocity = format!("block.velocity=({:e}, 0.0, -0.0107)", psi * UNIT);
        ladder.rung(
            format!("psi = {psi}"),
            psi,
            &[COARSE[0], COARSE[1], &velocity],
        )
    };
    let angles = [0.5, 1.0, 2.0, 3.0, 4.0];
    Case {
        name: "oblique-impact",
        about: "An elastic cube meets a rigid ball under an angle psi = 2 (1 - nu) V_t/(mu (2 - nu) V_n), chi = 1.0294: Maw, Barber and \
                Fawcett 1976. The closed form psi - 4 chi holds from psi = 3.118 on; below, the reference is an independent computation with \
                a row of springs. The error of psi after the impact is absolute. Friction over mu^2 m V_n^2; restitution is that of the \
                normal velocity, 1 without vibrations.",
        scene: "oblique-impact",
        sets: Vec::new(),
        ladders: vec![
            angles.into_iter().fold(Ladder::new("angle"), at),
            angles
                .into_iter()
                .fold(Ladder::new("angle, coarse mesh"), coarse),
            Ladder::over_dt("step, psi = 2.00", &[2e-5, 1e-5, 5e-6], &[]),
        ],
        measure,
    }
}

fn measure(ran: &Ran) -> Result<Vec<Found>, String> {
    let body = RigidMotion::of(ran, &ran.last.v);
    let start = RigidMotion::of(ran, &ran.built.velocity);
    let (mu, normal) = (ran.scene.interfaces["contact"].mu, -start.velocity[1]);
    let theory = Oblique {
        nu: 0.3,
        mobility: 1.0 + body.mass * LEVER * LEVER / body.inertia,
    };
    let psi =
        |motion: &RigidMotion| theory.psi(mu, motion.velocity[0] - motion.spin * LEVER, normal);
    let exact = theory.rebound(psi(&start));
    let friction = ran.end("dissipation.friction")? / (mu * mu * body.mass * normal * normal);
    Ok(vec![
        Found {
            relative_to: Some(1.0),
            ..Found::exact("psi after", "-", psi(&body), exact.psi)
        },
        Found::exact("friction", "-", friction, exact.loss),
        Found::exact("restitution", "-", body.velocity[1] / normal, 1.0),
    ])
}

/// Mean motion in the plane of symmetry.
struct RigidMotion {
    /// \[kg\]
    mass: f64,
    /// About the y axis through the middle \[kg m^2\].
    inertia: f64,
    /// Along x and z \[m/s\].
    velocity: [f64; 2],
    /// About the y axis \[rad/s\].
    spin: f64,
}

impl RigidMotion {
    /// Of these nodal velocities \[m/s\] on the reference positions: it moves by a ten-thousandth of its size.
    fn of(ran: &Ran, v: &[f64]) -> RigidMotion {
        let model = &ran.built.model;
        let points = &model.solid.mesh().points;
        let momenta = |v: &[f64]| -> [f64; 3] {
            let mut p = vec![0.0; v.len()];
            model.mass.times(v, &mut p);
            let nodes = points.iter().zip(p.chunks_exact(3));
            nodes.fold([0.0; 3], |sum, (x, p)| {
                let moment = (x[2] - LEVER) * p[0] - x[0] * p[2];
                [sum[0] + p[0], sum[1] + p[2], sum[2] + moment]
            })
        };
        let field =
            |f: &dyn Fn(&[f64; 3]) -> [f64; 3]| -> Vec<f64> { points.iter().flat_map(f).collect() };
        let mass = momenta(&field(&|_| [1.0, 0.0, 0.0]))[0];
        let inertia = momenta(&field(&|x| [x[2] - LEVER, 0.0, -x[0]]))[2];
        let [x, z, moment] = momenta(v);
        RigidMotion {
            mass,
            inertia,
            velocity: [x / mass, z / mass],
            spin: moment / inertia,
        }
    }
}
