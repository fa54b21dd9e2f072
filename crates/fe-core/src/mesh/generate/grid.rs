//! Rectilinear meshes: lines along x, y and z.

use nalgebra::Vector3;

use super::axis::GridAxis;
use super::{
    check_grid, check_kind, cut_grid, name_side, of_degree, require, require_indices,
    require_positive, single_block,
};
use crate::element::CellKind;
use crate::mesh::Mesh;
use crate::mesh::MeshError;
use crate::symmetry::Symmetry;

/// A rectilinear mesh in the plane (two axes) or in space (three): each cell of the grid is a quadrilateral or two
/// triangles, a hexahedron or six tetrahedra.
///
/// Nodes are numbered with x fastest, then y; those that quadratic cells add come after them. The mesh has node and
/// facet sets `x_min`, `x_max`, `y_min`, `y_max`, in space also `z_min`, `z_max`, and the node set `all`.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct GridMesh {
    /// Lines along x, y, and in space z.
    pub axes: Vec<GridAxis>,
    /// Into how many parts each cell of each axis is divided; 1 leaves them.
    pub refine: usize,
    /// A kind of plane cells if there are two axes, of solid cells if there are three.
    pub kind: CellKind,
}

const SIDES: [[&str; 2]; 3] = [["x_min", "x_max"], ["y_min", "y_max"], ["z_min", "z_max"]];

impl GridMesh {
    /// Cells of one kind between the lines of these axes, not refined.
    #[must_use]
    pub fn new(axes: Vec<GridAxis>, kind: CellKind) -> GridMesh {
        GridMesh {
            axes,
            refine: 1,
            kind,
        }
    }

    /// With each cell of each axis divided into this many.
    #[must_use]
    pub fn with_refine(mut self, refine: usize) -> GridMesh {
        self.refine = refine;
        self
    }

    /// A rectangle or a box: axes of one piece each, checked.
    pub(super) fn between(
        shape: &'static str,
        [min, max]: [&[f64]; 2],
        cells: &[usize],
        grading: &[f64],
        kind: CellKind,
    ) -> Result<GridMesh, MeshError> {
        check_grid(shape, min, max, cells, grading)?;
        let axis = |i| GridAxis::graded(min[i], max[i], cells[i], grading[i]);
        Ok(GridMesh::new((0..min.len()).map(axis).collect(), kind))
    }

    /// Builds the mesh; its only block gets the name `block`.
    ///
    /// # Errors
    /// [`MeshError::Shape`] for what [`GridAxis::lines`] refuses, another number of axes than 2 or 3, or more nodes
    /// than 32-bit indices can address; [`MeshError::CellDimension`] for cells of another dimension.
    pub fn generate(&self, block: &str) -> Result<Mesh, MeshError> {
        let dim = self.axes.len();
        let axes = "axes";
        require(
            dim == 2 || dim == 3,
            "grid",
            axes,
            dim as f64,
            "must be 2 or 3",
        )?;
        check_kind(block, self.kind, dim)?;
        let mut nodes = 1.0;
        for axis in &self.axes {
            nodes *= axis.cells()? as f64 * self.refine as f64 + 1.0;
        }
        require_indices("grid", nodes)?;
        let mut lines = [vec![0.0], vec![0.0], vec![0.0]];
        for (lines, axis) in lines.iter_mut().zip(&self.axes) {
            *lines = axis.lines(self.refine)?;
        }
        let points = points(&lines);
        let count = lines.map(|lines| lines.len());
        let kind = self.kind.linear();
        let (symmetry, grid_cells) = if dim == 2 {
            (Symmetry::PlaneStrain, quads(count))
        } else {
            (Symmetry::None, bricks(count))
        };
        let cells = cut_grid(kind, &points, &grid_cells);
        let mut mesh = single_block(symmetry, points, block, kind, cells);
        let boundary = mesh.boundary_facets();
        let stride = [1, count[0], count[0] * count[1]];
        for axis in 0..dim {
            let at = |node: usize| node / stride[axis] % count[axis];
            name_side(&mut mesh, &boundary, SIDES[axis][0], |n| at(n) == 0);
            let last = count[axis] - 1;
            name_side(&mut mesh, &boundary, SIDES[axis][1], |n| at(n) == last);
        }
        of_degree(self.kind.degree(), mesh)
    }

    /// The mesh with a crowned top: the side `y_max` (`z_max` in space) bends down by `r^2 / (2 radius)` at the
    /// distance `r` from x = 0 (x = y = 0), the pole of a cylinder (ball) of this `radius` \[m\]; what lies below
    /// follows in proportion to its height, and the opposite side stays flat.
    ///
    /// # Errors
    /// Those of [`GridMesh::generate`], and [`MeshError::Shape`] for a radius that is not positive or so small that the
    /// top meets the bottom.
    pub fn generate_crowned(&self, block: &str, radius: f64) -> Result<Mesh, MeshError> {
        let mut mesh = self.generate(block)?;
        require_positive("grid", "radius of the crown [m]", radius)?;
        let up = mesh.dim - 1;
        let heights = || mesh.points.iter().map(|x| x[up]);
        let (bottom, top) = (
            heights().fold(f64::MAX, f64::min),
            heights().fold(f64::MIN, f64::max),
        );
        let drop =
            |x: &Vector3<f64>| x.iter().take(up).map(|x| x * x).sum::<f64>() / (2.0 * radius);
        let deepest = mesh.points.iter().map(drop).fold(0.0, f64::max);
        require(
            deepest < top - bottom,
            "grid",
            "radius of the crown [m]",
            radius,
            "must be so large that the top stays above the bottom",
        )?;
        for x in &mut mesh.points {
            x[up] -= drop(x) * (x[up] - bottom) / (top - bottom);
        }
        Ok(mesh)
    }
}

fn points([xs, ys, zs]: &[Vec<f64>; 3]) -> Vec<Vector3<f64>> {
    let mut points = Vec::with_capacity(xs.len() * ys.len() * zs.len());
    for &z in zs {
        for &y in ys {
            points.extend(xs.iter().map(|&x| Vector3::new(x, y, z)));
        }
    }
    points
}

/// Corners of the rectangle of a layer, counter-clockwise.
fn quad(i: usize, j: usize, k: usize, [nx, ny, _]: [usize; 3]) -> [u32; 4] {
    let node = |i: usize, j: usize| (i + nx * (j + ny * k)) as u32;
    [
        node(i, j),
        node(i + 1, j),
        node(i + 1, j + 1),
        node(i, j + 1),
    ]
}

fn quads(count: [usize; 3]) -> Vec<u32> {
    let row = |j| (0..count[0] - 1).flat_map(move |i| quad(i, j, 0, count));
    (0..count[1] - 1).flat_map(row).collect()
}

fn bricks(count: [usize; 3]) -> Vec<u32> {
    let mut cells = Vec::new();
    for k in 0..count[2] - 1 {
        for j in 0..count[1] - 1 {
            for i in 0..count[0] - 1 {
                cells.extend(quad(i, j, k, count));
                cells.extend(quad(i, j, k + 1, count));
            }
        }
    }
    cells
}
