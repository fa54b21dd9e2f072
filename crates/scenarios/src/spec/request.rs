//! What a run writes.

use indexmap::IndexMap;
use serde::{Deserialize, Serialize};

/// Fields, plots and probes of a run.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Output {
    /// How often the fields are written; the first and the last state always are, unless `Never`.
    #[serde(default)]
    pub fields_every: FieldsEvery,
    /// Pictures beside the numbers.
    #[serde(default)]
    pub plots: Vec<Plot>,
    /// Points followed in `history.csv`, by name.
    #[serde(default)]
    pub probes: IndexMap<String, Probe>,
}

/// Distance between two written fields.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum FieldsEvery {
    /// Every so many accepted steps \[-\].
    Steps(usize),
    /// Every multiple of this time \[s\]: exactly where steps end there or were cut, else the first accepted step
    /// after it.
    Interval(f64),
    /// No fields.
    Never,
}

impl Default for FieldsEvery {
    fn default() -> Self {
        FieldsEvery::Steps(EVERY)
    }
}

/// Default distance of written fields \[steps\]: a film of ten pictures for a hundred steps, at a tenth of the space.
const EVERY: usize = 10;

/// One picture, an SVG file.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum Plot {
    /// Energies and dissipations over time.
    Energy,
    /// The deformed bodies at the end, coloured by the von Mises stress.
    Deformed,
    /// The deformed bodies at a time \[s\], or at the first accepted step after it where uncut steps pass it.
    DeformedAt(f64),
    /// Force components of an interface or a motion over time.
    Force(String),
    /// Moment components of an interface or a motion over time.
    Moment(String),
    /// All quantities of a probe over time.
    Probe(String),
    /// Columns of `history.csv` over time, all in one picture.
    History(Vec<String>),
}

/// Node followed over time.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Probe {
    /// Body of the node.
    pub body: String,
    /// The node nearest to this reference position is taken \[m\].
    pub node: [f64; 3],
    /// What is written.
    pub quantities: Vec<Quantity>,
}

/// Quantity at a node.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "snake_case")]
pub enum Quantity {
    /// Displacement from the reference position \[m\], columns `displacement.x`, `.y`, `.z`.
    Displacement,
    /// Velocity \[m/s\], columns `velocity.x`, `.y`, `.z`.
    Velocity,
    /// Contact force on the node \[N\], columns `contact_force.x`, `.y`, `.z`.
    ContactForce,
    /// Von Mises stress, mean over the elements at the node \[Pa\].
    VonMises,
    /// Gap of a slave node to its master \[m\]; NaN beyond the reach of the contact search.
    Gap,
    /// Intensity of adhesion of a slave node \[-\].
    Beta,
    /// Force of the bond on a slave node \[N\], columns `adhesion_force.x`, `.y`, `.z`.
    AdhesionForce,
    /// Pull of the bond along the normal \[N\].
    AdhesionNormal,
    /// Norm of the tangential force of the bond \[N\].
    AdhesionTangential,
    /// Normal contact force on a slave node without the bond \[N\]; pressure is positive.
    NormalForce,
    /// Norm of the friction on a slave node without the bond \[N\].
    TangentialForce,
}

impl Quantity {
    /// All quantities.
    pub const ALL: [Quantity; 11] = [
        Quantity::Displacement,
        Quantity::Velocity,
        Quantity::ContactForce,
        Quantity::VonMises,
        Quantity::Gap,
        Quantity::Beta,
        Quantity::AdhesionForce,
        Quantity::AdhesionNormal,
        Quantity::AdhesionTangential,
        Quantity::NormalForce,
        Quantity::TangentialForce,
    ];

    /// Name in a scene and in the header of `history.csv`.
    pub fn name(self) -> &'static str {
        match self {
            Quantity::Displacement => "displacement",
            Quantity::Velocity => "velocity",
            Quantity::ContactForce => "contact_force",
            Quantity::VonMises => "von_mises",
            Quantity::Gap => "gap",
            Quantity::Beta => "beta",
            Quantity::AdhesionForce => "adhesion_force",
            Quantity::AdhesionNormal => "adhesion_normal",
            Quantity::AdhesionTangential => "adhesion_tangential",
            Quantity::NormalForce => "normal_force",
            Quantity::TangentialForce => "tangential_force",
        }
    }

    /// Name with unit, for axes.
    pub fn label(self) -> &'static str {
        match self {
            Quantity::Displacement => "Displacement [m]",
            Quantity::Velocity => "Velocity [m/s]",
            Quantity::ContactForce => "Contact force [N]",
            Quantity::VonMises => "Von Mises stress [Pa]",
            Quantity::Gap => "Gap [m]",
            Quantity::Beta => "Intensity of adhesion [-]",
            Quantity::AdhesionForce | Quantity::AdhesionNormal | Quantity::AdhesionTangential => {
                "Adhesion force [N]"
            }
            Quantity::NormalForce => "Normal force [N]",
            Quantity::TangentialForce => "Tangential force [N]",
        }
    }

    /// Number of columns: 3 for a vector, 1 for a scalar.
    pub fn components(self) -> usize {
        match self {
            Quantity::Displacement
            | Quantity::Velocity
            | Quantity::ContactForce
            | Quantity::AdhesionForce => 3,
            _ => 1,
        }
    }
}
