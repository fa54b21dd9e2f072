//! Chains of lines in the plane: brute force, continuity, and the operations of `H` on what the search finds.

use std::f64::consts::TAU;

use faer::Mat;

use super::*;
use crate::geometry::facet::facet_normal;
use crate::geometry::kinematics::CompliancePart;

type Point = [f64; 2];

/// A polygon, body on its left, and slaves; node numbers and facet numbers in any order.
#[derive(Clone)]
struct Chain {
    positions: Vec<f64>,
    /// Node of each point of the polygon, then of each slave.
    node: Vec<u32>,
    /// Facets by the polygon's edge that they are: edge `k` starts at point `k`.
    edges: Vec<Facet>,
    /// Facet number of each edge.
    number: Vec<usize>,
    points: usize,
}

impl Chain {
    /// `shuffle` orders nodes and facets: larger keys get larger numbers.
    fn new(points: &[Point], closed: bool, slaves: &[Point], shuffle: &[u32]) -> Self {
        let rank = |n: usize| {
            let key = |k: usize| (shuffle.get(k).copied().unwrap_or(0), k);
            (0..n)
                .map(|k| (0..n).filter(|j| key(*j) < key(k)).count())
                .collect::<Vec<usize>>()
        };
        let all: Vec<Point> = points.iter().chain(slaves).copied().collect();
        let node: Vec<u32> = rank(all.len()).into_iter().map(|k| k as u32).collect();
        let mut positions = vec![0.0; 2 * all.len()];
        for (x, k) in all.iter().zip(&node) {
            positions[2 * *k as usize..][..2].copy_from_slice(x);
        }
        let n = points.len();
        let edges: Vec<Facet> = (0..if closed { n } else { n - 1 })
            .map(|k| Facet::edge([node[k], node[(k + 1) % n]]))
            .collect();
        Self {
            positions,
            node,
            number: rank(edges.len()),
            edges,
            points: n,
        }
    }

    fn slave(&self) -> &[u32] {
        &self.node[self.points..]
    }

    fn detector_with(&self, reach: f64, cone: Cone) -> Detector {
        let mut facets = self.edges.clone();
        for (edge, number) in self.edges.iter().zip(&self.number) {
            facets[*number] = *edge;
        }
        let master = Master::Surface(Surface::new(facets).unwrap());
        let area = vec![1.0; self.slave().len()];
        let interface = Interface::new("chain", self.slave().to_vec(), area, master, reach);
        Detector::new(vec![interface], &self.positions, 2, cone).unwrap()
    }

    fn detector(&self, reach: f64) -> Detector {
        self.detector_with(reach, Cone::Planar)
    }

    fn detect(&self, reach: f64) -> ContactMap {
        self.detector(reach).detect(&self.positions, 0.0, 1.0)
    }

    fn at(&self, node: u32) -> Vector3<f64> {
        at_node(&self.positions, 2, node)
    }

    fn ends(&self, edge: usize) -> [Vector3<f64>; 2] {
        let [a, b, ..] = self.edges[edge].nodes;
        [self.at(a), self.at(b)]
    }

    fn move_slave(&mut self, x: Vector3<f64>) {
        let start = 2 * self.slave()[0] as usize;
        self.positions[start..start + 2].copy_from_slice(&x.as_slice()[..2]);
    }

    /// Closest edge, parameter on it and distance, by Pythagoras.
    fn brute_force(&self, x: Vector3<f64>) -> (usize, f64, f64) {
        let mut best = (0, 0.0, f64::INFINITY);
        for k in 0..self.edges.len() {
            let [a, b] = self.ends(k);
            let (la, lb, l) = ((x - a).norm(), (x - b).norm(), (b - a).norm());
            let t = ((l * l + la * la - lb * lb) / (2.0 * l * l)).clamp(0.0, 1.0);
            let d = (x - (a + t * (b - a))).norm();
            if d < best.2 {
                best = (k, t, d);
            }
        }
        best
    }

