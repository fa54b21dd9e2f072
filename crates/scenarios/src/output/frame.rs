//! Fields of one moment, in plain arrays.

use fe_core::CellKind;
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

/// Cells of one kind.
#[derive(Clone, Copy, Debug)]
pub struct Cells<'a> {
    /// Their kind.
    pub kind: CellKind,
    /// Nodes, cell after cell, in the order of VTK.
    pub connectivity: &'a [u32],
}

impl Cells<'_> {
    /// Number of cells.
    pub fn count(&self) -> usize {
        self.connectivity.len() / self.kind.node_count()
    }

    /// Faces of a cell as local nodes, outward by the right-hand rule; a plane cell is its own face. Those of quadratic
    /// cells are cut between their nodes.
    pub(super) fn faces(&self) -> Vec<Vec<usize>> {
        let whole: Vec<usize> = (0..self.kind.node_count()).collect();
        let faces: &[&[usize]] = match self.kind.dim() {
            2 => &[&whole],
            _ => self.kind.facets(),
        };
        faces.iter().flat_map(|face| pieces(face)).collect()
    }
}

/// Flat pieces of a face: the nodes of a quadratic one are its corners, the middles of its edges, and its centre.
fn pieces(face: &[usize]) -> Vec<Vec<usize>> {
    let whole: &[usize] = &[0, 1, 2, 3][..face.len().min(4)];
    let pieces: &[&[usize]] = match face.len() {
        6 => &[&[0, 3, 5], &[3, 1, 4], &[5, 4, 2], &[3, 4, 5]],
        9 => &[&[0, 4, 8, 7], &[4, 1, 5, 8], &[8, 5, 2, 6], &[7, 8, 6, 3]],
        _ => &[whole],
    };
    let nodes = |piece: &&[usize]| piece.iter().map(|local| face[*local]).collect();
    pieces.iter().map(nodes).collect()
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

/// Components of a symmetric tensor \[-\].
pub(super) const SYMMETRIC: usize = 6;

impl Values<'_> {
    /// Numbers a tuple.
    pub fn components(&self) -> usize {
        match self {
            Values::Scalar(_) | Values::Integer(_) => 1,
            Values::Vector(_) => 3,
            Values::SymmetricTensor(_) => SYMMETRIC,
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
    pub(crate) fn cell_count(&self) -> usize {
        self.cells.iter().map(Cells::count).sum()
    }

    /// A vector field at the points.
    pub(crate) fn point_vector(&self, name: &str) -> Option<&'a [f64]> {
        self.point_data
            .iter()
            .find(|array| array.name == name)
            .and_then(|array| match array.values {
                Values::Vector(values) => Some(values),
                _ => None,
            })
    }

    /// A scalar field of the cells.
    #[must_use]
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
    #[must_use]
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
            if cells.connectivity.len() % cells.kind.node_count() != 0 {
                return Some(format!(
                    "the nodes of the {:?} cells are not full cells",
                    cells.kind
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
