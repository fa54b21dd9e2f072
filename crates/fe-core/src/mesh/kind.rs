//! Kinds of cells.

use nalgebra::Vector3;

use super::FacetKind;
use crate::element::{self, Hex8, Hex27, Quad4, Quad9, Tet4, Tet10, Tri3, Tri6};

/// Shape of a cell, with VTK node order.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
#[non_exhaustive]
pub enum CellKind {
    /// Trilinear hexahedron.
    Hex8,
    /// Linear tetrahedron.
    Tet4,
    /// Bilinear quadrilateral in the plane, counter-clockwise.
    Quad4,
    /// Linear triangle in the plane, counter-clockwise.
    Tri3,
    /// Triquadratic hexahedron.
    Hex27,
    /// Quadratic tetrahedron.
    Tet10,
    /// Biquadratic quadrilateral in the plane, counter-clockwise.
    Quad9,
    /// Quadratic triangle in the plane, counter-clockwise.
    Tri6,
}

impl CellKind {
    /// All kinds.
    pub const ALL: [CellKind; 8] = [
        CellKind::Hex8,
        CellKind::Tet4,
        CellKind::Quad4,
        CellKind::Tri3,
        CellKind::Hex27,
        CellKind::Tet10,
        CellKind::Quad9,
        CellKind::Tri6,
    ];

    /// Name, as in `Hex8`.
    pub const fn name(self) -> &'static str {
        match self {
            CellKind::Hex8 => "Hex8",
            CellKind::Tet4 => "Tet4",
            CellKind::Quad4 => "Quad4",
            CellKind::Tri3 => "Tri3",
            CellKind::Hex27 => "Hex27",
            CellKind::Tet10 => "Tet10",
            CellKind::Quad9 => "Quad9",
            CellKind::Tri6 => "Tri6",
        }
    }

    /// Nodes of a cell.
    pub fn node_count(self) -> usize {
        match self {
            CellKind::Hex8 => 8,
            CellKind::Tet4 | CellKind::Quad4 => 4,
            CellKind::Tri3 => 3,
            CellKind::Hex27 => 27,
            CellKind::Tet10 => 10,
            CellKind::Quad9 => 9,
            CellKind::Tri6 => 6,
        }
    }

    /// Dimension of the cell, 2 or 3.
    pub const fn dim(self) -> usize {
        match self {
            CellKind::Hex8 | CellKind::Tet4 | CellKind::Hex27 | CellKind::Tet10 => 3,
            CellKind::Quad4 | CellKind::Tri3 | CellKind::Quad9 | CellKind::Tri6 => 2,
        }
    }

    /// Degree of the polynomials that the shape functions reproduce, 1 or 2.
    pub const fn degree(self) -> usize {
        match self {
            CellKind::Hex8 | CellKind::Tet4 | CellKind::Quad4 | CellKind::Tri3 => 1,
            CellKind::Hex27 | CellKind::Tet10 | CellKind::Quad9 | CellKind::Tri6 => 2,
        }
    }

    /// The cell of degree 1 with the same corners, whose nodes are the first of this one's.
    pub const fn linear(self) -> CellKind {
        match self {
            CellKind::Hex8 | CellKind::Hex27 => CellKind::Hex8,
            CellKind::Tet4 | CellKind::Tet10 => CellKind::Tet4,
            CellKind::Quad4 | CellKind::Quad9 => CellKind::Quad4,
            CellKind::Tri3 | CellKind::Tri6 => CellKind::Tri3,
        }
    }

    /// The cell of degree 2 with the same corners.
    pub const fn quadratic(self) -> CellKind {
        match self {
            CellKind::Hex8 | CellKind::Hex27 => CellKind::Hex27,
            CellKind::Tet4 | CellKind::Tet10 => CellKind::Tet10,
            CellKind::Quad4 | CellKind::Quad9 => CellKind::Quad9,
            CellKind::Tri3 | CellKind::Tri6 => CellKind::Tri6,
        }
    }

    /// For each node beyond the corners, the corners in whose middle it lies; none for cells of degree 1.
    pub(super) fn parents(self) -> &'static [&'static [usize]] {
        match self {
            CellKind::Hex8 | CellKind::Tet4 | CellKind::Quad4 | CellKind::Tri3 => &[],
            CellKind::Hex27 => &element::hex27::PARENTS,
            CellKind::Tet10 => &element::tet10::PARENTS,
            CellKind::Quad9 => &element::quad9::PARENTS,
            CellKind::Tri6 => &element::tri6::PARENTS,
        }
    }

    /// Local nodes of each facet, outward as in [`super::Facet`].
    pub fn facets(self) -> &'static [&'static [usize]] {
        match self {
            CellKind::Hex8 => &element::hex8::FACETS,
            CellKind::Tet4 => &element::tet4::FACETS,
            CellKind::Quad4 => &element::quad4::FACETS,
            CellKind::Tri3 => &element::tri3::FACETS,
            CellKind::Hex27 => &element::hex27::FACETS,
            CellKind::Tet10 => &element::tet10::FACETS,
            CellKind::Quad9 => &element::quad9::FACETS,
            CellKind::Tri6 => &element::tri6::FACETS,
        }
    }

    /// Kind of the facets.
    pub const fn facet_kind(self) -> FacetKind {
        match self {
            CellKind::Hex8 => FacetKind::Quad4,
            CellKind::Tet4 => FacetKind::Tri3,
            CellKind::Quad4 | CellKind::Tri3 => FacetKind::Edge2,
            CellKind::Hex27 => FacetKind::Quad9,
            CellKind::Tet10 => FacetKind::Tri6,
            CellKind::Quad9 | CellKind::Tri6 => FacetKind::Edge3,
        }
    }

    /// VTK's number for the cell type.
    pub fn vtk_type(self) -> u8 {
        match self {
            CellKind::Hex8 => 12,
            CellKind::Tet4 => 10,
            CellKind::Quad4 => 9,
            CellKind::Tri3 => 5,
            CellKind::Hex27 => 29,
            CellKind::Tet10 => 24,
            CellKind::Quad9 => 28,
            CellKind::Tri6 => 22,
        }
    }

    /// First quadrature point whose Jacobian is not positive, with that Jacobian \[m^dim\].
    pub(super) fn bad_jacobian(
        self,
        points: &[Vector3<f64>],
        cell: &[u32],
    ) -> Option<(usize, f64)> {
        match self {
            CellKind::Hex8 => element::bad_jacobian::<Hex8, 8>(points, cell),
            CellKind::Tet4 => element::bad_jacobian::<Tet4, 4>(points, cell),
            CellKind::Quad4 => element::bad_jacobian::<Quad4, 4>(points, cell),
            CellKind::Tri3 => element::bad_jacobian::<Tri3, 3>(points, cell),
            CellKind::Hex27 => element::bad_jacobian::<Hex27, 27>(points, cell),
            CellKind::Tet10 => element::bad_jacobian::<Tet10, 10>(points, cell),
            CellKind::Quad9 => element::bad_jacobian::<Quad9, 9>(points, cell),
            CellKind::Tri6 => element::bad_jacobian::<Tri6, 6>(points, cell),
        }
    }
}
