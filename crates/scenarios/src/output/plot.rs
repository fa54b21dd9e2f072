//! Pictures as SVG.
//!
//! The backend places everything on whole pixels and cannot measure text. So pictures are drawn `FINE` times larger
//! and shown at their nominal size, and nothing depends on the width of a text: legends stand in a column of their
//! own.

mod deformed;
mod scale;

use plotters::prelude::*;

use self::scale::Scale;
use super::{ENERGY_COLUMNS, History};

pub use self::deformed::deformed_svg;

/// Drawn pixels per shown pixel.
const FINE: u32 = 4;
const WIDTH: u32 = 900;
const HEIGHT: u32 = 520;
/// Column of the legend.
const LEGEND: u32 = 190;

const INK: RGBColor = RGBColor(40, 44, 52);
const GRID: RGBColor = RGBColor(226, 229, 234);
/// Okabe and Ito's colours, which colour-blind people can tell apart.
const COLORS: [RGBColor; 9] = [
    RGBColor(0, 114, 178),
    RGBColor(213, 94, 0),
    RGBColor(0, 158, 115),
    RGBColor(204, 121, 167),
    RGBColor(230, 159, 0),
    RGBColor(86, 180, 233),
    RGBColor(148, 103, 60),
    RGBColor(110, 110, 110),
    RGBColor(120, 60, 160),
];

/// A line of a chart.
struct Curve {
    name: String,
    color: RGBColor,
    points: Vec<(f64, f64)>,
}

/// Size in drawn pixels of a size in shown pixels.
fn px(shown: u32) -> u32 {
    shown * FINE
}

fn ipx(shown: u32) -> i32 {
    (shown * FINE) as i32
}

fn font(size: u32) -> TextStyle<'static> {
    // The backend divides font sizes by 1.24.
    ("sans-serif", f64::from(px(size)) * 1.24)
        .into_font()
        .color(&INK)
}

/// Energies, works and dissipations over time; those that are zero throughout are left out.
///
/// # Errors
/// What the drawing library reports.
pub fn energy_svg(title: &str, history: &History) -> Result<String, String> {
    let time = history.column("t").unwrap_or_default();
    let mut total = vec![0.0; time.len()];
    let mut curves = Vec::new();
    for (i, column) in ENERGY_COLUMNS.iter().enumerate() {
        let values = history.column(column).unwrap_or_default();
        if column.starts_with("energy.") {
            total
                .iter_mut()
                .zip(&values)
                .for_each(|(sum, value)| *sum += value);
        }
        if values.iter().any(|value| *value != 0.0) {
            curves.push(curve(spoken(column), COLORS[i], &time, &values));
        }
    }
    curves.push(curve("total energy".into(), INK, &time, &total));
    chart(title, "Energy", "J", curves)
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
pub fn series_svg(
    title: &str,
    label: &str,
    history: &History,
    columns: &[(String, String)],
) -> Result<String, String> {
    let time = history.column("t").unwrap_or_default();
    let curves = columns
        .iter()
        .enumerate()
        .filter_map(|(i, (name, column))| {
            Some(curve(
                name.clone(),
                COLORS[i % COLORS.len()],
                &time,
                &history.column(column)?,
            ))
        });
    let (quantity, unit) = label.split_once(" [").unwrap_or((label, "-"));
    chart(
        title,
        quantity,
        unit.trim_end_matches(']'),
        curves.collect(),
    )
}

fn curve(name: String, color: RGBColor, x: &[f64], y: &[f64]) -> Curve {
    let points = x.iter().copied().zip(y.iter().copied());
    Curve {
        name,
        color,
        points: points
            .filter(|(x, y)| x.is_finite() && y.is_finite())
            .collect(),
    }
}

fn chart(title: &str, quantity: &str, unit: &str, curves: Vec<Curve>) -> Result<String, String> {
    let mut svg = String::new();
    draw_chart(&mut svg, title, quantity, unit, &curves).map_err(|error| error.to_string())?;
    Ok(shown_size(&svg, WIDTH, HEIGHT))
}

fn draw_chart(
    svg: &mut String,
    title: &str,
    quantity: &str,
    unit: &str,
    curves: &[Curve],
) -> Result<(), Box<dyn std::error::Error>> {
    let root = SVGBackend::with_string(svg, (px(WIDTH), px(HEIGHT))).into_drawing_area();
    root.fill(&WHITE)?;
    let all = || curves.iter().flat_map(|curve| &curve.points);
    let x = Scale::around(all().map(|p| p.0), 8, false);
    let y = Scale::around(all().map(|p| p.1), 7, true);
    let (left, right) = root.split_horizontally(px(WIDTH - LEGEND));
    left.draw(&Text::new(title.to_owned(), (ipx(72), ipx(14)), font(16)))?;
    let mut context = ChartBuilder::on(&left)
        .margin_top(px(44))
        .margin_right(px(14))
        .margin_bottom(px(10))
        .margin_left(px(10))
        .set_label_area_size(LabelAreaPosition::Left, px(62))
        .set_label_area_size(LabelAreaPosition::Bottom, px(46))
        .build_cartesian_2d(x.low..x.high, y.low..y.high)?;
    context
        .configure_mesh()
        .disable_mesh()
        .x_labels(x.count())
        .y_labels(y.count())
        .x_label_formatter(&|v| x.tick(*v))
        .y_label_formatter(&|v| y.tick(*v))
        .x_desc(x.label("Time", "s"))
        .y_desc(y.label(quantity, unit))
        .label_style(font(12))
        .axis_desc_style(font(13))
        .set_all_tick_mark_size(px(5))
        .axis_style(INK.stroke_width(FINE))
        .draw()?;
    for (ticks, vertical) in [(x.ticks(), true), (y.ticks(), false)] {
        for tick in ticks {
            let line = if vertical {
                [(tick, y.low), (tick, y.high)]
            } else {
                [(x.low, tick), (x.high, tick)]
            };
            let color = if tick == 0.0 && !vertical {
                RGBColor(150, 156, 166)
            } else {
                GRID
            };
            context.draw_series(LineSeries::new(line, color.stroke_width(FINE)))?;
        }
    }
    for curve in curves {
        context.draw_series(LineSeries::new(
            curve.points.iter().copied(),
            curve.color.stroke_width(2 * FINE),
        ))?;
    }
    for (i, curve) in curves.iter().enumerate() {
        let row = ipx(58 + 22 * i as u32);
        let line = vec![(ipx(4), row), (ipx(28), row)];
        right.draw(&PathElement::new(line, curve.color.stroke_width(3 * FINE)))?;
        right.draw(&Text::new(
            curve.name.clone(),
            (ipx(36), row - ipx(6)),
            font(12),
        ))?;
    }
    root.present()?;
    Ok(())
}

/// The picture with its nominal size in the header; the drawing keeps its finer coordinates.
fn shown_size(svg: &str, width: u32, height: u32) -> String {
    let drawn = format!("<svg width=\"{}\" height=\"{}\"", px(width), px(height));
    svg.replacen(
        &drawn,
        &format!("<svg width=\"{width}\" height=\"{height}\""),
        1,
    )
}
