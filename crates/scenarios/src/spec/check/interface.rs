//! Interfaces: shapes, friction, bonds.

use super::Checker;
use crate::spec::{
    Adhesion, ContactLevel, Healing, Interface, Master, Motion, ShapeValue, Stiffness, Update,
};

impl Checker<'_> {
    pub(super) fn interfaces(&mut self) {
        for (name, interface) in &self.scene.interfaces {
            let path = format!("interfaces.{name}");
            self.set(&interface.slave, "facet", &format!("{path}.slave"));
            self.master(interface, &path);
            self.not_negative(interface.mu, &format!("{path}.mu"), "-");
            let e = format!("{path}.restitution");
            self.between(interface.restitution, 0.0, 1.0, &e, "-");
            let velocity = self.scene.time.contact == ContactLevel::Velocity;
            self.require(
                interface.restitution == 0.0 || velocity,
                &e,
                "needs time.contact: Velocity",
            );
            if let Some(reach) = interface.search_distance {
                self.positive(reach, &format!("{path}.search_distance"), "m");
            }
            if let Some(adhesion) = &interface.adhesion {
                self.adhesion(adhesion, &format!("{path}.adhesion"));
            }
        }
    }

    fn master(&mut self, interface: &Interface, path: &str) {
        let master = format!("{path}.master");
        if let Master::Facets(facets) = &interface.master {
            self.set(facets, "facet", &master);
            self.require(
                *facets != interface.slave,
                &master,
                "must not be the slave itself",
            );
            let body = |set: &str| set.split_once('.').map(|(body, _)| body.to_owned());
            let itself =
                body(facets).filter(|master| Some(master) == body(&interface.slave).as_ref());
            let message = format!(
                "is a side of body `{}`, as the slave is: contact of a body with itself is not supported; let the master be \
                 another body or a rigid shape",
                itself.as_deref().unwrap_or_default()
            );
            self.require(
                itself.is_none() || *facets == interface.slave,
                &master,
                message,
            );
            let still = interface.motion == Motion::Fixed;
            self.require(
                still,
                &format!("{path}.motion"),
                "is for rigid masters; move a body by motions",
            );
        }
        for (field, value) in interface.master.form().values {
            let path = format!("{master}.{field}");
            match value {
                ShapeValue::Point(point) => self.finite(&point, &path),
                ShapeValue::Direction(direction) => self.direction(direction, &path),
                ShapeValue::Radius(radius) => self.positive(radius, &path, "m"),
                ShapeValue::SemiApexAngle(angle) => {
                    let sharp = angle > 0.0 && angle < 90.0;
                    self.require(sharp, &path, "must be between 0 and 90 [degrees]");
                }
            }
        }
        self.motion(&interface.motion, &format!("{path}.motion"));
    }

    /// The bounds of the law of bonds [Hu2022, eq. 12-15].
    fn adhesion(&mut self, adhesion: &Adhesion, path: &str) {
        let field = |name: &str| format!("{path}.{name}");
        let [first, second] = adhesion.tangential_stiffness.pair();
        self.not_negative(adhesion.normal_stiffness, &field("C_n"), "N/m^3");
        match adhesion.tangential_stiffness {
            Stiffness::Equal(value) => self.not_negative(value, &field("C_t"), "N/m^3"),
            Stiffness::Pair(values) => {
                for (i, value) in values.into_iter().enumerate() {
                    self.not_negative(value, &field(&format!("C_t.{i}")), "N/m^3");
                }
            }
        }
        self.not_negative(adhesion.energy, &field("w"), "J/m^2");
        let weak = adhesion.normal_stiffness == 0.0 && first == 0.0 && second == 0.0;
        self.require(
            !(weak && adhesion.energy > 0.0),
            &field("C_n"),
            "must be greater than 0 [N/m^3], or C_t must: a bond with w > 0 and no stiffness carries nothing and never breaks",
        );
        self.not_negative(adhesion.viscosity, &field("b"), "N s/m");
        self.require(
            adhesion.viscosity > 0.0 || adhesion.update == Update::SecondOrder,
            &field("b"),
            "must be greater than 0 [N s/m] with update: EnergyConsistent",
        );
        let inside = adhesion.threshold > 0.0 && adhesion.threshold < 1.0;
        self.require(inside, &field("epsilon"), "must be between 0 and 1 [-]");
        self.not_negative(adhesion.healing_gap, &field("healing_gap"), "m");
        self.require(
            adhesion.healing == Healing::Recoverable || adhesion.healing_gap == 0.0,
            &field("healing_gap"),
            "needs healing: Recoverable; irreversible bonds never heal, at no gap",
        );
        self.between(adhesion.initial, 0.0, 1.0, &field("beta"), "-");
        if let Some(mu) = adhesion.bonded_friction {
            self.not_negative(mu, &field("mu_bonded"), "-");
        }
        self.require(
            self.scene.time.contact == ContactLevel::Position,
            path,
            "needs time.contact: Position; bonds are laws of the separation, not of its velocity",
        );
    }
}
