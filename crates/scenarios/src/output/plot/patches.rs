//! Facets of meshes and maps: filled, with or without rims.

use plotters::coord::Shift;
use plotters::prelude::*;

/// One facet, or a part of one, in drawn pixels.
#[derive(Clone, Debug)]
pub(super) struct Patch {
    /// Corners in order around it.
    pub(super) outline: Vec<(i32, i32)>,
    pub(super) fill: RGBColor,
    /// Width of a rim in the colour of the filling, which closes the hairlines between neighbours; zero for none.
    pub(super) overlap: u32,
    /// Lines above it.
    pub(super) rim: Option<(Vec<(i32, i32)>, ShapeStyle)>,
}

/// Outlines that the patches are drawn with.
pub(super) fn weight(patches: &[Patch]) -> usize {
    let of = |patch: &Patch| 1 + usize::from(patch.overlap > 0) + usize::from(patch.rim.is_some());
    patches.iter().map(of).sum()
}

/// From back to front.
///
/// # Errors
/// What the drawing library reports.
pub(super) fn draw_patches<B: DrawingBackend>(
    root: &DrawingArea<B, Shift>,
    patches: &[Patch],
) -> Result<(), DrawingAreaErrorKind<B::ErrorType>> {
    for patch in patches {
        let mut outline = patch.outline.clone();
        root.draw(&Polygon::new(outline.clone(), patch.fill.filled()))?;
        if patch.overlap > 0 {
            outline.extend(patch.outline.first());
            root.draw(&PathElement::new(
                outline,
                patch.fill.stroke_width(patch.overlap),
            ))?;
        }
        if let Some((line, style)) = &patch.rim {
            root.draw(&PathElement::new(line.clone(), *style))?;
        }
    }
    Ok(())
}
