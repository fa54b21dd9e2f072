//! One hexahedron, stretched along x with its sides held: force and tangent against the law.

use fe_core::nalgebra::Matrix3;
use fe_core::{BoxMesh, Solid, solid_block};
use hyperelastic::{ElasticConstants, Material, NeoHookean, right_cauchy_green};

/// Step of the differences \[-\].
const STEP: f64 = 1e-5;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let law = NeoHookean::new(ElasticConstants::from_young_poisson(10.0e6, 0.45)?)?;
    let mesh = BoxMesh::uniform([0.0; 3], [1.0; 3], [1; 3])
        .generate("cube")?
        .validated()?;
    let end = mesh.node_set("x_max")?.to_vec();
    let block = solid_block(&mesh, 0, law, 1000.0)?;
    let solid = Solid::new(mesh, vec![block])?;
    let mut work = solid.workspace();
    let mut force = vec![0.0; solid.dof_count()];
    let mut shift = vec![0.0; solid.dof_count()];
    end.iter().for_each(|&node| shift[3 * node as usize] = 1.0);

    println!("stretch   force [N]      law [N]        tangent [N/m]  differences [N/m]");
    for stretch in [0.7, 0.9, 1.0, 1.2, 1.5] {
        let at = |stretch: f64| -> Vec<f64> { shift.iter().map(|s| (stretch - 1.0) * s).collect() };
        solid.tangent(&at(stretch), &mut work, &mut force)?;
        let pull: f64 = end.iter().map(|&node| force[3 * node as usize]).sum();
        let mut product = vec![0.0; solid.dof_count()];
        solid.tangent_times(&work, &shift, &mut product);
        let tangent: f64 = product.iter().zip(&shift).map(|(k, s)| k * s).sum();

        // First Piola-Kirchhoff stress F S on the unit face.
        let nominal = |stretch: f64| -> Result<f64, Box<dyn std::error::Error>> {
            let mut f = Matrix3::identity();
            f[(0, 0)] = stretch;
            Ok(stretch * law.response(&right_cauchy_green(&f))?.stress[0])
        };
        let slope = (nominal(stretch + STEP)? - nominal(stretch - STEP)?) / (2.0 * STEP);
        println!(
            "{stretch:<9} {pull:<14.6e} {:<14.6e} {tangent:<14.6e} {slope:<14.6e}",
            nominal(stretch)?
        );
    }
    Ok(())
}
