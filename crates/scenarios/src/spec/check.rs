//! Every value of a scene against what is possible.

mod interface;
mod mesh;
mod plane;
mod run;

use indexmap::IndexMap;

use super::locate::join;
use super::near::near_names;
use super::{Inertia, Load, Motion, Scene, Table};

/// A value that is not allowed.
#[derive(Debug)]
pub(super) struct Issue {
    pub(super) path: String,
    pub(super) message: String,
}

/// More nodes than this are a slip in `cells` or `refine`: their matrix fits no memory.
const MAX_NODES: usize = 20_000_000;
/// More steps than this are a slip in `dt` or `end`.
const MAX_STEPS: f64 = 1e9;
/// Longest name of a part \[letters\]: pictures are called by it, with words around it, and file systems take 255
/// bytes.
const LONGEST_NAME: usize = 100;
/// A larger ratio of the sizes of two cells, or its inverse, is a slip, and cells vanish in round-off.
const MAX_GRADING: f64 = 1e9;

/// All that is wrong with the values of a scene, in the order of the checks.
pub(super) fn check(scene: &Scene) -> Vec<Issue> {
    let mut checker = Checker {
        scene,
        issues: Vec::new(),
    };
    checker.names();
    checker.materials();
    checker.bodies();
    checker.plane();
    checker.motions();
    checker.loads();
    checker.interfaces();
    checker.time();
    checker.solver();
    checker.output();
    checker.issues
}

struct Checker<'a> {
    scene: &'a Scene,
    issues: Vec<Issue>,
}

