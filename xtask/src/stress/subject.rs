//! What a run of the stress map is made of, in natural units (a length, a modulus and a density of one).

/// What is set up.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub(crate) enum Case {
    /// A free body flies against a rigid obstacle
    Fall,
    /// A driven body is pressed on a rigid obstacle and dragged
    Press,
    /// A moving rigid obstacle presses into a held body
    Indent,
    /// A driven body is pressed on another one and dragged
    Pair,
    /// Two free bodies collide
    Collide,
    /// A free body between two rigid plates, of which one moves
    Squeeze,
}

impl Case {
    pub(super) const ALL: [Case; 6] = [
        Case::Fall,
        Case::Press,
        Case::Indent,
        Case::Pair,
        Case::Collide,
        Case::Squeeze,
    ];

    pub(super) fn has_second_body(self) -> bool {
        matches!(self, Case::Pair | Case::Collide)
    }

    /// Whether a face of the body is driven or held.
    pub(super) fn is_held(self) -> bool {
        matches!(self, Case::Press | Case::Indent | Case::Pair)
    }
}

/// Number of [`Extreme`]s.
pub(super) const DIRECTIONS: usize = 22;

/// One direction in which a run leaves what is usual.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Extreme {
    Friction,
    Stiffness,
    Density,
    LongSteps,
    ShortSteps,
    Speed,
    Slivers,
    Incompressible,
    StrongBonds,
    NoViscosity,
    Compression,
    Overlap,
    NoSupports,
    OneElement,
    Flicker,
    Units,
    AllDriven,
    DeadLoads,
    Sharp,
    Touching,
    Restitution,
    Turning,
}

impl Extreme {
    /// Every direction with what the map says of it.
    pub(super) const ALL: [(Extreme, &str); DIRECTIONS] = [
        (Extreme::Friction, "friction: mu 1, 1.9, 3 or 10"),
        (Extreme::Stiffness, "stiffness ratio 1e-6 to 1e6"),
        (Extreme::Density, "density ratio 1e-6 to 1e6"),
        (Extreme::LongSteps, "steps 10 to 100 times as long"),
        (Extreme::ShortSteps, "steps 1e-2 to 1e-8 times as long"),
        (Extreme::Speed, "speed 10 to 100 times as high"),
        (Extreme::Slivers, "aspect ratio or grading 30 to 1000"),
        (Extreme::Incompressible, "nu .49 to .4999"),
        (Extreme::StrongBonds, "bonds 1e2 to 1e4 times as stiff"),
        (Extreme::NoViscosity, "bonds without viscosity, b = 0"),
        (Extreme::Compression, "compression by 50 to 90 %"),
        (
            Extreme::Overlap,
            "overlap at the start, up to 60 % of the body",
        ),
        (Extreme::NoSupports, "no supports"),
        (Extreme::OneElement, "one element a body"),
        (Extreme::Flicker, "contacts that come and go every step"),
        (
            Extreme::Units,
            "lengths, masses, times in units of 1e-6 to 1e6",
        ),
        (Extreme::AllDriven, "all nodes of a body driven"),
        (Extreme::DeadLoads, "dead loads of .1 to 10 moduli"),
        (Extreme::Sharp, "sharp edges, tips and small balls"),
        (Extreme::Touching, "no gap, coincident nodes"),
        (Extreme::Restitution, "velocity level, restitution 0 to 1"),
        (Extreme::Turning, "turns up to one revolution"),
    ];
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    Plane,
    Axisymmetric,
    Space,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Law {
    SaintVenantKirchhoff,
    ThreeE,
    BlatzKo,
    NeoHookean,
}

impl Law {
    pub(super) const ALL: [Law; 4] = [
        Law::SaintVenantKirchhoff,
        Law::ThreeE,
        Law::BlatzKo,
        Law::NeoHookean,
    ];
}

/// A rigid shape whose highest point is the origin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Shape {
    /// Its slope against the horizontal.
    Plane(f64),
    /// Radius.
    Sphere(f64),
    /// Radius.
    Cylinder(f64),
    /// Semi-apex angle \[degrees\].
    Cone(f64),
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Bond {
    pub(super) stiffness: f64,
    pub(super) energy: f64,
    pub(super) viscosity: f64,
    pub(super) initial: f64,
    pub(super) irreversible: bool,
    pub(super) ageing: bool,
    pub(super) consistent: bool,
    pub(super) bonded_friction: Option<f64>,
    pub(super) healing_gap: f64,
}

/// What drives a body.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Hold {
    /// The face opposite the contact.
    Face,
    /// All nodes.
    All,
    /// Nothing.
    Free,
}

/// A run in natural units.
#[derive(Clone, Debug)]
pub(super) struct Draw {
    pub(super) case: Case,
    pub(super) extremes: Vec<Extreme>,
    pub(super) kind: Kind,
    pub(super) round: bool,
    pub(super) simplex: bool,
    /// The first body has elements of the second degree.
    pub(super) quadratic: bool,
    /// The first body has the projected dilatation.
    pub(super) projected: bool,
    /// Across and along the vertical.
    pub(super) cells: [usize; 2],
    pub(super) width: f64,
    pub(super) height: f64,
    pub(super) grading: f64,
    pub(super) law: Law,
    pub(super) nu: f64,
    pub(super) modulus: f64,
    pub(super) density: f64,
    pub(super) mu: f64,
    pub(super) bond: Option<Bond>,
    pub(super) restitution: f64,
    pub(super) theta: f64,
    pub(super) xi: f64,
    pub(super) velocity_level: bool,
    pub(super) quasi_static: bool,
    pub(super) lumped: bool,
    pub(super) damping: [f64; 2],
    pub(super) dt: f64,
    pub(super) steps: usize,
    /// Initial velocity of a free body, across and down.
    pub(super) speed: [f64; 2],
    /// Negative where bodies overlap at the start.
    pub(super) gap: f64,
    pub(super) depth: f64,
    pub(super) slide: f64,
    /// Of the driven face \[rad\].
    pub(super) turn: f64,
    pub(super) flicker: bool,
    /// Pulls back after the press.
    pub(super) pull: bool,
    pub(super) shape: Shape,
    pub(super) hold: Hold,
    /// Dead traction on the far face (down), or body force.
    pub(super) traction: f64,
    pub(super) gravity: f64,
    /// The second body has the mesh and width of the first, node on node.
    pub(super) matching: bool,
    /// The second body is narrower than the first.
    pub(super) overhang: bool,
    /// Length, mass and time in the units of the scene.
    pub(super) units: [f64; 3],
}
