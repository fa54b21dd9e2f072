//! Blocks: elements of one kind with one material, seen through an object-safe trait.

mod dilatation;
mod entries;
mod kernel;
mod matrix;
mod plane_kernel;
mod projected_kernel;
mod projection;
mod solid_block;

use std::fmt::Debug;

use hyperelastic::{Material, Symmetric};

use crate::element::{Element, ElementVisitor};
use crate::error::FeError;
use crate::mesh::ValidMesh;
use crate::symmetry::Symmetry;

pub use dilatation::Dilatation;
pub use solid_block::SolidBlock;

/// Stress and volume change of one element.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
#[non_exhaustive]
pub struct ElementState {
    /// Cauchy stress averaged over the current volume \[Pa\]: 11 22 33 12 13 23. In the plane 33 is the stress
    /// across it: along z, or the hoop stress.
    pub cauchy: Symmetric,
    /// Von Mises stress of the averaged tensor \[Pa\].
    pub von_mises: f64,
    /// Smallest `J = det F` of the quadrature points \[-\].
    pub det_f_min: f64,
    /// Largest `J = det F` of the quadrature points \[-\].
    pub det_f_max: f64,
}

/// A set of elements that adds force, stiffness and mass to a solid.
///
/// One virtual call serves all elements; each element writes its own slice of the buffers, so that the order
/// of sums does not depend on threads. With `d` unknowns a node and `n` nodes an element:
/// - forces: `d n` entries an element, `d a + i`;
/// - tangents: [`tangent_len`] entries an element, see [`tangent_index`];
/// - masses: `n n` entries an element, `n a + b`.
///
/// Units are those of space; plane strain means one metre of thickness, see [`Symmetry`].
///
/// On an error the buffers hold no meaning. A displacement or a buffer of a wrong length is
/// [`FeError::Length`].
pub trait Block: Debug + Send + Sync {
    /// Name, for errors.
    fn name(&self) -> &str;
    /// What the elements stand for: space, plane strain, or rings.
    fn symmetry(&self) -> Symmetry;
    /// Unknowns per node.
    fn dim(&self) -> usize {
        self.symmetry().dim()
    }
    /// Number of elements.
    fn element_count(&self) -> usize;
    /// Nodes of an element.
    fn nodes_per_element(&self) -> usize;
    /// Degree of the shape functions, 1 or 2.
    fn degree(&self) -> usize {
        1
    }
    /// Node indices, element after element.
    fn connectivity(&self) -> &[u32];

    /// Nodal forces \[N\] and strain energies \[J\] of each element for the displacement `u` \[m\].
    ///
    /// # Errors
    /// [`FeError::Inverted`] for the lowest element where `det F` is not positive and finite.
    fn internal_force(
        &self,
        u: &[f64],
        forces: &mut [f64],
        energies: &mut [f64],
    ) -> Result<(), FeError>;

    /// The same, and the derivative of the forces \[N/m\].
    ///
    /// # Errors
    /// [`FeError::Inverted`] for the lowest element where `det F` is not positive and finite.
    fn tangent(
        &self,
        u: &[f64],
        forces: &mut [f64],
        energies: &mut [f64],
        tangents: &mut [f64],
    ) -> Result<(), FeError>;

    /// Integrals of density times products of shape functions \[kg\], the same for each component.
    fn mass(&self, masses: &mut [f64]);

    /// Stress and volume change of each element for the displacement `u` \[m\].
    ///
    /// # Errors
    /// [`FeError::Inverted`] for the lowest element where `det F` is not positive and finite.
    fn stress_state(&self, u: &[f64], states: &mut [ElementState]) -> Result<(), FeError>;
}

/// Length of an element's tangent: one `n x n` block for each pair of components `i <= k`.
#[must_use]
pub const fn tangent_len(dim: usize, nodes: usize) -> usize {
    dim * (dim + 1) / 2 * nodes * nodes
}

/// Where the derivative of force `(a, i)` with respect to displacement `(b, k)` is stored: blocks (0,0) (0,1)
/// (0,2) (1,1) (1,2) (2,2) of components, each `n a + b`. Entries with `i > k` are read from their mirror image.
#[must_use]
pub const fn tangent_index(
    dim: usize,
    nodes: usize,
    (a, i): (usize, usize),
    (b, k): (usize, usize),
) -> usize {
    let (a, i, b, k) = if i <= k { (a, i, b, k) } else { (b, k, a, i) };
    let pair = i * dim - i * (i + 1) / 2 + k;
    (pair * nodes + a) * nodes + b
}

/// The block for a mesh block's kind of cells: [`SolidBlock`] with the right element, [`Dilatation::Pointwise`].
///
/// `density` \[kg/m^3\].
///
/// # Errors
/// As [`SolidBlock::new`].
pub fn solid_block<M: Material>(
    mesh: &ValidMesh,
    block_index: usize,
    material: M,
    density: f64,
) -> Result<Box<dyn Block>, FeError> {
    solid_block_with(mesh, block_index, material, density, Dilatation::Pointwise)
}

/// The same with a choice of the dilatation.
///
/// `density` \[kg/m^3\].
///
/// # Errors
/// As [`SolidBlock::new`] and [`SolidBlock::with_dilatation`].
pub fn solid_block_with<M: Material>(
    mesh: &ValidMesh,
    block_index: usize,
    material: M,
    density: f64,
    dilatation: Dilatation,
) -> Result<Box<dyn Block>, FeError> {
    let kind = solid_block::cell_block(mesh, block_index)?.kind;
    kind.with_element(NewBlock {
        mesh,
        block_index,
        material,
        density,
        dilatation,
    })
}

/// A block to be made, whatever its element.
struct NewBlock<'a, M> {
    mesh: &'a ValidMesh,
    block_index: usize,
    material: M,
    density: f64,
    dilatation: Dilatation,
}

impl<M: Material> ElementVisitor for NewBlock<'_, M> {
    type Output = Result<Box<dyn Block>, FeError>;

    fn visit<E: Element<Nodal = [f64; N]>, const N: usize>(self) -> Self::Output {
        let block =
            SolidBlock::<E, M>::new(self.mesh, self.block_index, self.material, self.density)?;
        Ok(Box::new(block.with_dilatation(self.dilatation)?))
    }
}
