//! Dense LU with partial pivoting, on one thread.

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::lu::partial_pivoting;
use faer::perm::PermRef;
use faer::{Mat, MatMut, Par};

/// Factors `P A = L U`.
#[derive(Debug)]
pub(crate) struct DenseLu {
    lu: Mat<f64>,
    order: Vec<usize>,
    place: Vec<usize>,
}

impl DenseLu {
    /// Factorises a square matrix in place. A singular one gives factors whose solutions are not finite.
    pub(crate) fn new(mut lu: Mat<f64>) -> Self {
        let n = lu.nrows();
        let (mut order, mut place) = (vec![0; n], vec![0; n]);
        if n > 0 {
            let params = Default::default();
            let scratch =
                partial_pivoting::factor::lu_in_place_scratch::<usize, f64>(n, n, Par::Seq, params);
            let mut memory = MemBuffer::new(scratch);
            partial_pivoting::factor::lu_in_place(
                lu.as_mut(),
                &mut order,
                &mut place,
                Par::Seq,
                MemStack::new(&mut memory),
                params,
            );
        }
        DenseLu { lu, order, place }
    }

    /// Number of rows.
    pub(crate) fn size(&self) -> usize {
        self.order.len()
    }

    /// Overwrites a right side with the solution.
    pub(crate) fn solve(&self, x: &mut [f64]) {
        let n = x.len();
        self.solve_in_place(MatMut::from_column_major_slice_mut(x, n, 1));
    }

    /// Overwrites the columns of a matrix with their solutions.
    pub(crate) fn solve_columns(&self, x: &mut Mat<f64>) {
        self.solve_in_place(x.as_mut());
    }

    fn solve_in_place(&self, x: MatMut<'_, f64>) {
        let (n, columns) = (self.size(), x.ncols());
        if n == 0 {
            return;
        }
        let scratch =
            partial_pivoting::solve::solve_in_place_scratch::<usize, f64>(n, columns, Par::Seq);
        let mut memory = MemBuffer::new(scratch);
        partial_pivoting::solve::solve_in_place(
            self.lu.as_ref(),
            self.lu.as_ref(),
            PermRef::new_checked(&self.order, &self.place, n),
            x,
            Par::Seq,
            MemStack::new(&mut memory),
        );
    }

    /// The storage of the factors, to be filled again.
    pub(crate) fn into_storage(self) -> Mat<f64> {
        self.lu
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn solutions_give_back_the_right_side() {
        let a = Mat::from_fn(5, 5, |i, j| {
            ((3 * i + 5 * j) % 7) as f64 - f64::from(u8::from(i == j))
        });
        let lu = DenseLu::new(a.clone());
        let mut x: Vec<f64> = (0..5).map(f64::from).collect();
        lu.solve(&mut x);
        let mut columns = Mat::from_fn(5, 2, |i, j| if j == 0 { i as f64 } else { 1.0 });
        lu.solve_columns(&mut columns);
        for i in 0..5 {
            let b: f64 = (0..5).map(|j| a[(i, j)] * x[j]).sum();
            assert!((b - i as f64).abs() < 1e-12);
            assert!((columns[(i, 0)] - x[i]).abs() < 1e-12);
        }
        let mut nothing = [];
        DenseLu::new(Mat::new()).solve(&mut nothing);
    }
}
