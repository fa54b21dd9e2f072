//! Contact interfaces.

use serde::{Deserialize, Serialize};

use super::Motion;

/// A pair of surfaces that can touch: the nodes of the slave do not enter the master.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Interface {
    /// Facet set whose nodes are checked against the master, `body.set`.
    pub slave: String,
    /// The other side.
    pub master: Master,
    /// Motion of a rigid master; a deformable one moves by itself.
    #[serde(default)]
    pub motion: Motion,
    /// Coulomb friction coefficient \[-\]; 0 is frictionless and cheaper.
    #[serde(default)]
    pub mu: f64,
    /// Newton's coefficient of restitution \[-\], 0 to 1; needs `time.contact: Velocity` when not zero.
    #[serde(default)]
    pub restitution: f64,
}

/// The master side of an interface. A rigid shape is free space outside.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum Master {
    /// Facet set of a deformable body, `body.set`.
    Facets(String),
    /// Rigid half-space.
    Plane {
        /// A point of the plane \[m\].
        point: [f64; 3],
        /// Direction out of the half-space into free space, any length but zero \[-\].
        normal: [f64; 3],
    },
    /// Rigid ball.
    Sphere {
        /// Centre \[m\].
        center: [f64; 3],
        /// Radius \[m\].
        radius: f64,
    },
    /// Rigid cylinder, infinitely long.
    Cylinder {
        /// A point of the axis \[m\].
        point: [f64; 3],
        /// Direction of the axis, any length but zero \[-\].
        axis: [f64; 3],
        /// Radius \[m\].
        radius: f64,
    },
    /// Rigid cone, infinitely long.
    Cone {
        /// Tip \[m\].
        apex: [f64; 3],
        /// Direction from the tip into the cone, any length but zero \[-\].
        axis: [f64; 3],
        /// Angle between the axis and the surface \[degrees\], between 0 and 90.
        semi_apex_angle: f64,
    },
}

impl Master {
    /// True for a shape that does not deform.
    pub fn is_rigid(&self) -> bool {
        !matches!(self, Master::Facets(_))
    }
}
