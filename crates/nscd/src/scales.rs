//! Sizes of a model that do not change in a run.

use nalgebra::Vector3;

use crate::flat::largest;
use crate::model::Model;

/// What round-off and costs are measured by.
#[derive(Debug)]
pub(crate) struct ModelScales {
    /// Largest coordinate of a node \[m\].
    pub(crate) extent: f64,
    /// Shortest edge of the bounding boxes of the elements around each node \[m\].
    pub(crate) element_size: Vec<f64>,
    /// Largest row sum of the mass matrix \[kg\].
    pub(crate) largest_mass: f64,
    /// Elements of all blocks.
    pub(crate) elements: usize,
    /// Largest distance at which contacts are looked for \[m\].
    pub(crate) reach: f64,
}

impl ModelScales {
    pub(crate) fn of(model: &Model) -> Self {
        let points = model.solid.mesh().points.iter();
        let reach = model.interfaces.iter().map(|i| i.search_distance);
        Self {
            extent: points.map(Vector3::amax).fold(0.0, f64::max),
            element_size: smallest_edges(model),
            largest_mass: largest(&model.mass.row_sums()),
            elements: model.solid.element_count(),
            reach: reach.fold(0.0, f64::max),
        }
    }
}

fn smallest_edges(model: &Model) -> Vec<f64> {
    let points = &model.solid.mesh().points;
    let dim = model.solid.dim();
    let blocks = model.solid.blocks().iter();
    let cells = blocks.flat_map(|b| b.connectivity().chunks_exact(b.nodes_per_element()));
    let mut smallest = vec![f64::MAX; points.len()];
    for cell in cells {
        let extent = |c: usize| {
            let along = cell.iter().map(|&n| points[n as usize][c]);
            along.clone().fold(f64::MIN, f64::max) - along.fold(f64::MAX, f64::min)
        };
        let edge = (0..dim).map(extent).fold(f64::MAX, f64::min);
        for &n in cell {
            let at = &mut smallest[n as usize];
            *at = at.min(edge);
        }
    }
    smallest
}
