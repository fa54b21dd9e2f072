//! The search against brute force, and the continuity that the solver relies on.

use super::*;
use crate::geometry::facet::closest_point;
use fe_core::{Facet, Interpolation, Motion, Rotation, Surface, Table};
use nalgebra::Matrix3;
use proptest::prelude::*;

/// A master grid of `n` by `m` facets on the unit square, `z` from a function, and the slaves' positions.
struct Scene {
    facets: Vec<Facet>,
    positions: Vec<f64>,
    slave: Vec<u32>,
}

/// Positions as they are written down.
type Point3 = [f64; 3];

fn grid(
    n: u32,
    m: u32,
    triangles: bool,
    at: impl Fn(f64, f64) -> Point3,
    slaves: &[Point3],
) -> Scene {
    let mut positions = Vec::new();
    for j in 0..=m {
        for i in 0..=n {
            positions.extend(at(f64::from(i) / f64::from(n), f64::from(j) / f64::from(m)));
        }
    }
    let mut facets = Vec::new();
    for j in 0..m {
        for i in 0..n {
            let a = j * (n + 1) + i;
            let (b, c, d) = (a + 1, a + n + 2, a + n + 1);
            if triangles {
                facets.extend([Facet::triangle([a, b, c]), Facet::triangle([a, c, d])]);
            } else {
                facets.push(Facet::quad([a, b, c, d]));
            }
        }
    }
    let first = (n + 1) * (m + 1);
    positions.extend(slaves.iter().flatten());
    Scene {
        facets,
        positions,
        slave: (first..first + slaves.len() as u32).collect(),
    }
}

fn flat(u: f64, v: f64) -> Point3 {
    [u, v, 0.0]
}

/// Waves with slopes up to about `height * 6`.
fn wavy(height: f64, phase: f64) -> impl Fn(f64, f64) -> Point3 {
    move |u, v| {
        [
            u,
            v,
            height * ((6.0 * u + phase).sin() + (5.0 * v - phase).cos()),
        ]
    }
}

impl Scene {
    fn detector(&self, reach: f64) -> Detector {
        let surface = Surface::new(self.facets.clone()).unwrap();
        let area = vec![1.0; self.slave.len()];
        let interface = Interface::new(
            "test",
            self.slave.clone(),
            area,
            Master::Surface(surface),
            reach,
        );
        Detector::new(vec![interface], &self.positions, 3, Cone::Spatial).unwrap()
    }

    fn detect(&self, reach: f64) -> ContactMap {
        self.detector(reach).detect(&self.positions, 0.0, 1.0)
    }

    fn move_slave(&mut self, index: usize, x: impl Into<Point3>) {
        let start = 3 * self.slave[index] as usize;
        self.positions[start..start + 3].copy_from_slice(&x.into());
    }

    fn vertices(&self, facet: &Facet) -> Vec<Vector3<f64>> {
        facet
            .nodes()
            .iter()
            .map(|n| at_node(&self.positions, 3, *n))
            .collect()
    }
}

fn vector(size: f64) -> impl Strategy<Value = Vector3<f64>> {
    prop::array::uniform3(-size..size).prop_map(Vector3::from)
}

