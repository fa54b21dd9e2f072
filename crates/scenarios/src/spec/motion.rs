//! What changes with time: tables, prescribed motions, loads.

use fe_core::Interpolation;
use ron::value::RawValue;
use serde::{Deserialize, Deserializer, Serialize, Serializer, de::Error as _};

use super::source::shorten;

/// A value over time: a number, `[(t, value), ..]` (linear), `Linear([..])` or `Smooth([..])`. Constant before
/// the first and after the last time. Times \[s\]; the unit of the values is the field's.
#[derive(Clone, Debug, PartialEq)]
pub enum Table {
    /// The same at all times.
    Constant(f64),
    /// Points joined as the interpolation says.
    Points(Interpolation, Vec<(f64, f64)>),
}

impl Default for Table {
    fn default() -> Self {
        Table::Constant(0.0)
    }
}

impl Table {
    /// Points `(t \[s\], value)`; a constant is one point at t = 0.
    #[must_use]
    pub fn points(&self) -> Vec<(f64, f64)> {
        match self {
            Table::Constant(value) => vec![(0.0, *value)],
            Table::Points(_, points) => points.clone(),
        }
    }

    /// Interpolation; linear for a constant.
    pub(crate) fn interpolation(&self) -> Interpolation {
        match self {
            Table::Constant(_) => Interpolation::Linear,
            Table::Points(interpolation, _) => *interpolation,
        }
    }
}

// RON's self-describing mode drops the names of variants, so the three forms cannot be told apart by an untagged
// enum; the raw text can.
impl<'de> Deserialize<'de> for Table {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        #[derive(Deserialize)]
        enum Named {
            Linear(Vec<(f64, f64)>),
            Smooth(Vec<(f64, f64)>),
        }
        let raw = Box::<RawValue>::deserialize(deserializer)?;
        let text = raw.trim().get_ron();
        let wrong = |e: ron::error::SpannedError| {
            D::Error::custom(format!(
                "expected a table: a number, [(t, value), ..], Linear([(t, value), ..]) or \
                 Smooth([(t, value), ..]); found `{}` ({})",
                shorten(text),
                e.code
            ))
        };
        if text.starts_with('[') {
            let points = ron::from_str(text).map_err(wrong)?;
            return Ok(Table::Points(Interpolation::Linear, points));
        }
        let named = ["Linear", "Smooth"]
            .iter()
            .any(|name| text.starts_with(name));
        if !named {
            return ron::from_str(text).map(Table::Constant).map_err(wrong);
        }
        Ok(match ron::from_str(text).map_err(wrong)? {
            Named::Linear(points) => Table::Points(Interpolation::Linear, points),
            Named::Smooth(points) => Table::Points(Interpolation::Smooth, points),
        })
    }
}

impl Serialize for Table {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self {
            Table::Constant(value) => serializer.serialize_f64(*value),
            Table::Points(interpolation, points) => {
                let (index, name) = match interpolation {
                    Interpolation::Linear => (0, "Linear"),
                    Interpolation::Smooth => (1, "Smooth"),
                };
                serializer.serialize_newtype_variant("Table", index, name, points)
            }
        }
    }
}

/// Nodes with a given displacement.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Prescribed {
    /// Node set, `body.set`.
    pub nodes: String,
    /// The components that are given, some of `x`, `y`, `z` (others stay free).
    #[serde(default = "all_components")]
    pub components: String,
    /// The displacement.
    #[serde(default)]
    pub motion: Motion,
}

fn all_components() -> String {
    "xyz".into()
}

impl Prescribed {
    /// Which of x, y, z are prescribed.
    pub(crate) fn mask(&self) -> [bool; 3] {
        ['x', 'y', 'z'].map(|c| self.components.contains(c))
    }
}

/// A rigid motion from the reference position: rotation first, then translation.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum Motion {
    /// No displacement.
    #[default]
    Fixed,
    /// Rotation about a fixed axis, then translation.
    Move {
        /// Displacement along x, y, z over time \[m\].
        #[serde(default)]
        translation: [Table; 3],
        /// Rotation, if any.
        #[serde(default)]
        rotation: Option<Rotation>,
    },
}

impl Motion {
    /// Translation along x, y, z and rotation; nothing where nothing moves. Checks and models read a motion by these
    /// alone, so that a new kind of motion is told here.
    pub(crate) fn parts(&self) -> Option<(&[Table; 3], Option<&Rotation>)> {
        match self {
            Motion::Fixed => None,
            Motion::Move {
                translation,
                rotation,
            } => Some((translation, rotation.as_ref())),
        }
    }
}

/// Rotation about an axis that stays where it is in the reference position.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Rotation {
    /// A point of the axis \[m\].
    pub point: [f64; 3],
    /// Direction of the axis, any length but zero \[-\].
    pub axis: [f64; 3],
    /// Angle over time, right-hand rule \[rad\].
    pub angle: Table,
}

/// A given force.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum Load {
    /// Acceleration of all bodies \[m/s^2\].
    Gravity([f64; 3]),
    /// Force per reference area that keeps its direction.
    Traction {
        /// Facet set, `body.set`.
        facets: String,
        /// Traction \[Pa\].
        traction: [f64; 3],
        /// Multiplies the traction over time \[-\].
        #[serde(default = "full")]
        factor: Table,
    },
}

fn full() -> Table {
    Table::Constant(1.0)
}
