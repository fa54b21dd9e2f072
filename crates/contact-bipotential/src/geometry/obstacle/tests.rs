//! Signed distances against their defining properties, and the kinematics of moving obstacles.

use super::*;
use fe_core::{Interpolation, Table};
use proptest::prelude::*;

const CORE: f64 = 1e-12;

fn vector(size: f64) -> impl Strategy<Value = Vector3<f64>> {
    prop::array::uniform3(-size..size).prop_map(Vector3::from)
}

fn axis() -> impl Strategy<Value = Vector3<f64>> {
    vector(1.0).prop_filter("needs a direction", |a| a.norm() > 0.1)
}

fn shape() -> impl Strategy<Value = Shape> {
    prop_oneof![
        (vector(1.0), axis()).prop_map(|(point, normal)| Shape::Plane { point, normal }),
        (vector(1.0), 0.1f64..2.0).prop_map(|(center, radius)| Shape::Sphere { center, radius }),
        (vector(1.0), axis(), 0.1f64..2.0).prop_map(|(point, axis, radius)| Shape::Cylinder {
            point,
            axis,
            radius
        }),
        (vector(1.0), axis(), 0.1f64..1.5).prop_map(|(apex, axis, semi_apex_angle)| Shape::Cone {
            apex,
            axis,
            semi_apex_angle
        }),
        (vector(1.0), axis(), 0.1f64..2.0).prop_map(|(center, axis, radius)| Shape::Punch {
            center,
            axis,
            radius
        }),
    ]
}

fn table() -> impl Strategy<Value = Table> {
    (-1.0f64..1.0, -1.0f64..1.0)
        .prop_map(|(a, b)| Table::new(vec![(0.0, a), (1.0, b)], Interpolation::Linear).unwrap())
}

fn motion() -> impl Strategy<Value = Motion> {
    ([table(), table(), table()], vector(2.0), axis(), table()).prop_map(
        |(translation, point, axis, angle)| {
            Motion::translation(translation)
                .with_rotation(Rotation::new(point, axis, angle).unwrap())
        },
    )
}

