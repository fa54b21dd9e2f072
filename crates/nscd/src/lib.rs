//! Non-smooth time stepping of deformable bodies in contact.
//!
//! A [`Model`] holds bodies, supports, loads, interfaces and a [`Scheme`]; a [`Stepper`] advances a
//! [`State`] by one step; [`march`] runs a whole span with step control and tells an [`Observer`].
//!
//! The scheme is the first-order theta/xi rule of non-smooth contact dynamics [Feng2007, eq. 38-41]
//! with the contact law at the position level (the papers) or at the velocity level (Moreau-Jean),
//! or without inertia. Every step ends with an energy audit whose terms all have their own formula.

mod accept;
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
mod iterate;
mod law;
mod linear;
mod local;
mod march;
mod memory;
mod model;
mod monitor;
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
