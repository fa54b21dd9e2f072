//! What all pictures have in common: size, ink, letters.

use plotters::coord::Shift;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

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
