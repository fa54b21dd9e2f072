//! Bodies and their meshes.

use serde::{Deserialize, Serialize};

/// One deformable body: a mesh of one material.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Body {
    /// Where the mesh comes from.
    pub mesh: Mesh,
    /// Name of the material.
    pub material: String,
    /// Initial velocity of all its nodes \[m/s\].
    #[serde(default)]
    pub velocity: [f64; 3],
}

/// Mesh of a body.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum Mesh {
    /// Structured block. Sets `x_min` .. `z_max` (nodes and facets), `all` (nodes).
    Box {
        /// Smallest corner \[m\].
        min: [f64; 3],
        /// Largest corner \[m\].
        max: [f64; 3],
        /// Cells along x, y, z before `refine` \[-\].
        cells: [usize; 3],
        /// Size of the last cell over the size of the first along x, y, z \[-\]; 1 is uniform.
        #[serde(default = "uniform")]
        grading: [f64; 3],
        /// Element.
        #[serde(default)]
        element: Element,
    },
}

fn uniform() -> [f64; 3] {
    [1.0; 3]
}

/// Element of a mesh.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum Element {
    /// Hexahedron with 8 nodes.
    #[default]
    Hex8,
    /// Tetrahedron with 4 nodes; six of them fill a cell of a box.
    Tet4,
}

/// Counts of a mesh.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct BoxSize {
    /// Nodes \[-\].
    pub nodes: usize,
    /// Elements \[-\].
    pub elements: usize,
}

impl BoxSize {
    /// Displacement unknowns, three a node \[-\].
    pub fn dofs(self) -> usize {
        3 * self.nodes
    }
}

impl Mesh {
    /// Counts of the mesh with each cell count multiplied by `refine`.
    pub fn size(&self, refine: usize) -> BoxSize {
        let Mesh::Box { cells, element, .. } = self;
        let fine = cells.map(|c| c.saturating_mul(refine));
        let product = |n: [usize; 3]| n.into_iter().fold(1, usize::saturating_mul);
        let per_cell = match element {
            Element::Hex8 => 1,
            Element::Tet4 => 6,
        };
        BoxSize {
            nodes: product(fine.map(|c| c.saturating_add(1))),
            elements: product(fine).saturating_mul(per_cell),
        }
    }

    /// Names of the node sets.
    pub fn node_sets(&self) -> &'static [&'static str] {
        match self {
            Mesh::Box { .. } => &["x_min", "x_max", "y_min", "y_max", "z_min", "z_max", "all"],
        }
    }

    /// Names of the facet sets.
    pub fn facet_sets(&self) -> &'static [&'static str] {
        match self {
            Mesh::Box { .. } => &["x_min", "x_max", "y_min", "y_max", "z_min", "z_max"],
        }
    }
}
