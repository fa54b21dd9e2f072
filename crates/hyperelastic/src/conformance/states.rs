//! Where laws are tried, and the small algebra to compare them.

use std::f64::consts::TAU;

use super::Options;
use crate::tensor;

type Matrix = [[f64; 3]; 3];

/// Rotation for three numbers in `[0, 1]`; evenly spread numbers give evenly spread rotations.
pub fn rotation([u, v, w]: [f64; 3]) -> [[f64; 3]; 3] {
    let (sin_v, cos_v) = (TAU * v).sin_cos();
    let (sin_w, cos_w) = (TAU * w).sin_cos();
    let (a, b) = ((1.0 - u).max(0.0).sqrt(), u.max(0.0).sqrt());
    let (x, y, z, s) = (a * sin_v, a * cos_v, b * sin_w, b * cos_w);
    [
        [
            1.0 - 2.0 * (y * y + z * z),
            2.0 * (x * y - s * z),
            2.0 * (x * z + s * y),
        ],
        [
            2.0 * (x * y + s * z),
            1.0 - 2.0 * (x * x + z * z),
            2.0 * (y * z - s * x),
        ],
        [
            2.0 * (x * z - s * y),
            2.0 * (y * z + s * x),
            1.0 - 2.0 * (x * x + y * y),
        ],
    ]
}

/// `C = F^T F`, components 11 22 33 12 13 23.
pub fn right_cauchy_green(f: &[[f64; 3]; 3]) -> [f64; 6] {
    let entry = |i: usize, j: usize| f[0][i] * f[0][j] + f[1][i] * f[1][j] + f[2][i] * f[2][j];
    [
        entry(0, 0),
        entry(1, 1),
        entry(2, 2),
        entry(0, 1),
        entry(0, 2),
        entry(1, 2),
    ]
}

/// `P = F S`, first Piola-Kirchhoff stress in the unit of `S`: force per reference area.
pub fn first_piola(f: &[[f64; 3]; 3], s: &[f64; 6]) -> [[f64; 3]; 3] {
    product(f, &full(s))
}

/// `sigma = F S F^T/J`, Cauchy stress in the unit of `S`, components 11 22 33 12 13 23.
///
/// \[Hu2022, eq. 40\], \[Feng2007, eq. 21\]
pub fn cauchy(f: &[[f64; 3]; 3], s: &[f64; 6]) -> [f64; 6] {
    let j = f[0][0] * (f[1][1] * f[2][2] - f[1][2] * f[2][1])
        - f[0][1] * (f[1][0] * f[2][2] - f[1][2] * f[2][0])
        + f[0][2] * (f[1][0] * f[2][1] - f[1][1] * f[2][0]);
    rotate(s, f).map(|x| x / j)
}

/// All states of [`check`](super::check): the special ones, then a low-discrepancy sequence.
pub(super) fn all(options: &Options) -> Vec<([f64; 3], Matrix)> {
    let [low, high] = options.stretches;
    let turned = rotation([0.3, 0.8, 0.45]);
    let mut states = vec![([1.0; 3], rotation([0.0, 0.0, 0.0]))];
    for l in [low, 0.7, 1.0 - 1e-7, 1.0 + 1e-9, 1.2, high] {
        if (low..=high).contains(&l) {
            states.extend(
                [[l; 3], [l, l, 1.0], [l, 1.0, 1.0], [l, 1.0 / l, 1.0]]
                    .map(|stretches| (stretches, turned)),
            );
        }
    }
    // Powers of the root of x^7 = x + 1 fill the unit cube of six dimensions evenly.
    const ROOT: f64 = 1.112_775_684_278_705_5;
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

/// States with strains of 1e-7.
pub(super) fn small_strains() -> [[f64; 6]; 4] {
    let near = |e: [f64; 6]| {
        let mut c = tensor::IDENTITY;
        for i in 0..6 {
            c[i] += 2e-7 * e[i];
        }
        c
    };
    [
        near([1.0, 0.0, 0.0, 0.0, 0.0, 0.0]),
        near([-1.0, -1.0, -1.0, 0.0, 0.0, 0.0]),
        near([0.0, 0.0, 0.0, 1.0, 0.0, 0.0]),
        near([0.7, -0.4, 0.2, 0.3, -0.5, 0.6]),
    ]
}

/// Tensors that are `F^T F` of no deformation, or of an absurd one.
pub(super) fn impossible() -> [[f64; 6]; 12] {
    let scaled = |s: f64| tensor::IDENTITY.map(|x| s * x);
    [
        [0.0; 6],
        [0.0, 1.0, 1.0, 0.0, 0.0, 0.0],
        [-1.0, 1.0, 1.0, 0.0, 0.0, 0.0],
        [-1.0, -1.0, 1.0, 0.0, 0.0, 0.0],
        [1.0, 1.0, 1.0, 2.0, 0.0, 0.0],
        [1.0, 1.0, 1.0, 1.0, 1.0, 1.0],
        [1e200, 1e-200, 1.0, 0.0, 0.0, 0.0],
        [1e20, 1e-20, 1.0, 0.0, 0.0, 0.0],
        scaled(1e-105),
        scaled(1e-8),
        scaled(1e20),
        scaled(1e300),
    ]
}

/// The `j`-th unit strain: as a tensor, and in engineering components.
pub(super) fn unit_strain(j: usize) -> ([f64; 6], [f64; 6]) {
    let mut strain = [0.0; 6];
    strain[j] = 1.0;
    (strain, engineering(&strain))
}

/// Shear components doubled.
pub(super) fn engineering(a: &[f64; 6]) -> [f64; 6] {
    [a[0], a[1], a[2], 2.0 * a[3], 2.0 * a[4], 2.0 * a[5]]
}

/// `Q A Q^T`.
pub(super) fn rotate(a: &[f64; 6], q: &Matrix) -> [f64; 6] {
    let qa = product(q, &full(a));
    let entry = |i: usize, j: usize| dot(&qa[i], &q[j]);
    [
        entry(0, 0),
        entry(1, 1),
        entry(2, 2),
        entry(0, 1),
        entry(0, 2),
        entry(1, 2),
    ]
}

/// `D e`.
pub(super) fn times(d: &[[f64; 6]; 6], e: &[f64; 6]) -> [f64; 6] {
    d.map(|row| dot(&row, e))
}

pub(super) fn dot<const N: usize>(a: &[f64; N], b: &[f64; N]) -> f64 {
    a.iter().zip(b).map(|(x, y)| x * y).sum()
}

fn full(a: &[f64; 6]) -> Matrix {
    [[a[0], a[3], a[4]], [a[3], a[1], a[5]], [a[4], a[5], a[2]]]
}

fn product(a: &Matrix, b: &Matrix) -> Matrix {
    let mut c = [[0.0; 3]; 3];
    for i in 0..3 {
        for j in 0..3 {
            c[i][j] = a[i][0] * b[0][j] + a[i][1] * b[1][j] + a[i][2] * b[2][j];
        }
    }
    c
}
