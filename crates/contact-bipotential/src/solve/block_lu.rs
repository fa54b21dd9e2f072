//! Sparse LU by contacts: `D x D` blocks, symmetric pattern, minimum-degree order, pivoting inside of a block only.
//!
//! Contact networks of rigid bodies fill in little, and their blocks are too small for supernodes: one row after the
//! other is cheapest. Without pivoting across blocks the result may be poor where the matrix is nearly singular; the
//! callers check what they do with it.

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::sparse::SymbolicSparseColMatRef;
use faer::sparse::linalg::amd;

use crate::delassus::BlockSparse;
use crate::local::{Matrix, Vector, inverse, load, store};

/// A block padded to four columns, so that a row of it is one vector register.
type Padded = [[f64; 4]; 3];

/// The order of elimination and the storage of the factors.
#[derive(Debug)]
pub(crate) struct BlockLu<const D: usize> {
    /// Contact at each place of the elimination.
    order: Vec<u32>,
    place: Vec<u32>,
    upper: Pattern,
    lower: Pattern,
    u: Vec<Padded>,
    l: Vec<Padded>,
    pivots: Vec<Matrix<D>>,
    work: Vec<Padded>,
}

#[derive(Debug, Default)]
struct Pattern {
    offsets: Vec<usize>,
    columns: Vec<u32>,
}

/// No row.
const NONE: u32 = u32::MAX;

impl Pattern {
    /// Adds the entry `(k, column)` to the last row `k` if it stands right of the diagonal and is not there yet.
    #[inline(always)]
    fn add(&mut self, k: usize, column: u32, mark: &mut [u32]) {
        if column as usize > k && mark[column as usize] != k as u32 {
            mark[column as usize] = k as u32;
            self.columns.push(column);
        }
    }

    /// Becomes the transpose of a square pattern; columns ascend in each row.
    fn transpose_of(&mut self, other: &Pattern) {
        let n = other.offsets.len() - 1;
        let mut next = vec![0usize; n + 1];
        for column in &other.columns {
            next[*column as usize + 1] += 1;
        }
        for k in 0..n {
            next[k + 1] += next[k];
        }
        self.offsets.clone_from(&next);
        self.columns.clear();
        self.columns.resize(next[n], 0);
        for k in 0..n {
            for column in &other.columns[other.range(k)] {
                let p = *column as usize;
                self.columns[next[p]] = k as u32;
                next[p] += 1;
            }
        }
    }

    #[inline(always)]
    fn range(&self, k: usize) -> std::ops::Range<usize> {
        self.offsets[k]..self.offsets[k + 1]
    }
}

/// One block row of the matrix to factorise, written by its owner.
pub(crate) trait BlockRows<const D: usize> {
    /// Calls `put(column, block)` for every block of row `c` that is not zero, the diagonal among them.
    fn row(&self, c: usize, put: impl FnMut(usize, &Matrix<D>));
    /// Whether row and column `c` hold nothing but the diagonal.
    fn is_alone(&self, c: usize) -> bool;
}

impl<const D: usize> BlockLu<D> {
    /// The order for the pattern of `w`.
    pub(crate) fn new(w: &BlockSparse) -> Self {
        let n = w.contacts();
        let order = minimum_degree(w).unwrap_or_else(|| (0..n as u32).collect());
        let mut place = vec![0; n];
        for (k, &c) in order.iter().enumerate() {
            place[c as usize] = k as u32;
        }
        BlockLu {
            order,
            place,
            upper: Pattern::default(),
            lower: Pattern::default(),
            u: Vec::new(),
            l: Vec::new(),
            pivots: vec![Matrix::zeros(); n],
            work: vec![[[0.0; 4]; 3]; n],
        }
    }

