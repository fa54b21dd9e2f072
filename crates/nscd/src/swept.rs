//! Boxes around nodes and the way they go in a step.

/// The box that a set of nodes sweeps in a step, and the range of their displacements.
#[derive(Debug)]
pub(crate) struct Swept {
    low: [f64; 3],
    high: [f64; 3],
    slowest: [f64; 3],
    fastest: [f64; 3],
}

impl Swept {
    pub(crate) fn of(nodes: &[u32], dim: usize, start: &[f64], end: &[f64]) -> Self {
        let (high, low) = ([f64::MIN; 3], [f64::MAX; 3]);
        let mut swept = Self {
            low,
            high,
            slowest: low,
            fastest: high,
        };
        for i in 0..dim {
            for &node in nodes {
                let (a, b) = (start[dim * node as usize + i], end[dim * node as usize + i]);
                swept.low[i] = swept.low[i].min(a.min(b));
                swept.high[i] = swept.high[i].max(a.max(b));
                swept.slowest[i] = swept.slowest[i].min(b - a);
                swept.fastest[i] = swept.fastest[i].max(b - a);
            }
        }
        swept
    }

    fn axes(&self) -> impl Iterator<Item = usize> + '_ {
        (0..3).filter(|&i| self.low[i] <= self.high[i])
    }

    /// Largest component of the displacement of any node here relative to any node there.
    pub(crate) fn fastest_against(&self, other: &Self) -> f64 {
        let along =
            |i: usize| (self.fastest[i] - other.slowest[i]).max(other.fastest[i] - self.slowest[i]);
        self.axes().map(along).fold(0.0, f64::max)
    }

    /// Whether the boxes come closer than `distance`.
    pub(crate) fn meets(&self, other: &Self, distance: f64) -> bool {
        let apart = |i: usize| {
            self.low[i] > other.high[i] + distance || other.low[i] > self.high[i] + distance
        };
        !self.axes().any(apart)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nodes_that_pass_each_other_meet_and_nodes_side_by_side_do_not_race() {
        let start = [0.0, 0.0, 1.0, 0.0, 0.0, 0.0];
        let through = [0.0, 0.0, -1.0, 0.0, 0.0, 0.0];
        let (a, b) = (
            Swept::of(&[0], 3, &start, &through),
            Swept::of(&[1], 3, &start, &through),
        );
        assert!(a.meets(&b, 0.0));
        assert_eq!(a.fastest_against(&b), 2.0);
        let together = [0.0, 0.0, -1.0, 0.0, 0.0, -2.0];
        let (a, b) = (
            Swept::of(&[0], 3, &start, &together),
            Swept::of(&[1], 3, &start, &together),
        );
        assert_eq!(a.fastest_against(&b), 0.0);
        let aside = [5.0, 0.0, 1.0, 0.0, 0.0, 0.0];
        let (a, b) = (
            Swept::of(&[0], 3, &aside, &aside),
            Swept::of(&[1], 3, &aside, &aside),
        );
        assert!(!a.meets(&b, 1.0));
    }
}
