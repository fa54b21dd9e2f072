//! Hertz: rigid round bodies on an elastic one of `E* = 1e9 Pa`, their radius 1 m, the radius of contact 1 mm at the
//! end.

use crate::closed_form::{Pressed, hertz_cylinder_on_layer, hertz_sphere};
use crate::traction::{INNER, ellipse, tractions};
use crate::{Case, Found, Ladder, Ran};

const E_STAR: f64 = 1e9;
const RADIUS: f64 = 1.0;

/// A cylinder in plane strain.
pub fn cylinder() -> Case {
    Case {
        name: "hertz-cylinder",
        about: "A rigid cylinder on an elastic layer of 100 half-widths, plane strain: force at a given depth, half-width of contact and \
                largest pressure (from the line through the squares of the nodal pressures). refine = 2 has 20 elements on the half-width.",
        scene: "hertz-cylinder",
        sets: Vec::new(),
        ladders: vec![Ladder::over_refine("mesh", &[1, 2, 4], &[]), quadratic()],
        measure: |ran| {
            let depth = |t: f64| 2.723_325e-6 * t;
            let exact = |t| hertz_cylinder_on_layer(E_STAR, RADIUS, 0.1, depth(t));
            compare(ran, "force.contact.y", 2.0, &exact)
        },
    }
}

/// A ball as a body of revolution.
pub fn sphere() -> Case {
    Case {
        name: "hertz-sphere",
        about: "A rigid ball on an elastic half-space, axisymmetric: force at a given depth, radius of contact and largest pressure. refine = 2 has \
                20 elements on the radius of contact.",
        scene: "hertz-sphere",
        sets: Vec::new(),
        ladders: vec![
            Ladder::over_refine("mesh", &[1, 2, 4], &[]),
            quadratic(),
            domains(),
        ],
        measure: |ran| compare(ran, "force.contact.y", 1.0, &ball_at),
    }
}

/// The same numbers of cells with quadratic elements: `refine = 1` has the nodes of `refine = 2` with linear ones.
fn quadratic() -> Ladder {
    Ladder::over_refine("mesh, Quad9", &[1, 2], &["mesh.element=Quad9"])
}

/// Blocks of other sizes, as wide \[m\] and high \[m\] as this.
fn domains() -> Ladder {
    let sizes = [(0.1, 0.1), (0.1, 0.2), (0.4, 0.4), (4.0, 4.0)];
    let with = |ladder: Ladder, (width, height): &(f64, f64)| {
        let axis = |name, to: f64, core: f64, cells| {
            format!(
                "block.mesh.{name}.pieces=[Cells(to: {core:e}, cells: {cells}), Growing(to: {to:e}, growth: 1.2)]"
            )
        };
        let sets = [
            axis("x", *width, 1.3e-3, 13),
            axis("y", -height, -0.8e-3, 8),
        ];
        let label = format!("{} a wide, {} a high", 1e3 * width, 1e3 * height);
        ladder.rung(label, 0.1 / width, &sets.each_ref().map(String::as_str))
    };
    sizes.iter().fold(Ladder::new("block"), with)
}

/// A ball in space.
pub fn ball() -> Case {
    Case {
        name: "hertz-ball",
        about: "A rigid ball on an elastic block of hexahedra, a quarter of it: force at a given depth, radius of contact and largest pressure. \
                refine = 2 has 10 elements on the radius of contact.",
        scene: "hertz-ball",
        sets: Vec::new(),
        ladders: vec![Ladder::over_refine("mesh", &[1, 2], &[])],
        measure: |ran| compare(ran, "force.contact.z", 4.0, &ball_at),
    }
}

fn ball_at(t: f64) -> Pressed {
    hertz_sphere(E_STAR, RADIUS, 1e-6 * t)
}

/// `parts` of the computed body make the whole; `exact` is the solution at the end of a step.
fn compare(
    ran: &Ran,
    force: &str,
    parts: f64,
    exact: &dyn Fn(f64) -> Pressed,
) -> Result<Vec<Found>, String> {
    let curve = ran.curve("t", force)?;
    let end = exact(1.0);
    // From depth to depth a node more or less is in contact: the mean tells the trend from the teeth.
    let later: Vec<f64> = curve
        .iter()
        .filter(|p| p.0 > 0.45)
        .map(|(t, f)| -parts * f / exact(*t).force)
        .collect();
    let mean = later.iter().sum::<f64>() / later.len() as f64;
    let fit = ellipse(
        tractions(ran, &ran.last).iter().map(|t| (t.r, t.pressure)),
        INNER * end.radius,
    );
    Ok(vec![
        Found::exact("force", "N", -parts * ran.end(force)?, end.force),
        Found::exact("force, mean over depths", "-", mean, 1.0),
        Found::exact(
            "radius of contact",
            "mm",
            1e3 * fit.radius,
            1e3 * end.radius,
        ),
        Found::exact(
            "largest pressure",
            "kPa",
            1e-3 * fit.peak,
            1e-3 * end.pressure,
        ),
    ])
}
