//! How often a closed surface goes round a point.

use std::f64::consts::PI;

use nalgebra::Vector3;

use super::Surface;

impl Surface {
    /// How often the surface goes round `point` \[-\]: 1 inside of a closed outward surface, 0 outside, something
    /// between for a point on it or for a surface with holes. Bilinear facets count as two triangles.
    ///
    /// `positions` are current coordinates \[m\] of the whole mesh, flat, `dim * node + component`. Source: the solid
    /// angle of a triangle of Van Oosterom and Strackee (1983); in the plane, the angle of an edge.
    #[must_use]
    pub fn winding(&self, positions: &[f64], point: Vector3<f64>) -> f64 {
        let seen = |facet| {
            let x = self.facet_positions(facet, positions);
            let [a, b, c, d] = x.map(|x| x - point);
            match facet.nodes().len() {
                2 => (a.x * b.y - a.y * b.x).atan2(a.dot(&b)) / (2.0 * PI),
                3 => solid_angle(&a, &b, &c) / (4.0 * PI),
                _ => (solid_angle(&a, &b, &c) + solid_angle(&a, &c, &d)) / (4.0 * PI),
            }
        };
        self.facets.iter().map(seen).sum()
    }
}

fn solid_angle(a: &Vector3<f64>, b: &Vector3<f64>, c: &Vector3<f64>) -> f64 {
    let (la, lb, lc) = (a.norm(), b.norm(), c.norm());
    let below = la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb;
    2.0 * a.dot(&b.cross(c)).atan2(below)
}

#[cfg(test)]
mod tests {
    use nalgebra::Vector3;
    use proptest::prelude::*;

    use crate::{BoxMesh, CellKind, Mesh, RectangleMesh, Surface};

    fn block(kind: CellKind) -> Mesh {
        match kind.dim() {
            2 => RectangleMesh::uniform([0.0; 2], [1.0; 2], [3, 2])
                .with_kind(kind)
                .generate("b"),
            _ => BoxMesh::uniform([0.0; 3], [1.0; 3], [3, 2, 2])
                .with_kind(kind)
                .generate("b"),
        }
        .unwrap()
    }

    fn flat(mesh: &Mesh) -> Vec<f64> {
        let points = mesh.points.iter();
        points
            .flat_map(|x| x.as_slice()[..mesh.dim].to_vec())
            .collect()
    }

    proptest! {
        /// One inside, zero outside, in the plane and in space, for every kind of face.
        #[test]
        fn a_block_is_gone_round_once(p in [-0.5f64..1.5, -0.5f64..1.5, -0.5f64..1.5]) {
            use CellKind::{Hex8, Hex27, Quad4, Quad9, Tet4, Tet10, Tri3};
            for kind in [Quad4, Quad9, Tri3, Hex8, Hex27, Tet4, Tet10] {
                let mesh = block(kind);
                let surface = Surface::new(mesh.boundary_facets()).unwrap();
                let at = Vector3::from_fn(|i, _| if i < mesh.dim { p[i] } else { 0.0 });
                let inside = at.iter().take(mesh.dim).all(|x| (0.0..1.0).contains(x));
                let found = surface.winding(&flat(&mesh), at);
                prop_assert!((found - f64::from(u8::from(inside))).abs() < 1e-9, "{kind:?} {found}");
            }
        }
    }
}
