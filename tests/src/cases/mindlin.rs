//! Cattaneo and Mindlin: two bodies of one material, pressed, then moved sideways to and fro.

use crate::closed_form::{PartialSlip, under_ball, under_cylinder};
use crate::traction::{Ellipse, INNER, ellipse, tractions};
use crate::{Case, Found, Ladder, Plan, Ran};

use std::f64::consts::PI;

use nscd::State;

const E_STAR: f64 = 1e9;
const MU: f64 = 0.5;

/// In plane strain.
pub fn cylinder() -> Case {
    Case {
        name: "mindlin-cylinder",
        about: "Partial slip under a cylinder: radius of the part that sticks, energy lost in a cycle, half-width of contact and largest \
                pressure under the load that is found. refine = 3 has 30 elements on the half-width. The last node that sticks jumps by one when \
                the load grows: the loss has teeth of the order of h/a.",
        scene: "mindlin-cylinder",
        sets: Vec::new(),
        ladders: vec![
            Ladder::over_refine("mesh", &[1, 2, 3, 4], &[]),
            amplitudes(&["7.0e-7", "8.5e-7", "1.15e-6"]),
        ],
        measure: |ran| {
            let loads = Loads::of(ran, "force.contact.y", 1.0)?;
            let radius = (4.0 * loads.normal / (PI * E_STAR)).sqrt();
            let exact = under_cylinder(E_STAR, MU, loads.normal, loads.q());
            let pressure = 2.0 * loads.normal / (PI * radius);
            compare(ran, 1.0, radius, pressure, &exact)
        },
    }
}

/// In space.
pub fn sphere() -> Case {
    Case {
        name: "mindlin-sphere",
        about: "Partial slip under a ball, half of it: radius of the part that sticks, energy lost in a cycle, radius of contact and largest \
                pressure under the load that is found. The scene has 8 elements on the radius of contact, the finest mesh 20 where it slips.",
        scene: "mindlin-sphere",
        sets: Vec::new(),
        ladders: vec![
            Ladder::new("mesh")
                .rung("5 on the radius", 1.6, &FIVE)
                .rung("8 on the radius (the scene)", 1.0, &[])
                .rung("20 at the rim", 0.4, &RIM),
            amplitudes(&["1.8e-7", "2.2e-7", "2.8e-7"]),
        ],
        measure: |ran| {
            let loads = Loads::of(ran, "force.contact.z", 2.0)?;
            let (radius, exact) = ball(&loads);
            let pressure = 1.5 * loads.normal / (PI * radius * radius);
            compare(ran, 2.0, radius, pressure, &exact)
        },
    }
}

/// Radius of contact \[m\] and partial slip under a ball with these loads.
fn ball(loads: &Loads) -> (f64, PartialSlip) {
    let radius = (0.75 * loads.normal / E_STAR).cbrt();
    let exact = under_ball(0.25 * E_STAR, MU, loads.normal, radius, loads.q());
    (radius, exact)
}

/// The scene with other ways to the side and back \[m\].
fn amplitudes(ways: &[&str]) -> Ladder {
    let with = |ladder: Ladder, way: &&str| {
        let set = format!(
            "top.motion.translation.0=[(1.0, 0.0), (2.0, {way}), (4.0, -{way}), (6.0, {way})]"
        );
        ladder.rung(format!("{way} m to each side"), 1.0, &[set.as_str()])
    };
    ways.iter().fold(Ladder::new("load"), with)
}

/// The mesh of `mindlin-sphere` with 5 elements on the radius of contact.
pub const FIVE: [&str; 6] = [
    "low.mesh.x.pieces=[Cells(to: -1.2e-3, cells: 5, grading: 0.068), Cells(to: 1.2e-3, cells: 12), Cells(to: 0.01, cells: 5, grading: 14.7)]",
    "high.mesh.x.pieces=[Cells(to: -1.2e-3, cells: 5, grading: 0.068), Cells(to: 1.2e-3, cells: 12), Cells(to: 0.01, cells: 5, grading: 14.7)]",
    "low.mesh.y.pieces=[Cells(to: 1.2e-3, cells: 6), Growing(to: 0.01, growth: 1.9)]",
    "high.mesh.y.pieces=[Cells(to: 1.2e-3, cells: 6), Growing(to: 0.01, growth: 1.9)]",
    "low.mesh.z.pieces=[Cells(to: -0.6e-3, cells: 3), Growing(to: -0.01, growth: 1.9)]",
    "high.mesh.z.pieces=[Cells(to: 0.6e-3, cells: 3), Growing(to: 0.01, growth: 1.9)]",
];

/// The mesh of `mindlin-sphere` with elements of 1/20 of the radius of contact where it slips, larger ones in the
/// middle. Sizes change little by little: where they jump the share of a node lies beside it, and so does its pressure.
pub const RIM: [&str; 6] = [
    "low.mesh.x.pieces=[Cells(to: -1.1e-3, cells: 7, grading: 0.04), Cells(to: -0.55e-3, cells: 11), Cells(to: 0.0, cells: 6, grading: 2.5), Cells(to: 0.55e-3, cells: 6, grading: 0.4), Cells(to: 1.1e-3, cells: 11), Cells(to: 0.01, cells: 7, grading: 25.0)]",
    "high.mesh.x.pieces=[Cells(to: -1.1e-3, cells: 7, grading: 0.04), Cells(to: -0.55e-3, cells: 11), Cells(to: 0.0, cells: 6, grading: 2.5), Cells(to: 0.55e-3, cells: 6, grading: 0.4), Cells(to: 1.1e-3, cells: 11), Cells(to: 0.01, cells: 7, grading: 25.0)]",
    "low.mesh.y.pieces=[Cells(to: 0.55e-3, cells: 6, grading: 0.4), Cells(to: 1.1e-3, cells: 11), Growing(to: 0.01, growth: 1.8)]",
    "high.mesh.y.pieces=[Cells(to: 0.55e-3, cells: 6, grading: 0.4), Cells(to: 1.1e-3, cells: 11), Growing(to: 0.01, growth: 1.8)]",
    "low.mesh.z.pieces=[Cells(to: -0.5e-3, cells: 6), Growing(to: -0.01, growth: 1.8)]",
    "high.mesh.z.pieces=[Cells(to: 0.5e-3, cells: 6), Growing(to: 0.01, growth: 1.8)]",
];

