//! The patch test: in a linear displacement a distorted mesh has one stress, and no node inside feels a force.

use fe_core::nalgebra::Matrix3;
use fe_core::{BoxMesh, CellKind, ElementState, Solid, solid_block};
use hyperelastic::BlatzKo;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let h = Matrix3::new(0.20, 0.30, -0.10, 0.10, -0.20, 0.05, 0.00, 0.10, 0.30);
    for kind in CellKind::ALL.into_iter().filter(|kind| kind.dim() == 3) {
        let mut mesh = BoxMesh::uniform([0.0; 3], [1.0; 3], [2; 3])
            .with_kind(kind.linear())
            .generate("patch")?;
        // The node in the middle moves aside, so that no two cells are alike.
        let inside = |x: f64| x > 0.0 && x < 1.0;
        let middle = mesh
            .points
            .iter_mut()
            .filter(|x| x.iter().all(|x| inside(*x)));
        middle.for_each(|x| {
            x.iter_mut()
                .zip([0.12, -0.08, 0.1])
                .for_each(|(x, d)| *x += d)
        });
        if kind.degree() == 2 {
            mesh = mesh.quadratic()?;
        }
        let mesh = mesh.validated()?;
        let block = solid_block(&mesh, 0, BlatzKo::new(1.5e6)?, 1000.0)?;
        let solid = Solid::new(mesh, vec![block])?;

        let points = solid.mesh().points.iter();
        let u: Vec<f64> = points.flat_map(|x| <[f64; 3]>::from(h * x)).collect();
        let mut states = vec![ElementState::default(); solid.element_count()];
        solid.blocks()[0].stress_state(&u, &mut states)?;
        let mean = states.iter().map(|s| s.von_mises).sum::<f64>() / states.len() as f64;
        let spread = states.iter().map(|s| (s.von_mises - mean).abs());
        let spread = spread.fold(0.0, f64::max) / mean;

        let mut force = vec![0.0; solid.dof_count()];
        solid.internal_force(&u, &mut solid.workspace(), &mut force)?;
        let points = solid.mesh().points.iter().zip(force.chunks_exact(3));
        let at_rest = points.filter(|(x, _)| x.iter().all(|x| inside(*x)));
        let largest = at_rest
            .flat_map(|(_, f)| f)
            .fold(0.0_f64, |m, f| m.max(f.abs()));
        println!(
            "{:<6} {:>3} cells: von Mises {mean:.6e} Pa, spread {spread:.1e}; force inside {largest:.1e} N",
            kind.name(),
            states.len()
        );
    }
    Ok(())
}
