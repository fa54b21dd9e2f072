//! What space and the plane do not share: the entries of `F` that can change, and the loops that know them; and the
//! nodal forces, which are the same in both.

use hyperelastic::{Material, Symmetric};

use super::kernel::{self, Gradients, Inversion};
use super::matrix::{Matrix, right_cauchy_green};
use super::plane_kernel;

/// Component of the displacement that an entry of `F` belongs to, its row and its column. The gradients that belong to
/// an entry are the row of its column.
pub(super) type Entry = (usize, usize, usize);

/// Entries of `F` that can change.
pub(super) trait Entries<const K: usize> {
    const LIST: [Entry; K];

    /// Deformation at a point, checked.
    fn deform<const N: usize>(
        u: &[[f64; N]; 3],
        gradients: &Gradients<N>,
        point: usize,
    ) -> Result<(Matrix, f64), Inversion>;

    /// Adds `volume F S dN/dX` to the nodal forces.
    fn add_force<const N: usize>(
        f: &Matrix,
        s: &Symmetric,
        volume: f64,
        gradients: &Gradients<N>,
        forces: &mut [[f64; N]; 3],
    );
}

/// All nine.
#[derive(Debug)]
pub(super) struct Space;

/// Those of [`plane_kernel`].
#[derive(Debug)]
pub(super) struct Plane;

impl Entries<9> for Space {
    const LIST: [Entry; 9] = [
        (0, 0, 0),
        (0, 0, 1),
        (0, 0, 2),
        (1, 1, 0),
        (1, 1, 1),
        (1, 1, 2),
        (2, 2, 0),
        (2, 2, 1),
        (2, 2, 2),
    ];

    #[inline(always)]
    fn deform<const N: usize>(
        u: &[[f64; N]; 3],
        gradients: &Gradients<N>,
        point: usize,
    ) -> Result<(Matrix, f64), Inversion> {
        kernel::deform(u, gradients, point)
    }

    #[inline(always)]
    fn add_force<const N: usize>(
        f: &Matrix,
        s: &Symmetric,
        volume: f64,
        gradients: &Gradients<N>,
        forces: &mut [[f64; N]; 3],
    ) {
        kernel::add_force(f, s, volume, gradients, forces);
    }
}

impl Entries<5> for Plane {
    const LIST: [Entry; 5] = [(0, 0, 0), (0, 0, 1), (0, 2, 2), (1, 1, 0), (1, 1, 1)];

    #[inline(always)]
    fn deform<const N: usize>(
        u: &[[f64; N]; 3],
        gradients: &Gradients<N>,
        point: usize,
    ) -> Result<(Matrix, f64), Inversion> {
        plane_kernel::deform(u, gradients, point)
    }

    #[inline(always)]
    fn add_force<const N: usize>(
        f: &Matrix,
        s: &Symmetric,
        volume: f64,
        gradients: &Gradients<N>,
        forces: &mut [[f64; N]; 3],
    ) {
        plane_kernel::add_force(f, s, volume, gradients, forces);
    }
}

/// Strain energy \[J\] and nodal forces \[N\], which are stored `[i][a]`; in the plane the third row stays zero.
#[inline(always)]
pub(super) fn internal_force<L: Entries<K>, M: Material, const K: usize, const N: usize>(
    material: &M,
    u: &[[f64; N]; 3],
    gradients: &[Gradients<N>],
    volumes: &[f64],
    forces: &mut [[f64; N]; 3],
) -> Result<f64, Inversion> {
    let mut energy = 0.0;
    *forces = [[0.0; N]; 3];
    for (point, (gradients, &volume)) in gradients.iter().zip(volumes).enumerate() {
        let (f, det_f) = L::deform(u, gradients, point)?;
        let Ok((w, s)) = material.stress(&right_cauchy_green(&f)) else {
            return Err(Inversion { point, det_f });
        };
        energy += volume * w;
        L::add_force(&f, &s, volume, gradients, forces);
    }
    Ok(energy)
}