/// Load steps of [`first_loading`] at which the side load grows.
const GROWING: std::ops::RangeInclusive<u32> = 2..=12;

/// The first way to the side, in so many steps that the load is seen to grow from `q` = .39 to .78.
pub fn first_loading(mesh: &[&str]) -> Plan {
    let way = [
        "top.motion.translation.0=[(1.0, 0.0), (2.0, 1.52e-7), (12.0, 3.42e-7)]",
        "time.end=12.0",
        "time.dt=1.0",
    ];
    let scene = "mindlin-sphere";
    let times: Vec<f64> = GROWING.map(f64::from).collect();
    Plan::new(scene, scene, mesh.iter().copied().chain(way)).keeping(&times)
}

/// A moment of a first loading, beside what it should be.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Moment {
    /// Side load over that of full slip \[-\].
    pub q: f64,
    /// Radius of what sticks over radius of contact, relative error \[-\].
    pub stick: f64,
    /// Energy lost, relative error \[-\].
    pub loss: f64,
}

/// The moments of a [`first_loading`]. It loses a quarter of what a cycle between `-T` and `T` loses: on the way back,
/// and forth again, the same places slip twice as far under the same friction.
///
/// # Errors
/// The run is no such loading or did not reach its end.
pub fn moments(ran: &Ran) -> Result<Vec<Moment>, String> {
    let lost = ran.curve("t", "dissipation.friction")?;
    let (normal, sideways) = (
        ran.curve("t", "force.contact.z")?,
        ran.curve("t", "force.contact.x")?,
    );
    let at = |curve: &[(f64, f64)], time: f64| {
        let row = curve.iter().find(|p| p.0 >= time - 1e-9);
        row.map(|p| p.1)
            .ok_or_else(|| format!("there is no time {time}"))
    };
    let moment = |(k, step): (usize, u32)| {
        let time = f64::from(step);
        let loads = Loads {
            normal: -2.0 * at(&normal, time)?,
            sideways: 2.0 * at(&sideways, time)?.abs(),
        };
        let (radius, exact) = ball(&loads);
        let [contact, stick] = ellipses(ran, ran.snapshot(k)?, radius, &exact);
        let loss = 4.0 * 2.0 * (at(&lost, time)? - at(&lost, 1.0)?);
        Ok(Moment {
            q: loads.q(),
            stick: stick.radius / contact.radius / exact.stick - 1.0,
            loss: loss / exact.loss - 1.0,
        })
    };
    GROWING.enumerate().map(moment).collect()
}

/// Loads of the whole contact \[N\], per metre in the plane.
struct Loads {
    normal: f64,
    sideways: f64,
}

impl Loads {
    fn of(ran: &Ran, normal: &str, parts: f64) -> Result<Loads, String> {
        Ok(Loads {
            normal: -parts * ran.end(normal)?,
            sideways: parts * ran.end("force.contact.x")?.abs(),
        })
    }

    fn q(&self) -> f64 {
        self.sideways / (MU * self.normal)
    }
}

/// Of the pressure, and of what sticks.
fn ellipses(ran: &Ran, state: &State, radius: f64, exact: &PartialSlip) -> [Ellipse; 2] {
    let nodes = tractions(ran, state);
    let contact = ellipse(nodes.iter().map(|t| (t.r, t.pressure)), INNER * radius);
    // Where it sticks, full slip and friction differ by an ellipse that ends where slip begins.
    let spare = nodes.iter().map(|t| (t.r, MU * t.pressure - t.friction));
    [contact, ellipse(spare, INNER * exact.stick * radius)]
}

fn compare(
    ran: &Ran,
    parts: f64,
    radius: f64,
    pressure: f64,
    exact: &PartialSlip,
) -> Result<Vec<Found>, String> {
    let [contact, stick] = ellipses(ran, &ran.last, radius, exact);
    let friction = ran.curve("t", "dissipation.friction")?;
    let at = |time: f64| {
        let row = friction.iter().find(|p| p.0 >= time - 1e-9);
        row.map(|p| p.1)
            .ok_or_else(|| format!("there is no time {time}"))
    };
    let loss = parts * (at(6.0)? - at(2.0)?);
    Ok(vec![
        Found::exact(
            "stick over contact radius",
            "-",
            stick.radius / contact.radius,
            exact.stick,
        ),
        Found::exact("loss in a cycle", "uJ", 1e6 * loss, 1e6 * exact.loss),
        Found::exact(
            "radius of contact",
            "mm",
            1e3 * contact.radius,
            1e3 * radius,
        ),
        Found::exact(
            "largest pressure",
            "kPa",
            1e-3 * contact.peak,
            1e-3 * pressure,
        ),
    ])
}
