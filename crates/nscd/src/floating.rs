//! Bodies that supports alone do not hold: some rigid motion is left to them.

use fe_core::Symmetry;
use nalgebra::Vector3;

use crate::model::Model;

/// Part of the size of a rigid motion that supports have to hinder \[-\].
const HINDERED: f64 = 1e-9;
/// Rigid motions of a body in space: three displacements and three turns. In the plane there are fewer.
const MOTIONS: usize = 6;

/// Whether a rigid motion of the body with these nodes moves no prescribed unknown.
pub(crate) fn is_floating(model: &Model, nodes: &[u32], fixed: &[bool]) -> bool {
    let mesh = model.solid.mesh();
    let dim = model.solid.dim();
    let count = nodes.len().max(1) as f64;
    let places = nodes.iter().map(|&n| mesh.points[n as usize] / count);
    let center: Vector3<f64> = places.sum();
    let arm = |n: u32| mesh.points[n as usize] - center;
    let size = nodes.iter().map(|&n| arm(n).amax());
    let size = size.fold(f64::MIN_POSITIVE, f64::max);
    let mut rows = Vec::new();
    for &n in nodes {
        for c in (0..dim).filter(|&c| fixed[dim * n as usize + c]) {
            rows.push(rigid_motions(mesh.symmetry, arm(n) / size, c));
        }
    }
    rank(rows) < rigid_count(mesh.symmetry)
}

fn rigid_count(symmetry: Symmetry) -> usize {
    match symmetry {
        Symmetry::None => MOTIONS,
        // Two displacements and the turn in the plane.
        Symmetry::PlaneStrain => 3,
        // The displacement along the axis: a turn about it is none of the plane.
        Symmetry::Axisymmetric => 1,
    }
}

/// Component `c` of every rigid motion at the place `x`; those that do not exist are zero.
fn rigid_motions(symmetry: Symmetry, x: Vector3<f64>, c: usize) -> [f64; MOTIONS] {
    let mut row = [0.0; MOTIONS];
    match (symmetry, c) {
        // A displacement along the radius strains the ring.
        (Symmetry::Axisymmetric, 0) => {}
        (Symmetry::Axisymmetric, _) => row[0] = 1.0,
        (Symmetry::None, _) => {
            let (i, j) = ((c + 1) % 3, (c + 2) % 3);
            row[c] = 1.0;
            // Turns about the axes i and j move the component c by the arms j and -i.
            row[3 + i] = x[j];
            row[3 + j] = -x[i];
        }
        (Symmetry::PlaneStrain, _) => {
            row[c] = 1.0;
            row[2] = if c == 0 { -x[1] } else { x[0] };
        }
    }
    row
}

/// Rank by elimination with full pivoting.
fn rank(mut rows: Vec<[f64; MOTIONS]>) -> usize {
    for rank in 0..MOTIONS {
        let entries = rows.iter().enumerate().skip(rank);
        let entries =
            entries.flat_map(|(i, row)| row.iter().enumerate().map(move |(j, x)| (x.abs(), i, j)));
        let best = entries.max_by(|a, b| a.0.total_cmp(&b.0));
        let Some((size, i, j)) = best.filter(|(size, ..)| *size > HINDERED) else {
            return rank;
        };
        debug_assert!(size.is_finite());
        rows.swap(rank, i);
        let pivot = rows[rank];
        for row in &mut rows[rank + 1..] {
            let factor = row[j] / pivot[j];
            (0..MOTIONS).for_each(|k| row[k] -= factor * pivot[k]);
            row[j] = 0.0;
        }
    }
    MOTIONS
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rank_of(symmetry: Symmetry, held: &[([f64; 3], &[usize])]) -> usize {
        let rows = held.iter().flat_map(|(x, components)| {
            components
                .iter()
                .map(|&c| rigid_motions(symmetry, (*x).into(), c))
        });
        rank(rows.collect())
    }

    #[test]
    fn what_holds_a_body_and_what_does_not() {
        let all: &[usize] = &[0, 1, 2];
        let (a, b, c) = ([0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]);
        assert_eq!(rank_of(Symmetry::None, &[(a, all)]), 3);
        // A hinge: two points leave the turn about their line.
        assert_eq!(rank_of(Symmetry::None, &[(a, all), (b, all)]), 5);
        assert_eq!(rank_of(Symmetry::None, &[(a, all), (b, all), (c, all)]), 6);
        // Three dofs in just the right places are enough in the plane, in the wrong ones they are not.
        let plane = Symmetry::PlaneStrain;
        assert_eq!(rank_of(plane, &[(a, &[0, 1]), (b, &[1])]), 3);
        assert_eq!(rank_of(plane, &[(a, &[0, 1]), (b, &[0])]), 2);
        assert_eq!(rank_of(Symmetry::Axisymmetric, &[(b, &[0])]), 0);
        assert_eq!(rank_of(Symmetry::Axisymmetric, &[(b, &[1])]), 1);
    }
}
