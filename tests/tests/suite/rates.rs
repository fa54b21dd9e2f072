//! How fast the elements converge: `h^(k+1)` in displacement and `h^k` in energy for degree `k`.

use std::f64::consts::FRAC_PI_2;

use fe_core::{
    BoxMesh, CellKind, Dirichlet, Element, Hex8, Hex27, Interpolation, Mesh, Quad4, Quad9,
    QuadraturePoint, RectangleMesh, Solid, Symmetry, Table, Tet4, Tet10, Tri3, Tri6, corner_points,
    reference_gradients, solid_block,
};
use hyperelastic::{ElasticConstants, Material, NeoHookean, right_cauchy_green};
use nalgebra::Matrix3;
use nscd::{Load, Model, NoClock, Scheme, Settings, Span, Stepper, Totals, march};

const SHEAR: f64 = 1.0;
const LAME: f64 = 1.5;

type Vec3 = [f64; 3];
type Mat3 = [Vec3; 3];

/// What loads the body so that its displacement is known.
#[derive(Clone, Copy)]
enum Loading {
    /// Body force and tractions of the finite deformation `exact`, in their weak form: `int P dN/dX dV`.
    Manufactured,
    /// Pressure on `x_min`, at small strain.
    Pressure(f64),
}

/// A problem with a known solution on the unit square or cube, or on what they are bent to.
#[derive(Clone, Copy)]
struct Problem {
    symmetry: Symmetry,
    shape: fn(Vec3) -> Vec3,
    exact: fn(Vec3) -> Vec3,
    loading: Loading,
    /// Cells along y for each along x.
    along: usize,
    /// Held sides and their components.
    held: &'static [(&'static str, [bool; 3])],
}

/// A quadrature point of an element.
struct Place<const N: usize> {
    x: Vec3,
    shape: [f64; N],
    /// With `N_a/R` in the third row if axisymmetric.
    gradients: [[f64; N]; 3],
    volume: f64,
}

fn law() -> NeoHookean {
    NeoHookean::new(ElasticConstants::from_shear_lame(SHEAR, LAME).unwrap()).unwrap()
}

/// Five Gauss points a direction; triangles and tetrahedra are squares and cubes with a side shrunk to a point.
fn fine_rule(kind: CellKind) -> Vec<QuadraturePoint> {
    let (x1, x2) = (0.538_469_310_105_683_1, 0.906_179_845_938_664);
    let (w0, w1, w2) = (
        0.568_888_888_888_888_9,
        0.478_628_670_499_366_47,
        0.236_926_885_056_189_08,
    );
    let line = [(-x2, w2), (-x1, w1), (0.0, w0), (x1, w1), (x2, w2)];
    let flat = [(0.0, 1.0)];
    let third: &[(f64, f64)] = if kind.dim() == 3 { &line } else { &flat };
    let mut rule = Vec::new();
    for (a, wa) in line {
        for (b, wb) in line {
            for &(c, wc) in third {
                let weight = wa * wb * wc;
                rule.push(match kind.linear() {
                    CellKind::Quad4 | CellKind::Hex8 => QuadraturePoint::new([a, b, c], weight),
                    _ => collapsed([a, b, c], weight, kind.dim()),
                });
            }
        }
    }
    rule
}

fn collapsed(xi: Vec3, weight: f64, dim: usize) -> QuadraturePoint {
    let [u, v, w] = xi.map(|x| 0.5 * (1.0 + x));
    if dim == 2 {
        return QuadraturePoint::new([u, v * (1.0 - u), 0.0], 0.25 * weight * (1.0 - u));
    }
    QuadraturePoint::new(
        [u, v * (1.0 - u), w * (1.0 - u) * (1.0 - v)],
        0.125 * weight * (1.0 - u).powi(2) * (1.0 - v),
    )
}

/// Calls `add` at the points of the fine rule in every cell.
fn visit<E, const N: usize>(mesh: &Mesh, mut add: impl FnMut(&[u32], &Place<N>))
where
    E: Element<Nodal = [f64; N]>,
{
    let rule = fine_rule(E::KIND);
    for cell in mesh.blocks[0].iter() {
        let corners = corner_points::<N>(&mesh.points, cell);
        for point in &rule {
            let (mut gradients, det) = reference_gradients::<E, N>(&corners, &point.xi);
            let shape = E::shape(&point.xi);
            let x = std::array::from_fn(|i| (0..N).map(|a| shape[a] * corners[a][i]).sum());
            let x: Vec3 = x;
            let mut volume = point.weight * det;
            if mesh.symmetry == Symmetry::Axisymmetric {
                gradients[2] = shape.map(|n| n / x[0]);
                volume *= std::f64::consts::TAU * x[0];
            }
            let place = Place {
                x,
                shape,
                gradients,
                volume,
            };
            add(cell, &place);
        }
    }
}

