//! Who touches whom: interfaces, search, facets, obstacles, and the kinematics `H` between nodes and contacts.

mod carry;
mod detect;
mod error;
pub mod facet;
pub mod frame;
mod interface;
mod kinematics;
mod obstacle;
mod vec3;

pub use carry::material_axes;
pub use detect::{DetectionCounters, Detector};
pub use error::GeometryError;
pub use interface::{Interface, Master, RIM_TOLERANCE};
pub use kinematics::{CompliancePart, Contact, ContactMap, FrameRule, Stencil};
pub use obstacle::{Obstacle, PlacedObstacle, Shape};
