//! Pieces of boundary.

/// Shape of a facet. Its nodes are the corners in order, then the middles of the edges in order, then the centre.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum FacetKind {
    /// Straight edge of a plane body.
    Edge2,
    /// Edge of a plane body with a middle.
    Edge3,
    /// Triangle.
    Tri3,
    /// Triangle with middles of its edges.
    Tri6,
    /// Quadrilateral.
    Quad4,
    /// Quadrilateral with middles of its edges and a centre.
    Quad9,
}

impl FacetKind {
    /// Nodes of a facet.
    pub const fn node_count(self) -> usize {
        match self {
            FacetKind::Edge2 => 2,
            FacetKind::Edge3 | FacetKind::Tri3 => 3,
            FacetKind::Quad4 => 4,
            FacetKind::Tri6 => 6,
            FacetKind::Quad9 => 9,
        }
    }

    /// Unknowns a node of the bodies that have such facets, 2 or 3.
    pub const fn dim(self) -> usize {
        match self {
            FacetKind::Edge2 | FacetKind::Edge3 => 2,
            FacetKind::Tri3 | FacetKind::Tri6 | FacetKind::Quad4 | FacetKind::Quad9 => 3,
        }
    }

    /// The facet of degree 2 with the same corners.
    pub(crate) const fn quadratic(self) -> FacetKind {
        match self {
            FacetKind::Edge2 | FacetKind::Edge3 => FacetKind::Edge3,
            FacetKind::Tri3 | FacetKind::Tri6 => FacetKind::Tri6,
            FacetKind::Quad4 | FacetKind::Quad9 => FacetKind::Quad9,
        }
    }

    /// For each node beyond the corners, the corners in whose middle it lies; none for facets of degree 1.
    pub(crate) fn parents(self) -> &'static [&'static [usize]] {
        match self {
            FacetKind::Edge2 | FacetKind::Tri3 | FacetKind::Quad4 => &[],
            FacetKind::Edge3 => &[&[0, 1]],
            FacetKind::Tri6 => &TRIANGLE_PARENTS,
            FacetKind::Quad9 => &QUADRILATERAL_PARENTS,
        }
    }

    /// Local nodes of the facets of degree 1 into which it is cut, and their kind.
    fn pieces(self) -> (FacetKind, &'static [&'static [usize]]) {
        match self {
            FacetKind::Edge2 => (self, &[&[0, 1]]),
            FacetKind::Edge3 => (FacetKind::Edge2, &[&[0, 2], &[2, 1]]),
            FacetKind::Tri3 => (self, &[&[0, 1, 2]]),
            FacetKind::Tri6 => (FacetKind::Tri3, &TRIANGLES),
            FacetKind::Quad4 => (self, &[&[0, 1, 2, 3]]),
            FacetKind::Quad9 => (FacetKind::Quad4, &QUADRILATERALS),
        }
    }
}

/// Corners between which the other nodes lie.
pub(super) static TRIANGLE_PARENTS: [&[usize]; 3] = [&[0, 1], &[1, 2], &[2, 0]];

/// Corners between which the other nodes lie.
pub(super) static QUADRILATERAL_PARENTS: [&[usize]; 5] =
    [&[0, 1], &[1, 2], &[2, 3], &[3, 0], &[0, 1, 2, 3]];

/// Pieces of a quadratic triangle and quadrilateral.
static TRIANGLES: [&[usize]; 4] = [&[0, 3, 5], &[3, 1, 4], &[5, 4, 2], &[3, 4, 5]];
static QUADRILATERALS: [&[usize]; 4] = [&[0, 4, 8, 7], &[4, 1, 5, 8], &[8, 5, 2, 6], &[7, 8, 6, 3]];

/// A piece of boundary.
///
/// Seen from outside the body the corners turn counter-clockwise (right-hand rule); in the plane the
/// body lies to the left of the way from the first node to the second.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[non_exhaustive]
pub struct Facet {
    /// Shape, which gives the number of nodes.
    pub kind: FacetKind,
    /// Node indices; the entries that are not used are `u32::MAX`.
    pub nodes: [u32; 9],
}

impl Facet {
    /// An edge of a plane body.
    #[must_use]
    pub fn edge(nodes: [u32; 2]) -> Facet {
        Facet::new(FacetKind::Edge2, nodes)
    }

    /// A triangle.
    #[must_use]
    pub fn triangle(nodes: [u32; 3]) -> Facet {
        Facet::new(FacetKind::Tri3, nodes)
    }

    /// A quadrilateral.
    #[must_use]
    pub fn quad(nodes: [u32; 4]) -> Facet {
        Facet::new(FacetKind::Quad4, nodes)
    }

    /// A facet of any kind; nodes in excess of those of the kind are ignored.
    #[must_use]
    pub fn new(kind: FacetKind, given: impl IntoIterator<Item = u32>) -> Facet {
        let mut nodes = [u32::MAX; 9];
        let used = nodes[..kind.node_count()].iter_mut();
        used.zip(given).for_each(|(slot, node)| *slot = node);
        Facet { kind, nodes }
    }

    /// The nodes that are used.
    pub fn nodes(&self) -> &[u32] {
        &self.nodes[..self.kind.node_count()]
    }

    /// The facets of degree 1 between its nodes: one, or two edges, four triangles or four quadrilaterals.
    pub fn pieces(&self) -> impl Iterator<Item = Facet> + '_ {
        let (kind, cut) = self.kind.pieces();
        let piece = move |local: &&[usize]| self.part(kind, local);
        cut.iter().map(piece)
    }

    /// Facet of a cell from its local node numbers.
    pub(crate) fn of_cell(kind: FacetKind, cell: &[u32], local: &[usize]) -> Facet {
        Facet::new(kind, local.iter().map(|&a| cell[a]))
    }

    fn part(&self, kind: FacetKind, local: &[usize]) -> Facet {
        Facet::of_cell(kind, &self.nodes, local)
    }

    /// Nodes in increasing order: equal for the two cells that share the facet.
    pub(crate) fn key(&self) -> [u32; 9] {
        let mut key = self.nodes;
        key.sort_unstable();
        key
    }
}
