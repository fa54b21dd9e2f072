//! The change of volume that the law of an element sees.

use crate::element::Element;

/// The change of volume that the law of an element sees.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Dilatation {
    /// `J = det F` of each quadrature point. As `nu -> 1/2` each point demands `J = 1`, which is more than the
    /// displacements of most elements can satisfy: they lock.
    #[default]
    Pointwise,
    /// `J` of each point replaced by its projection onto few functions over the element, by
    /// [`crate::Element::DILATATION_MODES`] (the mean over the element for linear elements). Does not lock, and is as
    /// good as the other one for compressible matter. The energy is that of `Fbar = (Jbar/J)^(1/3) F`, so forces have a
    /// potential and the tangent is symmetric.
    Projected,
}

/// The first functions of 1, X, Y, Z at the quadrature points of one cell, made orthonormal under the weights `volumes`
/// \[m^3\]; `[point][function]` \[m^-3/2\]. `corners` are the coordinates of the nodes, `[i][a]` \[m\].
///
/// Coordinates of space, not of the reference cell: a linear field is then its own projection on distorted cells too.
pub(super) fn modes<E, const N: usize>(corners: &[[f64; N]; 3], volumes: &[f64]) -> Vec<f64>
where
    E: Element<Nodal = [f64; N]>,
{
    let count = E::DILATATION_MODES;
    let mut modes = vec![1.0; count * volumes.len()];
    for (row, point) in modes.chunks_exact_mut(count).zip(E::rule()) {
        let shape = E::shape(&point.xi);
        for (value, x) in row.iter_mut().skip(1).zip(corners) {
            // Distances from a node, so that a cell far from the origin loses no digits.
            *value = x.iter().zip(&shape).map(|(at, n)| n * (at - x[0])).sum();
        }
    }
    for i in 0..count {
        for j in 0..i {
            let along = product(&modes, volumes, [i, j]);
            let rows = modes.chunks_exact_mut(count);
            rows.for_each(|row| row[i] -= along * row[j]);
        }
        let length = product(&modes, volumes, [i, i]).sqrt();
        let column = modes.iter_mut().skip(i).step_by(count);
        column.for_each(|value| *value /= length);
    }
    modes
}

fn product(modes: &[f64], volumes: &[f64], [i, j]: [usize; 2]) -> f64 {
    let rows = modes.chunks_exact(modes.len() / volumes.len());
    rows.zip(volumes)
        .map(|(row, volume)| volume * row[i] * row[j])
        .sum()
}
