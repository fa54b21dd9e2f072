//! Properties of forces, energies and tangents.

use nalgebra::Vector3;

use super::{AGREEMENT, DIFFERENCES, Violation, direction, largest, same, same_entries};
use crate::block::{Block, tangent_index, tangent_len};
use crate::error::FeError;
use crate::motion::{Interpolation, Motion, Rotation, Table};
use crate::symmetry::Symmetry;

/// Step of the differences relative to the size of the mesh. Two steps, of which the second is half as long, are
/// extrapolated: errors of order `1e-16` and `1e-12`.
const STEP: f64 = 1e-4;

/// What a block computes at one displacement.
#[derive(Debug, Clone)]
struct Evaluation {
    forces: Vec<f64>,
    energies: Vec<f64>,
    tangents: Vec<f64>,
}

/// At the displacement `u` \[m\]: both entry points give the same force, the tangent is symmetric and the
/// derivative of the force, the force is the derivative of the energy. Rigid motions (if axisymmetric: along the
/// axis) give no force and no energy. `points` are the reference coordinates of the mesh \[m\].
///
/// # Errors
/// The first [`Violation`] found.
pub fn check_block(block: &dyn Block, points: &[Vector3<f64>], u: &[f64]) -> Result<(), Violation> {
    let here = evaluate(block, u)?;
    let (forces, energies) = force(block, u)?;
    let scale = largest(&here.tangents) * size(points);
    let tolerance = AGREEMENT * scale;
    same_entries("force beside the tangent", &here.forces, &forces, tolerance)?;
    let tolerance = tolerance * size(points);
    same_entries(
        "energy beside the tangent",
        &here.energies,
        &energies,
        tolerance,
    )?;
    check_symmetry(block, &here.tangents)?;
    for seed in 1..=6 {
        let d = direction(seed, u.len());
        check_derivatives(block, u, &d, &here, STEP * size(points))?;
    }
    check_rigid_motion(block, points)
}

fn evaluate(block: &dyn Block, u: &[f64]) -> Result<Evaluation, FeError> {
    let (count, nodes, dim) = (
        block.element_count(),
        block.nodes_per_element(),
        block.dim(),
    );
    let mut found = Evaluation {
        forces: vec![0.0; dim * nodes * count],
        energies: vec![0.0; count],
        tangents: vec![0.0; tangent_len(dim, nodes) * count],
    };
    let Evaluation {
        forces,
        energies,
        tangents,
    } = &mut found;
    block.tangent(u, forces, energies, tangents)?;
    Ok(found)
}

fn force(block: &dyn Block, u: &[f64]) -> Result<(Vec<f64>, Vec<f64>), FeError> {
    let (count, nodes, dim) = (
        block.element_count(),
        block.nodes_per_element(),
        block.dim(),
    );
    let mut forces = vec![0.0; dim * nodes * count];
    let mut energies = vec![0.0; count];
    block.internal_force(u, &mut forces, &mut energies)?;
    Ok((forces, energies))
}

/// Largest extent of the mesh \[m\].
fn size(points: &[Vector3<f64>]) -> f64 {
    let extent = |i: usize| {
        let low = points.iter().fold(f64::INFINITY, |m, x| m.min(x[i]));
        let high = points.iter().fold(f64::NEG_INFINITY, |m, x| m.max(x[i]));
        high - low
    };
    extent(0).max(extent(1)).max(extent(2))
}

/// Pairs of different components are stored once; what is stored twice has to agree.
fn check_symmetry(block: &dyn Block, tangents: &[f64]) -> Result<(), Violation> {
    let (dim, nodes) = (block.dim(), block.nodes_per_element());
    let tolerance = AGREEMENT * largest(tangents);
    for (element, k) in tangents.chunks_exact(tangent_len(dim, nodes)).enumerate() {
        for i in 0..dim {
            for a in 0..nodes {
                for b in 0..a {
                    let place = || format!("element {element}, nodes {a} {b}, component {i}");
                    let found = k[tangent_index(dim, nodes, (a, i), (b, i))];
                    let mirror = k[tangent_index(dim, nodes, (b, i), (a, i))];
                    same("symmetry of the tangent", place, found, mirror, tolerance)?;
                }
            }
        }
    }
    Ok(())
}