proptest! {
    #[test]
    fn gap_is_the_signed_distance_along_the_normal(shape in shape(), x in vector(4.0)) {
        let obstacle = Obstacle::new(shape, Motion::still()).unwrap();
        let placed = obstacle.over_step(0.0, 1.0);
        let at = placed.closest(x, CORE);
        prop_assert!((at.normal.norm() - 1.0).abs() < 1e-14);
        // The node lies on the normal through the closest point, at the gap, and that point on the surface.
        prop_assert!((at.point + at.gap * at.normal - x).norm() < 1e-13);
        prop_assert!(placed.closest(at.point, CORE).gap.abs() < 1e-13);
        prop_assert_eq!(placed.displacement(at.point), Vector3::zeros());
    }

    #[test]
    fn no_surface_point_is_closer_than_the_gap(shape in shape(), x in vector(4.0), samples in prop::collection::vec(vector(4.0), 30)) {
        let obstacle = Obstacle::new(shape, Motion::still()).unwrap();
        let placed = obstacle.over_step(0.0, 1.0);
        let gap = placed.closest(x, CORE).gap;
        for y in samples {
            // A signed distance changes no faster than its argument.
            let other = placed.closest(y, CORE).gap;
            prop_assert!((gap - other).abs() <= (x - y).norm() + 1e-13);
        }
    }

    #[test]
    fn normal_is_the_gradient_of_the_gap(shape in shape(), x in vector(4.0)) {
        let obstacle = Obstacle::new(shape, Motion::still()).unwrap();
        let placed = obstacle.over_step(0.0, 1.0);
        let at = placed.closest(x, CORE);
        let h = 1e-5;
        // Centre and axis have no gradient.
        prop_assume!((x - at.point).norm() + at.gap.abs() > 0.0);
        let gap = |i: usize, s: f64| {
            let mut y = x;
            y[i] += s;
            placed.closest(y, CORE).gap
        };
        let gradient = Vector3::from_fn(|i, _| (gap(i, h) - gap(i, -h)) / (2.0 * h));
        prop_assume!((gradient.norm() - 1.0).abs() < 1e-4);
        prop_assert!((gradient - at.normal).norm() < 1e-3);
    }

    #[test]
    fn a_moving_obstacle_carries_its_distance_field(shape in shape(), motion in motion(), x in vector(3.0), t in 0.0f64..1.0) {
        let still = Obstacle::new(shape, Motion::still()).unwrap();
        let moving = Obstacle::new(shape, motion.clone()).unwrap();
        let before = still.over_step(0.0, t).closest(x, CORE);
        let after = moving.over_step(t, t).closest(motion.position(x, t), CORE);
        prop_assert!((before.gap - after.gap).abs() < 1e-13);
        prop_assert!((motion.rotate(before.normal, t) - after.normal).norm() < 1e-10);
        prop_assert!((motion.position(before.point, t) - after.point).norm() < 1e-10);
    }

    #[test]
    fn displacement_is_that_of_the_material_point(motion in motion(), x in vector(3.0), t0 in 0.0f64..0.5, t1 in 0.5f64..1.0) {
        let plane = Shape::Plane { point: Vector3::zeros(), normal: Vector3::z() };
        let obstacle = Obstacle::new(plane, motion.clone()).unwrap();
        let moved = obstacle.over_step(t0, t1).displacement(motion.position(x, t1));
        prop_assert!((moved - (motion.position(x, t1) - motion.position(x, t0))).norm() < 1e-13);
        // A rate exists: over a short step the displacement is velocity times step.
        let dt = 1e-6;
        let short = obstacle.over_step(t1 - dt, t1).displacement(motion.position(x, t1));
        prop_assert!((1.0 / dt * short - motion.velocity(x, t1 - 0.5 * dt)).norm() < 1e-7);
    }
}

#[test]
fn parameters_outside_their_bounds_are_refused() {
    let point = Vector3::zeros();
    let axis = Vector3::z();
    let bad = [
        Shape::Plane {
            point,
            normal: Vector3::zeros(),
        },
        Shape::Plane {
            point: Vector3::new(f64::NAN, 0.0, 0.0),
            normal: axis,
        },
        Shape::Plane {
            point,
            normal: Vector3::new(f64::INFINITY, 0.0, 0.0),
        },
        Shape::Sphere {
            center: point,
            radius: 0.0,
        },
        Shape::Sphere {
            center: point,
            radius: -1.0,
        },
        Shape::Sphere {
            center: point,
            radius: f64::NAN,
        },
        Shape::Cylinder {
            point,
            axis: Vector3::zeros(),
            radius: 1.0,
        },
        Shape::Cylinder {
            point,
            axis,
            radius: f64::INFINITY,
        },
        Shape::Cone {
            apex: point,
            axis,
            semi_apex_angle: 0.0,
        },
        Shape::Cone {
            apex: point,
            axis,
            semi_apex_angle: std::f64::consts::FRAC_PI_2,
        },
        Shape::Cone {
            apex: point,
            axis,
            semi_apex_angle: f64::NAN,
        },
        Shape::Cone {
            apex: point,
            axis: Vector3::repeat(f64::NAN),
            semi_apex_angle: 1.0,
        },
        Shape::Punch {
            center: point,
            axis: Vector3::zeros(),
            radius: 1.0,
        },
        Shape::Punch {
            center: Vector3::new(0.0, f64::NAN, 0.0),
            axis,
            radius: 1.0,
        },
        Shape::Punch {
            center: point,
            axis,
            radius: -1.0,
        },
    ];
    for shape in bad {
        let error = Obstacle::new(shape, Motion::still()).unwrap_err();
        assert!(error.to_string().contains("must"), "{error}");
    }
}

