//! Solid elements with a hyperelastic material.

use hyperelastic::{Material, cauchy, right_cauchy_green, von_mises};
use nalgebra::Matrix3;
use rayon::prelude::*;

use super::dilatation::{Dilatation, modes};
use super::entries::{self, Plane, Space};
use super::kernel::{self, Inversion};
use super::matrix::Matrix;
use super::projection::{Points, Workspace};
use super::{Block, ElementState, plane_kernel, projected_kernel, tangent_len};
use crate::element::{Element, corner_points, jacobian, reference_gradients};
use crate::error::{FeError, check_length};
use crate::mesh::{CellBlock, Mesh, ValidMesh};
use crate::parallel::{ELEMENTS_PER_TASK, sequential};
use crate::symmetry::Symmetry;

/// Elements `E` of one mesh block with the material `M`, in total Lagrangian form: in space, in plane strain, or
/// axisymmetric, as the mesh says.
///
/// Gradients of the shape functions and weights are computed once; the memory is about 1.8 kB for a
/// hexahedron.
#[derive(Debug, Clone)]
pub struct SolidBlock<E: Element, M: Material> {
    name: String,
    symmetry: Symmetry,
    dof_count: usize,
    connectivity: Vec<u32>,
    material: M,
    density: f64,
    corners: Vec<[E::Nodal; 3]>,
    gradients: Vec<[E::Nodal; 3]>,
    /// Reference volume of each quadrature point \[m^3\]; of one metre of thickness in plane strain, of the ring if
    /// axisymmetric.
    volumes: Vec<f64>,
    dilatation: Dilatation,
    /// Of the projected dilatation, `[point][function]`; else empty.
    modes: Vec<f64>,
}

/// An element that failed.
#[derive(Debug, Clone, Copy)]
struct Failure {
    element: usize,
    inversion: Inversion,
}

impl<E: Element, M: Material> SolidBlock<E, M> {
    /// Unknowns per node.
    const DIM: usize = E::KIND.dim();

    /// The elements of `mesh.blocks[block_index]` with a material and a density \[kg/m^3\].
    ///
    /// # Errors
    /// [`FeError::Index`] if there is no such block, [`FeError::CellKind`] if its cells are not `E`,
    /// [`FeError::Parameter`] unless the density is positive and finite.
    pub fn new<const N: usize>(
        mesh: &ValidMesh,
        block_index: usize,
        material: M,
        density: f64,
    ) -> Result<Self, FeError>
    where
        E: Element<Nodal = [f64; N]>,
    {
        let block = cell_block(mesh, block_index)?;
        check_kind::<E>(block)?;
        check_density(&block.name, density)?;
        let points = block.cell_count() * E::POINTS;
        let mut gradients = Vec::with_capacity(points);
        let mut volumes = Vec::with_capacity(points);
        let mut corners = Vec::with_capacity(block.cell_count());
        for cell in block.iter() {
            let x = corner_points::<N>(&mesh.points, cell);
            for point in E::rule() {
                let (mut gradient, det_j) = reference_gradients::<E, N>(&x, &point.xi);
                let radius = first_coordinate::<E, N>(&x, &point.xi);
                if mesh.symmetry == Symmetry::Axisymmetric {
                    gradient[2] = E::shape(&point.xi).map(|n| n / radius);
                }
                gradients.push(gradient);
                volumes.push(point.weight * det_j * mesh.symmetry.extent(radius));
            }
            corners.push([0, 1, 2].map(|i| x.map(|x| x[i])));
        }
        Ok(SolidBlock {
            name: block.name.clone(),
            symmetry: mesh.symmetry,
            dof_count: Self::DIM * mesh.points.len(),
            connectivity: block.cells.clone(),
            material,
            density,
            corners,
            gradients,
            volumes,
            dilatation: Dilatation::Pointwise,
            modes: Vec::new(),
        })
    }

    /// The same elements with another dilatation; a new block has [`Dilatation::Pointwise`].
    ///
    /// # Errors
    /// [`FeError::Unprojectable`] for elements that have no more quadrature points than functions to project on.
    pub fn with_dilatation<const N: usize>(
        mut self,
        dilatation: Dilatation,
    ) -> Result<Self, FeError>
    where
        E: Element<Nodal = [f64; N]>,
    {
        self.dilatation = dilatation;
        self.modes.clear();
        if dilatation == Dilatation::Projected {
            if E::POINTS <= E::DILATATION_MODES {
                return Err(FeError::Unprojectable {
                    block: self.name,
                    kind: E::KIND,
                });
            }
            let cells = self.corners.iter().zip(self.volumes.chunks(E::POINTS));
            let modes = cells.flat_map(|(corners, volumes)| modes::<E, N>(corners, volumes));
            self.modes.extend(modes);
        }
        Ok(self)
    }

