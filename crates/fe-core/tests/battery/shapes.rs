//! Discs, rings, balls and their halves.

use std::collections::BTreeSet;
use std::f64::consts::{FRAC_PI_2, PI, TAU};

use fe_core::{
    AnnulusMesh, CellKind, DiscMesh, Facet, HalfBallMesh, HalfDiscMesh, Mesh, Pole,
    QuarterDiscMesh, RectangleMesh, Surface, Symmetry,
};
use nalgebra::Vector3;
use proptest::prelude::*;

use crate::common::{PLANE_KINDS, blatz_ko, solid};

const CELLS: [usize; 7] = [1, 2, 3, 4, 5, 6, 32];
const CENTER: [f64; 2] = [2.5, -1.5];
const RADIUS: f64 = 0.75;

fn disc(cells: usize, kind: CellKind) -> Mesh {
    let shape = DiscMesh {
        center: CENTER,
        radius: RADIUS,
        cells,
        kind,
    };
    shape.generate("disc").unwrap()
}

fn half_disc(cells: usize, pole: Pole) -> Mesh {
    let shape = HalfDiscMesh {
        center: CENTER,
        radius: RADIUS,
        cells,
        pole,
        kind: CellKind::Quad4,
    };
    shape.generate("half").unwrap()
}

fn quarter_disc(cells: usize, pole: Pole) -> Mesh {
    let shape = QuarterDiscMesh {
        center: CENTER,
        radius: RADIUS,
        cells,
        pole,
        kind: CellKind::Quad4,
    };
    shape.generate("quarter").unwrap()
}

fn annulus(cells: [usize; 2], grading: f64) -> Mesh {
    let shape = AnnulusMesh {
        center: CENTER,
        inner: 0.5,
        outer: RADIUS,
        cells,
        grading,
        kind: CellKind::Quad4,
    };
    shape.generate("ring").unwrap()
}

fn half_ball(cells: usize, pole: Pole) -> Mesh {
    let shape = HalfBallMesh {
        center: Vector3::new(2.5, -1.5, 0.5),
        radius: RADIUS,
        cells,
        pole,
        kind: CellKind::Hex8,
    };
    shape.generate("ball").unwrap()
}

fn triple(a: Vector3<f64>, b: Vector3<f64>, c: Vector3<f64>) -> f64 {
    a.dot(&b.cross(&c))
}

/// Smallest over all corners of all cells of the determinant of the unit vectors along the edges there, counted in the
/// cell's sense: 1 for a right angle, negative for a corner that is turned inside out.
fn worst_corner(mesh: &Mesh) -> f64 {
    let block = &mesh.blocks[0];
    let mut worst = f64::INFINITY;
    for cell in block.iter() {
        let x = |a: usize| mesh.points[cell[a] as usize];
        let along = |from: usize, to: usize| (x(to) - x(from)).normalize();
        let n = block.kind.node_count();
        for a in 0..n {
            let volume = if block.kind == CellKind::Hex8 {
                let (base, up) = (a / 4 * 4, (a + 4) % 8);
                let (next, previous) = (base + (a + 1) % 4, base + (a + 3) % 4);
                let volume = triple(along(a, next), along(a, previous), along(a, up));
                if base == 0 { volume } else { -volume }
            } else {
                triple(
                    along(a, (a + 1) % n),
                    along(a, (a + n - 1) % n),
                    Vector3::z(),
                )
            };
            worst = worst.min(volume);
        }
    }
    worst
}

/// Area or volume from the facets: `dim V = sum of x . n dA`.
fn enclosed(mesh: &Mesh, facets: &[Facet]) -> f64 {
    let x = |n: u32| mesh.points[n as usize];
    let flux = |facet: &Facet| match *facet.nodes() {
        [a, b] => triple(x(a), x(b), Vector3::z()) / 2.0,
        [a, b, c, d] => {
            // A bilinear patch encloses the mean of its two ways to be cut.
            let cut = |a, b, c| triple(x(a), x(b), x(c)) / 12.0;
            cut(a, b, c) + cut(a, c, d) + cut(a, b, d) + cut(b, c, d)
        }
        _ => panic!("{facet:?}"),
    };
    facets
        .iter()
        .flat_map(Facet::pieces)
        .map(|f| flux(&f))
        .sum()
}

/// Valid, with good corners, and closed by the facets of its sides, which point outward.
fn check(mesh: &Mesh, sides: &[&str]) {
    mesh.validate().unwrap();
    let bound = if mesh.blocks[0].kind == CellKind::Tri3 {
        0.2
    } else {
        0.6
    };
    assert!(worst_corner(mesh) > bound, "{}", worst_corner(mesh));
    assert_eq!(mesh.node_sets["all"].len(), mesh.points.len());
    let boundary: BTreeSet<Facet> = mesh.boundary_facets().into_iter().collect();
    let mut covered = BTreeSet::new();
    for side in sides {
        let facets = &mesh.facet_sets[*side];
        assert!(facets.iter().all(|f| covered.insert(*f)), "{side} overlaps");
        assert_eq!(
            Surface::new(facets.clone()).unwrap().nodes,
            mesh.node_sets[*side]
        );
    }
    assert_eq!(boundary, covered);
    assert_eq!(mesh.facet_sets.len(), sides.len());
    let solid = solid(mesh.clone(), blatz_ko(), 1.0);
    let volume = solid.consistent_mass().total();
    let found = enclosed(mesh, &boundary.into_iter().collect::<Vec<_>>());
    assert!(
        (found - volume).abs() < 1e-12 * (1.0 + volume),
        "{found} {volume}"
    );
}

