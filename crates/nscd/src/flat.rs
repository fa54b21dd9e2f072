//! Flat vectors and their round-off.

use fe_core::ROUND_OFF;

/// `a . b`.
pub(crate) fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// `sqrt(a . a)`.
pub(crate) fn norm(a: &[f64]) -> f64 {
    dot(a, a).sqrt()
}

/// `a - b`.
pub(crate) fn difference(a: &[f64], b: &[f64]) -> Vec<f64> {
    a.iter().zip(b).map(|(a, b)| a - b).collect()
}

/// Largest absolute entry, 0 without entries.
pub(crate) fn largest(a: &[f64]) -> f64 {
    a.iter().fold(0.0, |m, x| m.max(x.abs()))
}

/// What cannot be told from zero in a difference of numbers as large as the largest of `a`, e.g. a gap between positions.
pub(crate) fn round_off(a: &[f64]) -> f64 {
    ROUND_OFF * largest(a)
}
