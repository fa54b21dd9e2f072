//! Discs, half discs and quarter discs.

use nalgebra::Vector3;

use super::o_grid::OGrid;
use super::{Pole, RectangleMesh, check_kind, name_side, require_cells, require_indices};
use crate::element::CellKind;
use crate::mesh::Mesh;
use crate::mesh::MeshError;
#[cfg(feature = "serde")]
use crate::mesh::text::{Deserialize, Serialize, plane, quadrilaterals};

/// A disc of quadrilaterals around a square core, or each cut into two triangles.
///
/// The side is `rim`, its nodes equally spaced and on the circle, also those of quadratic cells; the node set `center`
/// is the node nearest to the centre.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(Serialize, Deserialize),
    serde(deny_unknown_fields)
)]
pub struct DiscMesh {
    /// Centre \[m\].
    pub center: [f64; 2],
    /// Radius \[m\].
    pub radius: f64,
    /// Cells per quarter of the rim. Even numbers give a node at the centre and at the four poles.
    pub cells: usize,
    /// A kind of plane cells.
    #[cfg_attr(
        feature = "serde",
        serde(rename = "element", default = "quadrilaterals", with = "plane")
    )]
    pub kind: CellKind,
}

/// The upper or lower half of a disc, of quadrilaterals, or each cut into two triangles.
///
/// Sides are `dome`, its nodes equally spaced, one of them at the pole, and `base`, the diameter.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(Serialize, Deserialize),
    serde(deny_unknown_fields)
)]
pub struct HalfDiscMesh {
    /// Centre \[m\], on the base.
    pub center: [f64; 2],
    /// Radius \[m\].
    pub radius: f64,
    /// Cells per quarter of the rim; an odd number is raised to the next even one.
    pub cells: usize,
    /// Where the dome points: +y or -y.
    pub pole: Pole,
    /// A kind of plane cells.
    #[cfg_attr(
        feature = "serde",
        serde(rename = "element", default = "quadrilaterals", with = "plane")
    )]
    pub kind: CellKind,
}

/// The upper or lower half of a disc, right of its centre, of quadrilaterals, or each cut into two
/// triangles: half a ball if axisymmetric.
///
/// Sides are `dome`, its nodes equally spaced, `base`, the radius along x, and `axis`, the radius along y.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(Serialize, Deserialize),
    serde(deny_unknown_fields)
)]
pub struct QuarterDiscMesh {
    /// Centre \[m\], where base and axis meet.
    pub center: [f64; 2],
    /// Radius \[m\].
    pub radius: f64,
    /// Cells of the rim; an odd number is raised to the next even one.
    pub cells: usize,
    /// Where the dome points: +y or -y.
    pub pole: Pole,
    /// A kind of plane cells.
    #[cfg_attr(
        feature = "serde",
        serde(rename = "element", default = "quadrilaterals", with = "plane")
    )]
    pub kind: CellKind,
}

impl DiscMesh {
    /// The same shape with each number of cells multiplied by `factor`.
    #[must_use]
    pub fn refined(self, factor: usize) -> DiscMesh {
        DiscMesh {
            cells: self.cells * factor,
            ..self
        }
    }

    /// Builds the mesh; its only block gets the name `block`.
    ///
    /// # Errors
    /// [`MeshError::Shape`] unless the radius is positive and finite, the centre finite, and there are cells, not more
    /// than 32-bit indices can address; [`MeshError::CellDimension`] for solid cells.
    pub fn generate(&self, block: &str) -> Result<Mesh, MeshError> {
        let n = self.cells;
        let part = Part {
            shape: "disc",
            center: self.center,
            radius: self.radius,
            pole: Pole::Up,
            rim: "rim",
            kind: self.kind,
        };
        let mut mesh = part.generate(block, [-1.0; 2], [n; 2], n)?;
        let center = Vector3::new(self.center[0], self.center[1], 0.0);
        let distance = |x: &Vector3<f64>| (x - center).norm_squared();
        let distances = mesh.points.iter().map(distance).enumerate();
        let nearest = distances.min_by(|a, b| a.1.total_cmp(&b.1));
        let nodes = nearest.map(|(node, _)| node as u32).into_iter().collect();
        mesh.node_sets.insert("center".to_owned(), nodes);
        Ok(mesh)
    }
}

