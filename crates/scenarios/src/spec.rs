//! The scene: everything that a `.ron` file can say, with units.
//!
//! Quantities are in SI units (or in any other consistent set: the program never converts), angles in radians
//! except where a field says degrees. Names of bodies, materials, interfaces, motions, loads and probes are
//! letters, digits, `_` and `-`; a set is called `body.set`, with the sets that the [`Mesh`] names.
//!
//! Bodies with plane meshes make a plane scene: vectors keep three numbers, z is 0, and a rigid shape acts by its
//! section at z = 0.

mod body;
mod check;
mod error;
mod extent;
mod interface;
mod layout;
mod load;
mod locate;
mod material;
mod mesh;
mod motion;
mod near;
mod overrides;
mod paths;
mod request;
mod source;
mod time;
mod variants;

pub use body::{Body, Symmetry};
pub use error::SceneError;
pub use extent::Extent;
pub use interface::{Adhesion, Interface, Master, Stiffness};
pub(crate) use interface::{FLAT, ShapeValue, Side, along_z};
pub use layout::{Layout, ProbeColumns};
pub use load::{LoadedScene, parse};
pub use locate::{Node, NodeKind, ScanError, SpanTree};
pub use material::{BlatzKoParameters, ElasticPair, Law, LawError, Material, ThreeEParameters};
pub use mesh::{Mesh, MeshSize, PlaneGrid, SolidGrid};
pub use motion::{Load, Motion, Prescribed, Rotation, Table};
pub(crate) use near::near_names;
pub use overrides::Override;
pub use paths::field_paths;
pub use request::{FieldsEvery, Output, Plot, Probe, Quantity};
pub use source::{Fault, Source};
pub use time::{MassKind, Solver, Time};

// Choices and shapes that the libraries name; their feature `serde` reads them.
pub use contact_bipotential::rcc::{Healing, Reference, Update};
pub use fe_core::{
    AnnulusMesh, BoxMesh, Dilatation, DiscMesh, GridAxis, GridPiece, HalfBallMesh, HalfDiscMesh,
    Interpolation, Pole, QuarterDiscMesh, RectangleMesh,
};
pub use nscd::{ContactLevel, Inertia, Rayleigh};

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
    /// What a plane scene is a section of; plane strain when absent. Not for solid bodies.
    #[serde(default)]
    pub symmetry: Option<Symmetry>,
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
    /// What may be wrong with the energies of a run that still counts as completed.
    #[serde(default)]
    pub accept: Vec<Acceptance>,
    /// What is written besides `summary.json` and `history.csv`.
    #[serde(default)]
    pub output: Output,
}

fn one() -> usize {
    1
}

/// What makes a run that reached its end `unreliable`, unless the scene accepts it by name. Bounds are parts of the
/// energy in play: the most that was stored, came in as work or was dissipated.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Acceptance {
    /// The energy audit leaves more than 1e-3 unexplained.
    OpenAudit,
    /// The integration of a motion made more than a tenth out of nothing.
    EnergyGain,
    /// The dissipation of friction, bonds, damping or closing contacts fell by more than 1e-4.
    NegativeDissipation,
}

/// Poisson's ratio beyond which elements with a pointwise dilatation deserve a word \[-\]: there their error is up to
/// seven times that of projected ones, at .48 up to sixteen times (docs/theory/elements.md, locking).
const NOTABLE_POISSON_RATIO: f64 = 0.45;

/// Part of a step, over the number of steps, that counts as none \[-\]: a quotient like 0.3 / 0.1 = 2.999.. or
/// 3.000..1 must not add a step of round-off length.
const WHOLE_STEP: f64 = 1e-9;

impl Scene {
    /// A scene without bodies, all else left to its default, as in a file.
    #[must_use]
    pub fn new(title: impl Into<String>, time: Time) -> Scene {
        Scene {
            title: title.into(),
            description: String::new(),
            source: String::new(),
            refine: one(),
            symmetry: None,
            materials: IndexMap::new(),
            bodies: IndexMap::new(),
            motions: IndexMap::new(),
            loads: IndexMap::new(),
            interfaces: IndexMap::new(),
            damping: Rayleigh::default(),
            time,
            solver: Solver::default(),
            mass: MassKind::default(),
            accept: Vec::new(),
            output: Output::default(),
        }
    }

    /// True when the first body is plane; then all are.
    pub fn is_plane(&self) -> bool {
        let first = self.bodies.first();
        first.is_some_and(|(_, body)| body.mesh.is_plane())
    }

    /// Counts of all bodies together, `refine` included.
    #[must_use]
    pub fn size(&self) -> MeshSize {
        let sizes = self.bodies.values().map(|body| body.mesh.size(self.refine));
        sizes.fold(MeshSize::default(), |sum, size| MeshSize {
            nodes: sum.nodes.saturating_add(size.nodes),
            elements: sum.elements.saturating_add(size.elements),
            dofs: sum.dofs.saturating_add(size.dofs),
        })
    }

    /// What is allowed but hardly meant.
    #[must_use]
    pub fn warnings(&self) -> Vec<String> {
        let one = |(name, body): (&String, &Body)| {
            let material = self.materials.get(&body.material)?;
            let nu = material.law.elastic_constants().ok()?.poisson_ratio();
            let locks = body.dilatation == Dilatation::Pointwise && nu > NOTABLE_POISSON_RATIO;
            locks.then(|| {
                format!(
                    "body `{name}` is nearly incompressible (nu = {nu:.6}) and its elements are too stiff then: give it \
                     `dilatation: Projected` (not with Tri3 or Tet4)"
                )
            })
        };
        self.bodies.iter().filter_map(one).collect()
    }

    /// Number of equal steps of `time.dt` that reach `time.end` (a rejected step adds to it).
    #[must_use]
    pub fn step_count(&self) -> usize {
        let exact = self.time.end / self.time.dt;
        (exact - WHOLE_STEP * exact.max(1.0)).ceil().max(1.0) as usize
    }
}