impl Problem {
    /// Gradient of the exact displacement, by differences of fourth order; the hoop strain is its last entry if
    /// axisymmetric.
    fn gradient(&self, x: Vec3) -> Mat3 {
        let step = 1e-3;
        let mut h = [[0.0; 3]; 3];
        for j in 0..self.symmetry.dim() {
            let at = |k: f64| {
                let mut moved = x;
                moved[j] += k * step;
                (self.exact)(moved)
            };
            let (far, near) = ([at(2.0), at(-2.0)], [at(1.0), at(-1.0)]);
            for i in 0..3 {
                h[i][j] =
                    (8.0 * (near[0][i] - near[1][i]) - (far[0][i] - far[1][i])) / (12.0 * step);
            }
        }
        if self.symmetry == Symmetry::Axisymmetric {
            h[2][2] = (self.exact)(x)[0] / x[0];
        }
        h
    }

    fn mesh(&self, kind: CellKind, n: usize) -> Mesh {
        let mut mesh = if kind.dim() == 2 {
            let square = RectangleMesh::uniform([0.0; 2], [1.0; 2], [n, self.along * n]);
            square.with_kind(kind).generate("body").unwrap()
        } else {
            let cube = BoxMesh::uniform([0.0; 3], [1.0; 3], [n; 3]);
            cube.with_kind(kind).generate("body").unwrap()
        };
        mesh.symmetry = self.symmetry;
        mesh.points
            .iter_mut()
            .for_each(|x| *x = (self.shape)((*x).into()).into());
        mesh
    }

    fn load<E, const N: usize>(&self, mesh: &Mesh) -> Vec<f64>
    where
        E: Element<Nodal = [f64; N]>,
    {
        let dim = mesh.dim;
        let mut load = vec![0.0; dim * mesh.points.len()];
        match self.loading {
            Loading::Pressure(p) => push(mesh, p, &mut load),
            Loading::Manufactured => visit::<E, N>(mesh, |cell, at| {
                let p = first_piola(&self.gradient(at.x));
                for (a, &node) in cell.iter().enumerate() {
                    let start = dim * node as usize;
                    for i in 0..dim {
                        let p = (0..dim).map(|j| p[i][j] * at.gradients[j][a]);
                        load[start + i] += at.volume * p.sum::<f64>();
                    }
                    if dim == 2 {
                        load[start] += at.volume * p[2][2] * at.gradients[2][a];
                    }
                }
            }),
        }
        load
    }

    /// Errors of the displacement and of the strain energy, `sqrt(int e.e dV)` and `sqrt(int 2 w(grad e) dV)`.
    fn errors<E, const N: usize>(&self, n: usize) -> [f64; 2]
    where
        E: Element<Nodal = [f64; N]>,
    {
        let mesh = self.mesh(E::KIND, n);
        let load = self.load::<E, N>(&mesh);
        let u = self.equilibrium(mesh.clone(), load);
        let (dim, mut squares) = (mesh.dim, [0.0; 2]);
        visit::<E, N>(&mesh, |cell, at| {
            let (exact, mut h) = ((self.exact)(at.x), self.gradient(at.x));
            let mut e = exact;
            for (a, &node) in cell.iter().enumerate() {
                for i in 0..dim {
                    let u = u[dim * node as usize + i];
                    e[i] -= at.shape[a] * u;
                    (0..dim).for_each(|j| h[i][j] -= at.gradients[j][a] * u);
                    if dim == 2 && i == 0 {
                        h[2][2] -= at.gradients[2][a] * u;
                    }
                }
            }
            squares[0] += at.volume * e.iter().map(|e| e * e).sum::<f64>();
            squares[1] += at.volume * energy(&h);
        });
        squares.map(f64::sqrt)
    }

    /// Displacement under the load, by the program's own steps.
    fn equilibrium(&self, mesh: Mesh, forces: Vec<f64>) -> Vec<f64> {
        let hold = |(set, components): &(&str, [bool; 3])| {
            let nodes = mesh.node_set(set).unwrap().to_vec();
            Dirichlet::clamped(set, nodes).with_components(*components)
        };
        let supports = self.held.iter().map(hold).collect();
        let mesh = mesh.validated().unwrap();
        let block = solid_block(&mesh, 0, law(), 1.0).unwrap();
        let solid = Solid::new(mesh, vec![block]).unwrap();
        let ramp = Table::new(vec![(0.0, 0.0), (1.0, 1.0)], Interpolation::Linear).unwrap();
        let mass = solid.lumped_mass();
        let mut model = Model::new(solid)
            .with_mass(mass)
            .with_load(Load::new(forces, ramp))
            .with_scheme(Scheme::quasi_static())
            .with_settings(Settings::default().with_newton_tolerance(1e-9));
        model.supports = supports;
        let mut stepper = Stepper::new(&model, Box::new(NoClock)).unwrap();
        let mut state = stepper.initial_state(vec![0.0; model.dof_count()]).unwrap();
        let span = Span::new(1.0, 1.0);
        let totals = &mut Totals::default();
        march(&mut stepper, &mut state, span, totals, &mut ()).unwrap();
        state.u
    }