    /// The change of volume that the law sees.
    pub fn dilatation(&self) -> Dilatation {
        self.dilatation
    }

    /// The material.
    pub fn material(&self) -> &M {
        &self.material
    }

    /// Density in the reference configuration \[kg/m^3\].
    pub fn density(&self) -> f64 {
        self.density
    }

    fn cell(&self, element: usize) -> &[u32] {
        &self.connectivity[element * E::NODES..(element + 1) * E::NODES]
    }

    fn points_of(&self, element: usize) -> std::ops::Range<usize> {
        element * E::POINTS..(element + 1) * E::POINTS
    }

    fn report(&self, failure: Option<Failure>) -> Result<(), FeError> {
        match failure {
            None => Ok(()),
            Some(Failure { element, inversion }) => Err(FeError::Inverted {
                block: self.name.clone(),
                element,
                point: inversion.point,
                det_f: inversion.det_f,
            }),
        }
    }
}

impl<E, M, const N: usize> SolidBlock<E, M>
where
    E: Element<Nodal = [f64; N]>,
    M: Material,
{
    /// Displacements of an element's nodes \[m\], stored `[i][a]`; the third row is zero in the plane.
    #[inline(always)]
    fn displacements(&self, element: usize, u: &[f64]) -> [[f64; N]; 3] {
        let mut local = [[0.0; N]; 3];
        for (a, &node) in self.cell(element).iter().enumerate() {
            let start = Self::DIM * node as usize;
            let u = &u[start..start + Self::DIM];
            (0..Self::DIM).for_each(|i| local[i][a] = u[i]);
        }
        local
    }

    #[inline(always)]
    fn quadrature(&self, element: usize) -> Points<'_, N> {
        let points = self.points_of(element);
        let modes = match self.dilatation {
            Dilatation::Pointwise => 0..0,
            Dilatation::Projected => {
                E::DILATATION_MODES * points.start..E::DILATATION_MODES * points.end
            }
        };
        Points {
            gradients: &self.gradients[points.clone()],
            volumes: &self.volumes[points],
            modes: &self.modes[modes],
        }
    }

    /// Forces of consecutive elements, up to the first that fails.
    fn force_range(
        &self,
        u: &[f64],
        first: usize,
        forces: &mut [f64],
        energies: &mut [f64],
    ) -> Option<Failure> {
        let mut local = [[0.0; N]; 3];
        let mut work = Workspace::new();
        let slices = forces.chunks_exact_mut(Self::DIM * N).zip(energies);
        for (element, (force, energy)) in (first..).zip(slices) {
            let (m, u, p) = (
                &self.material,
                &self.displacements(element, u),
                self.quadrature(element),
            );
            let (f, work) = (&mut local, &mut work);
            let result = match (self.dilatation, Self::DIM) {
                (Dilatation::Pointwise, 2) => {
                    entries::internal_force::<Plane, M, 5, N>(m, u, p.gradients, p.volumes, f)
                }
                (Dilatation::Pointwise, _) => {
                    entries::internal_force::<Space, M, 9, N>(m, u, p.gradients, p.volumes, f)
                }
                (Dilatation::Projected, 2) => {
                    projected_kernel::internal_force::<Plane, M, 5, N>(m, u, p, work, f)
                }
                (Dilatation::Projected, _) => {
                    projected_kernel::internal_force::<Space, M, 9, N>(m, u, p, work, f)
                }
            };
            match result {
                Ok(w) => *energy = w,
                Err(inversion) => return Some(Failure { element, inversion }),
            }
            store(Self::DIM, &local, force);
        }
        None
    }

    /// Tangents of consecutive elements, up to the first that fails.
    fn tangent_range(
        &self,
        u: &[f64],
        first: usize,
        forces: &mut [f64],
        energies: &mut [f64],
        tangents: &mut [f64],
    ) -> Option<Failure> {
        let mut local = [[0.0; N]; 3];
        let mut products = kernel::no_products::<N>();
        let mut work = Workspace::new();
        let slices = forces
            .chunks_exact_mut(Self::DIM * N)
            .zip(energies)
            .zip(tangents.chunks_exact_mut(tangent_len(Self::DIM, N)));
        for (element, ((force, energy), k)) in (first..).zip(slices) {
            let (m, u, p) = (
                &self.material,
                &self.displacements(element, u),
                self.quadrature(element),
            );
            let (f, work, products) = (&mut local, &mut work, &mut products);
            let result = match (self.dilatation, Self::DIM) {
                (Dilatation::Pointwise, 2) => {
                    plane_kernel::tangent(m, u, p.gradients, p.volumes, f, k)
                }
                (Dilatation::Pointwise, _) => {
                    kernel::tangent(m, u, p.gradients, p.volumes, f, products, k)
                }
                (Dilatation::Projected, 2) => projected_kernel::plane_tangent(m, u, p, work, f, k),
                (Dilatation::Projected, _) => {
                    projected_kernel::tangent(m, u, p, work, f, products, k)
                }
            };
            match result {
                Ok(w) => *energy = w,
                Err(inversion) => return Some(Failure { element, inversion }),
            }
            store(Self::DIM, &local, force);
        }
        None
    }

    /// Deformation gradient that the law sees, and its determinant, at each point of an element.
    fn deformations(&self, element: usize, u: &[f64]) -> Result<Vec<(Matrix, f64)>, Inversion> {
        let (u, points) = (self.displacements(element, u), self.quadrature(element));
        if self.dilatation == Dilatation::Projected {
            let mut work = Workspace::new();
            if Self::DIM == 2 {
                work.deform::<Plane, 5>(&u, points)?;
            } else {
                work.deform::<Space, 9>(&u, points)?;
            }
            return Ok(work.deformations().collect());
        }
        let deform = if Self::DIM == 2 {
            plane_kernel::deform
        } else {
            kernel::deform
        };
        let gradients = points.gradients.iter().enumerate();
        gradients.map(|(point, g)| deform(&u, g, point)).collect()
    }

    fn state(&self, element: usize, u: &[f64]) -> Result<ElementState, Failure> {
        let fail = |inversion| Failure { element, inversion };
        let mut state = ElementState {
            det_f_min: f64::INFINITY,
            det_f_max: f64::NEG_INFINITY,
            ..ElementState::default()
        };
        let mut volume = 0.0;
        let deformations = self.deformations(element, u).map_err(fail)?;
        for (point, (f, det_f)) in deformations.into_iter().enumerate() {
            let f = Matrix3::from_fn(|i, j| f[i][j]);
            let stress = self.material.stress(&right_cauchy_green(&f));
            let (_, s) = stress.map_err(|_| fail(Inversion { point, det_f }))?;
            let current = det_f * self.volumes[element * E::POINTS + point];
            state.cauchy += cauchy(&f, &s) * current;
            volume += current;
            state.det_f_min = state.det_f_min.min(det_f);
            state.det_f_max = state.det_f_max.max(det_f);
        }
        state.cauchy /= volume;
        state.von_mises = von_mises(&state.cauchy);
        Ok(state)
    }
}

