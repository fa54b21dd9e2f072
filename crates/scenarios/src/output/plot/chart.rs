//! Curves over an axis, one chart or several in a grid.

use plotters::coord::types::RangedCoordf64;
use plotters::prelude::*;

use super::picture::picture;
use super::scale::Scale;
use super::style::{Area, COLORS, Drawn, FINE, GRID, INK, font, ipx, px};

/// Width and height of a chart of a grid, and its legend's column, in shown pixels.
const PANEL: [u32; 2] = [600, 370];
const PANEL_LEGEND: u32 = 120;

/// What is along an axis.
#[derive(Clone, Debug, PartialEq)]
pub struct Axis {
    /// Name of the quantity.
    pub quantity: String,
    /// Its unit, `-` without.
    pub unit: String,
    /// Powers of ten; values that are not positive are left out.
    pub logarithmic: bool,
}

impl Axis {
    /// An axis with equal steps.
    pub fn linear(quantity: &str, unit: &str) -> Axis {
        Axis {
            quantity: quantity.to_owned(),
            unit: unit.to_owned(),
            logarithmic: false,
        }
    }

    /// An axis of powers of ten.
    pub fn logarithmic(quantity: &str, unit: &str) -> Axis {
        Axis {
            logarithmic: true,
            ..Axis::linear(quantity, unit)
        }
    }

    fn place(&self, value: f64) -> f64 {
        if self.logarithmic {
            value.log10()
        } else {
            value
        }
    }

    fn scale(&self, values: impl Iterator<Item = f64>, wanted: usize, whole_steps: bool) -> Scale {
        if self.logarithmic {
            Scale::powers(values)
        } else {
            Scale::around(values, wanted, whole_steps)
        }
    }
}

/// How a line looks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Pen {
    /// In the next colour.
    Next,
    /// In the colour of this number.
    Color(usize),
    /// Black, for sums.
    Ink,
    /// Thin and grey beside the data: a bound, a limit.
    Mark,
}

/// A line of a chart.
#[derive(Clone, Debug, PartialEq)]
pub struct Curve {
    /// Name in the legend; without a name it has no place there.
    pub name: String,
    /// How it looks.
    pub pen: Pen,
    /// From left to right.
    pub points: Vec<(f64, f64)>,
}

impl Curve {
    /// A line through `(x, y)`; pairs that are not numbers are left out.
    pub fn new(name: impl Into<String>, x: &[f64], y: &[f64]) -> Curve {
        let points = x.iter().copied().zip(y.iter().copied());
        Curve {
            name: name.into(),
            pen: Pen::Next,
            points: points
                .filter(|(x, y)| x.is_finite() && y.is_finite())
                .collect(),
        }
    }

    /// A thin grey line from a point to a point.
    pub fn mark(name: &str, from: (f64, f64), to: (f64, f64)) -> Curve {
        Curve {
            name: name.to_owned(),
            pen: Pen::Mark,
            points: vec![from, to],
        }
    }
}

/// A shaded range of the horizontal axis.
#[derive(Clone, Debug, PartialEq)]
pub struct Band {
    /// Name, written at its top.
    pub name: String,
    /// Where it begins \[unit of the axis\].
    pub from: f64,
    /// Where it ends \[unit of the axis\].
    pub to: f64,
}

/// Curves with a title, axes and a legend.
#[derive(Clone, Debug, PartialEq)]
pub struct Chart {
    /// Heading.
    pub title: String,
    /// Horizontal axis.
    pub x: Axis,
    /// Vertical axis.
    pub y: Axis,
    /// Lines; those behind come first.
    pub curves: Vec<Curve>,
    /// Shades behind the lines.
    pub bands: Vec<Band>,
}

/// Charts in rows of `columns`.
///
/// # Errors
/// What the drawing library reports.
pub fn charts_svg(charts: &[Chart], columns: usize) -> Result<String, String> {
    let columns = columns.clamp(1, charts.len().max(1));
    let rows = charts.len().div_ceil(columns).max(1);
    let size = [PANEL[0] * columns as u32, PANEL[1] * rows as u32];
    picture(size, &[], |root| {
        let areas = root.split_evenly((rows, columns));
        for (area, chart) in areas.iter().zip(charts) {
            chart.draw(area, PANEL[0], PANEL_LEGEND)?;
        }
        Ok(())
    })
}

const SHADES: [RGBColor; 3] = [
    RGBColor(226, 243, 220),
    RGBColor(219, 242, 246),
    RGBColor(245, 240, 226),
];

impl Chart {
    /// Curves without shades behind them.
    pub fn new(title: &str, x: Axis, y: Axis, curves: Vec<Curve>) -> Chart {
        Chart {
            title: title.to_owned(),
            x,
            y,
            curves,
            bands: Vec::new(),
        }
    }

