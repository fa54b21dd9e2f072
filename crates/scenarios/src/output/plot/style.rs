//! What all pictures have in common: size, ink, letters.

use plotters::coord::Shift;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

use super::patches::{Patch, paths};

/// Drawn pixels per shown pixel.
pub(super) const FINE: u32 = 4;
pub(super) const INK: RGBColor = RGBColor(40, 44, 52);
pub(super) const GRID: RGBColor = RGBColor(226, 229, 234);
/// Okabe and Ito's colours, which colour-blind people can tell apart.
pub(super) const COLORS: [RGBColor; 9] = [
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

pub(super) type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;
pub(super) type Drawn = Result<(), Box<dyn std::error::Error>>;

/// Size in drawn pixels of a size in shown pixels.
pub(super) fn px(shown: u32) -> u32 {
    shown * FINE
}

pub(super) fn ipx(shown: u32) -> i32 {
    (shown * FINE) as i32
}

pub(super) fn font(size: u32) -> TextStyle<'static> {
    // The backend divides font sizes by 1.24.
    ("sans-serif", f64::from(px(size)) * 1.24)
        .into_font()
        .color(&INK)
}

/// Letters around their place.
pub(super) fn centred(size: u32) -> TextStyle<'static> {
    font(size).pos(Pos::new(HPos::Center, VPos::Center))
}

/// A picture of `size` in shown pixels: white, then the patches, then what `draw` makes of it.
///
/// # Errors
/// What the drawing library reports.
pub(super) fn picture(
    size: [u32; 2],
    patches: &[Patch],
    draw: impl FnOnce(&Area<'_>) -> Drawn,
) -> Result<String, String> {
    let [width, height] = size;
    let mut svg = String::new();
    let root = SVGBackend::with_string(&mut svg, (px(width), px(height))).into_drawing_area();
    root.fill(&WHITE).map_err(|e| e.to_string())?;
    draw(&root).map_err(|e| e.to_string())?;
    root.present().map_err(|e| e.to_string())?;
    drop(root);
    let svg = shown_size(&svg, width, height);
    if patches.is_empty() {
        return Ok(svg);
    }
    Ok(above_the_ground(&svg, &paths(patches)))
}

/// The drawing with a group behind the white ground, which is its first rectangle.
fn above_the_ground(svg: &str, group: &str) -> String {
    let end = svg.find("<rect").and_then(|rect| {
        let close = svg[rect..].find('\n')?;
        Some(rect + close + 1)
    });
    let (ground, rest) = svg.split_at(end.unwrap_or(svg.len()));
    format!("{ground}{group}{rest}")
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

#[cfg(test)]
mod tests {
    use super::super::patches::Paint;
    use super::*;

    #[test]
    fn patches_stand_between_the_ground_and_the_texts_and_weigh_little() {
        let facet = |i: usize| {
            let (x, y) = ((i % 60) as i32 * 50, (i / 60) as i32 * 30);
            Patch {
                outline: vec![(x, y), (x + 50, y + 1), (x + 49, y + 30), (x, y + 29)],
                paint: Paint::Face(RGBColor((i % 251) as u8, 0, 128)),
            }
        };
        let mut patches: Vec<Patch> = (0..5000).map(facet).collect();
        patches.sort_by_key(|patch| patch.paint.key());
        let svg = picture([900, 700], &patches, |root| {
            root.draw(&Text::new("title", (ipx(5), ipx(5)), font(12)))?;
            Ok(())
        })
        .unwrap();
        let places =
            ["<svg", "<rect", "<path", "</g>", "<text", "</svg>"].map(|tag| svg.find(tag).unwrap());
        assert!(places.is_sorted(), "{places:?}");
        assert!(svg.len() <= 200_000, "{}", svg.len());
    }
}
