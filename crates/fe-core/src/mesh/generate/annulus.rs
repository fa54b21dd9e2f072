//! Rings.

use nalgebra::Vector3;

use super::axis::Run;
use super::{
    check_kind, into_kind, name_side, require, require_cells, require_finite, require_indices,
    require_positive, single_block,
};
use crate::element::CellKind;
use crate::mesh::Mesh;
use crate::mesh::MeshError;
#[cfg(feature = "serde")]
use crate::mesh::text::{Deserialize, Serialize, even, plane, quadrilaterals};
use crate::symmetry::Symmetry;

/// A plane ring of quadrilaterals, or each cut into two triangles.
///
/// Nodes are numbered counter-clockwise from the x axis, from the inner rim outwards. Sides are `inner` and `outer`,
/// their nodes equally spaced. Nodes that quadratic cells add between two of a radius have that radius too.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(Serialize, Deserialize),
    serde(deny_unknown_fields)
)]
pub struct AnnulusMesh {
    /// Centre \[m\].
    pub center: [f64; 2],
    /// Radius of the inner rim \[m\].
    pub inner: f64,
    /// Radius of the outer rim \[m\].
    pub outer: f64,
    /// Cells around the whole ring (at least 3), and through its thickness.
    pub cells: [usize; 2],
    /// Thickness of the outermost cell over that of the innermost \[-\]; 1 is uniform.
    #[cfg_attr(feature = "serde", serde(default = "even"))]
    pub grading: f64,
    /// A kind of plane cells.
    #[cfg_attr(
        feature = "serde",
        serde(rename = "element", default = "quadrilaterals", with = "plane")
    )]
    pub kind: CellKind,
}

impl AnnulusMesh {
    /// The same shape with each number of cells multiplied by `factor`.
    #[must_use]
    pub fn refined(self, factor: usize) -> AnnulusMesh {
        AnnulusMesh {
            cells: self.cells.map(|n| n * factor),
            ..self
        }
    }

    /// Builds the mesh; its only block gets the name `block`.
    ///
    /// # Errors
    /// [`MeshError::Shape`] for radii that are not positive or not in order, fewer than 3 cells around or 1 through,
    /// a grading that is not positive, or more nodes than 32-bit indices can address;
    /// [`MeshError::CellDimension`] for solid cells.
    pub fn generate(&self, block: &str) -> Result<Mesh, MeshError> {
        check_kind(block, self.kind, 2)?;
        self.check()?;
        let [around, through] = self.cells;
        let radii = Run::graded(self.inner, self.outer, through, self.grading).lines();
        let rim = |&radius: &f64| {
            (0..around).map(move |k| {
                let d = direction(k, around);
                let [x, y] = self.center;
                Vector3::new(x + radius * d[0], y + radius * d[1], 0.0)
            })
        };
        let points = radii.iter().flat_map(rim).collect();
        let node = |k: usize, layer: usize| (k % around + around * layer) as u32;
        let quad = |k, l| {
            [
                node(k, l),
                node(k, l + 1),
                node(k + 1, l + 1),
                node(k + 1, l),
            ]
        };
        let cells = (0..through)
            .flat_map(|l| (0..around).flat_map(move |k| quad(k, l)))
            .collect();
        let mut mesh = single_block(Symmetry::PlaneStrain, points, block, CellKind::Quad4, cells);
        let boundary = mesh.boundary_facets();
        name_side(&mut mesh, &boundary, "inner", |n| n < around);
        name_side(&mut mesh, &boundary, "outer", |n| n >= around * through);
        let [x, y] = self.center;
        into_kind(mesh, self.kind, Vector3::new(x, y, 0.0), |_| true)
    }

    fn check(&self) -> Result<(), MeshError> {
        let shape = "annulus";
        let [around, through] = self.cells;
        require_finite(shape, &self.center)?;
        require_positive(shape, "inner radius [m]", self.inner)?;
        require_positive(shape, "outer radius [m]", self.outer)?;
        let thickness = self.outer - self.inner;
        require_positive(shape, "outer less inner radius [m]", thickness)?;
        let count = around as f64;
        require(
            around >= 3,
            shape,
            "cells around",
            count,
            "must be at least 3",
        )?;
        require_cells(shape, "cells through", through)?;
        require_positive(shape, "grading", self.grading)?;
        require_indices(shape, count * (through as f64 + 1.0))
    }
}

/// Unit vector at `k/n` of a full turn; exact at quarters.
fn direction(k: usize, n: usize) -> [f64; 2] {
    let (quarter, rest) = (4 * k / n, 4 * k % n);
    let (s, c) = (rest as f64 / n as f64 * std::f64::consts::FRAC_PI_2).sin_cos();
    match quarter {
        0 => [c, s],
        1 => [-s, c],
        2 => [-c, -s],
        _ => [s, -c],
    }
}
