//! Non-smooth time stepping of deformable bodies in contact.
//!
//! A [`Model`] holds bodies, supports, loads, interfaces and a [`Scheme`]; a [`Stepper`] advances a
//! [`State`] by one step; [`march`] runs a whole span with step control and tells an [`Observer`].
//!
//! The scheme is the first-order theta/xi rule of non-smooth contact dynamics [Feng2007, eq. 38-41]
//! with the contact law at the position level (the papers) or at the velocity level (Moreau-Jean),
//! or without inertia. Every step ends with an energy audit whose terms all have their own formula.
//!
//! # Modules
//! A module uses those of the lines below it only:
//! ```text
//! march                                        from start to end, step control
//! audit                                        what the energies of a run went through
//! stepper                                      one step
//! accept          contact                      new state and report; contact problem of an iteration
//! monitor         operator        overlap      has it arrived; W; nodes inside the other body
//! body            search                       matrix and factor; what touches what
//! bonds           energy          law          adhesion; audit; error of the contact law
//! contact_stiffness               anchors      pressed contacts in an indefinite tangent; springs of floating bodies
//! newton_iterate                               what Newton's method improves
//! local           tunnelling                   slip and gap; steps that are too long
//! step_problem    unsupported                  what does not change in a step; bodies that nothing holds
//! elements        memory          floating     forces and tangents; contact forces of the nodes; rigid motions
//! model           scales          tally        what never changes, and its sizes; counters and times
//! scheme          report          linear       weights; what is told; sparse Cholesky factor
//! error  state  settings  ordering  blocked  swept  cost  flat
//! ```

/// The example of the README is a doc test.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;

mod accept;
mod anchors;
mod audit;
mod blocked;
mod body;
mod bonds;
mod contact;
mod contact_stiffness;
mod cost;
mod elements;
mod energy;
mod error;
mod flat;
mod floating;
mod law;
mod linear;
mod local;
mod march;
mod memory;
mod model;
mod monitor;
mod newton_iterate;
mod operator;
mod ordering;
mod overlap;
mod report;
mod scales;
mod scheme;
mod search;
mod settings;
mod state;
mod step_problem;
mod stepper;
mod swept;
mod tally;
mod tunnelling;
mod unsupported;

pub use contact_bipotential;
pub use fe_core;
pub use nalgebra;

pub use audit::EnergyAudit;
pub use error::{ContactPlace, NscdError, Side, StepFailure};
pub use march::{Observer, Span, Totals, march};
pub use model::{Load, Model, Rayleigh};
pub use report::{
    Clock, Counters, EnergyTerms, NoClock, Overlap, Phase, Phases, Rejection, Resultant, StepReport,
};
pub use scheme::{ContactLevel, Inertia, Scheme};
pub use settings::Settings;
pub use state::{BondState, ContactState, ContactStatus, NodeBond, State};
pub use stepper::Stepper;