fn turned(axis: Vector3<f64>, angle: f64, shift: Vector3<f64>) -> Motion {
    let constant = Table::constant;
    Motion::translation(<[f64; 3]>::from(shift).map(constant))
        .with_rotation(Rotation::new([0.3, 0.1, -0.2], axis, constant(angle)).unwrap())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(40))]

    #[test]
    fn the_closest_facet_is_that_of_brute_force(
        phase in 0.0f64..6.0, triangles in any::<bool>(),
        slaves in prop::collection::vec([0.0f64..1.0, 0.0f64..1.0, -0.3f64..0.3], 20),
    ) {
        let scene = grid(7, 6, triangles, wavy(0.06, phase), &slaves);
        let reach = 0.25;
        let map = scene.detect(reach);
        let mut found = map.contacts.iter().peekable();
        for (k, x) in slaves.iter().enumerate() {
            let distances: Vec<f64> = scene
                .facets
                .iter()
                .map(|f| closest_point(&scene.vertices(f), Vector3::from(*x)).distance_squared.sqrt())
                .collect();
            let least = distances.iter().copied().fold(f64::INFINITY, f64::min);
            let Some(contact) = found.next_if(|c| c.slave_index == k) else {
                // Only out of reach, or over the rim.
                let over_rim = x[0].min(x[1]).min(1.0 - x[0]).min(1.0 - x[1]) < 0.2;
                prop_assert!(least > reach || over_rim);
                continue;
            };
            prop_assert!(least <= reach);
            prop_assert!((contact.gap.abs() - least).abs() < 1e-5 * 0.2 + 1e-14);
            let facet = contact.facet.unwrap() as usize;
            prop_assert!(distances[facet] <= least * (1.0 + 1e-11) + 1e-14);
            let lowest = distances.iter().position(|d| *d <= least * (1.0 + 1e-13)).unwrap();
            prop_assert!(facet <= lowest);
        }
        prop_assert!(found.next().is_none());
    }

    #[test]
    fn gap_is_continuous_across_facet_borders(
        phase in 0.0f64..6.0, triangles in any::<bool>(), height in -0.04f64..0.04,
        from in [0.2f64..0.8, 0.2f64..0.8], angle in 0.0f64..6.3,
    ) {
        // 400 small steps over several facets, above and below the surface. A signed distance never changes
        // faster than the node moves, whichever facet, edge or vertex is closest.
        let surface = wavy(0.05, phase);
        let mut scene = grid(8, 8, triangles, &surface, &[[0.0; 3]]);
        let mut detector = scene.detector(0.2);
        let step = 1e-3;
        let mut before: Option<(f64, Vector3<f64>)> = None;
        for k in 0..400 {
            let s = step * f64::from(k) - 0.2;
            let (u, v) = (from[0] + s * angle.cos(), from[1] + s * angle.sin());
            prop_assume!(u.min(v) > 0.05 && u.max(v) < 0.95);
            let x = Vector3::from(surface(u, v)) + Vector3::new(0.0, 0.0, height);
            scene.move_slave(0, x);
            let map = detector.detect(&scene.positions, 0.0, 1.0);
            prop_assert_eq!(map.len(), 1);
            let gap = map.contacts[0].gap;
            prop_assert!((map.contacts[0].normal() - Vector3::z()).norm() < 1.0);
            if let Some((last, at)) = before {
                prop_assert!((gap - last).abs() <= (x - at).norm() + 1e-14, "{last} -> {gap}");
            }
            before = Some((gap, x));
        }
    }

    #[test]
    fn normal_and_frame_are_continuous_on_the_surface(
        phase in 0.0f64..6.0, triangles in any::<bool>(), from in [0.2f64..0.8, 0.2f64..0.8], angle in 0.0f64..6.3,
    ) {
        let mut scene = grid(8, 8, triangles, wavy(0.05, phase), &[[0.0; 3]]);
        let mut detector = scene.detector(0.2);
        let mut before: Option<(usize, Matrix3<f64>)> = None;
        let mut borders = 0;
        for k in 0..400 {
            let s = 1e-3 * f64::from(k) - 0.2;
            let (u, v) = (from[0] + s * angle.cos(), from[1] + s * angle.sin());
            prop_assume!(u.min(v) > 0.02 && u.max(v) < 0.98);
            // Onto the faceted surface itself, along z.
            let mut x = [u, v, 0.0];
            for _ in 0..8 {
                scene.move_slave(0, x);
                let c = detector.detect(&scene.positions, 0.0, 1.0).contacts[0];
                x[2] -= c.gap;
            }
            scene.move_slave(0, x);
            let c = detector.detect(&scene.positions, 0.0, 1.0).contacts[0];
            prop_assert!(c.gap.abs() < 1e-6, "{}", c.gap);
            let facet = c.facet.unwrap() as usize;
            if let Some((last, frame)) = before {
                borders += usize::from(last != facet);
                for i in 0..3 {
                    // A normal turns by up to 1.8 per unit length, twice that where the gradient of a facet bunches.
                    prop_assert!((c.frame.column(i) - frame.column(i)).norm() < 5e-3, "{:?} {:?}", c.frame, frame);
                }
            }
            before = Some((facet, c.frame));
        }
        prop_assert!(borders > 0);
    }

    #[test]
    fn a_slave_on_the_surface_has_no_gap(
        phase in 0.0f64..6.0, triangles in any::<bool>(), facet in 0usize..36,
        w in [0.0f64..1.0, 0.0f64..1.0], pin in 0usize..4,
    ) {
        let mut scene = grid(6, 6, triangles, wavy(0.05, phase), &[[0.0; 3]]);
        let x = scene.vertices(&scene.facets[facet]);
        // Also exactly on edges and vertices, the rim among them.
        let (a, b) = match pin {
            0 => (w[0], w[1]),
            1 => (w[0], 0.0),
            2 => (0.0, w[1]),
            _ => (1.0, 0.0),
        };
        let weights = if triangles {
            vec![1.0 - a, a * (1.0 - b), a * b]
        } else {
            vec![(1.0 - a) * (1.0 - b), a * (1.0 - b), a * b, (1.0 - a) * b]
        };
        let p = x.iter().zip(&weights).fold(Vector3::zeros(), |s, (x, w)| s + *w * x);
        scene.move_slave(0, p);
        let map = scene.detect(0.1);
        prop_assert_eq!(map.len(), 1);
        prop_assert!(map.contacts[0].gap.abs() < 1e-15);
    }

    #[test]
    fn gaps_do_not_change_under_a_rigid_motion(
        phase in 0.0f64..6.0, triangles in any::<bool>(), axis in vector(1.0), angle in -3.0f64..3.0, shift in vector(3.0),
        slaves in prop::collection::vec([0.05f64..0.95, 0.05f64..0.95, -0.15f64..0.15], 10),
    ) {
        prop_assume!(axis.norm() > 0.1);
        let mut scene = grid(5, 4, triangles, wavy(0.05, phase), &slaves);
        let mut detector = scene.detector(0.3);
        let before = detector.detect(&scene.positions, 0.0, 1.0);
        let motion = turned(axis, angle, shift);
        for x in scene.positions.chunks_exact_mut(3) {
            let moved = motion.position(Vector3::new(x[0], x[1], x[2]), 0.0);
            x.copy_from_slice(moved.as_slice());
        }
        let after = detector.detect(&scene.positions, 0.0, 1.0);
        prop_assert_eq!(before.len(), after.len());
        for (a, b) in before.contacts.iter().zip(&after.contacts) {
            prop_assert!((a.gap - b.gap).abs() < 1e-13);
            let normal = motion.rotate(a.normal(), 0.0);
            // Between two equally close facets of a valley round-off may choose.
            if a.facet == b.facet {
                prop_assert!((normal - b.normal()).norm() < 1e-10);
            }
        }
    }

    #[test]
    fn the_gaps_derivative_is_the_normal_row(
        triangles in any::<bool>(), x in [0.11f64..0.89, 0.11f64..0.89, -0.1f64..0.1], direction in prop::collection::vec(-1.0f64..1.0, 3 * 37),
        axis in vector(1.0), angle in -3.0f64..3.0,
    ) {
        prop_assume!(axis.norm() > 0.1);
        let mut scene = grid(5, 5, triangles, flat, &[x]);
        let motion = turned(axis, angle, Vector3::zeros());
        for x in scene.positions.chunks_exact_mut(3) {
            x.copy_from_slice(motion.position(Vector3::new(x[0], x[1], x[2]), 0.0).as_slice());
        }
        let mut detector = scene.detector(0.3);
        let map = detector.detect(&scene.positions, 0.0, 1.0);
        prop_assert_eq!(map.len(), 1);
        prop_assume!(map.contacts[0].stencil.weights()[1..].iter().all(|w| *w < -1e-3));
        let mut change = [0.0; 3];
        map.apply(&direction, &mut change);
        let h = 1e-6;
        let mut gap = |s: f64| {
            let moved: Vec<f64> = scene.positions.iter().zip(&direction).map(|(x, d)| x + s * d).collect();
            detector.detect(&moved, 0.0, 1.0).contacts[0].gap
        };
        let difference = (gap(h) - gap(-h)) / (2.0 * h);
        prop_assert!((difference - change[2]).abs() < 1e-7, "{difference} {}", change[2]);
    }

    #[test]
    fn earlier_searches_leave_no_trace(
        phase in 0.0f64..6.0, slaves in prop::collection::vec([0.0f64..1.0, 0.0f64..1.0, -0.1f64..0.1], 30),
        noise in prop::collection::vec(-0.05f64..0.05, 3 * 72),
    ) {
        let mut scene = grid(6, 5, false, wavy(0.05, phase), &slaves);
        let (mut travelled, mut fresh) = (scene.detector(0.08), scene.detector(0.08));
        for size in [0.2, 1.0, 3.0] {
            let moved: Vec<f64> = scene.positions.iter().zip(&noise).map(|(x, d)| x + size * d).collect();
            travelled.detect(&moved, 0.0, 1.0);
        }
        for (x, d) in scene.positions.iter_mut().zip(&noise) {
            *x += 0.3 * d;
        }
        prop_assert_eq!(travelled.detect(&scene.positions, 0.0, 1.0), fresh.detect(&scene.positions, 0.0, 1.0));
    }
}

mod cases;
mod plane;
