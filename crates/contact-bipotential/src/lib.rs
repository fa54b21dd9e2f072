//! Unilateral contact with Coulomb friction by the bi-potential method: the contact problem, its solvers, and contact
//! search. No elements, no materials.
//!
//! Without the default feature `geometry` there is no mesh either: `W`, `q` and `mu` make a [`ContactProblem`],
//! [`solve`] solves it. The feature `conformance` has problems to try a solver on.
//!
//! Most names stand here. [`cone`] holds the projections and the bi-potential, [`rcc`] the law of adhesion with its
//! choices, [`flat`] the sums over flat vectors that others share.
//!
//! Conventions, once: `n` points out of the master towards the slave, `x = X_slave - X_master` in the local frame
//! `(t1, t2, n)`, normal **last**; `r` acts on the slave; `x_n >= 0` is separation, `r_n >= 0` compression.

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;

mod anderson;
pub mod cone;
#[cfg(any(test, feature = "conformance"))]
pub mod conformance;
mod delassus;
mod error;
mod error_measure;
mod extended;
pub mod flat;
#[cfg(feature = "geometry")]
mod geometry;
mod global;
mod law;
mod local;
mod problem;
pub mod rcc;
mod solve;

pub use nalgebra;

pub use anderson::Anderson;
pub use cone::Cone;
pub use delassus::{BlockSparse, Delassus, DelassusOperator, DenseMatrix};
pub use error::{ContactError, ParameterError};
pub use error_measure::{ErrorMeasure, Errors, errors, law_residual};
#[cfg(feature = "geometry")]
pub use geometry::{
    CompliancePart, Contact, ContactKey, ContactMap, DetectionCounters, Detector, FacetPlace,
    FacetPoint, FrameRule, GeometryError, Interface, InterfaceFault, Master, Obstacle,
    PlacedObstacle, RIM_ROUND_OFF, Shape, Stencil, SurfacePoint, closest_point, material_frame,
};
pub use global::{GlobalProblem, SparseEntries};
pub use law::{ContactDiagnostic, Status, natural_map};
pub use local::{Matrix, Vector};
pub use problem::ContactProblem;
pub use rcc::{Adhesion, Bond, BondStep};
pub use solve::{
    Method, Outcome, SequenceSolver, SingleContact, SingleSolution, SolveSettings, SolveStatus,
    Work, freeze_bonds, solve, solve_bonded, solve_single,
};