impl HalfDiscMesh {
    /// The same shape with each number of cells multiplied by `factor`.
    #[must_use]
    pub fn refined(self, factor: usize) -> HalfDiscMesh {
        HalfDiscMesh {
            cells: self.cells * factor,
            ..self
        }
    }

    /// Builds the mesh; its only block gets the name `block`.
    ///
    /// # Errors
    /// [`MeshError::Shape`] unless the radius is positive and finite, the centre finite, and there are cells, not more
    /// than 32-bit indices can address; [`MeshError::CellDimension`] for solid cells.
    pub fn generate(&self, block: &str) -> Result<Mesh, MeshError> {
        let n = self.cells.div_ceil(2);
        let part = Part {
            shape: "half disc",
            center: self.center,
            radius: self.radius,
            pole: self.pole,
            rim: "dome",
            kind: self.kind,
        };
        let mut mesh = part.generate(
            block,
            [-1.0, 0.0],
            [n.saturating_mul(2), n],
            n.saturating_mul(2),
        )?;
        name_plane(&mut mesh, "base", 1, self.center[1]);
        Ok(mesh)
    }
}

impl QuarterDiscMesh {
    /// The same shape with each number of cells multiplied by `factor`.
    #[must_use]
    pub fn refined(self, factor: usize) -> QuarterDiscMesh {
        QuarterDiscMesh {
            cells: self.cells * factor,
            ..self
        }
    }

    /// Builds the mesh; its only block gets the name `block`.
    ///
    /// # Errors
    /// [`MeshError::Shape`] unless the radius is positive and finite, the centre finite, and there are cells, not more
    /// than 32-bit indices can address; [`MeshError::CellDimension`] for solid cells.
    pub fn generate(&self, block: &str) -> Result<Mesh, MeshError> {
        let n = self.cells.div_ceil(2);
        let part = Part {
            shape: "quarter disc",
            center: self.center,
            radius: self.radius,
            pole: self.pole,
            rim: "dome",
            kind: self.kind,
        };
        let mut mesh = part.generate(block, [0.0; 2], [n; 2], n.saturating_mul(2))?;
        name_plane(&mut mesh, "base", 1, self.center[1]);
        name_plane(&mut mesh, "axis", 0, self.center[0]);
        Ok(mesh)
    }
}

/// What the three have in common.
#[derive(Debug)]
struct Part {
    shape: &'static str,
    center: [f64; 2],
    radius: f64,
    pole: Pole,
    rim: &'static str,
    kind: CellKind,
}

impl Part {
    fn generate(
        &self,
        block: &str,
        low: [f64; 2],
        cells: [usize; 2],
        quarter: usize,
    ) -> Result<Mesh, MeshError> {
        check_kind(block, self.kind, 2)?;
        require_cells(self.shape, "cells", quarter)?;
        require_indices(self.shape, cells[0] as f64 * cells[1] as f64)?;
        let grid = OGrid {
            shape: self.shape,
            center: Vector3::new(self.center[0], self.center[1], 0.0),
            radius: self.radius,
            pole: self.pole,
            quarter,
            rim: self.rim,
            kind: self.kind,
            core: RectangleMesh::uniform(low, [1.0; 2], cells).generate(block)?,
        };
        grid.generate(block)
    }
}

/// Names the part of the boundary in a plane across `axis`. Nodes of the cut lie in it to the last bit.
pub(super) fn name_plane(mesh: &mut Mesh, name: &str, axis: usize, at: f64) {
    let boundary = mesh.boundary_facets();
    let inside: Vec<bool> = mesh.points.iter().map(|x| x[axis] == at).collect();
    name_side(mesh, &boundary, name, |n| inside[n]);
}
