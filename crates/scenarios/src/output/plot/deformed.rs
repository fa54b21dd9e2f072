//! The deformed bodies from a fixed point of view.

use std::collections::BTreeMap;

use nalgebra::Vector3;
use plotters::prelude::*;

use super::color::{color, draw_bar};
use super::scale::Scale;
use super::style::{Area, Drawn, FINE, INK, centred, font, ipx, picture, px};
use crate::output::Frame;

const WIDTH: u32 = 900;
const HEIGHT: u32 = 680;
/// Column of the colour bar.
const BAR: u32 = 130;
/// Patches of colour of a picture; a face has up to 9, and one at least.
const PATCHES: f64 = 1200.0;
/// Largest number of patches along an edge of a face.
const PARTS: f64 = 3.0;

/// Picture of the deformed surface, coloured by the cell field `von_mises` averaged to the nodes; grey when there
/// is none. Needs the point field `displacement` to deform anything.
///
/// # Errors
/// What the drawing library reports.
pub fn deformed_svg(title: &str, frame: &Frame<'_>) -> Result<String, String> {
    picture([WIDTH, HEIGHT], |root| draw(root, title, frame))
}

fn draw(root: &Area<'_>, title: &str, frame: &Frame<'_>) -> Drawn {
    root.draw(&Text::new(title.to_owned(), (ipx(28), ipx(16)), font(17)))?;
    let time = format!("t = {}", short(frame.time));
    root.draw(&Text::new(
        format!("{time} s"),
        (ipx(28), ipx(42)),
        font(13),
    ))?;
    let stress = nodal_stress(frame);
    let faces = boundary(frame);
    let points = deformed_points(frame);
    let plane = frame.cells.iter().all(|cells| cells.kind.dim() == 2);
    let view = View::new(plane);
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
    for face in &visible {
        draw_face(root, face, &scenery)?;
    }
    if stress.is_some() {
        let title = scale.label("von Mises", "Pa");
        draw_bar(root, &scale, title, [WIDTH - BAR, 130], 400, WIDTH - 24)?;
    }
    draw_axes(root, &view)
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

fn deformed_points(frame: &Frame<'_>) -> Vec<[f64; 3]> {
    let displacement = frame.point_vector("displacement");
    let moved = |(i, x): (usize, &Vector3<f64>)| {
        let u = displacement
            .and_then(|u| u.get(3 * i..3 * i + 3))
            .unwrap_or(&[0.0; 3]);
        [x[0] + u[0], x[1] + u[1], x[2] + u[2]]
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
    axes: [[f64; 3]; 3],
    plane: bool,
}

impl View {
    fn new(plane: bool) -> View {
        if plane {
            return View {
                axes: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
                plane,
            };
        }
        let eye = unit([1.0, -1.5, 0.85]);
        let right = unit(cross([0.0, 0.0, 1.0], eye));
        View {
            axes: [right, cross(eye, right), eye],
            plane,
        }
    }

    fn project(&self, x: [f64; 3]) -> [f64; 3] {
        self.axes.map(|axis| dot(axis, x))
    }
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

fn unit(a: [f64; 3]) -> [f64; 3] {
    let length = dot(a, a).sqrt();
    if length > 0.0 {
        a.map(|v| v / length)
    } else {
        a
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
    fn new(view: &View, points: &[[f64; 3]], faces: &[Vec<usize>]) -> Fit {
        let mut low = [f64::INFINITY; 2];
        let mut high = [f64::NEG_INFINITY; 2];
        for node in faces.iter().flatten() {
            let p = view.project(points[*node]);
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

    fn pixel(&self, p: [f64; 3]) -> (i32, i32) {
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
    points: &[[f64; 3]],
    faces: &'a [Vec<usize>],
) -> Vec<Visible<'a>> {
    let lamp = unit([0.35, -0.55, 0.75]);
    let mut visible = Vec::new();
    for nodes in faces {
        let corners: Vec<[f64; 3]> = nodes.iter().map(|node| points[*node]).collect();
        let last = corners.len() - 1;
        let diagonal = |a: usize, b: usize| [0, 1, 2].map(|k| corners[b][k] - corners[a][k]);
        let normal = unit(cross(diagonal(0, 2), diagonal(1, last)));
        if !view.plane && dot(normal, view.axes[2]) <= 0.0 {
            continue;
        }
        let depth =
            corners.iter().map(|c| dot(*c, view.axes[2])).sum::<f64>() / corners.len() as f64;
        let light = if view.plane {
            1.0
        } else {
            0.74 + 0.26 * dot(normal, lamp).max(0.0)
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
    points: &'a [[f64; 3]],
    view: &'a View,
    fit: &'a Fit,
    stress: Option<&'a [f64]>,
    scale: &'a Scale,
    /// Patches along each edge of a face.
    parts: usize,
}

fn draw_face(root: &Area<'_>, face: &Visible<'_>, scenery: &Scenery<'_>) -> Drawn {
    let Scenery {
        points,
        view,
        fit,
        stress,
        scale,
        parts,
    } = *scenery;
    // A triangle is a quadrilateral whose last corner stands twice.
    let corner = |i: usize| face.nodes[i.min(face.nodes.len() - 1)];
    let at = |s: f64, t: f64| {
        let weights = [(1.0 - s) * (1.0 - t), s * (1.0 - t), s * t, (1.0 - s) * t];
        let mut place = [0.0; 3];
        let mut value = 0.0;
        for (i, w) in weights.into_iter().enumerate() {
            let node = corner(i);
            let p = view.project(points[node]);
            (0..3).for_each(|k| place[k] += w * p[k]);
            value += w * stress.map_or(0.0, |stress| stress[node]);
        }
        (fit.pixel(place), value)
    };
    let step = 1.0 / parts as f64;
    for i in 0..parts {
        for j in 0..parts {
            let (s, t) = (i as f64 * step, j as f64 * step);
            let patch = [
                at(s, t),
                at(s + step, t),
                at(s + step, t + step),
                at(s, t + step),
            ];
            let mean = patch.iter().map(|(_, value)| value).sum::<f64>() / 4.0;
            let base = if stress.is_some() {
                color(scale, mean)
            } else {
                RGBColor(170, 180, 195)
            };
            let color = shaded(base, face.light);
            let mut outline: Vec<(i32, i32)> = patch.iter().map(|(pixel, _)| *pixel).collect();
            root.draw(&Polygon::new(outline.clone(), color.filled()))?;
            // The same colour along the rim closes the hairlines between neighbouring patches.
            outline.push(outline[0]);
            root.draw(&PathElement::new(outline, color.stroke_width(FINE)))?;
        }
    }
    let mut rim: Vec<(i32, i32)> = face
        .nodes
        .iter()
        .map(|node| fit.pixel(view.project(points[*node])))
        .collect();
    rim.push(rim[0]);
    root.draw(&PathElement::new(
        rim,
        BLACK.mix(0.45).stroke_width(FINE / 2),
    ))?;
    Ok(())
}

fn shaded(color: RGBColor, light: f64) -> RGBColor {
    let shade = |c: u8| (f64::from(c) * light).round().clamp(0.0, 255.0) as u8;
    RGBColor(shade(color.0), shade(color.1), shade(color.2))
}

/// Directions of x, y, z in the lower left corner.
fn draw_axes(root: &Area<'_>, view: &View) -> Drawn {
    let origin = (ipx(60), ipx(HEIGHT - 52));
    for (k, name) in ["x", "y", "z"].into_iter().enumerate() {
        let mut direction = [0.0; 3];
        direction[k] = 1.0;
        let p = view.project(direction);
        let length = (p[0] * p[0] + p[1] * p[1]).sqrt();
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
