//! Loops over elements and nodes that give the same bits for any number of threads: each task writes its own
//! slice, and nothing is summed across tasks.

use rayon::prelude::*;

/// Elements per task: long enough (some ten microseconds) that handing it to a thread costs nothing.
pub(crate) const ELEMENTS_PER_TASK: usize = 32;

/// Rows (nodes, columns) per task, for loops that do little work per row.
pub(crate) const ROWS_PER_TASK: usize = 512;

/// Nonzeros of a matrix per task: a row has some dozens.
pub(crate) const NONZEROS_PER_TASK: usize = 16 * ROWS_PER_TASK;

/// True if a loop is better run here than handed to threads.
pub(crate) fn sequential(count: usize, per_task: usize) -> bool {
    count <= per_task || rayon::current_num_threads() == 1
}

/// Calls `row(index, slice)` for each slice of `width` entries of `out`.
pub(crate) fn for_each_row(out: &mut [f64], width: usize, row: impl Fn(usize, &mut [f64]) + Sync) {
    let all = |first: usize, part: &mut [f64]| {
        for (index, slice) in part.chunks_exact_mut(width).enumerate() {
            row(first + index, slice);
        }
    };
    if sequential(out.len() / width, ROWS_PER_TASK) {
        all(0, out);
    } else {
        out.par_chunks_mut(width * ROWS_PER_TASK)
            .enumerate()
            .for_each(|(task, part)| all(task * ROWS_PER_TASK, part));
    }
}
