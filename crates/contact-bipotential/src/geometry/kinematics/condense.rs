//! The condensed compliance `W = H C H^T` of a contact map.

use std::borrow::Borrow;

use rayon::prelude::*;

use super::{Contact, ContactMap};
use crate::delassus::DenseMatrix;
use crate::geometry::error::GeometryError;

/// The axes of a contact's frame, one a row. Plain arrays: the loops below vectorise.
type Rows = [[f64; 3]; 3];

/// Marks a component without unknown in [`CompliancePart`].
const NO_UNKNOWN: u32 = u32::MAX;

/// The compliance of one body, seen from those of its nodes that may come into contact.
#[derive(Clone, Debug)]
pub struct CompliancePart {
    offset: Vec<u32>,
    pub(super) c: DenseMatrix,
}

impl CompliancePart {
    /// `c` is the dense compliance \[m/N\], both triangles filled, symmetric; `offset` gives the row of each
    /// displacement component of the mesh (`dim * node + component`), `u32::MAX` where there is none: fixed
    /// components and nodes of other bodies. Components beyond the end of `offset` have no row either.
    ///
    /// # Errors
    /// [`GeometryError::Compliance`] if `c` is not square or an offset lies outside of it.
    pub fn new(offset: Vec<u32>, c: DenseMatrix) -> Result<Self, GeometryError> {
        let n = c.nrows();
        let largest = offset.iter().filter(|row| **row != NO_UNKNOWN).max();
        if c.ncols() != n || largest.is_some_and(|row| *row as usize >= n) {
            return Err(GeometryError::Compliance {
                rows: n,
                columns: c.ncols(),
                largest: largest.map_or(0, |row| *row as usize),
            });
        }
        Ok(Self { offset, c })
    }
}

/// One stencil node with unknowns in a body: where its components sit among the rows in use.
struct Entry {
    rows: [usize; 3],
    weight: f64,
}

/// The stencils of all contacts, restricted to one body.
struct BodyRows<'a> {
    c: &'a DenseMatrix,
    /// Rows of `c` that some contact uses, sorted.
    used: Vec<usize>,
    entries: Vec<Entry>,
    /// Entries of contact `k`: `starts[k]..starts[k + 1]`.
    starts: Vec<usize>,
    /// Contacts with entries.
    touching: Vec<usize>,
}

impl<'a> BodyRows<'a> {
    fn new(map: &ContactMap, part: &'a CompliancePart) -> Self {
        let row = |node: u32, i: usize| -> Option<usize> {
            let row = part.offset.get(map.dim() * node as usize + i)?;
            (i < map.dim() && *row != NO_UNKNOWN).then_some(*row as usize)
        };
        let mut used: Vec<usize> = map
            .nodes()
            .iter()
            .flat_map(|node| (0..3).filter_map(move |i| row(*node, i)))
            .collect();
        used.sort_unstable();
        used.dedup();
        // A component without unknown reads the row after the last, which stays zero.
        let place = |node, i| {
            row(node, i)
                .and_then(|r| used.binary_search(&r).ok())
                .unwrap_or(used.len())
        };
        let (mut entries, mut starts, mut touching) = (Vec::new(), vec![0], Vec::new());
        for (k, contact) in map.contacts.iter().enumerate() {
            for (node, weight) in contact.stencil.iter() {
                let rows = [place(node, 0), place(node, 1), place(node, 2)];
                if rows.iter().any(|r| *r < used.len()) {
                    entries.push(Entry { rows, weight });
                }
            }
            if entries.len() > starts[k] {
                touching.push(k);
            }
            starts.push(entries.len());
        }
        Self {
            c: &part.c,
            used,
            entries,
            starts,
            touching,
        }
    }

    fn entries(&self, contact: usize) -> &[Entry] {
        &self.entries[self.starts[contact]..self.starts[contact + 1]]
    }

    /// `z += w C(used, column)`.
    fn add_column(&self, z: &mut [f64], w: f64, column: usize) {
        let c = self.c.col_as_slice(column);
        if self.used.len() == c.len() {
            for (z, c) in z.iter_mut().zip(c) {
                *z += w * c;
            }
        } else {
            for (z, row) in z.iter_mut().zip(&self.used) {
                *z += w * c[*row];
            }
        }
    }

    /// `Y = C H_b^T` of one contact: a row of `P >= D` numbers for each row in use, and a zero row at the end.
    fn response<const D: usize, const P: usize>(
        &self,
        b: usize,
        axes: &Rows,
        work: &mut Scratch<P>,
    ) {
        let n = self.used.len();
        for z in &mut work.z {
            z.clear();
            z.resize(n, 0.0);
        }
        for entry in self.entries(b) {
            for (z, row) in work
                .z
                .iter_mut()
                .zip(entry.rows)
                .filter(|(_, row)| *row < n)
            {
                self.add_column(z, entry.weight, self.used[row]);
            }
        }
        work.y.clear();
        work.y.resize(n + 1, [0.0; P]);
        let [z0, z1, z2] = &work.z;
        for (y, ((a, b), c)) in work.y.iter_mut().zip(z0.iter().zip(z1).zip(z2)) {
            for j in 0..D {
                y[j] = axes[j][0] * a + axes[j][1] * b + axes[j][2] * c;
            }
        }
    }

