//! What all pictures have in common: size, ink, letters.

use plotters::coord::Shift;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

use super::patches::{Patch, draw_patches, weight};
use super::raster;

/// Outlines of patches up to which they are drawn one by one. One weighs 90 to 150 bytes, all of them 180 kB at most,
/// so that a picture with its texts stays below 200 kB.
const MOST_OUTLINES: usize = 1200;
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
    let image = if weight(patches) > MOST_OUTLINES {
        Some(raster::image(patches, [px(width), px(height)])?)
    } else {
        draw_patches(&root, patches).map_err(|e| e.to_string())?;
        None
    };
    draw(&root).map_err(|e| e.to_string())?;
    root.present().map_err(|e| e.to_string())?;
    drop(root);
    let svg = shown_size(&svg, width, height);
    Ok(match image {
        Some(image) => above_the_ground(&svg, &image),
        None => svg,
    })
}

/// The drawing with an element behind the white ground, which is its first rectangle.
fn above_the_ground(svg: &str, element: &str) -> String {
    let end = svg.find("<rect").and_then(|rect| {
        let close = svg[rect..].find('\n')?;
        Some(rect + close + 1)
    });
    let (ground, rest) = svg.split_at(end.unwrap_or(svg.len()));
    format!("{ground}{element}\n{rest}")
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
    use super::*;

    fn picture_of(facets: usize) -> String {
        let facet = |i: usize| {
            let (x, y) = ((i % 40) as i32 * 10, (i / 40) as i32 * 10);
            Patch {
                outline: vec![(x, y), (x + 10, y), (x + 10, y + 10), (x, y + 10)],
                fill: RGBColor((i % 251) as u8, (i / 251) as u8, 128),
                overlap: 0,
                rim: None,
            }
        };
        let patches: Vec<Patch> = (0..facets).map(facet).collect();
        picture([100, 110], &patches, |root| {
            root.draw(&Text::new("title", (ipx(5), ipx(5)), font(12)))?;
            Ok(())
        })
        .unwrap()
    }

    #[test]
    fn few_facets_are_outlines_and_many_are_an_image_between_the_ground_and_the_texts() {
        let few = picture_of(MOST_OUTLINES);
        assert_eq!(few.matches("<polygon").count(), MOST_OUTLINES);
        assert!(!few.contains("<image"));
        let many = picture_of(MOST_OUTLINES + 1);
        assert_eq!(many.matches("<polygon").count(), 0);
        let places =
            ["<svg", "<rect", "<image", "<text", "</svg>"].map(|tag| many.find(tag).unwrap());
        assert!(places.is_sorted(), "{places:?}");
        assert!(few.len().max(many.len()) <= 200_000);
    }
}
