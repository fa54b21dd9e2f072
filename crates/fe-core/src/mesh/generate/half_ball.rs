//! Half balls.

use nalgebra::Vector3;

use super::disc::name_plane;
use super::o_grid::OGrid;
use super::{BoxMesh, Pole, check_shape_kind, require_cells, require_indices};
use crate::element::CellKind;
use crate::mesh::Mesh;
use crate::mesh::MeshError;
#[cfg(feature = "serde")]
use crate::mesh::text::{Deserialize, Serialize, hexahedra, point, solid};

/// The upper or lower half of a ball, of hexahedra around half a cube.
///
/// Sides are `dome`, with a node at the pole, and `base`, the disc.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(Serialize, Deserialize),
    serde(deny_unknown_fields)
)]
pub struct HalfBallMesh {
    /// Centre \[m\], on the base.
    #[cfg_attr(feature = "serde", serde(with = "point"))]
    pub center: Vector3<f64>,
    /// Radius \[m\].
    pub radius: f64,
    /// Cells per quarter of a great circle; an odd number is raised to the next even one.
    pub cells: usize,
    /// Where the dome points: +z or -z.
    pub pole: Pole,
    /// [`CellKind::Hex8`] or [`CellKind::Hex27`].
    #[cfg_attr(
        feature = "serde",
        serde(rename = "element", default = "hexahedra", with = "solid")
    )]
    pub kind: CellKind,
}

impl HalfBallMesh {
    /// The same shape with each number of cells multiplied by `factor`.
    #[must_use]
    pub fn refined(self, factor: usize) -> HalfBallMesh {
        HalfBallMesh {
            cells: self.cells * factor,
            ..self
        }
    }

    /// Builds the mesh; its only block gets the name `block`.
    ///
    /// # Errors
    /// [`MeshError::Shape`] unless the radius is positive and finite, the centre finite, and there are cells, not more
    /// than 32-bit indices can address; [`MeshError::Kind`] for other cells than hexahedra.
    pub fn generate(&self, block: &str) -> Result<Mesh, MeshError> {
        let shape = "half ball";
        check_shape_kind(shape, self.kind, CellKind::Hex8)?;
        require_cells(shape, "cells", self.cells)?;
        require_indices(shape, (self.cells as f64).powi(3))?;
        let n = self.cells.div_ceil(2);
        let core = BoxMesh::uniform([-1.0, -1.0, 0.0], [1.0; 3], [2 * n, 2 * n, n]);
        let grid = OGrid {
            shape,
            center: self.center,
            radius: self.radius,
            pole: self.pole,
            quarter: 2 * n,
            rim: "dome",
            core: core.generate(block)?,
            kind: self.kind,
        };
        let mut mesh = grid.generate(block)?;
        name_plane(&mut mesh, "base", 2, self.center[2]);
        Ok(mesh)
    }
}
