//! The scene of a draw, as text.

use std::fmt::Write as _;

use super::subject::{Bond, Case, Draw, Hold, Kind, Law, Shape};

/// The scene as RON.
pub(super) fn scene(draw: &Draw, title: &str) -> String {
    let writer = Writer { draw };
    let mut text = String::new();
    let parts = [
        writer.head(title),
        writer.materials(),
        writer.bodies(),
        writer.motions(),
        writer.loads(),
        writer.interfaces(),
        writer.time(),
    ];
    for part in parts {
        text.push_str(&part);
    }
    text.push_str("    output: (fields_every: Never),\n)\n");
    text
}

struct Writer<'a> {
    draw: &'a Draw,
}

impl Writer<'_> {
    fn length(&self, x: f64) -> f64 {
        x * self.draw.units[0]
    }

    fn time_of(&self, t: f64) -> f64 {
        t * self.draw.units[2]
    }

    fn stress(&self, s: f64) -> f64 {
        let [l, m, t] = self.draw.units;
        s * m / (l * t * t)
    }

    fn is_space(&self) -> bool {
        self.draw.kind == Kind::Space
    }

    /// A vector across and up.
    fn vector(&self, across: f64, up: f64) -> String {
        if self.is_space() {
            format!("({across:?}, 0.0, {up:?})")
        } else {
            format!("({across:?}, {up:?}, 0.0)")
        }
    }

    fn up(&self) -> char {
        if self.is_space() { 'z' } else { 'y' }
    }

    /// End of the span, natural.
    fn end(&self) -> f64 {
        self.draw.dt * self.draw.steps as f64
    }

    fn head(&self, title: &str) -> String {
        let symmetry = match self.draw.kind {
            Kind::Axisymmetric => "    symmetry: Some(Axisymmetric),\n",
            _ => "",
        };
        format!("(\n    title: \"{title}\",\n{symmetry}")
    }

    fn law(&self, law: Law, modulus: f64) -> String {
        let e = self.stress(modulus);
        let nu = self.draw.nu;
        let (g, k) = (e / (2.0 * (1.0 + nu)), e / (3.0 * (1.0 - 2.0 * nu)));
        match law {
            Law::SaintVenantKirchhoff => format!("SaintVenantKirchhoff(E: {e:?}, nu: {nu:?})"),
            Law::NeoHookean => format!("NeoHookean(E: {e:?}, nu: {nu:?})"),
            Law::BlatzKo => format!("BlatzKo(G: {:?})", 0.4 * e),
            Law::ThreeE => format!(
                "ThreeE(G: {g:?}, K: {k:?}, a1: {:?}, a2: {:?}, a3: 0.0, a4: {:?}, a5: {:?})",
                0.1 * g,
                0.1 * k,
                0.4 * k,
                0.1 * g
            ),
        }
    }

    fn materials(&self) -> String {
        let [l, m, _] = self.draw.units;
        let unit = m / (l * l * l);
        let mut text = "    materials: {\n".to_owned();
        let mut one = |name: &str, law: Law, modulus: f64, density: f64| {
            let law = self.law(law, modulus);
            let _ = writeln!(
                text,
                "        \"{name}\": (law: {law}, density: {:?}),",
                unit * density
            );
        };
        one("first", self.draw.law, self.draw.modulus, self.draw.density);
        if self.draw.case.has_second_body() {
            one("second", Law::NeoHookean, 1.0, 1.0);
        }
        text.push_str("    },\n");
        text
    }

    /// A block from `-width/2`, or from the axis, between two heights.
    fn block(&self, width: f64, low: f64, high: f64, cells: [usize; 2], grading: f64) -> String {
        let (half, low, high) = (
            self.length(0.5 * width),
            self.length(low),
            self.length(high),
        );
        let [n, m] = cells;
        match self.draw.kind {
            Kind::Space => {
                let element = self.element(["Hex8", "Tet4", "Hex27", "Tet10"]);
                format!(
                    "Box(min: ({:?}, {:?}, {low:?}), max: ({half:?}, {half:?}, {high:?}), cells: ({n}, {n}, {m}), \
                     grading: (1.0, 1.0, {grading:?}), element: {element})",
                    -half, -half
                )
            }
            _ => {
                let left = if self.draw.kind == Kind::Axisymmetric {
                    0.0
                } else {
                    -half
                };
                let element = self.element(["Quad4", "Tri3", "Quad9", "Tri6"]);
                format!(
                    "Rectangle(min: ({left:?}, {low:?}), max: ({half:?}, {high:?}), cells: ({n}, {m}), \
                     grading: (1.0, {grading:?}), element: {element})"
                )
            }
        }
    }

    fn element(&self, kinds: [&'static str; 4]) -> &'static str {
        kinds[2 * usize::from(self.draw.quadratic) + usize::from(self.draw.simplex)]
    }

    /// Mesh, contact set and far set of the first body.
    fn first(&self) -> (String, String, String) {
        let draw = self.draw;
        let up = self.up();
        if !draw.round {
            let mesh = self.block(
                draw.width,
                draw.gap,
                draw.gap + draw.height,
                draw.cells,
                draw.grading,
            );
            return (mesh, format!("{up}_min"), format!("{up}_max"));
        }
        let cells = draw.cells[0].max(2);
        let (radius, center) = (
            self.length(draw.height),
            self.length(draw.gap + draw.height),
        );
        if draw.case == Case::Squeeze && draw.kind == Kind::Plane {
            let half = 0.5 * radius;
            let at = self.length(draw.gap) + half;
            let mesh = format!("Disc(center: (0.0, {at:?}), radius: {half:?}, cells: {cells})");
            return (mesh, "rim".into(), "center".into());
        }
        let mesh = match draw.kind {
            Kind::Plane => {
                format!(
                    "HalfDisc(center: (0.0, {center:?}), radius: {radius:?}, cells: {cells}, pole: Down)"
                )
            }
            Kind::Axisymmetric => {
                format!(
                    "QuarterDisc(center: (0.0, {center:?}), radius: {radius:?}, cells: {cells}, pole: Down)"
                )
            }
            Kind::Space => {
                format!(
                    "HalfBall(center: (0.0, 0.0, {center:?}), radius: {radius:?}, cells: 2, pole: Down)"
                )
            }
        };
        (mesh, "dome".into(), "base".into())
    }

    fn second(&self) -> String {
        let draw = self.draw;
        let width = match (draw.overhang, draw.matching) {
            (true, _) => 0.5 * draw.width,
            (false, true) => draw.width,
            (false, false) => 2.0 * draw.width,
        };
        let cells = if draw.matching {
            draw.cells
        } else {
            [draw.cells[0] + 1, draw.cells[1]]
        };
        self.block(width, -draw.height, 0.0, cells, 1.0)
    }

    fn bodies(&self) -> String {
        let draw = self.draw;
        let unit = draw.units[0] / draw.units[2];
        let moves = draw.hold == Hold::Free && !draw.quasi_static && draw.case != Case::Squeeze;
        let velocity = if moves {
            let v = self.vector(unit * draw.speed[0], -unit * draw.speed[1]);
            format!(", velocity: {v}")
        } else {
            String::new()
        };
        let dilatation = if draw.projected {
            ", dilatation: Projected"
        } else {
            ""
        };
        let mut text = format!(
            "    bodies: {{\n        \"first\": (mesh: {}, material: \"first\"{velocity}{dilatation}),\n",
            self.first().0
        );
        if draw.case.has_second_body() {
            let _ = writeln!(
                text,
                "        \"second\": (mesh: {}, material: \"second\"),",
                self.second()
            );
        }
        text.push_str("    },\n");
        text
    }

    /// Displacements across and towards the other side over time: press, then drag, then perhaps pull back; or to and
    /// fro with every step. `sign` is 1 for what comes from below.
    fn tables(&self, sign: f64) -> [String; 2] {
        let draw = self.draw;
        let (end, deep) = (self.end(), sign * (draw.gap.max(0.0) + draw.depth));
        let points = |points: &[(f64, f64)]| {
            let each = points
                .iter()
                .map(|(t, x)| format!("({:?}, {:?})", self.time_of(*t), self.length(*x)));
            format!("[{}]", each.collect::<Vec<_>>().join(", "))
        };
        let across = if draw.slide == 0.0 {
            "0.0".to_owned()
        } else {
            points(&[(0.0, 0.0), (0.4 * end, 0.0), (end, draw.slide)])
        };
        let mut towards = vec![(0.0, 0.0), (0.4 * end, deep)];
        if draw.pull {
            towards.push((end, -0.3 * sign * draw.depth));
        }
        if draw.flicker {
            let at = |k: usize| if k.is_multiple_of(2) { 0.0 } else { deep };
            towards = (0..=draw.steps)
                .map(|k| (draw.dt * k as f64, at(k)))
                .collect();
        }
        [across, points(&towards)]
    }

    fn drive(&self, sign: f64) -> String {
        let draw = self.draw;
        let [across, towards] = self.tables(sign);
        let translation = if self.is_space() {
            format!("({across}, 0.0, {towards})")
        } else {
            format!("({across}, {towards}, 0.0)")
        };
        let rotation = if draw.turn == 0.0 {
            String::new()
        } else {
            format!(
                ", rotation: Some((point: {}, axis: (0.0, 0.0, 1.0), angle: [(0.0, 0.0), ({:?}, {:?})]))",
                self.vector(0.0, self.length(draw.gap + draw.height)),
                self.time_of(self.end()),
                draw.turn
            )
        };
        format!("Move(translation: {translation}{rotation})")
    }

    fn motions(&self) -> String {
        let draw = self.draw;
        let (_, _, far) = self.first();
        let all = if self.is_space() { "xyz" } else { "xy" };
        let mut text = "    motions: {\n".to_owned();
        let mut one = |name: &str, nodes: &str, components: &str, motion: &str| {
            let _ = writeln!(
                text,
                "        \"{name}\": (nodes: \"{nodes}\", components: \"{components}\", motion: {motion}),"
            );
        };
        let axisymmetric = draw.kind == Kind::Axisymmetric;
        if axisymmetric && draw.hold != Hold::All {
            let axis = if draw.round { "axis" } else { "x_min" };
            one("axis", &format!("first.{axis}"), "x", "Fixed");
        }
        let motion = match draw.case {
            Case::Indent => "Fixed".to_owned(),
            _ => self.drive(-1.0),
        };
        match draw.hold {
            Hold::Free => {}
            Hold::Face => one("drive", &format!("first.{far}"), all, &motion),
            Hold::All => one("drive", "first.all", all, &motion),
        }
        if draw.case == Case::Pair {
            let bottom = format!("second.{}_min", self.up());
            one("bottom", &bottom, all, "Fixed");
        }
        if draw.case.has_second_body() && axisymmetric {
            one("second-axis", "second.x_min", "x", "Fixed");
        }
        text.push_str("    },\n");
        text
    }

    fn loads(&self) -> String {
        let draw = self.draw;
        let mut text = "    loads: {\n".to_owned();
        if draw.gravity != 0.0 {
            let unit = draw.units[0] / draw.units[2].powi(2);
            let g = self.vector(0.0, -unit * draw.gravity / draw.density);
            let _ = writeln!(text, "        \"gravity\": Gravity({g}),");
        }
        let (_, _, far) = self.first();
        if draw.traction != 0.0 && far != "center" {
            let t = self.vector(0.0, -self.stress(draw.traction));
            // A driven face would take the load straight back.
            let face = match (draw.hold, draw.round) {
                (Hold::Face, false) => "x_max",
                _ => &far,
            };
            let end = self.time_of(self.end());
            let _ = writeln!(
                text,
                "        \"traction\": Traction(facets: \"first.{face}\", traction: {t}, factor: [(0.0, 0.0), ({end:?}, 1.0)]),"
            );
        }
        text.push_str("    },\n");
        text
    }

    /// The rigid shape with its highest point in the origin.
    fn shape(&self) -> String {
        match self.draw.shape {
            Shape::Plane(slope) => format!(
                "Plane(point: (0.0, 0.0, 0.0), normal: {})",
                self.vector(-slope.sin(), slope.cos())
            ),
            Shape::Sphere(radius) => {
                let r = self.length(radius);
                format!("Sphere(center: {}, radius: {r:?})", self.vector(0.0, -r))
            }
            Shape::Cylinder(radius) => {
                let r = self.length(radius);
                let axis = if self.is_space() {
                    "(0.0, 1.0, 0.0)"
                } else {
                    "(0.0, 0.0, 1.0)"
                };
                format!(
                    "Cylinder(point: {}, axis: {axis}, radius: {r:?})",
                    self.vector(0.0, -r)
                )
            }
            Shape::Cone(angle) => format!(
                "Cone(apex: (0.0, 0.0, 0.0), axis: {}, semi_apex_angle: {angle:?})",
                self.vector(0.0, -1.0)
            ),
        }
    }

    fn interfaces(&self) -> String {
        let draw = self.draw;
        let (_, near, far) = self.first();
        let mut text = "    interfaces: {\n".to_owned();
        let law = format!(
            "mu: {:?}, restitution: {:?}{}",
            draw.mu,
            draw.restitution,
            draw.bond.map_or(String::new(), |bond| self.adhesion(&bond))
        );
        let mut one = |name: &str, slave: &str, master: &str, motion: &str| {
            let _ = writeln!(
                text,
                "        \"{name}\": (slave: \"first.{slave}\", master: {master}, motion: {motion}, {law}),"
            );
        };
        match draw.case {
            Case::Fall | Case::Press => one("contact", &near, &self.shape(), "Fixed"),
            Case::Indent => one("contact", &near, &self.shape(), &self.drive(1.0)),
            Case::Pair | Case::Collide => {
                let master = format!("Facets(\"second.{}_max\")", self.up());
                one("contact", &near, &master, "Fixed");
            }
            Case::Squeeze => {
                let plane = |height: f64, side: f64| {
                    let (point, normal) = (self.vector(0.0, height), self.vector(0.0, side));
                    format!("Plane(point: {point}, normal: {normal})")
                };
                let top = self.length(draw.height + 2.0 * draw.gap);
                one("lower", &near, &plane(0.0, 1.0), "Fixed");
                let slave = if far == "center" { "rim" } else { &far };
                one("upper", slave, &plane(top, -1.0), &self.drive(-1.0));
            }
        }
        text.push_str("    },\n");
        text
    }

    fn adhesion(&self, bond: &Bond) -> String {
        let [l, _, t] = self.draw.units;
        let c = self.stress(bond.stiffness) / l;
        // Viscosity is work per area over a rate of the intensity.
        let (w, b) = (
            self.stress(bond.energy) * l,
            self.stress(bond.viscosity) * l * t,
        );
        let mu = bond
            .bonded_friction
            .map_or(String::new(), |mu| format!(", mu_bonded: {mu:?}"));
        let (healing, gap) = if bond.irreversible {
            ("Irreversible", 0.0)
        } else {
            ("Recoverable", self.length(bond.healing_gap))
        };
        format!(
            ", adhesion: Some((C_n: {c:?}, C_t: {c:?}, w: {w:?}, b: {b:?}, beta: {:?}, healing: {healing}, \
             healing_gap: {gap:?}, reference: {}, update: {}{mu}))",
            bond.initial,
            if bond.ageing { "Ageing" } else { "Reset" },
            if bond.consistent {
                "EnergyConsistent"
            } else {
                "SecondOrder"
            },
        )
    }

    fn time(&self) -> String {
        let draw = self.draw;
        let [mass, stiffness] = draw.damping;
        let contact = if draw.velocity_level {
            "Velocity"
        } else {
            "Position"
        };
        let inertia = if draw.quasi_static {
            "QuasiStatic"
        } else {
            "Dynamic"
        };
        format!(
            "    damping: (mass: {:?}, stiffness: {:?}),\n    time: (end: {:?}, dt: {:?}, theta: {:?}, xi: {:?}, \
             contact: {contact}, inertia: {inertia}),\n    mass: {},\n    \
             solver: (max_contact_iterations: 2000),\n",
            mass / draw.units[2],
            self.time_of(stiffness),
            self.time_of(self.end()),
            self.time_of(draw.dt),
            draw.theta,
            draw.xi,
            if draw.lumped { "Lumped" } else { "Consistent" },
        )
    }
}
