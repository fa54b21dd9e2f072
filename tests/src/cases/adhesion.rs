//! Bonds against closed forms: pull-off of a ball from DMT towards JKR, pull of a rigid plate.

use std::f64::consts::PI;

use crate::closed_form::{DMT, bond_ramp, maugis_parameter, peel_force};
use crate::curve::{Curve, mean, peak};
use crate::{Case, Found, Ladder, Ran};

/// Pull-off force over `pi w R` for the bonds of the program on a half-space, over the Maugis parameter, as
/// [`half_space::pull_off`](crate::half_space::pull_off) finds it with 100 to 400 rings on `a0`.
pub const HALF_SPACE: [(f64, f64); 6] = [
    (0.1, 1.988),
    (0.3, 1.942),
    (0.6, 1.858),
    (1.0, 1.762),
    (2.0, 1.638),
    (3.0, 1.587),
];

/// Values that bring `pull-off` to a Maugis parameter of .1: weak bonds reach far, and the mesh has to.
pub const SMALL: [&str; 2] = [
    "C_n=3.391e7",
    "mesh.x=(from: 0.0, pieces: [Cells(to: 4.5e-3, cells: 40), Growing(to: 22.0e-3, growth: 1.06)])",
];

/// Values that let `pull-off` jump into contact and out of it, as the ball does at a Maugis parameter of 2 and of 3:
/// bonds with so little viscosity that the pull hardly sees it, a way that turns behind the largest pull, and rings for
/// the softening at 3.
pub const LARGE: [&str; 8] = [
    "b=4e-6",
    "adhesion.beta=0.0",
    "translation=(0.0, [(0.0, 4.0e-6), (0.4, 1.0e-6), (1.4, 4.3e-6)], 0.0)",
    "time.end=1.4",
    "time.min_dt=2e-6",
    "mesh.x=(from: 0.0, pieces: [Cells(to: 0.48e-3, cells: 40), Cells(to: 0.84e-3, cells: 108), Growing(to: 22.0e-3, growth: 1.2)])",
    "mesh.y=(from: 0.0, pieces: [Cells(to: -1.4e-5, cells: 4), Growing(to: -22.0e-3, growth: 1.4)])",
    "output.fields_every=Never",
];

/// Pull-off at a Maugis parameter of 1.
pub fn pull_off() -> Case {
    Case {
        name: "pull-off",
        about: "Largest pull on a ball over pi w R at the Maugis parameter 1, against an integral equation for the half-space with the same bonds.",
        scene: "pull-off",
        sets: Vec::new(),
        ladders: vec![
            Ladder::over_refine("mesh", &[1, 2, 3], &[]),
            Ladder::over_dt("step", &[0.08, 0.04, 0.02], &[]),
        ],
        measure: largest_pull,
    }
}

/// Pull-off at a Maugis parameter of .1.
pub fn pull_off_small() -> Case {
    Case {
        name: "pull-off-dmt",
        about: "The same at the Maugis parameter .1, where the pull is almost the 2 pi w R of Derjaguin, Muller and Toporov.",
        scene: "pull-off",
        sets: SMALL.map(str::to_owned).to_vec(),
        ladders: vec![Ladder::over_refine("mesh", &[1, 2], &[])],
        measure: largest_pull,
    }
}

/// Pull-off at Maugis parameters of 2 and 3.
pub fn pull_off_large() -> Case {
    Case {
        name: "pull-off-jkr",
        about: "The same at the Maugis parameters 2 and 3, where the ball jumps into contact and out of it. A little viscosity of the bonds \
                makes the jumps branches.",
        scene: "pull-off",
        sets: LARGE.map(str::to_owned).to_vec(),
        ladders: vec![
            Ladder::new("Maugis parameter")
                .rung("lambda = 2", 2.0, &["C_n=1.3564e10"])
                .rung("lambda = 3", 3.0, &["C_n=3.0519e10"]),
            Ladder::new("viscosity at lambda = 2")
                .rung("b = 1.6e-5 N s/m", 4.0, &["C_n=1.3564e10", "b=1.6e-5"])
                .rung("b = 4e-6 N s/m", 1.0, &["C_n=1.3564e10"]),
        ],
        measure: largest_pull,
    }
}

