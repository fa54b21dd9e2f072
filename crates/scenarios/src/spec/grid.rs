//! Axes of rectilinear meshes.

use fe_core::{GridAxis, GridPiece};
use serde::{Deserialize, Serialize};

/// Grid lines along one axis: pieces one after the other, up or down from `from`. `refine` divides all cells.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Axis {
    /// Where the first piece begins \[m\].
    pub from: f64,
    /// At least one piece; the first is `Cells`.
    pub pieces: Vec<Piece>,
}

/// A part of an axis, from the end of the part before.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum Piece {
    /// A number of cells.
    Cells {
        /// End \[m\].
        to: f64,
        /// Number of cells before `refine` \[-\].
        cells: usize,
        /// Size of the last cell over the size of the first \[-\]; 1 is uniform.
        #[serde(default = "one")]
        grading: f64,
    },
    /// As many cells as it takes when each is larger than the one before by `growth` at most, starting from the size of
    /// the last cell of the piece before.
    Growing {
        /// End \[m\].
        to: f64,
        /// Bound on the size of a cell over the size of the one before \[-\], 1 or more.
        growth: f64,
    },
}

fn one() -> f64 {
    1.0
}

impl Axis {
    /// The axis of the mesh generator.
    pub fn grid_axis(&self) -> GridAxis {
        let piece = |piece: &Piece| match *piece {
            Piece::Cells { to, cells, grading } => GridPiece::Cells { to, cells, grading },
            Piece::Growing { to, growth } => GridPiece::Growing { to, growth },
        };
        GridAxis {
            from: self.from,
            pieces: self.pieces.iter().map(piece).collect(),
        }
    }

    /// Smallest coordinate \[m\].
    pub fn min(&self) -> f64 {
        let ends = self.grid_axis().pieces.into_iter().map(|p| p.to());
        ends.fold(self.from, f64::min)
    }

    /// Number of cells before `refine`; none if there is no such grid.
    pub(super) fn cells(&self) -> f64 {
        self.grid_axis().cells().map_or(0.0, |cells| cells as f64)
    }
}