    /// Even-odd rule along +x.
    fn is_inside(&self, x: Vector3<f64>) -> bool {
        let crosses = |k: &usize| {
            let [a, b] = self.ends(*k);
            (a[1] > x[1]) != (b[1] > x[1])
                && x[0] < a[0] + (x[1] - a[1]) / (b[1] - a[1]) * (b[0] - a[0])
        };
        (0..self.edges.len()).filter(crosses).count() % 2 == 1
    }

    /// Mean of the normals of the edges at both ends of an edge.
    fn end_normals(&self, edge: usize) -> [Vector3<f64>; 2] {
        let outward = |k: usize| facet_normal(&self.ends(k), [0.5, 0.0]).unwrap();
        self.edges[edge]
            .nodes()
            .iter()
            .fold(Vec::new(), |mut all, node| {
                let sum = (0..self.edges.len())
                    .filter(|k| self.edges[*k].nodes().contains(node))
                    .fold(Vector3::zeros(), |sum, k| sum + outward(k));
                all.push(unit(sum).unwrap());
                all
            })[..]
            .try_into()
            .unwrap()
    }
}

/// A star-shaped polygon about the origin, counter-clockwise.
fn star() -> impl Strategy<Value = Vec<Point>> {
    prop::collection::vec((0.7f64..1.3, 0.0f64..0.5), 4..14).prop_map(|rays| {
        let n = rays.len() as f64;
        rays.iter()
            .enumerate()
            .map(|(k, (r, jitter))| {
                let (sin, cos) = (TAU * (k as f64 + jitter) / n).sin_cos();
                [r * cos, r * sin]
            })
            .collect()
    })
}

/// A graph over [0, 1], the body under it: from right to left, so that the body is on the left.
fn terrain() -> impl Strategy<Value = Vec<Point>> {
    prop::collection::vec(-0.1f64..0.1, 2..9).prop_map(|heights| {
        let n = heights.len() - 1;
        let x = |k: usize| 1.0 - k as f64 / n as f64;
        (0..=n).map(|k| [x(k), heights[k]]).collect()
    })
}

fn slaves(low: f64, high: f64) -> impl Strategy<Value = Vec<Point>> {
    prop::collection::vec([low..high, low..high], 12)
}

fn shuffle() -> impl Strategy<Value = Vec<u32>> {
    prop::collection::vec(any::<u32>(), 30)
}

fn numbers(n: usize) -> impl Strategy<Value = Vec<f64>> {
    prop::collection::vec(-1.0f64..1.0, n)
}

fn moved(positions: &mut [f64], motion: &Motion) {
    for x in positions.chunks_exact_mut(2) {
        x.copy_from_slice(
            &motion
                .position(Vector3::new(x[0], x[1], 0.0), 0.0)
                .as_slice()[..2],
        );
    }
}

