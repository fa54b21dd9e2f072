//! An elastic block that meets a rigid ball obliquely.

use nalgebra::Vector3;

use crate::closed_form::Oblique;
use crate::{Case, Found, Ladder, Ran};

/// Height of the middle of the block above the contact \[m\].
const LEVER: f64 = 0.02;
/// A mesh half as fine at the contact and twice the step: a run of a second.
pub const COARSE: [&str; 2] = [
    "block.mesh=SolidGrid(x: (from: -0.02, pieces: [Cells(to: -1.2e-3, cells: 5, grading: 0.02), Cells(to: 1.2e-3, cells: 6), \
     Cells(to: 0.02, cells: 5, grading: 50.0)]), y: (from: 0.0, pieces: [Cells(to: 1.2e-3, cells: 3), \
     Cells(to: 0.02, cells: 5, grading: 50.0)]), z: (from: 0.0, pieces: [Cells(to: 0.8e-3, cells: 2), \
     Cells(to: 0.04, cells: 6, grading: 70.0)]))",
    "time.dt=2e-5",
];

/// Cells of .12 mm at the contact instead of .2 mm.
const FINE: &str = "block.mesh=SolidGrid(x: (from: -0.02, pieces: [Cells(to: -1.2e-3, cells: 8, grading: 0.02), \
     Cells(to: 1.2e-3, cells: 20), Cells(to: 0.02, cells: 8, grading: 50.0)]), \
     y: (from: 0.0, pieces: [Cells(to: 1.2e-3, cells: 10), Cells(to: 0.02, cells: 8, grading: 50.0)]), \
     z: (from: 0.0, pieces: [Cells(to: 0.8e-3, cells: 7), Cells(to: 0.04, cells: 9, grading: 75.0)]))";

/// The value of the scene that makes an impact of this `psi`, with the Poisson's ratio `nu` of the block.
pub fn velocity(psi: f64, nu: f64) -> String {
    let tangential = psi * 0.3 * (2.0 - nu) / (2.0 * (1.0 - nu)) * 0.0107;
    format!("block.velocity=({tangential:e}, 0.0, -0.0107)")
}

/// Maw, Barber and Fawcett: how the tangential velocity of the contact leaves, from sticking to sliding throughout.
pub fn oblique() -> Case {
    let angles = |name: &str, sets: &[&str]| {
        let at = |ladder: Ladder, psi: f64| {
            let velocity = velocity(psi, 0.3);
            ladder.rung(
                format!("psi = {psi}"),
                psi,
                &[sets, &[velocity.as_str()]].concat(),
            )
        };
        [0.5, 1.0, 2.0, 3.0, 4.0]
            .into_iter()
            .fold(Ladder::new(name), at)
    };
    let coupling = |ladder: Ladder, (nu, psi): (f64, f64)| {
        let (ratio, velocity) = (format!("nu={nu}"), velocity(psi, nu));
        let sets = [COARSE[0], COARSE[1], &ratio, &velocity];
        ladder.rung(
            format!("nu = {nu}, psi = {psi}"),
            (1.0 - 2.0 * nu) / (2.0 - 2.0 * nu),
            &sets,
        )
    };
    let three = velocity(3.0, 0.3);
    Case {
        name: "oblique-impact",
        about: "An elastic cube meets a rigid ball under an angle psi = 2 (1 - nu) V_t/(mu (2 - nu) V_n), chi = 1.0294: Maw, Barber and \
                Fawcett 1976. The closed form psi - 4 chi holds from psi = 3.118 on; below, the reference is an independent computation with \
                a row of springs. The error of psi after the impact is absolute. Friction over mu^2 m V_n^2; restitution is that of the \
                normal velocity, 1 without vibrations. The last ladder is just below the limit of gross sliding.",
        scene: "oblique-impact",
        sets: Vec::new(),
        ladders: vec![
            angles("angle", &[]),
            angles("angle, coarse mesh", &COARSE),
            Ladder::new("cells on 2.4 contact radii, psi = 3")
                .rung("6", 2.0, &[COARSE[0], &three])
                .rung("12", 1.0, &[&three])
                .rung("20", 0.6, &[FINE, &three]),
            Ladder::over_dt("step, psi = 2", &[2e-5, 1e-5, 5e-6], &[&velocity(2.0, 0.3)]),
            [(0.0, 3.9), (0.3, 3.0), (0.45, 2.45)]
                .into_iter()
                .fold(Ladder::new("Poisson's ratio, coarse mesh"), coupling),
        ],
        measure,
    }
}

fn measure(ran: &Ran) -> Result<Vec<Found>, String> {
    let body = RigidMotion::of(ran, &ran.last.v);
    let start = RigidMotion::of(ran, &ran.built.velocity);
    let (mu, normal) = (ran.scene.interfaces["contact"].mu, -start.velocity[1]);
    let law = &ran.scene.materials["elastic"].law;
    let elastic = law.elastic_constants().map_err(|e| e.message)?;
    let theory = Oblique {
        nu: elastic.poisson_ratio(),
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
        let field = |f: &dyn Fn(&Vector3<f64>) -> [f64; 3]| -> Vec<f64> {
            points.iter().flat_map(f).collect()
        };
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
