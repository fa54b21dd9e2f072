//! Bodies.

use fe_core::Dilatation;
use serde::{Deserialize, Serialize};

use super::mesh::Mesh;

/// One deformable body: a mesh of one material.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Body {
    /// Where the mesh comes from.
    pub mesh: Mesh,
    /// Name of the material.
    pub material: String,
    /// Initial velocity of the material at the origin, of all its nodes when it has no spin \[m/s\].
    #[serde(default)]
    pub velocity: [f64; 3],
    /// Initial rate of rotation about the origin \[rad/s\]; adds `spin x X` to the velocity.
    #[serde(default)]
    pub spin: [f64; 3],
    /// The change of volume that the law sees: a choice for nearly incompressible matter.
    #[serde(default)]
    pub dilatation: Dilatation,
}

impl Body {
    /// A body at rest, all else left to its default, as in a file.
    #[must_use]
    pub fn new(mesh: Mesh, material: impl Into<String>) -> Body {
        Body {
            mesh,
            material: material.into(),
            velocity: [0.0; 3],
            spin: [0.0; 3],
            dilatation: Dilatation::default(),
        }
    }

    /// Initial velocity \[m/s\] of its node at `point` \[m\].
    pub(crate) fn velocity_at(&self, point: [f64; 3]) -> [f64; 3] {
        let turn = |i: usize, j: usize| self.spin[i] * point[j] - self.spin[j] * point[i];
        std::array::from_fn(|c| self.velocity[c] + turn((c + 1) % 3, (c + 2) % 3))
    }
}

/// What the third direction of a plane scene is like. A solid scene says nothing, where the library's
/// [`fe_core::Symmetry`] says `None`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum Symmetry {
    /// Thick bodies that do not stretch along z; forces, masses and energies are those of 1 m of thickness.
    #[default]
    PlaneStrain,
    /// Bodies of revolution about the y axis, x is the radius; forces, masses and energies are those of the whole ring.
    Axisymmetric,
}
