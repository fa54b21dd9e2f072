//! Who touches whom: interfaces, search, facets, obstacles, and the kinematics `H` between nodes and contacts.

mod contact;
mod detect;
mod error;
mod facet;
mod interface;
mod kinematics;
mod material_frame;
mod obstacle;
mod vector;

pub use contact::{Contact, ContactKey, Stencil};
pub use detect::{DetectionCounters, Detector};
pub use error::{GeometryError, InterfaceFault};
pub use facet::{FacetPlace, FacetPoint, closest_point};
pub use interface::{Interface, Master, RIM_ROUND_OFF};
pub use kinematics::{CompliancePart, ContactMap, FrameRule};
pub use material_frame::material_frame;
pub use obstacle::{Obstacle, PlacedObstacle, Shape, SurfacePoint};
