//! Closest point on one facet: a flat triangle or a bilinear quadrilateral; in the plane, a straight line.
//!
//! Vertices run counter-clockwise seen from outside; edge `k` joins vertex `k` to the next one. A line lies in
//! z = 0 with the body on its left; it has no edges, only its inside and two vertices.
//! A quadrilateral is `x = a + xi b + eta c + xi eta d` with `(xi, eta)` in the unit square, vertices at
//! (0,0), (1,0), (1,1), (0,1); a triangle is the case `d = 0` with `xi + eta <= 1`.

use nalgebra::Vector3;

use crate::geometry::vector::unit;

/// Where on a facet a point lies. Edges and vertices are exact: the point was clamped to them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FacetPlace {
    /// Inside the facet.
    Interior,
    /// On the edge from vertex `k` to the next one.
    Edge(u8),
    /// At vertex `k`.
    Vertex(u8),
}

/// A point of a facet.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct FacetPoint {
    /// Local coordinates `(xi, eta)` in the unit square (quadrilateral) or unit triangle \[-\]; `(xi, 0)` on a line.
    pub coordinates: [f64; 2],
    /// Shape functions at the point \[-\]: they sum to 1; those of missing vertices are 0.
    pub weights: [f64; 4],
    /// Position \[m\].
    pub point: Vector3<f64>,
    /// Squared distance to the point that was projected \[m^2\].
    pub distance_squared: f64,
    /// Interior, edge or vertex.
    pub place: FacetPlace,
}

/// The point of a facet closest to `p` \[m\]: `vertices` holds 2 to 4 positions \[m\].
///
/// Exact for lines and triangles. For quadrilaterals a safeguarded projected Newton iteration, compared with the four
/// edges; it returns the global minimum unless the facet is warped so strongly, and `p` so far, that the
/// distance has several minima inside.
///
/// With fewer than 2 vertices the first one is returned.
#[must_use]
pub fn closest_point(vertices: &[Vector3<f64>], p: Vector3<f64>) -> FacetPoint {
    match vertices {
        [a, b] => line(&[*a, *b], p),
        [a, b, c] => triangle(&[*a, *b, *c], p),
        [a, b, c, d, ..] => quadrilateral(&[*a, *b, *c, *d], p),
        _ => {
            let point = vertices.first().copied().unwrap_or(p);
            let r = point - p;
            FacetPoint {
                coordinates: [0.0; 2],
                weights: [1.0, 0.0, 0.0, 0.0],
                point,
                distance_squared: r.norm_squared(),
                place: FacetPlace::Vertex(0),
            }
        }
    }
}

/// Outward unit normal of the facet itself at local coordinates; `None` where the facet is degenerate.
pub(crate) fn facet_normal(
    vertices: &[Vector3<f64>],
    coordinates: [f64; 2],
) -> Option<Vector3<f64>> {
    match vertices {
        [a, b] => unit(Vector3::new(b[1] - a[1], a[0] - b[0], 0.0)),
        [a, b, c] => unit((b - a).cross(&(c - a))),
        [a, b, c, d, ..] => {
            let q = Bilinear::new(&[*a, *b, *c, *d], *a);
            unit(q.d_xi(coordinates).cross(&q.d_eta(coordinates)))
        }
        _ => None,
    }
}

/// Parameter in [0, 1] of the point of segment `a b` closest to the origin.
fn segment(a: Vector3<f64>, b: Vector3<f64>) -> f64 {
    let e = b - a;
    let length_squared = e.norm_squared();
    if length_squared > 0.0 {
        (-a.dot(&e) / length_squared).clamp(0.0, 1.0)
    } else {
        0.0
    }
}

/// The closest point to the origin on the border of a polygon: edge, parameter along it, squared distance.
fn closest_on_border(vertices: &[Vector3<f64>]) -> (usize, f64, f64) {
    let mut best = (0, 0.0, f64::INFINITY);
    for k in 0..vertices.len() {
        let (a, b) = (vertices[k], vertices[(k + 1) % vertices.len()]);
        let t = segment(a, b);
        let r = a + t * (b - a);
        let f = r.norm_squared();
        if f < best.2 {
            best = (k, t, f);
        }
    }
    best
}

fn line(x: &[Vector3<f64>; 2], p: Vector3<f64>) -> FacetPoint {
    let a = x[0] - p;
    let t = segment(a, x[1] - p);
    let place = if t <= 0.0 {
        FacetPlace::Vertex(0)
    } else if t >= 1.0 {
        FacetPlace::Vertex(1)
    } else {
        FacetPlace::Interior
    };
    let relative = a + t * (x[1] - x[0]);
    finish(x, [t, 0.0], [1.0 - t, t, 0.0, 0.0], place, relative)
}

