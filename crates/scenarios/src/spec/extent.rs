//! What the numbers of a scene are numbers of.

use serde::{Deserialize, Serialize};

use super::{Scene, Symmetry};

/// The piece of the bodies that forces and energies belong to.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Extent {
    /// All of a solid body.
    #[default]
    Whole,
    /// One metre of thickness.
    Metre,
    /// The whole ring.
    Ring,
}

impl Extent {
    /// That of a scene.
    #[must_use]
    pub fn of(scene: &Scene) -> Extent {
        match (scene.is_plane(), scene.symmetry) {
            (false, _) => Extent::Whole,
            (true, Some(Symmetry::Axisymmetric)) => Extent::Ring,
            (true, _) => Extent::Metre,
        }
    }

    /// A label of a solid scene, `Force \[N\]`, with the unit that it has here.
    #[must_use]
    pub fn label(self, solid: &str) -> String {
        match self {
            Extent::Metre => solid
                .replace("[N]", "[N/m]")
                .replace("[J]", "[J/m]")
                .replace("[N m]", "[N m/m]"),
            _ => solid.to_owned(),
        }
    }

    /// Components of a force that are forces; the radial one of a ring is the integral of a pressure around it.
    #[must_use]
    pub fn force_axes(self) -> &'static [&'static str] {
        match self {
            Extent::Whole => &["x", "y", "z"],
            Extent::Metre => &["x", "y"],
            Extent::Ring => &["y"],
        }
    }

    /// Components that a moment has; none on a ring.
    #[must_use]
    pub fn moment_axes(self) -> &'static [&'static str] {
        match self {
            Extent::Whole => &["x", "y", "z"],
            Extent::Metre => &["z"],
            Extent::Ring => &[],
        }
    }

    /// Components of a vector at a node.
    pub(crate) fn vector_axes(self) -> &'static [&'static str] {
        match self {
            Extent::Whole => &["x", "y", "z"],
            _ => &["x", "y"],
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn forces_have_the_components_and_units_of_what_they_act_on() {
        assert_eq!(Extent::Metre.label("Force [N]"), "Force [N/m]");
        assert_eq!(Extent::Metre.label("Moment [N m]"), "Moment [N m/m]");
        assert_eq!(Extent::Metre.label("Gap [m]"), "Gap [m]");
        assert_eq!(Extent::Ring.label("Energy [J]"), "Energy [J]");
        // The radial integral around a ring is no force.
        assert_eq!(Extent::Ring.force_axes(), ["y"]);
    }
}
