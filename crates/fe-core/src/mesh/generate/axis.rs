//! Grid lines along one axis, in pieces.

use super::{require, require_cells, require_indices, require_positive};
use crate::mesh::MeshError;
#[cfg(feature = "serde")]
use crate::mesh::text::{Deserialize, Serialize, even};

/// Grid lines along one axis: pieces one after the other, away from `from`, all in the same direction.
///
/// Inside a piece the sizes of the cells form a geometric sequence. Refinement divides the cells in the same smooth
/// way, so refined grids contain the lines of the coarse one, and all sizes shrink alike.
///
/// ```
/// use fe_core::{GridAxis, GridPiece};
/// let axis = GridAxis {
///     from: 0.0,
///     pieces: vec![
///         GridPiece::Cells { to: -1.0, cells: 4, grading: 1.0 },
///         GridPiece::Growing { to: -3.0, growth: 1.5 },
///     ],
/// };
/// assert_eq!(axis.lines(1)?.len(), 1 + 4 + 4);
/// # Ok::<(), fe_core::MeshError>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(Serialize, Deserialize),
    serde(rename = "Axis", deny_unknown_fields)
)]
pub struct GridAxis {
    /// Where the first piece begins \[m\].
    pub from: f64,
    /// At least one piece; the first one is [`GridPiece::Cells`].
    pub pieces: Vec<GridPiece>,
}

/// A part of an axis, from the end of the part before.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(Serialize, Deserialize),
    serde(rename = "Piece", deny_unknown_fields)
)]
pub enum GridPiece {
    /// A given number of cells.
    Cells {
        /// End \[m\].
        to: f64,
        /// Number of cells, at least 1.
        cells: usize,
        /// Size of the last cell over that of the first \[-\]; 1 is uniform.
        #[cfg_attr(feature = "serde", serde(default = "even"))]
        grading: f64,
    },
    /// Cells that continue those of the piece before: each is larger than its neighbour by the same ratio, which is the
    /// largest up to `growth` that ends at `to`.
    Growing {
        /// End \[m\].
        to: f64,
        /// Bound on the size of a cell over that of the one before \[-\], at least 1.
        growth: f64,
    },
}

impl GridPiece {
    /// End \[m\].
    pub fn to(&self) -> f64 {
        match *self {
            GridPiece::Cells { to, .. } | GridPiece::Growing { to, .. } => to,
        }
    }
}

impl GridAxis {
    /// One piece of `cells` cells from `min` to `max` \[m\]; `grading` is the size of the last over that of the first.
    #[must_use]
    pub fn graded(min: f64, max: f64, cells: usize, grading: f64) -> GridAxis {
        let piece = GridPiece::Cells {
            to: max,
            cells,
            grading,
        };
        GridAxis {
            from: min,
            pieces: vec![piece],
        }
    }

    /// Number of cells before refinement.
    ///
    /// # Errors
    /// [`MeshError::Shape`] for no piece or one without extent or against the direction of the first, no cell, a
    /// grading that is not positive, a growth below 1, a first piece that has nothing to continue, or more lines than
    /// 32-bit indices can address.
    pub fn cells(&self) -> Result<usize, MeshError> {
        let cells: f64 = self.runs()?.iter().map(|run| run.cells).sum();
        require_indices("grid", cells)?;
        Ok(cells as usize)
    }

    /// The grid lines \[m\], increasing, with each cell divided into `refine`.
    ///
    /// # Errors
    /// Those of [`GridAxis::cells`], also for `refine = 0`.
    pub fn lines(&self, refine: usize) -> Result<Vec<f64>, MeshError> {
        require_cells("grid", "refine", refine)?;
        require_indices("grid", self.cells()? as f64 * refine as f64)?;
        let runs = self.runs()?;
        let mut lines = vec![self.from];
        for run in &runs {
            let count = run.cells as usize * refine;
            lines.extend((1..count).map(|k| run.line(k as f64 / refine as f64)));
            lines.push(run.to);
        }
        if runs.iter().any(|run| run.to < run.from) {
            lines.reverse();
        }
        Ok(lines)
    }