#[test]
fn a_node_under_the_tip_meets_it_head_on() {
    let down = Shape::Cone {
        apex: Vector3::zeros(),
        axis: Vector3::z(),
        semi_apex_angle: 1.0,
    };
    let obstacle = Obstacle::new(down, Motion::still()).unwrap();
    let placed = obstacle.over_step(0.0, 0.0);
    for z in [-0.5, -1e-17, 0.0, 1e-17, 0.5] {
        for x in [0.0, 1e-15, -1e-13] {
            let at = placed.closest(Vector3::new(x, 0.0, z), 1e-9);
            assert_eq!(at.normal, -Vector3::z());
            assert_eq!(at.gap, -z);
        }
    }
    // Beside the tip the surface has its own normal again.
    let side = placed.closest(Vector3::new(0.1, 0.0, 0.1), 1e-9);
    let expected = Vector3::new(1.0f64.cos(), 0.0, -1.0f64.sin());
    assert!((side.normal - expected).norm() < 1e-15);
    assert!((side.gap - 0.1 * (1.0f64.cos() - 1.0f64.sin())).abs() < 1e-16);
}

/// A punch of radius 1 that stands on z = 0, and moves by `-sunk` along z from t = 0 to 1.
fn upright_punch(sunk: f64) -> Obstacle {
    let punch = Shape::Punch {
        center: Vector3::new(0.0, 0.0, sunk),
        axis: Vector3::new(0.0, 0.0, 3.0),
        radius: 1.0,
    };
    let down = Table::new(vec![(0.0, 0.0), (1.0, -sunk)], Interpolation::Linear).unwrap();
    let still = Table::constant(0.0);
    Obstacle::new(punch, Motion::translation([still.clone(), still, down])).unwrap()
}

#[test]
fn around_the_edge_of_a_punch_the_nearest_surface_counts() {
    let (down, out) = (-Vector3::z(), Vector3::x());
    let slanted = Vector3::new(0.6, 0.0, -0.8);
    let cases = [
        // Below the face, at its edge, above it.
        (Vector3::new(0.2, 0.0, -0.3), 0.3, down),
        (Vector3::new(1.0, 0.0, -0.3), 0.3, down),
        (Vector3::x(), 0.0, down),
        (Vector3::new(0.9, 0.0, 0.05), -0.05, down),
        // Beside the wall and inside it, farther from the face.
        (Vector3::new(1.3, 0.0, 0.0), 0.3, out),
        (Vector3::new(1.3, 0.0, 7.0), 0.3, out),
        (Vector3::new(0.9, 0.0, 0.2), -0.1, out),
        (Vector3::new(1.0, 0.0, 0.2), 0.0, out),
        // Beyond the edge and below.
        (Vector3::new(1.6, 0.0, -0.8), 1.0, slanted),
    ];
    let obstacle = upright_punch(0.0);
    let placed = obstacle.over_step(0.0, 1.0);
    for (x, gap, normal) in cases {
        let at = placed.closest(x, 1e-9);
        assert!((at.gap - gap).abs() < 1e-15, "{x:?}: {at:?}");
        assert!((at.normal - normal).norm() < 1e-15, "{x:?}: {at:?}");
    }
}

#[test]
fn nodes_that_the_face_sweeps_over_meet_the_face() {
    let obstacle = upright_punch(0.2);
    let driven = obstacle.over_step(0.0, 1.0);
    for x in [0.0, 0.9, 0.999, 1.0, 1.0 + 1e-12] {
        for depth in [0.0, 1e-9, 0.1, 0.2 - 1e-12] {
            let at = driven.closest(Vector3::new(x, 0.0, depth), 1e-9);
            assert_eq!((at.normal, at.gap), (-Vector3::z(), -depth), "{x}");
        }
    }
    // Beyond the edge, or higher than the face has been, the wall counts: also when the punch is withdrawn.
    for x in [Vector3::new(1.01, 0.0, 0.1), Vector3::new(0.99, 0.0, 0.3)] {
        assert_eq!(driven.closest(x, 1e-9).normal, Vector3::x());
    }
    let back = obstacle.over_step(1.0, 0.0);
    let at = back.closest(Vector3::new(0.99, 0.0, 0.3), 1e-9);
    assert_eq!((at.normal, at.gap < 0.0), (Vector3::x(), true));
}

