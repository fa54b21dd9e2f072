//! Force and tangent of one solid element.
//!
//! With `P = F S` and the first elasticity `A_iJkL = delta_ik S_JL + F_iM D_MJNL F_kN`,
//! `f_ai = sum_q w P_iJ dN_a/dX_J` and `K_aibk = sum_q w dN_a/dX_J A_iJkL dN_b/dX_L`: the papers'
//! `(B_L + B_NL)^T S` and `(B_L + B_NL)^T D (B_L + B_NL) + geometric part` \[Feng2007, eq. 30, 34\] without their
//! zeros. Arrays have the node as the last index, which is the vector lane.

use hyperelastic::tensor::INDEX;
use hyperelastic::{Material, Symmetric, Tangent};

use super::matrix::{Matrix, determinant, right_cauchy_green};
use crate::kinematics::deformation_rows;

/// Pairs of components `i <= k`.
pub(super) const PAIRS: [(usize, usize); 6] = [(0, 0), (0, 1), (0, 2), (1, 1), (1, 2), (2, 2)];

/// Quadrature points whose products are held before they are summed into the tangent.
pub(super) const BATCH: usize = 8;

/// Rows of a tangent block that are summed together, in registers.
const ROWS: usize = 4;

/// Gradients `dN_a/dX_J` \[1/m\] stored `\[J\][a]`.
pub(super) type Gradients<const N: usize> = [[f64; N]; 3];

/// Where an element failed.
#[derive(Debug, Clone, Copy)]
pub(super) struct Inversion {
    pub(super) point: usize,
    pub(super) det_f: f64,
}

/// `A_iJkL dN_b/dX_L` for each pair `i <= k`, point and `J`.
pub(super) type Products<const N: usize> = [[Gradients<N>; BATCH]; 6];

/// Deformation at a point, checked.
#[inline(always)]
pub(super) fn deform<const N: usize>(
    u: &[[f64; N]; 3],
    gradients: &Gradients<N>,
    point: usize,
) -> Result<(Matrix, f64), Inversion> {
    let f = deformation_rows(u, gradients);
    let det_f = determinant(&f);
    checked(f, det_f, point)
}