/// Central differences of forces and energies.
fn difference(
    at: &impl Fn(f64) -> Result<(Vec<f64>, Vec<f64>), FeError>,
    h: f64,
) -> Result<(Vec<f64>, Vec<f64>), FeError> {
    let ((f1, w1), (f0, w0)) = (at(h)?, at(-h)?);
    let slope = |after: &[f64], before: &[f64]| {
        let pairs = after.iter().zip(before);
        pairs.map(|(a, b)| (a - b) / (2.0 * h)).collect()
    };
    Ok((slope(&f1, &f0), slope(&w1, &w0)))
}

/// Derivatives along `d`, element by element.
fn check_derivatives(
    block: &dyn Block,
    u: &[f64],
    d: &[f64],
    here: &Evaluation,
    step: f64,
) -> Result<(), Violation> {
    let at = |h: f64| {
        let moved: Vec<f64> = u.iter().zip(d).map(|(u, d)| u + h * d).collect();
        force(block, &moved)
    };
    let (coarse, fine) = (difference(&at, step)?, difference(&at, 0.5 * step)?);
    let extrapolated = |coarse: &[f64], fine: &[f64]| -> Vec<f64> {
        let pairs = coarse.iter().zip(fine);
        pairs.map(|(c, f)| (4.0 * f - c) / 3.0).collect()
    };
    let df = extrapolated(&coarse.0, &fine.0);
    let dw = extrapolated(&coarse.1, &fine.1);
    let (dim, nodes) = (block.dim(), block.nodes_per_element());
    let (length, entries) = (dim * nodes, tangent_len(dim, nodes));
    let stiffness = largest(&here.tangents);
    let force_tolerance = DIFFERENCES * stiffness;
    let work_tolerance = DIFFERENCES * (largest(&here.forces) + stiffness * step);
    for (element, cell) in block.connectivity().chunks_exact(nodes).enumerate() {
        let k = &here.tangents[element * entries..(element + 1) * entries];
        let f = &here.forces[element * length..(element + 1) * length];
        let mut work = 0.0;
        for entry in 0..length {
            let (a, i) = (entry / dim, entry % dim);
            work += f[entry] * d[dim * cell[a] as usize + i];
            let found = (0..length).map(|other| {
                let (b, j) = (other / dim, other % dim);
                let k = k[tangent_index(dim, nodes, (a, i), (b, j))];
                k * d[dim * cell[b] as usize + j]
            });
            let global = element * length + entry;
            let expected = df[global];
            let place = || format!("element {element}, node {a}, component {i}");
            let property = "tangent is the derivative of the force";
            same(property, place, found.sum(), expected, force_tolerance)?;
        }
        let expected = dw[element];
        let place = || format!("element {element}");
        let property = "force is the derivative of the energy";
        same(property, place, work, expected, work_tolerance)?;
    }
    Ok(())
}

fn check_rigid_motion(block: &dyn Block, points: &[Vector3<f64>]) -> Result<(), Violation> {
    let (dim, size) = (block.dim(), size(points));
    let rest = evaluate(block, &vec![0.0; dim * points.len()])?;
    // Round-off of `C` acts as a strain of 1e-16; a law may lose two more digits.
    let force_tolerance = AGREEMENT * largest(&rest.tangents) * size;
    let energy_tolerance = AGREEMENT * force_tolerance * size;
    // Around an axis of symmetry only a shift along it is rigid.
    let ring = block.symmetry() == Symmetry::Axisymmetric;
    let angles = [0.0, 0.3, 2.0, std::f64::consts::PI];
    let shift = if ring {
        [0.0, -0.4, 0.0]
    } else {
        [0.7, -0.4, 0.2]
    };
    for &angle in if ring { &angles[..1] } else { &angles[..] } {
        // In the plane only the third axis leaves the plane as it is.
        let axis = if dim == 2 {
            [0.0, 0.0, 1.0]
        } else {
            [1.0, -2.0, 0.5]
        };
        let angle = Table::new(vec![(0.0, angle)], Interpolation::Linear)?;
        let motion = Motion {
            translation: shift.map(|x| Table::constant(x * size)),
            rotation: Some(Rotation::new(points[0], axis, angle)?),
        };
        let moved = points.iter().map(|&x| motion.displacement(x, 0.0));
        let u: Vec<f64> = moved.flat_map(|d| d.as_slice()[..dim].to_vec()).collect();
        let (forces, energies) = force(block, &u)?;
        let none = vec![0.0; forces.len()];
        same_entries("no force in rigid motion", &forces, &none, force_tolerance)?;
        same_entries(
            "no energy in rigid motion",
            &energies,
            &none,
            energy_tolerance,
        )?;
    }
    Ok(())
}