impl<E, M, const N: usize> Block for SolidBlock<E, M>
where
    E: Element<Nodal = [f64; N]>,
    M: Material,
{
    fn name(&self) -> &str {
        &self.name
    }

    fn symmetry(&self) -> Symmetry {
        self.symmetry
    }

    fn element_count(&self) -> usize {
        self.corners.len()
    }

    fn nodes_per_element(&self) -> usize {
        N
    }

    fn degree(&self) -> usize {
        E::KIND.degree()
    }

    fn connectivity(&self) -> &[u32] {
        &self.connectivity
    }

    fn internal_force(
        &self,
        u: &[f64],
        forces: &mut [f64],
        energies: &mut [f64],
    ) -> Result<(), FeError> {
        let count = self.element_count();
        check_length("displacement", self.dof_count, u.len())?;
        check_length("element forces", Self::DIM * N * count, forces.len())?;
        check_length("element energies", count, energies.len())?;
        if sequential(count, ELEMENTS_PER_TASK) {
            return self.report(self.force_range(u, 0, forces, energies));
        }
        let failures = forces
            .par_chunks_mut(Self::DIM * N * ELEMENTS_PER_TASK)
            .zip(energies.par_chunks_mut(ELEMENTS_PER_TASK))
            .enumerate()
            .filter_map(|(task, (f, w))| self.force_range(u, task * ELEMENTS_PER_TASK, f, w));
        self.report(failures.min_by_key(|failure| failure.element))
    }

    fn tangent(
        &self,
        u: &[f64],
        forces: &mut [f64],
        energies: &mut [f64],
        tangents: &mut [f64],
    ) -> Result<(), FeError> {
        let (count, len) = (self.element_count(), tangent_len(Self::DIM, N));
        check_length("displacement", self.dof_count, u.len())?;
        check_length("element forces", Self::DIM * N * count, forces.len())?;
        check_length("element energies", count, energies.len())?;
        check_length("element tangents", len * count, tangents.len())?;
        if sequential(count, ELEMENTS_PER_TASK) {
            return self.report(self.tangent_range(u, 0, forces, energies, tangents));
        }
        let failures = forces
            .par_chunks_mut(Self::DIM * N * ELEMENTS_PER_TASK)
            .zip(energies.par_chunks_mut(ELEMENTS_PER_TASK))
            .zip(tangents.par_chunks_mut(len * ELEMENTS_PER_TASK))
            .enumerate()
            .filter_map(|(task, ((f, w), k))| {
                self.tangent_range(u, task * ELEMENTS_PER_TASK, f, w, k)
            });
        self.report(failures.min_by_key(|failure| failure.element))
    }

    fn mass(&self, masses: &mut [f64]) {
        for (corners, mass) in self.corners.iter().zip(masses.chunks_exact_mut(N * N)) {
            let x = std::array::from_fn(|a| [corners[0][a], corners[1][a], corners[2][a]]);
            mass.fill(0.0);
            for point in E::mass_rule() {
                let det_j = jacobian::<E, N>(&x, &point.xi).determinant();
                let shape = E::shape(&point.xi);
                let extent = self
                    .symmetry
                    .extent(first_coordinate::<E, N>(&x, &point.xi));
                let m = self.density * point.weight * det_j * extent;
                for a in 0..N {
                    for b in 0..N {
                        mass[N * a + b] += m * shape[a] * shape[b];
                    }
                }
            }
        }
    }

    fn stress_state(&self, u: &[f64], states: &mut [ElementState]) -> Result<(), FeError> {
        check_length("displacement", self.dof_count, u.len())?;
        check_length("element states", self.element_count(), states.len())?;
        let failures = states
            .par_iter_mut()
            .enumerate()
            .filter_map(|(element, state)| match self.state(element, u) {
                Ok(found) => {
                    *state = found;
                    None
                }
                Err(failure) => Some(failure),
            });
        self.report(failures.min_by_key(|failure| failure.element))
    }
}

