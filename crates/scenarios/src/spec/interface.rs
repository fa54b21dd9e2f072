//! Contact interfaces.

use contact_bipotential::Shape;
use contact_bipotential::rcc::{DEFAULT_THRESHOLD, Healing, Reference, Update};
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
    /// A node closer than this to the master becomes a contact, open or closed \[m\]. The longest diagonal of a facet
    /// when absent, with adhesion at least ten times `sqrt(w / C_n)`, at which a bond carries most.
    #[serde(default)]
    pub search_distance: Option<f64>,
    /// Bonds between the surfaces, if any.
    #[serde(default)]
    pub adhesion: Option<Adhesion>,
}

impl Interface {
    /// A pair of surfaces without friction and bonds, all else left to its default, as in a file.
    #[must_use]
    pub fn new(slave: impl Into<String>, master: Master) -> Interface {
        Interface {
            slave: slave.into(),
            master,
            motion: Motion::default(),
            mu: 0.0,
            restitution: 0.0,
            search_distance: None,
            adhesion: None,
        }
    }
}

/// Bonds that break and heal: `b beta' = w - beta (C_n x_n^2 + C_t |u_t|^2)` with `0 <= beta <= 1` [Hu2022, eq. 12-15].
/// A bond pulls back with the traction `beta^2 C` times its stretch.
// Not the library's type: whether `C_t` was written as a number or a pair decides which paths (`C_t.1`) the scene has.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Adhesion {
    /// Normal stiffness of full bonds \[N/m^3\].
    #[serde(rename = "C_n")]
    pub normal_stiffness: f64,
    /// Tangential stiffness of full bonds \[N/m^3\], one number or one for each tangent.
    #[serde(rename = "C_t")]
    pub tangential_stiffness: Stiffness,
    /// Energy of full bonds (Dupre) \[J/m^2\].
    #[serde(rename = "w")]
    pub energy: f64,
    /// Viscosity of breaking and healing \[N s/m\]; 0 is independent of the rate.
    #[serde(rename = "b")]
    pub viscosity: f64,
    /// Intensity below which a bond that has opened is broken for good and its separation starts anew \[-\].
    #[serde(rename = "epsilon", default = "threshold")]
    pub threshold: f64,
    /// Bonds heal up to this gap \[m\]; 0 is in contact only.
    #[serde(default)]
    pub healing_gap: f64,
    /// Intensity at the start of what touches then \[-\].
    #[serde(rename = "beta", default)]
    pub initial: f64,
    /// Whether broken bonds come back.
    #[serde(default)]
    pub healing: Healing,
    /// What the tangential separation is measured from.
    #[serde(default)]
    pub reference: Reference,
    /// How the intensity advances in a step.
    #[serde(default)]
    pub update: Update,
    /// Friction coefficient of full bonds \[-\], linear in the intensity between `mu` and this; `mu` when absent.
    #[serde(rename = "mu_bonded", default)]
    pub bonded_friction: Option<f64>,
}

fn threshold() -> f64 {
    DEFAULT_THRESHOLD
}

/// A stiffness along the two tangents.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(untagged, expecting = "expected a number or a pair of numbers")]
pub enum Stiffness {
    /// The same along both.
    Equal(f64),
    /// Along the first and the second tangent.
    Pair([f64; 2]),
}

impl Stiffness {
    /// Along the first and the second tangent.
    pub fn pair(self) -> [f64; 2] {
        match self {
            Stiffness::Equal(value) => [value; 2],
            Stiffness::Pair(values) => values,
        }
    }
}

/// The master side of an interface. A rigid shape is free space outside. In a plane scene its section at z = 0 counts;
/// in an axisymmetric one that section sweeps a ring round the axis, so that a ball beside the axis is an O-ring.
///
/// A new rigid shape is a variant of the library's [`Shape`] and one here, with its arms of `Master::side` and
/// `Master::form`; checks, descriptions and models ask no more.
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
    /// Rigid cylinder with a flat end and a sharp edge, infinitely long; in the plane a strip.
    Punch {
        /// Centre of the flat end \[m\].
        center: [f64; 3],
        /// Direction from the flat end into the punch, any length but zero \[-\].
        axis: [f64; 3],
        /// Radius \[m\].
        radius: f64,
    },
}

