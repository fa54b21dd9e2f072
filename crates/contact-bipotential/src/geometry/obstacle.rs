//! Rigid obstacles with prescribed motion: shape, signed gap, normal and the motion of the point under a contact.

use fe_core::{Motion, Rotation};
use nalgebra::Vector3;

use crate::error::ParameterError;
use crate::geometry::error::{GeometryError, InterfaceFault};
use crate::geometry::vector::{reject, unit};

/// A rigid solid; what is outside of it is free space. Lengths in \[m\], at the reference position of the motion.
///
/// In the plane z = 0 a sphere is a disc, a cylinder along z too, a cone a wedge, a punch a strip; in axisymmetry a
/// sphere, cone or punch on the axis is itself.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Shape {
    /// A half-space.
    Plane {
        /// A point of its surface \[m\].
        point: Vector3<f64>,
        /// Direction out of the solid; any length but zero.
        normal: Vector3<f64>,
    },
    /// A ball.
    Sphere {
        /// Centre \[m\].
        center: Vector3<f64>,
        /// Radius \[m\].
        radius: f64,
    },
    /// An infinitely long solid cylinder.
    Cylinder {
        /// A point on the axis \[m\].
        point: Vector3<f64>,
        /// Direction of the axis; any length but zero.
        axis: Vector3<f64>,
        /// Radius \[m\].
        radius: f64,
    },
    /// An infinitely tall solid cone: a sharp indenter.
    Cone {
        /// Apex \[m\].
        apex: Vector3<f64>,
        /// Direction from the apex into the solid; any length but zero.
        axis: Vector3<f64>,
        /// Angle between axis and surface \[rad\], in (0, pi/2).
        semi_apex_angle: f64,
    },
    /// An infinitely tall solid cylinder with a flat end and a sharp edge: a flat indenter.
    Punch {
        /// Centre of the flat end \[m\].
        center: Vector3<f64>,
        /// Direction from the flat end into the solid; any length but zero.
        axis: Vector3<f64>,
        /// Radius \[m\].
        radius: f64,
    },
}

impl Shape {
    /// The same shape with unit directions, its parameters checked.
    fn checked(self) -> Result<Self, GeometryError> {
        match self {
            Shape::Plane { point, normal } => Ok(Shape::Plane {
                point: finite("plane point", point)?,
                normal: direction("plane normal", normal)?,
            }),
            Shape::Sphere { center, radius } => Ok(Shape::Sphere {
                center: finite("sphere center", center)?,
                radius: positive("sphere radius [m]", radius)?,
            }),
            Shape::Cylinder {
                point,
                axis,
                radius,
            } => Ok(Shape::Cylinder {
                point: finite("cylinder point", point)?,
                axis: direction("cylinder axis", axis)?,
                radius: positive("cylinder radius [m]", radius)?,
            }),
            Shape::Cone {
                apex,
                axis,
                semi_apex_angle,
            } => {
                let inside = semi_apex_angle > 0.0 && semi_apex_angle < std::f64::consts::FRAC_PI_2;
                if !inside {
                    return Err(GeometryError::Parameter(ParameterError {
                        name: "semi-apex angle [rad]",
                        value: semi_apex_angle,
                        bound: "must lie between 0 and pi/2 (90 degrees), both excluded",
                    }));
                }
                Ok(Shape::Cone {
                    apex: finite("cone apex", apex)?,
                    axis: direction("cone axis", axis)?,
                    semi_apex_angle,
                })
            }
            Shape::Punch {
                center,
                axis,
                radius,
            } => Ok(Shape::Punch {
                center: finite("punch center", center)?,
                axis: direction("punch axis", axis)?,
                radius: positive("punch radius [m]", radius)?,
            }),
        }
    }

    /// The shape where the motion takes it at time `t` \[s\].
    fn moved(&self, motion: &Motion, t: f64) -> Self {
        let place = |x| motion.position(x, t);
        let turn = |a| motion.rotate(a, t);
        match *self {
            Shape::Plane { point, normal } => Shape::Plane {
                point: place(point),
                normal: turn(normal),
            },
            Shape::Sphere { center, radius } => Shape::Sphere {
                center: place(center),
                radius,
            },
            Shape::Cylinder {
                point,
                axis,
                radius,
            } => Shape::Cylinder {
                point: place(point),
                axis: turn(axis),
                radius,
            },
            Shape::Cone {
                apex,
                axis,
                semi_apex_angle,
            } => Shape::Cone {
                apex: place(apex),
                axis: turn(axis),
                semi_apex_angle,
            },
            Shape::Punch {
                center,
                axis,
                radius,
            } => Shape::Punch {
                center: place(center),
                axis: turn(axis),
                radius,
            },
        }
    }

