//! Rims, depths, ties, counters, obstacles and refused interfaces, each by hand.

use super::*;

#[test]
fn flush_sides_are_in_contact_and_overhanging_nodes_are_not() {
    let rim = |d: f64| {
        let z = 0.0;
        [
            [0.2, -d, z],
            [-d, 0.3, z],
            [1.0 + d, 0.5, z],
            [0.7, 1.0 + d, z],
            [1.0 + d, 1.0 + d, z],
            [-d, -d, z],
        ]
    };
    for triangles in [false, true] {
        for z in [-1e-3, 0.0, 1e-3] {
            for (overhang, expected) in [(0.0, 6), (1e-12, 6), (1e-9, 6), (-1e-3, 6)] {
                let slaves = rim(overhang).map(|x| [x[0], x[1], z]);
                let map = grid(4, 3, triangles, flat, &slaves).detect(0.1);
                assert_eq!(map.len(), expected, "overhang {overhang}");
                for c in &map.contacts {
                    assert!((c.gap - z).abs() < 1e-15, "{}", c.gap);
                    assert_eq!(c.normal(), Vector3::z());
                }
            }
            // Beyond the tolerance nothing holds a node, above or below the level of the surface.
            let slaves = rim(1e-4).map(|x| [x[0], x[1], z]);
            let map = grid(4, 3, triangles, flat, &slaves).detect(0.1);
            assert_eq!(map.len(), 0);
        }
    }
}

/// Past a corner that is not square what a node overhangs one rim by is partly overhang of the other, none of it a gap.
#[test]
fn the_gap_over_a_skew_corner_is_that_along_the_normal() {
    let skew = |u: f64, v: f64| [u + 0.3 * v, v, 0.0];
    for z in [0.0, 1e-7, -1e-7] {
        let scene = grid(3, 3, false, skew, &[[1.3 + 4e-7, 1.0 + 4e-7, z]]);
        let map = scene.detect(0.1);
        assert_eq!(map.len(), 1);
        assert!(
            (map.contacts[0].gap - z).abs() < 1e-20,
            "{:e}",
            map.contacts[0].gap
        );
    }
}

#[test]
fn a_slab_on_a_ridge_keeps_its_rim_nodes() {
    // A half cylinder one facet thick, as in plane strain: every node lies on the rim, above convex ridges too.
    let arch = |u: f64, v: f64| {
        let a = std::f64::consts::PI * (1.0 - u);
        [a.cos(), v, a.sin()]
    };
    let directions = [0.25, 0.31, 0.5, 0.625, 0.7];
    for height in [-0.01, 0.0, 0.01] {
        let slaves: Vec<Point3> = directions
            .iter()
            .flat_map(|u| {
                [0.0, 1.0].map(|v| {
                    let x = arch(*u, v);
                    [(1.0 + height) * x[0], x[1], (1.0 + height) * x[2]]
                })
            })
            .collect();
        let map = grid(8, 1, false, arch, &slaves).detect(0.2);
        assert_eq!(map.len(), slaves.len(), "height {height}");
        for (c, x) in map.contacts.iter().zip(&slaves) {
            assert!(c.normal()[1].abs() < 1e-15);
            // The chords lie up to 0.02 inside the circle.
            assert!(
                c.gap > height - 1e-12 && c.gap < height + 0.02,
                "{} at {x:?}",
                c.gap
            );
        }
    }
}

#[test]
fn far_and_deep_nodes_are_no_contacts() {
    let slaves = [
        [0.5, 0.5, 0.1],
        [0.5, 0.5, 0.11],
        [0.5, 0.5, -0.1],
        [0.5, 0.5, -0.11],
        [0.5, 0.5, 0.05],
    ];
    let map = grid(3, 3, false, flat, &slaves).detect(0.105);
    let found: Vec<usize> = map.contacts.iter().map(|c| c.slave_index).collect();
    assert_eq!(found, [0, 2, 4]);
    assert!(map.contacts[1].gap < 0.0);
}

#[test]
fn ties_go_to_the_lowest_facet() {
    // A vertex of four facets, an edge of two, and a node between two parallel sheets' worth of edges.
    let slaves = [
        [0.5, 0.5, 0.05],
        [0.5, 0.25, 0.0],
        [0.25, 0.5, -0.05],
        [0.5, 0.5, 0.0],
    ];
    let map = grid(2, 2, false, flat, &slaves).detect(0.1);
    let facets: Vec<u32> = map.contacts.iter().filter_map(|c| c.facet).collect();
    assert_eq!(facets, [0, 0, 0, 0]);
}

