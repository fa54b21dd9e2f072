//! Isoparametric elements: shape functions, their derivatives and quadrature.

pub mod hex27;
pub mod hex8;
pub mod quad4;
pub mod quad9;
pub mod tet10;
pub mod tet4;
pub mod tri3;
pub mod tri6;

pub(crate) mod quadratic;

use std::fmt::Debug;

use nalgebra::Matrix3;

pub use hex8::Hex8;
pub use hex27::Hex27;
pub use quad4::Quad4;
pub use quad9::Quad9;
pub use tet4::Tet4;
pub use tet10::Tet10;
pub use tri3::Tri3;
pub use tri6::Tri6;

use nalgebra::Vector3;

use crate::mesh::CellKind;
use crate::quadrature::QuadraturePoint;

/// Values of the shape functions: an array `[f64; N]`.
pub trait Nodal: Copy + Debug + Send + Sync + AsRef<[f64]> + 'static {}

impl<const N: usize> Nodal for [f64; N] {}

/// Shape functions and quadrature of an element in space or in the plane.
///
/// Plane elements do not depend on the third reference coordinate: their derivatives with respect to it are zero.
///
/// A new element is one file with this implementation and one line in [`CellKind`]; the battery
/// [`crate::conformance::check_element`] tells what is wrong with it.
pub trait Element: Debug + Clone + Copy + Default + Send + Sync + 'static {
    /// Kind of the cell.
    const KIND: CellKind;
    /// Number of nodes.
    const NODES: usize;
    /// Number of quadrature points of the force and the tangent.
    const POINTS: usize;
    /// Functions of the projected dilatation ([`crate::Dilatation`]): the first ones of 1, X, Y, Z. Few enough that the element
    /// does not lock, and no pressure is without resistance.
    const DILATATION_MODES: usize = 1;
    /// `[f64; NODES]`.
    type Nodal: Nodal;

    /// Reference coordinates of the nodes \[-\], VTK order.
    fn reference_nodes() -> &'static [[f64; 3]];
    /// Shape functions at `xi` \[-\].
    fn shape(xi: &[f64; 3]) -> Self::Nodal;
    /// Derivatives `dN_a/dxi_j` at `xi` \[-\], stored `[j][a]`.
    fn shape_derivatives(xi: &[f64; 3]) -> [Self::Nodal; 3];
    /// Rule of the force and the tangent, `POINTS` long.
    fn rule() -> &'static [QuadraturePoint];
    /// Rule of the mass: exact for products of two shape functions, also on distorted cells and
    /// those around an axis, as long as their edges are straight.
    fn mass_rule() -> &'static [QuadraturePoint];
}

/// Coordinates of an element's nodes \[m\].
///
/// Indices must be in range, which [`crate::Mesh::validate`] ensures.
pub fn corner_points<const N: usize>(points: &[Vector3<f64>], cell: &[u32]) -> [[f64; 3]; N] {
    std::array::from_fn(|a| points[cell[a] as usize].into())
}

/// Jacobian `dX_i/dxi_j` \[m\] of the map from the reference element, row `i`, column `j`. In the plane the third
/// coordinate is ignored and its row and column are those of the identity.
pub fn jacobian<E, const N: usize>(points: &[[f64; 3]; N], xi: &[f64; 3]) -> Matrix3<f64>
where
    E: Element<Nodal = [f64; N]>,
{
    let dn = E::shape_derivatives(xi);
    let dim = E::KIND.dim();
    let mut jac = Matrix3::zeros();
    if dim == 2 {
        jac[(2, 2)] = 1.0;
    }
    for i in 0..dim {
        for j in 0..dim {
            for a in 0..N {
                jac[(i, j)] += points[a][i] * dn[j][a];
            }
        }
    }
    jac
}

/// Gradients `dN_a/dX_J` \[1/m\] stored `\[J\][a]`, and the determinant of the Jacobian \[m^3; m^2 in the
/// plane\]. In the plane the third row is zero.
///
/// The gradients are meaningless unless the determinant is positive.
pub fn reference_gradients<E, const N: usize>(
    points: &[[f64; 3]; N],
    xi: &[f64; 3],
) -> ([[f64; N]; 3], f64)
where
    E: Element<Nodal = [f64; N]>,
{
    let dn = E::shape_derivatives(xi);
    let map = jacobian::<E, N>(points, xi);
    let inverse = map.try_inverse().unwrap_or(Matrix3::repeat(f64::NAN));
    let mut gradients = [[0.0; N]; 3];
    for (j, row) in gradients.iter_mut().enumerate() {
        for a in 0..N {
            row[a] = dn[0][a] * inverse[(0, j)]
                + dn[1][a] * inverse[(1, j)]
                + dn[2][a] * inverse[(2, j)];
        }
    }
    (gradients, map.determinant())
}

/// First quadrature point with a Jacobian that is not positive and finite, and its value \[m^3; m^2 in the plane\].
pub(crate) fn bad_jacobian<E, const N: usize>(
    points: &[Vector3<f64>],
    cell: &[u32],
) -> Option<(usize, f64)>
where
    E: Element<Nodal = [f64; N]>,
{
    let corners = corner_points::<N>(points, cell);
    E::rule().iter().enumerate().find_map(|(q, point)| {
        let det = jacobian::<E, N>(&corners, &point.xi).determinant();
        let good = det > 0.0 && det.is_finite();
        (!good).then_some((q, det))
    })
}
