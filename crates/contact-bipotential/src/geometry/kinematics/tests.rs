//! `H` against its transpose and against a dense matrix built entry by entry.

use super::*;
use crate::geometry::contact::Stencil;
use crate::geometry::vector::unit;
use faer::Mat;
use nalgebra::Matrix3;
use proptest::prelude::*;

const NODES: usize = 12;

fn vector() -> impl Strategy<Value = Vector3<f64>> {
    prop::array::uniform3(-1.0f64..1.0).prop_map(Vector3::from)
}

fn frame() -> impl Strategy<Value = Matrix3<f64>> {
    vector()
        .prop_filter("needs a direction", |a| a.norm() > 0.1)
        .prop_map(|a| FrameRule::spatial(Vector3::new(0.1, 0.2, 0.3)).at(unit(a).unwrap()))
}

fn contact() -> impl Strategy<Value = Contact> {
    let weights = prop_oneof![
        Just(vec![]),
        (0.0f64..1.0).prop_map(|a| vec![a, 1.0 - a, 0.0]),
        (0.0f64..1.0, 0.0f64..1.0).prop_map(|(a, b)| vec![
            a * b,
            a * (1.0 - b),
            (1.0 - a) * (1.0 - b),
            (1.0 - a) * b
        ]),
    ];
    (0u32..6, 6u32..9, weights, frame(), vector()).prop_map(
        |(slave, first, weights, frame, obstacle_motion)| {
            let nodes: Vec<u32> = (0..weights.len() as u32).map(|k| first + k).collect();
            Contact::new(
                ContactKey::new(0, slave as usize),
                Stencil::deformable(slave, &nodes, &weights),
                frame,
                0.0,
            )
            .on_moving_obstacle(obstacle_motion)
        },
    )
}

/// Maps with 1, 2 or 3 rows a contact, in space and in the plane.
fn map() -> impl Strategy<Value = ContactMap> {
    let shape = prop_oneof![
        Just((3, Cone::Spatial)),
        Just((3, Cone::Frictionless)),
        Just((2, Cone::Planar)),
        Just((2, Cone::Frictionless)),
    ];
    (prop::collection::vec(contact(), 0..8), shape).prop_map(|(mut contacts, (dim, cone))| {
        if dim == 2 {
            for contact in &mut contacts {
                let n = contact.normal();
                let n = unit(Vector3::new(n[0] + 1.5, n[1], 0.0)).unwrap();
                contact.frame = FrameRule::planar().at(n);
            }
        }
        ContactMap::new(contacts, dim, cone)
    })
}

fn numbers(n: usize) -> impl Strategy<Value = Vec<f64>> {
    prop::collection::vec(-1.0f64..1.0, n)
}

/// `H` row by row from its definition.
fn dense(map: &ContactMap) -> Vec<Vec<f64>> {
    let mut h = vec![vec![0.0; map.dim() * NODES]; map.row_count()];
    for (k, contact) in map.contacts.iter().enumerate() {
        let [t1, t2, n] = [0, 1, 2].map(|i| contact.frame.column(i).into_owned());
        let rows = match map.cone().dim() {
            1 => vec![n],
            2 => vec![t1, n],
            _ => vec![t1, t2, n],
        };
        for (j, row) in rows.iter().enumerate() {
            for (node, w) in contact.stencil.iter() {
                for i in 0..map.dim() {
                    h[k * rows.len() + j][map.dim() * node as usize + i] += w * row[i];
                }
            }
        }
    }
    h
}

/// A random symmetric compliance over some of the components of the nodes `first..last`.
fn part(dim: usize, first: usize, last: usize, keep: &[bool], values: &[f64]) -> CompliancePart {
    let mut offset = vec![u32::MAX; dim * last];
    let mut n = 0;
    for dof in dim * first..dim * last {
        if keep[dof] {
            offset[dof] = n;
            n += 1;
        }
    }
    let c = Mat::from_fn(n as usize, n as usize, |i, j| {
        let (i, j) = (i.max(j), i.min(j));
        values[(i * 31 + j) % values.len()]
    });
    CompliancePart::new(offset, c).unwrap()
}