    /// Adds `H_a Y`, where `P - D` columns are padding.
    #[inline]
    fn add_block<const D: usize, const P: usize>(
        &self,
        a: usize,
        axes: &Rows,
        y: &[[f64; P]],
        block: &mut [[f64; P]; 3],
    ) {
        let mut sum = [[0.0; P]; 3];
        for entry in self.entries(a) {
            for k in 0..3 {
                let y = &y[entry.rows[k]];
                for j in 0..P {
                    sum[k][j] += entry.weight * y[j];
                }
            }
        }
        for i in 0..D {
            for k in 0..3 {
                for j in 0..P {
                    block[i][j] += axes[i][k] * sum[k][j];
                }
            }
        }
    }
}

/// What one column of blocks needs, reused from column to column.
struct Scratch<const P: usize> {
    /// Global components of `C H_b^T`, before the frame turns them.
    z: [Vec<f64>; 3],
    y: Vec<[f64; P]>,
    /// Blocks `W_ab` for `a >= b`, by rows.
    blocks: Vec<[[f64; P]; 3]>,
}

impl<const P: usize> Scratch<P> {
    fn new() -> Self {
        Self {
            z: [Vec::new(), Vec::new(), Vec::new()],
            y: Vec::new(),
            blocks: Vec::new(),
        }
    }

    /// The blocks of column `b` on and below the diagonal, summed over the bodies in order.
    fn sum_blocks<const D: usize>(&mut self, bodies: &[BodyRows], frames: &[Rows], b: usize) {
        self.blocks.clear();
        self.blocks.resize(frames.len() - b, [[0.0; P]; 3]);
        for body in bodies.iter().filter(|body| !body.entries(b).is_empty()) {
            body.response::<D, P>(b, &frames[b], self);
            let first = body.touching.partition_point(|a| *a < b);
            for a in &body.touching[first..] {
                let block = &mut self.blocks[a - b];
                body.add_block::<D, P>(*a, &frames[*a], &self.y, block);
            }
        }
    }
}

impl ContactMap {
    /// Writes `W = H C H^T` \[m/N\] into `w`, resized to [`row_count`](ContactMap::row_count) squared; exactly
    /// symmetric.
    ///
    /// `C` is the sum of the bodies' compliances: two contacts couple through the bodies they share. Costs about
    /// `contacts^2 * stencil * 9` multiplications; only the lower triangle is computed. Columns are spread over
    /// threads and each is summed in a fixed order, so that the bits do not depend on their number.
    pub fn delassus<P: Borrow<CompliancePart>>(&self, bodies: &[P], w: &mut DenseMatrix) {
        let n = self.row_count();
        if w.nrows() != n || w.ncols() != n {
            *w = DenseMatrix::zeros(n, n);
        }
        let bodies: Vec<BodyRows> = bodies
            .iter()
            .map(|part| BodyRows::new(self, part.borrow()))
            .collect();
        // Rows of three padded to four: one AVX register.
        match self.cone().dim() {
            1 => self.lower_triangle::<1, 1>(&bodies, w),
            2 => self.lower_triangle::<2, 2>(&bodies, w),
            _ => self.lower_triangle::<3, 4>(&bodies, w),
        }
        mirror(w);
    }

    fn lower_triangle<const D: usize, const P: usize>(
        &self,
        bodies: &[BodyRows],
        w: &mut DenseMatrix,
    ) {
        let rows = |c: &Contact| self.axes(c).map(<[f64; 3]>::from);
        let frames: Vec<Rows> = self.contacts.iter().map(rows).collect();
        let chunks = w.par_col_chunks_mut(D).enumerate();
        chunks.for_each_init(Scratch::<P>::new, |work, (b, columns)| {
            work.sum_blocks::<D>(bodies, &frames, b);
            for (j, column) in columns.col_iter_mut().enumerate() {
                // Columns of an owned matrix are always contiguous.
                let Some(column) = column.try_as_col_major_mut() else {
                    continue;
                };
                let contacts = column.as_slice_mut().chunks_exact_mut(D).skip(b);
                for (w, block) in contacts.zip(&work.blocks) {
                    for i in 0..D {
                        w[i] = block[i][j];
                    }
                }
            }
        });
    }
}

/// Copies the lower triangle to the upper one, tile by tile to stay in cache.
fn mirror(w: &mut DenseMatrix) {
    const TILE: usize = 32;
    let n = w.nrows();
    let mut tile = [[0.0; TILE]; TILE];
    for j0 in (0..n).step_by(TILE) {
        let j1 = (j0 + TILE).min(n);
        for i0 in (j0..n).step_by(TILE) {
            let i1 = (i0 + TILE).min(n);
            for j in j0..j1 {
                tile[j - j0][..i1 - i0].copy_from_slice(&w.col_as_slice(j)[i0..i1]);
            }
            for i in i0..i1 {
                let upper = &mut w.col_as_slice_mut(i)[j0..j1.min(i)];
                for (upper, row) in upper.iter_mut().zip(&tile) {
                    *upper = row[i - i0];
                }
            }
        }
    }
}
