//! Deformation at a point: F, C, E, and the papers' strain-displacement matrices.
//!
//! The element kernels work with `F` directly; [`linear_strain_matrix`] and [`nonlinear_strain_matrix`] are
//! the papers' `B_L` and `B_NL(u)` \[Feng2007, eq. 25, 26\], the reference that the kernels are tested against.
//! Symmetric tensors are stored as 11 22 33 12 13 23.

/// Rows and columns of the entries of a symmetric tensor.
pub const VOIGT: [(usize, usize); 6] = [(0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)];

/// Where entry `(i, j)` of a symmetric tensor is stored.
pub const VOIGT_INDEX: [[usize; 3]; 3] = [[0, 3, 4], [3, 1, 5], [4, 5, 2]];

/// Determinant of a 3 x 3 matrix.
#[inline]
pub fn determinant(m: &[[f64; 3]; 3]) -> f64 {
    m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1])
        - m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0])
        + m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0])
}

/// Inverse and determinant of a 3 x 3 matrix; the inverse is not finite if the determinant is zero.
pub fn inverse(m: &[[f64; 3]; 3]) -> ([[f64; 3]; 3], f64) {
    let det = determinant(m);
    let mut inv = [[0.0; 3]; 3];
    for i in 0..3 {
        for j in 0..3 {
            // Cyclic indices give the cofactor its sign.
            let (r, s) = ((j + 1) % 3, (j + 2) % 3);
            let (p, q) = ((i + 1) % 3, (i + 2) % 3);
            inv[i][j] = (m[r][p] * m[s][q] - m[r][q] * m[s][p]) / det;
        }
    }
    (inv, det)
}

/// Deformation gradient `F = I + u (x) dN/dX` \[-\].
///
/// `u` are nodal displacements \[m\] stored `[i][a]`, `gradients` are `dN_a/dX_J` \[1/m\] stored `\[J\][a]`.
#[inline(always)]
pub fn deformation_gradient<const N: usize>(
    u: &[[f64; N]; 3],
    gradients: &[[f64; N]; 3],
) -> [[f64; 3]; 3] {
    let mut f = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    // Nine independent chains of scalar fused products are faster than lanes that have to be summed.
    for a in 0..N {
        for i in 0..3 {
            for j in 0..3 {
                f[i][j] = u[i][a].mul_add(gradients[j][a], f[i][j]);
            }
        }
    }
    f
}

/// Right Cauchy-Green tensor `C = F^T F` \[-\].
#[inline(always)]
pub fn right_cauchy_green(f: &[[f64; 3]; 3]) -> [f64; 6] {
    VOIGT.map(|(i, j)| f[0][i] * f[0][j] + f[1][i] * f[1][j] + f[2][i] * f[2][j])
}

/// Green-Lagrange strain `E = (H + H^T + H^T H) / 2` \[-\] from the displacement gradient `H = F - I`, without
/// cancellation for small strains.
pub fn green_lagrange(h: &[[f64; 3]; 3]) -> [f64; 6] {
    VOIGT.map(|(i, j)| {
        0.5 * (h[i][j] + h[j][i] + h[0][i] * h[0][j] + h[1][i] * h[1][j] + h[2][i] * h[2][j])
    })
}

/// Cauchy stress `F S F^T / J` \[Pa\] from the second Piola-Kirchhoff stress `S` \[Pa\].
pub fn cauchy_stress(f: &[[f64; 3]; 3], s: &[f64; 6]) -> [f64; 6] {
    let j = determinant(f);
    VOIGT.map(|(i, k)| {
        let mut sum = 0.0;
        for p in 0..3 {
            for q in 0..3 {
                sum += f[i][p] * s[VOIGT_INDEX[p][q]] * f[k][q];
            }
        }
        sum / j
    })
}

/// Von Mises stress \[Pa\] of a stress tensor \[Pa\].
pub fn von_mises(s: &[f64; 6]) -> f64 {
    let normal = (s[0] - s[1]).powi(2) + (s[1] - s[2]).powi(2) + (s[2] - s[0]).powi(2);
    let shear = s[3] * s[3] + s[4] * s[4] + s[5] * s[5];
    (0.5 * normal + 3.0 * shear).sqrt()
}

/// `B_L` \[1/m\] \[Feng2007, eq. 25\]: strain linear in the nodal displacements.
///
/// Column of node `a`: `[i]` component of the displacement, then the six strains with engineering shear.
/// `gradients` are `dN_a/dX_J` \[1/m\] stored `\[J\][a]`.
pub fn linear_strain_matrix<const N: usize>(gradients: &[[f64; N]; 3]) -> [[[f64; 6]; 3]; N] {
    let identity = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    strain_matrix(&identity, gradients)
}

/// `B_NL(u)` \[1/m\] \[Feng2007, eq. 25\]: with `h = F - I` the displacement gradient, `(B_L + B_NL(u)/2) u` is
/// the Green-Lagrange strain and `(B_L + B_NL(u)) du` its change \[Feng2007, eq. 26\].
///
/// Same layout as [`linear_strain_matrix`].
pub fn nonlinear_strain_matrix<const N: usize>(
    h: &[[f64; 3]; 3],
    gradients: &[[f64; N]; 3],
) -> [[[f64; 6]; 3]; N] {
    strain_matrix(h, gradients)
}

