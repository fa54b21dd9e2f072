//! The deformed bodies from a fixed point of view.

use std::collections::BTreeMap;

use nalgebra::Vector3;
use plotters::prelude::*;

use super::color::{color, draw_bar};
use super::patches::{Paint, Patch, shaded};
use super::picture::picture;
use super::scale::Scale;
use super::style::{Area, Drawn, FINE, INK, centred, font, ipx, px};
use crate::output::Frame;

const WIDTH: u32 = 900;
const HEIGHT: u32 = 680;
/// Column of the colour bar.
const BAR: u32 = 130;
/// Patches of colour of a picture; a face has up to 9, and one at least.
const PATCHES: f64 = 1200.0;
/// Largest number of patches along an edge of a face.
const PARTS: f64 = 3.0;
/// Directions from the bodies to the eye and to the lamp \[-\].
const EYE: Vector3<f64> = Vector3::new(1.0, -1.5, 0.85);
const LAMP: Vector3<f64> = Vector3::new(0.35, -0.55, 0.75);
/// Light of a face that looks away from the lamp; a full one has 1.
const AMBIENT: f64 = 0.74;
/// Colour of bodies without values.
const GREY: RGBColor = RGBColor(170, 180, 195);
/// Steps of light between dark and full: faces of one direction and value share a path.
const LIGHTS: f64 = 64.0;

/// Picture of the deformed surface, coloured by the cell field `von_mises` averaged to the nodes; grey when there
/// is none. Needs the point field `displacement` to deform anything.
///
/// # Errors
/// What the drawing library reports.
pub fn deformed_svg(title: &str, frame: &Frame<'_>) -> Result<String, String> {
    let plane = frame.cells.iter().all(|cells| cells.kind.dim() == 2);
    let view = View::new(plane);
    let stress = nodal_stress(frame);
    let faces = boundary(frame);
    let points = deformed_points(frame);
    let on_surface = faces
        .iter()
        .flatten()
        .filter_map(|node| stress.as_ref()?.get(*node).copied());
    let scale = Scale::around(on_surface, 6, true);
    let fit = Fit::new(&view, &points, &faces);
    let visible = visible_faces(&view, &points, &faces);
    let along = (PATCHES / visible.len().max(1) as f64).sqrt();
    let parts = along.floor().clamp(1.0, PARTS) as usize;
    let scenery = Scenery {
        points: &points,
        view: &view,
        fit: &fit,
        stress: stress.as_deref(),
        scale: &scale,
        parts,
    };
    let mut patches: Vec<Patch> = visible
        .iter()
        .flat_map(|face| patches_of(face, &scenery))
        .collect();
    if plane {
        // No face hides another: those of one colour become one path.
        patches.sort_by_key(|patch| patch.paint.key());
    }
    let scale = stress.is_some().then_some(&scale);
    picture([WIDTH, HEIGHT], &patches, |root| {
        draw_legend(root, title, frame.time, scale)?;
        draw_axes(root, &view)
    })
}

/// Title, time, and the bar of the colours if there are any.
fn draw_legend(root: &Area<'_>, title: &str, time: f64, scale: Option<&Scale>) -> Drawn {
    root.draw(&Text::new(title.to_owned(), (ipx(28), ipx(16)), font(17)))?;
    let time = format!("t = {} s", short(time));
    root.draw(&Text::new(time, (ipx(28), ipx(42)), font(13)))?;
    if let Some(scale) = scale {
        let title = scale.label("von Mises", "Pa");
        draw_bar(root, scale, title, [WIDTH - BAR, 130], 400, WIDTH - 24)?;
    }
    Ok(())
}

fn short(value: f64) -> String {
    // Sums of steps carry round-off digits that say nothing.
    let text = format!("{value:.6e}").parse::<f64>().unwrap_or(value);
    if text != 0.0 && !(1e-3..1e6).contains(&text.abs()) {
        format!("{text:e}")
    } else {
        format!("{text}")
    }
}

fn deformed_points(frame: &Frame<'_>) -> Vec<Vector3<f64>> {
    let displacement = frame.point_vector("displacement");
    let moved = |(i, x): (usize, &Vector3<f64>)| {
        let u = displacement
            .and_then(|u| u.get(3 * i..3 * i + 3))
            .unwrap_or(&[0.0; 3]);
        x + Vector3::from_column_slice(u)
    };
    frame.points.iter().enumerate().map(moved).collect()
}

