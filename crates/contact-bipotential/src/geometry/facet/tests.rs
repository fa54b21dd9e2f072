//! Projection against brute force, closed forms and its own optimality conditions.

use super::*;
use proptest::prelude::*;

fn vector(size: f64) -> impl Strategy<Value = Vector3<f64>> {
    prop::array::uniform3(-size..size).prop_map(Vector3::from)
}

/// A unit square or triangle in the plane z = 0, each vertex moved by up to `warp`, seen through a random map.
fn facet(count: usize, warp: f64) -> impl Strategy<Value = Vec<Vector3<f64>>> {
    let moves = prop::collection::vec(vector(warp), count);
    (moves, vector(5.0), vector(1.0), 0.1f64..10.0).prop_map(|(moves, origin, axis, size)| {
        let corners = [
            Vector3::zeros(),
            Vector3::x(),
            Vector3::new(1.0, 1.0, 0.0),
            Vector3::y(),
        ];
        let pick = if moves.len() == 3 {
            [0, 1, 3, 3]
        } else {
            [0, 1, 2, 3]
        };
        (0..moves.len())
            .map(|k| {
                let x = corners[pick[k]] + moves[k];
                origin + size * turn(axis, x)
            })
            .collect()
    })
}

/// Rodrigues rotation by |axis| * pi about `axis`.
fn turn(axis: Vector3<f64>, x: Vector3<f64>) -> Vector3<f64> {
    let Some(k) = unit(axis) else { return x };
    let (s, c) = (axis.norm() * std::f64::consts::PI).sin_cos();
    let along = k.dot(&x) * (1.0 - c) * k;
    c * x + s * k.cross(&x) + along
}

fn size(x: &[Vector3<f64>]) -> f64 {
    (x[1] - x[0]).norm().max((x[2] - x[1]).norm())
}

/// A point at most about one facet size away from the facet.
fn near(x: &[Vector3<f64>], offset: Vector3<f64>) -> Vector3<f64> {
    let centre = x.iter().sum::<Vector3<f64>>() / x.len() as f64;
    centre + size(x) * offset
}

/// Distance by dense sampling with one local refinement.
fn brute_force(x: &[Vector3<f64>], p: Vector3<f64>) -> f64 {
    let n = 30;
    let point = |u: f64, v: f64| {
        let w = if x.len() == 3 {
            // The unit square collapsed on the triangle.
            [1.0 - u, u * (1.0 - v), u * v, 0.0]
        } else {
            [(1.0 - u) * (1.0 - v), u * (1.0 - v), u * v, (1.0 - u) * v]
        };
        (interpolate(x, &w) - p).norm()
    };
    let (mut best, mut at, mut h) = (f64::INFINITY, (0.5, 0.5), 0.5);
    for _ in 0..6 {
        let centre = at;
        for i in 0..=n {
            for j in 0..=n {
                let u = (centre.0 + h * (2.0 * i as f64 / n as f64 - 1.0)).clamp(0.0, 1.0);
                let v = (centre.1 + h * (2.0 * j as f64 / n as f64 - 1.0)).clamp(0.0, 1.0);
                let f = point(u, v);
                if f < best {
                    (best, at) = (f, (u, v));
                }
            }
        }
        h *= 4.0 / n as f64;
    }
    best
}

