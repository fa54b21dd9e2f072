//! Polynomials of second degree that the quadratic elements share.

/// Polynomial that is one at the node `c` of -1, 0, 1 and zero at the others \[-\].
pub(crate) fn line(c: f64, x: f64) -> f64 {
    if c == 0.0 {
        1.0 - x * x
    } else {
        0.5 * x * (x + c)
    }
}

/// Derivative of [`line`] \[-\].
pub(crate) fn line_derivative(c: f64, x: f64) -> f64 {
    if c == 0.0 { -2.0 * x } else { x + 0.5 * c }
}

/// Shape functions of a quadratic simplex at the barycentric coordinates `l` \[-\]: corners first, then the middles of
/// the edges between the corners `edges`.
pub(super) fn simplex<const C: usize, const N: usize>(l: [f64; C], edges: &[&[usize]]) -> [f64; N] {
    std::array::from_fn(|a| match a.checked_sub(C) {
        None => l[a] * (2.0 * l[a] - 1.0),
        Some(edge) => 4.0 * l[edges[edge][0]] * l[edges[edge][1]],
    })
}

/// Derivatives of [`simplex`] with respect to the last coordinates of `l`, of which the first is one less the others.
pub(super) fn simplex_derivatives<const C: usize, const N: usize>(
    l: [f64; C],
    edges: &[&[usize]],
) -> [[f64; N]; 3] {
    let slope = |corner: usize, j: usize| match corner {
        0 => -1.0,
        _ => f64::from(u8::from(corner == j + 1)),
    };
    let mut derivatives = [[0.0; N]; 3];
    for (j, row) in derivatives.iter_mut().enumerate().take(C - 1) {
        for (a, value) in row.iter_mut().enumerate() {
            *value = match a.checked_sub(C) {
                None => (4.0 * l[a] - 1.0) * slope(a, j),
                Some(edge) => {
                    let (p, q) = (edges[edge][0], edges[edge][1]);
                    4.0 * (l[q] * slope(p, j) + l[p] * slope(q, j))
                }
            };
        }
    }
    derivatives
}
