//! Isoparametric elements: shape functions, their derivatives and quadrature.

mod hex27;
mod hex8;
mod quad4;
mod quad9;
mod tet10;
mod tet4;
mod tri3;
mod tri6;

mod facet;
pub(crate) mod quadratic;

use std::fmt::Debug;

use nalgebra::{Matrix3, Vector3};

pub use facet::{Facet, FacetKind};
pub use hex8::Hex8;
pub use hex27::Hex27;
pub use quad4::Quad4;
pub use quad9::Quad9;
pub use tet4::Tet4;
pub use tet10::Tet10;
pub use tri3::Tri3;
pub use tri6::Tri6;

use crate::quadrature::QuadraturePoint;

/// What is known of a kind of cells: a row of the table, which stands in the file of its element.
#[derive(Debug)]
pub(crate) struct CellData {
    /// As in the code and in scene files.
    name: &'static str,
    nodes: usize,
    dim: usize,
    degree: usize,
    linear: CellKind,
    quadratic: CellKind,
    /// For each node beyond the corners, the corners in whose middle it lies.
    parents: &'static [&'static [usize]],
    /// Local nodes of each facet, outward.
    facets: &'static [&'static [usize]],
    facet_kind: FacetKind,
    vtk_type: u8,
    grid_cut: GridCut,
}

/// How a quadrilateral or a brick of a structured mesh becomes cells of degree 1.
#[derive(Debug, Clone, Copy)]
pub(crate) enum GridCut {
    /// Into these cells, by its local corners.
    Cells(&'static [&'static [usize]]),
    /// Along its shorter diagonal into two triangles.
    ShorterDiagonal,
}

/// Something that is done with the element of a kind; see [`CellKind::with_element`].
pub(crate) trait ElementVisitor {
    /// Result.
    type Output;

    /// Called with the element of the kind.
    fn visit<E: Element<Nodal = [f64; N]>, const N: usize>(self) -> Self::Output;
}

/// The list of kinds: the enum, its rows and the elements. Nothing else in the house lists them.
macro_rules! kinds {
    ($($(#[$doc:meta])* $kind:ident: $file:ident, $nodes:literal;)*) => {
        /// Shape of a cell, with VTK node order.
        #[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
        pub enum CellKind {
            $($(#[$doc])* $kind,)*
        }

        impl CellKind {
            /// All kinds there are.
            pub const ALL: [CellKind; [$($nodes),*].len()] = [$(CellKind::$kind),*];

            const fn data(self) -> &'static CellData {
                match self {
                    $(CellKind::$kind => &$file::CELL,)*
                }
            }

            /// Calls `visitor` with the element of this kind: from a value to a type.
            pub(crate) fn with_element<V: ElementVisitor>(self, visitor: V) -> V::Output {
                match self {
                    $(CellKind::$kind => visitor.visit::<$kind, $nodes>(),)*
                }
            }
        }
    };
}

kinds! {
    /// Trilinear hexahedron.
    Hex8: hex8, 8;
    /// Linear tetrahedron.
    Tet4: tet4, 4;
    /// Bilinear quadrilateral in the plane, counter-clockwise.
    Quad4: quad4, 4;
    /// Linear triangle in the plane, counter-clockwise.
    Tri3: tri3, 3;
    /// Triquadratic hexahedron.
    Hex27: hex27, 27;
    /// Quadratic tetrahedron.
    Tet10: tet10, 10;
    /// Biquadratic quadrilateral in the plane, counter-clockwise.
    Quad9: quad9, 9;
    /// Quadratic triangle in the plane, counter-clockwise.
    Tri6: tri6, 6;
}

impl CellKind {
    /// Name, as in the code.
    pub const fn name(self) -> &'static str {
        self.data().name
    }

    /// Nodes of a cell.
    pub const fn node_count(self) -> usize {
        self.data().nodes
    }

    /// Dimension of the cell, 2 or 3.
    pub const fn dim(self) -> usize {
        self.data().dim
    }

    /// Degree of the polynomials that the shape functions reproduce, 1 or 2.
    pub const fn degree(self) -> usize {
        self.data().degree
    }

    /// The cell of degree 1 with the same corners, whose nodes are the first of this one's.
    #[must_use]
    pub const fn linear(self) -> CellKind {
        self.data().linear
    }

    /// The cell of degree 2 with the same corners.
    #[must_use]
    pub const fn quadratic(self) -> CellKind {
        self.data().quadratic
    }

    /// For each node beyond the corners, the corners in whose middle it lies; none for cells of degree 1.
    pub(crate) const fn parents(self) -> &'static [&'static [usize]] {
        self.data().parents
    }

    /// Local nodes of each facet, outward as in [`Facet`].
    pub const fn facets(self) -> &'static [&'static [usize]] {
        self.data().facets
    }

    /// Kind of the facets.
    pub const fn facet_kind(self) -> FacetKind {
        self.data().facet_kind
    }

    /// VTK's number for the cell type.
    pub const fn vtk_type(self) -> u8 {
        self.data().vtk_type
    }

    /// How structured meshes get cells of this kind, or those of degree 1 with the same corners.
    pub(crate) const fn grid_cut(self) -> GridCut {
        self.data().grid_cut
    }

    /// First quadrature point whose Jacobian is not positive, with that Jacobian \[m^dim\].
    pub(crate) fn bad_jacobian(
        self,
        points: &[Vector3<f64>],
        cell: &[u32],
    ) -> Option<(usize, f64)> {
        self.with_element(BadJacobian { points, cell })
    }
}

/// A cell whose Jacobians are checked.
struct BadJacobian<'a> {
    points: &'a [Vector3<f64>],
    cell: &'a [u32],
}

impl ElementVisitor for BadJacobian<'_> {
    type Output = Option<(usize, f64)>;

    fn visit<E: Element<Nodal = [f64; N]>, const N: usize>(self) -> Self::Output {
        bad_jacobian::<E, N>(self.points, self.cell)
    }
}

/// Values of the shape functions: an array `[f64; N]`.
pub trait Nodal: Copy + Debug + Send + Sync + AsRef<[f64]> + 'static {}

impl<const N: usize> Nodal for [f64; N] {}

/// Shape functions and quadrature of an element in space or in the plane.
///
/// Plane elements do not depend on the third reference coordinate: their derivatives with respect to it are zero.
///
/// A new element is one file with this implementation and its row of the table, and one line in the list of kinds; the
/// battery `conformance::check_element` tells what is wrong with it.
pub trait Element: Debug + Clone + Copy + Default + Send + Sync + 'static {
    /// Kind of the cell.
    const KIND: CellKind;
    /// Number of nodes.
    const NODES: usize;
    /// Number of quadrature points of the force and the tangent.
    const POINTS: usize;
    /// Functions of the projected dilatation ([`crate::Dilatation`]): the first ones of 1, X, Y, Z. Few enough that the
    /// element does not lock, and no pressure is without resistance.
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
#[must_use]
pub fn corner_points<const N: usize>(points: &[Vector3<f64>], cell: &[u32]) -> [[f64; 3]; N] {
    std::array::from_fn(|a| points[cell[a] as usize].into())
}

/// Jacobian `dX_i/dxi_j` \[m\] of the map from the reference element, row `i`, column `j`. In the plane the third
/// coordinate is ignored and its row and column are those of the identity.
pub(crate) fn jacobian<E, const N: usize>(points: &[[f64; 3]; N], xi: &[f64; 3]) -> Matrix3<f64>
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
#[must_use]
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
fn bad_jacobian<E, const N: usize>(points: &[Vector3<f64>], cell: &[u32]) -> Option<(usize, f64)>
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
