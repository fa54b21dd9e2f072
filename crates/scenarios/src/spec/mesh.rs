//! Meshes of bodies: the shapes of `fe-core`, as a scene names them.

use fe_core::{
    AnnulusMesh, BoxMesh, CellKind, DiscMesh, GridAxis, GridMesh, HalfBallMesh, HalfDiscMesh,
    MeshError, QuarterDiscMesh, RectangleMesh, text,
};
use serde::{Deserialize, Serialize};

use super::variants::struct_variants;

struct_variants! {
    /// Mesh of a body. All meshes have the node set `all`; the other sets are of nodes and facets unless said. Cells
    /// are counted before the `refine` of the scene.
    #[derive(Clone, Debug, PartialEq, Serialize)]
    pub enum Mesh {
        /// Structured block. Sets `x_min` .. `z_max`.
        Box(BoxMesh),
        /// Half of a ball of hexahedra; its flat face is normal to z. Sets `dome`, `base`.
        HalfBall(HalfBallMesh),
        /// Plane structured rectangle. Sets `x_min` .. `y_max`.
        Rectangle(RectangleMesh),
        /// Plane rectilinear mesh with graded axes. Sets `x_min` .. `y_max`.
        Grid(PlaneGrid),
        /// Solid rectilinear mesh with graded axes. Sets `x_min` .. `z_max`.
        SolidGrid(SolidGrid),
        /// Disc. Set `rim`, node set `center` (the node nearest the centre).
        Disc(DiscMesh),
        /// Half of a disc of quadrilaterals; its flat side is normal to y. Sets `dome`, `base`.
        HalfDisc(HalfDiscMesh),
        /// Quarter of a disc of quadrilaterals, x not below that of the centre: half of a ball in an axisymmetric
        /// scene. Sets `dome`, `base` (normal to y), `axis` (normal to x).
        QuarterDisc(QuarterDiscMesh),
        /// Ring of quadrilaterals. Sets `inner`, `outer`.
        Annulus(AnnulusMesh),
    }
}

/// A plane rectilinear mesh.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PlaneGrid {
    /// Lines along x.
    pub x: GridAxis,
    /// Lines along y.
    pub y: GridAxis,
    /// A kind of plane cells.
    #[serde(
        rename = "element",
        default = "text::quadrilaterals",
        with = "text::plane"
    )]
    pub kind: CellKind,
    /// Radius of curvature of the top at x = 0 \[m\]: `y_max` bends down by `x^2 / (2 R)`; flat when absent.
    #[serde(default)]
    pub crown: Option<f64>,
}

/// A solid rectilinear mesh.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SolidGrid {
    /// Lines along x.
    pub x: GridAxis,
    /// Lines along y.
    pub y: GridAxis,
    /// Lines along z.
    pub z: GridAxis,
    /// A kind of solid cells.
    #[serde(rename = "element", default = "text::hexahedra", with = "text::solid")]
    pub kind: CellKind,
    /// Radius of curvature of the top at x = y = 0 \[m\]: `z_max` bends down by `(x^2 + y^2) / (2 R)`; flat when
    /// absent.
    #[serde(default)]
    pub crown: Option<f64>,
}

impl PlaneGrid {
    fn generate(&self, refine: usize, name: &str) -> Result<fe_core::Mesh, MeshError> {
        let axes = vec![self.x.clone(), self.y.clone()];
        grid(axes, refine, self.kind, self.crown, name)
    }
}

impl SolidGrid {
    fn generate(&self, refine: usize, name: &str) -> Result<fe_core::Mesh, MeshError> {
        let axes = vec![self.x.clone(), self.y.clone(), self.z.clone()];
        grid(axes, refine, self.kind, self.crown, name)
    }
}

fn grid(
    axes: Vec<GridAxis>,
    refine: usize,
    kind: CellKind,
    crown: Option<f64>,
    name: &str,
) -> Result<fe_core::Mesh, MeshError> {
    let grid = GridMesh::new(axes, kind).with_refine(refine);
    match crown {
        Some(radius) => grid.generate_crowned(name, radius),
        None => grid.generate(name),
    }
}

