//! Force and tangent of one element with projected dilatation.
//!
//! With `J_q = det F_q` and functions `b_i` that are orthonormal under the weights `w_q`, the dilatation is
//! `theta_q = sum_i b_qi sum_r w_r b_ri J_r`, and the energy `sum_q w_q W(Fbar_q)` with `Fbar = alpha F`,
//! `alpha = (theta/J)^(1/3)`. Its derivatives, with `Pbar = Fbar S`, `tau = Pbar : Fbar` and `G = F^-T`, taken as a
//! function of `F` and `theta`:
//! `W_F = alpha Pbar - tau/3 G`, `W_theta = tau / (3 theta)`; and with `A` the first elasticity at `Fbar`,
//! `y = alpha (A Fbar + Pbar)`, `s = Fbar A Fbar + tau`, `T = d tr(F^-1 dF F^-1 dF)`:
//! `W_FF = alpha^2 A - (y G + G y)/3 + s/9 G G + tau/3 T`, `W_Ftheta = (y/3 - s/9 G)/theta`,
//! `W_thetatheta = (s/9 - tau/3)/theta^2`. The amplitudes `pi_i = sum_q w_q b_qi W_theta` are those of the pressure;
//! they act on `dJ = J G : dF` and `d2J = J (G G - T)`.
//!
//! The entries of `F` that can change are taken as a list: nine in space, five in the plane.

use hyperelastic::tensor::INDEX;
use hyperelastic::{Material, Tangent};

use super::entries::{Entries, Plane, Space};
use super::kernel::{self, BATCH, Gradients, Inversion, PAIRS, Products};
use super::matrix::{Matrix, right_cauchy_green};
use super::plane_kernel;
use super::projection::{Deformed, MODES, Points, Workspace, add_stress};

/// `sum_i amplitude_i x_i`.
#[inline(always)]
fn add_multiples<const N: usize>(
    amplitudes: &[f64],
    vectors: &[Gradients<N>],
    sum: &mut [[f64; N]; 3],
) {
    for (amplitude, vector) in amplitudes.iter().zip(vectors) {
        for (sum, vector) in sum.as_flattened_mut().iter_mut().zip(vector.as_flattened()) {
            *sum = amplitude.mul_add(*vector, *sum);
        }
    }
}

/// Entries of `F S`.
#[inline(always)]
fn first_stress<L: Entries<K>, const K: usize>(f: &Matrix, s: &[f64; 6]) -> [f64; K] {
    L::LIST.map(|(_, i, j)| (0..3).map(|m| f[i][m] * s[INDEX[m][j]]).sum())
}

/// Strain energy \[J\], amplitudes of the pressure, and nodal forces \[N\].
#[inline(never)]
fn forces<L: Entries<K>, const K: usize, const N: usize>(
    element: Points<'_, N>,
    work: &Workspace<N>,
    forces: &mut [[f64; N]; 3],
) -> (f64, [f64; MODES]) {
    let mut energy = 0.0;
    let mut pressure = [0.0; MODES];
    *forces = [[0.0; N]; 3];
    for (point, (at, (w, s))) in work.points.iter().zip(&work.stresses).enumerate() {
        let (f_bar, volume) = (at.f_bar(), element.volumes[point]);
        energy += volume * w;
        let mut p = first_stress::<L, K>(&f_bar, &s.data.0[0].map(|s| volume * s));
        let trace = product(&p, &L::LIST.map(|(_, i, j)| f_bar[i][j]));
        let (scale, along) = (at.scale(), trace / (3.0 * at.det_f));
        for (p, (_, i, j)) in p.iter_mut().zip(L::LIST) {
            *p = scale * *p - along * at.cofactor[i][j];
        }
        add_stress::<L, K, N>(&p, &element.gradients[point], forces);
        for (pressure, b) in pressure.iter_mut().zip(element.modes_at(point)) {
            *pressure += b * trace / (3.0 * at.theta);
        }
    }
    add_multiples(&pressure, &work.rates, forces);
    (energy, pressure)
}

/// Strain energy \[J\] and nodal forces \[N\], which are stored `[i][a]`.
#[inline(always)]
pub(super) fn internal_force<L: Entries<K>, M: Material, const K: usize, const N: usize>(
    material: &M,
    u: &[[f64; N]; 3],
    element: Points<'_, N>,
    work: &mut Workspace<N>,
    f: &mut [[f64; N]; 3],
) -> Result<f64, Inversion> {
    work.deform::<L, K>(u, element)?;
    work.stresses.clear();
    for (point, at) in work.points.iter().enumerate() {
        let stress = material.stress(&right_cauchy_green(&at.f_bar()));
        work.stresses.push(stress.map_err(|_| at.failed(point))?);
    }
    Ok(forces::<L, K, N>(element, work, f).0)
}

