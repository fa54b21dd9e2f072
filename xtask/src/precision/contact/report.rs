//! The table as Markdown, and error against time as a plot.

use std::fmt::Write as _;

use plotters::prelude::*;

use super::{Point, Study, TOLERANCES};
use crate::fclib::profile::{Area, COLORS, Drawn, key};

/// Pixels of a chart.
const CHART: (u32, u32) = (400, 340);
/// Charts in a row; the key takes the place after the last.
const COLUMNS: usize = 3;
/// Smallest power of ten of an error shown: rounding.
const LEAST: f64 = -16.0;

pub(super) fn markdown(studies: &[Study]) -> String {
    let mut text = "# Error against time of the contact methods\n\n\
        Made by `cargo xtask precision contact`. Every solve starts from zero, runs on one thread and may take 20000 sweeps or\n\
        projections, `newton` 200 steps. A column is a tolerance on all errors of a solution (see\n\
        [solvers](../theory/solvers.md)); a cell gives CPU seconds, the mean over many solves where one is short. The first\n\
        tolerance that a method does not reach ends its row: in italics the scale-free error, recomputed from the reactions,\n\
        that was left. The half-space has a `W` of full rank, that of the wall is a quarter of its size in rank at most.\n\
        Problems of other codes are there if the folder `FCLIB_DIR`, or `../shared/fclib`, has their files.\n\n\
        ![Error against time](contact_precision.svg)\n\n\
        Error reached over CPU seconds, a disc for each tolerance reached, a ring where the method ended unsolved.\n"
        .to_owned();
    for study in studies {
        let _ = writeln!(text, "\n## {}, {} contacts\n", study.name, study.contacts);
        let _ = writeln!(text, "| method | {} |", TOLERANCES.join(" | "));
        let _ = writeln!(text, "|---|{}", "---:|".repeat(TOLERANCES.len()));
        for (method, points) in &study.methods {
            let cells = (0..TOLERANCES.len()).map(|k| cell(points.get(k)));
            let cells: Vec<String> = cells.collect();
            let _ = writeln!(text, "| {method} | {} |", cells.join(" | "));
        }
    }
    text
}

fn cell(point: Option<&Point>) -> String {
    match point {
        Some(p) if p.solved => format!("{:.1e}", p.cpu),
        Some(p) => format!("*error {:.0e}*", p.error),
        None => String::new(),
    }
}

pub(super) fn svg(studies: &[Study]) -> Result<String, String> {
    let mut text = String::new();
    draw(&mut text, studies).map_err(|e| format!("the errors cannot be drawn: {e}"))?;
    Ok(text)
}

fn draw(text: &mut String, studies: &[Study]) -> Drawn {
    let rows = (studies.len() + 1).div_ceil(COLUMNS);
    let size = (CHART.0 * COLUMNS as u32, CHART.1 * rows as u32);
    let root = SVGBackend::with_string(text, size).into_drawing_area();
    root.fill(&WHITE)?;
    let areas = root.split_evenly((rows, COLUMNS));
    for (area, study) in areas.iter().zip(studies) {
        chart(area, study)?;
    }
    if let (Some(area), Some(study)) = (areas.get(studies.len()), studies.first()) {
        let names: Vec<&str> = study.methods.iter().map(|m| m.0).collect();
        key(&area.margin(0, 0, 40, 0), &names)?;
    }
    root.present()?;
    Ok(())
}

fn chart(area: &Area<'_>, study: &Study) -> Drawn {
    let times = study.methods.iter().flat_map(|m| &m.1);
    let times: Vec<f64> = times.map(|p| p.cpu.log10()).collect();
    let first = times.iter().copied().fold(f64::INFINITY, f64::min).floor();
    let last = times.iter().copied().fold(first + 1.0, f64::max).ceil();
    let mut chart = ChartBuilder::on(area)
        .caption(short(&study.name), ("sans-serif", 16))
        .margin(10)
        .x_label_area_size(40)
        .y_label_area_size(52)
        .build_cartesian_2d(first..last, LEAST..0.0)?;
    chart
        .configure_mesh()
        .light_line_style(TRANSPARENT)
        .bold_line_style(RGBColor(226, 229, 234))
        .x_labels((last - first) as usize + 1)
        .y_labels(9)
        .x_label_formatter(&power)
        .y_label_formatter(&power)
        .x_desc("CPU time [s]")
        .y_desc("scale-free error")
        .label_style(("sans-serif", 12))
        .axis_desc_style(("sans-serif", 13))
        .draw()?;
    // The first method last, so that it lies on top.
    for (k, (_, points)) in study.methods.iter().enumerate().rev() {
        let color = COLORS[k % COLORS.len()];
        let line = points.iter().map(place);
        chart.draw_series(LineSeries::new(line, color.stroke_width(2)))?;
        chart.draw_series(points.iter().map(|p| {
            let style = if p.solved {
                color.filled()
            } else {
                color.stroke_width(1)
            };
            Circle::new(place(p), if p.solved { 2 } else { 5 }, style)
        }))?;
    }
    Ok(())
}

fn place(p: &Point) -> (f64, f64) {
    (p.cpu.log10(), p.error.log10().clamp(LEAST, 0.0))
}

/// A file's name without its endings and numbers.
fn short(name: &str) -> &str {
    name.split("-i").next().unwrap_or(name)
}

/// A power of ten, given its exponent.
fn power(x: &f64) -> String {
    if x.fract() == 0.0 {
        format!("1e{x:.0}")
    } else {
        String::new()
    }
}
