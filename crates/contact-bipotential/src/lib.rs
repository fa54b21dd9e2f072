//! Unilateral contact with Coulomb friction by the bi-potential method: the contact problem, its solvers, and contact
//! search. No elements, no materials.
//!
//! Conventions, once: `n` points out of the master towards the slave, `x = X_slave - X_master` in the local frame
//! `(t1, t2, n)`, normal **last**; `r` acts on the slave; `x_n >= 0` is separation, `r_n >= 0` compression.

pub mod carry;
pub mod cone;
pub mod conformance;
pub mod delassus;
pub mod detect;
pub mod error;
pub mod facet;
pub mod frame;
pub mod global;
pub mod interface;
pub mod kinematics;
pub mod law;
pub mod local;
pub mod obstacle;
pub mod problem;
pub mod rcc;
pub mod solve;
pub mod truth;

mod vec3;

pub use carry::material_axes;
pub use cone::Cone;
pub use delassus::{BlockSparse, Delassus, DelassusOperator};
pub use detect::{DetectionCounters, Detector};
pub use error::ContactError;
pub use global::{GlobalProblem, SparseEntries};
pub use interface::{GeometryError, Interface, Master};
pub use kinematics::{CompliancePart, Contact, ContactMap, Stencil};
pub use law::{ContactDiagnostic, Status};
pub use obstacle::{Obstacle, Shape};
pub use problem::ContactProblem;
pub use rcc::{Adhesion, Bond, BondStep};
pub use solve::sequence::SequenceSolver;
pub use solve::{Method, Outcome, SolveSettings, SolveStatus, Work, solve, solve_bonded};
pub use truth::{Errors, errors};