/// Deformation, stresses and moduli of all points.
#[inline(always)]
fn respond<L: Entries<K>, M: Material, const K: usize, const N: usize>(
    material: &M,
    u: &[[f64; N]; 3],
    element: Points<'_, N>,
    work: &mut Workspace<N>,
) -> Result<(), Inversion> {
    work.deform::<L, K>(u, element)?;
    work.stresses.clear();
    work.moduli.clear();
    for (point, at) in work.points.iter().enumerate() {
        let response = material.response(&right_cauchy_green(&at.f_bar()));
        let response = response.map_err(|_| at.failed(point))?;
        work.stresses.push((response.energy, response.stress));
        work.moduli.push(response.tangent);
    }
    Ok(())
}

/// Strain energy \[J\], nodal forces \[N\] and tangent \[N/m\] in space, see [`super::tangent_index`].
#[inline(always)]
pub(super) fn tangent<M: Material, const N: usize>(
    material: &M,
    u: &[[f64; N]; 3],
    element: Points<'_, N>,
    work: &mut Workspace<N>,
    f: &mut [[f64; N]; 3],
    products: &mut Products<N>,
    tangent: &mut [f64],
) -> Result<f64, Inversion> {
    respond::<Space, M, 9, N>(material, u, element, work)?;
    Ok(assemble(element, work, f, products, tangent))
}

/// The same in the plane.
#[inline(always)]
pub(super) fn plane_tangent<M: Material, const N: usize>(
    material: &M,
    u: &[[f64; N]; 3],
    element: Points<'_, N>,
    work: &mut Workspace<N>,
    f: &mut [[f64; N]; 3],
    tangent: &mut [f64],
) -> Result<f64, Inversion> {
    respond::<Plane, M, 5, N>(material, u, element, work)?;
    Ok(assemble_plane(element, work, f, tangent))
}

// What follows knows no law, so that the compiler makes it once for each element.

#[inline(never)]
fn assemble<const N: usize>(
    element: Points<'_, N>,
    work: &Workspace<N>,
    f: &mut [[f64; N]; 3],
    products: &mut Products<N>,
    tangent: &mut [f64],
) -> f64 {
    let gradients = element.gradients;
    let add = |point: usize, h: &[[f64; 9]; 9]| {
        let slot = point % BATCH;
        for (products, (i, k)) in products.iter_mut().zip(PAIRS) {
            let block = [0, 1, 2].map(|j| [0, 1, 2].map(|l| h[3 * i + j][3 * k + l]));
            kernel::multiply(&block, &gradients[point], &mut products[slot]);
        }
        if slot + 1 == BATCH || point + 1 == gradients.len() {
            let batch = &gradients[point - slot..=point];
            for (block, products) in tangent.chunks_exact_mut(N * N).zip(products.iter()) {
                kernel::add_products(batch, &products[..=slot], point < BATCH, block);
            }
        }
    };
    let (energy, pressure) = forces::<Space, 9, N>(element, work, f);
    let couplings = hessians::<Space, 9, N>(element, work, &pressure, add);
    add_couplings(&PAIRS, &couplings, &work.rates, tangent);
    energy
}

#[inline(never)]
fn assemble_plane<const N: usize>(
    element: Points<'_, N>,
    work: &Workspace<N>,
    f: &mut [[f64; N]; 3],
    tangent: &mut [f64],
) -> f64 {
    let mut blocks = [[[0.0; N]; N]; 3];
    let add = |point: usize, h: &[[f64; 5]; 5]| {
        plane_kernel::add_blocks(&element.gradients[point], h, &mut blocks);
    };
    let (energy, pressure) = forces::<Plane, 5, N>(element, work, f);
    let couplings = hessians::<Plane, 5, N>(element, work, &pressure, add);
    for (row, sums) in tangent.chunks_exact_mut(N).zip(blocks.as_flattened()) {
        row.copy_from_slice(sums);
    }
    let pairs = [(0, 0), (0, 1), (1, 1)];
    add_couplings(&pairs, &couplings, &work.rates, tangent);
    energy
}

/// `add(point, ..)` of the Hessian in `F` of each point, and the vectors `c_i` of the part `sum_i (c_i g_i + g_i c_i)`
/// of the tangent, with the rates `g_i`.
#[inline(always)]
fn hessians<L: Entries<K>, const K: usize, const N: usize>(
    element: Points<'_, N>,
    work: &Workspace<N>,
    pressure: &[f64; MODES],
    mut add: impl FnMut(usize, &[[f64; K]; K]),
) -> [Gradients<N>; MODES] {
    let mut couplings = [[[0.0; N]; 3]; MODES];
    let mut bulk = [[0.0; MODES]; MODES];
    for (point, at) in work.points.iter().enumerate() {
        let (modes, volume) = (element.modes_at(point), element.volumes[point]);
        let local: f64 = modes.iter().zip(pressure).map(|(b, p)| b * p).sum();
        let s = work.stresses[point].1.data.0[0].map(|s| volume * s);
        let a = elasticity::<L, K>(&at.f_bar(), &s, &work.moduli[point], volume);
        let hessian = hessian::<L, K>(at, &s, &a, volume * local);
        add(point, &hessian.ff);
        for (i, b) in modes.iter().enumerate() {
            let coupling = hessian.f_theta.map(|h| b * h);
            add_stress::<L, K, N>(&coupling, &element.gradients[point], &mut couplings[i]);
            for (j, c) in modes.iter().enumerate() {
                bulk[i][j] += 0.5 * hessian.theta_theta * b * c;
            }
        }
    }
    for (coupling, bulk) in couplings.iter_mut().zip(&bulk) {
        add_multiples(bulk, &work.rates, coupling);
    }
    couplings
}

