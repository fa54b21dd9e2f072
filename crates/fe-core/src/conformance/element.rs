//! Properties of shape functions, rules and facets.

use nalgebra::Vector3;

use super::{AGREEMENT, Violation, same, same_entries};
use crate::element::Facet;
use crate::element::{Element, jacobian};
use crate::quadrature::QuadraturePoint;

/// Step of the central differences in a reference coordinate \[-\]. Shape functions are of the second degree in each,
/// so that nothing is left but round-off over the step, 1e-11.
const STEP: f64 = 1e-5;
/// Allowed difference of a derivative from central differences \[-\]: a thousand times what the step leaves.
const SLOPES: f64 = 1e-8;

/// Shape functions are one at their node and zero at the others, sum to one, reproduce linear fields (quadratic ones
/// from degree 2), and have the right derivatives; both rules measure the volume; facets are closed and point outward.
///
/// # Errors
/// The first [`Violation`] found.
pub fn check_element<E, const N: usize>() -> Result<(), Violation>
where
    E: Element<Nodal = [f64; N]>,
{
    check_sizes::<E, N>()?;
    for (a, xi) in E::reference_nodes().iter().enumerate() {
        let mut expected = [0.0; N];
        expected[a] = 1.0;
        same_entries("one at its node", &E::shape(xi), &expected, AGREEMENT)?;
    }
    for point in E::rule().iter().chain(E::mass_rule()) {
        check_shape::<E, N>(&point.xi)?;
    }
    check_facets::<E, N>()
}

fn check_sizes<E: Element, const N: usize>() -> Result<(), Violation> {
    let sizes = [
        ("number of nodes", E::NODES, N),
        ("nodes of the cell kind", E::KIND.node_count(), N),
        ("reference nodes", E::reference_nodes().len(), N),
        ("points of the rule", E::rule().len(), E::POINTS),
    ];
    for (property, found, expected) in sizes {
        let place = || format!("{:?}", E::KIND);
        same(property, place, found as f64, expected as f64, 0.0)?;
    }
    let volume = |rule: &[QuadraturePoint]| rule.iter().map(|q| q.weight).sum::<f64>();
    let (found, expected) = (volume(E::mass_rule()), volume(E::rule()));
    same("sum of weights", String::new, found, expected, AGREEMENT)
}

fn check_shape<E, const N: usize>(xi: &[f64; 3]) -> Result<(), Violation>
where
    E: Element<Nodal = [f64; N]>,
{
    let place = || format!("xi = {xi:?}");
    let (shape, derivatives) = (E::shape(xi), E::shape_derivatives(xi));
    let total = shape.iter().sum();
    same("partition of unity", place, total, 1.0, AGREEMENT)?;
    let interpolated = |f: &dyn Fn(&[f64; 3]) -> f64| -> f64 {
        let nodes = E::reference_nodes().iter();
        nodes.zip(&shape).map(|(x, n)| n * f(x)).sum()
    };
    for i in 0..3 {
        let found = interpolated(&|x| x[i]);
        same("linear completeness", place, found, xi[i], AGREEMENT)?;
        for j in (0..3).filter(|_| E::KIND.degree() == 2) {
            let found = interpolated(&|x| x[i] * x[j]);
            let expected = xi[i] * xi[j];
            same("quadratic completeness", place, found, expected, AGREEMENT)?;
        }
        let at = |step: f64| {
            let mut moved = *xi;
            moved[i] += step;
            E::shape(&moved)
        };
        let (after, before) = (at(STEP), at(-STEP));
        for a in 0..N {
            let difference = (after[a] - before[a]) / (2.0 * STEP);
            let found = derivatives[i][a];
            same(
                "derivative of a shape function",
                place,
                found,
                difference,
                SLOPES,
            )?;
        }
    }
    Ok(())
}

/// The facets of the reference cell enclose its volume: by the divergence theorem, `dim V = sum of x . n dA`.
fn check_facets<E, const N: usize>() -> Result<(), Violation>
where
    E: Element<Nodal = [f64; N]>,
{
    let x: [[f64; 3]; N] = std::array::from_fn(|a| E::reference_nodes()[a]);
    let local: Vec<u32> = (0..N as u32).collect();
    let mut area = Vector3::zeros();
    let mut flux = 0.0;
    // Straight edges, and flat facets as fans of triangles around their first node.
    let facets = E::KIND.facets().iter();
    let facets = facets.map(|facet| Facet::of_cell(E::KIND.facet_kind(), &local, facet));
    for piece in facets.flat_map(|facet| facet.pieces().collect::<Vec<_>>()) {
        let node = |m: usize| Vector3::from(x[piece.nodes[m] as usize]);
        if E::KIND.dim() == 2 {
            let (p, q) = (node(0), node(1));
            let normal = Vector3::new(q.y - p.y, p.x - q.x, 0.0);
            area += normal;
            flux += p.dot(&normal);
        }
        for m in 2..piece.nodes().len() {
            let (p, q, r) = (node(0), node(m - 1), node(m));
            let normal = (q - p).cross(&(r - p));
            area += 0.5 * normal;
            flux += 0.5 * p.dot(&normal);
        }
    }
    same_entries("closed facets", area.as_slice(), &[0.0; 3], AGREEMENT)?;
    let mut volume = 0.0;
    for point in E::rule() {
        volume += point.weight * jacobian::<E, N>(&x, &point.xi).determinant();
    }
    let found = flux / E::KIND.dim() as f64;
    same("outward facets", String::new, found, volume, AGREEMENT)
}
