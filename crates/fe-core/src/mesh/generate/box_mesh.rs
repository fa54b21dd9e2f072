//! Boxes.

use nalgebra::Vector3;

use super::check_kind;
use super::grid::GridMesh;
use crate::element::CellKind;
use crate::mesh::Mesh;
use crate::mesh::MeshError;
#[cfg(feature = "serde")]
use crate::mesh::text::{Deserialize, Serialize, hexahedra, point, solid, uniform};

/// A box of `cells[0] x cells[1] x cells[2]` bricks, each one hexahedron or six tetrahedra.
///
/// Nodes are numbered with x fastest, those that quadratic cells add come after them. The mesh has node and facet sets
/// `x_min`, `x_max`, `y_min`, `y_max`, `z_min`, `z_max` and the node set `all`.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(Serialize, Deserialize),
    serde(deny_unknown_fields)
)]
pub struct BoxMesh {
    /// Lowest corner \[m\].
    #[cfg_attr(feature = "serde", serde(with = "point"))]
    pub min: Vector3<f64>,
    /// Highest corner \[m\].
    #[cfg_attr(feature = "serde", serde(with = "point"))]
    pub max: Vector3<f64>,
    /// Bricks per axis.
    pub cells: [usize; 3],
    /// Size of the last brick over that of the first, per axis \[-\]; sizes grow geometrically, 1 is uniform.
    #[cfg_attr(feature = "serde", serde(default = "uniform"))]
    pub grading: [f64; 3],
    /// A kind of solid cells.
    #[cfg_attr(
        feature = "serde",
        serde(rename = "element", default = "hexahedra", with = "solid")
    )]
    pub kind: CellKind,
}

impl BoxMesh {
    /// A box of equal hexahedra.
    #[must_use]
    pub fn uniform(
        min: impl Into<Vector3<f64>>,
        max: impl Into<Vector3<f64>>,
        cells: [usize; 3],
    ) -> BoxMesh {
        BoxMesh {
            min: min.into(),
            max: max.into(),
            cells,
            grading: [1.0; 3],
            kind: CellKind::Hex8,
        }
    }

    /// The same box with another kind of cells.
    #[must_use]
    pub fn with_kind(self, kind: CellKind) -> BoxMesh {
        BoxMesh { kind, ..self }
    }

    /// The same shape with each number of cells multiplied by `factor`.
    #[must_use]
    pub fn refined(self, factor: usize) -> BoxMesh {
        BoxMesh {
            cells: self.cells.map(|n| n * factor),
            ..self
        }
    }

    /// Builds the mesh; its only block gets the name `block`.
    ///
    /// # Errors
    /// [`MeshError::Shape`] for a box without extent, without cells, with a grading that is not positive, or with
    /// more nodes than 32-bit indices can address; [`MeshError::CellDimension`] for plane cells.
    pub fn generate(&self, block: &str) -> Result<Mesh, MeshError> {
        check_kind(block, self.kind, 3)?;
        let corners = [self.min.as_slice(), self.max.as_slice()];
        GridMesh::between("box", corners, &self.cells, &self.grading, self.kind)?.generate(block)
    }
}
