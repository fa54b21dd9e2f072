//! Obstacles in the plane, ends of chains, ties, the axis of symmetry and what is refused.

use super::*;

proptest! {
    #[test]
    fn obstacles_in_the_plane_have_their_closed_forms(
        x in [-3.0f64..3.0, -3.0f64..3.0], p in [-1.0f64..1.0, -1.0f64..1.0], heading in -3.0f64..3.0,
        radius in 0.1f64..2.0, angle in -3.0f64..3.0, shift in [-1.0f64..1.0, -1.0f64..1.0], depth in -5.0f64..5.0,
    ) {
        let motion = turned(Vector3::z(), angle, Vector3::new(shift[0], shift[1], 0.0));
        let at = motion.position(Vector3::new(p[0], p[1], 0.0), 0.0);
        let (sin, cos) = heading.sin_cos();
        let shapes = [
            Shape::Plane { point: Vector3::new(p[0], p[1], depth), normal: Vector3::new(cos, sin, 0.0) },
            Shape::Sphere { center: Vector3::new(p[0], p[1], 0.0), radius },
            Shape::Cylinder { point: Vector3::new(p[0], p[1], depth), axis: Vector3::new(0.0, 0.0, depth), radius },
        ];
        let arm = Vector3::new(x[0], x[1], 0.0) - at;
        let (sin, cos) = (heading + angle).sin_cos();
        let level = (cos * arm[0] + sin * arm[1], Vector3::new(cos, sin, 0.0));
        let round = (arm.norm() - radius, unit(arm).unwrap());
        for (shape, (gap, normal)) in shapes.into_iter().zip([level, round, round]) {
            let master = Master::Obstacle(Obstacle::new(shape, motion.clone()).unwrap());
            let interface = Interface::new("obstacle", vec![0], vec![1.0], master, 10.0);
            let map = Detector::new(vec![interface], &x, 2, Cone::Planar).unwrap().detect(&x, 0.0, 1.0);
            let c = map.contacts[0];
            prop_assert!((c.gap - gap).abs() < 1e-14, "{shape:?} {} {gap}", c.gap);
            prop_assert!((c.normal() - normal).norm() < 1e-12);
            prop_assert_eq!(c.normal()[2], 0.0);
            prop_assert_eq!(c.frame.column(0), Vector3::new(c.normal()[1], -c.normal()[0], 0.0));
            prop_assert_eq!(c.obstacle_motion[2], 0.0);
        }
    }
}

/// Four edges of length 0.25 along y = 0, the body under them, from x = 1 to x = 0.
fn bench(slaves: &[Point]) -> Chain {
    let points = [1.0, 0.75, 0.5, 0.25, 0.0].map(|x| [x, 0.0]);
    Chain::new(&points, false, slaves, &[])
}

#[test]
fn flush_ends_are_in_contact_and_overhanging_nodes_are_not() {
    for y in [-1e-3, 0.0, 1e-3] {
        for (overhang, expected) in [
            (0.0, 2),
            (1e-12, 2),
            (2e-7, 2),
            (-1e-3, 2),
            (3e-7, 0),
            (1e-3, 0),
        ] {
            let map = bench(&[[-overhang, y], [1.0 + overhang, y]]).detect(0.1);
            assert_eq!(map.len(), expected, "overhang {overhang}");
            for c in &map.contacts {
                assert!((c.gap - y).abs() < 1e-15, "{}", c.gap);
                let axes = [Vector3::x(), -Vector3::z(), Vector3::y()];
                assert_eq!(c.frame, Matrix3::from_columns(&axes));
            }
        }
    }
}

#[test]
fn ties_depths_and_counters_of_a_chain_by_hand() {
    let mut chain = bench(&[
        [0.75, 0.05],
        [0.5, 0.0],
        [0.3, -0.09],
        [0.3, -0.11],
        [0.1, 0.11],
    ]);
    let mut detector = chain.detector(0.1);
    let map = detector.detect(&chain.positions, 0.0, 1.0);
    let found: Vec<(usize, Option<u32>, f64)> = map
        .contacts
        .iter()
        .map(|c| (c.slave_index, c.facet, c.gap))
        .collect();
    assert_eq!(
        found,
        [(0, Some(0), 0.05), (1, Some(1), 0.0), (2, Some(2), -0.09)]
    );
    let counters = detector.counters();
    assert_eq!((counters.box_rejections, counters.bvh_refits), (0, 1));
    assert!((3..=7).contains(&counters.facet_projections));
    // The master rests, moves within the padding, and moves on.
    detector.detect(&chain.positions, 0.0, 1.0);
    for shift in [0.004, 0.5] {
        chain.positions.iter_mut().for_each(|x| *x += shift);
        assert_eq!(detector.detect(&chain.positions, 0.0, 1.0).len(), 3);
    }
    assert_eq!(detector.counters().bvh_refits, 2);

    let far = bench(&[[0.5, 3.0], [0.2, 2.0]]);
    let mut detector = far.detector(0.1);
    assert!(detector.detect(&far.positions, 0.0, 1.0).is_empty());
    let rejected = DetectionCounters {
        box_rejections: 1,
        ..DetectionCounters::default()
    };
    assert_eq!(detector.counters(), rejected);
}