/// Second derivatives of the energy of a point, times its volume.
struct Hessian<const K: usize> {
    /// With that of the pressure in it.
    ff: [[f64; K]; K],
    f_theta: [f64; K],
    theta_theta: f64,
}

/// From the stress `s`, the first elasticity `a` and the pressure of the point, all times its volume.
#[inline(never)]
fn hessian<L: Entries<K>, const K: usize>(
    at: &Deformed,
    s: &[f64; 6],
    a: &[[f64; K]; K],
    pressure: f64,
) -> Hessian<K> {
    let (scale, f_bar, theta) = (at.scale(), at.f_bar(), at.theta);
    let g = at.cofactor.map(|row| row.map(|c| c / at.det_f));
    let stretch = L::LIST.map(|(_, i, j)| f_bar[i][j]);
    let mut y = first_stress::<L, K>(&f_bar, s);
    let trace = product(&y, &stretch);
    for (y, a) in y.iter_mut().zip(a) {
        *y += product(a, &stretch);
    }
    // `y` without its factor alpha: its product with Fbar is `s`.
    let bulk = product(&y, &stretch) / 9.0;
    let p = pressure * at.det_f;
    let (dyadic, turning) = (bulk + p, trace / 3.0 - p);
    let y = y.map(|y| scale * y / 3.0);
    let mut ff = [[0.0; K]; K];
    for (row, (_, i, j)) in L::LIST.into_iter().enumerate() {
        for (column, (_, k, l)) in L::LIST.into_iter().enumerate() {
            ff[row][column] =
                scale * scale * a[row][column] - y[row] * g[k][l] - g[i][j] * y[column]
                    + dyadic * g[i][j] * g[k][l]
                    + turning * g[i][l] * g[k][j];
        }
    }
    let mut f_theta = y;
    for (h, (_, i, j)) in f_theta.iter_mut().zip(L::LIST) {
        *h = (*h - bulk * g[i][j]) / theta;
    }
    Hessian {
        ff,
        f_theta,
        theta_theta: (bulk - trace / 3.0) / (theta * theta),
    }
}

#[inline(always)]
fn product<const K: usize>(x: &[f64; K], y: &[f64; K]) -> f64 {
    x.iter().zip(y).map(|(x, y)| x * y).sum()
}

/// `delta_ik s_JL + volume F_iM D_MJNL F_kN`.
#[inline(never)]
fn elasticity<L: Entries<K>, const K: usize>(
    f: &Matrix,
    s: &[f64; 6],
    d: &Tangent,
    volume: f64,
) -> [[f64; K]; K] {
    // Columns of the tangent, which are its rows to round-off.
    let d = &d.data.0;
    let mut a = [[0.0; K]; K];
    for (row, (_, i, j)) in a.iter_mut().zip(L::LIST) {
        let mut half = [0.0; 6];
        for m in 0..3 {
            let f = volume * f[i][m];
            for v in 0..6 {
                half[v] = f.mul_add(d[INDEX[m][j]][v], half[v]);
            }
        }
        for (entry, (_, k, l)) in row.iter_mut().zip(L::LIST) {
            *entry = if i == k { s[INDEX[j][l]] } else { 0.0 };
            for n in 0..3 {
                *entry = half[INDEX[n][l]].mul_add(f[k][n], *entry);
            }
        }
    }
    a
}

/// Adds `sum_m (c_m g_m + g_m c_m)` to the blocks of pairs of components.
#[inline(always)]
fn add_couplings<const N: usize>(
    pairs: &[(usize, usize)],
    couplings: &[Gradients<N>; MODES],
    rates: &[Gradients<N>; MODES],
    tangent: &mut [f64],
) {
    for (block, &(i, k)) in tangent.chunks_exact_mut(N * N).zip(pairs) {
        for (c, g) in couplings.iter().zip(rates) {
            for (a, row) in block.chunks_exact_mut(N).enumerate() {
                for b in 0..N {
                    row[b] = c[i][a].mul_add(g[k][b], g[i][a].mul_add(c[k][b], row[b]));
                }
            }
        }
    }
}
