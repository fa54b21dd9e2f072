//! Patches as an image inside a drawing.

use std::collections::BTreeMap;

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use color_quant::NeuQuant;
use plotters::prelude::*;

use super::patches::{Patch, draw_patches};

/// Drawn pixels of the picture per pixel of the image, along each direction: two of the image are a shown pixel, so
/// that it is sharp on fine screens, and edges are the mean of four drawn pixels.
const COARSE: usize = 2;
/// Bytes up to which an image keeps all its colours: 180 kB as text in the drawing.
const LIGHT: usize = 135_000;
/// Colours of the palette, as many as a byte counts.
const COLORS: usize = 256;
/// Every so many pixels is looked at for the palette; the library says 1 for the best, 30 for the fastest.
const SAMPLE: i32 = 10;

type Rgb = [u8; 3];

/// The patches as an element of a drawing of this size in drawn pixels.
///
/// # Errors
/// What the drawing and the image library report.
pub(super) fn image(patches: &[Patch], [width, height]: [u32; 2]) -> Result<String, String> {
    let mut drawn = vec![u8::MAX; 3 * (width * height) as usize];
    {
        let root = BitMapBackend::with_buffer(&mut drawn, (width, height)).into_drawing_area();
        draw_patches(&root, patches).map_err(|e| e.to_string())?;
        root.present().map_err(|e| e.to_string())?;
    }
    let [left, top, right, bottom] = bounds(patches, [width, height]);
    let mut pixels = Vec::new();
    for y in (top..bottom).step_by(COARSE) {
        let columns = (left..right).step_by(COARSE);
        pixels.extend(columns.map(|x| mean(&drawn, width as usize, [x, y])));
    }
    let (wide, high) = (right - left, bottom - top);
    let png = encode(&pixels, [wide / COARSE, high / COARSE])?;
    Ok(format!(
        "<image x=\"{left}\" y=\"{top}\" width=\"{wide}\" height=\"{high}\" preserveAspectRatio=\"none\" \
         href=\"data:image/png;base64,{}\"/>",
        STANDARD.encode(png)
    ))
}

/// Left, top, right and bottom of all patches with a margin for their rims, in whole pixels of the image.
fn bounds(patches: &[Patch], [width, height]: [u32; 2]) -> [usize; 4] {
    let margin = 4 * COARSE as i32;
    let corners = || patches.iter().flat_map(|patch| &patch.outline);
    let low =
        |at: Option<i32>| at.unwrap_or(0).saturating_sub(margin).max(0) as usize / COARSE * COARSE;
    let high = |at: Option<i32>, most: u32| {
        let end = at.unwrap_or(0).saturating_add(margin).max(0) as usize;
        end.div_ceil(COARSE).min(most as usize / COARSE) * COARSE
    };
    [
        low(corners().map(|p| p.0).min()),
        low(corners().map(|p| p.1).min()),
        high(corners().map(|p| p.0).max(), width),
        high(corners().map(|p| p.1).max(), height),
    ]
}

/// Mean of the square of drawn pixels with this upper left corner.
fn mean(drawn: &[u8], width: usize, [x, y]: [usize; 2]) -> Rgb {
    [0, 1, 2].map(|channel| {
        let mut sum = 0;
        for j in y..y + COARSE {
            for i in x..x + COARSE {
                sum += usize::from(drawn[3 * (j * width + i) + channel]);
            }
        }
        ((sum + COARSE * COARSE / 2) / (COARSE * COARSE)) as u8
    })
}

/// A PNG of all colours if it is light enough, else one with a palette.
fn encode(pixels: &[Rgb], size: [usize; 2]) -> Result<Vec<u8>, String> {
    let png = compressed(size, pixels.as_flattened(), None)?;
    if png.len() <= LIGHT {
        return Ok(png);
    }
    let mut indices: BTreeMap<Rgb, u8> = pixels.iter().map(|color| (*color, 0)).collect();
    let palette = palette(pixels, &mut indices);
    let data: Vec<u8> = pixels.iter().map(|color| indices[color]).collect();
    compressed(size, &data, Some(palette))
}