    /// Slopes of both errors between `n` and `2 n` cells a side.
    fn check(&self, kind: CellKind, n: usize) -> String {
        let errors: fn(&Problem, usize) -> [f64; 2] = match kind {
            CellKind::Quad4 => Problem::errors::<Quad4, 4>,
            CellKind::Tri3 => Problem::errors::<Tri3, 3>,
            CellKind::Quad9 => Problem::errors::<Quad9, 9>,
            CellKind::Tri6 => Problem::errors::<Tri6, 6>,
            CellKind::Hex8 => Problem::errors::<Hex8, 8>,
            CellKind::Tet4 => Problem::errors::<Tet4, 4>,
            CellKind::Hex27 => Problem::errors::<Hex27, 27>,
            CellKind::Tet10 => Problem::errors::<Tet10, 10>,
        };
        let (coarse, fine) = (errors(self, n), errors(self, 2 * n));
        let slopes = [0, 1].map(|k| (coarse[k] / fine[k]).log2());
        let k = kind.degree() as f64;
        let good = (slopes[0] - k - 1.0).abs() < 0.1 && (slopes[1] - k).abs() < 0.1;
        if good {
            return String::new();
        }
        format!("{kind:?} {:?}: {slopes:?}\n", self.symmetry)
    }
}

/// `P = F S` of the law.
fn first_piola(h: &Mat3) -> Mat3 {
    let f = Matrix3::from_fn(|i, j| h[i][j]) + Matrix3::identity();
    assert!(f.determinant() > 0.1);
    let (_, s) = law().stress(&right_cauchy_green(&f)).unwrap();
    let p = hyperelastic::first_piola(&f, &s);
    std::array::from_fn(|i| std::array::from_fn(|j| p[(i, j)]))
}

/// Twice the energy of a small strain.
fn energy(h: &Mat3) -> f64 {
    let trace = h[0][0] + h[1][1] + h[2][2];
    let mut sum = LAME * trace * trace;
    for i in 0..3 {
        for j in 0..3 {
            let strain = 0.5 * (h[i][j] + h[j][i]);
            sum += 2.0 * SHEAR * strain * strain;
        }
    }
    sum
}

/// Nodal forces of a pressure on the edges of `x_min` as they are, curved ones too.
fn push(mesh: &Mesh, pressure: f64, load: &mut [f64]) {
    let g = 0.6_f64.sqrt();
    for facet in mesh.facet_set("x_min").unwrap() {
        let x = |a: usize| mesh.points[facet.nodes()[a] as usize];
        for (s, weight) in [(-g, 5.0 / 9.0), (0.0, 8.0 / 9.0), (g, 5.0 / 9.0)] {
            // Ends, then the middle.
            let (shape, slope) = match facet.nodes().len() {
                2 => (vec![0.5 - 0.5 * s, 0.5 + 0.5 * s], vec![-0.5, 0.5]),
                _ => (
                    vec![0.5 * s * (s - 1.0), 0.5 * s * (s + 1.0), 1.0 - s * s],
                    vec![s - 0.5, s + 0.5, -2.0 * s],
                ),
            };
            let sum = |by: &[f64], i: usize| {
                let terms = by.iter().enumerate().map(|(a, by)| by * x(a)[i]);
                terms.sum::<f64>()
            };
            let inward = [-sum(&slope, 1), sum(&slope, 0)];
            let around = match mesh.symmetry {
                Symmetry::Axisymmetric => std::f64::consts::TAU * sum(&shape, 0),
                _ => 1.0,
            };
            for (&node, n) in facet.nodes().iter().zip(&shape) {
                for i in 0..2 {
                    load[2 * node as usize + i] += weight * pressure * around * n * inward[i];
                }
            }
        }
    }
}

const PLANE_KINDS: [(CellKind, usize); 4] = [
    (CellKind::Quad4, 16),
    (CellKind::Tri3, 16),
    (CellKind::Quad9, 8),
    (CellKind::Tri6, 8),
];

fn bent_square(x: Vec3) -> Vec3 {
    let [x, y, _] = x;
    [
        x * (1.0 + 0.1 * (2.0 * y).sin()),
        y * (1.0 + 0.1 * (2.0 * x).cos()),
        0.0,
    ]
}

