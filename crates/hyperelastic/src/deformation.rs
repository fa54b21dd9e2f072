//! From the deformation gradient `F` to `C`, and from `S` to the stresses that can be measured.

use nalgebra::Matrix3;

use crate::tensor::{self, Symmetric};

/// Right Cauchy-Green tensor `C = F^T F` \[-\].
#[must_use]
#[inline(always)]
pub fn right_cauchy_green(f: &Matrix3<f64>) -> Symmetric {
    let columns = &f.data.0;
    let entry = |(i, j): (usize, usize)| {
        let (a, b) = (&columns[i], &columns[j]);
        a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
    };
    Symmetric::from(tensor::COMPONENTS.map(entry))
}

/// First Piola-Kirchhoff stress `P = F S` \[Pa\]: `P_ij` is the force `i` per reference area on the face with normal
/// `j`.
#[must_use]
#[inline]
pub fn first_piola(f: &Matrix3<f64>, s: &Symmetric) -> Matrix3<f64> {
    f * tensor::to_matrix(s)
}

/// Cauchy stress `sigma = F S F^T/J` \[Pa\]: force per deformed area \[Hu2022, eq. 40\], \[Feng2007, eq. 21\].
#[must_use]
#[inline]
pub fn cauchy(f: &Matrix3<f64>, s: &Symmetric) -> Symmetric {
    tensor::from_matrix(&(first_piola(f, s) * f.transpose())) / f.determinant()
}

/// Von Mises stress \[Pa\] of a stress tensor \[Pa\].
#[must_use]
pub fn von_mises(s: &Symmetric) -> f64 {
    let normal = (s[0] - s[1]).powi(2) + (s[1] - s[2]).powi(2) + (s[2] - s[0]).powi(2);
    let shear = s[3] * s[3] + s[4] * s[4] + s[5] * s[5];
    (0.5 * normal + 3.0 * shear).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn von_mises_of_tension_shear_and_pressure() {
        assert_eq!(
            von_mises(&Symmetric::new(2.0, 0.0, 0.0, 0.0, 0.0, 0.0)),
            2.0
        );
        assert_eq!(
            von_mises(&Symmetric::new(5.0, 5.0, 5.0, 0.0, 0.0, 0.0)),
            0.0
        );
        let sheared = von_mises(&Symmetric::new(0.0, 0.0, 0.0, 0.0, 1.0, 0.0));
        assert!((sheared - 3.0_f64.sqrt()).abs() < 1e-15);
    }

    #[test]
    fn cauchy_stress_of_a_stretched_and_turned_bar() {
        // Stretched by 2 along x, then turned by a quarter about z: S_11 becomes 2^2 S_11 / J along y.
        let f = Matrix3::new(0.0, -1.0, 0.0, 2.0, 0.0, 0.0, 0.0, 0.0, 1.0);
        let sigma = cauchy(&f, &Symmetric::new(3.0, 0.0, 0.0, 0.0, 0.0, 0.0));
        assert_eq!(sigma, Symmetric::new(0.0, 6.0, 0.0, 0.0, 0.0, 0.0));
    }
}
