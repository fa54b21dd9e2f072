//! Deformation of the quadrature points of an element with projected dilatation, see [`super::projected_kernel`].

use hyperelastic::{Symmetric, Tangent};

use super::entries::Entries;
use super::kernel::{Gradients, Inversion};
use super::matrix::Matrix;

/// Most functions of an element's projected dilatation: 1, X, Y, Z.
pub(super) const MODES: usize = 4;

/// What an element knows of its quadrature points.
#[derive(Debug, Clone, Copy)]
pub(super) struct Points<'a, const N: usize> {
    pub(super) gradients: &'a [Gradients<N>],
    pub(super) volumes: &'a [f64],
    /// Orthonormal functions of the dilatation, `[point][function]`; none if it is pointwise.
    pub(super) modes: &'a [f64],
}

impl<const N: usize> Points<'_, N> {
    #[inline(always)]
    pub(super) fn modes_at(&self, point: usize) -> &[f64] {
        let count = self.modes.len() / self.volumes.len();
        &self.modes[point * count..(point + 1) * count]
    }
}

/// Deformation of a point.
#[derive(Debug, Clone, Copy)]
pub(super) struct Deformed {
    pub(super) f: Matrix,
    pub(super) cofactor: Matrix,
    pub(super) det_f: f64,
    /// Projected `det F`.
    pub(super) theta: f64,
}

impl Deformed {
    pub(super) fn scale(&self) -> f64 {
        (self.theta / self.det_f).cbrt()
    }

    pub(super) fn failed(&self, point: usize) -> Inversion {
        Inversion {
            point,
            det_f: self.theta,
        }
    }

    pub(super) fn f_bar(&self) -> Matrix {
        let scale = self.scale();
        self.f.map(|row| row.map(|f| scale * f))
    }
}

/// Scratch of an element.
#[derive(Debug)]
pub(super) struct Workspace<const N: usize> {
    pub(super) points: Vec<Deformed>,
    /// Energy and stress at `Cbar`.
    pub(super) stresses: Vec<(f64, Symmetric)>,
    /// `dS/dE` at `Cbar`.
    pub(super) moduli: Vec<Tangent>,
    /// Derivatives of the amplitudes of the dilatation with respect to the displacements.
    pub(super) rates: [Gradients<N>; MODES],
}

impl<const N: usize> Workspace<N> {
    pub(super) fn new() -> Self {
        Workspace {
            points: Vec::new(),
            stresses: Vec::new(),
            moduli: Vec::new(),
            rates: [[[0.0; N]; 3]; MODES],
        }
    }

    /// `Fbar` and its determinant at each point.
    pub(super) fn deformations(&self) -> impl Iterator<Item = (Matrix, f64)> {
        self.points.iter().map(|point| (point.f_bar(), point.theta))
    }

    /// Deformation of all points, and the rates.
    #[inline(never)]
    pub(super) fn deform<L: Entries<K>, const K: usize>(
        &mut self,
        u: &[[f64; N]; 3],
        element: Points<'_, N>,
    ) -> Result<(), Inversion> {
        self.points.clear();
        self.rates = [[[0.0; N]; 3]; MODES];
        let mut amplitudes = [0.0; MODES];
        for (point, (gradients, &volume)) in
            element.gradients.iter().zip(element.volumes).enumerate()
        {
            let (f, det_f) = L::deform(u, gradients, point)?;
            let cofactor = cofactor(&f);
            for (i, b) in element.modes_at(point).iter().enumerate() {
                amplitudes[i] += volume * b * det_f;
                let rate = L::LIST.map(|(_, i, j)| volume * b * cofactor[i][j]);
                add_stress::<L, K, N>(&rate, gradients, &mut self.rates[i]);
            }
            self.points.push(Deformed {
                f,
                cofactor,
                det_f,
                theta: 0.0,
            });
        }
        for (point, at) in self.points.iter_mut().enumerate() {
            let modes = element.modes_at(point).iter().zip(&amplitudes);
            at.theta = modes.map(|(b, amplitude)| b * amplitude).sum();
            // Linear functions can be negative where no J is.
            if at.theta <= 0.0 {
                return Err(at.failed(point));
            }
        }
        Ok(())
    }
}

#[inline(always)]
fn cofactor(f: &Matrix) -> Matrix {
    let mut cofactor = [[0.0; 3]; 3];
    for i in 0..3 {
        for j in 0..3 {
            // Cyclic indices give the cofactor its sign.
            let (r, s, p, q) = ((i + 1) % 3, (i + 2) % 3, (j + 1) % 3, (j + 2) % 3);
            cofactor[i][j] = f[r][p] * f[s][q] - f[r][q] * f[s][p];
        }
    }
    cofactor
}

/// Adds `P dN/dX` to nodal forces.
#[inline(always)]
pub(super) fn add_stress<L: Entries<K>, const K: usize, const N: usize>(
    p: &[f64; K],
    gradients: &Gradients<N>,
    forces: &mut [[f64; N]; 3],
) {
    for (p, (component, _, j)) in p.iter().zip(L::LIST) {
        for a in 0..N {
            forces[component][a] = p.mul_add(gradients[j][a], forces[component][a]);
        }
    }
}