fn triangle(x: &[Vector3<f64>; 3], p: Vector3<f64>) -> FacetPoint {
    let r = [x[0] - p, x[1] - p, x[2] - p];
    let (b, c) = (x[1] - x[0], x[2] - x[0]);
    let (bb, bc, cc) = (b.norm_squared(), b.dot(&c), c.norm_squared());
    let (rb, rc) = (-r[0].dot(&b), -r[0].dot(&c));
    let det = bb * cc - bc * bc;
    let (xi, eta) = ((cc * rb - bc * rc) / det, (bb * rc - bc * rb) / det);
    // A degenerate triangle gives NaN or infinity here and is left to its border.
    if xi > 0.0 && eta > 0.0 && xi + eta < 1.0 {
        let relative = r[0] + xi * b + eta * c;
        let weights = [1.0 - xi - eta, xi, eta, 0.0];
        return finish(x, [xi, eta], weights, FacetPlace::Interior, relative);
    }
    let (edge, t, _) = closest_on_border(&r);
    let next = (edge + 1) % 3;
    let mut weights = [0.0; 4];
    weights[edge] = 1.0 - t;
    weights[next] = t;
    let place = if t <= 0.0 {
        FacetPlace::Vertex(edge as u8)
    } else if t >= 1.0 {
        FacetPlace::Vertex(next as u8)
    } else {
        FacetPlace::Edge(edge as u8)
    };
    let relative = r[edge] + t * (x[next] - x[edge]);
    finish(x, [weights[1], weights[2]], weights, place, relative)
}

/// `relative` is the closest point seen from `p`, formed without the cancellation of two large positions.
fn finish(
    x: &[Vector3<f64>],
    coordinates: [f64; 2],
    weights: [f64; 4],
    place: FacetPlace,
    relative: Vector3<f64>,
) -> FacetPoint {
    FacetPoint {
        coordinates,
        weights,
        point: interpolate(x, &weights),
        distance_squared: relative.norm_squared(),
        place,
    }
}

/// `r(xi, eta) = a + xi b + eta c + xi eta d`, seen from the projected point.
struct Bilinear {
    a: Vector3<f64>,
    b: Vector3<f64>,
    c: Vector3<f64>,
    d: Vector3<f64>,
}

impl Bilinear {
    fn new(x: &[Vector3<f64>; 4], p: Vector3<f64>) -> Self {
        let b = x[1] - x[0];
        Self {
            a: x[0] - p,
            b,
            c: x[3] - x[0],
            d: x[2] - x[3] - b,
        }
    }

    fn at(&self, [xi, eta]: [f64; 2]) -> Vector3<f64> {
        let along = self.b + eta * self.d;
        self.a + eta * self.c + xi * along
    }

    fn d_xi(&self, [_, eta]: [f64; 2]) -> Vector3<f64> {
        self.b + eta * self.d
    }

    fn d_eta(&self, [xi, _]: [f64; 2]) -> Vector3<f64> {
        self.c + xi * self.d
    }

    /// Half the squared distance's gradient and Hessian (xi xi, xi eta without curvature, eta eta, curvature).
    fn derivatives(&self, s: [f64; 2]) -> ([f64; 2], [f64; 4]) {
        let (r, u, v) = (self.at(s), self.d_xi(s), self.d_eta(s));
        (
            [r.dot(&u), r.dot(&v)],
            [
                u.norm_squared(),
                u.dot(&v),
                v.norm_squared(),
                r.dot(&self.d),
            ],
        )
    }

    /// One exact minimisation along xi, then one along eta: never uphill, since both are parabolas.
    fn alternate(&self, s: [f64; 2]) -> [f64; 2] {
        let (g, h) = self.derivatives(s);
        let xi = if h[0] > 0.0 {
            (s[0] - g[0] / h[0]).clamp(0.0, 1.0)
        } else {
            s[0]
        };
        let s = [xi, s[1]];
        let (g, h) = self.derivatives(s);
        let eta = if h[2] > 0.0 {
            (s[1] - g[1] / h[2]).clamp(0.0, 1.0)
        } else {
            s[1]
        };
        [xi, eta]
    }

    /// Newton step in the coordinates whose bound is not active: not reached, or pushed away from.
    fn newton(&self, s: [f64; 2]) -> [f64; 2] {
        let (g, [huu, huv, hvv, curvature]) = self.derivatives(s);
        let is_active = |k: usize| (s[k] <= 0.0 && g[k] >= 0.0) || (s[k] >= 1.0 && g[k] <= 0.0);
        let step = match (is_active(0), is_active(1)) {
            (true, true) => [0.0, 0.0],
            (true, false) => [0.0, -g[1] / hvv],
            (false, true) => [-g[0] / huu, 0.0],
            (false, false) => {
                let full = huv + curvature;
                let definite = |h: f64| huu * hvv - h * h > DEFINITE * huu * hvv;
                // Far from a warped facet the Hessian turns indefinite: without its curvature term it cannot.
                let h = if definite(full) { full } else { huv };
                let det = huu * hvv - h * h;
                [(h * g[1] - hvv * g[0]) / det, (h * g[0] - huu * g[1]) / det]
            }
        };
        [
            (s[0] + step[0]).clamp(0.0, 1.0),
            (s[1] + step[1]).clamp(0.0, 1.0),
        ]
    }