/// `sym(m^T du dN/dX)` as a matrix that acts on nodal displacements, engineering shear.
fn strain_matrix<const N: usize>(
    m: &[[f64; 3]; 3],
    gradients: &[[f64; N]; 3],
) -> [[[f64; 6]; 3]; N] {
    std::array::from_fn(|a| {
        std::array::from_fn(|i| {
            VOIGT.map(|(p, q)| {
                if p == q {
                    m[i][p] * gradients[p][a]
                } else {
                    m[i][p] * gradients[q][a] + m[i][q] * gradients[p][a]
                }
            })
        })
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::element::{Element, Hex8, reference_gradients};
    use proptest::prelude::*;

    type Nodal = [[f64; 8]; 3];

    fn nodal(size: f64) -> impl Strategy<Value = Nodal> {
        prop::array::uniform3(prop::array::uniform8(-size..size))
    }

    fn gradients(jitter: &Nodal) -> Nodal {
        let corners = std::array::from_fn(|a| {
            std::array::from_fn(|i| Hex8::reference_nodes()[a][i] + jitter[i][a])
        });
        reference_gradients::<Hex8, 8>(&corners, &[0.3, -0.2, 0.5]).0
    }

    fn displacement_gradient(u: &Nodal, gradients: &Nodal) -> [[f64; 3]; 3] {
        let mut h = deformation_gradient(u, gradients);
        (0..3).for_each(|i| h[i][i] -= 1.0);
        h
    }

    fn strain(u: &Nodal, gradients: &Nodal) -> [f64; 6] {
        let h = displacement_gradient(u, gradients);
        // Engineering shear, as the matrices give it.
        let e = green_lagrange(&h);
        [e[0], e[1], e[2], 2.0 * e[3], 2.0 * e[4], 2.0 * e[5]]
    }

    fn times(b: &[[[f64; 6]; 3]; 8], u: &Nodal) -> [f64; 6] {
        let mut e = [0.0; 6];
        for a in 0..8 {
            for i in 0..3 {
                (0..6).for_each(|v| e[v] += b[a][i][v] * u[i][a]);
            }
        }
        e
    }

    fn close(x: &[f64; 6], y: &[f64; 6], tolerance: f64) -> bool {
        x.iter().zip(y).all(|(x, y)| (x - y).abs() <= tolerance)
    }

    proptest! {
        #[test]
        fn strain_is_linear_part_plus_half_the_nonlinear_one(u in nodal(0.5), jitter in nodal(0.2)) {
            // [Feng2007, eq. 25]
            let g = gradients(&jitter);
            let h = displacement_gradient(&u, &g);
            let linear = times(&linear_strain_matrix(&g), &u);
            let nonlinear = times(&nonlinear_strain_matrix(&h, &g), &u);
            let sum = std::array::from_fn(|v| linear[v] + 0.5 * nonlinear[v]);
            prop_assert!(close(&sum, &strain(&u, &g), 1e-13));
        }

        #[test]
        fn strain_matrices_give_the_derivative_of_the_strain(
            u in nodal(0.5), du in nodal(1.0), jitter in nodal(0.2),
        ) {
            // [Feng2007, eq. 26]; the strain is quadratic, so central differences are exact.
            let g = gradients(&jitter);
            let h = displacement_gradient(&u, &g);
            let linear = times(&linear_strain_matrix(&g), &du);
            let nonlinear = times(&nonlinear_strain_matrix(&h, &g), &du);
            let found = std::array::from_fn(|v| linear[v] + nonlinear[v]);
            let step = 1e-2;
            let at = |s: f64| {
                let moved = std::array::from_fn(|i| std::array::from_fn(|a| u[i][a] + s * du[i][a]));
                strain(&moved, &g)
            };
            let (after, before) = (at(step), at(-step));
            let difference = std::array::from_fn(|v| (after[v] - before[v]) / (2.0 * step));
            prop_assert!(close(&found, &difference, 1e-11));
        }

        #[test]
        fn strain_and_right_cauchy_green_agree(u in nodal(0.5), jitter in nodal(0.2)) {
            let g = gradients(&jitter);
            let c = right_cauchy_green(&deformation_gradient(&u, &g));
            let e = green_lagrange(&displacement_gradient(&u, &g));
            let expected = std::array::from_fn(|v| 2.0 * e[v] + if v < 3 { 1.0 } else { 0.0 });
            prop_assert!(close(&c, &expected, 1e-13));
        }

        #[test]
        fn inverse_undoes(m in prop::array::uniform3(prop::array::uniform3(-1.0..1.0_f64))) {
            let (inv, det) = inverse(&m);
            prop_assume!(det.abs() > 1e-2);
            for i in 0..3 {
                for j in 0..3 {
                    let entry: f64 = (0..3).map(|k| m[i][k] * inv[k][j]).sum();
                    let unit = if i == j { 1.0 } else { 0.0 };
                    prop_assert!((entry - unit).abs() < 1e-11);
                }
            }
        }
    }

    #[test]
    fn von_mises_of_tension_shear_and_pressure() {
        assert_eq!(von_mises(&[2.0, 0.0, 0.0, 0.0, 0.0, 0.0]), 2.0);
        assert_eq!(von_mises(&[5.0, 5.0, 5.0, 0.0, 0.0, 0.0]), 0.0);
        assert!((von_mises(&[0.0, 0.0, 0.0, 0.0, 1.0, 0.0]) - 3.0_f64.sqrt()).abs() < 1e-15);
    }

    #[test]
    fn cauchy_stress_of_a_stretched_and_turned_bar() {
        // Stretched by 2 along x, then turned by a quarter about z: S_11 becomes 2^2 S_11 / J along y.
        let f = [[0.0, -1.0, 0.0], [2.0, 0.0, 0.0], [0.0, 0.0, 1.0]];
        let sigma = cauchy_stress(&f, &[3.0, 0.0, 0.0, 0.0, 0.0, 0.0]);
        assert_eq!(sigma, [0.0, 6.0, 0.0, 0.0, 0.0, 0.0]);
    }
}