#[test]
fn centres_have_a_definite_finite_normal() {
    let sphere = Shape::Sphere {
        center: Vector3::new(1.0, 2.0, 3.0),
        radius: 2.0,
    };
    let cylinder = Shape::Cylinder {
        point: Vector3::zeros(),
        axis: Vector3::z(),
        radius: 2.0,
    };
    for (shape, x) in [
        (sphere, Vector3::new(1.0, 2.0, 3.0)),
        (cylinder, Vector3::new(0.0, 0.0, 5.0)),
    ] {
        let obstacle = Obstacle::new(shape, Motion::still()).unwrap();
        let at = obstacle.over_step(0.0, 0.0).closest(x, 0.0);
        assert_eq!(at.gap, -2.0);
        assert!((at.normal.norm() - 1.0).abs() < 1e-15);
    }
}

#[test]
fn obstacles_that_leave_the_plane_say_why() {
    let point = Vector3::new(0.5, 0.5, 0.0);
    let z = Vector3::z();
    let plane = |normal| Shape::Plane { point, normal };
    let disc = |height| Shape::Sphere {
        center: Vector3::new(1.0, 2.0, height),
        radius: 1.0,
    };
    let cylinder = |axis| Shape::Cylinder {
        point: Vector3::new(0.0, 0.0, 7.0),
        axis,
        radius: 1.0,
    };
    let wedge = |apex, axis| Shape::Cone {
        apex,
        axis,
        semi_apex_angle: 0.4,
    };
    let strip = |center, axis| Shape::Punch {
        center,
        axis,
        radius: 0.4,
    };
    let reason = |shape, motion| {
        let fault = Obstacle::new(shape, motion).unwrap().validate_in_plane();
        fault.err().map(|fault| fault.to_string())
    };
    let still = Motion::still;
    let accepted = [
        plane(Vector3::new(3.0, 4.0, 0.0)),
        disc(0.0),
        cylinder(Vector3::new(0.0, 0.0, -2.0)),
        wedge(point, Vector3::new(1.0, 2.0, 0.0)),
        strip(point, Vector3::new(1.0, 2.0, 0.0)),
    ];
    let refused = [
        (plane(z), "plane's normal"),
        (plane(Vector3::new(1.0, 0.0, 1e-9)), "plane's normal"),
        (disc(0.1), "sphere's center"),
        (cylinder(Vector3::y()), "cylinder's axis"),
        (cylinder(Vector3::new(0.0, 0.1, 1.0)), "cylinder's axis"),
        (wedge(point, z), "cone's axis"),
        (
            wedge(Vector3::new(0.0, 0.0, 0.1), Vector3::x()),
            "cone's apex",
        ),
        (strip(point, z), "punch's axis"),
        (
            strip(Vector3::new(0.0, 0.0, 0.1), Vector3::x()),
            "punch's center",
        ),
    ];
    for shape in accepted {
        assert_eq!(reason(shape, still()), None);
    }
    for (shape, part) in refused {
        let reason = reason(shape, still()).unwrap();
        assert!(
            reason.contains(part) && reason.contains("plane"),
            "{reason}"
        );
    }
    let turn = |axis: Vector3<f64>| {
        still().with_rotation(Rotation::new(point, axis, Table::constant(0.3)).unwrap())
    };
    let lift = |z| Motion::translation([1.0, 2.0, z].map(Table::constant));
    for motion in [turn(z), turn(Vector3::new(0.0, 0.0, -3.0)), lift(0.0)] {
        assert_eq!(reason(disc(0.0), motion), None);
    }
    for motion in [turn(Vector3::new(0.0, 1.0, 1.0)), lift(0.1)] {
        assert!(reason(disc(0.0), motion).unwrap().contains("motion"));
    }
}