    /// Closest surface point to `x`; the shape must have unit directions.
    ///
    /// `core` \[m\]: a point this close to a place without a normal (centre, axis, apex, edge) takes the definite one.
    /// `advance` \[m\]: how far a flat end has come out of the solid.
    fn closest(&self, x: Vector3<f64>, core: f64, advance: f64) -> SurfacePoint {
        match *self {
            Shape::Plane { point, normal } => {
                let gap = normal.dot(&(x - point));
                SurfacePoint {
                    gap,
                    normal,
                    point: x - gap * normal,
                }
            }
            Shape::Sphere { center, radius } => {
                round(x - center, center, radius, core, Vector3::y())
            }
            Shape::Cylinder {
                point,
                axis,
                radius,
            } => {
                let along = point + (x - point).dot(&axis) * axis;
                round(reject(x - point, axis), along, radius, core, across(axis))
            }
            Shape::Cone {
                apex,
                axis,
                semi_apex_angle,
            } => cone(x, apex, axis, semi_apex_angle, core),
            Shape::Punch {
                center,
                axis,
                radius,
            } => punch(x, center, axis, radius, core, advance),
        }
    }
}

/// The surface point of an obstacle closest to a node.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct SurfacePoint {
    /// Signed distance \[m\], negative inside the solid.
    pub gap: f64,
    /// Unit normal out of the solid.
    pub normal: Vector3<f64>,
    /// The point \[m\].
    pub point: Vector3<f64>,
}

fn round(
    arm: Vector3<f64>,
    center: Vector3<f64>,
    radius: f64,
    core: f64,
    definite: Vector3<f64>,
) -> SurfacePoint {
    let distance = arm.norm();
    let normal = if distance > core {
        unit(arm).unwrap_or(definite)
    } else {
        definite
    };
    SurfacePoint {
        gap: distance - radius,
        normal,
        point: center + radius * normal,
    }
}

/// Largest z of a unit vector \[-\] that is far enough from the z axis to be told from it.
const OFF_AXIS: f64 = 0.9;

/// A fixed direction perpendicular to a unit vector.
fn across(axis: Vector3<f64>) -> Vector3<f64> {
    let k = if axis[2].abs() < OFF_AXIS {
        Vector3::z()
    } else {
        Vector3::x()
    };
    unit(reject(k, axis)).unwrap_or(k)
}

/// In the half-plane (radius rho, depth s along the axis) the surface is the ray along `(sin a, cos a)`.
///
/// The apex has no normal, and on the axis inside the solid every direction around is equally close: within
/// `core` of either the normal is `-axis` and the gap the depth. A node under the tip then meets the tip
/// head-on, whatever its round-off, instead of being pushed aside.
fn cone(
    x: Vector3<f64>,
    apex: Vector3<f64>,
    axis: Vector3<f64>,
    angle: f64,
    core: f64,
) -> SurfacePoint {
    let arm = x - apex;
    let s = arm.dot(&axis);
    let side = reject(arm, axis);
    let rho = side.norm();
    let (sin, cos) = angle.sin_cos();
    let along = rho * sin + s * cos;
    let tip = |gap, normal| SurfacePoint {
        gap,
        normal,
        point: apex,
    };
    if rho <= core {
        return tip(-s, -axis);
    }
    if along <= 0.0 {
        let distance = arm.norm();
        return tip(distance, unit(arm).unwrap_or(-axis));
    }
    let out = (1.0 / rho) * side;
    let normal = cos * out - sin * axis;
    let point = apex + (along * sin) * out + (along * cos) * axis;
    SurfacePoint {
        gap: rho * cos - s * sin,
        normal,
        point,
    }
}

/// In the half-plane (radius rho, depth s along the axis) the surface is the face s = 0 up to the edge at the radius,
/// and the wall above it.
///
/// A node inside leaves by the way that is shorter, but one that the face has swept over in this step leaves by the
/// face, however near to the wall: a step that is long against the elements at the edge must not push nodes aside.
/// Within `core` of the edge a node is under the face.
fn punch(
    x: Vector3<f64>,
    center: Vector3<f64>,
    axis: Vector3<f64>,
    radius: f64,
    core: f64,
    advance: f64,
) -> SurfacePoint {
    let arm = x - center;
    let s = arm.dot(&axis);
    let side = reject(arm, axis);
    let rho = side.norm();
    let swept = s <= advance.max(radius - rho).max(core);
    if rho <= radius + core && swept {
        return SurfacePoint {
            gap: -s,
            normal: -axis,
            point: x - s * axis,
        };
    }
    let out = if rho > core {
        (1.0 / rho) * side
    } else {
        across(axis)
    };
    let point = center + radius * out + s.max(0.0) * axis;
    if s >= 0.0 {
        return SurfacePoint {
            gap: rho - radius,
            normal: out,
            point,
        };
    }
    let to_node = x - point;
    SurfacePoint {
        gap: to_node.norm(),
        normal: unit(to_node).unwrap_or(out),
        point,
    }
}

/// A shape with its motion.
#[derive(Clone, Debug, PartialEq)]
pub struct Obstacle {
    shape: Shape,
    motion: Motion,
}