fn largest_pull(ran: &Ran) -> Result<Vec<Found>, String> {
    let (e_star, radius) = (2.0e6_f64, 0.1_f64);
    let bonds = ran.scene.interfaces["contact"].adhesion;
    let bonds = bonds.ok_or("the scene has no bonds")?;
    let lambda = maugis_parameter(e_star, radius, bonds.energy, bonds.normal_stiffness);
    let force = ran.curve("t", "force.contact.y")?;
    let (_, largest) = peak(&force).ok_or("the history is empty")?;
    let pull = largest / (PI * bonds.energy * radius);
    let close = |(known, _): &&(f64, f64)| (known / lambda - 1.0).abs() < 1e-3;
    let against = match HALF_SPACE.iter().find(close) {
        Some((_, exact)) => Found::exact("pull-off", "pi w R", pull, *exact),
        None => Found::open("pull-off", "pi w R", pull),
    };
    Ok(vec![
        against,
        Found::exact("pull-off against DMT", "pi w R", pull, DMT),
    ])
}

/// Steady peel of a strip at a right angle.
pub fn peel() -> Case {
    let viscous = |ladder: Ladder, b: &f64| {
        let set = format!("adhesion.b={b}");
        ladder.rung(format!("b = {b} N s/m"), *b, &[&set])
    };
    let viscosities = [2.4, 1.2, 0.6, 0.3].iter();
    Case {
        name: "peel",
        about: "Steady force per width, mean over the last 4 mm of 20 mm of lift, against F (1 + F / (2 E' t)) = w. The viscosity of the \
                bonds adds to it, about in proportion.",
        scene: "peel",
        sets: Vec::new(),
        ladders: vec![
            viscosities.fold(Ladder::new("viscosity"), viscous),
            Ladder::new("mesh")
                .rung("40 x 1", 1.0, &[])
                .rung("80 x 2", 0.5, &["refine=2"]),
            Ladder::over_dt("step", &[0.1, 0.05], &[]),
        ],
        measure: |ran| {
            let force = ran.curve("t", "force.end.y")?;
            let end = force.last().map_or(f64::NAN, |p| p.0);
            let late: Curve = force.into_iter().filter(|p| p.0 >= end - 4.0).collect();
            let steady = mean(&late).ok_or("the history is empty")?;
            Ok(vec![Found::exact(
                "force",
                "N/m",
                steady,
                peel_force(32.0, 4e3),
            )])
        },
    }
}

/// Pull of a rigid plate.
pub fn plate_pull() -> Case {
    Case {
        name: "plate-pull",
        about: "A row of bonds stretched alike at De = .1: largest error of the intensity at any time, largest force, and work \
                until ten times the stretch at which they start to break, against the ramp of one bond.",
        scene: "plate-pull",
        sets: Vec::new(),
        ladders: vec![Ladder::over_dt("step", &[0.004, 0.002, 0.001, 0.0005], &[]).of_order(2.0)],
        measure: ramp,
    }
}

fn ramp(ran: &Ran) -> Result<Vec<Found>, String> {
    let (energy, stiffness, speed, area) = (20.0_f64, 2.0e9, 1e-3, 0.02);
    let bonds = ran.scene.interfaces["joint"].adhesion;
    let viscosity = bonds.ok_or("the scene has no bonds")?.viscosity;
    let gap = (energy / stiffness).sqrt();
    let de = viscosity * speed / (energy * gap);
    let pull = |s: f64| bond_ramp(de, s).powi(2) * stiffness * s * gap * area;
    let fine: Curve = (0..=4000)
        .map(|k| 0.0025 * f64::from(k))
        .map(|s| (s * gap, pull(s)))
        .collect();
    let force: Curve = ran
        .curve("t", "force.joint.y")?
        .iter()
        .map(|(t, f)| (t * speed, -f))
        .collect();
    let beta = ran.curve("t", "probe.corner.beta")?;
    let apart = beta
        .iter()
        .map(|(t, b)| (b - bond_ramp(de, t * speed / gap)).abs());
    let worst = apart.fold(0.0, f64::max);
    let work = |curve: &Curve| mean(curve).map_or(f64::NAN, |m| m * 10.0 * gap);
    let largest = |curve: &Curve| curve.iter().map(|p| p.1).fold(f64::NAN, f64::max);
    // Without viscosity the largest force stands on a kink, which a parabola would round upwards.
    let top = |curve: &Curve| match viscosity {
        0.0 => largest(curve),
        _ => peak(curve).map_or(f64::NAN, |p| p.1),
    };
    Ok(vec![
        Found::zero("beta", "-", worst, 1.0),
        Found::exact("largest force", "N/m", top(&force), top(&fine)),
        Found::exact("work", "J/m", work(&force), work(&fine)),
    ])
}
