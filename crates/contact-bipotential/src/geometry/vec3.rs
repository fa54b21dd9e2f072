//! Vectors of three numbers, as plain arrays: nothing here is worth a dependency or a type.

pub(crate) type Vec3 = [f64; 3];

pub(crate) fn dot(a: Vec3, b: Vec3) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub(crate) fn sub(a: Vec3, b: Vec3) -> Vec3 {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

pub(crate) fn scale(s: f64, a: Vec3) -> Vec3 {
    [s * a[0], s * a[1], s * a[2]]
}

/// `a + s b`.
pub(crate) fn axpy(a: Vec3, s: f64, b: Vec3) -> Vec3 {
    [a[0] + s * b[0], a[1] + s * b[1], a[2] + s * b[2]]
}

pub(crate) fn cross(a: Vec3, b: Vec3) -> Vec3 {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

pub(crate) fn norm(a: Vec3) -> f64 {
    dot(a, a).sqrt()
}

/// The unit vector along `a`, `None` when `a` has no direction (zero, infinite or NaN).
///
/// Scaled first by the largest entry, so that neither tiny nor huge vectors under- or overflow.
pub(crate) fn unit(a: Vec3) -> Option<Vec3> {
    let largest = a[0].abs().max(a[1].abs()).max(a[2].abs());
    if !(largest > 0.0 && largest.is_finite() && a.iter().all(|c| c.is_finite())) {
        return None;
    }
    let b = [a[0] / largest, a[1] / largest, a[2] / largest];
    Some(scale(1.0 / norm(b), b))
}

/// The part of `a` perpendicular to the unit vector `n`.
pub(crate) fn reject(a: Vec3, n: Vec3) -> Vec3 {
    axpy(a, -dot(a, n), n)
}

/// The position of a node in a flat array of `dim` components a node; the third is 0 in the plane.
pub(crate) fn node_vector(flat: &[f64], dim: usize, node: u32) -> Vec3 {
    let start = dim * node as usize;
    let mut a = [0.0; 3];
    a[..dim].copy_from_slice(&flat[start..start + dim]);
    a
}
