//! Contact problems as FCLib `.hdf5`, for other codes.

use std::path::Path;

use contact_bipotential::{Cone, ContactProblem, Delassus};
use hdf5_pure::{FileBuilder, LibVer};

use super::FclibError;

/// The bytes of a file `/fclib_local` with `W` by compressed columns (`nz = -1`) and the normal first; `path` is only
/// for messages.
///
/// A problem without friction has one row a contact, which other codes do not know: it is written in three dimensions,
/// with `mu = 0` and tangents that nothing moves. Its normal reactions and `|u|` are the same.
///
/// # Errors
/// [`FclibError::File`] for more entries than the format counts, or what the writer says.
pub fn local(path: &Path, problem: &ContactProblem) -> Result<Vec<u8>, FclibError> {
    let failed = |reason: String| FclibError::File {
        path: path.to_owned(),
        reason,
    };
    let spatial;
    let problem = if problem.cone == Cone::Frictionless {
        spatial = with_tangents(problem);
        &spatial
    } else {
        problem
    };
    let columns = Columns::new(problem);
    let integer = |n: usize| {
        i32::try_from(n).map_err(|_| failed(format!("{n} entries, more than FCLib can count")))
    };
    let (size, count) = (integer(problem.q.len())?, integer(columns.values.len())?);
    let pointers = columns.pointers.iter().map(|p| integer(*p));
    let rows = columns.rows.iter().map(|r| integer(*r));

    let mut file = FileBuilder::new();
    // Old enough for every code that reads FCLib.
    file.with_libver_bounds(LibVer::Earliest, LibVer::V18);
    let mut root = file.create_group("fclib_local");
    root.create_dataset("spacedim")
        .with_i32_data(&[problem.cone.dim() as i32]);
    let mut w = root.create_group("W");
    for (name, value) in [("m", size), ("n", size), ("nz", -1), ("nzmax", count)] {
        w.create_dataset(name).with_i32_data(&[value]);
    }
    w.create_dataset("p")
        .with_i32_data(&pointers.collect::<Result<Vec<i32>, _>>()?);
    w.create_dataset("i")
        .with_i32_data(&rows.collect::<Result<Vec<i32>, _>>()?);
    w.create_dataset("x").with_f64_data(&columns.values);
    root.add_group(w.finish());
    let mut vectors = root.create_group("vectors");
    vectors.create_dataset("mu").with_f64_data(&problem.mu);
    vectors
        .create_dataset("q")
        .with_f64_data(&normal_first(&problem.q, problem.cone.dim()));
    root.add_group(vectors.finish());
    file.add_group(root.finish());
    file.finish().map_err(|e| failed(e.to_string()))
}

/// Position in our flat vectors (normal last) of entry `k` of one with the normal first.
fn ours(k: usize, dim: usize) -> usize {
    super::normal_last(k, dim)
}

fn normal_first(v: &[f64], dim: usize) -> Vec<f64> {
    (0..v.len()).map(|k| v[ours(k, dim)]).collect()
}

/// `W` by columns, zeros left out, normal first.
struct Columns {
    pointers: Vec<usize>,
    rows: Vec<usize>,
    values: Vec<f64>,
}

impl Columns {
    fn new(problem: &ContactProblem) -> Self {
        let (w, dim) = (problem.w.to_dense(), problem.cone.dim());
        let mut columns = Columns {
            pointers: vec![0],
            rows: Vec::new(),
            values: Vec::new(),
        };
        for j in 0..w.ncols() {
            let column = w.col_as_slice(ours(j, dim));
            for i in 0..w.nrows() {
                let value = column[ours(i, dim)];
                if value != 0.0 {
                    columns.rows.push(i);
                    columns.values.push(value);
                }
            }
            columns.pointers.push(columns.values.len());
        }
        columns
    }
}

fn with_tangents(problem: &ContactProblem) -> ContactProblem {
    let contacts = problem.contacts();
    let flat = problem.w.to_dense();
    let mut entries = Vec::new();
    let mut q = vec![0.0; 3 * contacts];
    for c in 0..contacts {
        q[3 * c + 2] = problem.q[c];
        entries.extend((0..2).map(|t| (3 * c + t, 3 * c + t, flat[(c, c)])));
        entries.extend((0..contacts).map(|d| (3 * d + 2, 3 * c + 2, flat[(d, c)])));
    }
    let w = Delassus::from_entries(contacts, 3, &entries);
    // Every entry lies inside.
    let w = w.unwrap_or_else(|_| problem.w.clone());
    ContactProblem::unchecked(w, q, vec![0.0; contacts], Cone::Spatial)
}

#[cfg(test)]
mod tests {
    use super::super::hdf5;
    use super::*;

    fn problem(cone: Cone) -> ContactProblem {
        let (contacts, dim) = (3, cone.dim());
        let size = contacts * dim;
        let entry = |i: usize, j: usize| {
            let near = ((i * 5 + j * 3) % 7) as f64 * 0.1 - 0.3;
            if i == j { 4.0 + near } else { near }
        };
        let entries: Vec<_> = (0..size * size)
            .map(|k| (k / size, k % size, entry(k / size, k % size)))
            .collect();
        let w = Delassus::from_entries(contacts, dim, &entries).unwrap();
        let q = (0..size).map(|k| 0.5 - k as f64).collect();
        ContactProblem::unchecked(w, q, vec![0.2, 0.0, 1.5], cone)
    }

    #[test]
    fn what_is_written_is_read() {
        for cone in [Cone::Planar, Cone::Spatial] {
            let given = problem(cone);
            let path = Path::new("x.hdf5");
            let read = hdf5::parse(path, local(path, &given).unwrap()).unwrap();
            assert_eq!(read.cone, given.cone);
            assert_eq!(read.mu, given.mu);
            assert_eq!(read.q, given.q);
            assert_eq!(read.w.to_dense(), given.w.to_dense());
        }
    }

    #[test]
    fn one_row_a_contact_becomes_three() {
        let mut given = problem(Cone::Frictionless);
        given.mu = vec![0.0; 3];
        let path = Path::new("x.hdf5");
        let read = hdf5::parse(path, local(path, &given).unwrap()).unwrap();
        assert_eq!((read.cone, read.contacts()), (Cone::Spatial, 3));
        let (w, flat) = (read.w.to_dense(), given.w.to_dense());
        assert_eq!([w[(5, 2)], w[(2, 5)]], [flat[(1, 0)], flat[(0, 1)]]);
        assert_eq!(
            [w[(3, 3)], w[(4, 4)], w[(3, 4)]],
            [flat[(1, 1)], flat[(1, 1)], 0.0]
        );
        let solved = |p: &ContactProblem| {
            let mut r = Vec::new();
            let outcome = contact_bipotential::solve(p, &mut r, &Default::default());
            assert!(outcome.is_converged());
            r
        };
        let (r, flat) = (solved(&read), solved(&given));
        for c in 0..3 {
            assert!((r[3 * c + 2] - flat[c]).abs() < 1e-9);
            assert_eq!(r[3 * c..3 * c + 2], [0.0, 0.0]);
        }
    }
}
