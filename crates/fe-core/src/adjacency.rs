//! Which nodes share an element.

/// Neighbours of each node through elements, itself included, sorted.
#[derive(Debug, Clone)]
pub(crate) struct Adjacency {
    pub(crate) offsets: Vec<usize>,
    pub(crate) columns: Vec<u32>,
}

impl Adjacency {
    /// Of `nodes` nodes; `cells(node, row)` appends the nodes of the elements around a node, repeats allowed.
    pub(crate) fn new(nodes: usize, cells: impl Fn(usize, &mut Vec<u32>)) -> Adjacency {
        let mut offsets = vec![0];
        let mut columns = Vec::new();
        let mut row: Vec<u32> = Vec::new();
        for node in 0..nodes {
            row.clear();
            cells(node, &mut row);
            row.sort_unstable();
            row.dedup();
            columns.extend(&row);
            offsets.push(columns.len());
        }
        Adjacency { offsets, columns }
    }
}
