//! Bodies and their meshes.

use fe_core::{Dilatation, GridAxis, Pole};
use serde::{Deserialize, Serialize};

/// One deformable body: a mesh of one material.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Body {
    /// Where the mesh comes from.
    pub mesh: Mesh,
    /// Name of the material.
    pub material: String,
    /// Initial velocity of the material at the origin, of all its nodes when it has no spin \[m/s\].
    #[serde(default)]
    pub velocity: [f64; 3],
    /// Initial rate of rotation about the origin \[rad/s\]; adds `spin x X` to the velocity.
    #[serde(default)]
    pub spin: [f64; 3],
    /// The change of volume that the law sees: a choice for nearly incompressible matter.
    #[serde(default)]
    pub dilatation: Dilatation,
}

impl Body {
    /// Initial velocity \[m/s\] of its node at `point` \[m\].
    pub fn velocity_at(&self, point: [f64; 3]) -> [f64; 3] {
        let turn = |i: usize, j: usize| self.spin[i] * point[j] - self.spin[j] * point[i];
        std::array::from_fn(|c| self.velocity[c] + turn((c + 1) % 3, (c + 2) % 3))
    }
}

/// What the third direction of a plane scene is like.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum Symmetry {
    /// Thick bodies that do not stretch along z; forces, masses and energies are those of 1 m of thickness.
    #[default]
    PlaneStrain,
    /// Bodies of revolution about the y axis, x is the radius; forces, masses and energies are those of the whole ring.
    Axisymmetric,
}

/// Mesh of a body. All meshes have the node set `all`; the other sets are of nodes and facets unless said.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum Mesh {
    /// Structured block. Sets `x_min` .. `z_max`.
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
    /// Half of a ball of hexahedra; its flat face is normal to z. Sets `dome`, `base`.
    HalfBall {
        /// Centre of the ball \[m\].
        center: [f64; 3],
        /// Radius \[m\].
        radius: f64,
        /// Cells on a quarter of a great circle before `refine` \[-\], raised to an even number.
        cells: usize,
        /// Which half.
        pole: Pole,
        /// Element, `Hex8` or `Hex27`.
        #[serde(default)]
        element: Element,
    },
    /// Plane structured rectangle. Sets `x_min` .. `y_max`.
    Rectangle {
        /// Smallest corner \[m\].
        min: [f64; 2],
        /// Largest corner \[m\].
        max: [f64; 2],
        /// Cells along x, y before `refine` \[-\].
        cells: [usize; 2],
        /// Size of the last cell over the size of the first along x, y \[-\]; 1 is uniform.
        #[serde(default = "uniform")]
        grading: [f64; 2],
        /// Element.
        #[serde(default)]
        element: PlaneElement,
    },
    /// Plane rectilinear mesh with graded axes. Sets `x_min` .. `y_max`.
    Grid {
        /// Lines along x.
        x: GridAxis,
        /// Lines along y.
        y: GridAxis,
        /// Element.
        #[serde(default)]
        element: PlaneElement,
        /// Radius of curvature of the top at x = 0 \[m\]: `y_max` bends down by `x^2 / (2 R)`; flat when absent.
        #[serde(default)]
        crown: Option<f64>,
    },
    /// Solid rectilinear mesh with graded axes. Sets `x_min` .. `z_max`.
    SolidGrid {
        /// Lines along x.
        x: GridAxis,
        /// Lines along y.
        y: GridAxis,
        /// Lines along z.
        z: GridAxis,
        /// Element.
        #[serde(default)]
        element: Element,
        /// Radius of curvature of the top at x = y = 0 \[m\]: `z_max` bends down by `(x^2 + y^2) / (2 R)`; flat when absent.
        #[serde(default)]
        crown: Option<f64>,
    },
    /// Disc. Set `rim`, node set `center` (the node nearest the centre).
    Disc {
        /// Centre \[m\].
        center: [f64; 2],
        /// Radius \[m\].
        radius: f64,
        /// Cells on a quarter of the rim before `refine` \[-\]; an even number has nodes at the centre and at the poles.
        cells: usize,
        /// Element.
        #[serde(default)]
        element: PlaneElement,
    },
    /// Half of a disc of quadrilaterals; its flat side is normal to y. Sets `dome`, `base`.
    HalfDisc {
        /// Centre of the disc \[m\].
        center: [f64; 2],
        /// Radius \[m\].
        radius: f64,
        /// Cells on a quarter of the rim before `refine` \[-\], raised to an even number.
        cells: usize,
        /// Which half.
        pole: Pole,
        /// Element.
        #[serde(default)]
        element: PlaneElement,
    },
    /// Quarter of a disc of quadrilaterals, x not below that of the centre: half of a ball in an axisymmetric scene.
    /// Sets `dome`, `base` (normal to y), `axis` (normal to x).
    QuarterDisc {
        /// Centre of the disc \[m\].
        center: [f64; 2],
        /// Radius \[m\].
        radius: f64,
        /// Cells on the quarter of the rim before `refine` \[-\], raised to an even number.
        cells: usize,
        /// Which quarter.
        pole: Pole,
        /// Element.
        #[serde(default)]
        element: PlaneElement,
    },
    /// Ring of quadrilaterals. Sets `inner`, `outer`.
    Annulus {
        /// Centre \[m\].
        center: [f64; 2],
        /// Inner radius \[m\].
        inner: f64,
        /// Outer radius \[m\].
        outer: f64,
        /// Cells around and through the thickness before `refine` \[-\].
        cells: [usize; 2],
        /// Size of the outermost cell over the size of the innermost \[-\]; 1 is uniform.
        #[serde(default = "one")]
        grading: f64,
        /// Element.
        #[serde(default)]
        element: PlaneElement,
    },
}

