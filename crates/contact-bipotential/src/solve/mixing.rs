//! Anderson's extrapolation of a fixed-point sequence.

use crate::truth::Truth;

/// Pairs of differences that are kept.
const DEPTH: usize = 8;
/// Steps without a new best point after which the extrapolation rests, and how long it rests.
const PATIENCE: usize = 20;
const REST: usize = 20;

/// The last few steps of a sequence `r -> g(r)`.
#[derive(Debug)]
pub(crate) struct Mixer<'a> {
    scales: &'a [f64],
    last: Option<(Vec<f64>, Vec<f64>)>,
    /// Differences of `g` and of `f = g - r`.
    steps: Vec<(Vec<f64>, Vec<f64>)>,
    idle: usize,
    rest: usize,
}

impl<'a> Mixer<'a> {
    pub(crate) fn new(truth: &'a Truth<'_>) -> Self {
        Mixer {
            scales: truth.scales(),
            last: None,
            steps: Vec::new(),
            idle: 0,
            rest: 0,
        }
    }

    pub(crate) fn forget(&mut self) {
        self.last = None;
        self.steps.clear();
    }

    /// Takes note whether the last step found a new best point. A sequence that only circles is left to itself for a while.
    pub(crate) fn note(&mut self, improved: bool) {
        self.idle = if improved { 0 } else { self.idle + 1 };
        self.rest = self.rest.saturating_sub(1);
        if self.idle >= PATIENCE {
            self.forget();
            self.idle = 0;
            self.rest = REST;
        }
    }

    /// The extrapolation after `r -> g`; `None` while resting and until there is something to extrapolate from.
    pub(crate) fn mix(&mut self, r: &[f64], g: &[f64]) -> Option<Vec<f64>> {
        if self.rest > 0 {
            return None;
        }
        let f: Vec<f64> = g.iter().zip(r).map(|(g, r)| g - r).collect();
        if let Some((last_g, last_f)) = self.last.take() {
            let difference = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a - b).collect();
            if self.steps.len() == DEPTH {
                self.steps.remove(0);
            }
            self.steps
                .push((difference(g, &last_g), difference(&f, &last_f)));
        }
        let gamma = self.least_squares(&f);
        self.last = Some((g.to_vec(), f));
        let gamma = gamma?;
        let mut mixed = g.to_vec();
        for (x, (dg, _)) in gamma.iter().zip(&self.steps) {
            for (m, d) in mixed.iter_mut().zip(dg) {
                *m -= x * d;
            }
        }
        mixed.iter().all(|x| x.is_finite()).then_some(mixed)
    }

    /// The combination of differences that comes closest to `f`, in the energy norm.
    fn least_squares(&self, f: &[f64]) -> Option<Vec<f64>> {
        let m = self.steps.len();
        if m == 0 {
            return None;
        }
        let per = f.len() / self.scales.len();
        let product = |a: &[f64], b: &[f64]| {
            let terms = a
                .chunks_exact(per)
                .zip(b.chunks_exact(per))
                .zip(self.scales);
            terms
                .map(|((a, b), w)| w * a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>())
                .sum::<f64>()
        };
        let mut a = vec![vec![0.0; m + 1]; m];
        for i in 0..m {
            for j in 0..=i {
                a[i][j] = product(&self.steps[i].1, &self.steps[j].1);
                a[j][i] = a[i][j];
            }
            a[i][m] = product(&self.steps[i].1, f);
        }
        let size: f64 = (0..m).map(|i| a[i][i]).sum();
        for i in 0..m {
            a[i][i] += 1e-12 * size;
        }
        eliminate(&mut a)
    }
}

/// Gauss elimination on `m` rows of `m + 1`, symmetric positive definite.
fn eliminate(a: &mut [Vec<f64>]) -> Option<Vec<f64>> {
    let m = a.len();
    for k in 0..m {
        if a[k][k] <= 0.0 || a[k][k].is_nan() {
            return None;
        }
        for i in k + 1..m {
            let l = a[i][k] / a[k][k];
            for j in k..=m {
                a[i][j] -= l * a[k][j];
            }
        }
    }
    let mut x = vec![0.0; m];
    for k in (0..m).rev() {
        let known: f64 = (k + 1..m).map(|j| a[k][j] * x[j]).sum();
        x[k] = (a[k][m] - known) / a[k][k];
    }
    Some(x)
}
