//! Performance profiles: which share of the problems is solved within a factor of the best.

use plotters::coord::Shift;
use plotters::prelude::*;

use super::Study;
use super::report::fastest;

const SIZE: (u32, u32) = (1100, 460);
pub(crate) const LEGEND: u32 = 210;
/// Largest factor shown, as a power of two.
const DOUBLINGS: f64 = 12.0;
/// Okabe and Ito's colours and two more, in the order of the methods.
pub(crate) const COLORS: [RGBColor; 9] = [
    RGBColor(0, 0, 0),
    RGBColor(213, 94, 0),
    RGBColor(0, 114, 178),
    RGBColor(0, 158, 115),
    RGBColor(86, 180, 233),
    RGBColor(204, 121, 167),
    RGBColor(230, 159, 0),
    RGBColor(148, 103, 60),
    RGBColor(120, 120, 120),
];

pub(crate) type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;
pub(crate) type Drawn = Result<(), Box<dyn std::error::Error>>;

pub(super) fn svg(studies: &[Study]) -> Result<String, String> {
    let mut text = String::new();
    draw(&mut text, studies).map_err(|e| format!("the profiles cannot be drawn: {e}"))?;
    Ok(text)
}

fn draw(text: &mut String, studies: &[Study]) -> Drawn {
    let root = SVGBackend::with_string(text, SIZE).into_drawing_area();
    root.fill(&WHITE)?;
    let (charts, legend) = root.split_horizontally(SIZE.0 - LEGEND);
    for (area, study) in charts.split_evenly((1, studies.len())).iter().zip(studies) {
        chart(area, study)?;
    }
    if let Some(study) = studies.first() {
        let names: Vec<&str> = study.methods.iter().map(|m| m.0).collect();
        key(&legend, &names)?;
    }
    root.present()?;
    Ok(())
}

/// The colours of the methods.
pub(crate) fn key(area: &Area<'_>, names: &[&str]) -> Drawn {
    for (k, name) in names.iter().enumerate() {
        let y = 60 + 24 * k as i32;
        let line = vec![(4, y), (28, y)];
        let color = COLORS[k % COLORS.len()];
        area.draw(&PathElement::new(line, color.stroke_width(3)))?;
        area.draw(&Text::new(*name, (36, y - 7), ("sans-serif", 15)))?;
    }
    Ok(())
}

fn chart(area: &Area<'_>, study: &Study) -> Drawn {
    let mut chart = ChartBuilder::on(area)
        .caption(format!("tolerance {}", study.tolerance), ("sans-serif", 18))
        .margin(12)
        .x_label_area_size(44)
        .y_label_area_size(52)
        .build_cartesian_2d(0.0..DOUBLINGS, 0.0..1.03)?;
    chart
        .configure_mesh()
        .light_line_style(TRANSPARENT)
        .bold_line_style(RGBColor(226, 229, 234))
        .x_labels(7)
        .y_labels(6)
        .x_label_formatter(&|x| format!("{:.0}", x.exp2()))
        .y_label_formatter(&|y| format!("{:.0} %", 100.0 * y))
        .x_desc("CPU time over that of the best method")
        .y_desc("problems solved")
        .label_style(("sans-serif", 13))
        .axis_desc_style(("sans-serif", 14))
        .draw()?;
    // The first method last, so that it lies on top.
    for (k, (_, solves)) in study.methods.iter().enumerate().rev() {
        let mut ratios: Vec<f64> = (0..solves.len())
            .filter(|i| solves[*i].solved())
            .map(|i| (solves[i].cpu() / fastest(study, i)).log2())
            .collect();
        ratios.sort_by(f64::total_cmp);
        let color = COLORS[k % COLORS.len()];
        chart.draw_series(LineSeries::new(
            steps(&ratios, solves.len()),
            color.stroke_width(2),
        ))?;
    }
    Ok(())
}

/// The distribution function of sorted values as a line of steps.
fn steps(sorted: &[f64], of: usize) -> Vec<(f64, f64)> {
    let share = |n: usize| n as f64 / of.max(1) as f64;
    let mut line = vec![(0.0, 0.0)];
    for (n, &x) in sorted.iter().enumerate() {
        let x = x.min(DOUBLINGS);
        line.push((x, share(n)));
        if x < DOUBLINGS {
            line.push((x, share(n + 1)));
        }
    }
    let within = sorted.iter().filter(|x| **x < DOUBLINGS).count();
    line.push((DOUBLINGS, share(within)));
    line
}
