//! What [`nalgebra`] lacks for vectors of three numbers.

use nalgebra::Vector3;

/// The unit vector along `a`, `None` when `a` has no direction (zero, infinite or NaN).
///
/// Scaled first by the largest entry, so that neither tiny nor huge vectors under- or overflow.
pub(crate) fn unit(a: Vector3<f64>) -> Option<Vector3<f64>> {
    let largest = a[0].abs().max(a[1].abs()).max(a[2].abs());
    if !(largest > 0.0 && a.iter().all(|c| c.is_finite())) {
        return None;
    }
    let b = a / largest;
    Some((1.0 / b.norm()) * b)
}

/// The part of `a` perpendicular to the unit vector `n`.
pub(crate) fn reject(a: Vector3<f64>, n: Vector3<f64>) -> Vector3<f64> {
    a - a.dot(&n) * n
}

/// The part of a flat array that belongs to a node, `dim` components a node; the third is 0 in the plane.
pub(crate) fn at_node(flat: &[f64], dim: usize, node: u32) -> Vector3<f64> {
    let start = dim * node as usize;
    let mut a = Vector3::zeros();
    a.as_mut_slice()[..dim].copy_from_slice(&flat[start..start + dim]);
    a
}
