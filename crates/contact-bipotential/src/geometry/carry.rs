//! Axes fixed in a master's material: what is stored along them turns with the master.

use fe_core::Surface;

use crate::geometry::facet::facet_normal;
use crate::geometry::interface::{Interface, Master};
use crate::geometry::vec3::{Vec3, cross, node_vector, reject, sub, unit};

const GLOBAL: [Vec3; 3] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];

/// Right-handed orthonormal rows `e1`, `e2`, `m` [-] that turn with the material of an interface's master.
///
/// On facet `facet` of a deformable master `m` is the facet's own normal (of a quadrilateral, at its middle), `e1`
/// the direction from its first to its second node, across `m`, and `e2 = m x e1`, which is `e_z` in the plane.
/// An obstacle, `None`, has the axes x, y, z at zero displacement, turned by its motion at `time` \[s\].
/// `positions` are current \[m\], flat, `dim * node + component`.
///
/// A facet without area, a facet that the master lacks and a deformable master without a facet give x, y, z.
/// Axes of two facets differ: carry a vector on the facet on which it was stored, then store it on the next one.
pub fn material_axes(
    interface: &Interface,
    facet: Option<u32>,
    positions: &[f64],
    dim: usize,
    time: f64,
) -> [[f64; 3]; 3] {
    match (&interface.master, facet) {
        (Master::Obstacle(obstacle), _) => {
            GLOBAL.map(|e| obstacle.motion().rotate(e.into(), time).into())
        }
        (Master::Surface(surface), Some(facet)) => {
            facet_axes(surface, facet as usize, positions, dim).unwrap_or(GLOBAL)
        }
        (Master::Surface(_), None) => GLOBAL,
    }
}

