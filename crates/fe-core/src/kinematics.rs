//! Deformation at a point: `F`, and the papers' strain-displacement matrices; `C` and the stresses are those of
//! `hyperelastic`.
//!
//! The element kernels work with `F` directly; [`linear_strain_matrix`] and [`nonlinear_strain_matrix`] are
//! the papers' `B_L` and `B_NL(u)` \[Feng2007, eq. 25, 26\], the reference that the kernels are tested against.
//! Symmetric tensors are stored as 11 22 33 12 13 23.
//! Nodal values are arrays with the node as the last index, which is the vector lane of the kernels.

use hyperelastic::tensor::COMPONENTS;
use nalgebra::{Matrix3, SMatrix};

/// Deformation gradient `F = I + u (x) dN/dX` \[-\].
///
/// `u` are nodal displacements \[m\] stored `[i][a]`, `gradients` are `dN_a/dX_J` \[1/m\] stored `\[J\][a]`.
#[inline(always)]
#[must_use]
pub fn deformation_gradient<const N: usize>(
    u: &[[f64; N]; 3],
    gradients: &[[f64; N]; 3],
) -> Matrix3<f64> {
    let f = deformation_rows(u, gradients);
    Matrix3::from_fn(|i, j| f[i][j])
}

/// The rows of [`deformation_gradient`].
#[inline(always)]
pub(crate) fn deformation_rows<const N: usize>(
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

/// `B_L` \[1/m\] \[Feng2007, eq. 25\]: strain linear in the nodal displacements.
///
/// One matrix for each node, whose column `i` holds the six strains, with engineering shear, of its displacement along
/// `i`. `gradients` are `dN_a/dX_J` \[1/m\] stored `\[J\][a]`.
#[must_use]
pub fn linear_strain_matrix<const N: usize>(gradients: &[[f64; N]; 3]) -> [SMatrix<f64, 6, 3>; N] {
    strain_matrix(&Matrix3::identity(), gradients)
}

/// `B_NL(u)` \[1/m\] \[Feng2007, eq. 25\]: with `h = F - I` the displacement gradient, `(B_L + B_NL(u)/2) u` is
/// the Green-Lagrange strain and `(B_L + B_NL(u)) du` its change \[Feng2007, eq. 26\].
///
/// Same layout as [`linear_strain_matrix`].
#[must_use]
pub fn nonlinear_strain_matrix<const N: usize>(
    h: &Matrix3<f64>,
    gradients: &[[f64; N]; 3],
) -> [SMatrix<f64, 6, 3>; N] {
    strain_matrix(h, gradients)
}

/// `sym(m^T du dN/dX)` as a matrix that acts on nodal displacements, engineering shear.
fn strain_matrix<const N: usize>(
    m: &Matrix3<f64>,
    gradients: &[[f64; N]; 3],
) -> [SMatrix<f64, 6, 3>; N] {
    std::array::from_fn(|a| {
        SMatrix::from_fn(|v, i| {
            let (p, q) = COMPONENTS[v];
            if p == q {
                m[(i, p)] * gradients[p][a]
            } else {
                m[(i, p)] * gradients[q][a] + m[(i, q)] * gradients[p][a]
            }
        })
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::element::{Element, Hex8, jacobian, reference_gradients};
    use hyperelastic::tensor::{IDENTITY, engineering};
    use hyperelastic::{Symmetric, right_cauchy_green};
    use nalgebra::Vector3;
    use proptest::prelude::*;

    type Nodal = [[f64; 8]; 3];

    fn nodal(size: f64) -> impl Strategy<Value = Nodal> {
        prop::array::uniform3(prop::array::uniform8(-size..size))
    }

    const POINT: [f64; 3] = [0.3, -0.2, 0.5];

    fn corners(jitter: &Nodal) -> [[f64; 3]; 8] {
        let nodes = Hex8::reference_nodes();
        std::array::from_fn(|a| std::array::from_fn(|i| nodes[a][i] + jitter[i][a]))
    }

    fn gradients(jitter: &Nodal) -> Nodal {
        reference_gradients::<Hex8, 8>(&corners(jitter), &POINT).0
    }

    fn displacement_gradient(u: &Nodal, gradients: &Nodal) -> Matrix3<f64> {
        deformation_gradient(u, gradients) - Matrix3::identity()
    }

    /// `E = (H + H^T + H^T H) / 2` from `H = F - I`, without cancellation for small strains.
    fn green_lagrange(h: &Matrix3<f64>) -> Symmetric {
        let entry = |(i, j)| 0.5 * (h[(i, j)] + h[(j, i)] + h.column(i).dot(&h.column(j)));
        Symmetric::from(COMPONENTS.map(entry))
    }

    /// With engineering shear, as the matrices give it.
    fn strain(u: &Nodal, gradients: &Nodal) -> Symmetric {
        engineering(&green_lagrange(&displacement_gradient(u, gradients)))
    }

    fn times(b: &[SMatrix<f64, 6, 3>; 8], u: &Nodal) -> Symmetric {
        let nodes = b.iter().enumerate();
        nodes
            .map(|(a, b)| b * Vector3::new(u[0][a], u[1][a], u[2][a]))
            .sum()
    }

    proptest! {
        #[test]
        fn strain_is_linear_part_plus_half_the_nonlinear_one(u in nodal(0.5), jitter in nodal(0.2)) {
            // [Feng2007, eq. 25]
            let g = gradients(&jitter);
            let h = displacement_gradient(&u, &g);
            let linear = times(&linear_strain_matrix(&g), &u);
            let nonlinear = times(&nonlinear_strain_matrix(&h, &g), &u);
            let sum = linear + 0.5 * nonlinear;
            prop_assert!((sum - strain(&u, &g)).amax() <= 1e-13);
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
            let step = 1e-2;
            let at = |s: f64| {
                let moved = std::array::from_fn(|i| std::array::from_fn(|a| u[i][a] + s * du[i][a]));
                strain(&moved, &g)
            };
            let difference = (at(step) - at(-step)) / (2.0 * step);
            prop_assert!((linear + nonlinear - difference).amax() <= 1e-11);
        }

        #[test]
        fn strain_and_right_cauchy_green_agree(u in nodal(0.5), jitter in nodal(0.2)) {
            let g = gradients(&jitter);
            let c = right_cauchy_green(&deformation_gradient(&u, &g));
            let e = green_lagrange(&displacement_gradient(&u, &g));
            prop_assert!((c - (2.0 * e + IDENTITY)).amax() <= 1e-13);
        }

        #[test]
        fn gradients_undo_the_jacobian(jitter in nodal(0.2)) {
            let corners = corners(&jitter);
            let (gradients, det) = reference_gradients::<Hex8, 8>(&corners, &POINT);
            let map = jacobian::<Hex8, 8>(&corners, &POINT);
            prop_assert!((det - map.determinant()).abs() < 1e-13);
            // dN/dX dX/dxi = dN/dxi.
            let derivatives = Hex8::shape_derivatives(&POINT);
            for a in 0..8 {
                let found = map.tr_mul(&Vector3::new(gradients[0][a], gradients[1][a], gradients[2][a]));
                for j in 0..3 {
                    prop_assert!((found[j] - derivatives[j][a]).abs() < 1e-11);
                }
            }
        }
    }
}
