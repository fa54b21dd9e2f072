//! The scene: everything that a `.ron` file can say, with units.
//!
//! Quantities are in SI units (or in any other consistent set: the program never converts), angles in radians
//! except where a field says degrees. Names of bodies, materials, interfaces, motions, loads and probes are
//! letters, digits, `_` and `-`; a set is called `body.set`, for a box one of `x_min`, `x_max`, `y_min`, `y_max`,
//! `z_min`, `z_max` (nodes and facets) or `all` (nodes).

mod body;
mod check;
mod error;
mod interface;
mod load;
mod locate;
mod material;
mod motion;
mod overrides;
mod paths;
mod request;
mod time;

pub use body::{Body, BoxSize, Element, Mesh};
pub use error::{Fault, SceneError};
pub use interface::{Interface, Master};
pub use load::{LoadedScene, Source, parse};
pub use locate::{Node, NodeKind, ScanError, SpanTree};
pub use material::{BuiltLaw, Law, LawError, Material};
pub use motion::{Interpolation, Load, Motion, Prescribed, Rotation, Table};
pub use overrides::{Override, near_names};
pub use paths::field_paths;
pub use request::{FieldsEvery, Output, Plot, Probe, Quantity};
pub use time::{ContactLevel, Inertia, MassKind, Rayleigh, Solver, Time};

use indexmap::IndexMap;
use serde::{Deserialize, Serialize};

/// One problem: bodies, what moves and loads them, where they touch, how time advances, what is written.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Scene {
    /// One line for lists and pictures.
    pub title: String,
    /// What is simulated and what to look at.
    #[serde(default)]
    pub description: String,
    /// Where the problem comes from, as in `[Feng2007, 4.2]`.
    #[serde(default)]
    pub source: String,
    /// Multiplies the cell counts of every structured mesh \[-\].
    #[serde(default = "one")]
    pub refine: usize,
    /// Materials by name.
    pub materials: IndexMap<String, Material>,
    /// Deformable bodies by name.
    pub bodies: IndexMap<String, Body>,
    /// Prescribed displacements by name (Dirichlet data).
    #[serde(default)]
    pub motions: IndexMap<String, Prescribed>,
    /// Given forces by name.
    #[serde(default)]
    pub loads: IndexMap<String, Load>,
    /// Pairs of surfaces that can touch, by name.
    #[serde(default)]
    pub interfaces: IndexMap<String, Interface>,
    /// Material damping.
    #[serde(default)]
    pub damping: Rayleigh,
    /// Duration, step and scheme.
    pub time: Time,
    /// Tolerances and limits of the solvers.
    #[serde(default)]
    pub solver: Solver,
    /// Mass matrix.
    #[serde(default)]
    pub mass: MassKind,
    /// What is written besides `summary.json` and `history.csv`.
    #[serde(default)]
    pub output: Output,
}

fn one() -> usize {
    1
}

impl Scene {
    /// Nodes, elements and displacement unknowns of all bodies together, `refine` included, prescribed unknowns
    /// not taken off.
    pub fn size(&self) -> BoxSize {
        let mut total = BoxSize::default();
        for body in self.bodies.values() {
            let size = body.mesh.size(self.refine);
            total.nodes += size.nodes;
            total.elements += size.elements;
        }
        total
    }

    /// Number of equal steps of `time.dt` that reach `time.end` (a rejected step adds to it).
    pub fn step_count(&self) -> usize {
        // A quotient like 0.3 / 0.1 = 2.999.. or 3.000..1 must not add a step of round-off length.
        let exact = self.time.end / self.time.dt;
        (exact - 1e-9 * exact.max(1.0)).ceil().max(1.0) as usize
    }
}