fn facet_axes(surface: &Surface, facet: usize, positions: &[f64], dim: usize) -> Option<[Vec3; 3]> {
    let nodes = surface.facets.get(facet)?.nodes();
    let mut buffer = [[0.0; 3]; 4];
    for (x, node) in buffer.iter_mut().zip(nodes) {
        *x = node_vector(positions, dim, *node);
    }
    let x = buffer.get(..nodes.len())?;
    let m = facet_normal(x, [0.5; 2])?;
    let e1 = unit(reject(sub(x[1], x[0]), m))?;
    Some([e1, cross(m, e1), m])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::obstacle::{Obstacle, Shape};
    use crate::geometry::vec3::{axpy, dot, norm};
    use fe_core::{Facet, Motion, Rotation, Table};
    use proptest::prelude::*;

    const NODES: usize = 5;

    fn vector() -> impl Strategy<Value = Vec3> {
        [-1.0f64..1.0, -1.0f64..1.0, -1.0f64..1.0]
    }

    /// Shift and turn, constant in time.
    fn motion(axis: Vec3, angle: f64, shift: Vec3) -> Motion {
        Motion {
            translation: shift.map(Table::constant),
            rotation: Some(Rotation::new([0.1, 0.2, 0.0], axis, Table::constant(angle)).unwrap()),
        }
    }

    fn pair(facets: Vec<Facet>) -> Interface {
        let master = Master::Surface(Surface::new(facets).unwrap());
        Interface::new("pair", vec![0], vec![1.0], master, 0.1)
    }

    fn moved(positions: &[f64], dim: usize, motion: &Motion) -> Vec<f64> {
        (0..NODES as u32)
            .flat_map(|k| {
                motion
                    .position(node_vector(positions, dim, k).into(), 0.0)
                    .as_slice()[..dim]
                    .to_vec()
            })
            .collect()
    }

    fn assert_right_handed([e1, e2, m]: [Vec3; 3]) {
        for a in [e1, e2, m] {
            assert!((norm(a) - 1.0).abs() < 1e-14);
        }
        assert!(norm(sub(cross(e1, e2), m)) < 1e-14);
    }

    /// A unit square with a node off its plane, and the triangle and lines in it; nodes 1 to 4.
    fn masters(dim: usize) -> Interface {
        if dim == 2 {
            return pair(vec![Facet::edge([1, 2]), Facet::edge([2, 3])]);
        }
        pair(vec![Facet::quad([1, 2, 3, 4]), Facet::triangle([2, 3, 4])])
    }

    fn corners(dim: usize, noise: &[f64]) -> Vec<f64> {
        let square = [
            [9.0, 9.0, 9.0],
            [0.0; 3],
            [1.0, 0.0, 0.0],
            [1.0, 1.0, 0.0],
            [0.0, 1.0, 0.0],
        ];
        let flat = square.iter().flat_map(|x| x[..dim].to_vec());
        flat.zip(noise).map(|(x, d)| x + d).collect()
    }

    proptest! {
        #[test]
        fn axes_of_a_facet_turn_with_it_and_ignore_translation(
            noise in prop::collection::vec(-0.2f64..0.2, 3 * NODES), axis in vector(), angle in -3.0f64..3.0,
            shift in vector(), plane in any::<bool>(), facet in 0u32..2,
        ) {
            prop_assume!(norm(axis) > 0.1);
            let (dim, axis) = if plane { (2, [0.0, 0.0, 1.0]) } else { (3, axis) };
            let (interface, x) = (masters(dim), corners(dim, &noise));
            let axes = |x: &[f64]| material_axes(&interface, Some(facet), x, dim, 0.0);
            let before = axes(&x);
            assert_right_handed(before);
            let turn = motion(axis, angle, [shift[0], shift[1], if plane { 0.0 } else { shift[2] }]);
            let after = axes(&moved(&x, dim, &turn));
            for i in 0..3 {
                prop_assert!(norm(sub(turn.rotate(before[i].into(), 0.0).into(), after[i])) < 1e-13);
            }
            let still = axes(&moved(&x, dim, &motion(axis, 0.0, shift)));
            for i in 0..3 {
                prop_assert!(norm(sub(before[i], still[i])) < 1e-14);
            }
        }

        #[test]
        fn axes_of_an_obstacle_are_its_motion(axis in vector(), angle in -3.0f64..3.0, shift in vector(), t in 0.0f64..1.0) {
            prop_assume!(norm(axis) > 0.1);
            let ramp = Table::new(vec![(0.0, 0.0), (1.0, angle)], fe_core::Interpolation::Linear).unwrap();
            let motion = Motion {
                rotation: Some(Rotation::new([0.0; 3], axis, ramp).unwrap()),
                ..Motion::translation(shift.map(Table::constant))
            };
            let ball = Shape::Sphere { center: [0.0; 3], radius: 1.0 };
            let master = Master::Obstacle(Obstacle::new(ball, motion).unwrap());
            let interface = Interface::new("ball", vec![0], vec![1.0], master, 0.1);
            prop_assert_eq!(material_axes(&interface, None, &[], 3, 0.0), GLOBAL);
            let axes = material_axes(&interface, None, &[], 3, t);
            assert_right_handed(axes);
            // Rodrigues: the axis stays, and across it everything turns by the angle.
            let k = unit(axis).unwrap();
            for (e, turned) in GLOBAL.iter().zip(axes) {
                let (a, b) = (reject(*e, k), reject(turned, k));
                prop_assert!((dot(*e, k) - dot(turned, k)).abs() < 1e-14);
                let (sin, cos) = (t * angle).sin_cos();
                prop_assert!(norm(sub(b, axpy(axpy([0.0; 3], cos, a), sin, cross(k, a)))) < 1e-14);
            }
        }
    }

    #[test]
    fn axes_by_hand() {
        let mut x = corners(2, &[0.0; 10]);
        let axes = |x: &[f64], facet| material_axes(&masters(2), Some(facet), x, 2, 0.0);
        assert_eq!(
            axes(&x, 0),
            [[1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, -1.0, 0.0]]
        );
        assert_eq!(
            axes(&x, 1),
            [[0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [1.0, 0.0, 0.0]]
        );
        // Stretch is not a rotation; a collapsed facet has no axes of its own.
        x[4] = 5.0;
        assert_eq!(axes(&x, 0)[0], [1.0, 0.0, 0.0]);
        x[4] = 0.0;
        assert_eq!(axes(&x, 0), GLOBAL);
        assert_eq!(axes(&x, 7), GLOBAL);
        let quad = material_axes(&masters(3), Some(0), &corners(3, &[0.0; 15]), 3, 0.0);
        assert_eq!(quad, GLOBAL);
    }
}
