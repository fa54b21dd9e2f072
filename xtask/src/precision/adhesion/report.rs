//! The tables as Markdown, and error against time as a plot.

use std::fmt::Write as _;

use plotters::prelude::*;

use super::{Findings, Row};
use crate::fclib::profile::{Area, COLORS, Drawn};

/// Pixels of a chart.
const CHART: (u32, u32) = (480, 360);
const COLUMNS: usize = 2;
/// Deviations that are asked for [-].
const BOUNDS: [f64; 2] = [0.05, 0.02];
/// Powers of ten of the deviations shown.
const SHOWN: (f64, f64) = (-5.0, 0.0);

pub(super) fn markdown(all: &[Findings]) -> String {
    let mut text = "# Error against time of the scenes with adhesion\n\n\
        Made by `cargo xtask precision adhesion`. A row is a run on one thread; its CPU seconds hold the building of the model, but\n\
        no output. Peaks are those of the parabola through the largest value and its neighbours, times those of the line\n\
        between two steps, so that the steps do not quantise them. In brackets the deviation from the finest row of the\n\
        ladder (in bold), in which mesh and step are halved together. The other rows halve one of the two.\n\
        The limit is extrapolated from the last three rungs where the steps between them shrink.\n\n\
        ![Error against time](adhesion.svg)\n\n\
        Deviation of every quantity from the finest level over CPU seconds, along the ladder.\n"
        .to_owned();
    for findings in all {
        section(&mut text, findings);
    }
    text
}

fn section(text: &mut String, findings: &Findings) {
    let case = findings.case;
    let _ = writeln!(text, "\n## {}\n\n{}\n", case.title, case.about);
    let quantities = case.quantities.iter();
    let heads: Vec<String> = quantities
        .map(|q| format!("{} [{}]", q.name, q.unit))
        .collect();
    let _ = writeln!(
        text,
        "| mesh | dt [s] | unknowns | cut steps | CPU [s] | {} |\n|---|---:|---:|---:|---:|{}",
        heads.join(" | "),
        "---:|".repeat(heads.len())
    );
    for row in &findings.rows {
        let _ = writeln!(text, "{}", line(findings, row));
    }
    let _ = writeln!(text, "{}", limits(findings));
    let _ = writeln!(text, "\n{}", verdict(findings));
}

/// What the ladder goes to, and how far its finest row is from there.
fn limits(findings: &Findings) -> String {
    let finest = findings.reference().map_or(&[][..], |row| &row.values);
    let cells = finest.iter().enumerate().map(|(k, value)| {
        findings.limit(k).map_or("-".to_owned(), |limit| {
            let left = 100.0 * (value / limit - 1.0);
            format!("{} (finest {left:+.1} %)", digits(limit))
        })
    });
    let cells: Vec<String> = cells.collect();
    format!("| limit | | | | | {} |", cells.join(" | "))
}

fn line(findings: &Findings, row: &Row) -> String {
    let bold = if row.level.ladder { "**" } else { "" };
    let errors = findings.errors(row);
    let cells = row.values.iter().zip(errors).map(|(value, error)| {
        let deviation = if error == 0.0 {
            String::new()
        } else {
            format!(" ({:+.1} %)", 100.0 * error)
        };
        format!("{}{deviation}", digits(*value))
    });
    let cells: Vec<String> = cells.collect();
    format!(
        "| {bold}{}{bold}{} | {} | {} | {} | {:.1} | {} |",
        row.level.mesh,
        if row.level.default { " (default)" } else { "" },
        row.level.dt,
        row.run.dofs,
        row.run.rejected,
        row.run.cpu,
        cells.join(" | ")
    )
}

/// Four digits that count.
fn digits(value: f64) -> String {
    let magnitude = value.abs().max(1e-9).log10().floor() as i32;
    format!("{value:.*}", (3 - magnitude).max(0) as usize)
}

