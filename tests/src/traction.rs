//! Tractions in a contact, from the forces on the slave nodes.

use nscd::State;

use crate::Ran;

/// A slave node in contact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Traction {
    /// Distance in the reference state from x = 0 (x = y = 0 in space) \[m\].
    pub r: f64,
    /// Normal force over the share of the surface \[Pa\].
    pub pressure: f64,
    /// Norm of the tangential force over that share \[Pa\].
    pub friction: f64,
}

/// The pressed slave nodes of the first interface.
pub fn tractions(ran: &Ran, state: &State) -> Vec<Traction> {
    let model = &ran.built.model;
    let mesh = model.solid.mesh();
    let pressed = state
        .contacts
        .iter()
        .filter(|c| c.interface == 0 && c.force[2] > 0.0);
    let traction = |c: &nscd::ContactState| {
        let x = mesh.points[c.node as usize];
        let area = model.interfaces[0].area[c.slave_index];
        // Corners of quadratic triangles and the axis end of a quadratic edge have no share.
        (area > 0.0).then(|| Traction {
            r: if mesh.dim == 2 {
                x[0].abs()
            } else {
                x[0].hypot(x[1])
            },
            pressure: c.force[2] / area,
            friction: c.force[0].hypot(c.force[1]) / area,
        })
    };
    pressed.filter_map(traction).collect()
}

/// A distribution `peak sqrt(1 - r^2 / radius^2)`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ellipse {
    /// In the middle \[Pa\].
    pub peak: f64,
    /// Where it ends \[m\]: finer than the distance of the nodes.
    pub radius: f64,
}

/// The ellipse through points `(r, p)` with `r <= within`: its square is a line over `r^2`, by least squares. NaN for
/// fewer than two points.
pub fn ellipse(points: impl Iterator<Item = (f64, f64)>, within: f64) -> Ellipse {
    let inside = points.filter(|p| p.0 <= within);
    let squares: Vec<(f64, f64)> = inside.map(|(r, p)| (r * r, p * p)).collect();
    let n = squares.len() as f64;
    let mean = |f: fn(&(f64, f64)) -> f64| squares.iter().map(f).sum::<f64>() / n;
    let (x, y) = (mean(|s| s.0), mean(|s| s.1));
    let above: f64 = squares.iter().map(|s| (s.0 - x) * (s.1 - y)).sum();
    let below: f64 = squares.iter().map(|s| (s.0 - x).powi(2)).sum();
    let slope = above / below;
    let top = y - slope * x;
    Ellipse {
        peak: top.sqrt(),
        radius: (-top / slope).sqrt(),
    }
}

/// Part of the radius whose nodes are fitted \[-\]: further out a node's share reaches over the edge.
pub const INNER: f64 = 0.85;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_ellipse_is_found_again() {
        let p = |r: f64| (r, 3.0 * (1.0 - r * r / 4.0).max(0.0).sqrt());
        let found = ellipse((0..20).map(|k| p(0.1 * f64::from(k))), 1.7);
        assert!((found.peak - 3.0).abs() < 1e-12 && (found.radius - 2.0).abs() < 1e-12);
        assert!(ellipse([(0.0, 1.0)].into_iter(), 1.0).radius.is_nan());
    }
}
