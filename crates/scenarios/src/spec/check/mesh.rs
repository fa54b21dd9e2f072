//! Meshes of bodies.

use fe_core::{AnnulusMesh, CellKind};

use super::{Checker, MAX_GRADING, MAX_NODES};
use crate::spec::{GridAxis, GridPiece, Mesh};

/// Fewest cells of a ring, around and through: two around would be one on the other.
const LEAST_OF_RING: [usize; 2] = [3, 1];

impl Checker<'_> {
    pub(super) fn mesh(&mut self, mesh: &Mesh, path: &str) {
        match mesh {
            Mesh::Box(m) => {
                let (min, max) = (m.min.as_slice(), m.max.as_slice());
                self.lattice(min, max, &m.cells, &m.grading, path);
            }
            Mesh::Rectangle(m) => self.lattice(&m.min, &m.max, &m.cells, &m.grading, path),
            Mesh::Grid(m) => self.axes(&[("x", &m.x), ("y", &m.y)], m.crown, path),
            Mesh::SolidGrid(m) => {
                let axes = [("x", &m.x), ("y", &m.y), ("z", &m.z)];
                self.axes(&axes, m.crown, path);
            }
            Mesh::HalfBall(m) => {
                self.round(m.center.as_slice(), m.radius, m.cells, path);
                let hexahedra = m.kind.linear() == CellKind::Hex8;
                let message = "must be Hex8 or Hex27: a half ball is not cut into tetrahedra";
                self.require(hexahedra, &format!("{path}.element"), message);
            }
            Mesh::Disc(m) => self.round(&m.center, m.radius, m.cells, path),
            Mesh::HalfDisc(m) => self.round(&m.center, m.radius, m.cells, path),
            Mesh::QuarterDisc(m) => self.round(&m.center, m.radius, m.cells, path),
            Mesh::Annulus(m) => self.ring(m, path),
        }
        let nodes = mesh.size(self.scene.refine).nodes;
        let message = format!(
            "times refine = {} makes {nodes} nodes; at most {MAX_NODES}",
            self.scene.refine
        );
        self.require(nodes <= MAX_NODES, &format!("{path}.cells"), message);
    }

    fn ring(&mut self, ring: &AnnulusMesh, path: &str) {
        self.finite(&ring.center, &format!("{path}.center"));
        self.positive(ring.inner, &format!("{path}.inner"), "m");
        let message = format!("must be greater than inner = {} [m]", ring.inner);
        let larger = ring.outer.is_finite() && ring.outer > ring.inner;
        self.require(larger, &format!("{path}.outer"), message);
        for (i, least) in LEAST_OF_RING.into_iter().enumerate() {
            self.cells(ring.cells[i], least, &format!("{path}.cells.{i}"));
        }
        self.grading(ring.grading, &format!("{path}.grading"));
    }

    fn axes(&mut self, axes: &[(&str, &GridAxis)], crown: Option<f64>, path: &str) {
        self.positive(crown.unwrap_or(1.0), &format!("{path}.crown"), "m");
        for (name, axis) in axes {
            self.axis(axis, &format!("{path}.{name}"));
        }
    }

    fn lattice(&mut self, min: &[f64], max: &[f64], cells: &[usize], grading: &[f64], path: &str) {
        self.finite(min, &format!("{path}.min"));
        for (i, axis) in ["x", "y", "z"].into_iter().enumerate().take(min.len()) {
            let larger = max[i].is_finite() && max[i] > min[i];
            let message = format!(
                "must be greater than min.{axis} = {} [m], or the elements are inverted",
                min[i]
            );
            self.require(larger, &format!("{path}.max.{i}"), message);
            self.cells(cells[i], 1, &format!("{path}.cells.{i}"));
            self.grading(grading[i], &format!("{path}.grading.{i}"));
        }
    }

    fn axis(&mut self, axis: &GridAxis, path: &str) {
        self.finite(&[axis.from], &format!("{path}.from"));
        let path = format!("{path}.pieces");
        self.require(!axis.pieces.is_empty(), &path, "must hold a piece");
        let way = axis
            .pieces
            .first()
            .map_or(1.0, |piece| (piece.to() - axis.from).signum());
        let mut from = axis.from;
        for (i, piece) in axis.pieces.iter().enumerate() {
            let path = format!("{path}.{i}");
            let to = piece.to();
            let ahead = to.is_finite() && way * (to - from) > 0.0;
            let message = format!(
                "must differ from the end of the piece before, {from} [m], and all pieces must go the same way"
            );
            self.require(ahead, &format!("{path}.to"), message);
            from = to;
            match *piece {
                GridPiece::Cells { cells, grading, .. } => {
                    self.cells(cells, 1, &format!("{path}.cells"));
                    self.grading(grading, &format!("{path}.grading"));
                }
                GridPiece::Growing { growth, .. } => {
                    self.require(
                        (1.0..=MAX_GRADING).contains(&growth),
                        &format!("{path}.growth"),
                        format!("must be 1 or more and at most {MAX_GRADING:e} [-]"),
                    );
                    let message =
                        "has no piece before whose cells it could continue; begin with Cells";
                    self.require(i > 0, &path, message);
                }
            }
        }
    }

    fn round(&mut self, center: &[f64], radius: f64, cells: usize, path: &str) {
        self.finite(center, &format!("{path}.center"));
        self.positive(radius, &format!("{path}.radius"), "m");
        self.cells(cells, 1, &format!("{path}.cells"));
    }

    fn cells(&mut self, cells: usize, least: usize, path: &str) {
        self.require(cells >= least, path, format!("must be {least} or more [-]"));
    }
}