fn verdict(findings: &Findings) -> String {
    let cheapest = |bound: f64| {
        let rows = findings.rows.iter();
        let fine = rows.filter(|r| findings.worst(r) <= bound && findings.worst(r) > 0.0);
        let cheapest = fine.min_by(|a, b| a.run.cpu.total_cmp(&b.run.cpu));
        let percent = 100.0 * bound;
        cheapest.map_or(
            format!("No row but the finest is within {percent:.0} % of it."),
            |row| {
                format!(
                    "All numbers within {percent:.0} % of the finest: {} with dt = {}, {:.1} s (the finest takes {:.0} s).",
                    row.level.mesh,
                    row.level.dt,
                    row.run.cpu,
                    findings.reference().map_or(f64::NAN, |r| r.run.cpu)
                )
            },
        )
    };
    let mut lines: Vec<String> = BOUNDS.map(cheapest).into();
    if let Some(row) = findings.rows.iter().find(|r| r.level.default) {
        lines.push(match 100.0 * findings.worst(row) {
            0.0 => "The scene as it is: the finest here.".to_owned(),
            worst => format!("The scene as it is: within {worst:.1} %."),
        });
    }
    lines.join("\n")
}

pub(super) fn svg(all: &[Findings]) -> Result<String, String> {
    let mut text = String::new();
    draw(&mut text, all).map_err(|e| format!("the errors cannot be drawn: {e}"))?;
    Ok(text)
}

fn draw(text: &mut String, all: &[Findings]) -> Drawn {
    let rows = all.len().div_ceil(COLUMNS);
    let size = (CHART.0 * COLUMNS as u32, CHART.1 * rows as u32);
    let root = SVGBackend::with_string(text, size).into_drawing_area();
    root.fill(&WHITE)?;
    for (area, findings) in root.split_evenly((rows, COLUMNS)).iter().zip(all) {
        chart(area, findings)?;
    }
    root.present()?;
    Ok(())
}

fn chart(area: &Area<'_>, findings: &Findings) -> Drawn {
    let ladder = findings.rows.iter().filter(|row| row.level.ladder);
    let coarse: Vec<&Row> = ladder.filter(|row| findings.worst(row) > 0.0).collect();
    let times = coarse.iter().map(|row| row.run.cpu.log10());
    let first = times.clone().fold(f64::INFINITY, f64::min).floor();
    let last = times.fold(first + 1.0, f64::max).ceil();
    let mut chart = ChartBuilder::on(area)
        .caption(findings.case.title, ("sans-serif", 16))
        .margin(10)
        .x_label_area_size(40)
        .y_label_area_size(52)
        .build_cartesian_2d(first..last, SHOWN.0..SHOWN.1)?;
    chart
        .configure_mesh()
        .light_line_style(TRANSPARENT)
        .bold_line_style(RGBColor(226, 229, 234))
        .x_labels((last - first) as usize + 1)
        .y_labels(6)
        .x_label_formatter(&power)
        .y_label_formatter(&power)
        .x_desc("CPU time [s]")
        .y_desc("deviation from the finest")
        .label_style(("sans-serif", 12))
        .axis_desc_style(("sans-serif", 13))
        .draw()?;
    for bound in BOUNDS {
        let line = [first, last].map(|x| (x, bound.log10()));
        chart.draw_series(LineSeries::new(line, BLACK.mix(0.4)))?;
    }
    for (k, quantity) in findings.case.quantities.iter().enumerate() {
        let color = COLORS[k % COLORS.len()];
        let place = |row: &&Row| {
            let error = findings.errors(row)[k].abs().log10();
            (row.run.cpu.log10(), error.clamp(SHOWN.0, SHOWN.1))
        };
        let points: Vec<(f64, f64)> = coarse.iter().map(place).collect();
        chart
            .draw_series(LineSeries::new(points.clone(), color.stroke_width(2)))?
            .label(quantity.name)
            .legend(move |(x, y)| PathElement::new([(x, y), (x + 16, y)], color.stroke_width(2)));
        chart.draw_series(points.iter().map(|p| Circle::new(*p, 3, color.filled())))?;
    }
    chart
        .configure_series_labels()
        .position(SeriesLabelPosition::LowerLeft)
        .background_style(WHITE.mix(0.8))
        .label_font(("sans-serif", 12))
        .draw()?;
    Ok(())
}

/// A power of ten, given its exponent.
fn power(x: &f64) -> String {
    if x.fract() == 0.0 {
        format!("1e{x:.0}")
    } else {
        String::new()
    }
}
