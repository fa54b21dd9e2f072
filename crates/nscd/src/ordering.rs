//! Elimination order of one body: nested dissection inside, contact candidates last.
//!
//! With the candidates last, the trailing block of the Cholesky factor is the factor of the
//! body condensed onto its contact surface: the compliance needed by the contact solve comes
//! out of the factorization instead of one solve per contact.

use feral_ordering_core::CscPattern;

/// Compressed adjacency of a graph: the neighbours of node `i` are
/// `neighbours[offsets[i]..offsets[i + 1]]`.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Graph<'a> {
    pub(crate) offsets: &'a [usize],
    pub(crate) neighbours: &'a [u32],
}

impl Graph<'_> {
    fn neighbours(&self, node: u32) -> &[u32] {
        let i = node as usize;
        &self.neighbours[self.offsets[i]..self.offsets[i + 1]]
    }
}

const ABSENT: u32 = u32::MAX;

/// Elimination order of `interior` followed by `last` (in their given order).
///
/// The interior is ordered by nested dissection and then postordered along the elimination
/// tree of the whole, which lets the supernodes of the factor grow; a postorder changes no fill.
pub(crate) fn elimination_order(graph: Graph<'_>, interior: &[u32], last: &[u32]) -> Vec<u32> {
    let mut order = nested_dissection(graph, interior);
    order.extend_from_slice(last);
    let parents = elimination_tree(graph, &order);
    let post = postorder_head(&parents, interior.len());
    let mut result: Vec<u32> = post.iter().map(|&k| order[k]).collect();
    result.extend_from_slice(last);
    result
}

/// Nested dissection of the induced subgraph; the given order when the library refuses it.
fn nested_dissection(graph: Graph<'_>, nodes: &[u32]) -> Vec<u32> {
    let local = local_numbers(graph, nodes);
    let mut pointers = vec![0_i32];
    let mut rows: Vec<i32> = Vec::new();
    for (i, &node) in nodes.iter().enumerate() {
        let start = rows.len();
        rows.push(i as i32);
        let inside = graph.neighbours(node).iter().map(|&m| local[m as usize]);
        rows.extend(
            inside
                .filter(|&j| j != ABSENT && j as usize != i)
                .map(|j| j as i32),
        );
        rows[start..].sort_unstable();
        pointers.push(rows.len() as i32);
    }
    CscPattern::new(nodes.len(), &pointers, &rows)
        .and_then(|pattern| feral_scotch::scotch_order(&pattern).ok())
        .map_or_else(
            || nodes.to_vec(),
            |perm| perm.iter().map(|&k| nodes[k as usize]).collect(),
        )
}

fn local_numbers(graph: Graph<'_>, nodes: &[u32]) -> Vec<u32> {
    let mut local = vec![ABSENT; graph.offsets.len() - 1];
    for (i, &node) in nodes.iter().enumerate() {
        local[node as usize] = i as u32;
    }
    local
}

/// Parent of each position of `order` in the elimination tree (Liu's algorithm), `None` at roots.
fn elimination_tree(graph: Graph<'_>, order: &[u32]) -> Vec<Option<usize>> {
    let position = local_numbers(graph, order);
    let mut parent: Vec<Option<usize>> = vec![None; order.len()];
    let mut ancestor: Vec<Option<usize>> = vec![None; order.len()];
    for k in 0..order.len() {
        for &m in graph.neighbours(order[k]) {
            let start = position[m as usize];
            if start == ABSENT || start as usize >= k {
                continue;
            }
            let mut i = start as usize;
            while let Some(next) = ancestor[i].replace(k) {
                if next == k {
                    break;
                }
                i = next;
            }
            if i != k && parent[i].is_none() {
                parent[i] = Some(k);
            }
        }
    }
    parent
}

/// Postorder of the first `head` positions; those whose parent lies beyond count as roots.
fn postorder_head(parents: &[Option<usize>], head: usize) -> Vec<usize> {
    let mut children: Vec<Vec<usize>> = vec![Vec::new(); head];
    let mut roots = Vec::new();
    for i in 0..head {
        match parents[i] {
            Some(p) if p < head => children[p].push(i),
            _ => roots.push(i),
        }
    }
    let mut post = Vec::with_capacity(head);
    let mut stack: Vec<(usize, usize)> = Vec::new();
    for root in roots {
        stack.push((root, 0));
        while let Some((node, next)) = stack.pop() {
            if next < children[node].len() {
                stack.push((node, next + 1));
                stack.push((children[node][next], 0));
            } else {
                post.push(node);
            }
        }
    }
    post
}

#[cfg(test)]
mod tests {
    use super::*;

    fn grid(n: usize) -> (Vec<usize>, Vec<u32>) {
        let mut offsets = vec![0];
        let mut neighbours = Vec::new();
        for j in 0..n {
            for i in 0..n {
                let mut push = |a: usize, b: usize| neighbours.push((a + n * b) as u32);
                if j > 0 {
                    push(i, j - 1);
                }
                if i > 0 {
                    push(i - 1, j);
                }
                if i + 1 < n {
                    push(i + 1, j);
                }
                if j + 1 < n {
                    push(i, j + 1);
                }
                offsets.push(neighbours.len());
            }
        }
        (offsets, neighbours)
    }

    /// Column counts of the Cholesky factor by brute-force symbolic elimination.
    fn fill(graph: Graph<'_>, order: &[u32]) -> usize {
        let n = order.len();
        let position = local_numbers(graph, order);
        let mut rows: Vec<std::collections::BTreeSet<usize>> = order
            .iter()
            .enumerate()
            .map(|(k, &v)| {
                graph
                    .neighbours(v)
                    .iter()
                    .map(|&m| position[m as usize] as usize)
                    .filter(|&i| i > k)
                    .collect()
            })
            .collect();
        let mut total = 0;
        for k in 0..n {
            total += rows[k].len() + 1;
            if let Some(&p) = rows[k].first() {
                let up: Vec<usize> = rows[k].iter().copied().filter(|&i| i != p).collect();
                rows[p].extend(up);
            }
        }
        total
    }

    #[test]
    fn order_is_a_permutation_with_candidates_last_and_little_fill() {
        let (offsets, neighbours) = grid(20);
        let graph = Graph {
            offsets: &offsets,
            neighbours: &neighbours,
        };
        let last: Vec<u32> = (0..20).collect();
        let interior: Vec<u32> = (20..400).collect();
        let order = elimination_order(graph, &interior, &last);
        let mut sorted = order.clone();
        sorted.sort_unstable();
        assert_eq!(sorted, (0..400).collect::<Vec<u32>>());
        assert_eq!(&order[380..], last.as_slice());
        let natural: Vec<u32> = (0..400).collect();
        assert!(fill(graph, &order) * 3 < fill(graph, &natural) * 2);
    }

    #[test]
    fn postorder_keeps_the_fill() {
        let (offsets, neighbours) = grid(12);
        let graph = Graph {
            offsets: &offsets,
            neighbours: &neighbours,
        };
        let interior: Vec<u32> = (0..144).collect();
        let before = nested_dissection(graph, &interior);
        let after = elimination_order(graph, &interior, &[]);
        assert_eq!(fill(graph, &before), fill(graph, &after));
        let parents = elimination_tree(graph, &after);
        assert!(
            parents
                .iter()
                .enumerate()
                .all(|(i, p)| p.is_none_or(|p| p > i))
        );
    }
}
