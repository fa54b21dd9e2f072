//! Meshes of bodies.

use super::{Checker, MAX_NODES};
use crate::spec::{Element, Mesh};

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
                self.positive(*grading, &format!("{path}.grading"), "-");
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
            self.positive(grading[i], &format!("{path}.grading.{i}"), "-");
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