fn uniform<const N: usize>() -> [f64; N] {
    [1.0; N]
}

fn one() -> f64 {
    1.0
}

/// Element of a solid mesh.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum Element {
    /// Hexahedron with 8 nodes.
    #[default]
    Hex8,
    /// Tetrahedron with 4 nodes; six of them fill a cell of a box.
    Tet4,
    /// Quadratic hexahedron with 27 nodes: two edges of a `Hex8` in each direction.
    Hex27,
    /// Quadratic tetrahedron with 10 nodes; six of them fill a cell of a box.
    Tet10,
}

/// Element of a plane mesh.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum PlaneElement {
    /// Quadrilateral with 4 nodes.
    #[default]
    Quad4,
    /// Triangle with 3 nodes; two of them fill a quadrilateral.
    Tri3,
    /// Quadratic quadrilateral with 9 nodes.
    Quad9,
    /// Quadratic triangle with 6 nodes; two of them fill a quadrilateral.
    Tri6,
}

/// Counts of a mesh.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct MeshSize {
    /// Nodes \[-\].
    pub nodes: usize,
    /// Elements \[-\].
    pub elements: usize,
    /// Displacement unknowns, two or three a node, prescribed ones included \[-\].
    pub dofs: usize,
}

impl Mesh {
    /// True for a mesh in the x-y plane.
    pub fn is_plane(&self) -> bool {
        !matches!(
            self,
            Mesh::Box { .. } | Mesh::SolidGrid { .. } | Mesh::HalfBall { .. }
        )
    }

    /// Counts of the mesh with each cell count multiplied by `refine`.
    pub fn size(&self, refine: usize) -> MeshSize {
        let fine = |n: usize| n as f64 * refine as f64;
        let half = |n: usize| (0.5 * fine(n)).ceil();
        let lines = |axis: &GridAxis| axis.cells().map_or(0.0, |cells| fine(cells));
        let (corners, cells) = match self {
            Mesh::Box { cells, .. } => lattice(&cells.map(fine)),
            Mesh::SolidGrid { x, y, z, .. } => lattice(&[x, y, z].map(lines)),
            Mesh::Grid { x, y, .. } => lattice(&[x, y].map(lines)),
            Mesh::Rectangle { cells, .. } => lattice(&cells.map(fine)),
            Mesh::Annulus { cells, .. } => {
                let [around, through] = cells.map(fine);
                (around * (through + 1.0), around * through)
            }
            Mesh::Disc { cells, .. } => {
                let n = fine(*cells);
                round(n * n, (n + 1.0).powi(2), 4.0 * n, 4.0 * n, n)
            }
            Mesh::HalfDisc { cells, .. } => {
                let h = half(*cells);
                let core = (2.0 * h + 1.0) * (h + 1.0);
                round(2.0 * h * h, core, 4.0 * h, 4.0 * h + 1.0, 2.0 * h)
            }
            Mesh::QuarterDisc { cells, .. } => {
                let h = half(*cells);
                round(h * h, (h + 1.0).powi(2), 2.0 * h, 2.0 * h + 1.0, 2.0 * h)
            }
            Mesh::HalfBall { cells, .. } => {
                let h = half(*cells);
                let (top, sides) = ((2.0 * h + 1.0).powi(2), 8.0 * h * h);
                let (core, shell) = (4.0 * h.powi(3), 12.0 * h * h);
                round(core, top * (h + 1.0), shell, top + sides, 2.0 * h)
            }
        };
        // Quadratic cells have a node for each edge, face and cell too; Euler's formula counts them.
        let outside = |[a, b, c]: [f64; 3]| 2.0 * (a * b + b * c + c * a);
        let around = |faces: f64| corners + 6.0 * cells + faces - 1.0;
        let between = match self {
            Mesh::Box { cells, .. } => around(outside(cells.map(fine))),
            Mesh::SolidGrid { x, y, z, .. } => around(outside([x, y, z].map(lines))),
            Mesh::HalfBall { cells, .. } => {
                let h = half(*cells);
                around(16.0 * h * h + 8.0 * h * layers(2.0 * h))
            }
            Mesh::Annulus { .. } => corners + 2.0 * cells,
            _ => corners + 2.0 * cells - 1.0,
        };
        let (per_cell, quadratic) = self.element();
        let nodes = corners + if quadratic { between } else { 0.0 };
        let dim = if self.is_plane() { 2.0 } else { 3.0 };
        MeshSize {
            nodes: nodes as usize,
            elements: (per_cell * cells) as usize,
            dofs: (dim * nodes) as usize,
        }
    }

