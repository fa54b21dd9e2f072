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
    !loose_unknowns(model, nodes, fixed).is_empty()
}

/// Unknowns of the body with these nodes that would hold it, together with what is prescribed, if they were prescribed
/// too: as few as possible, and far apart. None where supports hold the body.
pub(crate) fn loose_unknowns(model: &Model, nodes: &[u32], fixed: &[bool]) -> Vec<u32> {
    let mesh = model.solid.mesh();
    let dim = model.solid.dim();
    let count = nodes.len().max(1) as f64;
    let places = nodes.iter().map(|&n| mesh.points[n as usize] / count);
    let center: Vector3<f64> = places.sum();
    let arm = |n: u32| mesh.points[n as usize] - center;
    let size = nodes.iter().map(|&n| arm(n).amax());
    let size = size.fold(f64::MIN_POSITIVE, f64::max);
    let mut rows = Elimination::default();
    for &n in nodes {
        for c in 0..dim {
            let dof = dim * n as usize + c;
            let row = rigid_motions(mesh.symmetry, arm(n) / size, c);
            rows.push(row, dof as u32, fixed[dof]);
        }
    }
    rows.pivots(true);
    if rows.rank == rigid_count(mesh.symmetry) {
        return Vec::new();
    }
    rows.pivots(false)
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

/// Components of the rigid motions at some unknowns, one row an unknown, and their elimination with full pivoting.
#[derive(Debug, Default)]
struct Elimination {
    rows: Vec<Row>,
    /// Rows that were pivots; they are the first.
    rank: usize,
}

#[derive(Debug)]
struct Row {
    motions: [f64; MOTIONS],
    dof: u32,
    prescribed: bool,
}

impl Elimination {
    fn push(&mut self, motions: [f64; MOTIONS], dof: u32, prescribed: bool) {
        self.rows.push(Row {
            motions,
            dof,
            prescribed,
        });
    }

    /// Eliminates with the largest entries of the rows that are prescribed, or are not, until none is left; returns the
    /// unknowns of the pivots.
    fn pivots(&mut self, prescribed: bool) -> Vec<u32> {
        let mut pivots = Vec::new();
        while self.rank < MOTIONS {
            let rows = self.rows.iter().enumerate().skip(self.rank);
            let rows = rows.filter(|(_, row)| row.prescribed == prescribed);
            let entries = rows.flat_map(|(i, row)| {
                let entries = row.motions.iter().enumerate();
                entries.map(move |(j, x)| (x.abs(), i, j))
            });
            let best = entries.max_by(|a, b| a.0.total_cmp(&b.0));
            let Some((size, i, j)) = best.filter(|(size, ..)| *size > HINDERED) else {
                break;
            };
            debug_assert!(size.is_finite());
            self.rows.swap(self.rank, i);
            let pivot = self.rows[self.rank].motions;
            self.rank += 1;
            for row in &mut self.rows[self.rank..] {
                let factor = row.motions[j] / pivot[j];
                (0..MOTIONS).for_each(|k| row.motions[k] -= factor * pivot[k]);
                row.motions[j] = 0.0;
            }
            pivots.push(self.rows[self.rank - 1].dof);
        }
        pivots
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rank_of(symmetry: Symmetry, held: &[([f64; 3], &[usize])]) -> usize {
        let mut rows = Elimination::default();
        for (x, components) in held {
            for &c in *components {
                rows.push(rigid_motions(symmetry, (*x).into(), c), 0, true);
            }
        }
        rows.pivots(true).len()
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