impl Checker<'_> {
    fn require(&mut self, allowed: bool, path: &str, message: impl Into<String>) {
        if !allowed {
            self.issues.push(Issue {
                path: path.to_owned(),
                message: message.into(),
            });
        }
    }

    fn positive(&mut self, value: f64, path: &str, unit: &str) {
        self.require(
            value.is_finite() && value > 0.0,
            path,
            format!("must be greater than 0 [{unit}], and finite"),
        );
    }

    /// Size of the last cell over that of the first.
    fn grading(&mut self, value: f64, path: &str) {
        self.require(
            (1.0 / MAX_GRADING..=MAX_GRADING).contains(&value),
            path,
            format!(
                "must lie between {:e} and {MAX_GRADING:e} [-]",
                1.0 / MAX_GRADING
            ),
        );
    }

    fn not_negative(&mut self, value: f64, path: &str, unit: &str) {
        self.require(
            value.is_finite() && value >= 0.0,
            path,
            format!("must be 0 or more [{unit}], and finite"),
        );
    }

    fn between(&mut self, value: f64, low: f64, high: f64, path: &str, unit: &str) {
        self.require(
            (low..=high).contains(&value),
            path,
            format!("must be from {low} to {high} [{unit}]"),
        );
    }

    fn finite(&mut self, values: &[f64], path: &str) {
        self.require(values.iter().all(|v| v.is_finite()), path, "must be finite");
    }

    fn direction(&mut self, axis: [f64; 3], path: &str) {
        let length = axis.iter().map(|a| a * a).sum::<f64>().sqrt();
        self.require(
            length.is_finite() && length > 0.0,
            path,
            "must be a direction, not the zero vector",
        );
    }

    fn known<V>(&mut self, map: &IndexMap<String, V>, name: &str, what: &str, path: &str) {
        let names = map.keys().map(String::as_str);
        self.require(map.contains_key(name), path, unknown(what, name, names));
    }

    /// `body.set` against the sets of the body.
    fn set(&mut self, name: &str, kind: &str, path: &str) {
        let bodies = &self.scene.bodies;
        if name.trim().is_empty() {
            self.require(
                false,
                path,
                format!("names no {kind} set, so nothing would be in it; write body.set"),
            );
            return;
        }
        let Some((body, set)) = name.split_once('.') else {
            self.require(
                false,
                path,
                format!("must be body.set; bodies: {}", list(bodies.keys())),
            );
            return;
        };
        let Some(found) = bodies.get(body) else {
            return self.known(bodies, body, "body", path);
        };
        let sets = if kind == "node" {
            found.mesh.node_sets()
        } else {
            found.mesh.facet_sets().to_vec()
        };
        let what = format!("{kind} set of body `{body}`");
        self.require(
            sets.contains(&set),
            path,
            unknown(&what, set, sets.iter().copied()),
        );
    }

    fn names(&mut self) {
        let scene = self.scene;
        self.require(
            !scene.bodies.is_empty(),
            "bodies",
            "a scene needs at least one body",
        );
        self.require(scene.refine >= 1, "refine", "must be 1 or more [-]");
        let maps: [(&str, Vec<&String>); 6] = [
            ("materials", scene.materials.keys().collect()),
            ("bodies", scene.bodies.keys().collect()),
            ("motions", scene.motions.keys().collect()),
            ("loads", scene.loads.keys().collect()),
            ("interfaces", scene.interfaces.keys().collect()),
            ("output.probes", scene.output.probes.keys().collect()),
        ];
        let plain = |c: char| c.is_ascii_alphanumeric() || c == '_' || c == '-';
        for (map, names) in maps {
            for name in names {
                let fine = !name.is_empty() && name.chars().all(plain);
                // A dot in the name would break the path to it: point at the map.
                let path = if name.contains('.') {
                    map.to_owned()
                } else {
                    format!("{map}.{name}")
                };
                self.require(
                    fine,
                    &path,
                    format!("the name `{name}` may only have letters, digits, _ and -"),
                );
                let message = format!(
                    "the name has {} letters, at most {LONGEST_NAME} are allowed: files are called by it",
                    name.len()
                );
                self.require(name.len() <= LONGEST_NAME, &path, message);
            }
        }
        for name in scene
            .interfaces
            .keys()
            .filter(|name| scene.motions.contains_key(*name))
        {
            let message = "is the name of a motion too; both write columns force.<name>, so names must differ";
            self.require(false, &format!("interfaces.{name}"), message);
        }
    }

    fn materials(&mut self) {
        for (name, material) in &self.scene.materials {
            let path = format!("materials.{name}");
            self.positive(material.density, &format!("{path}.density"), "kg/m^3");
            if let Err(error) = material.law.build() {
                self.require(
                    false,
                    &join(&format!("{path}.law"), &error.field),
                    error.message,
                );
            }
        }
    }

    fn bodies(&mut self) {
        for (name, body) in &self.scene.bodies {
            let path = format!("bodies.{name}");
            self.known(
                &self.scene.materials,
                &body.material,
                "material",
                &format!("{path}.material"),
            );
            for (field, value) in [("velocity", body.velocity), ("spin", body.spin)] {
                let path = format!("{path}.{field}");
                self.finite(&value, &path);
                let moves = value.iter().any(|v| *v != 0.0);
                let at_rest = self.scene.time.inertia == Inertia::Dynamic || !moves;
                self.require(at_rest, &path, "must be zero in a QuasiStatic scene");
            }
            self.mesh(&body.mesh, &format!("{path}.mesh"));
        }
    }

    fn motions(&mut self) {
        let motions = &self.scene.motions;
        for (i, (name, given)) in motions.iter().enumerate() {
            let path = format!("motions.{name}");
            self.set(&given.nodes, "node", &format!("{path}.nodes"));
            let letters = given.components.chars().all(|c| "xyz".contains(c));
            let count = given.mask().iter().filter(|m| **m).count();
            let fine = letters && count >= 1 && count == given.components.len();
            self.require(
                fine,
                &format!("{path}.components"),
                "must be some of the letters xyz, each once",
            );
            self.motion(&given.motion, &format!("{path}.motion"));
            for (other, earlier) in motions.iter().take(i) {
                let shared = (0..3).any(|c| given.mask()[c] && earlier.mask()[c]);
                let message =
                    format!("motion `{other}` prescribes the same components of the same nodes");
                self.require(
                    !shared || earlier.nodes != given.nodes,
                    &format!("{path}.nodes"),
                    message,
                );
            }
        }
    }

    fn motion(&mut self, motion: &Motion, path: &str) {
        let Some((translation, rotation)) = motion.parts() else {
            return;
        };
        for (i, table) in translation.iter().enumerate() {
            self.table(table, &format!("{path}.translation.{i}"));
        }
        if let Some(rotation) = rotation {
            self.finite(&rotation.point, &format!("{path}.rotation.point"));
            self.direction(rotation.axis, &format!("{path}.rotation.axis"));
            self.table(&rotation.angle, &format!("{path}.rotation.angle"));
        }
    }

    fn table(&mut self, table: &Table, path: &str) {
        let points = table.points();
        self.require(
            !points.is_empty(),
            path,
            "must have at least one point (t, value)",
        );
        for (i, (t, value)) in points.iter().enumerate() {
            let finite = t.is_finite() && value.is_finite();
            self.require(finite, path, "must be finite");
            let message = "the times of a table must increase from point to point [s]";
            self.require(
                i == 0 || points[i - 1].0 < *t || !finite,
                &format!("{path}.{i}.0"),
                message,
            );
        }
    }

    fn loads(&mut self) {
        for (name, load) in &self.scene.loads {
            let path = format!("loads.{name}");
            match load {
                Load::Gravity(acceleration) => self.finite(acceleration, &path),
                Load::Traction {
                    facets,
                    traction,
                    factor,
                } => {
                    self.set(facets, "facet", &format!("{path}.facets"));
                    self.finite(traction, &format!("{path}.traction"));
                    self.table(factor, &format!("{path}.factor"));
                }
            }
        }
    }
}

fn list(names: impl Iterator<Item = impl AsRef<str>>) -> String {
    names
        .map(|name| format!("`{}`", name.as_ref()))
        .collect::<Vec<_>>()
        .join(", ")
}

fn unknown<'a>(what: &str, name: &str, names: impl Iterator<Item = &'a str> + Clone) -> String {
    let all = list(names.clone());
    let all = if all.is_empty() {
        "there is none".to_owned()
    } else {
        format!("there are: {all}")
    };
    match near_names(name, names).first() {
        Some(near) => format!("no {what} is called `{name}`, did you mean `{near}`? {all}"),
        None => format!("no {what} is called `{name}`; {all}"),
    }
}
