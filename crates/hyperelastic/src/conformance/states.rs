//! Where laws are tried, and the rotations they are compared under.

use std::f64::consts::TAU;

use nalgebra::{Matrix3, Quaternion, UnitQuaternion};

use super::Options;
use crate::tensor::{self, Symmetric};

/// Rotation for three numbers in `[0, 1]`; evenly spread numbers give evenly spread rotations.
#[must_use]
pub fn rotation([u, v, w]: [f64; 3]) -> Matrix3<f64> {
    let (sin_v, cos_v) = (TAU * v).sin_cos();
    let (sin_w, cos_w) = (TAU * w).sin_cos();
    let (a, b) = ((1.0 - u).max(0.0).sqrt(), u.max(0.0).sqrt());
    let quaternion = Quaternion::new(b * cos_w, a * sin_v, a * cos_v, b * sin_w);
    let unit = UnitQuaternion::new_unchecked(quaternion);
    unit.to_rotation_matrix().into_inner()
}

/// Small strains, equal stretches and pure shears, relative to no strain: where formulas lose digits or divide by zero.
const SPECIAL_STRETCHES: [f64; 4] = [0.7, 1.0 - 1e-7, 1.0 + 1e-9, 1.2];

/// The root of `x^7 = x + 1`, whose powers fill the unit cube of six dimensions evenly.
const ROOT: f64 = 1.112_775_684_278_705_5;

/// All states of [`check`](super::check): the special ones, then a low-discrepancy sequence.
pub(super) fn all(options: &Options) -> Vec<([f64; 3], Matrix3<f64>)> {
    let [low, high] = options.stretches;
    let turned = rotation([0.3, 0.8, 0.45]);
    let mut states = vec![([1.0; 3], rotation([0.0, 0.0, 0.0]))];
    for l in [low, high].into_iter().chain(SPECIAL_STRETCHES) {
        if (low..=high).contains(&l) {
            states.extend(
                [[l; 3], [l, l, 1.0], [l, 1.0, 1.0], [l, 1.0 / l, 1.0]]
                    .map(|stretches| (stretches, turned)),
            );
        }
    }
    for n in 1..=options.states {
        let mut point = [0.0; 6];
        let mut power = 1.0;
        for x in &mut point {
            power /= ROOT;
            *x = (0.5 + n as f64 * power).fract();
        }
        let [a, b, c, u, v, w] = point;
        states.push((
            [a, b, c].map(|x| low * (high / low).powf(x)),
            rotation([u, v, w]),
        ));
    }
    // The special states hold 1 and 1/l too.
    states.retain(|(stretches, _)| stretches.iter().all(|l| (low..=high).contains(l)));
    states
}

/// The size of [`small_strains`] \[-\]: far below what the square of a strain adds, far above the round-off of `C`.
const SMALL_STRAIN: f64 = 1e-7;

/// States with strains of 1e-7.
pub(super) fn small_strains() -> [Symmetric; 4] {
    [
        [1.0, 0.0, 0.0, 0.0, 0.0, 0.0],
        [-1.0, -1.0, -1.0, 0.0, 0.0, 0.0],
        [0.0, 0.0, 0.0, 1.0, 0.0, 0.0],
        [0.7, -0.4, 0.2, 0.3, -0.5, 0.6],
    ]
    .map(|e| tensor::IDENTITY + Symmetric::from(e) * (2.0 * SMALL_STRAIN))
}

/// Tensors that are `F^T F` of no deformation, or of an absurd one.
pub(super) fn impossible() -> [Symmetric; 12] {
    let scaled = |s: f64| tensor::IDENTITY * s;
    [
        Symmetric::zeros(),
        Symmetric::new(0.0, 1.0, 1.0, 0.0, 0.0, 0.0),
        Symmetric::new(-1.0, 1.0, 1.0, 0.0, 0.0, 0.0),
        Symmetric::new(-1.0, -1.0, 1.0, 0.0, 0.0, 0.0),
        Symmetric::new(1.0, 1.0, 1.0, 2.0, 0.0, 0.0),
        Symmetric::new(1.0, 1.0, 1.0, 1.0, 1.0, 1.0),
        Symmetric::new(1e200, 1e-200, 1.0, 0.0, 0.0, 0.0),
        Symmetric::new(1e20, 1e-20, 1.0, 0.0, 0.0, 0.0),
        scaled(1e-105),
        scaled(1e-8),
        scaled(1e20),
        scaled(1e300),
    ]
}

/// `Q A Q^T`.
pub(super) fn rotate(a: &Symmetric, q: &Matrix3<f64>) -> Symmetric {
    tensor::from_matrix(&(q * tensor::to_matrix(a) * q.transpose()))
}