/// Counts of a mesh.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
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
        self.kind().dim() == 2
    }

    /// Counts of the mesh with each cell count multiplied by `refine`.
    #[must_use]
    pub fn size(&self, refine: usize) -> MeshSize {
        let fine = |n: usize| n as f64 * refine as f64;
        let half = |n: usize| (0.5 * fine(n)).ceil();
        let lines = |axis: &GridAxis| axis.cells().map_or(0.0, fine);
        let (corners, cells) = self.corners_and_cells(refine);
        // Quadratic cells have a node for each edge, face and cell too; Euler's formula counts them.
        let outside = |[a, b, c]: [f64; 3]| 2.0 * (a * b + b * c + c * a);
        let around = |faces: f64| corners + 6.0 * cells + faces - 1.0;
        let between = match self {
            Mesh::Box(m) => around(outside(m.cells.map(fine))),
            Mesh::SolidGrid(m) => around(outside([&m.x, &m.y, &m.z].map(lines))),
            Mesh::HalfBall(m) => {
                let h = half(m.cells);
                around(16.0 * h * h + 8.0 * h * layers(2.0 * h))
            }
            Mesh::Annulus(_) => corners + 2.0 * cells,
            _ => corners + 2.0 * cells - 1.0,
        };
        let kind = self.kind();
        let nodes = corners + if kind.degree() == 2 { between } else { 0.0 };
        MeshSize {
            nodes: nodes as usize,
            elements: (elements_per_cell(kind) * cells) as usize,
            dofs: (kind.dim() as f64 * nodes) as usize,
        }
    }

    /// Corners, and quadrilaterals or hexahedra, with each cell count multiplied by `refine`.
    fn corners_and_cells(&self, refine: usize) -> (f64, f64) {
        let fine = |n: usize| n as f64 * refine as f64;
        let half = |n: usize| (0.5 * fine(n)).ceil();
        let lines = |axis: &GridAxis| axis.cells().map_or(0.0, fine);
        match self {
            Mesh::Box(m) => lattice(&m.cells.map(fine)),
            Mesh::SolidGrid(m) => lattice(&[&m.x, &m.y, &m.z].map(lines)),
            Mesh::Grid(m) => lattice(&[&m.x, &m.y].map(lines)),
            Mesh::Rectangle(m) => lattice(&m.cells.map(fine)),
            Mesh::Annulus(m) => {
                let [around, through] = m.cells.map(fine);
                (around * (through + 1.0), around * through)
            }
            Mesh::Disc(m) => {
                let n = fine(m.cells);
                round(n * n, (n + 1.0).powi(2), 4.0 * n, 4.0 * n, n)
            }
            Mesh::HalfDisc(m) => {
                let h = half(m.cells);
                let core = (2.0 * h + 1.0) * (h + 1.0);
                round(2.0 * h * h, core, 4.0 * h, 4.0 * h + 1.0, 2.0 * h)
            }
            Mesh::QuarterDisc(m) => {
                let h = half(m.cells);
                round(h * h, (h + 1.0).powi(2), 2.0 * h, 2.0 * h + 1.0, 2.0 * h)
            }
            Mesh::HalfBall(m) => {
                let h = half(m.cells);
                let (top, sides) = ((2.0 * h + 1.0).powi(2), 8.0 * h * h);
                let (core, shell) = (4.0 * h.powi(3), 12.0 * h * h);
                round(core, top * (h + 1.0), shell, top + sides, 2.0 * h)
            }
        }
    }

    /// Smallest x of a plane mesh \[m\], 0 for a solid one.
    pub(crate) fn leftmost(&self) -> f64 {
        match self {
            Mesh::Rectangle(m) => m.min[0],
            Mesh::Grid(m) => m.x.pieces.iter().map(|p| p.to()).fold(m.x.from, f64::min),
            Mesh::Disc(m) => m.center[0] - m.radius,
            Mesh::HalfDisc(m) => m.center[0] - m.radius,
            Mesh::QuarterDisc(m) => m.center[0],
            Mesh::Annulus(m) => m.center[0] - m.outer,
            Mesh::Box(_) | Mesh::SolidGrid(_) | Mesh::HalfBall(_) => 0.0,
        }
    }

    /// Kind of its cells.
    pub fn kind(&self) -> CellKind {
        match self {
            Mesh::Box(m) => m.kind,
            Mesh::HalfBall(m) => m.kind,
            Mesh::Rectangle(m) => m.kind,
            Mesh::Grid(m) => m.kind,
            Mesh::SolidGrid(m) => m.kind,
            Mesh::Disc(m) => m.kind,
            Mesh::HalfDisc(m) => m.kind,
            Mesh::QuarterDisc(m) => m.kind,
            Mesh::Annulus(m) => m.kind,
        }
    }

    /// Makes the mesh with each cell count multiplied by `refine`; its block gets the name `name`.
    ///
    /// # Errors
    /// Those of the shape.
    pub fn generate(&self, refine: usize, name: &str) -> Result<fe_core::Mesh, MeshError> {
        match self {
            Mesh::Box(m) => m.refined(refine).generate(name),
            Mesh::HalfBall(m) => m.refined(refine).generate(name),
            Mesh::Rectangle(m) => m.refined(refine).generate(name),
            Mesh::Grid(m) => m.generate(refine, name),
            Mesh::SolidGrid(m) => m.generate(refine, name),
            Mesh::Disc(m) => m.refined(refine).generate(name),
            Mesh::HalfDisc(m) => m.refined(refine).generate(name),
            Mesh::QuarterDisc(m) => m.refined(refine).generate(name),
            Mesh::Annulus(m) => m.refined(refine).generate(name),
        }
    }

    /// Names of the node sets: those of the facets, the nodes at single places, and `all`.
    #[must_use]
    pub fn node_sets(&self) -> Vec<&'static str> {
        let places: &[&str] = match self {
            Mesh::Disc(_) => &["center"],
            _ => &[],
        };
        [self.facet_sets(), places, &["all"]].concat()
    }

    /// Names of the facet sets.
    pub fn facet_sets(&self) -> &'static [&'static str] {
        match self {
            Mesh::Box(_) | Mesh::SolidGrid(_) => {
                &["x_min", "x_max", "y_min", "y_max", "z_min", "z_max"]
            }
            Mesh::Rectangle(_) | Mesh::Grid(_) => &["x_min", "x_max", "y_min", "y_max"],
            Mesh::Disc(_) => &["rim"],
            Mesh::HalfDisc(_) | Mesh::HalfBall(_) => &["dome", "base"],
            Mesh::QuarterDisc(_) => &["dome", "base", "axis"],
            Mesh::Annulus(_) => &["inner", "outer"],
        }
    }
}

/// Elements that a quadrilateral or hexahedron of a mesh is cut into.
fn elements_per_cell(kind: CellKind) -> f64 {
    match kind.linear() {
        CellKind::Tri3 => 2.0,
        CellKind::Tet4 => 6.0,
        _ => 1.0,
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
