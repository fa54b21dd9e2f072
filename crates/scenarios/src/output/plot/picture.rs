//! A whole picture: ground, patches, and what is drawn above them.

use plotters::prelude::*;

use super::patches::{Patch, paths};
use super::style::{Area, Drawn, px};

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
    use super::super::style::{font, ipx};
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
