//! Penetrations from the final positions alone, without the contact search of the program.

use contact_bipotential::{Master, Shape};
use fe_core::{Facet, Motion};
use nalgebra::Vector3;
use nscd::Model;

type Point = Vector3<f64>;

/// Flat displacements as current positions.
pub(super) fn positions(model: &Model, u: &[f64]) -> Vec<Point> {
    let dim = model.solid.dim();
    let points = model.solid.mesh().points.iter();
    let moved = points.zip(u.chunks_exact(dim));
    moved
        .map(|(x, u)| x + Vector3::from_fn(|c, _| u.get(c).copied().unwrap_or(0.0)))
        .collect()
}

/// How deep the worst slave node lies in its master \[m\], with its node; over all interfaces.
pub(super) fn deepest(model: &Model, x: &[Point], time: f64) -> (f64, u32) {
    let mut worst = (0.0, 0);
    for interface in &model.interfaces {
        for &node in &interface.slave {
            let at = x[node as usize];
            let depth = match &interface.master {
                Master::Obstacle(o) => depth_in_shape(o.shape(), o.motion(), at, time),
                Master::Surface(s) => depth_in_body(model, &s.facets, x, node),
            };
            if depth > worst.0 {
                worst = (depth, node);
            }
        }
    }
    worst
}

/// Farthest that a master's bilinear facet is from the two flat triangles that this file takes for it \[m\].
pub(super) fn warp(model: &Model, x: &[Point]) -> f64 {
    let surfaces = model.interfaces.iter().filter_map(|i| match &i.master {
        Master::Surface(surface) => Some(surface),
        Master::Obstacle(_) => None,
    });
    let facets = surfaces.flat_map(|surface| &surface.facets);
    let twist = facets.map(|facet| match facet.nodes() {
        &[a, b, c, d] => {
            let [a, b, c, d] = [a, b, c, d].map(|n| x[n as usize]);
            (a - b - (d - c)).norm() / 4.0
        }
        _ => 0.0,
    });
    twist.fold(0.0, f64::max)
}

/// How far a node passed through a round or sharp obstacle on its straight way \[m\], seen from the obstacle.
pub(super) fn deepest_on_the_way(
    model: &Model,
    [before, after]: [&[Point]; 2],
    [t0, t1]: [f64; 2],
) -> f64 {
    let mut worst = 0.0_f64;
    for interface in &model.interfaces {
        let Master::Obstacle(obstacle) = &interface.master else {
            continue;
        };
        for &node in &interface.slave {
            let ends = [(before, t0), (after, t1)]
                .map(|(x, t)| obstacle.motion().pull_back(x[node as usize], t));
            for k in 1..8 {
                let s = f64::from(k) / 8.0;
                let at = (1.0 - s) * ends[0] + s * ends[1];
                worst = worst.max(-distance(obstacle.shape(), at));
            }
        }
    }
    worst
}

fn depth_in_shape(shape: &Shape, motion: &Motion, x: Point, time: f64) -> f64 {
    -distance(shape, motion.pull_back(x, time))
}

/// Signed distance of a point to a shape at its reference position \[m\].
fn distance(shape: &Shape, x: Point) -> f64 {
    match *shape {
        Shape::Plane { point, normal } => (x - point).dot(&normal) / normal.norm(),
        Shape::Sphere { center, radius } => (x - center).norm() - radius,
        Shape::Cylinder {
            point,
            axis,
            radius,
        } => (x - point).cross(&axis).norm() / axis.norm() - radius,
        Shape::Cone {
            apex,
            axis,
            semi_apex_angle,
        } => {
            let arm = x - apex;
            let along = arm.dot(&axis) / axis.norm();
            let aside = arm.cross(&axis).norm() / axis.norm();
            let (sin, cos) = semi_apex_angle.sin_cos();
            // Only a ray of the surface bounds the solid; before the tip the tip is nearest.
            if aside * sin + along * cos <= 0.0 {
                arm.norm()
            } else {
                aside * cos - along * sin
            }
        }
        Shape::Punch {
            center,
            axis,
            radius,
        } => {
            let arm = x - center;
            let before = -arm.dot(&axis) / axis.norm();
            let beside = arm.cross(&axis).norm() / axis.norm() - radius;
            if before > 0.0 && beside > 0.0 {
                before.hypot(beside)
            } else {
                before.max(beside)
            }
        }
    }
}

