//! The first-order scheme: weights of the residual, velocity update, contact level.

use crate::error::NscdError;

/// Where the contact law is written.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum ContactLevel {
    /// Signorini on the gap at the end of the step, Coulomb on the slip of the step (the papers).
    #[default]
    Position,
    /// Moreau-Jean: Signorini on the velocity at the end of the step wherever the predicted gap
    /// closes, with restitution; Coulomb on the tangential velocity.
    Velocity,
}

/// With or without mass.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Inertia {
    /// Mass and velocities.
    #[default]
    Dynamic,
    /// No mass: every step is an equilibrium; velocities are only reported.
    QuasiStatic,
}

/// The theta/xi scheme [Feng2007, eq. 38-41].
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Scheme {
    /// Weight of the end velocity in the displacement, in `[1/2, 1]`.
    pub theta: f64,
    /// Weight of the end forces in the impulse, in `[1/2, 1]`.
    pub xi: f64,
    /// Where the contact law is written.
    pub contact: ContactLevel,
    /// With or without mass.
    pub inertia: Inertia,
}

/// The weights that make the residual of any scheme affine in `(F_int, A u, M u)`:
/// `A = stiffness K + damping A + mass M`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Weights {
    pub(crate) stiffness: f64,
    pub(crate) damping: f64,
    pub(crate) mass: f64,
}

impl Default for Scheme {
    /// The trapezoidal rule with contact at the position level.
    fn default() -> Self {
        Self::dynamic(0.5, 0.5)
    }
}

impl Scheme {
    /// Mass, velocities and contact at the position level; `theta` and `xi` are 0.5 for the trapezoidal rule, which
    /// loses no energy in the bodies, up to 1 for backward Euler, which loses most.
    #[must_use]
    pub const fn dynamic(theta: f64, xi: f64) -> Self {
        Self {
            theta,
            xi,
            contact: ContactLevel::Position,
            inertia: Inertia::Dynamic,
        }
    }

    /// A path of equilibria, with contact at the position level.
    #[must_use]
    pub const fn quasi_static() -> Self {
        Self {
            theta: 1.0,
            xi: 1.0,
            contact: ContactLevel::Position,
            inertia: Inertia::QuasiStatic,
        }
    }

    /// The same scheme with the contact law at another level.
    #[must_use]
    pub const fn with_contact(self, contact: ContactLevel) -> Self {
        Self { contact, ..self }
    }

    /// The same scheme with or without mass. An equilibrium path weighs the end forces alone, whatever `xi` is.
    #[must_use]
    pub const fn with_inertia(self, inertia: Inertia) -> Self {
        Self { inertia, ..self }
    }

    /// Refuses parameters outside the range in which the scheme is stable.
    ///
    /// # Errors
    /// [`NscdError::Setting`] with the bound, [`NscdError::VelocityWithoutInertia`].
    pub(crate) fn validated(self) -> Result<Self, NscdError> {
        let allowed = "between 0.5 (trapezoidal rule) and 1 (backward Euler)";
        for (name, value) in [("theta", self.theta), ("xi", self.xi)] {
            if !(0.5..=1.0).contains(&value) {
                return Err(NscdError::Setting {
                    name,
                    value,
                    allowed,
                });
            }
        }
        if self.contact == ContactLevel::Velocity && self.inertia == Inertia::QuasiStatic {
            return Err(NscdError::VelocityWithoutInertia);
        }
        Ok(self)
    }

    /// Weight of the end forces in the balance; an equilibrium knows no other.
    pub(crate) fn force_weight(&self) -> f64 {
        match self.inertia {
            Inertia::Dynamic => self.xi,
            Inertia::QuasiStatic => 1.0,
        }
    }

    /// Ratio of a change of end velocity to a change of end displacement \[1/s\].
    pub(crate) fn velocity_rate(&self, dt: f64) -> f64 {
        match self.inertia {
            Inertia::Dynamic => 1.0 / (self.theta * dt),
            Inertia::QuasiStatic => 1.0 / dt,
        }
    }

    /// Weight of the start velocity over that of the end velocity in the displacement of a step \[-\].
    pub(crate) fn start_weight(&self) -> f64 {
        (1.0 - self.theta) / self.theta
    }

    pub(crate) fn weights(&self, dt: f64) -> Weights {
        let rate = self.velocity_rate(dt);
        let stiffness = self.force_weight();
        let mass = match self.inertia {
            Inertia::Dynamic => rate / dt,
            Inertia::QuasiStatic => 0.0,
        };
        Weights {
            stiffness,
            damping: stiffness * rate,
            mass,
        }
    }

    /// End velocity of a free unknown [Feng2007, eq. 47].
    pub(crate) fn end_velocity(&self, v0: f64, du: f64, dt: f64) -> f64 {
        match self.inertia {
            Inertia::Dynamic => (1.0 - 1.0 / self.theta) * v0 + du / (self.theta * dt),
            Inertia::QuasiStatic => du / dt,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn end_velocity_inverts_the_displacement_rule() {
        let scheme = Scheme::dynamic(0.7, 0.6);
        let (v0, v1, dt) = (0.3, -1.2, 0.01);
        let du = dt * ((1.0 - 0.7) * v0 + 0.7 * v1);
        assert!((scheme.end_velocity(v0, du, dt) - v1).abs() < 1e-12);
        let slope = scheme.end_velocity(v0, du + 1e-3, dt) - scheme.end_velocity(v0, du, dt);
        assert!((slope / 1e-3 - scheme.velocity_rate(dt)).abs() < 1e-8);
    }

    #[test]
    fn unstable_parameters_are_refused() {
        let scheme = Scheme::dynamic(0.4, 0.5);
        assert!(scheme.validated().is_err());
        let still = Scheme::quasi_static().with_contact(ContactLevel::Velocity);
        assert!(matches!(
            still.validated(),
            Err(NscdError::VelocityWithoutInertia)
        ));
    }
}
