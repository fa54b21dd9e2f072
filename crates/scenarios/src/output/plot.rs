//! Pictures as SVG.
//!
//! The backend places everything on whole pixels and cannot measure text. So pictures are drawn `FINE` times larger
//! and shown at their nominal size, and nothing depends on the width of a text: legends stand in a column of their
//! own.
//!
//! Meshes and maps of many facets stand in the drawing as an image, which weighs a tenth of their outlines.

mod chart;
mod color;
mod deformed;
mod maps;
mod patches;
mod picture;
mod scale;
mod style;

use self::picture::picture;
use super::History;
use crate::energies::ENERGY_TERMS;

pub use self::chart::{Axis, Band, Chart, Curve, Pen, charts_svg};
pub use self::deformed::deformed_svg;
pub use self::maps::{MapFrame, Maps, maps_svg};

const WIDTH: u32 = 900;
const HEIGHT: u32 = 520;
/// Column of the legend.
const LEGEND: u32 = 190;

/// Energies, works and dissipations over time; those that are zero throughout are left out.
///
/// # Errors
/// What the drawing library reports.
pub(super) fn energy_svg(title: &str, unit: &str, history: &History) -> Result<String, String> {
    let time = history.column("t").unwrap_or_default();
    let mut total = vec![0.0; time.len()];
    let mut curves = Vec::new();
    for (i, term) in ENERGY_TERMS.iter().enumerate() {
        let values = history.column(term.column).unwrap_or_default();
        if term.is_stored() {
            total
                .iter_mut()
                .zip(&values)
                .for_each(|(sum, value)| *sum += value);
        }
        if values.iter().any(|value| *value != 0.0) {
            curves.push(Curve {
                pen: Pen::Color(i),
                ..Curve::new(spoken(term.column), &time, &values)
            });
        }
    }
    curves.push(Curve {
        pen: Pen::Ink,
        ..Curve::new("total energy", &time, &total)
    });
    over_time(title, Axis::linear("Energy", unit), curves)
}

/// `dissipation.friction` as `friction dissipation`.
fn spoken(column: &str) -> String {
    match column.split_once('.') {
        Some((kind, what)) => format!("{what} {kind}"),
        None => column.to_owned(),
    }
}

/// Columns of a history over time. `label` is a quantity with its unit, `Force \[N\]`; `columns` are pairs of the name
/// in the legend and the name of the column.
///
/// # Errors
/// What the drawing library reports.
pub(super) fn series_svg(
    title: &str,
    label: &str,
    history: &History,
    columns: &[(String, String)],
) -> Result<String, String> {
    let time = history.column("t").unwrap_or_default();
    let curves = columns.iter().filter_map(|(name, column)| {
        Some(Curve::new(name.clone(), &time, &history.column(column)?))
    });
    let (quantity, unit) = label.split_once(" [").unwrap_or((label, "-"));
    let axis = Axis::linear(quantity, unit.trim_end_matches(']'));
    over_time(title, axis, curves.collect())
}

fn over_time(title: &str, y: Axis, curves: Vec<Curve>) -> Result<String, String> {
    let chart = Chart::new(title, Axis::linear("Time", "s"), y, curves);
    picture([WIDTH, HEIGHT], &[], |root| chart.draw(root, WIDTH, LEGEND))
}
