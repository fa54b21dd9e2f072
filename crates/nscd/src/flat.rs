//! Flat vectors, their round-off and their places in a system.

use fe_core::ROUND_OFF;

pub(crate) use contact_bipotential::flat::{difference, dot, norm};

/// Largest absolute entry, 0 without entries.
pub(crate) fn largest(a: &[f64]) -> f64 {
    a.iter().fold(0.0, |m, x| m.max(x.abs()))
}

/// What cannot be told from zero in a difference of numbers as large as the largest of `a`, e.g. a gap between
/// positions.
pub(crate) fn round_off(a: &[f64]) -> f64 {
    ROUND_OFF * largest(a)
}

/// The equation of each of `count` dofs, those of a body in their order; `u32::MAX` where there is none.
pub(crate) fn equations(dofs: &[u32], count: usize) -> Vec<u32> {
    let mut equation = vec![u32::MAX; count];
    for (k, &d) in dofs.iter().enumerate() {
        equation[d as usize] = k as u32;
    }
    equation
}
