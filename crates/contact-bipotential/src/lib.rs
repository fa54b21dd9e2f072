//! Unilateral contact with Coulomb friction by the bi-potential method: the contact problem, its solvers, and contact
//! search. No elements, no materials.
//!
//! Conventions, once: `n` points out of the master towards the slave, `x = X_slave - X_master` in the local frame
//! `(t1, t2, n)`, normal **last**; `r` acts on the slave; `x_n >= 0` is separation, `r_n >= 0` compression.

pub mod cone;
#[cfg(any(test, feature = "conformance"))]
pub mod conformance;
pub mod delassus;
pub mod error;
#[cfg(feature = "geometry")]
mod geometry;
pub mod global;
pub mod law;
pub mod local;
pub mod problem;
pub mod rcc;
pub mod solve;
pub mod truth;

pub use nalgebra;

pub use cone::Cone;
pub use delassus::{BlockSparse, Delassus, DelassusOperator};
pub use error::{ContactError, ParameterError};
#[cfg(feature = "geometry")]
pub use geometry::{
    CompliancePart, Contact, ContactKey, ContactMap, DetectionCounters, Detector, FacetPlace,
    FacetPoint, FrameRule, GeometryError, Interface, InterfaceFault, Master, Obstacle,
    PlacedObstacle, RIM_ROUND_OFF, Shape, Stencil, SurfacePoint, closest_point, material_frame,
};
pub use global::{GlobalProblem, SparseEntries};
pub use law::{ContactDiagnostic, Status};
pub use problem::ContactProblem;
pub use rcc::{Adhesion, Bond, BondStep};
pub use solve::sequence::SequenceSolver;
pub use solve::{Method, Outcome, SolveSettings, SolveStatus, Work, solve, solve_bonded};
pub use truth::{Errors, errors};