    /// Factorises; false when a pivot block is singular.
    pub(crate) fn factorize(&mut self, w: &BlockSparse, rows: &impl BlockRows<D>) -> bool {
        self.symbolic(w, rows);
        let n = self.order.len();
        self.u.clear();
        self.u.resize(self.upper.columns.len(), [[0.0; 4]; 3]);
        self.l.clear();
        self.l.resize(self.lower.columns.len(), [[0.0; 4]; 3]);
        for i in 0..n {
            let (work, place) = (&mut self.work, &self.place);
            rows.row(self.order[i] as usize, |c, block| {
                let slot = &mut work[place[c] as usize];
                for a in 0..D {
                    for b in 0..D {
                        slot[a][b] += block[(a, b)];
                    }
                }
            });
            if !self.eliminate(i) {
                self.work.fill([[0.0; 4]; 3]);
                return false;
            }
        }
        true
    }

    #[inline]
    fn eliminate(&mut self, i: usize) -> bool {
        for at in self.lower.range(i) {
            let k = self.lower.columns[at] as usize;
            let x = std::mem::replace(&mut self.work[k], [[0.0; 4]; 3]);
            // L_ik = A_ik U_kk^-1
            let mut l = [[0.0; 4]; 3];
            for a in 0..D {
                for b in 0..D {
                    for m in 0..D {
                        l[a][b] += x[a][m] * self.pivots[k][(m, b)];
                    }
                }
            }
            let range = self.upper.range(k);
            for (&j, u) in self.upper.columns[range.clone()].iter().zip(&self.u[range]) {
                let target = &mut self.work[j as usize];
                for a in 0..D {
                    target[a] = minus_row_times(target[a], &l[a], u);
                }
            }
            self.l[at] = l;
        }
        for at in self.upper.range(i) {
            self.u[at] = std::mem::replace(
                &mut self.work[self.upper.columns[at] as usize],
                [[0.0; 4]; 3],
            );
        }
        let d = std::mem::replace(&mut self.work[i], [[0.0; 4]; 3]);
        match inverse(&Matrix::from_fn(|a, b| d[a][b])) {
            Some(inv) => {
                self.pivots[i] = inv;
                true
            }
            None => false,
        }
    }

    /// Overwrites the right side with the solution.
    pub(crate) fn solve(&self, x: &mut [f64]) {
        let n = self.order.len();
        let mut y = vec![Vector::zeros(); n];
        for i in 0..n {
            let c = self.order[i] as usize;
            let mut s = load::<D>(x, c);
            for at in self.lower.range(i) {
                subtract(&mut s, &self.l[at], &y[self.lower.columns[at] as usize]);
            }
            y[i] = s;
        }
        for i in (0..n).rev() {
            let mut s = y[i];
            for at in self.upper.range(i) {
                subtract(&mut s, &self.u[at], &y[self.upper.columns[at] as usize]);
            }
            y[i] = self.pivots[i] * s;
            store(x, self.order[i] as usize, &y[i]);
        }
    }

    /// Pattern of the factors for the rows that are not alone, by merging each column into its parent.
    fn symbolic(&mut self, w: &BlockSparse, rows: &impl BlockRows<D>) {
        let n = self.order.len();
        let upper = &mut self.upper;
        upper.offsets.clear();
        upper.offsets.push(0);
        upper.columns.clear();
        let mut mark = vec![NONE; n];
        let (mut first_child, mut next_sibling) = (vec![NONE; n], vec![NONE; n]);
        for k in 0..n {
            let c = self.order[k] as usize;
            let start = upper.columns.len();
            mark[k] = k as u32;
            if !rows.is_alone(c) {
                for &j in w.row(c) {
                    if !rows.is_alone(j as usize) {
                        upper.add(k, self.place[j as usize], &mut mark);
                    }
                }
            }
            let mut child = first_child[k];
            while child != NONE {
                for at in upper.range(child as usize) {
                    upper.add(k, upper.columns[at], &mut mark);
                }
                child = next_sibling[child as usize];
            }
            upper.columns[start..].sort_unstable();
            if let Some(&parent) = upper.columns.get(start) {
                next_sibling[k] = first_child[parent as usize];
                first_child[parent as usize] = k as u32;
            }
            upper.offsets.push(upper.columns.len());
        }
        self.lower.transpose_of(&self.upper);
    }
}

