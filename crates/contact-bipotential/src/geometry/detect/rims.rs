//! Rims of a surface: the sides of its facets that no other facet shares.

/// Corners of a facet by surface index: 2 on a line, 3 on a triangle, 4 on a quadrilateral.
#[derive(Clone, Copy, Debug)]
pub(super) struct Corners {
    indices: [u32; 4],
    count: u8,
}

impl Corners {
    /// Corners beyond the fourth are ignored.
    pub(super) fn new(corners: &[u32]) -> Self {
        let mut indices = [0; 4];
        let count = corners.len().min(4);
        indices[..count].copy_from_slice(&corners[..count]);
        Self {
            indices,
            count: count as u8,
        }
    }

    pub(super) fn indices(&self) -> &[u32] {
        &self.indices[..self.count as usize]
    }

    /// The same corners by other numbers.
    pub(super) fn map(&self, number: impl Fn(u32) -> u32) -> Self {
        let mut mapped = *self;
        for index in &mut mapped.indices[..self.count as usize] {
            *index = number(*index);
        }
        mapped
    }

    /// The nodes of side `k`, the same for all facets that share it: an edge of a face, a vertex of a line (twice). A
    /// collapsed side (a quadrilateral with two equal nodes) bounds nothing.
    fn side(&self, k: usize) -> Option<(u32, u32)> {
        let corners = self.indices();
        let (a, b) = (corners[k], corners[(k + 1) % corners.len()]);
        match (a == b, corners.len()) {
            (true, _) => None,
            (false, 2) => Some((a, a)),
            (false, _) => Some((a.min(b), a.max(b))),
        }
    }
}

/// The rims of a surface, by facet and by node.
#[derive(Debug)]
pub(super) struct Rims {
    /// Bit `k`: side `k` of the facet (edge of a face, vertex of a line) belongs to no other facet.
    sides: Vec<u8>,
    /// Rim sides (facet, side) at each surface node: `at_nodes[starts[i]..starts[i + 1]]`.
    starts: Vec<usize>,
    at_nodes: Vec<(u32, u8)>,
}

impl Rims {
    /// The rims of a surface with `nodes` nodes.
    pub(super) fn new(facets: &[Corners], nodes: usize) -> Self {
        let mut sides: Vec<((u32, u32), usize, usize)> = Vec::new();
        for (f, facet) in facets.iter().enumerate() {
            let own = (0..facet.indices().len()).filter_map(|k| Some((facet.side(k)?, f, k)));
            sides.extend(own);
        }
        sides.sort_unstable();
        let mut mask = vec![0; facets.len()];
        for same in sides.chunk_by(|a, b| a.0 == b.0) {
            if let [(_, f, k)] = same {
                mask[*f] |= 1 << k;
            }
        }
        Self::of_sides(facets, mask, nodes)
    }

    /// The same without the sides that start at one of the given nodes: the surface goes on there.
    pub(super) fn without(&self, facets: &[Corners], continued: &[bool]) -> Self {
        let mut mask = self.sides.clone();
        for (facet, mask) in facets.iter().zip(&mut mask) {
            for (k, corner) in facet.indices().iter().enumerate() {
                *mask &= !(u8::from(continued[*corner as usize]) << k);
            }
        }
        Self::of_sides(facets, mask, continued.len())
    }

    fn of_sides(facets: &[Corners], sides: Vec<u8>, nodes: usize) -> Self {
        let mut all: Vec<(u32, u32, u8)> = Vec::new();
        for (f, (facet, sides)) in facets.iter().zip(&sides).enumerate() {
            for k in (0..facet.indices().len()).filter(|k| sides & (1 << k) != 0) {
                if let Some((a, b)) = facet.side(k) {
                    all.extend([(a, f as u32, k as u8), (b, f as u32, k as u8)]);
                }
            }
        }
        all.sort_unstable();
        all.dedup();
        let mut starts = vec![0; nodes + 1];
        for (node, ..) in &all {
            starts[*node as usize + 1] += 1;
        }
        for i in 0..nodes {
            starts[i + 1] += starts[i];
        }
        Self {
            sides,
            starts,
            at_nodes: all.into_iter().map(|(_, f, k)| (f, k)).collect(),
        }
    }

    /// Whether side `k` of a facet is a rim.
    pub(super) fn is_rim(&self, facet: u32, k: u8) -> bool {
        self.sides[facet as usize] & (1 << k) != 0
    }

    /// Rim sides (facet, side) at a node, by surface index.
    pub(super) fn at_node(&self, index: u32) -> &[(u32, u8)] {
        let index = index as usize;
        &self.at_nodes[self.starts[index]..self.starts[index + 1]]
    }
}