/// Nodes of a set lie on a circle around the centre, in equal steps of the angle, which is counted towards `up`.
fn check_rim(mesh: &Mesh, set: &str, (radius, up): (f64, f64), steps: usize, step: f64) {
    let mut angles = Vec::new();
    for &n in mesh.node_set(set).unwrap() {
        let d = mesh.points[n as usize] - Vector3::new(CENTER[0], CENTER[1], 0.0);
        assert!((d[0].hypot(d[1]) - radius).abs() < 1e-15);
        angles.push((up * d[1] + 0.0).atan2(d[0]));
    }
    angles.sort_by(f64::total_cmp);
    let closed = (steps as f64 * step - TAU).abs() < 1e-12;
    assert_eq!(angles.len(), steps + usize::from(!closed));
    for pair in angles.windows(2) {
        assert!((pair[1] - pair[0] - step).abs() < 2e-14);
    }
}

/// The volume approaches the exact one with the square of the size.
fn check_slope(exact: f64, volume: impl Fn(usize) -> f64) {
    let errors = [8, 16, 32].map(|n| exact - volume(n));
    assert!(errors[2] > 0.0, "{errors:?}");
    for pair in errors.windows(2) {
        let slope = (pair[0] / pair[1]).log2();
        assert!((slope - 2.0).abs() < 0.1, "{errors:?}");
    }
}

fn volume(mesh: Mesh) -> f64 {
    solid(mesh, blatz_ko(), 1.0).lumped_mass().total()
}

#[test]
fn discs() {
    for cells in CELLS {
        for kind in [CellKind::Quad4, CellKind::Tri3] {
            let mesh = disc(cells, kind);
            check(&mesh, &["rim"]);
            check_rim(
                &mesh,
                "rim",
                (RADIUS, 1.0),
                4 * cells,
                FRAC_PI_2 / cells as f64,
            );
            assert_eq!(mesh.symmetry, Symmetry::PlaneStrain);
            let [node] = mesh.node_sets["center"][..] else {
                panic!("one node");
            };
            let x = mesh.points[node as usize];
            let off = (x[0] - CENTER[0]).hypot(x[1] - CENTER[1]);
            let bound = if cells % 2 == 0 {
                1e-15
            } else {
                0.7 * RADIUS / cells as f64
            };
            assert!(off <= bound, "{cells}: {off}");
        }
    }
    let exact = PI * RADIUS * RADIUS;
    check_slope(exact, |n| volume(disc(n, CellKind::Quad4)));
    check_slope(exact, |n| volume(disc(n, CellKind::Tri3)));
}

#[test]
fn half_and_quarter_discs() {
    for cells in CELLS {
        let even = cells.next_multiple_of(2);
        let step = FRAC_PI_2 / even as f64;
        for (pole, sign) in [(Pole::Up, 1.0), (Pole::Down, -1.0)] {
            let half = half_disc(cells, pole);
            check(&half, &["dome", "base"]);
            let quarter = quarter_disc(cells, pole);
            check(&quarter, &["dome", "base", "axis"]);
            check_rim(&half, "dome", (RADIUS, sign), 2 * even, step);
            check_rim(&quarter, "dome", (RADIUS, sign), even, step);
            for mesh in [&half, &quarter] {
                let top = mesh.points.iter().map(|x| sign * (x[1] - CENTER[1]));
                assert!(top.clone().all(|h| (0.0..=RADIUS).contains(&h)));
                assert_eq!(top.fold(0.0, f64::max), RADIUS);
                let base = mesh.node_set("base").unwrap();
                assert!(
                    base.iter()
                        .all(|&n| mesh.points[n as usize][1] == CENTER[1])
                );
            }
            let axis = quarter.node_set("axis").unwrap();
            assert!(
                axis.iter()
                    .all(|&n| quarter.points[n as usize][0] == CENTER[0])
            );
            assert!(quarter.points.iter().all(|x| x[0] >= CENTER[0]));
        }
    }
    let exact = PI * RADIUS * RADIUS / 2.0;
    check_slope(exact, |n| volume(half_disc(n, Pole::Up)));
    check_slope(exact / 2.0, |n| volume(quarter_disc(n, Pole::Down)));
}