/// A PNG of bytes that are colours, or places in a palette.
fn compressed(
    [width, height]: [usize; 2],
    data: &[u8],
    palette: Option<Vec<u8>>,
) -> Result<Vec<u8>, String> {
    let mut png = Vec::new();
    let mut encoder = png::Encoder::new(&mut png, width as u32, height as u32);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_compression(png::Compression::High);
    if let Some(palette) = palette {
        encoder.set_color(png::ColorType::Indexed);
        encoder.set_palette(palette);
        encoder.set_filter(png::Filter::NoFilter);
    } else {
        encoder.set_color(png::ColorType::Rgb);
    }
    let mut writer = encoder.write_header().map_err(|e| e.to_string())?;
    writer.write_image_data(data).map_err(|e| e.to_string())?;
    writer.finish().map_err(|e| e.to_string())?;
    Ok(png)
}

/// The colours of the palette one after the other; `indices` receives the place of each colour of the picture.
fn palette(pixels: &[Rgb], indices: &mut BTreeMap<Rgb, u8>) -> Vec<u8> {
    if indices.len() <= COLORS {
        let places = indices.values_mut().zip(0..=u8::MAX);
        places.for_each(|(index, place)| *index = place);
        return indices.keys().flatten().copied().collect();
    }
    let opaque = |[r, g, b]: Rgb| [r, g, b, u8::MAX];
    let samples: Vec<u8> = pixels.iter().flat_map(|color| opaque(*color)).collect();
    let quantizer = NeuQuant::new(SAMPLE, COLORS, &samples);
    for (color, index) in indices.iter_mut() {
        *index = quantizer.index_of(&opaque(*color)) as u8;
    }
    quantizer.color_map_rgb()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn patch(at: i32, fill: RGBColor) -> Patch {
        Patch {
            outline: vec![(at, 40), (at + 20, 40), (at + 20, 60), (at, 60)],
            fill,
            overlap: 0,
            rim: None,
        }
    }

    #[test]
    fn the_image_holds_the_colours_of_the_patches() {
        let patches = [
            patch(40, RGBColor(200, 10, 10)),
            patch(60, RGBColor(10, 10, 200)),
        ];
        let element = image(&patches, [200, 100]).unwrap();
        let (head, rest) = element.split_once("base64,").unwrap();
        assert_eq!(
            head,
            "<image x=\"32\" y=\"32\" width=\"56\" height=\"36\" preserveAspectRatio=\"none\" href=\"data:image/png;"
        );
        let data = STANDARD.decode(rest.trim_end_matches("\"/>")).unwrap();
        let mut reader = png::Decoder::new(std::io::Cursor::new(data))
            .read_info()
            .unwrap();
        assert_eq!((reader.info().width, reader.info().height), (28, 18));
        let mut bytes = vec![0; reader.output_buffer_size().unwrap()];
        reader.next_frame(&mut bytes).unwrap();
        let at = |x: usize, y: usize| [0, 1, 2].map(|k| bytes[3 * (28 * y + x) + k]);
        assert_eq!(at(0, 0), [255; 3]);
        assert_eq!(at(9, 9), [200, 10, 10]);
        assert_eq!(at(19, 9), [10, 10, 200]);
    }

    /// A palette made for the picture has to beat one made for no picture: six levels a channel, 51 apart (216
    /// colours), miss no colour by more than 25.5 in any channel.
    #[test]
    fn more_colours_than_a_palette_are_matched_better_than_by_a_fixed_one() {
        let pixels: Vec<Rgb> = (0..40_000_u32)
            .map(|i| [(i / 200) as u8, (i % 200) as u8, 90])
            .collect();
        let mut indices = pixels.iter().map(|color| (*color, 0)).collect();
        let colors = palette(&pixels, &mut indices);
        assert_eq!(colors.len(), 3 * COLORS);
        for (color, index) in indices {
            let found = &colors[3 * usize::from(index)..][..3];
            let apart = (0..3).map(|k| color[k].abs_diff(found[k])).max().unwrap();
            assert!(apart <= 25, "{color:?} {found:?}");
        }
    }

    #[test]
    fn few_colours_are_kept_as_they_are() {
        let pixels: Vec<Rgb> = (0..=u8::MAX).map(|i| [i, 255 - i, i / 2]).collect();
        let mut indices = pixels.iter().map(|color| (*color, 0)).collect();
        let colors = palette(&pixels, &mut indices);
        for (color, index) in indices {
            assert_eq!(colors[3 * usize::from(index)..][..3], color);
        }
    }
}
