//! Meshes of bodies.

use super::{Checker, MAX_GRADING, MAX_NODES};
use crate::spec::{Element, GridAxis, GridPiece, Mesh};

impl Checker<'_> {
    pub(super) fn mesh(&mut self, mesh: &Mesh, path: &str) {
        match mesh {
            Mesh::Box {
                min,
                max,
                cells,
                grading,
                ..
            } => self.lattice(min, max, cells, grading, path),
            Mesh::Rectangle {
                min,
                max,
                cells,
                grading,
                ..
            } => self.lattice(min, max, cells, grading, path),
            Mesh::Grid { x, y, crown, .. } => {
                self.positive(crown.unwrap_or(1.0), &format!("{path}.crown"), "m");
                self.axis(x, &format!("{path}.x"));
                self.axis(y, &format!("{path}.y"));
            }
            Mesh::SolidGrid { x, y, z, crown, .. } => {
                self.positive(crown.unwrap_or(1.0), &format!("{path}.crown"), "m");
                self.axis(x, &format!("{path}.x"));
                self.axis(y, &format!("{path}.y"));
                self.axis(z, &format!("{path}.z"));
            }
            Mesh::HalfBall {
                center,
                radius,
                cells,
                element,
                ..
            } => {
                self.round(center, *radius, *cells, path);
                let hexahedra = matches!(element, Element::Hex8 | Element::Hex27);
                let message = "must be Hex8 or Hex27: a half ball is not cut into tetrahedra";
                self.require(hexahedra, &format!("{path}.element"), message.to_owned());
            }
            Mesh::Disc {
                center,
                radius,
                cells,
                ..
            }
            | Mesh::HalfDisc {
                center,
                radius,
                cells,
                ..
            }
            | Mesh::QuarterDisc {
                center,
                radius,
                cells,
                ..
            } => self.round(center, *radius, *cells, path),
            Mesh::Annulus {
                center,
                inner,
                outer,
                cells,
                grading,
                ..
            } => {
                self.finite(center, &format!("{path}.center"));
                self.positive(*inner, &format!("{path}.inner"), "m");
                let message = format!("must be greater than inner = {inner} [m]");
                let larger = outer.is_finite() && outer > inner;
                self.require(larger, &format!("{path}.outer"), message);
                for (i, least) in [3, 1].into_iter().enumerate() {
                    self.cells(cells[i], least, &format!("{path}.cells.{i}"));
                }
                self.grading(*grading, &format!("{path}.grading"));
            }
        }
        let nodes = mesh.size(self.scene.refine).nodes;
        let message = format!(
            "times refine = {} makes {nodes} nodes; at most {MAX_NODES}",
            self.scene.refine
        );
        self.require(nodes <= MAX_NODES, &format!("{path}.cells"), message);
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
