//! Rectilinear meshes with graded axes.

use fe_core::{CellKind, GridAxis, GridMesh, GridPiece, MeshError, Surface};
use proptest::prelude::*;

use crate::common::{KINDS, PLANE_KINDS, blatz_ko, solid};

fn cells(to: f64, cells: usize, grading: f64) -> GridPiece {
    GridPiece::Cells { to, cells, grading }
}

fn growing(to: f64, growth: f64) -> GridPiece {
    GridPiece::Growing { to, growth }
}

fn axis(from: f64, pieces: &[GridPiece]) -> GridAxis {
    GridAxis {
        from,
        pieces: pieces.to_vec(),
    }
}

fn sizes(lines: &[f64]) -> Vec<f64> {
    lines.windows(2).map(|pair| pair[1] - pair[0]).collect()
}

#[test]
fn pieces_have_the_cells_asked_for() {
    let axis = axis(1.0, &[cells(2.0, 4, 1.0), cells(4.0, 3, 9.0)]);
    assert_eq!(axis.cells().unwrap(), 7);
    let sizes = sizes(&axis.lines(1).unwrap());
    for (size, expected) in
        sizes
            .iter()
            .zip([0.25, 0.25, 0.25, 0.25, 2.0 / 13.0, 6.0 / 13.0, 18.0 / 13.0])
    {
        assert!((size - expected).abs() < 1e-14, "{sizes:?}");
    }
}

#[test]
fn a_length_made_for_whole_cells_gets_them() {
    // 1/4 (1.5 + 1.5^2 + 1.5^3) after four cells of 1/4.
    let end = 1.0 + 0.25 * (1.5 + 2.25 + 3.375);
    let grown = axis(0.0, &[cells(1.0, 4, 1.0), growing(end, 1.5)]);
    let expected = [0.25, 0.25, 0.25, 0.25, 0.375, 0.5625, 0.84375];
    let found = sizes(&grown.lines(1).unwrap());
    assert_eq!(found.len(), 7);
    for (size, expected) in found.iter().zip(expected) {
        assert!((size - expected).abs() < 1e-13, "{found:?}");
    }
    // Growth 1 carries a uniform piece on.
    let even = axis(0.0, &[cells(1.0, 4, 1.0), growing(2.5, 1.0)]);
    let found = sizes(&even.lines(1).unwrap());
    assert_eq!(found.len(), 10);
    assert!(
        found.iter().all(|size| (size - 0.25).abs() < 1e-13),
        "{found:?}"
    );
}

proptest! {
    #[test]
    fn growing_pieces_continue_the_size_before(
        count in 1..9_usize, grading in 0.2..5.0_f64, length in 0.01..1e4_f64, growth in 1.0..3.0_f64, sign in prop::bool::ANY,
    ) {
        let way = if sign { 1.0 } else { -1.0 };
        let axis = axis(0.5, &[cells(0.5 + way, count, grading), growing(0.5 + way * (1.0 + length), growth)]);
        prop_assume!(axis.cells().unwrap() < 5_000);
        let mut lines = axis.lines(1).unwrap();
        prop_assert_eq!(lines.len(), axis.cells().unwrap() + 1);
        prop_assert!(lines.is_sorted_by(|a, b| a < b));
        if !sign {
            lines.reverse();
        }
        prop_assert_eq!(lines[0], 0.5);
        prop_assert_eq!(lines[count], 0.5 + way);
        prop_assert_eq!(*lines.last().unwrap(), 0.5 + way * (1.0 + length));
        let sizes: Vec<f64> = sizes(&lines).iter().map(|size| size * way).collect();
        let ratios: Vec<f64> = sizes[count - 1..].windows(2).map(|pair| pair[1] / pair[0]).collect();
        // One ratio, which is not above the bound, and as near to it as the number of cells allows.
        let off = 1e-11 * (1.0 + length) / sizes[count - 1].min(1.0);
        for ratio in &ratios {
            prop_assert!((ratio - ratios[0]).abs() < off, "{:?}", ratios);
            prop_assert!(*ratio < growth + off, "{:?}", ratios);
        }
        let fewer: f64 = (1..ratios.len()).map(|k| sizes[count - 1] * growth.powi(k as i32)).sum();
        prop_assert!(fewer < length * (1.0 + 1e-8));
    }

    #[test]
    fn refined_lines_contain_the_coarse_ones_and_divide_all_cells_alike(
        count in 1..6_usize, grading in 0.2..5.0_f64, growth in 1.0..1.6_f64, refine in 1..5_usize,
    ) {
        let axis = axis(0.0, &[cells(1.0, count, grading), growing(20.0, growth)]);
        let coarse = axis.lines(1).unwrap();
        let fine = axis.lines(refine).unwrap();
        prop_assert_eq!(fine.len(), axis.cells().unwrap() * refine + 1);
        for (k, line) in coarse.iter().enumerate() {
            prop_assert!((fine[k * refine] - line).abs() < 1e-12);
        }
        let largest = 5.0_f64.max(growth);
        for (k, size) in sizes(&coarse).iter().enumerate() {
            for part in sizes(&fine[k * refine..=(k + 1) * refine]) {
                let share = part * refine as f64 / size;
                prop_assert!(share < largest && share > 1.0 / largest, "{}", share);
            }
        }
    }

}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    #[test]
    fn grids_are_valid_and_their_sides_closed(
        pieces in prop::array::uniform3((1..4_usize, 0.3..3.0_f64, 1.0..2.0_f64)), refine in 1..3_usize,
    ) {
        let axes: Vec<GridAxis> = pieces
            .iter()
            .map(|&(count, grading, growth)| axis(-1.0, &[cells(-2.0, count, grading), growing(-4.0, growth)]))
            .collect();
        for kind in PLANE_KINDS.into_iter().chain(KINDS) {
            let dim = kind.dim();
            let mesh = GridMesh::new(axes[..dim].to_vec(), kind).with_refine(refine).generate("a").unwrap();
            mesh.validate().unwrap();
            let n: Vec<usize> = axes[..dim].iter().map(|axis| axis.cells().unwrap() * refine).collect();
            prop_assert_eq!(mesh.points.len(), n.iter().map(|n| kind.degree() * n + 1).product::<usize>());
            let names = &["x_min", "x_max", "y_min", "y_max", "z_min", "z_max"][..2 * dim];
            for (side, name) in names.iter().enumerate() {
                let at = if side % 2 == 0 { -4.0 } else { -1.0 };
                let on_side = (0..mesh.points.len() as u32).filter(|&n| mesh.points[n as usize][side / 2] == at);
                prop_assert!(on_side.eq(mesh.node_sets[*name].iter().copied()));
                let surface = Surface::new(mesh.facet_sets[*name].clone()).unwrap();
                let area: f64 = surface.tributary_areas(&mesh).iter().sum();
                prop_assert!((area - 3.0_f64.powi(dim as i32 - 1)).abs() < 1e-12);
            }
            let volume = solid(mesh, blatz_ko(), 1.0).lumped_mass().total();
            prop_assert!((volume - 3.0_f64.powi(dim as i32)).abs() < 1e-11);
        }
    }
}

