//! Rigid indenters with an edge or a tip on a half-space: cone and flat punch.

use scenarios::spec::{Law, Master, Motion};

use crate::closed_form::{
    Cubic, cone_force, cone_pressure, cone_radius, cone_strain_slope, cubic_of_neo_hookean,
    cubic_of_saint_venant_kirchhoff, punch_force, punch_pressure,
};
use crate::traction::tractions;
use crate::{Case, Found, Ladder, Ran};

/// Of both scenes \[Pa\].
const E: f64 = 1.0e7;
/// Radius of the contact at the end, and of the punch \[m\].
const RADIUS: f64 = 1.0e-3;
/// Of the flat punch \[-\].
const PUNCH_NU: f64 = 0.3;
/// Parts of the radius between which pressures are compared: outside of them a node's share reaches over the tip or the
/// edge.
const COMPARED: [f64; 2] = [0.15, 0.85];

/// A law that, other than that of the scene, does not soften under the tip.
pub const NEO_HOOKEAN: &str = "materials.block.law=NeoHookean(E: 1.0e7, nu: 0.495)";

/// The law of the scene.
pub const OF_THE_PAPER: &str = "materials.block.law=SaintVenantKirchhoff(E: 1.0e7, nu: 0.495)";

/// The cone of 85 degrees: strains are small, but not nothing.
pub fn cone() -> Case {
    Case {
        name: "cone",
        about: "A rigid cone of 85 degrees on an elastic half-space, nu = .495: P/d^2 over that of small strains, mean over the depths \
                from half of the way on; the same over what it should be with the first effect of finite strain, 1 + c cot(alpha); \
                pressure over that of small strains, mean over the nodes between .15 and .85 of the radius. \
                c is the change of the energy by its terms of third order in the field of small strains, and depends on the law. [Feng2007, 4.1]",
        scene: "cone",
        sets: [
            &cone_at(85.0)[..],
            &block_of(2500.0),
            &["refine=2".to_owned()],
        ]
        .concat(),
        ladders: vec![
            cone_meshes("mesh, neo-Hookean", 85.0, &[1, 2, 3], NEO_HOOKEAN),
            cone_blocks(),
            cone_angles("angle, Saint Venant-Kirchhoff", OF_THE_PAPER).of_order(1.0),
            cone_angles("angle, neo-Hookean", NEO_HOOKEAN),
            cone_ratios(),
            cone_meshes(
                "mesh, 60 degrees, Saint Venant-Kirchhoff",
                60.0,
                &[1, 2],
                OF_THE_PAPER,
            ),
            cone_meshes("mesh, 60 degrees, neo-Hookean", 60.0, &[1, 2], NEO_HOOKEAN),
        ],
        measure: |ran| {
            let (coefficient, spread) = cone_coefficient(ran)?;
            let expected = cone_with_strain(ran)?;
            Ok(vec![
                Found::exact("P/d^2", "-", coefficient, 1.0),
                Found::exact("P/d^2 with finite strain", "-", coefficient / expected, 1.0),
                Found::exact("pressure", "-", cone_pressures(ran)?, 1.0),
                Found::zero("spread of P/d^2", "-", spread, 1.0),
            ])
        },
    }
}

fn cone_meshes(name: &str, degrees: f64, factors: &[u32], law: &str) -> Ladder {
    let rung = |ladder: Ladder, refine: &u32| {
        let mut sets = cone_at(degrees).to_vec();
        sets.extend([format!("refine={refine}"), law.to_owned()]);
        let label = format!("{} elements on the radius", 10 * refine);
        with(ladder, label, 2.0 / f64::from(*refine), &sets)
    };
    factors.iter().fold(Ladder::new(name), rung)
}

fn cone_blocks() -> Ladder {
    let rung = |ladder: Ladder, radii: f64| {
        let mut sets = block_of(radii).to_vec();
        sets.push(NEO_HOOKEAN.to_owned());
        with(ladder, format!("{radii} a"), 1.0 / radii, &sets)
    };
    let name = "radius of the block, neo-Hookean";
    [20.0, 100.0, 500.0, 2500.0]
        .into_iter()
        .fold(Ladder::new(name), rung)
}