    /// Draws into an area of a width, with a column for the legend, both in shown pixels.
    pub(super) fn draw(&self, area: &Area<'_>, width: u32, legend: u32) -> Drawn {
        let curves: Vec<Curve> = self.curves.iter().map(|c| self.placed(c)).collect();
        let styles = styles(&curves);
        let all = || curves.iter().flat_map(|curve| &curve.points);
        let x = self.x.scale(all().map(|p| p.0), 8, false);
        let y = self.y.scale(all().map(|p| p.1), 7, true);
        let (left, right) = area.split_horizontally(px(width - legend));
        let corner = (ipx(72), ipx(14));
        left.draw(&Text::new(self.title.clone(), corner, font(16)))?;
        let mut context = ChartBuilder::on(&left)
            .margin_top(px(44))
            .margin_right(px(14))
            .margin_bottom(px(10))
            .margin_left(px(10))
            .set_label_area_size(LabelAreaPosition::Left, px(62))
            .set_label_area_size(LabelAreaPosition::Bottom, px(46))
            .build_cartesian_2d(x.low..x.high, y.low..y.high)?;
        self.draw_bands(&mut context, &x, &y)?;
        context
            .configure_mesh()
            .disable_mesh()
            .x_labels(x.count())
            .y_labels(y.count())
            .x_label_formatter(&|v| x.tick(*v))
            .y_label_formatter(&|v| y.tick(*v))
            .x_desc(x.label(&self.x.quantity, &self.x.unit))
            .y_desc(y.label(&self.y.quantity, &self.y.unit))
            .label_style(font(12))
            .axis_desc_style(font(13))
            .set_all_tick_mark_size(px(5))
            .axis_style(INK.stroke_width(FINE))
            .draw()?;
        self.draw_grid(&mut context, &x, &y)?;
        for (curve, style) in curves.iter().zip(&styles) {
            context.draw_series(LineSeries::new(curve.points.iter().copied(), *style))?;
        }
        draw_legend(&right, &curves, &styles)
    }

    fn draw_bands(&self, context: &mut Context<'_>, x: &Scale, y: &Scale) -> Drawn {
        for (band, shade) in self.bands.iter().zip(SHADES) {
            let ends = [band.from, band.to].map(|end| self.x.place(end).clamp(x.low, x.high));
            if ends[0] >= ends[1] {
                continue;
            }
            let corners = [(ends[0], y.low), (ends[1], y.high)];
            context.draw_series([Rectangle::new(corners, shade.filled())])?;
            let (right, down) = (0.01 * (x.high - x.low), 0.02 * (y.high - y.low));
            let at = (ends[0] + right, y.high - down);
            context.draw_series([Text::new(band.name.clone(), at, font(11))])?;
        }
        Ok(())
    }

    fn draw_grid(&self, context: &mut Context<'_>, x: &Scale, y: &Scale) -> Drawn {
        for tick in x.ticks() {
            let line = [(tick, y.low), (tick, y.high)];
            context.draw_series(LineSeries::new(line, GRID.stroke_width(FINE)))?;
        }
        for tick in y.ticks() {
            let zero = tick == 0.0 && !self.y.logarithmic;
            let color = if zero { RGBColor(150, 156, 166) } else { GRID };
            let line = [(x.low, tick), (x.high, tick)];
            context.draw_series(LineSeries::new(line, color.stroke_width(FINE)))?;
        }
        Ok(())
    }

    /// The curve in the coordinates that are drawn.
    fn placed(&self, curve: &Curve) -> Curve {
        let place = |(x, y): &(f64, f64)| (self.x.place(*x), self.y.place(*y));
        let points = curve.points.iter().map(place);
        Curve {
            points: points
                .filter(|(x, y)| x.is_finite() && y.is_finite())
                .collect(),
            ..curve.clone()
        }
    }
}

type Context<'a> = ChartContext<'a, SVGBackend<'a>, Cartesian2d<RangedCoordf64, RangedCoordf64>>;

fn draw_legend(area: &Area<'_>, curves: &[Curve], styles: &[ShapeStyle]) -> Drawn {
    let named = curves
        .iter()
        .zip(styles)
        .filter(|(c, _)| !c.name.is_empty());
    for (i, (curve, style)) in named.enumerate() {
        let row = ipx(58 + 22 * i as u32);
        let line = vec![(ipx(4), row), (ipx(28), row)];
        area.draw(&PathElement::new(line, *style))?;
        let at = (ipx(36), row - ipx(6));
        area.draw(&Text::new(curve.name.clone(), at, font(12)))?;
    }
    Ok(())
}

fn styles(curves: &[Curve]) -> Vec<ShapeStyle> {
    let mut colors = COLORS.into_iter().cycle();
    let style = |curve: &Curve| match curve.pen {
        Pen::Next => colors.next().unwrap_or(INK).stroke_width(2 * FINE),
        Pen::Color(number) => COLORS[number % COLORS.len()].stroke_width(2 * FINE),
        Pen::Ink => INK.stroke_width(2 * FINE),
        Pen::Mark => RGBColor(120, 126, 136).stroke_width(FINE),
    };
    curves.iter().map(style).collect()
}