#[test]
fn a_node_at_a_discs_centre_is_pushed_within_the_plane() {
    let disc = Shape::Sphere {
        center: Vector3::zeros(),
        radius: 1.0,
    };
    let rod = Shape::Cylinder {
        point: Vector3::zeros(),
        axis: Vector3::z(),
        radius: 1.0,
    };
    for shape in [disc, rod] {
        let master = Master::Obstacle(Obstacle::new(shape, Motion::still()).unwrap());
        let interface = Interface::new("disc", vec![0], vec![1.0], master, 1.0);
        let x = [0.0, 0.0];
        let c = Detector::new(vec![interface], &x, 2, Cone::Planar)
            .unwrap()
            .detect(&x, 0.0, 1.0)
            .contacts[0];
        assert_eq!((c.gap, c.normal()[2]), (-1.0, 0.0));
        assert_eq!(c.normal().norm(), 1.0);
    }
}

#[test]
fn masters_that_do_not_fit_the_plane_are_refused() {
    let refused = |master: Master, dim: usize| {
        let interface = Interface::new("pair", vec![4], vec![1.0], master, 0.1);
        let error =
            Detector::new(vec![interface], &[0.0; 30], dim, Cone::Frictionless).unwrap_err();
        assert!(error.to_string().contains("pair"), "{error}");
        error.to_string()
    };
    let edges = || Master::Surface(Surface::new(vec![Facet::edge([0, 1])]).unwrap());
    let faces = || Master::Surface(Surface::new(vec![Facet::triangle([0, 1, 2])]).unwrap());
    assert!(refused(edges(), 3).contains("has edges"));
    assert!(refused(faces(), 2).contains("has faces"));
    let floor = Shape::Plane {
        point: Vector3::zeros(),
        normal: Vector3::z(),
    };
    let obstacle = Obstacle::new(floor, Motion::still()).unwrap();
    assert!(refused(Master::Obstacle(obstacle.clone()), 2).contains("plane's normal"));
    let interface = Interface::new("pair", vec![4], vec![1.0], Master::Obstacle(obstacle), 0.1);
    assert!(Detector::new(vec![interface], &[0.0; 30], 3, Cone::Frictionless).is_ok());
}

#[test]
fn a_dome_on_the_axis_of_symmetry_holds_what_is_above_its_pole() {
    // The upper quarter of a disc, from its side to its pole.
    let points = [0.0, 0.25, 0.5, 0.75, 1.0].map(|s: f64| {
        let (sin, cos) = (0.25 * TAU * s).sin_cos();
        [cos, sin - 1.0]
    });
    let heights = [0.05, 0.0, -0.01];
    let chain = Chain::new(&points, false, &heights.map(|y| [0.0, y]), &[]);
    let mut plain = chain.detector(0.1);
    let found: Vec<usize> = plain
        .detect(&chain.positions, 0.0, 1.0)
        .contacts
        .iter()
        .map(|c| c.slave_index)
        .collect();
    assert_eq!(found, [1, 2]);
    let mut detector = chain.detector(0.1).axisymmetric(&chain.positions);
    let map = detector.detect(&chain.positions, 0.0, 1.0);
    assert_eq!(map.len(), 3);
    for (c, y) in map.contacts.iter().zip(heights) {
        assert!((c.gap - y).abs() <= 0.05 * y.abs() + 1e-15, "{}", c.gap);
        assert!((c.normal()[1] - 1.0).abs() < 1e-4);
    }
    for c in &map.contacts[..2] {
        assert_eq!(c.normal(), Vector3::y());
    }
    // The other end is a rim as before.
    let mut beside = chain.clone();
    beside.move_slave(Vector3::new(1.0, -1.05, 0.0));
    let mut detector = beside.detector(0.1).axisymmetric(&beside.positions);
    assert_eq!(detector.detect(&beside.positions, 0.0, 1.0).len(), 2);
}