proptest! {
    #[test]
    fn apply_is_the_dense_matrix(map in map(), u in numbers(3 * NODES)) {
        let mut x = vec![f64::NAN; map.row_count()];
        map.apply(&u[..map.dim() * NODES], &mut x);
        for (row, x) in dense(&map).iter().zip(&x) {
            let expected: f64 = row.iter().zip(&u).map(|(h, u)| h * u).sum();
            prop_assert!((expected - x).abs() < 1e-14);
        }
    }

    #[test]
    fn transpose_is_the_adjoint(map in map(), u in numbers(3 * NODES), r in numbers(24)) {
        let u = &u[..map.dim() * NODES];
        let r = &r[..map.row_count()];
        let mut x = vec![0.0; map.row_count()];
        let mut f = vec![0.0; u.len()];
        map.apply(u, &mut x);
        map.apply_transpose(r, &mut f);
        let xr: f64 = x.iter().zip(r).map(|(a, b)| a * b).sum();
        let uf: f64 = u.iter().zip(&f).map(|(a, b)| a * b).sum();
        prop_assert!((xr - uf).abs() < 1e-13);
        // Added, not written.
        let once = f.clone();
        map.apply_transpose(r, &mut f);
        for (twice, once) in f.iter().zip(once) {
            prop_assert!((twice - 2.0 * once).abs() < 1e-14);
        }
    }

    #[test]
    fn a_common_translation_is_no_relative_motion(map in map(), a in [-1.0f64..1.0, -1.0f64..1.0, -1.0f64..1.0]) {
        let dim = map.dim();
        let u: Vec<f64> = (0..dim * NODES).map(|k| a[k % dim]).collect();
        let mut x = vec![0.0; map.row_count()];
        map.apply(&u, &mut x);
        let per = map.cone().dim();
        for (contact, x) in map.contacts.iter().zip(x.chunks(per)) {
            if contact.stencil.nodes().len() > 1 {
                prop_assert!(x.iter().all(|x| x.abs() < 1e-15));
            }
        }
    }

    #[test]
    fn slip_offset_is_the_opposite_of_the_obstacles_motion(map in map()) {
        // A slave that moves with the obstacle does not slip.
        let mut offset = vec![f64::NAN; map.row_count()];
        map.slip_offsets(&mut offset);
        for (k, contact) in map.contacts.iter().enumerate().filter(|(_, c)| c.stencil.nodes().len() == 1) {
            let single = ContactMap::new(vec![*contact], map.dim(), map.cone());
            let mut u = vec![0.0; map.dim() * NODES];
            for i in 0..map.dim() {
                u[map.dim() * contact.slave as usize + i] = contact.obstacle_motion[i];
            }
            let mut x = vec![0.0; single.row_count()];
            single.apply(&u, &mut x);
            for (x, o) in x.iter().zip(&offset[k * single.row_count()..]) {
                prop_assert!((x + o).abs() < 1e-14);
            }
        }
    }

    #[test]
    fn delassus_is_the_naive_product(
        map in map(), keep in prop::collection::vec(prop::bool::weighted(0.8), 3 * NODES), values in numbers(97),
        whole in any::<bool>(),
    ) {
        let keep = if whole { vec![true; 3 * NODES] } else { keep };
        let dim = map.dim();
        // Slaves belong to the first body, masters to the second; node 9 and up only to the second.
        let bodies = [part(dim, 0, 6, &keep, &values), part(dim, 6, NODES, &keep, &values[7..])];
        let mut w = Mat::zeros(2, 3);
        map.delassus(&bodies, &mut w);
        let h = dense(&map);
        let n = map.row_count();
        prop_assert_eq!((w.nrows(), w.ncols()), (n, n));
        let starts = [0, 6 * dim];
        for i in 0..n {
            for j in 0..n {
                let mut expected = 0.0;
                for (body, part) in bodies.iter().enumerate() {
                    let dofs: Vec<usize> = (starts[body]..dim * [6, NODES][body]).filter(|d| keep[*d]).collect();
                    for (a, p) in dofs.iter().enumerate() {
                        for (b, q) in dofs.iter().enumerate() {
                            expected += h[i][*p] * part.c[(a, b)] * h[j][*q];
                        }
                    }
                }
                prop_assert!((w[(i, j)] - expected).abs() < 1e-13, "{i} {j}: {} {expected}", w[(i, j)]);
                prop_assert_eq!(w[(i, j)], w[(j, i)]);
            }
        }
    }
}

#[test]
fn delassus_has_the_same_bits_for_any_number_of_threads() {
    let nodes: u32 = 90;
    let contacts: Vec<Contact> = (0..40)
        .map(|k| {
            let n = unit(Vector3::new((k as f64).sin(), (k as f64).cos(), 1.0)).unwrap();
            Contact::new(
                ContactKey::new(0, k as usize),
                Stencil::deformable(k, &[40 + k, 41 + k, 43 + k], &[0.2, 0.3, 0.5]),
                FrameRule::spatial(Vector3::z()).at(n),
                0.0,
            )
        })
        .collect();
    let map = ContactMap::new(contacts, 3, Cone::Spatial);
    let n = 3 * nodes as usize;
    let c = Mat::from_fn(n, n, |i, j| 1.0 / (1.0 + i as f64 + j as f64));
    let body = [CompliancePart::new((0..n as u32).collect(), c).unwrap()];
    let of = |threads| {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .unwrap();
        pool.install(|| {
            let mut w = Mat::zeros(0, 0);
            map.delassus(&body, &mut w);
            w
        })
    };
    let one = of(1);
    assert_eq!(one, of(2));
    assert_eq!(one, of(8));
}

#[test]
fn compliances_that_do_not_fit_are_refused() {
    assert!(CompliancePart::new(vec![0, 1], Mat::zeros(2, 3)).is_err());
    assert!(CompliancePart::new(vec![0, 2], Mat::zeros(2, 2)).is_err());
    assert!(CompliancePart::new(vec![u32::MAX, 1], Mat::zeros(2, 2)).is_ok());
}

#[test]
fn the_normal_row_is_last() {
    let frame = FrameRule::spatial(Vector3::z()).at(Vector3::z());
    let contact = Contact::new(ContactKey::new(0, 0), Stencil::rigid(0), frame, 0.5);
    let [t1, t2, n] = [0, 1, 2].map(|i| contact.frame.column(i).into_owned());
    assert_eq!(t1.cross(&t2), n);
    let map = ContactMap::new(vec![contact], 3, Cone::Spatial);
    let mut x = [0.0; 3];
    map.apply(&[1.0, 2.0, 3.0], &mut x);
    assert_eq!(x, [1.0, 2.0, 3.0]);
    assert_eq!(map.gaps(), [0.5]);
}
