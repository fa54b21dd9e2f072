//! `W r + q` in twice the digits, for reactions so large that the rounding of `W r` would hide what is left.
//!
//! Two numbers, the second what the first has rounded away, after Dekker and Knuth: sums by `two_sum`, products by
//! splitting both factors into halves of 26 bits.

use crate::delassus::{Delassus, DenseMatrix};

/// `2^27 + 1` splits a number into two halves.
const SPLITTER: f64 = 134_217_729.0;

/// A number cut into halves whose products are exact.
#[derive(Clone, Copy)]
struct Split {
    whole: f64,
    high: f64,
    low: f64,
}

impl Split {
    #[inline(always)]
    fn new(whole: f64) -> Self {
        let c = SPLITTER * whole;
        let high = c - (c - whole);
        Split {
            whole,
            high,
            low: whole - high,
        }
    }
}

/// A sum with what its rounding lost.
#[derive(Clone, Copy, Default)]
struct Sum {
    high: f64,
    low: f64,
}

impl Sum {
    #[inline(always)]
    fn add_product(&mut self, a: f64, b: Split) {
        let a = Split::new(a);
        let product = a.whole * b.whole;
        let lost = ((a.high * b.high - product) + a.high * b.low + a.low * b.high) + a.low * b.low;
        let next = self.high + product;
        let part = next - self.high;
        self.low += ((self.high - (next - part)) + (product - part)) + lost;
        self.high = next;
    }
}

/// Fills `u = W r + q`, rounded once at the end; false for an operator, whose entries nobody knows, and where numbers
/// are too large to be split: `u` is then left alone.
pub(crate) fn velocity(w: &Delassus, r: &[f64], q: &[f64], u: &mut [f64]) -> bool {
    let start = |q: &f64| Sum { high: *q, low: 0.0 };
    let mut sums: Vec<Sum> = q.iter().map(start).collect();
    match w {
        Delassus::Dense(w) => dense(w, r, &mut sums),
        Delassus::BlockSparse(w) => {
            let d = w.dim();
            for c in 0..w.contacts() {
                let blocks = w.row_values(c).chunks_exact(d * d);
                for (&column, block) in w.row(c).iter().zip(blocks) {
                    for j in 0..d {
                        let r = Split::new(r[column as usize * d + j]);
                        for i in 0..d {
                            sums[c * d + i].add_product(block[i * d + j], r);
                        }
                    }
                }
            }
        }
        Delassus::Operator(_) => return false,
    }
    if sums.iter().any(|s| !(s.high + s.low).is_finite()) {
        return false;
    }
    for (u, sum) in u.iter_mut().zip(sums) {
        *u = sum.high + sum.low;
    }
    true
}

/// Fills `out = |W| |r| + |q|`, what the sums of `W r + q` are rounded with; false for an operator.
pub(crate) fn absolute(w: &Delassus, r: &[f64], q: &[f64], out: &mut [f64]) -> bool {
    for (out, q) in out.iter_mut().zip(q) {
        *out = q.abs();
    }
    match w {
        Delassus::Dense(w) => {
            for (j, x) in r.iter().enumerate().filter(|(_, x)| **x != 0.0) {
                for (out, a) in out.iter_mut().zip(w.col_as_slice(j)) {
                    *out += (a * x).abs();
                }
            }
        }
        Delassus::BlockSparse(w) => {
            let d = w.dim();
            for c in 0..w.contacts() {
                let blocks = w.row_values(c).chunks_exact(d * d);
                for (&column, block) in w.row(c).iter().zip(blocks) {
                    let r = &r[column as usize * d..][..d];
                    for (out, row) in out[c * d..].iter_mut().zip(block.chunks_exact(d)) {
                        *out += row.iter().zip(r).map(|(a, x)| (a * x).abs()).sum::<f64>();
                    }
                }
            }
        }
        Delassus::Operator(_) => return false,
    }
    true
}

fn dense(w: &DenseMatrix, r: &[f64], sums: &mut [Sum]) {
    for (j, &x) in r.iter().enumerate() {
        if x == 0.0 {
            continue;
        }
        let x = Split::new(x);
        for (sum, &a) in sums.iter_mut().zip(w.col_as_slice(j)) {
            sum.add_product(a, x);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use faer::Mat;

    #[test]
    fn what_cancels_to_the_last_digit_is_kept() {
        // 1e17 + 1 - 1e17, and a product whose lower half counts.
        let tiny = f64::EPSILON;
        let w = Mat::from_fn(2, 2, |i, j| match (i, j) {
            (0, _) => 1.0,
            (_, 0) => 1.0 + tiny,
            _ => 0.0,
        });
        let r = [1.0 + tiny, -1e17];
        for w in [
            Delassus::Dense(w.clone()),
            Delassus::Dense(w).compressed(2, 1),
        ] {
            let mut u = [0.0; 2];
            assert!(velocity(&w, &r, &[1e17, -1.0 - 2.0 * tiny], &mut u));
            assert_eq!(u, [1.0 + tiny, tiny * tiny]);
        }
    }

    #[test]
    fn what_cannot_be_split_is_left_alone() {
        let w = Delassus::Dense(Mat::from_fn(1, 1, |_, _| 1e305));
        let mut u = [7.0];
        assert!(!velocity(&w, &[1.0], &[0.0], &mut u));
        assert_eq!(u, [7.0]);
    }
}