/// The residual is perpendicular to every direction in which the point could still move.
fn assert_optimal(
    x: &[Vector3<f64>],
    p: Vector3<f64>,
    c: &FacetPoint,
) -> Result<(), TestCaseError> {
    let r = p - c.point;
    let scale_squared = size(x) * (size(x) + r.norm());
    for vertex in x {
        // Straight to a vertex stays inside a triangle; in a quadrilateral, only to first order on the facet.
        let toward = if x.len() == 3 {
            *vertex - c.point
        } else {
            let q = Bilinear::new(&[x[0], x[1], x[2], x[3]], p);
            let k = x.iter().position(|v| v == vertex).unwrap();
            let [du, dv] = {
                let goal = vertex_coordinates(4, k);
                [goal[0] - c.coordinates[0], goal[1] - c.coordinates[1]]
            };
            du * q.d_xi(c.coordinates) + dv * q.d_eta(c.coordinates)
        };
        prop_assert!(
            r.dot(&toward) <= 1e-11 * scale_squared,
            "downhill by {}",
            r.dot(&toward)
        );
    }
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(100))]

    #[test]
    fn projection_is_the_brute_force_minimum(
        x in prop_oneof![facet(4, 0.2), facet(3, 0.2)], offset in vector(1.0),
    ) {
        let p = near(&x, offset);
        let c = closest_point(&x, p);
        let d = c.distance_squared.sqrt();
        let sampled = brute_force(&x, p);
        prop_assert!(d <= sampled * (1.0 + 1e-9) + 1e-12, "{d} above the sampled {sampled}");
        prop_assert!(sampled - d < 1e-3 * size(&x));
        assert_optimal(&x, p, &c)?;
    }

    #[test]
    fn weights_reproduce_the_point_and_sum_to_one(
        x in prop_oneof![facet(4, 0.3), facet(3, 0.3)], offset in vector(2.0),
    ) {
        let p = near(&x, offset);
        let c = closest_point(&x, p);
        prop_assert!(c.weights.iter().all(|w| (0.0..=1.0).contains(w)));
        prop_assert!((c.weights.iter().sum::<f64>() - 1.0).abs() < 1e-15);
        prop_assert!((interpolate(&x, &c.weights) - c.point).norm() < 1e-13 * (size(&x) + c.point.norm()));
        match c.place {
            FacetPlace::Vertex(k) => prop_assert_eq!(c.weights[k as usize], 1.0),
            FacetPlace::Edge(k) => {
                let (k, l) = (k as usize, (k as usize + 1) % x.len());
                for i in (0..4).filter(|i| *i != k && *i != l) {
                    prop_assert_eq!(c.weights[i], 0.0);
                }
                prop_assert!(c.weights[k] > 0.0 && c.weights[l] > 0.0);
            }
            FacetPlace::Interior => prop_assert!(c.weights[..x.len()].iter().all(|w| *w > 0.0)),
        }
    }

    #[test]
    fn a_point_of_the_facet_projects_on_itself(
        x in prop_oneof![facet(4, 0.2), facet(3, 0.2)], u in 0.0f64..1.0, v in 0.0f64..1.0,
    ) {
        let w = if x.len() == 3 {
            [1.0 - u, u * (1.0 - v), u * v, 0.0]
        } else {
            [(1.0 - u) * (1.0 - v), u * (1.0 - v), u * v, (1.0 - u) * v]
        };
        let p = interpolate(&x, &w);
        let c = closest_point(&x, p);
        prop_assert!(c.distance_squared.sqrt() < 4e-15 * (size(&x) + p.norm()));
    }

    #[test]
    fn a_rotated_numbering_changes_nothing(x in facet(4, 0.2), offset in vector(1.0), by in 1usize..4) {
        let p = near(&x, offset);
        let mut y = x.clone();
        y.rotate_left(by);
        let (c, d) = (closest_point(&x, p), closest_point(&y, p));
        prop_assert!((c.distance_squared - d.distance_squared).abs() < 1e-12 * (size(&x) * size(&x)));
    }
}

#[test]
fn degenerate_facets_still_give_finite_points() {
    let p = Vector3::new(0.3, 0.4, 1.0);
    let a = Vector3::zeros();
    let b = Vector3::x();
    let c = Vector3::new(1.0, 1.0, 0.0);
    for facet in [
        &[a, b, c, c][..],
        &[a, a, b, c],
        &[a, a, a, a],
        &[a, b, b],
        &[a, a, a],
        &[a],
    ] {
        let q = closest_point(facet, p);
        assert!(
            q.point.iter().chain(&q.weights).all(|v| v.is_finite()),
            "{facet:?} {q:?}"
        );
    }
    // Two equal vertices make a triangle.
    let q = closest_point(&[a, b, c, c], p);
    let t = closest_point(&[a, b, c], p);
    assert!((q.distance_squared - t.distance_squared).abs() < 1e-12);
}

#[test]
fn clamping_tells_edge_and_vertex() {
    let x = [
        Vector3::zeros(),
        Vector3::new(2.0, 0.0, 0.0),
        Vector3::new(2.0, 2.0, 0.0),
        Vector3::new(0.0, 2.0, 0.0),
    ];
    let place = |p| closest_point(&x, p).place;
    assert_eq!(place(Vector3::new(1.0, 1.0, 3.0)), FacetPlace::Interior);
    assert_eq!(place(Vector3::new(1.0, -1.0, 3.0)), FacetPlace::Edge(0));
    assert_eq!(place(Vector3::new(3.0, 1.0, 3.0)), FacetPlace::Edge(1));
    assert_eq!(place(Vector3::new(1.0, 3.0, 3.0)), FacetPlace::Edge(2));
    assert_eq!(place(Vector3::new(-1.0, 1.0, 3.0)), FacetPlace::Edge(3));
    assert_eq!(place(Vector3::new(3.0, 3.0, 1.0)), FacetPlace::Vertex(2));
    let place = |p| closest_point(&x[..3], p).place;
    assert_eq!(place(Vector3::new(1.5, 0.5, 3.0)), FacetPlace::Interior);
    assert_eq!(place(Vector3::new(0.5, 1.5, 3.0)), FacetPlace::Edge(2));
    assert_eq!(place(Vector3::new(9.0, 2.5, 3.0)), FacetPlace::Vertex(2));
}