    /// Elements a quadrilateral or hexahedron of the mesh, and whether they are quadratic.
    fn element(&self) -> (f64, bool) {
        match self {
            Mesh::Box { element, .. }
            | Mesh::SolidGrid { element, .. }
            | Mesh::HalfBall { element, .. } => match element {
                Element::Hex8 => (1.0, false),
                Element::Tet4 => (6.0, false),
                Element::Hex27 => (1.0, true),
                Element::Tet10 => (6.0, true),
            },
            Mesh::Rectangle { element, .. }
            | Mesh::Grid { element, .. }
            | Mesh::Disc { element, .. }
            | Mesh::HalfDisc { element, .. }
            | Mesh::QuarterDisc { element, .. }
            | Mesh::Annulus { element, .. } => match element {
                PlaneElement::Quad4 => (1.0, false),
                PlaneElement::Tri3 => (2.0, false),
                PlaneElement::Quad9 => (1.0, true),
                PlaneElement::Tri6 => (2.0, true),
            },
        }
    }

    /// Names of the node sets.
    pub fn node_sets(&self) -> &'static [&'static str] {
        match self {
            Mesh::Box { .. } | Mesh::SolidGrid { .. } => {
                &["x_min", "x_max", "y_min", "y_max", "z_min", "z_max", "all"]
            }
            Mesh::Rectangle { .. } | Mesh::Grid { .. } => {
                &["x_min", "x_max", "y_min", "y_max", "all"]
            }
            Mesh::Disc { .. } => &["rim", "center", "all"],
            Mesh::HalfDisc { .. } | Mesh::HalfBall { .. } => &["dome", "base", "all"],
            Mesh::QuarterDisc { .. } => &["dome", "base", "axis", "all"],
            Mesh::Annulus { .. } => &["inner", "outer", "all"],
        }
    }

    /// Names of the facet sets.
    pub fn facet_sets(&self) -> &'static [&'static str] {
        match self {
            Mesh::Box { .. } | Mesh::SolidGrid { .. } => {
                &["x_min", "x_max", "y_min", "y_max", "z_min", "z_max"]
            }
            Mesh::Rectangle { .. } | Mesh::Grid { .. } => &["x_min", "x_max", "y_min", "y_max"],
            Mesh::Disc { .. } => &["rim"],
            Mesh::HalfDisc { .. } | Mesh::HalfBall { .. } => &["dome", "base"],
            Mesh::QuarterDisc { .. } => &["dome", "base", "axis"],
            Mesh::Annulus { .. } => &["inner", "outer"],
        }
    }
}

/// Corners and cells of a grid.
fn lattice(cells: &[f64]) -> (f64, f64) {
    let nodes = cells.iter().map(|n| n + 1.0).product();
    (nodes, cells.iter().product())
}

/// Corners and cells of a core and of the shells around it, from those of the core and of its outside; `quarter` is the
/// number of cells on a quarter of the rim.
fn round(core_cells: f64, core_nodes: f64, cells: f64, nodes: f64, quarter: f64) -> (f64, f64) {
    let shells = layers(quarter);
    (core_nodes + nodes * shells, core_cells + cells * shells)
}

/// Shells around a core.
fn layers(quarter: f64) -> f64 {
    ((2.0 * quarter + 2.0) / 5.0).floor().max(1.0)
}