/// Mean of the cells around each node.
fn nodal_stress(frame: &Frame<'_>) -> Option<Vec<f64>> {
    let cell_values = frame.cell_scalar("von_mises")?;
    let mut sums = vec![(0.0, 0_usize); frame.points.len()];
    let mut values = cell_values.iter();
    for cells in &frame.cells {
        for nodes in cells.connectivity.chunks_exact(cells.kind.node_count()) {
            let value = values.next()?;
            for node in nodes {
                let (sum, count) = &mut sums[*node as usize];
                *sum += value;
                *count += 1;
            }
        }
    }
    Some(
        sums.into_iter()
            .map(|(sum, count)| if count > 0 { sum / count as f64 } else { 0.0 })
            .collect(),
    )
}

/// Faces that belong to one cell only, as nodes in order, outward.
fn boundary(frame: &Frame<'_>) -> Vec<Vec<usize>> {
    let mut faces: BTreeMap<Vec<usize>, Option<Vec<usize>>> = BTreeMap::new();
    for cells in &frame.cells {
        let of_a_cell = cells.faces();
        for nodes in cells.connectivity.chunks_exact(cells.kind.node_count()) {
            for local in &of_a_cell {
                let face: Vec<usize> = local.iter().map(|i| nodes[*i] as usize).collect();
                let mut key = face.clone();
                key.sort_unstable();
                faces
                    .entry(key)
                    .and_modify(|seen| *seen = None)
                    .or_insert(Some(face));
            }
        }
    }
    faces.into_values().flatten().collect()
}

/// Directions of the picture: right, up, towards the eye.
struct View {
    axes: [Vector3<f64>; 3],
    plane: bool,
}

impl View {
    fn new(plane: bool) -> View {
        if plane {
            return View {
                axes: [Vector3::x(), Vector3::y(), Vector3::z()],
                plane,
            };
        }
        let eye = EYE.normalize();
        let right = Vector3::z().cross(&eye).normalize();
        View {
            axes: [right, eye.cross(&right), eye],
            plane,
        }
    }

    fn project(&self, x: &Vector3<f64>) -> Vector3<f64> {
        Vector3::from(self.axes.map(|axis| axis.dot(x)))
    }
}

/// From the view plane to pixels.
struct Fit {
    scale: f64,
    center: [f64; 2],
    /// Height of the middle of the bodies in shown pixels.
    middle: u32,
}

impl Fit {
    fn new(view: &View, points: &[Vector3<f64>], faces: &[Vec<usize>]) -> Fit {
        let mut low = [f64::INFINITY; 2];
        let mut high = [f64::NEG_INFINITY; 2];
        for node in faces.iter().flatten() {
            let p = view.project(&points[*node]);
            for k in 0..2 {
                low[k] = low[k].min(p[k]);
                high[k] = high[k].max(p[k]);
            }
        }
        // A plane picture may fill its corners: it stays above the directions.
        let below = if view.plane { 80 } else { 0 };
        let room = [
            f64::from(px(WIDTH - BAR - 90)),
            f64::from(px(HEIGHT - 150 - below)),
        ];
        let stretch = (0..2)
            .map(|k| room[k] / (high[k] - low[k]))
            .filter(|s| s.is_finite() && *s > 0.0);
        let scale = stretch.fold(f64::INFINITY, f64::min);
        Fit {
            scale: if scale.is_finite() { scale } else { 1.0 },
            center: [0, 1].map(|k| {
                if low[k] <= high[k] {
                    0.5 * (low[k] + high[k])
                } else {
                    0.0
                }
            }),
            middle: (HEIGHT + 40 - below) / 2,
        }
    }

    fn pixel(&self, p: Vector3<f64>) -> (i32, i32) {
        let x = f64::from(px(WIDTH - BAR)) / 2.0 + self.scale * (p[0] - self.center[0]);
        let y = f64::from(px(self.middle)) - self.scale * (p[1] - self.center[1]);
        (x.round() as i32, y.round() as i32)
    }
}

/// A face that shows its outside, and how much light it gets.
struct Visible<'a> {
    nodes: &'a [usize],
    depth: f64,
    light: f64,
}

