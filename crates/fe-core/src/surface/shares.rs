//! Integrals of shape functions over facets in the reference configuration.

use nalgebra::Vector3;

use crate::element::quadratic::{line, line_derivative};
use crate::element::{Element, Quad4, Quad9, Tri6};
use crate::element::{Facet, FacetKind};
use crate::quadrature::GAUSS_3;
use crate::symmetry::Symmetry;

/// Below this part of the area of a facet \[-\] the share of a node is no measure of what acts there.
const LEAST: f64 = 0.01;

/// Integral of each shape function over a facet \[m^2\]; unused entries are zero. Exact on flat facets with straight
/// edges.
pub(super) fn shares(facet: &Facet, points: &[Vector3<f64>], symmetry: Symmetry) -> [f64; 9] {
    let x = |m: usize| points[facet.nodes[m] as usize];
    let mut all = [0.0; 9];
    match facet.kind {
        FacetKind::Edge2 => {
            let (a, b) = (x(0), x(1));
            let half = 0.5 * (b[0] - a[0]).hypot(b[1] - a[1]);
            // Exact for shape functions and a radius that are linear along the edge.
            let share = |near: f64, far: f64| half * symmetry.extent((2.0 * near + far) / 3.0);
            all[..2].copy_from_slice(&[share(a[0], b[0]), share(b[0], a[0])]);
        }
        FacetKind::Edge3 => all[..3].copy_from_slice(&on_edge([x(0), x(1), x(2)], symmetry)),
        FacetKind::Tri3 => {
            let normal = (x(1) - x(0)).cross(&(x(2) - x(0)));
            all[..3].fill(normal.norm() / 6.0);
        }
        FacetKind::Tri6 => all[..6].copy_from_slice(&on_face::<Tri6, 6>(&std::array::from_fn(x))),
        FacetKind::Quad4 => all[..4].copy_from_slice(&on_face::<Quad4, 4>(&std::array::from_fn(x))),
        FacetKind::Quad9 => all.copy_from_slice(&on_face::<Quad9, 9>(&std::array::from_fn(x))),
    }
    all
}

/// The same without shares that are negative or too small to stand for an area; the others grow in proportion, so that
/// the sum stays.
pub(super) fn usable(mut shares: [f64; 9]) -> [f64; 9] {
    let area: f64 = shares.iter().sum();
    shares
        .iter_mut()
        .filter(|share| **share < LEAST * area)
        .for_each(|share| *share = 0.0);
    let kept: f64 = shares.iter().sum();
    // A facet that loses nothing keeps its last bit.
    if kept == area {
        shares
    } else {
        shares.map(|share| share * area / kept)
    }
}

/// Three Gauss points on an edge with ends `x[0]`, `x[1]` and middle `x[2]`.
fn on_edge(x: [Vector3<f64>; 3], symmetry: Symmetry) -> [f64; 3] {
    let nodes = [-1.0, 1.0, 0.0];
    let rule = [
        (-GAUSS_3, 5.0 / 9.0),
        (0.0, 8.0 / 9.0),
        (GAUSS_3, 5.0 / 9.0),
    ];
    let mut shares = [0.0; 3];
    for (s, weight) in rule {
        let (shape, slope) = (
            nodes.map(|c| line(c, s)),
            nodes.map(|c| line_derivative(c, s)),
        );
        let sum = |by: &[f64; 3], i: usize| (0..3).map(|a| by[a] * x[a][i]).sum::<f64>();
        let length = sum(&slope, 0).hypot(sum(&slope, 1));
        let area = weight * length * symmetry.extent(sum(&shape, 0));
        (0..3).for_each(|a| shares[a] += area * shape[a]);
    }
    shares
}

/// Points of the rule of the plane element with the same nodes, on a face in space.
fn on_face<E, const N: usize>(x: &[Vector3<f64>; N]) -> [f64; N]
where
    E: Element<Nodal = [f64; N]>,
{
    let mut shares = [0.0; N];
    for point in E::rule() {
        let (shape, slopes) = (E::shape(&point.xi), E::shape_derivatives(&point.xi));
        let along = |j: usize| -> Vector3<f64> { (0..N).map(|a| slopes[j][a] * x[a]).sum() };
        let area = point.weight * along(0).cross(&along(1)).norm();
        (0..N).for_each(|a| shares[a] += area * shape[a]);
    }
    shares
}