/// The matrix of `H`, column by column.
fn dense(map: &ContactMap, unknowns: usize) -> Mat<f64> {
    let mut h = Mat::zeros(map.row_count(), unknowns);
    for j in 0..unknowns {
        let mut u = vec![0.0; unknowns];
        u[j] = 1.0;
        let mut x = vec![0.0; map.row_count()];
        map.apply(&u, &mut x);
        for (i, x) in x.iter().enumerate() {
            h[(i, j)] = *x;
        }
    }
    h
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(100))]

    #[test]
    fn a_closed_polygon_has_the_signed_distance_of_brute_force(
        points in star(), slaves in slaves(-1.6, 1.6), shuffle in shuffle(),
    ) {
        let chain = Chain::new(&points, true, &slaves, &shuffle);
        let reach = 0.5;
        let map = chain.detect(reach);
        let mut found = map.contacts.iter().peekable();
        for (k, node) in chain.slave().iter().enumerate() {
            let x = chain.at(*node);
            let (edge, t, least) = chain.brute_force(x);
            let Some(c) = found.next_if(|c| c.slave_index == k) else {
                prop_assert!(least > reach);
                continue;
            };
            prop_assert!(least <= reach);
            prop_assert!((c.gap.abs() - least).abs() < 1e-14);
            prop_assert_eq!(c.gap < 0.0, chain.is_inside(x));
            // Point and normal, where no other edge is equally close.
            let [a, b] = chain.ends(edge);
            let at = a + t * (b - a);
            let master = c.stencil.iter().skip(1).fold(Vector3::zeros(), |s, (n, w)| s - w * chain.at(n));
            prop_assert!((master - at).norm() < 1e-7 || c.facet != Some(chain.number[edge] as u32));
            let [na, nb] = chain.end_normals(edge);
            let normal = unit(na + t * (nb - na)).unwrap();
            prop_assert!((c.normal() - normal).norm() < 1e-6 || c.facet != Some(chain.number[edge] as u32));
            prop_assert!(c.stencil.weights().iter().sum::<f64>().abs() < 1e-15);
            let n = c.normal();
            prop_assert_eq!(c.frame.column(0), Vector3::new(n[1], -n[0], 0.0));
            prop_assert_eq!(n[2], 0.0);
            // The lower of two facets that share the closest vertex.
            let touching = c.stencil.nodes();
            if touching.len() == 2 {
                let lowest = (0..chain.edges.len())
                    .filter(|e| chain.edges[*e].nodes().contains(&touching[1]))
                    .map(|e| chain.number[e] as u32)
                    .min();
                prop_assert_eq!(c.facet, lowest);
            }
        }
        prop_assert!(found.next().is_none());
    }

    #[test]
    fn an_open_chain_holds_what_is_above_or_below_it(
        points in terrain(), slaves in prop::collection::vec([-0.3f64..1.3, -0.3f64..0.3], 12), shuffle in shuffle(),
    ) {
        let chain = Chain::new(&points, false, &slaves, &shuffle);
        let reach = 0.2;
        let map = chain.detect(reach);
        let mut found = map.contacts.iter().peekable();
        let last = chain.edges.len() - 1;
        for (k, node) in chain.slave().iter().enumerate() {
            let x = chain.at(*node);
            let (edge, t, least) = chain.brute_force(x);
            let past_the_end = (edge, t) == (0, 0.0) || (edge, t) == (last, 1.0);
            let found = found.next_if(|c| c.slave_index == k);
            prop_assert_eq!(found.is_some(), least <= reach && !past_the_end, "{:?} {}", x, least);
            if let Some(c) = found && (0.0..1.0).contains(&x[0]) {
                prop_assert!((c.gap.abs() - least).abs() < 1e-14);
                let n = points.len() - 1;
                let s = (1.0 - x[0]) * n as f64;
                let left = (s as usize).min(n - 1);
                let ground = points[left][1] + (s - left as f64) * (points[left + 1][1] - points[left][1]);
                prop_assert_eq!(c.gap > 0.0, x[1] > ground);
            }
        }
    }

    #[test]
    fn gap_and_normal_are_continuous_along_a_polygon(
        points in star(), shuffle in shuffle(), height in prop_oneof![Just(0.0), -0.2f64..0.2],
    ) {
        let mut chain = Chain::new(&points, true, &[[0.0; 2]], &shuffle);
        let mut detector = chain.detector(0.5);
        let mut before: Option<(Vector3<f64>, Contact)> = None;
        let mut facets = Vec::new();
        for edge in (0..points.len()).chain([0]) {
            let ([a, b], [na, nb]) = (chain.ends(edge), chain.end_normals(edge));
            // The direction of a blend of two unit vectors turns at most this fast.
            let rate = (nb - na).norm() / (0.5 * (1.0 + na.dot(&nb))).sqrt();
            let steps = 100;
            for k in 0..=steps {
                let t = f64::from(k) / f64::from(steps);
                let n = unit(na + t * (nb - na)).unwrap();
                let x = a + t * (b - a) + height * n;
                chain.move_slave(x);
                let map = detector.detect(&chain.positions, 0.0, 1.0);
                prop_assert_eq!(map.len(), 1);
                let c = map.contacts[0];
                prop_assert!(height != 0.0 || c.gap.abs() < 1e-15);
                if let Some((last, from)) = before {
                    prop_assert!((c.gap - from.gap).abs() <= (x - last).norm() + 1e-15);
                    if height == 0.0 {
                        let turn = (c.normal() - from.normal()).norm();
                        prop_assert!(turn <= 1.0001 * rate / f64::from(steps) + 1e-13, "{turn}");
                        prop_assert!(((c.frame.column(0) - from.frame.column(0)).norm() - turn).abs() < 1e-15);
                    }
                }
                facets.extend(c.facet);
                before = Some((x, c));
            }
        }
        facets.sort_unstable();
        facets.dedup();
        prop_assert!(height != 0.0 || facets.len() == points.len());
    }

    #[test]
    fn rigid_motions_take_the_contacts_along(
        points in star(), slaves in slaves(-1.5, 1.5), angle in -3.0f64..3.0, shift in [-3.0f64..3.0, -3.0f64..3.0],
        u in numbers(60),
    ) {
        let mut chain = Chain::new(&points, true, &slaves, &[]);
        let motion = turned(Vector3::z(), angle, Vector3::new(shift[0], shift[1], 0.0));
        let turn = turned(Vector3::z(), angle, Vector3::zeros());
        let mut detector = chain.detector(0.5);
        let before = detector.detect(&chain.positions, 0.0, 1.0);
        moved(&mut chain.positions, &motion);
        let after = detector.detect(&chain.positions, 0.0, 1.0);
        prop_assert_eq!(before.len(), after.len());
        let u = &u[..chain.positions.len()];
        let mut v = u.to_vec();
        for x in v.chunks_exact_mut(2) {
            x.copy_from_slice(&turn.rotate(Vector3::new(x[0], x[1], 0.0), 0.0).as_slice()[..2]);
        }
        let (mut x, mut y) = (vec![0.0; before.row_count()], vec![0.0; after.row_count()]);
        before.apply(u, &mut x);
        after.apply(&v, &mut y);
        for (k, (a, b)) in before.contacts.iter().zip(&after.contacts).enumerate() {
            prop_assert!((a.gap - b.gap).abs() < 1e-14);
            if a.facet == b.facet {
                for i in 0..3 {
                    prop_assert!((motion.rotate(a.frame.column(i).into(), 0.0) - b.frame.column(i)).norm() < 1e-12);
                }
                prop_assert!((x[2 * k] - y[2 * k]).abs() + (x[2 * k + 1] - y[2 * k + 1]).abs() < 1e-12);
            }
        }
    }

    #[test]
    fn the_order_of_nodes_and_facets_does_not_matter(
        points in star(), slaves in slaves(-1.5, 1.5), shuffle in shuffle(),
    ) {
        let (plain, mixed) = (Chain::new(&points, true, &slaves, &[]), Chain::new(&points, true, &slaves, &shuffle));
        let (a, b) = (plain.detect(0.4), mixed.detect(0.4));
        prop_assert_eq!(a.len(), b.len());
        for (a, b) in a.contacts.iter().zip(&b.contacts) {
            prop_assert_eq!(a.slave_index, b.slave_index);
            prop_assert_eq!(a.gap, b.gap);
            prop_assert_eq!(a.frame, b.frame);
            let renamed: Vec<(u32, f64)> = a.stencil.iter().map(|(n, w)| (mixed.node[n as usize], w)).collect();
            prop_assert_eq!(renamed, b.stencil.iter().collect::<Vec<_>>());
        }
    }

    #[test]
    fn h_its_transpose_and_w_agree_with_dense_matrices(
        points in star(), slaves in slaves(-1.5, 1.5), shuffle in shuffle(), values in numbers(97), r in numbers(24),
        keep in prop::collection::vec(prop::bool::weighted(0.8), 60), frictionless in any::<bool>(),
    ) {
        let chain = Chain::new(&points, true, &slaves, &shuffle);
        let cone = if frictionless { Cone::Frictionless } else { Cone::Planar };
        let map = chain.detector_with(0.4, cone).detect(&chain.positions, 0.0, 1.0);
        let (n, rows) = (chain.positions.len(), map.row_count());
        prop_assert_eq!(rows, map.len() * cone.dim());
        let h = dense(&map, n);
        for (k, c) in map.contacts.iter().enumerate() {
            // The last row of a contact from its definition: the normal at the slave and, weighted, at the master.
            let row = cone.dim() * (k + 1) - 1;
            for i in 0..2 {
                prop_assert_eq!(h[(row, 2 * c.slave as usize + i)], c.normal()[i]);
                let all: f64 = (0..n / 2).map(|node| h[(row, 2 * node + i)]).sum();
                prop_assert!(all.abs() < 1e-15);
            }
        }
        let mut f = vec![0.0; n];
        map.apply_transpose(&r[..rows], &mut f);
        for (j, f) in f.iter().enumerate() {
            let expected: f64 = (0..rows).map(|i| h[(i, j)] * r[i]).sum();
            prop_assert!((f - expected).abs() < 1e-13);
        }

        let kept: Vec<usize> = (0..n).filter(|dof| keep[*dof]).collect();
        let mut offset = vec![u32::MAX; n];
        kept.iter().enumerate().for_each(|(row, dof)| offset[*dof] = row as u32);
        let c = Mat::from_fn(kept.len(), kept.len(), |i, j| values[(i.max(j) * 31 + i.min(j)) % 97]);
        let mut w = Mat::zeros(0, 0);
        map.delassus(&[CompliancePart::new(offset, c.clone()).unwrap()], &mut w);
        let hk = Mat::from_fn(rows, kept.len(), |i, j| h[(i, kept[j])]);
        let expected = &hk * &c * hk.transpose();
        prop_assert_eq!((w.nrows(), w.ncols()), (rows, rows));
        for i in 0..rows {
            for j in 0..rows {
                prop_assert!((w[(i, j)] - expected[(i, j)]).abs() < 1e-12);
            }
        }
    }

    #[test]
    fn on_a_straight_chain_the_gaps_derivative_is_the_normal_row(
        x in [0.11f64..0.89, -0.1f64..0.1], angle in -3.0f64..3.0, direction in numbers(14),
    ) {
        let points = [0, 1, 2, 3, 4, 5].map(|k| [1.0 - 0.2 * f64::from(k), 0.0]);
        let mut chain = Chain::new(&points, false, &[x], &[]);
        moved(&mut chain.positions, &turned(Vector3::z(), angle, Vector3::new(0.3, -0.2, 0.0)));
        let mut detector = chain.detector(0.3);
        let map = detector.detect(&chain.positions, 0.0, 1.0);
        prop_assert_eq!(map.len(), 1);
        prop_assert!((map.contacts[0].gap - x[1]).abs() < 1e-15);
        prop_assume!(map.contacts[0].stencil.weights()[1..].iter().all(|w| *w < -1e-3));
        let mut change = [0.0; 2];
        map.apply(&direction, &mut change);
        let h = 1e-6;
        let mut gap = |s: f64| {
            let moved: Vec<f64> = chain.positions.iter().zip(&direction).map(|(x, d)| x + s * d).collect();
            detector.detect(&moved, 0.0, 1.0).contacts[0].gap
        };
        let difference = (gap(h) - gap(-h)) / (2.0 * h);
        prop_assert!((difference - change[1]).abs() < 1e-7, "{difference} {}", change[1]);
    }
}

mod cases;