#[test]
fn conormals_point_out_of_the_facet() {
    let x = [
        Vector3::zeros(),
        Vector3::new(2.0, 0.0, 0.0),
        Vector3::new(2.0, 2.0, 0.0),
        Vector3::new(0.0, 2.0, 0.0),
    ];
    let expected = [
        Vector3::new(0.0, -1.0, 0.0),
        Vector3::x(),
        Vector3::y(),
        Vector3::new(-1.0, 0.0, 0.0),
    ];
    for k in 0..4 {
        assert!((conormal(&x, k, vertex_coordinates(4, k)) - expected[k]).norm() < 1e-15);
    }
}

fn in_plane(size: f64) -> impl Strategy<Value = Vector3<f64>> {
    (-size..size, -size..size).prop_map(|(x, y)| Vector3::new(x, y, 0.0))
}

fn flat_line() -> impl Strategy<Value = [Vector3<f64>; 2]> {
    let long = |[a, b]: &[Vector3<f64>; 2]| (*a - *b).norm() > 0.1;
    [in_plane(3.0), in_plane(3.0)].prop_filter("needs a length", long)
}

proptest! {
    #[test]
    fn the_closest_point_of_a_line_is_the_brute_force_minimum(
        x in flat_line(), p in in_plane(5.0),
    ) {
        let c = closest_point(&x, p);
        let d = c.distance_squared.sqrt();
        let on_line = |t: f64| x[0] + t * (x[1] - x[0]);
        let sampled = (0..=1000).map(|k| (on_line(f64::from(k) * 1e-3) - p).norm()).fold(f64::INFINITY, f64::min);
        prop_assert!(d <= sampled * (1.0 + 1e-12));
        prop_assert!(sampled - d <= 1e-3 * (x[1] - x[0]).norm());
        let [a, b, ..] = c.weights;
        prop_assert_eq!(c.weights[2..].iter().sum::<f64>(), 0.0);
        prop_assert!(a >= 0.0 && b >= 0.0 && (a + b - 1.0).abs() < 1e-15);
        prop_assert!((a * x[0] + b * x[1] - c.point).norm() < 1e-14);
        prop_assert!(((c.point - p).norm() - d).abs() < 1e-14);
        match c.place {
            FacetPlace::Interior => {
                let m = facet_normal(&x, c.coordinates).unwrap();
                prop_assert!(a > 0.0 && b > 0.0);
                prop_assert!((m.dot(&(p - c.point)).abs() - d).abs() < 1e-13);
            }
            FacetPlace::Vertex(k) => prop_assert_eq!(c.weights[k as usize], 1.0),
            FacetPlace::Edge(_) => prop_assert!(false, "a line has no edges"),
        }
    }
}

#[test]
fn a_line_has_its_body_on_the_left_and_ends_in_points() {
    let x = [Vector3::zeros(), Vector3::new(2.0, 0.0, 0.0)];
    assert_eq!(
        facet_normal(&x, [0.5, 0.0]),
        Some(Vector3::new(0.0, -1.0, 0.0))
    );
    assert_eq!(conormal(&x, 0, [0.0; 2]), Vector3::new(-1.0, 0.0, 0.0));
    assert_eq!(conormal(&x, 1, vertex_coordinates(2, 1)), Vector3::x());
    let place = |p| closest_point(&x, p).place;
    assert_eq!(place(Vector3::new(-1.0, 1.0, 0.0)), FacetPlace::Vertex(0));
    assert_eq!(place(Vector3::new(0.5, -1.0, 0.0)), FacetPlace::Interior);
    assert_eq!(place(Vector3::new(2.5, 0.0, 0.0)), FacetPlace::Vertex(1));
    let collapsed = [x[1], x[1]];
    assert_eq!(closest_point(&collapsed, x[0]).point, x[1]);
    assert_eq!(facet_normal(&collapsed, [0.0; 2]), None);
}