    fn runs(&self) -> Result<Vec<Run>, MeshError> {
        let shape = "grid";
        require(
            self.from.is_finite(),
            shape,
            "start [m]",
            self.from,
            "must be finite",
        )?;
        let count = self.pieces.len();
        require_cells(shape, "pieces", count)?;
        let way = (self.pieces[0].to() - self.from).signum();
        let mut runs: Vec<Run> = Vec::with_capacity(count);
        for (index, piece) in self.pieces.iter().enumerate() {
            let from = runs.last().map_or(self.from, |run| run.to);
            let what = |what: &str| format!("{what} of piece {index}");
            let length = way * (piece.to() - from);
            require_positive(
                shape,
                &what("length [m] in the direction of the first"),
                length,
            )?;
            runs.push(match *piece {
                GridPiece::Cells { to, cells, grading } => {
                    require_cells(shape, &what("cells"), cells)?;
                    require_positive(shape, &what("grading"), grading)?;
                    Run::graded(from, to, cells, grading)
                }
                GridPiece::Growing { to, growth } => {
                    let good = growth >= 1.0 && growth.is_finite();
                    require(good, shape, &what("growth"), growth, "must be at least 1")?;
                    let last = runs.last().map_or(0.0, Run::last_size);
                    let size = "size of the cell before [m]";
                    require_positive(shape, &what(size), last)?;
                    Run::growing(from, to, last, growth)
                }
            });
        }
        Ok(runs)
    }
}

/// By how little a number of cells may exceed a whole one without another cell \[-\]: a length made for a whole number
/// of cells shall get that number, whatever the round-off.
const WHOLE_CELLS: f64 = 1e-9;

/// Bisections of an interval of size 1 or so: far more than the 53 that leave two neighbouring numbers.
const BISECTIONS: usize = 200;

/// A geometric sequence of cells.
#[derive(Debug, Clone, Copy)]
pub(super) struct Run {
    from: f64,
    to: f64,
    /// A whole number; more than an integer can hold is refused later.
    cells: f64,
    /// Logarithm of the size of a cell over that of the one before.
    log_ratio: f64,
}

impl Run {
    /// `grading` is the size of the last cell over that of the first.
    pub(super) fn graded(from: f64, to: f64, cells: usize, grading: f64) -> Run {
        Run {
            from,
            to,
            cells: cells as f64,
            log_ratio: grading.ln() / (cells.max(2) - 1) as f64,
        }
    }

    /// The fewest cells that grow by `growth` at most, starting from one of size `last` just before.
    fn growing(from: f64, to: f64, last: f64, growth: f64) -> Run {
        let length = (to - from).abs() / last;
        let log = growth.ln();
        let exact = if log == 0.0 {
            length
        } else {
            (length * (log.exp_m1() / growth)).ln_1p() / log
        };
        let cells = (exact - WHOLE_CELLS).ceil().max(1.0);
        Run {
            from,
            to,
            cells,
            log_ratio: log_ratio_filling(length, cells, log),
        }
    }

    /// The line after `s` cells \[m\]; `s` need not be whole.
    fn line(&self, s: f64) -> f64 {
        let fraction = if self.log_ratio == 0.0 {
            s / self.cells
        } else {
            (s * self.log_ratio).exp_m1() / (self.cells * self.log_ratio).exp_m1()
        };
        self.from + (self.to - self.from) * fraction
    }

    pub(super) fn lines(&self) -> Vec<f64> {
        let inner = (0..self.cells as usize).map(|k| self.line(k as f64));
        inner.chain([self.to]).collect()
    }

    fn last_size(&self) -> f64 {
        // Not from the difference of two lines, which a large coordinate would round.
        let cells = if self.log_ratio == 0.0 {
            self.cells
        } else {
            (-self.cells * self.log_ratio).exp_m1() / (-self.log_ratio).exp_m1()
        };
        (self.to - self.from).abs() / cells
    }
}

/// The logarithm `q`, at most `bound`, for which `exp(q) + exp(2 q) + .. + exp(cells q) = length`.
fn log_ratio_filling(length: f64, cells: f64, bound: f64) -> f64 {
    if cells == 1.0 {
        return length.ln();
    }
    let sum = |q: f64| {
        if q == 0.0 {
            cells
        } else {
            q.exp() * (cells * q).exp_m1() / q.exp_m1()
        }
    };
    // More than one cell is needed, so the length is above 1, and the sum at -1 is below.
    let (mut low, mut high) = (-1.0, bound);
    for _ in 0..BISECTIONS {
        let middle = 0.5 * (low + high);
        if sum(middle) < length {
            low = middle;
        } else {
            high = middle;
        }
    }
    0.5 * (low + high)
}