/// What the master of an interface is.
pub(crate) enum Side<'a> {
    /// A facet set of a deformable body.
    Deformable(&'a str),
    /// A solid that does not deform.
    Rigid(Shape),
}

/// A master in words and by its values.
pub(crate) struct Form {
    /// For descriptions.
    pub(crate) words: String,
    /// What bounds apply to, by field.
    pub(crate) values: Vec<(&'static str, ShapeValue)>,
    /// Fields that have no z in a plane scene, so that the shape is symmetric about the plane of its section.
    pub(crate) flat: &'static [&'static str],
}

/// A value of a rigid shape by the bounds that it has.
#[derive(Clone, Copy)]
pub(crate) enum ShapeValue {
    /// A place \[m\].
    Point([f64; 3]),
    /// A direction of any length but zero \[-\].
    Direction([f64; 3]),
    /// A radius \[m\].
    Radius(f64),
    /// Angle between the axis and the surface of a cone \[degrees\].
    SemiApexAngle(f64),
}

impl Master {
    /// The facet set, or the shape of the library.
    pub(crate) fn side(&self) -> Side<'_> {
        Side::Rigid(match *self {
            Master::Facets(ref set) => return Side::Deformable(set),
            Master::Plane { point, normal } => Shape::Plane {
                point: point.into(),
                normal: normal.into(),
            },
            Master::Sphere { center, radius } => Shape::Sphere {
                center: center.into(),
                radius,
            },
            Master::Cylinder {
                point,
                axis,
                radius,
            } => Shape::Cylinder {
                point: point.into(),
                axis: axis.into(),
                radius,
            },
            Master::Cone {
                apex,
                axis,
                semi_apex_angle,
            } => Shape::Cone {
                apex: apex.into(),
                axis: axis.into(),
                semi_apex_angle: semi_apex_angle.to_radians(),
            },
            Master::Punch {
                center,
                axis,
                radius,
            } => Shape::Punch {
                center: center.into(),
                axis: axis.into(),
                radius,
            },
        })
    }

    /// Its words and values.
    pub(crate) fn form(&self) -> Form {
        use ShapeValue::{Direction, Point, Radius, SemiApexAngle};
        let rigid = |words: &str, flat, values: &[_]| Form {
            words: format!("rigid {words}"),
            values: values.to_vec(),
            flat,
        };
        match *self {
            Master::Facets(ref set) => Form {
                words: format!("`{set}`"),
                values: Vec::new(),
                flat: &[],
            },
            Master::Plane { point, normal } => {
                let values = [("point", Point(point)), ("normal", Direction(normal))];
                rigid("plane", &["normal"], &values)
            }
            Master::Sphere { center, radius } => {
                let values = [("center", Point(center)), ("radius", Radius(radius))];
                rigid("sphere", &["center"], &values)
            }
            Master::Cylinder {
                point,
                axis,
                radius,
            } => {
                let (place, way) = (("point", Point(point)), ("axis", Direction(axis)));
                let flat: &[_] = if along_z(axis) {
                    &[]
                } else {
                    &["point", "axis"]
                };
                rigid("cylinder", flat, &[place, way, ("radius", Radius(radius))])
            }
            Master::Cone {
                apex,
                axis,
                semi_apex_angle,
            } => {
                let (place, way) = (("apex", Point(apex)), ("axis", Direction(axis)));
                let angle = ("semi_apex_angle", SemiApexAngle(semi_apex_angle));
                rigid("cone", &["apex", "axis"], &[place, way, angle])
            }
            Master::Punch {
                center,
                axis,
                radius,
            } => {
                let (place, way) = (("center", Point(center)), ("axis", Direction(axis)));
                let values = [place, way, ("radius", Radius(radius))];
                rigid("punch", &["center", "axis"], &values)
            }
        }
    }
}

/// Largest component across a line that counts as none, as a part of the length of the vector \[-\]: round-off of a
/// direction given by sines and cosines, with room.
pub(crate) const FLAT: f64 = 1e-12;

/// True for a vector along z.
pub(crate) fn along_z([x, y, z]: [f64; 3]) -> bool {
    x.hypot(y) <= FLAT * z.abs()
}