fn cone_angles(name: &str, law: &str) -> Ladder {
    let rung = |ladder: Ladder, degrees: f64| {
        let mut sets = cone_at(degrees).to_vec();
        sets.push(law.to_owned());
        let size = (90.0_f64 - degrees) / 5.0;
        with(ladder, format!("{degrees} degrees"), size, &sets)
    };
    [80.0, 85.0, 87.5, 89.0]
        .into_iter()
        .fold(Ladder::new(name), rung)
}

/// Ratios of Poisson at which the neo-Hookean law stiffens and at which it softens.
fn cone_ratios() -> Ladder {
    let rung = |ladder: Ladder, nu: f64| {
        let law = format!("materials.block.law=NeoHookean(E: 1.0e7, nu: {nu})");
        with(ladder, format!("nu = {nu}"), 1.0 - 2.0 * nu, &[law])
    };
    [0.3, 0.45]
        .into_iter()
        .fold(Ladder::new("Poisson's ratio, neo-Hookean"), rung)
}

fn with(ladder: Ladder, label: String, size: f64, sets: &[String]) -> Ladder {
    let sets: Vec<&str> = sets.iter().map(String::as_str).collect();
    ladder.rung(label, size, &sets)
}

/// Values with which the cone of the scene has another angle, and the same radius of contact at the end.
pub fn cone_at(degrees: f64) -> [String; 2] {
    let depth = RADIUS / cone_radius(degrees.to_radians(), 1.0);
    [
        format!("contact.master.semi_apex_angle={degrees:?}"),
        format!(
            "contact.motion.translation=(0.0, [(0.0, 0.0), (1.0, {:?})], 0.0)",
            -depth
        ),
    ]
}

/// Values with which the block has another size, in radii of contact.
pub fn block_of(radii: f64) -> [String; 2] {
    let size = radii * RADIUS;
    [
        format!("block.mesh.x.pieces.1.to={size:?}"),
        format!("block.mesh.y.pieces.1.to={:?}", -size),
    ]
}

/// What is pressed, and how.
struct Pressing {
    /// `E/(1 - nu^2)` \[Pa\].
    e_star: f64,
    /// Half of the angle of the cone \[rad\].
    angle: f64,
    /// At the end \[m\].
    depth: f64,
    nu: f64,
    cubic: Cubic,
}

fn cone_of(ran: &Ran) -> Result<Pressing, String> {
    let interface = ran.scene.interfaces.get("contact").ok_or("no contact")?;
    let (
        Master::Cone {
            semi_apex_angle, ..
        },
        Motion::Move { translation, .. },
    ) = (&interface.master, &interface.motion)
    else {
        return Err("not a cone that moves".to_owned());
    };
    let material = ran.scene.materials.get("block").ok_or("no block")?;
    let (nu, cubic): (Option<f64>, Cubic) = match &material.law {
        Law::SaintVenantKirchhoff(elastic) => (elastic.nu, cubic_of_saint_venant_kirchhoff),
        Law::NeoHookean(elastic) => (elastic.nu, cubic_of_neo_hookean),
        _ => (None, cubic_of_neo_hookean),
    };
    let nu = nu.ok_or("the block has no Poisson's ratio")?;
    Ok(Pressing {
        e_star: E / (1.0 - nu * nu),
        angle: semi_apex_angle.to_radians(),
        depth: translation[1].points().last().map_or(f64::NAN, |p| -p.1),
        nu,
        cubic,
    })
}

/// `1 + c cot(alpha)`: force over that of small strains that the law should give, to the first order in the strains.
///
/// # Errors
/// The run is not one of a cone.
pub fn cone_with_strain(ran: &Ran) -> Result<f64, String> {
    let cone = cone_of(ran)?;
    Ok(1.0 + cone_strain_slope(cone.cubic, cone.nu) / cone.angle.tan())
}