impl Obstacle {
    /// An obstacle that is where its shape says at zero displacement.
    ///
    /// # Errors
    /// [`GeometryError`] with the bound when a parameter of the shape lies outside of it: points and radii must be
    /// finite, radii positive, directions not zero, the semi-apex angle between 0 and 90 degrees.
    pub fn new(shape: Shape, motion: Motion) -> Result<Self, GeometryError> {
        Ok(Self {
            shape: shape.checked()?,
            motion,
        })
    }

    /// The shape at its reference position, with unit directions.
    #[must_use]
    pub fn shape(&self) -> &Shape {
        &self.shape
    }

    /// The motion.
    #[must_use]
    pub fn motion(&self) -> &Motion {
        &self.motion
    }

    /// Whether the obstacle can bound a body in the plane z = 0.
    ///
    /// # Errors
    /// Where its normals or its motion leave the plane.
    pub(crate) fn validate_in_plane(&self) -> Result<(), InterfaceFault> {
        let (part, z) = match self.shape {
            Shape::Plane { normal, .. } => ("z of a plane's normal", normal[2]),
            Shape::Sphere { center, .. } => ("z of a sphere's center [m]", center[2]),
            Shape::Cylinder { axis, .. } => {
                ("part of a cylinder's axis across z", axis[0].hypot(axis[1]))
            }
            Shape::Cone { apex, axis, .. } if axis[2] == 0.0 => ("z of a cone's apex [m]", apex[2]),
            Shape::Cone { axis, .. } => ("z of a cone's axis", axis[2]),
            Shape::Punch { center, axis, .. } if axis[2] == 0.0 => {
                ("z of a punch's center [m]", center[2])
            }
            Shape::Punch { axis, .. } => ("z of a punch's axis", axis[2]),
        };
        if z != 0.0 {
            return Err(InterfaceFault::ShapeOutOfPlane { part, z });
        }
        let tilts = |r: &Rotation| !r.angle().is_zero() && r.axis()[2].abs() != 1.0;
        let leaves = !self.motion.translation[2].is_zero()
            || self.motion.rotation.as_ref().is_some_and(tilts);
        if leaves {
            return Err(InterfaceFault::MotionOutOfPlane);
        }
        Ok(())
    }

    /// The obstacle at the end of a step from `t0` to `t1` \[s\].
    #[must_use]
    pub fn over_step(&self, t0: f64, t1: f64) -> PlacedObstacle<'_> {
        let mut placed = PlacedObstacle {
            shape: self.shape.moved(&self.motion, t1),
            motion: (!self.motion.is_still()).then_some(&self.motion),
            advance: 0.0,
            t0,
            t1,
        };
        if let Shape::Punch { center, axis, .. } = placed.shape {
            placed.advance = -axis.dot(&placed.displacement(center));
        }
        placed
    }
}

/// An obstacle at the end of a step: positions evaluated once, then asked for many nodes.
#[derive(Clone, Debug)]
pub struct PlacedObstacle<'a> {
    shape: Shape,
    motion: Option<&'a Motion>,
    /// How far a flat end comes out of the solid during the step \[m\].
    advance: f64,
    t0: f64,
    t1: f64,
}

impl PlacedObstacle<'_> {
    /// The shape at the end of the step.
    #[must_use]
    pub fn shape(&self) -> &Shape {
        &self.shape
    }

    /// Gap, normal and closest point for the position `x` \[m\] at the end of the step.
    ///
    /// `core` \[m\], small against the mesh: nearer than this to a centre, an axis or an apex, where there is no
    /// unique normal, a fixed one is taken: along the axis out of the apex (cone) or the face (edge of a punch), `e_y`
    /// (sphere), or a fixed direction across the axis (cylinder).
    ///
    /// A node that the face of a punch has swept over in this step meets the face, even where the wall is nearer.
    #[must_use]
    pub fn closest(&self, x: Vector3<f64>, core: f64) -> SurfacePoint {
        self.shape.closest(x, core, self.advance)
    }

    /// Displacement \[m\] over the step of the obstacle's material point that ends it at `point` \[m\].
    #[must_use]
    pub fn displacement(&self, point: Vector3<f64>) -> Vector3<f64> {
        self.motion.map_or_else(Vector3::zeros, |motion| {
            let x = motion.pull_back(point, self.t1);
            motion.displacement(x, self.t1) - motion.displacement(x, self.t0)
        })
    }
}

fn finite(name: &'static str, x: Vector3<f64>) -> Result<Vector3<f64>, ParameterError> {
    match x.iter().find(|c| !c.is_finite()) {
        Some(&value) => Err(ParameterError {
            name,
            value,
            bound: "must be finite",
        }),
        None => Ok(x),
    }
}

fn direction(name: &'static str, a: Vector3<f64>) -> Result<Vector3<f64>, ParameterError> {
    unit(a).ok_or(ParameterError {
        name,
        value: a.norm(),
        bound: "must be a finite vector of length > 0",
    })
}

fn positive(name: &'static str, value: f64) -> Result<f64, ParameterError> {
    if value > 0.0 && value.is_finite() {
        Ok(value)
    } else {
        Err(ParameterError {
            name,
            value,
            bound: "must be positive and finite",
        })
    }
}

#[cfg(test)]
mod tests;
