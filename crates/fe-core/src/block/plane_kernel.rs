//! Force and tangent of one plane element.
//!
//! Five entries of `F` can change: 11, 12, 33 with the first component of the displacement, 21, 22 with the
//! second. The third row of the gradients is what turns the first component into `F_33 - 1`: `N_a/R` if the body is
//! axisymmetric (then 3 is the hoop direction), zero in plane strain. The law is that of space, and force and
//! tangent are those of [`super::kernel`] without their zeros.

use hyperelastic::tensor::INDEX;
use hyperelastic::{Material, Symmetric, Tangent};

use super::kernel::{Gradients, Inversion, checked};
use super::matrix::{Matrix, right_cauchy_green};

/// Entries `iJ` of `F` that can change: three belong to the first component, two to the second. The gradients that
/// belong to an entry are the row `J`.
const ENTRIES: [(usize, usize); 5] = [(0, 0), (0, 1), (2, 2), (1, 0), (1, 1)];

/// Deformation at a point, checked.
#[inline(always)]
pub(super) fn deform<const N: usize>(
    u: &[[f64; N]; 3],
    gradients: &Gradients<N>,
    point: usize,
) -> Result<(Matrix, f64), Inversion> {
    let mut h = [0.0; 5];
    for a in 0..N {
        for (h, (i, j)) in h.iter_mut().zip(ENTRIES) {
            *h = u[i % 2][a].mul_add(gradients[j][a], *h);
        }
    }
    let f = [
        [1.0 + h[0], h[1], 0.0],
        [h[3], 1.0 + h[4], 0.0],
        [0.0, 0.0, 1.0 + h[2]],
    ];
    let area = f[0][0] * f[1][1] - f[0][1] * f[1][0];
    let det_f = area * f[2][2];
    // Two negative factors are no deformation either.
    let det_f = if f[2][2] < 0.0 { -det_f.abs() } else { det_f };
    checked(f, det_f, point)
}

/// Adds `volume F S dN/dX` to the nodal forces.
#[inline(always)]
pub(super) fn add_force<const N: usize>(
    f: &Matrix,
    s: &Symmetric,
    volume: f64,
    gradients: &Gradients<N>,
    forces: &mut [[f64; N]; 3],
) {
    let [s] = &s.data.0;
    for (i, j) in ENTRIES {
        let p = volume * row_times(f, i, |m| s[INDEX[m][j]]);
        for a in 0..N {
            forces[i % 2][a] = p.mul_add(gradients[j][a], forces[i % 2][a]);
        }
    }
}

/// `F_iM x_M`, of which the entries that are always zero are left out.
#[inline(always)]
fn row_times(f: &Matrix, i: usize, x: impl Fn(usize) -> f64) -> f64 {
    if i == 2 {
        f[2][2] * x(2)
    } else {
        f[i][1].mul_add(x(1), f[i][0] * x(0))
    }
}

/// Strain energy \[J\], nodal forces \[N\] and tangent \[N/m\], see [`super::tangent_index`].
#[inline(always)]
pub(super) fn tangent<M: Material, const N: usize>(
    material: &M,
    u: &[[f64; N]; 3],
    gradients: &[Gradients<N>],
    volumes: &[f64],
    forces: &mut [[f64; N]; 3],
    tangent: &mut [f64],
) -> Result<f64, Inversion> {
    let mut energy = 0.0;
    let mut blocks = [[[0.0; N]; N]; 3];
    *forces = [[0.0; N]; 3];
    for (point, (gradients, &volume)) in gradients.iter().zip(volumes).enumerate() {
        let (f, det_f) = deform(u, gradients, point)?;
        let Ok(response) = material.response(&right_cauchy_green(&f)) else {
            return Err(Inversion { point, det_f });
        };
        energy += volume * response.energy;
        add_force(&f, &response.stress, volume, gradients, forces);
        let a = elasticity(&f, &response.stress, &response.tangent, volume);
        add_blocks(gradients, &a, &mut blocks);
    }
    for (row, sums) in tangent.chunks_exact_mut(N).zip(blocks.as_flattened()) {
        row.copy_from_slice(sums);
    }
    Ok(energy)
}

/// `volume A_iJkL` in the order of the entries.
#[inline(always)]
fn elasticity(f: &Matrix, s: &Symmetric, d: &Tangent, volume: f64) -> [[f64; 5]; 5] {
    // Columns of the tangent, which are its rows to round-off.
    let ([s], d) = (&s.data.0, &d.data.0);
    // Loops, because closures given to `map` are not inlined here.
    let mut a = [[0.0; 5]; 5];
    for (row, (i, j)) in a.iter_mut().zip(ENTRIES) {
        let mut half = [0.0; 4];
        for v in 0..4 {
            half[v] = volume * row_times(f, i, |m| d[INDEX[m][j]][v]);
        }
        for (entry, (k, l)) in row.iter_mut().zip(ENTRIES) {
            *entry = row_times(f, k, |n| half[INDEX[n][l]]);
            if i == k {
                *entry = volume.mul_add(s[INDEX[j][l]], *entry);
            }
        }
    }
    a
}

/// Adds `dN_a/dX_J A_iJkL dN_b/dX_L` to the blocks of the pairs of components.
#[inline(always)]
pub(super) fn add_blocks<const N: usize>(
    gradients: &Gradients<N>,
    a: &[[f64; 5]; 5],
    [first, mixed, second]: &mut [[[f64; N]; N]; 3],
) {
    add_block::<3, 3, N>(gradients, |p, q| a[p][q], first);
    add_block::<3, 2, N>(gradients, |p, q| a[p][3 + q], mixed);
    add_block::<2, 2, N>(gradients, |p, q| a[3 + p][3 + q], second);
}

/// Adds `dN_a/dX_J A_iJkL dN_b/dX_L` to the block of a pair of components that have `P` and `Q` entries.
#[inline(always)]
fn add_block<const P: usize, const Q: usize, const N: usize>(
    gradients: &Gradients<N>,
    a: impl Fn(usize, usize) -> f64,
    block: &mut [[f64; N]; N],
) {
    for p in 0..P {
        let mut product = [0.0; N];
        for q in 0..Q {
            for b in 0..N {
                product[b] = a(p, q).mul_add(gradients[q][b], product[b]);
            }
        }
        for (row, g) in block.iter_mut().zip(&gradients[p]) {
            for b in 0..N {
                row[b] = g.mul_add(product[b], row[b]);
            }
        }
    }
}
