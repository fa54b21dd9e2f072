//! Properties of assembled solids.

use nalgebra::{Matrix3, Vector3};

use super::{AGREEMENT, Violation, largest, same, same_entries};
use crate::block::ElementState;
use crate::solid::Solid;

/// Allowed relative difference of the stresses of two elements \[-\]: stresses are differences of the law's terms,
/// which cost two more digits.
const UNIFORM_STRESS: f64 = 100.0 * AGREEMENT;

/// Patch test: under the homogeneous displacement gradient `h` \[-\] no node inside the body feels a force, and
/// blocks of one material have one stress. The mesh needs nodes inside, and should be distorted there. Axisymmetric
/// bodies are in balance only if the radial and hoop stress agree: `h` diagonal, for isotropic matter.
///
/// # Errors
/// The first [`Violation`] found.
pub fn check_patch(solid: &Solid, h: &Matrix3<f64>) -> Result<(), Violation> {
    let dim = solid.dim();
    let affine = |x: &Vector3<f64>| {
        let x = *x;
        (0..dim).map(move |i| (0..dim).map(|j| h[(i, j)] * x[j]).sum::<f64>())
    };
    let u: Vec<f64> = solid.mesh().points.iter().flat_map(affine).collect();
    let mut f = vec![0.0; solid.dof_count()];
    solid.internal_force(&u, &mut solid.workspace(), &mut f)?;
    let scale = largest(&f);
    let mut inside = vec![true; solid.node_count()];
    for facet in solid.mesh().boundary_facets() {
        facet
            .nodes()
            .iter()
            .for_each(|&n| inside[n as usize] = false);
    }
    if !inside.contains(&true) || scale == 0.0 {
        return Err(Violation::Input {
            property: "the patch test",
            reason: "the mesh needs nodes inside, and the gradient a stress",
        });
    }
    for node in (0..solid.node_count()).filter(|&node| inside[node]) {
        let force = &f[dim * node..dim * (node + 1)];
        same_entries("patch test", force, &[0.0; 3], AGREEMENT * scale)?;
    }
    check_uniform_stress(solid, &u)
}

fn check_uniform_stress(solid: &Solid, u: &[f64]) -> Result<(), Violation> {
    for block in solid.blocks() {
        let mut states = vec![ElementState::default(); block.element_count()];
        block.stress_state(u, &mut states)?;
        let Some(first) = states.first().copied() else {
            continue;
        };
        let tolerance = UNIFORM_STRESS * first.cauchy.amax();
        for state in &states {
            same_entries(
                "uniform stress",
                state.cauchy.as_slice(),
                first.cauchy.as_slice(),
                tolerance,
            )?;
            let (low, high) = (state.det_f_min, state.det_f_max);
            same(
                "uniform volume change",
                String::new,
                low,
                high,
                AGREEMENT * high,
            )?;
        }
    }
    Ok(())
}

/// Consistent and lumped mass have the expected total \[kg; kg/m in plane strain\], also as inertia of a translation;
/// each node has a positive lumped mass.
///
/// # Errors
/// The first [`Violation`] found.
pub fn check_mass(solid: &Solid, expected: f64) -> Result<(), Violation> {
    let dim = solid.dim();
    for mass in [solid.consistent_mass(), solid.lumped_mass()] {
        let tolerance = AGREEMENT * expected;
        same("total mass", String::new, mass.total(), expected, tolerance)?;
        for i in 0..dim {
            let v: Vec<f64> = (0..solid.dof_count())
                .map(|dof| f64::from(u8::from(dof % dim == i)))
                .collect();
            let place = || format!("component {i}");
            let found = mass.quadratic(&v);
            same(
                "inertia of a translation",
                place,
                found,
                expected,
                tolerance,
            )?;
        }
        // Corners of quadratic triangles have a consistent row sum of zero.
        for (node, &m) in mass.values().iter().enumerate() {
            if !mass.is_diagonal() {
                break;
            }
            let place = || format!("node {node}");
            let positive = f64::from(u8::from(m > 0.0));
            same("positive mass", place, positive, 1.0, 0.0)?;
        }
    }
    Ok(())
}
