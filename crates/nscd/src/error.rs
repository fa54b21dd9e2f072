//! What can go wrong below a scene, with the place and what to try.

use std::fmt;

use contact_bipotential::{GeometryError, Method};
use fe_core::FeError;

/// What to try where a contact problem was not solved.
const CONTACT_ADVICE: &str = "try smaller steps";
/// The same where bonds of a surface may catch or let go all at once.
const SNAP_ADVICE: &str = "try smaller steps; where bonds catch or let go all at once there is no equilibrium on the way, but with some \
                           viscosity b of the bonds or inertia of the bodies there is a motion";

/// A contact that an error speaks of.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct ContactPlace {
    /// Name of the interface.
    pub interface: String,
    /// Slave node.
    pub node: u32,
    /// Its gap \[m\].
    pub gap: f64,
}

impl fmt::Display for ContactPlace {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self {
            interface,
            node,
            gap,
        } = self;
        write!(
            f,
            "node {node} of interface \"{interface}\" (gap {gap:e} m)"
        )
    }
}

fn place(contact: &Option<ContactPlace>) -> String {
    let none = || "no contact".to_owned();
    contact.as_ref().map_or_else(none, ContactPlace::to_string)
}

/// A side of an interface.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Side {
    /// The nodes that may not enter.
    Slave,
    /// The surface that may not be entered.
    Master,
}

impl fmt::Display for Side {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Side::Slave => "slave",
            Side::Master => "master",
        })
    }
}

/// Why a model was refused or a run stopped.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum NscdError {
    /// The sparse matrix of a body could not be analysed.
    #[error(
        "the matrix of a body with {unknowns} unknowns could not be analysed: {reason}; try a coarser mesh"
    )]
    Symbolic {
        /// Unknowns of the body.
        unknowns: usize,
        /// What the factorization said.
        reason: String,
    },
    /// A setting outside its bounds.
    #[error("{name} = {value} is not possible: {allowed}")]
    Setting {
        /// Name of the setting.
        name: &'static str,
        /// Its value.
        value: f64,
        /// What is allowed.
        allowed: &'static str,
    },
    /// A quasi-static body that nothing holds.
    #[error(
        "the prescribed motions leave the body of node {node} free to move as a whole, and no interface could hold it: without \
         inertia nothing does; hold more of its nodes, let it touch something, or give it inertia"
    )]
    Unsupported {
        /// First node of the body.
        node: usize,
    },
    /// A node of an interface that starts under the other side, where no contact holds it.
    #[error(
        "node {node} of interface \"{interface}\" starts inside the body of the {side}, {depth:e} m under its surface and {under:e} m \
         from the {side} itself, and no contact is found for it (search_distance: {reach:e} m); start the bodies apart, set a larger \
         search_distance, or let the {side} reach to where the node came in"
    )]
    Overlap {
        /// The side under which it lies.
        side: Side,
        /// The node.
        node: u32,
        /// Name of the interface.
        interface: String,
        /// Its distance to the nearest boundary of that body \[m\].
        depth: f64,
        /// Its distance to that side \[m\].
        under: f64,
        /// Reach of the search \[m\].
        reach: f64,
    },
    /// A node of an interface that starts so deep inside its master that pushing it out would make energy.
    #[error(
        "{nodes} nodes of interface \"{interface}\" start inside their master, node {node} {depth:e} m deep (allowed: {allowed:e} m): a \
         motion would get its energy from nothing; start the bodies apart, or let a quasi-static run press them together"
    )]
    StartsInside {
        /// How many nodes.
        nodes: usize,
        /// The deepest of them.
        node: u32,
        /// Name of the interface.
        interface: String,
        /// Its depth \[m\].
        depth: f64,
        /// The depth that is allowed there \[m\].
        allowed: f64,
    },
    /// Velocity-level contact without velocities.
    #[error(
        "velocity-level contact needs inertia; use position-level contact for a quasi-static run"
    )]
    VelocityWithoutInertia,
    /// Bonds need gaps, which velocity-level contact does not keep.
    #[error(
        "interface \"{interface}\" has adhesion, which needs position-level contact: use it instead of the velocity level"
    )]
    AdhesionAtVelocity {
        /// Name of the interface.
        interface: String,
    },
    /// Element or mesh trouble outside a step.
    #[error(transparent)]
    Element(#[from] FeError),
    /// An interface that does not fit the mesh.
    #[error(transparent)]
    Interface(#[from] GeometryError),
    /// The smallest step failed too.
    #[error(
        "stopped at t = {time:e} s: no step down to {smallest:e} s converges. Last reason: {failure}"
    )]
    Stopped {
        /// Time reached \[s\].
        time: f64,
        /// Smallest step tried \[s\].
        smallest: f64,
        /// Why the last try failed.
        failure: StepFailure,
    },
    /// The observer could not do its part, e.g. write a file.
    #[error("stopped at t = {time:e} s by the output: {source}")]
    Observer {
        /// Time reached \[s\].
        time: f64,
        /// What the observer said.
        source: Box<dyn std::error::Error + Send + Sync>,
    },
}

