//! Fields of one moment, in plain arrays.

use nalgebra::Vector3;

/// Mesh and fields at one time. Nothing here knows of the solver: any code can fill it.
#[derive(Clone, Debug)]
pub struct Frame<'a> {
    /// Time \[s\].
    pub time: f64,
    /// Reference positions \[m\].
    pub points: &'a [Vector3<f64>],
    /// Cells in the order of the cell data.
    pub cells: Vec<Cells<'a>>,
    /// Fields with one tuple a point. `displacement` (3 components) is used by pictures.
    pub point_data: Vec<Array<'a>>,
    /// Fields with one tuple a cell. `von_mises` (1 component) is used by pictures.
    pub cell_data: Vec<Array<'a>>,
}

/// Cells of one shape.
#[derive(Clone, Copy, Debug)]
pub struct Cells<'a> {
    /// Shape.
    pub shape: CellShape,
    /// Nodes, cell after cell, in the order of VTK.
    pub connectivity: &'a [u32],
}

/// Shapes of cells.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CellShape {
    /// Triangle, 3 nodes.
    Tri3,
    /// Quadrilateral, 4 nodes.
    Quad4,
    /// Tetrahedron, 4 nodes.
    Tet4,
    /// Hexahedron, 8 nodes.
    Hex8,
    /// Quadratic triangle, 6 nodes.
    Tri6,
    /// Quadratic quadrilateral, 9 nodes.
    Quad9,
    /// Quadratic tetrahedron, 10 nodes.
    Tet10,
    /// Quadratic hexahedron, 27 nodes.
    Hex27,
}

impl CellShape {
    /// True for cells in the plane.
    pub fn is_plane(self) -> bool {
        use CellShape::{Quad4, Quad9, Tri3, Tri6};
        matches!(self, Tri3 | Quad4 | Tri6 | Quad9)
    }

    /// Nodes a cell.
    pub fn node_count(self) -> usize {
        match self {
            CellShape::Tri3 => 3,
            CellShape::Quad4 | CellShape::Tet4 => 4,
            CellShape::Hex8 => 8,
            CellShape::Tri6 => 6,
            CellShape::Quad9 => 9,
            CellShape::Tet10 => 10,
            CellShape::Hex27 => 27,
        }
    }

    /// Number of the shape in VTK files.
    pub fn vtk_type(self) -> u8 {
        match self {
            CellShape::Tri3 => 5,
            CellShape::Quad4 => 9,
            CellShape::Tet4 => 10,
            CellShape::Hex8 => 12,
            CellShape::Tri6 => 22,
            CellShape::Quad9 => 28,
            CellShape::Tet10 => 24,
            CellShape::Hex27 => 29,
        }
    }

    /// Faces as local nodes, outward by the right-hand rule; a plane cell is its own face. Those of quadratic cells are
    /// cut between their nodes.
    pub fn faces(self) -> &'static [&'static [usize]] {
        match self {
            CellShape::Tri3 => &[&[0, 1, 2]],
            CellShape::Quad4 => &[&[0, 1, 2, 3]],
            CellShape::Tet4 => &[&[0, 2, 1], &[0, 1, 3], &[1, 2, 3], &[0, 3, 2]],
            CellShape::Hex8 => &[
                &[0, 3, 2, 1],
                &[4, 5, 6, 7],
                &[0, 1, 5, 4],
                &[1, 2, 6, 5],
                &[2, 3, 7, 6],
                &[3, 0, 4, 7],
            ],
            CellShape::Tri6 => &[&[0, 3, 5], &[3, 1, 4], &[5, 4, 2], &[3, 4, 5]],
            CellShape::Quad9 => &[&[0, 4, 8, 7], &[4, 1, 5, 8], &[8, 5, 2, 6], &[7, 8, 6, 3]],
            CellShape::Tet10 => &[
                &[0, 6, 4],
                &[6, 2, 5],
                &[4, 5, 1],
                &[6, 5, 4],
                &[0, 4, 7],
                &[4, 1, 8],
                &[7, 8, 3],
                &[4, 8, 7],
                &[1, 5, 8],
                &[5, 2, 9],
                &[8, 9, 3],
                &[5, 9, 8],
                &[0, 7, 6],
                &[7, 3, 9],
                &[6, 9, 2],
                &[7, 9, 6],
            ],
            CellShape::Hex27 => &[
                &[0, 16, 20, 11],
                &[16, 4, 15, 20],
                &[20, 15, 7, 19],
                &[11, 20, 19, 3],
                &[1, 9, 21, 17],
                &[9, 2, 18, 21],
                &[21, 18, 6, 13],
                &[17, 21, 13, 5],
                &[0, 8, 22, 16],
                &[8, 1, 17, 22],
                &[22, 17, 5, 12],
                &[16, 22, 12, 4],
                &[3, 19, 23, 10],
                &[19, 7, 14, 23],
                &[23, 14, 6, 18],
                &[10, 23, 18, 2],
                &[0, 11, 24, 8],
                &[11, 3, 10, 24],
                &[24, 10, 2, 9],
                &[8, 24, 9, 1],
                &[4, 12, 25, 15],
                &[12, 5, 13, 25],
                &[25, 13, 6, 14],
                &[15, 25, 14, 7],
            ],
        }
    }
}

