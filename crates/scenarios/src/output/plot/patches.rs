//! Facets of meshes and maps as short paths: a fifth of the weight of two elements each.

use std::fmt::Write;

use plotters::prelude::*;

use super::style::FINE;

/// A polygon in drawn pixels.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Patch {
    /// Corners in order around it.
    pub(super) outline: Vec<(i32, i32)>,
    pub(super) paint: Paint,
}

/// What patches of one path have in common.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Paint {
    /// Filled, with a rim of the same colour that closes the hairlines between neighbours.
    Fill(RGBColor),
    /// Filled, with a darker rim.
    Face(RGBColor),
    /// A line only, over what was filled before.
    Rim,
}

/// Light of a rim compared with its face.
const DARKER: f64 = 0.55;

impl Paint {
    /// Order in which patches that do not hide each other become few paths.
    pub(super) fn key(self) -> (bool, [u8; 3]) {
        match self {
            Paint::Fill(RGBColor(r, g, b)) | Paint::Face(RGBColor(r, g, b)) => (false, [r, g, b]),
            Paint::Rim => (true, [0; 3]),
        }
    }

    fn attributes(self) -> String {
        match self {
            Paint::Fill(color) => {
                let color = hex(color);
                format!("fill=\"{color}\" stroke=\"{color}\"")
            }
            Paint::Face(color) => {
                let (fill, rim) = (hex(color), hex(shaded(color, DARKER)));
                format!(
                    "fill=\"{fill}\" stroke=\"{rim}\" stroke-width=\"{}\"",
                    FINE / 2
                )
            }
            Paint::Rim => {
                format!(
                    "fill=\"none\" stroke=\"#000\" stroke-opacity=\".45\" stroke-width=\"{}\"",
                    FINE / 2
                )
            }
        }
    }
}

/// A colour in this much light.
pub(super) fn shaded(RGBColor(r, g, b): RGBColor, light: f64) -> RGBColor {
    let shade = |c: u8| (f64::from(c) * light).round().clamp(0.0, 255.0) as u8;
    RGBColor(shade(r), shade(g), shade(b))
}

fn hex(RGBColor(r, g, b): RGBColor) -> String {
    format!("#{r:02X}{g:02X}{b:02X}")
}

/// The patches as a group of paths, from back to front; neighbours in the list with one paint share a path.
pub(super) fn paths(patches: &[Patch]) -> String {
    let mut svg = format!("<g stroke-width=\"{FINE}\" stroke-linejoin=\"round\">\n");
    for run in patches.chunk_by(|a, b| a.paint == b.paint) {
        let outlines: String = run.iter().map(|patch| outline(&patch.outline)).collect();
        let paint = run[0].paint.attributes();
        // Writing to a string cannot fail.
        let _ = writeln!(svg, "<path {paint} d=\"{outlines}\"/>");
    }
    svg + "</g>\n"
}

/// A closed outline: the first corner, then the ways from corner to corner.
fn outline(corners: &[(i32, i32)]) -> String {
    let mut data = String::new();
    let mut last = None;
    for &(x, y) in corners {
        let (first, [dx, dy]) = match last {
            None => ("M", [x, y]),
            Some((from_x, from_y)) => ("", [x - from_x, y - from_y]),
        };
        if last.is_some() && !data.contains('l') {
            data.push('l');
        } else if last.is_some() && dx >= 0 {
            data.push(' ');
        }
        let gap = if dy < 0 { "" } else { " " };
        let _ = write!(data, "{first}{dx}{gap}{dy}");
        last = Some((x, y));
    }
    data + "z"
}

#[cfg(test)]
mod tests {
    use super::*;

    fn square(x: i32, y: i32, paint: Paint) -> Patch {
        Patch {
            outline: vec![(x, y), (x + 10, y), (x + 10, y - 10), (x, y - 10)],
            paint,
        }
    }

    #[test]
    fn an_outline_is_a_corner_and_ways() {
        assert_eq!(outline(&[(5, -3), (7, 4), (1, 2)]), "M5-3l2 7-6-2z");
    }

    #[test]
    fn neighbours_of_one_paint_share_a_path_and_the_order_stays() {
        let (red, blue) = (RGBColor(255, 0, 0), RGBColor(0, 0, 255));
        let patches = [
            square(0, 0, Paint::Fill(red)),
            square(10, 0, Paint::Fill(red)),
            square(20, 0, Paint::Face(blue)),
            square(30, 0, Paint::Fill(red)),
            square(0, 0, Paint::Rim),
        ];
        let svg = paths(&patches);
        let fills: Vec<&str> = svg
            .lines()
            .filter_map(|line| line.split('"').nth(1).filter(|_| line.starts_with("<path")))
            .collect();
        assert_eq!(fills, ["#FF0000", "#0000FF", "#FF0000", "none"]);
        assert_eq!(svg.matches('M').count(), patches.len());
    }
}
