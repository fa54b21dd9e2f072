//! What a plane scene adds: all bodies of one kind, and nothing out of the plane.

use super::Checker;
use crate::spec::{FLAT, Load, Motion, ShapeValue, Symmetry, Table, along_z};

impl Checker<'_> {
    pub(super) fn plane(&mut self) {
        let scene = self.scene;
        let kind = |plane: bool| if plane { "plane" } else { "solid" };
        let plane = scene.is_plane();
        if let Some((first, _)) = scene.bodies.first() {
            for (name, body) in &scene.bodies {
                let other = body.mesh.is_plane();
                let message = format!(
                    "is a {} mesh, but body `{first}` is {}; all bodies of a scene are either plane or solid",
                    kind(other),
                    kind(plane)
                );
                self.require(other == plane, &format!("bodies.{name}.mesh"), message);
            }
        }
        if !plane {
            let message =
                "is for plane meshes (Rectangle, Disc, ..); these bodies are solid: leave it out";
            self.require(
                scene.symmetry.is_none() || scene.bodies.is_empty(),
                "symmetry",
                message,
            );
            return;
        }
        self.flat_bodies();
        self.flat_loads();
        self.flat_interfaces();
        for (name, probe) in &scene.output.probes {
            self.flat(probe.node, &format!("output.probes.{name}.node"), "m");
        }
    }

    fn axisymmetric(&self) -> bool {
        self.scene.symmetry == Some(Symmetry::Axisymmetric)
    }

    /// A vector in the x-y plane.
    fn flat(&mut self, vector: [f64; 3], path: &str, unit: &str) {
        let length = vector.iter().map(|v| v * v).sum::<f64>().sqrt();
        let fine = !length.is_finite() || vector[2].abs() <= FLAT * length;
        let message = format!("must be 0 [{unit}]: a plane scene has no z");
        self.require(fine, &format!("{path}.2"), message);
    }

    fn flat_bodies(&mut self) {
        let scene = self.scene;
        for (name, body) in &scene.bodies {
            self.flat(body.velocity, &format!("bodies.{name}.velocity"), "m/s");
            let [x, y, z] = body.spin;
            let (path, fine) = (format!("bodies.{name}.spin"), x == 0.0 && y == 0.0);
            self.require(
                fine,
                &path,
                "must be along z: a plane scene turns in its plane",
            );
            let fine = !self.axisymmetric() || z == 0.0;
            let message = "must be 0 [rad/s]: an axisymmetric body cannot turn out of its symmetry";
            self.require(fine, &path, message);
            let left = body.mesh.leftmost();
            let message = format!(
                "reaches to x = {left} [m]; in an axisymmetric scene x is the radius, 0 or more"
            );
            let fine = !self.axisymmetric() || !left.is_finite() || left >= 0.0;
            self.require(fine, &format!("bodies.{name}.mesh"), message);
        }
        for (name, given) in &scene.motions {
            let path = format!("motions.{name}");
            let [x, y, _] = given.mask();
            let message = "must hold x or y: a plane scene has no z";
            self.require(x || y, &format!("{path}.components"), message);
            self.flat_motion(&given.motion, &format!("{path}.motion"));
        }
    }

    fn flat_motion(&mut self, motion: &Motion, path: &str) {
        let Some((translation, rotation)) = motion.parts() else {
            return;
        };
        let message = "must be 0 [m]: a plane scene has no z";
        self.require(
            is_zero(&translation[2]),
            &format!("{path}.translation.2"),
            message,
        );
        let Some(rotation) = rotation else { return };
        let path = format!("{path}.rotation");
        if self.axisymmetric() {
            let message = "is impossible: an axisymmetric body cannot turn out of its symmetry";
            self.require(false, &path, message);
            return;
        }
        self.require(
            along_z(rotation.axis),
            &format!("{path}.axis"),
            "must be along z: a plane scene turns in its plane",
        );
    }

    fn flat_loads(&mut self) {
        for (name, load) in &self.scene.loads {
            let path = format!("loads.{name}");
            match load {
                Load::Gravity(acceleration) => {
                    self.flat(*acceleration, &path, "m/s^2");
                    let fine = !self.axisymmetric() || acceleration[0] == 0.0;
                    let message = "must be 0 [m/s^2]: gravity along the radius has no symmetry";
                    self.require(fine, &format!("{path}.0"), message);
                }
                Load::Traction { traction, .. } => {
                    self.flat(*traction, &format!("{path}.traction"), "Pa");
                }
            }
        }
    }

    /// A rigid shape acts by its section at z = 0, so it has to be symmetric about that plane.
    fn flat_interfaces(&mut self) {
        for (name, interface) in &self.scene.interfaces {
            let path = format!("interfaces.{name}");
            let master = format!("{path}.master");
            let form = interface.master.form();
            let flat = form.values.iter();
            for (field, value) in flat.filter(|(field, _)| form.flat.contains(field)) {
                let path = format!("{master}.{field}");
                match *value {
                    ShapeValue::Point(point) => self.flat(point, &path, "m"),
                    ShapeValue::Direction(direction) => self.flat(direction, &path, "-"),
                    ShapeValue::Radius(_) | ShapeValue::SemiApexAngle(_) => {}
                }
            }
            let path = format!("{path}.motion");
            self.flat_motion(&interface.motion, &path);
            let moves = interface.motion.parts().filter(|_| self.axisymmetric());
            if let Some((translation, _)) = moves {
                let message = "must be 0 [m]: a rigid ring keeps its radius";
                self.require(
                    is_zero(&translation[0]),
                    &format!("{path}.translation.0"),
                    message,
                );
            }
        }
    }
}

fn is_zero(table: &Table) -> bool {
    table.points().iter().all(|(_, value)| *value == 0.0)
}