impl Cells<'_> {
    /// Number of cells.
    pub fn count(&self) -> usize {
        self.connectivity.len() / self.shape.node_count()
    }
}

/// A named field, tuple after tuple.
#[derive(Clone, Debug)]
pub struct Array<'a> {
    /// Name in the file.
    pub name: &'a str,
    /// Values and their meaning.
    pub values: Values<'a>,
}

/// Values of a field.
#[derive(Clone, Copy, Debug)]
pub enum Values<'a> {
    /// One number a tuple.
    Scalar(&'a [f64]),
    /// Three numbers a tuple: x, y, z.
    Vector(&'a [f64]),
    /// Symmetric tensors, six numbers a tuple in the order 11 22 33 12 13 23; files get VTK's order
    /// XX YY ZZ XY YZ XZ.
    SymmetricTensor(&'a [f64]),
    /// One whole number a tuple: a number of a body, a status.
    Integer(&'a [i32]),
}

impl Values<'_> {
    /// Numbers a tuple.
    pub fn components(&self) -> usize {
        match self {
            Values::Scalar(_) | Values::Integer(_) => 1,
            Values::Vector(_) => 3,
            Values::SymmetricTensor(_) => 6,
        }
    }

    /// Number of tuples.
    pub fn tuples(&self) -> usize {
        let length = match self {
            Values::Scalar(v) | Values::Vector(v) | Values::SymmetricTensor(v) => v.len(),
            Values::Integer(v) => v.len(),
        };
        length / self.components()
    }
}

impl<'a> Frame<'a> {
    /// Number of cells of all shapes.
    pub fn cell_count(&self) -> usize {
        self.cells.iter().map(Cells::count).sum()
    }

    /// A vector field at the points.
    pub fn point_vector(&self, name: &str) -> Option<&'a [f64]> {
        self.point_data
            .iter()
            .find(|array| array.name == name)
            .and_then(|array| match array.values {
                Values::Vector(values) => Some(values),
                _ => None,
            })
    }

    /// A scalar field of the cells.
    pub fn cell_scalar(&self, name: &str) -> Option<&'a [f64]> {
        self.cell_data
            .iter()
            .find(|array| array.name == name)
            .and_then(|array| match array.values {
                Values::Scalar(values) => Some(values),
                _ => None,
            })
    }

    /// What does not fit together, as a sentence: wrong lengths, nodes out of range.
    pub fn defect(&self) -> Option<String> {
        for (data, tuples, what) in [
            (&self.point_data, self.points.len(), "points"),
            (&self.cell_data, self.cell_count(), "cells"),
        ] {
            if let Some(array) = data.iter().find(|array| array.values.tuples() != tuples) {
                let found = array.values.tuples();
                return Some(format!(
                    "field `{}` has {found} tuples for {tuples} {what}",
                    array.name
                ));
            }
        }
        for cells in &self.cells {
            if cells.connectivity.len() % cells.shape.node_count() != 0 {
                return Some(format!(
                    "the nodes of the {:?} cells are not full cells",
                    cells.shape
                ));
            }
            if let Some(node) = cells
                .connectivity
                .iter()
                .find(|node| **node as usize >= self.points.len())
            {
                return Some(format!(
                    "a cell has node {node}, but there are {} points",
                    self.points.len()
                ));
            }
        }
        None
    }
}
