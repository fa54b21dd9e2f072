//! Meshes, displacements and solids for the tests.

use fe_core::{BoxMesh, CellKind, Mesh, RectangleMesh, Solid, solid_block};
use hyperelastic::{BlatzKo, ElasticConstants, Material, NeoHookean};
use nalgebra::Vector3;
use proptest::prelude::*;

pub(crate) const KINDS: [CellKind; 4] = [
    CellKind::Hex8,
    CellKind::Tet4,
    CellKind::Hex27,
    CellKind::Tet10,
];
pub(crate) const PLANE_KINDS: [CellKind; 4] = [
    CellKind::Quad4,
    CellKind::Tri3,
    CellKind::Quad9,
    CellKind::Tri6,
];

pub(crate) fn neo_hookean() -> NeoHookean {
    NeoHookean::new(ElasticConstants::from_shear_lame(1.0, 2.0).unwrap()).unwrap()
}

pub(crate) fn blatz_ko() -> BlatzKo {
    BlatzKo::new(1.5).unwrap()
}

/// A box with sides 1, 1.2 and 0.8, its corners moved by up to `jitter` of the smallest cell; boundary nodes too
/// if asked.
pub(crate) fn distorted_box(
    cells: [usize; 3],
    kind: CellKind,
    jitter: f64,
    boundary: bool,
) -> Mesh {
    let max = [1.0, 1.2, 0.8];
    let mut mesh = BoxMesh::uniform([0.0; 3], max, cells)
        .with_kind(kind.linear())
        .generate("box")
        .unwrap();
    let cell = (0..3)
        .map(|i| max[i] / cells[i] as f64)
        .fold(f64::INFINITY, f64::min);
    for (node, x) in mesh.points.iter_mut().enumerate() {
        let outer = (0..3).any(|i| x[i] == 0.0 || x[i] == max[i]);
        if boundary || !outer {
            for (i, x) in x.iter_mut().enumerate() {
                *x += jitter * cell * (1.7 * node as f64 + 2.9 * i as f64).sin();
            }
        }
    }
    of_degree(kind.degree(), mesh)
}

/// A rectangle from (0.3, 0) to (1.3, 1.2) in plane strain, its corners moved by up to `jitter` of the smallest cell;
/// boundary nodes too if asked.
pub(crate) fn distorted_rectangle(
    cells: [usize; 2],
    kind: CellKind,
    jitter: f64,
    boundary: bool,
) -> Mesh {
    let (min, max) = ([0.3, 0.0], [1.3, 1.2]);
    let mut mesh = RectangleMesh::uniform(min, max, cells)
        .with_kind(kind.linear())
        .generate("rectangle")
        .unwrap();
    let cell = (1.0 / cells[0] as f64).min(1.2 / cells[1] as f64);
    for (node, x) in mesh.points.iter_mut().enumerate() {
        let outer = (0..2).any(|i| x[i] == min[i] || x[i] == max[i]);
        if boundary || !outer {
            for (i, x) in x.iter_mut().take(2).enumerate() {
                *x += jitter * cell * (1.7 * node as f64 + 2.9 * i as f64).sin();
            }
        }
    }
    of_degree(kind.degree(), mesh)
}

fn of_degree(degree: usize, mesh: Mesh) -> Mesh {
    match degree {
        1 => mesh,
        _ => mesh.quadratic().unwrap(),
    }
}

/// The mesh with curved cells: nodes inside the body that are no corners move by up to `by` \[m\].
pub(crate) fn curved(mut mesh: Mesh, by: f64) -> Mesh {
    let mut held = vec![false; mesh.points.len()];
    let kind = mesh.blocks[0].kind;
    for cell in mesh.blocks[0].iter() {
        let corners = &cell[..kind.linear().node_count()];
        corners.iter().for_each(|&n| held[n as usize] = true);
    }
    let boundary = mesh.boundary_facets();
    let outer = boundary.iter().flat_map(|f| f.nodes());
    outer.for_each(|&n| held[n as usize] = true);
    for (node, x) in mesh
        .points
        .iter_mut()
        .enumerate()
        .filter(|(n, _)| !held[*n])
    {
        for (i, x) in x.iter_mut().take(kind.dim()).enumerate() {
            *x += by * (2.3 * node as f64 + 1.9 * i as f64).sin();
        }
    }
    mesh
}

pub(crate) fn solid<M: Material>(mesh: Mesh, material: M, density: f64) -> Solid {
    let mesh = mesh.validated().unwrap();
    let blocks = (0..mesh.blocks.len())
        .map(|index| solid_block(&mesh, index, material.clone(), density).unwrap());
    let blocks = blocks.collect();
    Solid::new(mesh, blocks).unwrap()
}

/// Displacements of each node up to `size`.
pub(crate) fn displacement(nodes: usize, size: f64) -> impl Strategy<Value = Vec<f64>> {
    prop::collection::vec(-size..size, 3 * nodes)
}

/// A smooth displacement, large enough to matter.
pub(crate) fn wave(mesh: &Mesh, size: f64) -> Vec<f64> {
    let wave = |x: &Vector3<f64>| {
        [
            size * (3.0 * x[1] + x[2]).sin(),
            size * (2.0 * x[2] - x[0]).cos(),
            size * x[0] * (x[1] + 0.3),
        ]
    };
    let waves = mesh.points.iter().map(wave);
    waves.flat_map(|u| u.into_iter().take(mesh.dim)).collect()
}

pub(crate) fn pool(threads: usize) -> rayon::ThreadPool {
    rayon::ThreadPoolBuilder::new()
        .num_threads(threads)
        .build()
        .unwrap()
}