/// Writes forces `[i][a]` in the order of the unknowns.
#[inline(always)]
fn store<const N: usize>(dim: usize, local: &[[f64; N]; 3], force: &mut [f64]) {
    for (a, force) in force.chunks_exact_mut(dim).enumerate() {
        (0..dim).for_each(|i| force[i] = local[i][a]);
    }
}

/// X of a point of an element \[m\]: the radius if axisymmetric.
fn first_coordinate<E, const N: usize>(x: &[[f64; 3]; N], xi: &[f64; 3]) -> f64
where
    E: Element<Nodal = [f64; N]>,
{
    x.iter().zip(E::shape(xi)).map(|(x, n)| n * x[0]).sum()
}

pub(super) fn cell_block(mesh: &Mesh, block_index: usize) -> Result<&CellBlock, FeError> {
    mesh.blocks.get(block_index).ok_or(FeError::Index {
        what: "block",
        index: block_index,
        count: mesh.blocks.len(),
    })
}

fn check_kind<E: Element>(block: &CellBlock) -> Result<(), FeError> {
    if block.kind == E::KIND {
        return Ok(());
    }
    Err(FeError::CellKind {
        block: block.name.clone(),
        expected: E::KIND,
        actual: block.kind,
    })
}

fn check_density(block: &str, density: f64) -> Result<(), FeError> {
    if density > 0.0 && density.is_finite() {
        return Ok(());
    }
    Err(FeError::Parameter {
        place: format!("block `{block}`"),
        what: "density [kg/m^3]",
        value: density,
        bound: "must be positive and finite",
    })
}
