//! Frames fixed in a master's material (convected axes): what is stored along them turns with the master.

use fe_core::Surface;
use nalgebra::{Matrix3, Vector3};

use crate::geometry::facet::facet_normal;
use crate::geometry::interface::{Interface, Master};
use crate::geometry::vector::{at_node, reject, unit};

/// A right-handed orthonormal frame \[-\], columns `e1`, `e2`, `m`, that turns with the material of an interface's
/// master.
///
/// On facet `facet` of a deformable master `m` is the facet's own normal (of a quadrilateral, at its middle), `e1`
/// the direction from its first to its second node, across `m`, and `e2 = m x e1`, which is `e_z` in the plane.
/// An obstacle, `None`, has the axes x, y, z at zero displacement, turned by its motion at `time` \[s\].
/// `positions` are current \[m\], flat, `dim * node + component`.
///
/// A facet without area, a facet that the master lacks and a deformable master without a facet give x, y, z.
/// Frames of two facets differ: turn a vector with the facet on which it was stored, then store it on the next one.
#[must_use]
pub fn material_frame(
    interface: &Interface,
    facet: Option<u32>,
    positions: &[f64],
    dim: usize,
    time: f64,
) -> Matrix3<f64> {
    let axes = Matrix3::identity();
    match (&interface.master, facet) {
        (Master::Obstacle(obstacle), _) => {
            let turned = [0, 1, 2].map(|i| obstacle.motion().rotate(axes.column(i).into(), time));
            Matrix3::from_columns(&turned)
        }
        (Master::Surface(surface), Some(facet)) => {
            facet_frame(surface, facet as usize, positions, dim).unwrap_or(axes)
        }
        (Master::Surface(_), None) => axes,
    }
}

fn facet_frame(
    surface: &Surface,
    facet: usize,
    positions: &[f64],
    dim: usize,
) -> Option<Matrix3<f64>> {
    let nodes = surface.facets.get(facet)?.nodes();
    let mut buffer = [Vector3::zeros(); 4];
    for (x, node) in buffer.iter_mut().zip(nodes) {
        *x = at_node(positions, dim, *node);
    }
    let x = buffer.get(..nodes.len())?;
    let m = facet_normal(x, [0.5; 2])?;
    let e1 = unit(reject(x[1] - x[0], m))?;
    Some(Matrix3::from_columns(&[e1, m.cross(&e1), m]))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::obstacle::{Obstacle, Shape};
    use fe_core::{Facet, Motion, Rotation, Table};
    use proptest::prelude::*;

    const NODES: usize = 5;

    fn vector() -> impl Strategy<Value = Vector3<f64>> {
        prop::array::uniform3(-1.0f64..1.0).prop_map(Vector3::from)
    }

    /// Shift and turn, constant in time.
    fn motion(axis: Vector3<f64>, angle: f64, shift: Vector3<f64>) -> Motion {
        let turn = Rotation::new([0.1, 0.2, 0.0], axis, Table::constant(angle)).unwrap();
        Motion::translation(<[f64; 3]>::from(shift).map(Table::constant)).with_rotation(turn)
    }

    fn pair(facets: Vec<Facet>) -> Interface {
        let master = Master::Surface(Surface::new(facets).unwrap());
        Interface::new("pair", vec![0], vec![1.0], master, 0.1)
    }

    fn moved(positions: &[f64], dim: usize, motion: &Motion) -> Vec<f64> {
        (0..NODES as u32)
            .flat_map(|k| {
                motion.position(at_node(positions, dim, k), 0.0).as_slice()[..dim].to_vec()
            })
            .collect()
    }

    fn assert_right_handed(axes: Matrix3<f64>) {
        for a in axes.column_iter() {
            assert!((a.norm() - 1.0).abs() < 1e-14);
        }
        let across = axes.column(0).cross(&axes.column(1));
        assert!((across - axes.column(2)).norm() < 1e-14);
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
            prop_assume!(axis.norm() > 0.1);
            let (dim, axis) = if plane { (2, Vector3::z()) } else { (3, axis) };
            let (interface, x) = (masters(dim), corners(dim, &noise));
            let axes = |x: &[f64]| material_frame(&interface, Some(facet), x, dim, 0.0);
            let before = axes(&x);
            assert_right_handed(before);
            let turn = motion(axis, angle, Vector3::new(shift[0], shift[1], if plane { 0.0 } else { shift[2] }));
            let after = axes(&moved(&x, dim, &turn));
            for i in 0..3 {
                prop_assert!((turn.rotate(before.column(i).into(), 0.0) - after.column(i)).norm() < 1e-13);
            }
            let still = axes(&moved(&x, dim, &motion(axis, 0.0, shift)));
            for i in 0..3 {
                prop_assert!((before.column(i) - still.column(i)).norm() < 1e-14);
            }
        }

        #[test]
        fn axes_of_an_obstacle_are_its_motion(axis in vector(), angle in -3.0f64..3.0, shift in vector(), t in 0.0f64..1.0) {
            prop_assume!(axis.norm() > 0.1);
            let ramp = Table::new(vec![(0.0, 0.0), (1.0, angle)], fe_core::Interpolation::Linear).unwrap();
            let motion = Motion::translation(<[f64; 3]>::from(shift).map(Table::constant))
                .with_rotation(Rotation::new([0.0; 3], axis, ramp).unwrap());
            let ball = Shape::Sphere { center: Vector3::zeros(), radius: 1.0 };
            let master = Master::Obstacle(Obstacle::new(ball, motion).unwrap());
            let interface = Interface::new("ball", vec![0], vec![1.0], master, 0.1);
            prop_assert_eq!(material_frame(&interface, None, &[], 3, 0.0), Matrix3::identity());
            let axes = material_frame(&interface, None, &[], 3, t);
            assert_right_handed(axes);
            // Rodrigues: the axis stays, and across it everything turns by the angle.
            let k = unit(axis).unwrap();
            for (i, e) in [Vector3::x(), Vector3::y(), Vector3::z()].iter().enumerate() {
                let turned = axes.column(i).into_owned();
                let (a, b) = (reject(*e, k), reject(turned, k));
                prop_assert!((e.dot(&k) - turned.dot(&k)).abs() < 1e-14);
                let (sin, cos) = (t * angle).sin_cos();
                prop_assert!((b - (cos * a + sin * k.cross(&a))).norm() < 1e-14);
            }
        }
    }

    #[test]
    fn axes_by_hand() {
        let mut x = corners(2, &[0.0; 10]);
        let axes = |x: &[f64], facet| material_frame(&masters(2), Some(facet), x, 2, 0.0);
        let (ex, ey, ez) = (Vector3::x(), Vector3::y(), Vector3::z());
        assert_eq!(axes(&x, 0), Matrix3::from_columns(&[ex, ez, -ey]));
        assert_eq!(axes(&x, 1), Matrix3::from_columns(&[ey, ez, ex]));
        // Stretch is not a rotation; a collapsed facet has no axes of its own.
        x[4] = 5.0;
        assert_eq!(axes(&x, 0).column(0), ex);
        x[4] = 0.0;
        assert_eq!(axes(&x, 0), Matrix3::identity());
        assert_eq!(axes(&x, 7), Matrix3::identity());
        let quad = material_frame(&masters(3), Some(0), &corners(3, &[0.0; 15]), 3, 0.0);
        assert_eq!(quad, Matrix3::identity());
    }
}