/// Why one step was rejected: which element, contact or residual, and what to try.
#[derive(Debug, Clone, thiserror::Error)]
#[non_exhaustive]
pub enum StepFailure {
    /// An element turned inside out and smaller corrections did not help.
    #[error(
        "{0}: try smaller steps or a finer mesh there; where the body is crushed, a law that resists the collapse of matter"
    )]
    Element(FeError),
    /// Newton's iteration did not reach the tolerance.
    #[error(
        "equilibrium not reached in {iterations} iterations: residual {residual:e} N at node {node} (allowed {allowed:e} N), \
         contact error {contact_error:e} at {place}; try smaller steps",
        place = place(contact)
    )]
    Newton {
        /// Iterations done.
        iterations: usize,
        /// Largest residual force \[N\].
        residual: f64,
        /// Where it is.
        node: usize,
        /// What would have been accepted \[N\].
        allowed: f64,
        /// Relative error of the contact law \[-\].
        contact_error: f64,
        /// Worst contact, if there is any.
        contact: Option<ContactPlace>,
    },
    /// The contact problem of an iteration was not solved.
    #[error(
        "the contact problem of {contacts} contacts was not solved: error {error:e} ({method:?}), worst at {place}; {advice}",
        place = place(contact),
        advice = if *bonded { SNAP_ADVICE } else { CONTACT_ADVICE }
    )]
    Contact {
        /// Contacts in the problem.
        contacts: usize,
        /// Recomputed relative error \[-\].
        error: f64,
        /// Method that ended last.
        method: Method,
        /// Whether bonds were in it.
        bonded: bool,
        /// Worst contact, if there is any.
        contact: Option<ContactPlace>,
    },
    /// The tangent stayed indefinite whatever was added to it.
    #[error(
        "the tangent of body {body} is not positive definite near node {node}; the body may buckle or lose ellipticity there: try smaller steps"
    )]
    Indefinite {
        /// Index of the body.
        body: usize,
        /// Node of the failing pivot.
        node: usize,
    },
    /// The factorization does not solve its own system.
    #[error(
        "a linear solve left the relative residual {residual:e} in body {body}; the matrix is close to singular: is the body held?"
    )]
    Linear {
        /// Index of the body.
        body: usize,
        /// Relative residual after refinement.
        residual: f64,
    },
    /// A body that only contacts could hold finds no equilibrium.
    #[error(
        "the body of node {node} can move as a whole and finds no contact that holds it; hold more of its nodes, start it in \
         contact, or give it inertia and damping"
    )]
    Adrift {
        /// First node of the body.
        node: usize,
    },
    /// A slave node went through a round or sharp obstacle.
    #[error(
        "node {node} of interface \"{interface}\" goes through its obstacle in one step, {travel:e} m from one side to the \
         other; try smaller steps"
    )]
    Passed {
        /// The node.
        node: u32,
        /// Name of the interface.
        interface: String,
        /// Its way, seen from the obstacle \[m\].
        travel: f64,
    },
    /// A contact on the rim of a deformable master came and went with the iterations.
    #[error(
        "{contact} lies on the rim of its master and is lost and found again in turn; try smaller steps, or a master that reaches \
         farther than its slave"
    )]
    Rim {
        /// The contact.
        contact: ContactPlace,
    },
    /// Slave and master are both driven into each other.
    #[error(
        "{contact} is driven {depth:e} m into its master, and neither can give way: all unknowns on both sides are prescribed; \
         free some of them, or change the motion"
    )]
    Immovable {
        /// The contact.
        contact: ContactPlace,
        /// How deep it would be \[m\], or the depth that stands for the velocity at the velocity level.
        depth: f64,
    },
    /// The compliance of a surface does not fit the mesh.
    #[error(transparent)]
    Surface(#[from] GeometryError),
    /// A slave crosses more than the contact search can see.
    #[error(
        "in interface \"{interface}\" slave and master move {travel:e} m against each other in one step, more than the \
         contact search reaches ({reach:e} m): they could pass through each other; try smaller steps"
    )]
    TooFast {
        /// Name of the interface.
        interface: String,
        /// Relative motion \[m\].
        travel: f64,
        /// Reach of the search \[m\].
        reach: f64,
    },
    /// A slave node lies under its master and the search does not see it.
    #[error(
        "node {node} of interface \"{interface}\" lies {depth:e} m under its master and its contact is lost: deeper \
         than the contact search reaches, round the rim or in a fold; try smaller steps, position-level contact or a larger search_distance"
    )]
    Lost {
        /// The node.
        node: u32,
        /// Name of the interface.
        interface: String,
        /// Depth under the boundary of the body \[m\].
        depth: f64,
    },
    /// A bond softens faster than anything can follow: more than one end of the step satisfies the law.
    #[error(
        "the interface snaps at {contact}: its bond softens faster than its viscosity over {dt:e} s and the body around it can \
         follow; try smaller steps, a larger b, inertia, or a stiffer or finer body there"
    )]
    Snap {
        /// The contact.
        contact: ContactPlace,
        /// Length of the step \[s\].
        dt: f64,
    },
    /// Something became infinite or not a number.
    #[error("a force at node {node} is not finite; try smaller steps")]
    NotFinite {
        /// First such node.
        node: usize,
    },
}