/// `t - l U`: one row of a block, as one vector register.
#[inline(always)]
fn minus_row_times(t: [f64; 4], l: &[f64; 4], u: &Padded) -> [f64; 4] {
    let fused = |t: [f64; 4], x: f64, u: &[f64; 4]| {
        [
            (-x).mul_add(u[0], t[0]),
            (-x).mul_add(u[1], t[1]),
            (-x).mul_add(u[2], t[2]),
            (-x).mul_add(u[3], t[3]),
        ]
    };
    fused(fused(fused(t, l[0], &u[0]), l[1], &u[1]), l[2], &u[2])
}

#[inline(always)]
fn subtract<const D: usize>(s: &mut Vector<D>, block: &Padded, x: &Vector<D>) {
    for a in 0..D {
        for b in 0..D {
            s[a] -= block[a][b] * x[b];
        }
    }
}

fn minimum_degree(w: &BlockSparse) -> Option<Vec<u32>> {
    let n = w.contacts();
    let mut offsets = vec![0usize];
    let mut indices = Vec::with_capacity(w.block_count());
    for c in 0..n {
        indices.extend(w.row(c).iter().map(|&j| j as usize));
        offsets.push(indices.len());
    }
    let pattern = SymbolicSparseColMatRef::new_checked(n, n, &offsets, None, &indices);
    let (mut order, mut place) = (vec![0usize; n], vec![0usize; n]);
    let mut memory =
        MemBuffer::try_new(amd::order_maybe_unsorted_scratch::<usize>(n, indices.len())).ok()?;
    let stack = MemStack::new(&mut memory);
    amd::order_maybe_unsorted(
        &mut order,
        &mut place,
        pattern,
        amd::Control::default(),
        stack,
    )
    .ok()?;
    Some(order.into_iter().map(|c| c as u32).collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::local::load_block;

    struct All<'a>(&'a BlockSparse, Vec<bool>);
    impl BlockRows<3> for All<'_> {
        fn row(&self, c: usize, mut put: impl FnMut(usize, &Matrix<3>)) {
            for (j, block) in self.0.blocks(c) {
                if (self.1[c] || self.1[j]) && j != c {
                    continue;
                }
                put(j, &load_block(block));
            }
        }
        fn is_alone(&self, c: usize) -> bool {
            self.1[c]
        }
    }

    #[test]
    fn solves_what_the_dense_product_made() {
        let n = 40;
        let mut blocks = Vec::new();
        for c in 0..n {
            for j in [c, (c + 1) % n, (c * 7 + 3) % n] {
                let v: Vec<f64> = (0..9)
                    .map(|k| (((c * 31 + j * 17 + k * 5) % 23) as f64 - 11.0) * 0.1)
                    .collect();
                blocks.push((c, j, v.clone()));
                blocks.push((j, c, v));
            }
            blocks.push((c, c, vec![9.0, 1.0, 0.0, -1.0, 8.0, 0.5, 0.0, 0.0, 7.0]));
        }
        let w = BlockSparse::from_blocks(n, 3, &blocks).unwrap();
        let alone: Vec<bool> = (0..n).map(|c| c % 6 == 1).collect();
        for rows in [All(&w, vec![false; n]), All(&w, alone)] {
            let mut lu = BlockLu::<3>::new(&w);
            assert!(lu.factorize(&w, &rows));
            let x: Vec<f64> = (0..3 * n).map(|i| (i % 11) as f64 - 5.0).collect();
            let mut b = vec![0.0; 3 * n];
            for c in 0..n {
                rows.row(c, |j, m| {
                    for i in 0..3 {
                        for k in 0..3 {
                            b[3 * c + i] += m[(i, k)] * x[3 * j + k];
                        }
                    }
                });
            }
            lu.solve(&mut b);
            for i in 0..3 * n {
                assert!((b[i] - x[i]).abs() < 1e-11, "{i}");
            }
        }
    }
}