    fn minimise(&self, mut s: [f64; 2]) -> ([f64; 2], f64) {
        let value = |s: [f64; 2]| {
            let r = self.at(s);
            r.norm_squared()
        };
        let mut f = value(s);
        // Near the minimum the value cannot tell a better point from round-off, but the gradient can.
        let slack = VALUE_ROUND_OFF
            * (self.a.norm_squared() + self.b.norm_squared() + self.c.norm_squared());
        for _ in 0..MAX_STEPS {
            let mut next = self.newton(s);
            let mut f_next = value(next);
            // NaN, from a degenerate facet, is no improvement either.
            let improved = f_next <= f + slack;
            if !improved {
                next = self.alternate(s);
                f_next = value(next);
            }
            let change = (next[0] - s[0]).abs().max((next[1] - s[1]).abs());
            if f_next <= f + slack {
                (s, f) = (next, f_next);
            }
            if change <= STEP_TOLERANCE {
                break;
            }
        }
        (s, f)
    }
}

/// Quadratic convergence needs five or six; the rest is for degenerate facets, which creep.
const MAX_STEPS: usize = 60;
/// In local coordinates: a few units of round-off.
const STEP_TOLERANCE: f64 = 1e-14;
/// Least determinant of a Hessian over the product of its diagonal \[-\] that counts as definite.
const DEFINITE: f64 = 1e-10;
/// Round-off of a squared distance over the squares it is the sum of \[-\].
const VALUE_ROUND_OFF: f64 = 1e-14;

fn quadrilateral(x: &[Vector3<f64>; 4], p: Vector3<f64>) -> FacetPoint {
    let q = Bilinear::new(x, p);
    let (mut s, f) = q.minimise([0.5, 0.5]);
    let r = [q.a, x[1] - p, x[2] - p, x[3] - p];
    let (edge, t, f_border) = closest_on_border(&r);
    let settled = f <= f_border;
    if !settled {
        let start = match edge {
            0 => [t, 0.0],
            1 => [1.0, t],
            2 => [1.0 - t, 1.0],
            _ => [0.0, 1.0 - t],
        };
        let (better, f_better) = q.minimise(start);
        if f_better < f || f.is_nan() {
            s = better;
        }
    }
    let [xi, eta] = s;
    let weights = [
        (1.0 - xi) * (1.0 - eta),
        xi * (1.0 - eta),
        xi * eta,
        (1.0 - xi) * eta,
    ];
    finish(x, s, weights, place_in_square(s), q.at(s))
}

fn place_in_square([xi, eta]: [f64; 2]) -> FacetPlace {
    match (xi <= 0.0, xi >= 1.0, eta <= 0.0, eta >= 1.0) {
        (true, _, true, _) => FacetPlace::Vertex(0),
        (_, true, true, _) => FacetPlace::Vertex(1),
        (_, true, _, true) => FacetPlace::Vertex(2),
        (true, _, _, true) => FacetPlace::Vertex(3),
        (_, _, true, _) => FacetPlace::Edge(0),
        (_, true, _, _) => FacetPlace::Edge(1),
        (_, _, _, true) => FacetPlace::Edge(2),
        (true, _, _, _) => FacetPlace::Edge(3),
        _ => FacetPlace::Interior,
    }
}

/// `sum_i N_i a_i`, for positions or vertex normals.
pub(crate) fn interpolate(values: &[Vector3<f64>], weights: &[f64; 4]) -> Vector3<f64> {
    values
        .iter()
        .zip(weights)
        .fold(Vector3::zeros(), |sum, (a, w)| sum + *w * a)
}

/// The unit vector in the facet that points out of it across side `k`, at a point of that side: edge `k` of a
/// face, vertex `k` of a line.
///
/// Zero on a degenerate facet, which then has no outside.
pub(crate) fn conormal(
    vertices: &[Vector3<f64>],
    side: usize,
    coordinates: [f64; 2],
) -> Vector3<f64> {
    let e = vertices[(side + 1) % vertices.len()] - vertices[side];
    let outward = if vertices.len() == 2 {
        unit(-e)
    } else {
        facet_normal(vertices, coordinates).and_then(|m| unit(e.cross(&m)))
    };
    outward.unwrap_or_else(Vector3::zeros)
}

/// Local coordinates of vertex `k` of a facet with `count` vertices.
pub(crate) fn vertex_coordinates(count: usize, k: usize) -> [f64; 2] {
    let square = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
    match (count, k) {
        (3, 2) => [0.0, 1.0],
        _ => square[k % 4],
    }
}

#[cfg(test)]
mod tests;
