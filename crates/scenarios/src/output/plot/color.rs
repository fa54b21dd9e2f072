//! Colours of values, and the bar that explains them.

use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

use super::scale::Scale;
use super::style::{Area, Drawn, FINE, INK, font, ipx};

/// Perceptually even colours from dark violet to yellow.
const MAP: [(u8, u8, u8); 10] = [
    (68, 1, 84),
    (72, 40, 120),
    (62, 73, 137),
    (49, 104, 142),
    (38, 130, 142),
    (31, 158, 137),
    (53, 183, 121),
    (110, 206, 88),
    (181, 222, 43),
    (253, 231, 37),
];

/// Bands of the bar: as many colours as a picture can show.
const BANDS: i32 = 100;

/// The colour of the band that a value is in.
pub(super) fn color(scale: &Scale, value: f64) -> RGBColor {
    let bands = f64::from(BANDS);
    let part = ((value - scale.low) / (scale.high - scale.low)).clamp(0.0, 1.0);
    let band = (part * bands).floor().min(bands - 1.0);
    let s = (band + 0.5) / bands * (MAP.len() - 1) as f64;
    let i = (s as usize).min(MAP.len() - 2);
    let w = s - i as f64;
    let mix = |a: u8, b: u8| (f64::from(a) + w * (f64::from(b) - f64::from(a))).round() as u8;
    let (a, b) = (MAP[i], MAP[i + 1]);
    RGBColor(mix(a.0, b.0), mix(a.1, b.1), mix(a.2, b.2))
}

/// A bar with its upper left corner at `corner` and `height` in shown pixels; `title` ends at `right`.
pub(super) fn draw_bar(
    root: &Area<'_>,
    scale: &Scale,
    title: String,
    corner: [u32; 2],
    height: u32,
    right: u32,
) -> Drawn {
    let (left, width, top, height) = (ipx(corner[0]), ipx(20), ipx(corner[1]), ipx(height));
    let place = |value: f64| {
        let s = (value - scale.low) / (scale.high - scale.low);
        top + height - (s * f64::from(height)).round() as i32
    };
    let style = font(12).pos(Pos::new(HPos::Right, VPos::Top));
    root.draw(&Text::new(title, (ipx(right), top - ipx(30)), style))?;
    for i in 0..BANDS {
        let value = |i: i32| scale.low + (scale.high - scale.low) * f64::from(i) / f64::from(BANDS);
        let color = color(scale, 0.5 * (value(i) + value(i + 1)));
        let corners = [
            (left, place(value(i + 1))),
            (left + width, place(value(i)) + 1),
        ];
        root.draw(&Rectangle::new(corners, color.filled()))?;
    }
    root.draw(&Rectangle::new(
        [(left, top), (left + width, top + height)],
        INK.stroke_width(FINE / 2),
    ))?;
    for tick in scale.ticks() {
        let y = place(tick);
        root.draw(&PathElement::new(
            vec![(left + width, y), (left + width + ipx(5), y)],
            INK.stroke_width(FINE),
        ))?;
        root.draw(&Text::new(
            scale.tick(tick),
            (left + width + ipx(10), y - ipx(6)),
            font(12),
        ))?;
    }
    Ok(())
}
