//! A quantity on a flat surface, in a grid of frames with one scale of colours.

use plotters::prelude::*;

use super::color::{color, draw_bar};
use super::patches::{Paint, Patch};
use super::picture::picture;
use super::scale::Scale;
use super::style::{Area, Drawn, centred, font, ipx};

/// Least and largest side of a frame, width of all frames where that allows; column of the names of the rows, heading
/// with the names of the columns, column of the bar; shown pixels.
const SIDE: [u32; 2] = [132, 300];
const ROW: u32 = 1080;
const NAMES: u32 = 92;
const HEADING: u32 = 64;
const BAR: u32 = 130;

/// One surface.
#[derive(Clone, Debug, PartialEq)]
pub struct MapFrame {
    /// Places of the nodes \[m\], to the right and up.
    pub points: Vec<[f64; 2]>,
    /// A value a node; nodes without a number make white facets.
    pub values: Vec<f64>,
}

/// Frames in rows and columns.
#[derive(Clone, Debug, PartialEq)]
pub struct Maps {
    /// Heading.
    pub title: String,
    /// Name of the quantity.
    pub quantity: String,
    /// Its unit.
    pub unit: String,
    /// Nodes of each facet in order around it, the same for all frames.
    pub facets: Vec<Vec<usize>>,
    /// Names of the columns.
    pub columns: Vec<String>,
    /// Names of the rows with their frames.
    pub rows: Vec<(String, Vec<MapFrame>)>,
}

/// Picture of all frames at one scale of length and one of colours, which begins at zero for values of one sign.
///
/// # Errors
/// What the drawing library reports.
pub fn maps_svg(maps: &Maps) -> Result<String, String> {
    let columns = maps.columns.len() as u32;
    let rows = maps.rows.len() as u32;
    let side = (ROW / columns.max(1)).clamp(SIDE[0], SIDE[1]);
    // The bar needs its ticks apart.
    let height = HEADING + (side * rows).max(150) + 16;
    let size = [NAMES + side * columns + BAR, height];
    let frames = || maps.rows.iter().flat_map(|row| &row.1);
    let values = frames().flat_map(|frame| frame.values.iter().copied());
    let scale = Scale::around(values.chain([0.0]), 6, true);
    let fit = Fit::around(side, frames().flat_map(|frame| &frame.points));
    let mut all = Vec::new();
    for (i, (_, row)) in maps.rows.iter().enumerate() {
        for (k, frame) in row.iter().enumerate() {
            let fit = fit.at(center(side, i, k));
            all.extend(
                maps.facets
                    .iter()
                    .filter_map(|facet| patch(facet, frame, &scale, &fit)),
            );
        }
    }
    // Facets of a surface do not hide each other: those of one colour become one path.
    all.sort_by_key(|patch| patch.paint.key());
    picture(size, &all, |root| draw(root, maps, side, size, &scale))
}

/// Middle of the frame in row `i` and column `k`, in drawn pixels.
fn center(side: u32, i: usize, k: usize) -> [i32; 2] {
    [
        NAMES + side * k as u32 + side / 2,
        HEADING + side * i as u32 + side / 2,
    ]
    .map(ipx)
}

/// All that is not a frame.
fn draw(root: &Area<'_>, maps: &Maps, side: u32, size: [u32; 2], scale: &Scale) -> Drawn {
    root.draw(&Text::new(maps.title.clone(), (ipx(16), ipx(12)), font(16)))?;
    for (k, name) in maps.columns.iter().enumerate() {
        let at = (ipx(NAMES + side * k as u32 + side / 2), ipx(HEADING - 14));
        root.draw(&Text::new(name.clone(), at, centred(12)))?;
    }
    for (i, (name, _)) in maps.rows.iter().enumerate() {
        let at = (ipx(NAMES / 2), center(side, i, 0)[1]);
        root.draw(&Text::new(name.clone(), at, centred(12)))?;
    }
    let title = scale.label(&maps.quantity, &maps.unit);
    let corner = [size[0] - BAR + 20, HEADING + 22];
    draw_bar(
        root,
        scale,
        title,
        corner,
        size[1] - HEADING - 56,
        size[0] - 12,
    )
}

/// A facet in the colour of its mean; none without a number.
fn patch(facet: &[usize], frame: &MapFrame, scale: &Scale, fit: &Fit) -> Option<Patch> {
    let corners = facet.iter().filter_map(|&node| {
        let (point, value) = (frame.points.get(node)?, frame.values.get(node)?);
        Some((fit.pixel(point), *value))
    });
    let corners: Vec<([f64; 2], f64)> = corners.collect();
    let count = corners.len() as f64;
    let mean = corners.iter().map(|(_, value)| value).sum::<f64>() / count;
    if !mean.is_finite() {
        return None;
    }
    let outline = corners
        .iter()
        .map(|(p, _)| (p[0].round() as i32, p[1].round() as i32));
    Some(Patch {
        outline: outline.collect(),
        paint: Paint::Fill(color(scale, mean)),
    })
}

/// From places to pixels.
#[derive(Clone, Copy, Debug)]
struct Fit {
    scale: f64,
    middle: [f64; 2],
    center: [i32; 2],
}

impl Fit {
    /// All places fit into a frame, with a margin.
    fn around<'a>(shown: u32, points: impl Iterator<Item = &'a [f64; 2]>) -> Fit {
        let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
        for point in points {
            for k in 0..2 {
                low[k] = low[k].min(point[k]);
                high[k] = high[k].max(point[k]);
            }
        }
        let side = (high[0] - low[0]).max(high[1] - low[1]);
        let room = 0.92 * f64::from(ipx(shown));
        Fit {
            scale: if side > 0.0 && side.is_finite() {
                room / side
            } else {
                1.0
            },
            middle: [0, 1].map(|k| {
                if side.is_finite() {
                    0.5 * (low[k] + high[k])
                } else {
                    0.0
                }
            }),
            center: [0; 2],
        }
    }

    fn at(self, center: [i32; 2]) -> Fit {
        Fit { center, ..self }
    }

    fn pixel(&self, point: &[f64; 2]) -> [f64; 2] {
        [
            f64::from(self.center[0]) + self.scale * (point[0] - self.middle[0]),
            f64::from(self.center[1]) - self.scale * (point[1] - self.middle[1]),
        ]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_facet_with_numbers_is_a_patch() {
        let points = vec![
            [0.0, 0.0],
            [1.0, 0.0],
            [1.0, 1.0],
            [0.0, 1.0],
            [2.0, 0.0],
            [2.0, 1.0],
        ];
        let frame = |last: f64| MapFrame {
            points: points.clone(),
            values: vec![0.0, 1.0, 2.0, 3.0, 4.0, last],
        };
        let maps = Maps {
            title: "Title".into(),
            quantity: "Force".into(),
            unit: "N".into(),
            facets: vec![vec![0, 1, 2, 3], vec![1, 4, 5, 2]],
            columns: vec!["t = 1".into(), "t = 2".into()],
            rows: vec![("row".into(), vec![frame(5.0), frame(f64::NAN)])],
        };
        let svg = maps_svg(&maps).unwrap();
        assert_eq!(svg.matches('M').count(), 3 + "<svg".matches('M').count());
        assert!(svg.contains("Force [N]"));
    }
}