#[test]
fn impossible_grids_are_refused_with_the_bound() {
    let refuse = |pieces: &[GridPiece], words: [&str; 2]| {
        let message = axis(0.0, pieces).lines(1).unwrap_err().to_string();
        assert!(words.iter().all(|w| message.contains(w)), "{message}");
    };
    let start = cells(1.0, 2, 1.0);
    refuse(&[], ["pieces", "at least 1"]);
    refuse(&[growing(1.0, 1.2)], ["before", "positive"]);
    refuse(&[start, growing(0.5, 1.2)], ["piece 1", "positive"]);
    refuse(&[start, growing(f64::NAN, 1.2)], ["piece 1", "positive"]);
    refuse(
        &[start, growing(2.0, 0.9)],
        ["growth of piece 1 = 0.9", "1"],
    );
    refuse(&[start, growing(2.0, f64::NAN)], ["growth", "at least 1"]);
    refuse(&[start, growing(1e300, 1.0)], ["nodes", "2^32"]);
    refuse(&[cells(0.0, 2, 1.0)], ["length", "positive"]);
    refuse(&[cells(f64::INFINITY, 2, 1.0)], ["length", "finite"]);
    refuse(&[cells(1.0, 0, 1.0)], ["cells of piece 0 = 0", "1"]);
    refuse(&[cells(1.0, 2, -1.0)], ["grading of piece 0 = -1", "pos"]);
    assert!(axis(f64::NAN, &[start]).lines(1).is_err());
    assert!(axis(0.0, &[start]).lines(0).is_err());
    assert!(axis(0.0, &[start]).lines(usize::MAX).is_err());
    let fine = axis(0.0, &[cells(1.0, 1_000_000, 1.0)]);
    let grid = |count: usize, kind| GridMesh::new(vec![fine.clone(); count], kind);
    let refused = [
        (grid(2, CellKind::Quad4), "2^32"),
        (grid(2, CellKind::Hex8), "dimension 2"),
        (grid(3, CellKind::Tri3), "dimension 3"),
        (grid(1, CellKind::Tri3), "must be 2 or 3"),
    ];
    for (grid, words) in refused {
        let error: MeshError = grid.generate("a").unwrap_err();
        assert!(error.to_string().contains(words), "{error}");
    }
}

#[test]
fn a_crown_bends_the_top_like_a_ball_and_leaves_the_bottom() {
    let lines = |from: f64, to: f64| GridAxis::graded(from, to, 5, 2.0);
    let axes = [lines(-1.0, 2.0), lines(-0.5, 1.0), lines(-3.0, 0.5)];
    let flat = |dim: usize, kind| GridMesh::new(axes[..dim].to_vec(), kind);
    for (dim, kind) in [(2, CellKind::Quad4), (3, CellKind::Hex8)] {
        let grid = flat(dim, kind);
        let (plain, bent) = (
            grid.generate("a").unwrap(),
            grid.generate_crowned("a", 4.0).unwrap(),
        );
        let up = dim - 1;
        let (bottom, top) = if dim == 2 { (-0.5, 1.0) } else { (-3.0, 0.5) };
        for (a, b) in plain.points.iter().zip(&bent.points) {
            let r2: f64 = a.iter().take(up).map(|x| x * x).sum();
            let share = (a[up] - bottom) / (top - bottom);
            assert!((b[up] - (a[up] - r2 / 8.0 * share)).abs() < 1e-15);
            assert_eq!(a.as_slice()[..up], b.as_slice()[..up]);
        }
        assert!(matches!(
            grid.generate_crowned("a", 0.5),
            Err(MeshError::Shape { .. })
        ));
        assert!(grid.generate_crowned("a", -1.0).is_err());
    }
}
