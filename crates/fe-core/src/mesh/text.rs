//! Shapes of meshes as text: what serde cannot derive.

use std::fmt;
use std::sync::LazyLock;

use nalgebra::Vector3;
use serde::de::{self, DeserializeSeed, EnumAccess, VariantAccess, Visitor};
use serde::{Deserializer, Serializer};

pub(super) use serde::{Deserialize, Serialize};

use crate::element::CellKind;

/// A grading that changes nothing \[-\].
pub(super) fn uniform<const N: usize>() -> [f64; N] {
    [1.0; N]
}

/// A grading that changes nothing \[-\].
pub(super) fn even() -> f64 {
    1.0
}

/// A point as `(x, y, z)` \[m\].
pub(super) mod point {
    use super::{Deserialize, Deserializer, Serialize, Serializer, Vector3};

    pub(in crate::mesh) fn serialize<S: Serializer>(
        point: &Vector3<f64>,
        serializer: S,
    ) -> Result<S::Ok, S::Error> {
        <[f64; 3]>::from(*point).serialize(serializer)
    }

    pub(in crate::mesh) fn deserialize<'de, D: Deserializer<'de>>(
        deserializer: D,
    ) -> Result<Vector3<f64>, D::Error> {
        <[f64; 3]>::deserialize(deserializer).map(Vector3::from)
    }
}

/// Hexahedra where a mesh of solid cells names no kind.
pub fn hexahedra() -> CellKind {
    CellKind::Hex8
}

/// Quadrilaterals where a mesh of plane cells names no kind.
pub fn quadrilaterals() -> CellKind {
    CellKind::Quad4
}

/// A kind of solid cells; others are no choice.
pub mod solid {
    use super::{CellKind, Deserializer, Serialize, Serializer, kind_of_dimension};

    /// Writes its name.
    ///
    /// # Errors
    /// What the serializer says.
    pub fn serialize<S: Serializer>(kind: &CellKind, serializer: S) -> Result<S::Ok, S::Error> {
        kind.serialize(serializer)
    }

    /// Reads its name.
    ///
    /// # Errors
    /// An unknown variant, with the solid kinds.
    pub fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<CellKind, D::Error> {
        kind_of_dimension(3, deserializer)
    }
}

/// A kind of plane cells; others are no choice.
pub mod plane {
    use super::{CellKind, Deserializer, kind_of_dimension};

    pub use super::solid::serialize;

    /// Reads its name.
    ///
    /// # Errors
    /// An unknown variant, with the plane kinds.
    pub fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<CellKind, D::Error> {
        kind_of_dimension(2, deserializer)
    }
}

/// Names of the plane kinds and of the solid ones.
static NAMES: LazyLock<[Vec<&'static str>; 2]> = LazyLock::new(|| {
    [2, 3].map(|dim| {
        let kinds = CellKind::ALL.iter().filter(|kind| kind.dim() == dim);
        kinds.map(|kind| kind.name()).collect()
    })
});

fn kind_of_dimension<'de, D: Deserializer<'de>>(
    dim: usize,
    deserializer: D,
) -> Result<CellKind, D::Error> {
    let names: &'static [&'static str] = &NAMES[dim - 2];
    deserializer.deserialize_enum("CellKind", names, Named(names))
}

impl Serialize for CellKind {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_unit_variant("CellKind", *self as u32, self.name())
    }
}

/// Reads one of these names.
#[derive(Clone, Copy)]
struct Named(&'static [&'static str]);

impl<'de> Visitor<'de> for Named {
    type Value = CellKind;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "one of {}", self.0.join(", "))
    }

    fn visit_enum<A: EnumAccess<'de>>(self, data: A) -> Result<CellKind, A::Error> {
        let (kind, variant) = data.variant_seed(self)?;
        variant.unit_variant().map(|()| kind)
    }

    fn visit_str<E: de::Error>(self, name: &str) -> Result<CellKind, E> {
        let allowed = self.0.contains(&name);
        let kind = CellKind::ALL
            .into_iter()
            .find(|kind| allowed && kind.name() == name);
        kind.ok_or_else(|| E::unknown_variant(name, self.0))
    }
}

impl<'de> DeserializeSeed<'de> for Named {
    type Value = CellKind;

    fn deserialize<D: Deserializer<'de>>(self, deserializer: D) -> Result<CellKind, D::Error> {
        deserializer.deserialize_identifier(self)
    }
}
