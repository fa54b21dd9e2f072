//! Nearly incompressible matter at small strain against closed forms: what locks, what does not, and the pressure.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use fe_core::{CellKind, Dilatation, Mesh, RectangleMesh, Symmetry, ValidMesh, solid_block_with};
use fe_core::{ElementState, tangent_index, tangent_len};
use hyperelastic::{ElasticConstants, SaintVenantKirchhoff};
use nalgebra::Vector3;

/// Young's modulus \[Pa\]. Strains are `1/E`: small, so that the tangent at rest is the problem.
const YOUNG: f64 = 1.0;

/// Function of the position and of Poisson's ratio.
type Field<T> = Box<dyn Fn(&Vector3<f64>, f64) -> T>;

/// A plane problem with a closed form, pressed along one set of facets.
struct Problem {
    mesh: ValidMesh,
    /// Sets of nodes and the component that is held there.
    held: Vec<(&'static str, usize)>,
    load: Vec<f64>,
    exact: Field<[f64; 2]>,
    /// Minus a third of the trace of the stress.
    pressure: Field<f64>,
}

/// Moves nodes inside by up to `share` of a cell, without pattern.
fn distort(mesh: &mut Mesh, cell: [f64; 2], share: f64) {
    let mut inside = vec![true; mesh.points.len()];
    for facet in mesh.boundary_facets() {
        facet
            .nodes()
            .iter()
            .for_each(|&n| inside[n as usize] = false);
    }
    let nodes = mesh.points.iter_mut().enumerate();
    for (node, x) in nodes.filter(|(node, _)| inside[*node]) {
        for i in 0..2 {
            let hash = 43758.5453 * (12.9898 * node as f64 + 78.233 * i as f64).sin();
            x[i] += share * cell[i] * (2.0 * hash.rem_euclid(1.0) - 1.0);
        }
    }
}

/// Nodal forces of a traction, which is called with the position and the outward normal times length.
fn edge_load(
    mesh: &Mesh,
    set: &str,
    traction: impl Fn([f64; 2], [f64; 2]) -> [f64; 2],
) -> Vec<f64> {
    let mut load = vec![0.0; 2 * mesh.points.len()];
    let s = 0.6_f64.sqrt();
    for facet in mesh.facet_set(set).unwrap() {
        let nodes = facet.nodes();
        for (xi, weight) in [(-s, 5.0 / 9.0), (0.0, 8.0 / 9.0), (s, 5.0 / 9.0)] {
            let (shape, slope) = if nodes.len() == 2 {
                (vec![0.5 - 0.5 * xi, 0.5 + 0.5 * xi], vec![-0.5, 0.5])
            } else {
                let shape = vec![0.5 * xi * (xi - 1.0), 0.5 * xi * (xi + 1.0), 1.0 - xi * xi];
                (shape, vec![xi - 0.5, xi + 0.5, -2.0 * xi])
            };
            let sum = |of: &[f64], i: usize| -> f64 {
                let values = nodes.iter().map(|&n| mesh.points[n as usize][i]);
                values.zip(of).map(|(x, n)| n * x).sum()
            };
            let x = [0, 1].map(|i| sum(&shape, i));
            let ring = if mesh.symmetry == Symmetry::Axisymmetric {
                TAU * x[0]
            } else {
                1.0
            };
            let t = traction(x, [sum(&slope, 1), -sum(&slope, 0)]);
            for (&node, n) in nodes.iter().zip(&shape) {
                (0..2).for_each(|i| load[2 * node as usize + i] += weight * ring * n * t[i]);
            }
        }
    }
    load
}

/// A rectangle with distorted cells of this kind.
fn rectangle(kind: CellKind, corners: [[f64; 2]; 2], cells: [usize; 2], distortion: f64) -> Mesh {
    let [min, max] = corners;
    let mut mesh = RectangleMesh::uniform(min, max, cells)
        .with_kind(kind.linear())
        .generate("body")
        .unwrap();
    let cell = [0, 1].map(|i| (max[i] - min[i]) / cells[i] as f64);
    distort(&mut mesh, cell, distortion);
    match kind.degree() {
        1 => mesh,
        _ => mesh.quadratic().unwrap(),
    }
}

/// Quarter of a tube (plane strain) or of a hollow ball (axisymmetric) of radii 1 and 2 under the inner pressure 1
/// \[Lame\].
fn hollow(symmetry: Symmetry, kind: CellKind, cells: usize, distortion: f64) -> Problem {
    let corners = [[1.0, 0.0], [2.0, FRAC_PI_2]];
    let mut mesh = rectangle(kind, corners, [cells, 2 * cells], distortion);
    mesh.symmetry = symmetry;
    let quarter = mesh.node_set("y_max").unwrap().to_vec();
    for (node, x) in mesh.points.iter_mut().enumerate() {
        let (r, (sin, cos)) = (x[0], x[1].sin_cos());
        let cos = if quarter.contains(&(node as u32)) {
            0.0
        } else {
            cos
        };
        *x = Vector3::new(r * cos, r * sin, 0.0);
    }
    let load = edge_load(&mesh, "x_min", |_, n| [-n[0], -n[1]]);
    let ball = symmetry == Symmetry::Axisymmetric;
    let radial = move |r: f64, nu: f64| {
        if ball {
            ((1.0 - 2.0 * nu) * r + (1.0 + nu) * 4.0 / (r * r)) / 7.0 / YOUNG
        } else {
            (1.0 + nu) / YOUNG / 3.0 * ((1.0 - 2.0 * nu) * r + 4.0 / r)
        }
    };
    Problem {
        mesh: mesh.validated().unwrap(),
        held: vec![("y_min", 1), ("y_max", 0)],
        load,
        exact: Box::new(move |x, nu| {
            let r = x[0].hypot(x[1]);
            [0, 1].map(|i| radial(r, nu) * x[i] / r)
        }),
        pressure: Box::new(move |_, nu| {
            if ball {
                -1.0 / 7.0
            } else {
                -2.0 / 9.0 * (1.0 + nu)
            }
        }),
    }
}

/// Layer of length pi and height 1 on a smooth base between smooth walls under the pressure `cos x`. With the stress
/// function `cos x (a cosh y + b y sinh y)` no shear at both faces gives `a` and `b`.
fn layer(kind: CellKind, cells: usize, distortion: f64) -> Problem {
    let mesh = rectangle(kind, [[0.0; 2], [PI, 1.0]], [3 * cells, cells], distortion);
    let load = edge_load(&mesh, "y_max", |x, n| {
        [-x[0].cos() * n[0], -x[0].cos() * n[1]]
    });
    let (s, c) = (1.0_f64.sinh(), 1.0_f64.cosh());
    // Shear at y = 1: a s + b (s + c) = 0, pressure there: a c + b s = 1.
    let b = 1.0 / (s - c * (s + c) / s);
    let a = -b * (s + c) / s;
    let exact = move |x: &Vector3<f64>, nu: f64| {
        let (s, c) = (x[1].sinh(), x[1].cosh());
        let phi = a * c + b * x[1] * s;
        // 2 G u_x = -d(phi)/dx + (1 - nu) int laplacian dx, and alike along y.
        let factor = (1.0 + nu) / YOUNG;
        let slope = a * s + b * (s + x[1] * c);
        [
            factor * x[0].sin() * (phi + (1.0 - nu) * 2.0 * b * c),
            factor * x[0].cos() * (-slope + (1.0 - nu) * 2.0 * b * s),
        ]
    };
    Problem {
        mesh: mesh.validated().unwrap(),
        held: vec![("x_min", 0), ("x_max", 0), ("y_min", 1)],
        load,
        exact: Box::new(exact),
        pressure: Box::new(move |x, nu| -(1.0 + nu) / 3.0 * 2.0 * b * x[0].cos() * x[1].cosh()),
    }
}

/// Solves `a x = b` for a symmetric positive definite matrix given by its lower band, `a[row][row - column]`.
fn solve_band(mut a: Vec<Vec<f64>>, mut x: Vec<f64>) -> Vec<f64> {
    let (n, band) = (x.len(), a[0].len());
    for k in 0..n {
        let pivot = a[k][0].sqrt();
        let last = n.min(k + band);
        a[k][0] = pivot;
        (k + 1..last).for_each(|i| a[i][i - k] /= pivot);
        for i in k + 1..last {
            let factor = a[i][i - k];
            for j in k + 1..=i {
                a[i][i - j] -= factor * a[j][j - k];
            }
        }
    }
    for i in 0..n {
        let known: f64 = (i.saturating_sub(band - 1)..i)
            .map(|j| a[i][i - j] * x[j])
            .sum();
        x[i] = (x[i] - known) / a[i][0];
    }
    for i in (0..n).rev() {
        let known: f64 = (i + 1..n.min(i + band)).map(|j| a[j][j - i] * x[j]).sum();
        x[i] = (x[i] - known) / a[i][0];
    }
    x
}

/// Displacements for a unit load, and the pressures of the elements.
fn solve(problem: &Problem, nu: f64, dilatation: Dilatation) -> (Vec<f64>, Vec<f64>) {
    let mesh = &problem.mesh;
    let elastic = ElasticConstants::from_young_poisson(YOUNG, nu).unwrap();
    let law = SaintVenantKirchhoff::new(elastic).unwrap();
    let block = solid_block_with(mesh, 0, law, 1.0, dilatation).unwrap();
    let (dofs, nodes) = (2 * mesh.points.len(), block.nodes_per_element());
    let count = block.element_count();
    let (mut f, mut w) = (vec![0.0; 2 * nodes * count], vec![0.0; count]);
    let mut k = vec![0.0; tangent_len(2, nodes) * count];
    block
        .tangent(&vec![0.0; dofs], &mut f, &mut w, &mut k)
        .unwrap();
    // Numbers along x keep the band narrow.
    let mut order: Vec<usize> = (0..mesh.points.len()).collect();
    order.sort_by(|&p, &q| mesh.points[p][0].total_cmp(&mesh.points[q][0]));
    let mut rank = vec![0; order.len()];
    (0..).zip(&order).for_each(|(k, &node)| rank[node] = k);
    let ranks = |cell: &[u32]| -> Vec<usize> { cell.iter().map(|&n| rank[n as usize]).collect() };
    let cells: Vec<Vec<usize>> = block.connectivity().chunks(nodes).map(ranks).collect();
    let spread = |cell: &Vec<usize>| cell.iter().max().unwrap() - cell.iter().min().unwrap();
    let widest = cells.iter().map(spread).max().unwrap();
    let mut a = vec![vec![0.0; 2 * widest + 2]; dofs];
    for (cell, k) in cells.iter().zip(k.chunks(tangent_len(2, nodes))) {
        for p in 0..2 * nodes {
            for q in 0..2 * nodes {
                let [row, column] = [p, q].map(|p| 2 * cell[p / 2] + p % 2);
                if row >= column {
                    let place = tangent_index(2, nodes, (p / 2, p % 2), (q / 2, q % 2));
                    a[row][row - column] += k[place];
                }
            }
        }
    }
    let load: Vec<f64> = (order.iter().flat_map(|&n| [2 * n, 2 * n + 1]))
        .map(|dof| problem.load[dof])
        .collect();
    for (set, i) in &problem.held {
        for &n in mesh.node_set(set).unwrap() {
            // So stiff that nothing moves there.
            a[2 * rank[n as usize] + i][0] *= 1e20;
        }
    }
    let moved = solve_band(a, load);
    let u: Vec<f64> = (rank.iter().flat_map(|&k| [2 * k, 2 * k + 1]))
        .map(|row| moved[row])
        .collect();
    // Two small displacements, so that what is quadratic in them goes.
    let small = 1e-6;
    let [forth, back] = [small, -small].map(|small| {
        let tiny: Vec<f64> = u.iter().map(|u| small * u).collect();
        let mut states = vec![ElementState::default(); count];
        block.stress_state(&tiny, &mut states).unwrap();
        states
    });
    let trace = |s: &ElementState| s.cauchy[0] + s.cauchy[1] + s.cauchy[2];
    let pairs = forth.iter().zip(&back);
    let pressure = pairs
        .map(|(f, b)| (trace(b) - trace(f)) / (6.0 * small))
        .collect();
    (u, pressure)
}

/// Relative errors of the displacement and of the pressure, root mean squares over nodes and elements.
fn errors(problem: &Problem, nu: f64, dilatation: Dilatation) -> [f64; 2] {
    let (u, pressure) = solve(problem, nu, dilatation);
    let mesh = &problem.mesh;
    let (mut off, mut size) = ([0.0; 2], [0.0; 2]);
    for (x, u) in mesh.points.iter().zip(u.chunks(2)) {
        let exact = (problem.exact)(x, nu);
        off[0] += (u[0] - exact[0]).powi(2) + (u[1] - exact[1]).powi(2);
        size[0] += exact[0].powi(2) + exact[1].powi(2);
    }
    for (cell, p) in mesh.blocks[0].iter().zip(&pressure) {
        let exact = (problem.pressure)(&center(mesh, cell), nu);
        off[1] += (p - exact).powi(2);
        size[1] += exact.powi(2);
    }
    [0, 1].map(|i| (off[i] / size[i]).sqrt())
}

fn center(mesh: &Mesh, cell: &[u32]) -> Vector3<f64> {
    let sum: Vector3<f64> = cell.iter().map(|&n| mesh.points[n as usize]).sum();
    sum / cell.len() as f64
}

/// Root mean square over patches of 2 x 2 cells of the part of the pressure that changes its sign from cell to cell,
/// relative to that of the pressure: one for a checkerboard, of order `h^2` for a smooth field.
fn checkerboard(pressure: &[f64], columns: usize) -> f64 {
    let at = |i: usize, j: usize| pressure[columns * j + i];
    let mut sum = 0.0;
    let rows = pressure.len() / columns;
    for (i, j) in (1..columns).flat_map(|i| (1..rows).map(move |j| (i, j))) {
        let part = at(i, j) - at(i - 1, j) - at(i, j - 1) + at(i - 1, j - 1);
        sum += (0.25 * part).powi(2);
    }
    let mean = sum / ((columns - 1) * (rows - 1)) as f64;
    let square = pressure.iter().map(|p| p * p).sum::<f64>() / pressure.len() as f64;
    (mean / square).sqrt()
}

type Family = (&'static str, fn(CellKind, usize, f64) -> Problem);

const FAMILIES: [Family; 3] = [
    ("tube", |kind, cells, distortion| {
        hollow(Symmetry::PlaneStrain, kind, cells, distortion)
    }),
    ("ball", |kind, cells, distortion| {
        hollow(Symmetry::Axisymmetric, kind, cells, distortion)
    }),
    ("layer", layer),
];

#[test]
fn pointwise_dilatation_locks_and_the_projected_one_does_not() {
    for (name, problem) in FAMILIES {
        let problem = problem(CellKind::Quad4, 8, 0.15);
        let [mild, _] = errors(&problem, 0.495, Dilatation::Projected);
        for nu in [0.4999, 0.499999] {
            let [locked, _] = errors(&problem, nu, Dilatation::Pointwise);
            assert!(locked > 0.6, "{name} {nu} {locked}");
            let [free, pressure] = errors(&problem, nu, Dilatation::Projected);
            assert!(free < 6e-3, "{name} {nu} {free}");
            assert!(
                (free / mild - 1.0).abs() < 0.03,
                "{name} {nu} {free} {mild}"
            );
            assert!(pressure < 0.05, "{name} {nu} {pressure}");
        }
    }
}

#[test]
fn displacement_and_pressure_converge_on_regular_meshes() {
    // Order of the displacement, and what that of the pressure is at least. Quad4 and Tri6 have one pressure a cell; it
    // is better than order 1 because the middle of a cell is a good place.
    for (kind, cells, order, least) in [
        (CellKind::Quad4, [8, 16], 2.0, 1.6),
        (CellKind::Quad9, [4, 8], 3.0, 1.9),
    ] {
        for (name, problem) in FAMILIES {
            let problems = cells.map(|cells| problem(kind, cells, 0.0));
            for nu in [0.3, 0.4999] {
                let [coarse, fine] =
                    (problems.each_ref()).map(|p| errors(p, nu, Dilatation::Projected));
                let [u, p] = [0, 1].map(|what| (coarse[what] / fine[what]).log2());
                // Nodes of quadratic cells in a tube are better than the theory of the whole field.
                let good = u > order - 0.1 && (kind == CellKind::Quad9 || u < order + 0.1);
                assert!(good, "{kind:?} {name} {nu} {coarse:?} {fine:?}");
                assert!(p > least, "{kind:?} {name} {nu} {coarse:?} {fine:?}");
            }
        }
    }
}

/// Cells of random shape: the alternating part of the pressure is bounded, but it does not fall with the size of the
/// cells. That is what the element is known for, and why the bound is one from both sides.
#[test]
fn pressure_alternates_on_irregular_meshes_only() {
    for (name, problem) in FAMILIES {
        let columns = if name == "layer" { 48 } else { 16 };
        let alternating = |distortion: f64| {
            let problem = problem(CellKind::Quad4, 16, distortion);
            checkerboard(&solve(&problem, 0.4999, Dilatation::Projected).1, columns)
        };
        let (regular, irregular) = (alternating(0.0), alternating(0.15));
        assert!(regular < 1e-3, "{name} {regular}");
        assert!((4e-3..0.05).contains(&irregular), "{name} {irregular}");
    }
}

#[test]
#[ignore = "a table"]
fn table_of_locking() {
    println!(
        "relative errors of displacement and pressure, cells through the thickness in brackets"
    );
    for (name, problem) in FAMILIES {
        for (kind, cells) in [
            (CellKind::Quad4, [8, 16, 32]),
            (CellKind::Tri6, [4, 8, 16]),
            (CellKind::Quad9, [4, 8, 16]),
        ] {
            for distortion in [0.0, 0.15] {
                let problems = cells.map(|cells| problem(kind, cells, distortion));
                for nu in [0.3, 0.45, 0.495, 0.4999, 0.499999] {
                    for dilatation in [Dilatation::Pointwise, Dilatation::Projected] {
                        let rows = problems.each_ref().map(|p| errors(p, nu, dilatation));
                        let column = |k: usize| rows.map(|row| format!("{:.1e}", row[k])).join(" ");
                        println!(
                            "{name:5} {kind:?} {cells:?} distortion {distortion:<4} nu {nu:<8} {dilatation:?}: u {} p {}",
                            column(0),
                            column(1),
                        );
                    }
                }
            }
        }
    }
}