/// Turned around its axis the quarter disc is half a ball.
#[test]
fn quarter_discs_as_half_balls() {
    let turned = |cells, pole| {
        let shape = QuarterDiscMesh {
            center: [0.0, 3.0],
            radius: 2.0,
            cells,
            pole,
            kind: CellKind::Quad4,
        };
        let mut mesh = shape.generate("ball").unwrap();
        mesh.symmetry = Symmetry::Axisymmetric;
        mesh
    };
    let ball = 2.0 / 3.0 * PI * 8.0;
    check_slope(ball, |n| volume(turned(n, Pole::Down)));
    let area = |n| {
        let mesh = turned(n, Pole::Up);
        let dome = Surface::new(mesh.facet_sets["dome"].clone()).unwrap();
        dome.tributary_areas(&mesh).iter().sum()
    };
    check_slope(TAU * 4.0, area);
    let mesh = turned(4, Pole::Up);
    let base = Surface::new(mesh.facet_sets["base"].clone()).unwrap();
    let found: f64 = base.tributary_areas(&mesh).iter().sum();
    assert!((found - 4.0 * PI).abs() < 1e-13);
}

#[test]
fn rings() {
    for around in [3, 4, 5, 6, 32] {
        for through in CELLS {
            let mesh = annulus([around, through], 1.0);
            if around >= 5 {
                check(&mesh, &["inner", "outer"]);
            }
            mesh.validate().unwrap();
            let step = TAU / around as f64;
            check_rim(&mesh, "inner", (0.5, 1.0), around, step);
            check_rim(&mesh, "outer", (RADIUS, 1.0), around, step);
        }
    }
    check_slope(PI * (RADIUS * RADIUS - 0.25), |n| {
        volume(annulus([n, 2], 3.0))
    });
    let graded = annulus([8, 5], 3.0);
    let radius = |layer: usize| graded.points[8 * layer][0] - CENTER[0];
    let size = |layer: usize| radius(layer + 1) - radius(layer);
    assert!((size(4) / size(0) - 3.0).abs() < 1e-12);
}

#[test]
fn half_balls() {
    for cells in CELLS {
        for (pole, sign) in [(Pole::Up, 1.0), (Pole::Down, -1.0)] {
            if cells == 32 && pole == Pole::Up {
                continue;
            }
            let mesh = half_ball(cells, pole);
            check(&mesh, &["dome", "base"]);
            let height = |x: &Vector3<f64>| sign * (x[2] - 0.5);
            assert!(
                mesh.points
                    .iter()
                    .all(|x| (0.0..=RADIUS).contains(&height(x)))
            );
            let dome = mesh.node_set("dome").unwrap();
            for &n in dome {
                let radius = (mesh.points[n as usize] - Vector3::new(2.5, -1.5, 0.5)).norm();
                assert!((radius - RADIUS).abs() < 1e-15);
            }
            let pole = dome.iter().map(|&n| height(&mesh.points[n as usize]));
            assert_eq!(pole.fold(0.0, f64::max), RADIUS);
            // Rim of the base: as many equal steps as cells.
            let even = cells.next_multiple_of(2);
            let rim = dome.iter().filter(|&&n| mesh.points[n as usize][2] == 0.5);
            assert_eq!(rim.count(), 4 * even);
        }
    }
    let exact = 2.0 / 3.0 * PI * RADIUS.powi(3);
    check_slope(exact, |n| volume(half_ball(n / 2, Pole::Up)));
}

proptest! {
    #[test]
    fn rectangles_are_valid_and_closed(
        cells in prop::array::uniform2(1..6_usize), grading in prop::array::uniform2(0.3..3.0_f64),
    ) {
        for kind in PLANE_KINDS {
            let shape = RectangleMesh {
                min: [-1.0, 0.5],
                max: [1.0, 3.5],
                cells,
                grading,
                kind,
            };
            let mesh = shape.generate("plate").unwrap();
            mesh.validate().unwrap();
            let all: usize = ["x_min", "x_max", "y_min", "y_max"].map(|s| mesh.facet_sets[s].len()).iter().sum();
            prop_assert_eq!(all, 2 * (cells[0] + cells[1]));
            let boundary = mesh.boundary_facets();
            prop_assert_eq!(all, boundary.len());
            prop_assert!((enclosed(&mesh, &boundary) - 6.0).abs() < 1e-13);
            for (side, axis, at) in [("x_min", 0, -1.0), ("x_max", 0, 1.0), ("y_min", 1, 0.5), ("y_max", 1, 3.5)] {
                let on_side = (0..mesh.points.len() as u32).filter(|&n| mesh.points[n as usize][axis] == at);
                prop_assert!(on_side.eq(mesh.node_sets[side].iter().copied()));
            }
            let sizes: Vec<f64> = mesh.points[..=cells[0]].windows(2).map(|p| p[1][0] - p[0][0]).collect();
            let ratio = if cells[0] == 1 { 1.0 } else { grading[0] };
            prop_assert!((sizes[cells[0] - 1] / sizes[0] / ratio - 1.0).abs() < 1e-9);
        }
    }
}