/// Distance to the master's facets of a node that lies in an element of another body, else zero. A node that is nearer
/// to a side of the body which is no master came in there, past the rim: nothing holds it up.
fn depth_in_body(model: &Model, facets: &[Facet], x: &[Point], node: u32) -> f64 {
    let at = x[node as usize];
    let bodies = model.solid.bodies();
    let own = bodies.iter().find(|body| body.contains(&node));
    for block in model.solid.blocks() {
        let cells = || block.connectivity().chunks_exact(block.nodes_per_element());
        let foreign = |cell: &[u32]| own.is_none_or(|own| !own.contains(&cell[0]));
        let dim = model.solid.dim();
        if cells().any(|cell| foreign(cell) && is_in_cell(dim, cell, x, at)) {
            let key = |nodes: &[u32]| {
                let mut key = nodes.to_vec();
                key.sort_unstable();
                key
            };
            let masters: Vec<Vec<u32>> = facets.iter().map(|f| key(f.nodes())).collect();
            let faces: Vec<Vec<u32>> = cells().flat_map(|cell| faces(dim, cell)).collect();
            let mut keys: Vec<Vec<u32>> = faces.iter().map(|f| key(f)).collect();
            keys.sort_unstable();
            let shared = |key: &Vec<u32>| {
                keys.partition_point(|k| k <= key) - keys.partition_point(|k| k < key) > 1
            };
            let sides = faces.iter().filter(|f| {
                let key = key(f);
                !shared(&key) && !masters.contains(&key)
            });
            let to_side = sides
                .map(|f| to_face(f, x, at))
                .fold(f64::INFINITY, f64::min);
            let to_master = facets.iter().map(|f| to_face(f.nodes(), x, at));
            let to_master = to_master.fold(f64::INFINITY, f64::min);
            return if to_side < to_master { 0.0 } else { to_master };
        }
    }
    0.0
}

/// The faces of an element in space, its edges in the plane, by their corners.
fn faces(dim: usize, cell: &[u32]) -> Vec<Vec<u32>> {
    let sets: &[&[usize]] = match (dim, cell.len()) {
        (2, 3) => &[&[0, 1], &[1, 2], &[2, 0]],
        (2, _) => &[&[0, 1], &[1, 2], &[2, 3], &[3, 0]],
        (_, 4) => &[&[0, 1, 2], &[0, 1, 3], &[0, 2, 3], &[1, 2, 3]],
        _ => &[
            &[0, 1, 2, 3],
            &[4, 5, 6, 7],
            &[0, 1, 5, 4],
            &[1, 2, 6, 5],
            &[2, 3, 7, 6],
            &[3, 0, 4, 7],
        ],
    };
    let face = |set: &&[usize]| set.iter().map(|i| cell[*i]).collect();
    sets.iter().map(face).collect()
}

/// Whether a point lies in an element with straight edges, cut into simplices. Where a crushed element is no longer
/// convex, a simplex turned inside out takes away what another one has too much.
fn is_in_cell(dim: usize, cell: &[u32], x: &[Point], at: Point) -> bool {
    let corner = |i: &usize| x[cell[*i] as usize];
    let triangles = |sets: &[[usize; 3]]| -> i32 {
        let turns = sets
            .iter()
            .map(|t| in_triangle(t.each_ref().map(corner), at));
        turns.sum()
    };
    let tetrahedra = |sets: &[[usize; 4]]| -> i32 {
        let turns = sets
            .iter()
            .map(|t| in_tetrahedron(t.each_ref().map(corner), at));
        turns.sum()
    };
    let turns = match (dim, cell.len()) {
        (2, 3) => triangles(&[[0, 1, 2]]),
        (2, _) => triangles(&[[0, 1, 2], [0, 2, 3]]),
        (_, 4) => tetrahedra(&[[0, 1, 2, 3]]),
        _ => tetrahedra(&[
            [0, 1, 2, 6],
            [0, 2, 3, 6],
            [0, 3, 7, 6],
            [0, 7, 4, 6],
            [0, 4, 5, 6],
            [0, 5, 1, 6],
        ]),
    };
    turns != 0
}