#[test]
fn the_box_test_ends_a_search_without_neighbours() {
    let mut scene = grid(4, 4, false, flat, &[[0.5, 0.5, 3.0], [0.2, 0.5, 2.0]]);
    let mut detector = scene.detector(0.1);
    assert!(detector.detect(&scene.positions, 0.0, 1.0).is_empty());
    assert_eq!(
        detector.counters(),
        DetectionCounters {
            box_rejections: 1,
            bvh_refits: 0,
            facet_projections: 0
        }
    );
    scene.move_slave(0, [0.55, 0.55, 0.05]);
    assert_eq!(detector.detect(&scene.positions, 0.0, 1.0).len(), 1);
    let counters = detector.counters();
    assert_eq!((counters.box_rejections, counters.bvh_refits), (1, 1));
    assert!(counters.facet_projections >= 1 && counters.facet_projections <= 4);
    // The master rests: no refit. It moves within the padding: none either. It moves on: one.
    detector.detect(&scene.positions, 0.0, 1.0);
    for shift in [0.004, 0.5] {
        for x in scene.positions.iter_mut() {
            *x += shift;
        }
        detector.detect(&scene.positions, 0.0, 1.0);
    }
    assert_eq!(detector.counters().bvh_refits, 2);
}

#[test]
fn order_and_bits_do_not_depend_on_threads() {
    let slaves: Vec<Point3> = (0..1000)
        .map(|k| {
            let k = f64::from(k);
            [
                (k * 0.618).fract(),
                (k * 0.414).fract(),
                0.2 * (k * 0.732).fract() - 0.1,
            ]
        })
        .collect();
    let scene = grid(20, 20, false, wavy(0.03, 0.4), &slaves);
    let of = |threads| {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .unwrap();
        pool.install(|| {
            let mut detector = scene.detector(0.05);
            (
                detector.detect(&scene.positions, 0.0, 1.0),
                detector.counters(),
            )
        })
    };
    let one = of(1);
    assert!(one.0.len() > 300);
    assert!(
        one.0
            .contacts
            .windows(2)
            .all(|pair| pair[0].slave_index < pair[1].slave_index)
    );
    assert_eq!(one, of(2));
    assert_eq!(one, of(8));
}

#[test]
fn obstacles_move_and_hold_at_any_depth() {
    let ramp = |v| Table::new(vec![(0.0, 0.0), (1.0, v)], Interpolation::Linear).unwrap();
    let plane = Shape::Plane {
        point: Vector3::zeros(),
        normal: Vector3::new(0.0, 0.0, 2.0),
    };
    let conveyor = Motion::translation([ramp(3.0), ramp(0.0), ramp(1.0)]);
    let obstacle = Obstacle::new(plane, conveyor).unwrap();
    let interface = Interface::new(
        "plane",
        vec![2, 0, 1],
        vec![1.0; 3],
        Master::Obstacle(obstacle),
        0.5,
    );
    let positions = [0.0, 0.0, 0.25, 1.0, 0.0, 9.0, 2.0, 0.0, -50.0];
    let mut detector = Detector::new(vec![interface], &positions, 3, Cone::Spatial).unwrap();
    let map = detector.detect(&positions, 0.25, 0.5);
    // Slave order, not node order; node 1 is far above, node 2 far below.
    let found: Vec<(u32, usize, f64)> = map
        .contacts
        .iter()
        .map(|c| (c.slave, c.slave_index, c.gap))
        .collect();
    assert_eq!(found, [(2, 0, -50.5), (0, 1, -0.25)]);
    for c in &map.contacts {
        assert_eq!(c.frame, Matrix3::identity());
        assert!((c.obstacle_motion - Vector3::new(0.75, 0.0, 0.25)).norm() < 1e-15);
        assert_eq!((c.facet, c.stencil.nodes()), (None, &[c.slave][..]));
    }
    // Two nodes at rest on a belt that runs along +x slip along -x.
    let mut slip = [0.0; 6];
    map.slip_offsets(&mut slip);
    assert!((slip[0] + 0.75).abs() < 1e-15 && slip[1] == 0.0);
}