/// From back to front.
fn visible_faces<'a>(
    view: &View,
    points: &[Vector3<f64>],
    faces: &'a [Vec<usize>],
) -> Vec<Visible<'a>> {
    let lamp = LAMP.normalize();
    let mut visible = Vec::new();
    for nodes in faces {
        let corners: Vec<Vector3<f64>> = nodes.iter().map(|node| points[*node]).collect();
        let last = corners.len() - 1;
        let across = (corners[2] - corners[0]).cross(&(corners[last] - corners[1]));
        let normal = across.try_normalize(0.0).unwrap_or_default();
        if !view.plane && normal.dot(&view.axes[2]) <= 0.0 {
            continue;
        }
        let depth =
            corners.iter().map(|c| c.dot(&view.axes[2])).sum::<f64>() / corners.len() as f64;
        let light = if view.plane {
            1.0
        } else {
            let light = AMBIENT + (1.0 - AMBIENT) * normal.dot(&lamp).max(0.0);
            (light * LIGHTS).round() / LIGHTS
        };
        visible.push(Visible {
            nodes,
            depth,
            light,
        });
    }
    visible.sort_by(|a, b| a.depth.total_cmp(&b.depth));
    visible
}

/// What every face of a picture needs.
struct Scenery<'a> {
    points: &'a [Vector3<f64>],
    view: &'a View,
    fit: &'a Fit,
    stress: Option<&'a [f64]>,
    scale: &'a Scale,
    /// Patches along each edge of a face.
    parts: usize,
}

impl Scenery<'_> {
    /// Pixel and value at the place `s`, `t` of a face, each from 0 to 1.
    fn at(&self, face: &Visible<'_>, s: f64, t: f64) -> ((i32, i32), f64) {
        let weights = [(1.0 - s) * (1.0 - t), s * (1.0 - t), s * t, (1.0 - s) * t];
        let mut place = Vector3::zeros();
        let mut value = 0.0;
        for (i, w) in weights.into_iter().enumerate() {
            // A triangle is a quadrilateral whose last corner stands twice.
            let node = face.nodes[i.min(face.nodes.len() - 1)];
            place += w * self.view.project(&self.points[node]);
            value += w * self.stress.map_or(0.0, |stress| stress[node]);
        }
        (self.fit.pixel(place), value)
    }

    /// Colour of a part of a face with the mean value `mean`.
    fn color(&self, face: &Visible<'_>, mean: f64) -> RGBColor {
        let base = match self.stress {
            Some(_) => color(self.scale, mean),
            None => GREY,
        };
        shaded(base, face.light)
    }
}

/// The parts of a face, and the rim of all where there are several.
fn patches_of(face: &Visible<'_>, scenery: &Scenery<'_>) -> Vec<Patch> {
    let parts = scenery.parts;
    let step = 1.0 / parts as f64;
    let mut patches = Vec::with_capacity(parts * parts);
    for i in 0..parts {
        for j in 0..parts {
            let (s, t) = (i as f64 * step, j as f64 * step);
            let corners = [(s, t), (s + step, t), (s + step, t + step), (s, t + step)];
            let corners = corners.map(|(s, t)| scenery.at(face, s, t));
            let mean = corners.iter().map(|(_, value)| value).sum::<f64>() / 4.0;
            let color = scenery.color(face, mean);
            patches.push(Patch {
                outline: corners.iter().map(|(pixel, _)| *pixel).collect(),
                paint: if parts == 1 {
                    Paint::Face(color)
                } else {
                    Paint::Fill(color)
                },
            });
        }
    }
    if parts > 1 {
        let (view, fit) = (scenery.view, scenery.fit);
        let corners = face.nodes.iter().map(|node| scenery.points[*node]);
        patches.push(Patch {
            outline: corners.map(|x| fit.pixel(view.project(&x))).collect(),
            paint: Paint::Rim,
        });
    }
    patches
}

/// Directions of x, y, z in the lower left corner.
fn draw_axes(root: &Area<'_>, view: &View) -> Drawn {
    let origin = (ipx(60), ipx(HEIGHT - 52));
    for (k, name) in ["x", "y", "z"].into_iter().enumerate() {
        let p = view.project(&Vector3::ith(k, 1.0));
        let length = p[0].hypot(p[1]);
        if length < 1e-6 {
            continue;
        }
        let end = |r: f64| {
            let reach = r * f64::from(FINE);
            (
                origin.0 + (reach * p[0]).round() as i32,
                origin.1 - (reach * p[1]).round() as i32,
            )
        };
        root.draw(&PathElement::new(
            vec![origin, end(34.0)],
            INK.stroke_width(FINE + FINE / 2),
        ))?;
        root.draw(&Text::new(
            name.to_owned(),
            end(34.0 + 11.0 / length),
            centred(12),
        ))?;
    }
    Ok(())
}