/// Held at `y = 0`, and on the axis.
fn stretched(x: Vec3) -> Vec3 {
    let [x, y, _] = x;
    let s = (1.3 * y).sin();
    [
        0.15 * x * s * (1.0 - 0.4 * x * x),
        0.2 * s * (1.0 + (1.2 * x).cos()),
        0.0,
    ]
}

/// Finite strain on curved cells, with an axis in the axisymmetric case.
#[test]
fn plane_elements_converge_with_their_degree() {
    let mut wrong = String::new();
    for symmetry in [Symmetry::PlaneStrain, Symmetry::Axisymmetric] {
        let problem = Problem {
            symmetry,
            shape: bent_square,
            exact: stretched,
            loading: Loading::Manufactured,
            along: 1,
            held: &[("x_min", [true, false, false]), ("y_min", [true; 3])],
        };
        for (kind, n) in PLANE_KINDS {
            wrong += &problem.check(kind, n);
        }
    }
    assert!(wrong.is_empty(), "{wrong}");
}

/// Radii 1 and 2; nodes lie on circles, edges between them are curved.
fn quarter_ring(x: Vec3) -> Vec3 {
    let (radius, angle) = (1.0 + x[0], FRAC_PI_2 * x[1]);
    // The end of the quarter lies on the axis to the last bit.
    let cosine = if x[1] == 1.0 { 0.0 } else { angle.cos() };
    [radius * cosine, radius * angle.sin(), 0.0]
}

const PRESSURE: f64 = 1e-8;

/// Along the radius: `u = p a^2/(2 G (b^2 - a^2)) ((1 - 2 nu) r + b^2/r)`.
fn lame_tube(x: Vec3) -> Vec3 {
    let nu = 0.5 * LAME / (LAME + SHEAR);
    let r = x[0].hypot(x[1]);
    let u = PRESSURE / (2.0 * SHEAR * 3.0) * ((1.0 - 2.0 * nu) * r + 4.0 / r);
    [u * x[0] / r, u * x[1] / r, 0.0]
}

/// Along the radius: `u = p a^3/(b^3 - a^3) (r/(3 K) + b^3/(4 G r^2))`.
fn lame_ball(x: Vec3) -> Vec3 {
    let bulk = LAME + 2.0 / 3.0 * SHEAR;
    let r = x[0].hypot(x[1]);
    let u = PRESSURE / 7.0 * (r / (3.0 * bulk) + 8.0 / (4.0 * SHEAR * r * r));
    [u * x[0] / r, u * x[1] / r, 0.0]
}

/// The true boundary is a circle: nodes on it are enough for the rates.
#[test]
fn thick_tube_and_thick_ball_under_pressure_converge_with_the_degree() {
    let mut wrong = String::new();
    for (symmetry, exact) in [
        (Symmetry::PlaneStrain, lame_tube as fn(Vec3) -> Vec3),
        (Symmetry::Axisymmetric, lame_ball),
    ] {
        let problem = Problem {
            symmetry,
            shape: quarter_ring,
            exact,
            loading: Loading::Pressure(PRESSURE),
            along: 2,
            held: &[
                ("y_max", [true, false, false]),
                ("y_min", [false, true, false]),
            ],
        };
        for (kind, n) in PLANE_KINDS {
            // An error of the next order is large for triangles at first.
            let finer = if kind == CellKind::Tri6 { 2 } else { 1 };
            wrong += &problem.check(kind, finer * n);
        }
    }
    assert!(wrong.is_empty(), "{wrong}");
}

fn bent_cube(x: Vec3) -> Vec3 {
    let [x, y, z] = x;
    [
        x + 0.06 * (2.0 * y + z).sin(),
        y + 0.06 * (2.0 * z + x).sin(),
        z * (1.0 + 0.06 * (x + y).cos()),
    ]
}

/// Held at `z = 0`.
fn twisted(x: Vec3) -> Vec3 {
    let [x, y, z] = x;
    let s = (1.2 * z).sin();
    [
        0.12 * s * (x + y * y * (1.0 - 0.5 * y)),
        0.15 * s * (1.1 * x).cos(),
        0.1 * s * (1.0 - 0.5 * x * y + 0.3 * (2.0 * x).sin()),
    ]
}

/// Finite strain on curved cells.
#[test]
fn elements_in_space_converge_with_their_degree() {
    let problem = Problem {
        symmetry: Symmetry::None,
        shape: bent_cube,
        exact: twisted,
        loading: Loading::Manufactured,
        along: 1,
        held: &[("z_min", [true; 3])],
    };
    let mut wrong = String::new();
    for (kind, n) in [
        (CellKind::Hex8, 6),
        (CellKind::Tet4, 6),
        (CellKind::Hex27, 3),
        (CellKind::Tet10, 3),
    ] {
        wrong += &problem.check(kind, n);
    }
    assert!(wrong.is_empty(), "{wrong}");
}