/// Force over that of small strains, and the largest less the least: from depth to depth a node more or less is in
/// contact, so the mean over the depths from half of the way on.
///
/// # Errors
/// The run is not one of a cone.
pub fn cone_coefficient(ran: &Ran) -> Result<(f64, f64), String> {
    let Pressing {
        e_star,
        angle,
        depth,
        ..
    } = cone_of(ran)?;
    let force = ran.curve("t", "force.contact.y")?;
    let later = force.iter().filter(|p| p.0 > 0.5);
    let ratios: Vec<f64> = later
        .map(|(t, f)| -f / cone_force(e_star, angle, depth * t))
        .collect();
    let mean = ratios.iter().sum::<f64>() / ratios.len() as f64;
    let (least, most) = ratios
        .iter()
        .fold((f64::MAX, 0.0_f64), |(a, b), r| (a.min(*r), b.max(*r)));
    Ok((mean, most - least))
}

/// Distance from the axis over the radius of contact, and pressure over `E*/2 cot(alpha)`, at the end of a run.
///
/// # Errors
/// The run is not one of a cone.
pub fn cone_profile(ran: &Ran) -> Result<Vec<(f64, f64)>, String> {
    let Pressing {
        e_star,
        angle,
        depth,
        ..
    } = cone_of(ran)?;
    let a = cone_radius(angle, depth);
    let unit = 0.5 * e_star / angle.tan();
    let all = tractions(ran, &ran.last).into_iter();
    Ok(all.map(|t| (t.r / a, t.pressure / unit)).collect())
}

fn cone_pressures(ran: &Ran) -> Result<f64, String> {
    // In these units the pressure is acosh(1/s).
    let exact = |s: f64| cone_pressure(2.0, std::f64::consts::FRAC_PI_4, 1.0, s);
    Ok(mean_ratio(cone_profile(ran)?, exact))
}

fn mean_ratio(profile: Vec<(f64, f64)>, exact: impl Fn(f64) -> f64) -> f64 {
    let compared = profile
        .into_iter()
        .filter(|p| p.0 > COMPARED[0] && p.0 < COMPARED[1]);
    let ratios: Vec<f64> = compared.map(|(s, p)| p / exact(s)).collect();
    ratios.iter().sum::<f64>() / ratios.len() as f64
}

/// A flat punch.
pub fn punch() -> Case {
    let large = block_of(2500.0);
    let large: Vec<&str> = large.iter().map(String::as_str).collect();
    let uniform = [
        "block.mesh.x.pieces.0.grading=1.0",
        "block.mesh.y.pieces.0.grading=1.0",
    ];
    let uniform: Vec<&str> = uniform.into_iter().chain(large.iter().copied()).collect();
    Case {
        name: "flat-punch",
        about: "A flat rigid punch on an elastic half-space, nu = .3: force at a small depth, and pressure over that of small strains, mean \
                over the nodes between .15 and .85 of the radius. The pressure is singular at the edge: equal elements have an error of \
                order 1 there, graded ones hardly any.",
        scene: "flat-punch",
        sets: Vec::new(),
        ladders: vec![
            Ladder::over_refine("mesh, graded towards the edge", &[1, 2, 4], &large),
            Ladder::over_refine("mesh, equal elements", &[1, 2, 4], &uniform),
        ],
        measure: |ran| {
            let e_star = E / (1.0 - PUNCH_NU * PUNCH_NU);
            let depth = ran.end("probe.center.displacement.y")?.abs();
            let force = -ran.end("force.contact.y")?;
            let exact = punch_force(e_star, RADIUS, depth);
            let profile = tractions(ran, &ran.last).into_iter();
            let profile = profile.map(|t| (t.r / RADIUS, t.pressure)).collect();
            let pressure = |s: f64| punch_pressure(force, RADIUS, s * RADIUS);
            Ok(vec![
                Found::exact("force", "N", force, exact),
                Found::exact("pressure", "-", mean_ratio(profile, pressure), 1.0),
            ])
        },
    }
}