/// A deformation gradient and its determinant, unless matter is inverted or the numbers are none.
#[inline(always)]
pub(super) fn checked(f: Matrix, det_f: f64, point: usize) -> Result<(Matrix, f64), Inversion> {
    // Written so that NaN fails.
    if det_f > 0.0 && det_f < f64::INFINITY {
        Ok((f, det_f))
    } else {
        Err(Inversion { point, det_f })
    }
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
    let s = volume * s;
    let [s] = &s.data.0;
    for i in 0..3 {
        let mut p = [0.0; 3];
        for j in 0..3 {
            p[j] = f[i][0] * s[INDEX[0][j]] + f[i][1] * s[INDEX[1][j]] + f[i][2] * s[INDEX[2][j]];
        }
        for a in 0..N {
            let sum = p[1].mul_add(gradients[1][a], forces[i][a]);
            forces[i][a] = p[0].mul_add(gradients[0][a], p[2].mul_add(gradients[2][a], sum));
        }
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
    products: &mut Products<N>,
    tangent: &mut [f64],
) -> Result<f64, Inversion> {
    let mut energy = 0.0;
    *forces = [[0.0; N]; 3];
    for start in (0..gradients.len()).step_by(BATCH) {
        let end = gradients.len().min(start + BATCH);
        for point in start..end {
            let (gradients, volume) = (&gradients[point], volumes[point]);
            let (f, det_f) = deform(u, gradients, point)?;
            let Ok(response) = material.response(&right_cauchy_green(&f)) else {
                return Err(Inversion { point, det_f });
            };
            energy += volume * response.energy;
            add_force(&f, &response.stress, volume, gradients, forces);
            let a = elasticity(&f, &response.stress, &response.tangent, volume);
            for pair in 0..6 {
                multiply(&a[pair], gradients, &mut products[pair][point - start]);
            }
        }
        let batch = &gradients[start..end];
        for (block, products) in tangent.chunks_exact_mut(N * N).zip(products.iter()) {
            add_products(batch, &products[..end - start], start == 0, block);
        }
    }
    Ok(energy)
}

/// `volume A_iJkL` stored `[pair ik]\[J\][L]`.
#[inline(always)]
fn elasticity(f: &Matrix, s: &Symmetric, d: &Tangent, volume: f64) -> [[[f64; 3]; 3]; 6] {
    // Columns of the tangent, which are its rows to round-off.
    let ([s], d) = (&s.data.0, &d.data.0);
    let mut half = [[[0.0; 6]; 3]; 3];
    for i in 0..3 {
        let f = [volume * f[i][0], volume * f[i][1], volume * f[i][2]];
        for j in 0..3 {
            let (d0, d1, d2) = (&d[INDEX[0][j]], &d[INDEX[1][j]], &d[INDEX[2][j]]);
            for v in 0..6 {
                half[i][j][v] = f[2].mul_add(d2[v], f[1].mul_add(d1[v], f[0] * d0[v]));
            }
        }
    }
    let mut a = [[[0.0; 3]; 3]; 6];
    for (a, (i, k)) in a.iter_mut().zip(PAIRS) {
        for j in 0..3 {
            for l in 0..3 {
                let geometric = if i == k { volume * s[INDEX[j][l]] } else { 0.0 };
                let h = &half[i][j];
                let sum = h[INDEX[0][l]].mul_add(f[k][0], geometric);
                let sum = h[INDEX[1][l]].mul_add(f[k][1], sum);
                a[j][l] = h[INDEX[2][l]].mul_add(f[k][2], sum);
            }
        }
    }
    a
}

/// `A_JL dN_b/dX_L`.
#[inline(always)]
pub(super) fn multiply<const N: usize>(
    a: &[[f64; 3]; 3],
    gradients: &Gradients<N>,
    product: &mut Gradients<N>,
) {
    for j in 0..3 {
        for b in 0..N {
            let sum = a[j][1].mul_add(gradients[1][b], a[j][0] * gradients[0][b]);
            product[j][b] = a[j][2].mul_add(gradients[2][b], sum);
        }
    }
}

/// Sums `dN_a/dX_J product_J[b]` over points and `J` into an `N x N` block.
#[inline(always)]
pub(super) fn add_products<const N: usize>(
    gradients: &[Gradients<N>],
    products: &[Gradients<N>],
    first: bool,
    block: &mut [f64],
) {
    let mut a = 0;
    while a + ROWS <= N {
        add_rows::<N, ROWS>(gradients, products, first, a, block);
        a += ROWS;
    }
    while a < N {
        add_rows::<N, 1>(gradients, products, first, a, block);
        a += 1;
    }
}

#[inline(always)]
fn add_rows<const N: usize, const R: usize>(
    gradients: &[Gradients<N>],
    products: &[Gradients<N>],
    first: bool,
    a: usize,
    block: &mut [f64],
) {
    let mut sums = [[0.0; N]; R];
    for (gradients, product) in gradients.iter().zip(products) {
        for j in 0..3 {
            for r in 0..R {
                let g = gradients[j][a + r];
                for b in 0..N {
                    sums[r][b] = g.mul_add(product[j][b], sums[r][b]);
                }
            }
        }
    }
    let rows = block[a * N..(a + R) * N].chunks_exact_mut(N);
    for (row, sums) in rows.zip(&sums) {
        for b in 0..N {
            row[b] = if first { sums[b] } else { row[b] + sums[b] };
        }
    }
}

/// Storage for [`tangent`].
pub(super) fn no_products<const N: usize>() -> Products<N> {
    [[[[0.0; N]; 3]; BATCH]; 6]
}