/// One turn if all are positive, one turn the other way if all are negative.
fn turn<const N: usize>(sides: [f64; N]) -> i32 {
    i32::from(sides.iter().all(|s| *s > 0.0)) - i32::from(sides.iter().all(|s| *s < 0.0))
}

fn in_triangle([a, b, c]: [Point; 3], x: Point) -> i32 {
    let side = |p: Point, q: Point| (q - p).cross(&(x - p))[2];
    turn([side(a, b), side(b, c), side(c, a)])
}

fn in_tetrahedron([a, b, c, d]: [Point; 4], x: Point) -> i32 {
    let volume = |p: Point, q: Point, r: Point, s: Point| (s - p).dot(&(q - p).cross(&(r - p)));
    turn([
        volume(x, b, c, d),
        volume(a, x, c, d),
        volume(a, b, x, d),
        volume(a, b, c, x),
    ])
}

fn to_face(nodes: &[u32], x: &[Point], at: Point) -> f64 {
    let corners: Vec<Point> = nodes.iter().map(|n| x[*n as usize]).collect();
    match corners[..] {
        [a, b] => to_segment([a, b], at),
        [a, b, c] => to_triangle([a, b, c], at),
        [a, b, c, d] => to_triangle([a, b, c], at).min(to_triangle([a, c, d], at)),
        _ => f64::INFINITY,
    }
}

fn to_segment([a, b]: [Point; 2], x: Point) -> f64 {
    let along = b - a;
    let t = ((x - a).dot(&along) / along.norm_squared()).clamp(0.0, 1.0);
    (x - a - t * along).norm()
}

fn to_triangle([a, b, c]: [Point; 3], x: Point) -> f64 {
    let normal = (b - a).cross(&(c - a));
    let inside = |p: Point, q: Point| (q - p).cross(&(x - p)).dot(&normal) >= 0.0;
    if inside(a, b) && inside(b, c) && inside(c, a) {
        return ((x - a).dot(&normal) / normal.norm()).abs();
    }
    let edges = [[a, b], [b, c], [c, a]];
    edges
        .map(|e| to_segment(e, x))
        .into_iter()
        .fold(f64::INFINITY, f64::min)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn distances_to_shapes_and_facets() {
        let up = Vector3::y();
        let plane = Shape::Plane {
            point: Vector3::zeros(),
            normal: up,
        };
        assert_eq!(distance(&plane, Vector3::new(3.0, -0.5, 0.0)), -0.5);
        let cone = Shape::Cone {
            apex: Vector3::zeros(),
            axis: Vector3::new(0.0, -1.0, 0.0),
            semi_apex_angle: std::f64::consts::FRAC_PI_4,
        };
        assert!((distance(&cone, Vector3::new(0.0, -1.0, 0.0)) + 0.5_f64.sqrt()).abs() < 1e-15);
        assert_eq!(distance(&cone, Vector3::new(0.0, 2.0, 0.0)), 2.0);
        let t = [Vector3::zeros(), Vector3::x(), Vector3::y()];
        assert_eq!(to_triangle(t, Vector3::new(0.2, 0.2, 0.7)), 0.7);
        assert_eq!(to_triangle(t, Vector3::new(-3.0, 0.0, 4.0)), 5.0);
        assert_eq!(in_triangle(t, Vector3::new(0.2, 0.2, 0.0)), 1);
        assert_eq!(in_triangle(t, Vector3::new(0.8, 0.8, 0.0)), 0);
        let t = [t[0], t[1], t[2], Vector3::z()];
        assert_eq!(in_tetrahedron(t, Vector3::new(0.1, 0.1, 0.1)).abs(), 1);
        assert_eq!(in_tetrahedron(t, Vector3::new(0.5, 0.5, 0.5)), 0);
        let dart = [
            Vector3::new(0.0, 0.0, 0.0),
            Vector3::new(2.0, 0.0, 0.0),
            Vector3::new(0.5, 0.5, 0.0),
            Vector3::new(0.0, 2.0, 0.0),
        ];
        for k in 0..4 {
            let cell = [0, 1, 2, 3].map(|i| (i + k) % 4);
            assert!(is_in_cell(2, &cell, &dart, Vector3::new(0.2, 0.1, 0.0)));
            assert!(!is_in_cell(2, &cell, &dart, Vector3::new(0.75, 0.7, 0.0)));
        }
    }
}
