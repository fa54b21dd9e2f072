//! Rectangles.

use super::check_kind;
use super::grid::GridMesh;
use crate::element::CellKind;
use crate::mesh::Mesh;
use crate::mesh::MeshError;
#[cfg(feature = "serde")]
use crate::mesh::text::{Deserialize, Serialize, plane, quadrilaterals, uniform};

/// A rectangle of `cells[0] x cells[1]` quadrilaterals, or each cut into two triangles.
///
/// Nodes are numbered with x fastest, those that quadratic cells add come after them. Sides are `x_min`, `x_max`,
/// `y_min`, `y_max`.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(Serialize, Deserialize),
    serde(deny_unknown_fields)
)]
pub struct RectangleMesh {
    /// Lowest corner \[m\].
    pub min: [f64; 2],
    /// Highest corner \[m\].
    pub max: [f64; 2],
    /// Cells per axis.
    pub cells: [usize; 2],
    /// Size of the last cell over that of the first, per axis \[-\]; sizes grow geometrically, 1 is uniform.
    #[cfg_attr(feature = "serde", serde(default = "uniform"))]
    pub grading: [f64; 2],
    /// A kind of plane cells.
    #[cfg_attr(
        feature = "serde",
        serde(rename = "element", default = "quadrilaterals", with = "plane")
    )]
    pub kind: CellKind,
}

impl RectangleMesh {
    /// A rectangle of equal quadrilaterals.
    #[must_use]
    pub fn uniform(min: [f64; 2], max: [f64; 2], cells: [usize; 2]) -> RectangleMesh {
        RectangleMesh {
            min,
            max,
            cells,
            grading: [1.0; 2],
            kind: CellKind::Quad4,
        }
    }

    /// The same rectangle with another kind of cells.
    #[must_use]
    pub fn with_kind(self, kind: CellKind) -> RectangleMesh {
        RectangleMesh { kind, ..self }
    }

    /// The same shape with each number of cells multiplied by `factor`.
    #[must_use]
    pub fn refined(self, factor: usize) -> RectangleMesh {
        RectangleMesh {
            cells: self.cells.map(|n| n * factor),
            ..self
        }
    }

    /// Builds the mesh; its only block gets the name `block`.
    ///
    /// # Errors
    /// [`MeshError::Shape`] for a rectangle without extent, without cells, with a grading that is not positive, or
    /// with more nodes than 32-bit indices can address; [`MeshError::CellDimension`] for solid cells.
    pub fn generate(&self, block: &str) -> Result<Mesh, MeshError> {
        check_kind(block, self.kind, 2)?;
        let corners: [&[f64]; 2] = [&self.min, &self.max];
        let (cells, grading) = (&self.cells, &self.grading);
        GridMesh::between("rectangle", corners, cells, grading, self.kind)?.generate(block)
    }
}