#[test]
fn a_turning_plane_keeps_its_frame() {
    let spin = Table::new(vec![(0.0, 0.0), (1.0, 2.0)], Interpolation::Linear).unwrap();
    let turn = Rotation::new([0.0; 3], [0.0, 0.0, 1.0], spin).unwrap();
    let motion = Motion::still().with_rotation(turn);
    let plane = Shape::Plane {
        point: Vector3::zeros(),
        normal: Vector3::z(),
    };
    let obstacle = Obstacle::new(plane, motion).unwrap();
    let interface = Interface::new("disc", vec![0], vec![1.0], Master::Obstacle(obstacle), 0.5);
    let positions = [1.0, 0.0, 0.0];
    let mut detector = Detector::new(vec![interface], &positions, 3, Cone::Spatial).unwrap();
    for t in [0.1, 0.5, 0.9] {
        let c = detector.detect(&positions, t - 0.05, t).contacts[0];
        assert_eq!(c.frame, Matrix3::identity());
        // The chord of an arc of 0.1 rad that ends at (1, 0).
        assert!((c.obstacle_motion.norm() - 2.0 * 0.05f64.sin()).abs() < 1e-15);
        assert!(c.obstacle_motion[1] > 0.0 && c.obstacle_motion[0] > 0.0);
        assert!(c.obstacle_motion.dot(&c.normal()).abs() < 1e-16);
    }
}

#[test]
fn plane_problems_have_two_rows() {
    let floor = Shape::Plane {
        point: Vector3::zeros(),
        normal: Vector3::y(),
    };
    let obstacle = Obstacle::new(floor, Motion::still()).unwrap();
    let interface = Interface::new("floor", vec![1], vec![1.0], Master::Obstacle(obstacle), 0.5);
    let positions = [5.0, 5.0, 0.3, 0.1];
    let mut detector = Detector::new(vec![interface], &positions, 2, Cone::Planar).unwrap();
    let map = detector.detect(&positions, 0.0, 1.0);
    let mut x = [0.0; 2];
    map.apply(&[0.0, 0.0, 2.0, 3.0], &mut x);
    assert_eq!(x, [2.0, 3.0]);
}

#[test]
fn interfaces_that_make_no_sense_are_refused() {
    let scene = grid(2, 2, false, flat, &[[0.5, 0.5, 0.1]]);
    let master = || Master::Surface(Surface::new(scene.facets.clone()).unwrap());
    let good = || Interface::new("pair", scene.slave.clone(), vec![1.0], master(), 0.1);
    let refused = |interface: Interface| {
        let error = Detector::new(vec![interface], &scene.positions, 3, Cone::Spatial).unwrap_err();
        assert!(error.to_string().contains("pair"), "{error}");
    };
    refused(Interface { mu: -0.1, ..good() });
    refused(Interface {
        mu: f64::NAN,
        ..good()
    });
    refused(Interface {
        restitution: 1.1,
        ..good()
    });
    refused(Interface {
        search_distance: 0.0,
        ..good()
    });
    refused(Interface {
        rim_tolerance: -1.0,
        ..good()
    });
    refused(Interface {
        slave: vec![],
        area: vec![],
        ..good()
    });
    refused(Interface {
        area: vec![],
        ..good()
    });
    refused(Interface {
        area: vec![-1.0],
        ..good()
    });
    refused(Interface {
        slave: vec![10],
        ..good()
    });
    refused(Interface {
        slave: vec![4],
        ..good()
    });
    let new = |dim, cone| Detector::new(vec![good()], &scene.positions, dim, cone);
    assert!(new(3, Cone::Spatial).is_ok());
    assert!(new(3, Cone::Frictionless).is_ok());
    assert!(new(3, Cone::Planar).is_err());
    assert!(new(2, Cone::Planar).is_err());
    assert!(new(4, Cone::Spatial).is_err());
}

#[test]
fn the_gap_does_not_jump_where_the_closest_point_crosses_a_valley() {
    // Slopes of 45 and 17 degrees: high above the valley the closest point leaps from one side to the other.
    let valley = |u: f64, v: f64| [u, v, if u < 0.5 { 0.5 - u } else { 0.3 * (u - 0.5) }];
    let mut scene = grid(4, 2, false, valley, &[[0.0; 3]]);
    let mut detector = scene.detector(0.3);
    let step = 1e-5;
    let (mut before, mut leaps) = (None::<Contact>, 0);
    for k in 0..20_000 {
        scene.move_slave(0, [0.45 + step * f64::from(k), 0.3, 0.25]);
        let c = detector.detect(&scene.positions, 0.0, 1.0).contacts[0];
        if let Some(last) = before {
            assert!(
                (c.gap - last.gap).abs() <= 1.0001 * step,
                "{} -> {}",
                last.gap,
                c.gap
            );
            leaps += usize::from((c.normal() - last.normal()).norm() > 100.0 * step);
        }
        before = Some(c);
    }
    assert_eq!(leaps, 1);
}
