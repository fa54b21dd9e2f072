//! Quadrature rules on the reference elements.

/// A point of a rule.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct QuadraturePoint {
    /// Position in the reference element \[-\]; the third coordinate is zero in the plane.
    pub xi: [f64; 3],
    /// Weight \[-\]; the weights of a rule sum to the volume (area) of the reference element.
    pub weight: f64,
}

/// `1 / sqrt(3)`: the two-point Gauss rule on \[-1, 1\].
pub const GAUSS_2: f64 = 0.577_350_269_189_625_8;
/// `sqrt(3 / 5)`: the outer points of the three-point Gauss rule on \[-1, 1\].
pub const GAUSS_3: f64 = 0.774_596_669_241_483_4;

const ORIGIN: QuadraturePoint = QuadraturePoint {
    xi: [0.0; 3],
    weight: 0.0,
};

/// Two by two by two Gauss points on \[-1, 1\]^3, exact to degree 3 in each direction; point `q` lies next
/// to node `q` of the hexahedron.
pub static HEXAHEDRON_8: [QuadraturePoint; 8] = hexahedron_8();

/// Three by three by three Gauss points on \[-1, 1\]^3, exact to degree 5 in each direction.
pub static HEXAHEDRON_27: [QuadraturePoint; 27] = hexahedron_27();

/// Centroid of the reference tetrahedron (volume 1/6), exact to degree 1.
pub static TETRAHEDRON_1: [QuadraturePoint; 1] = [QuadraturePoint {
    xi: [0.25; 3],
    weight: 1.0 / 6.0,
}];

/// Four points in the reference tetrahedron (volume 1/6), exact to degree 2.
pub static TETRAHEDRON_4: [QuadraturePoint; 4] = tetrahedron_4();

/// Two by two Gauss points on \[-1, 1\]^2, exact to degree 3 in each direction; point `q` lies next to node
/// `q` of the quadrilateral.
pub static QUADRILATERAL_4: [QuadraturePoint; 4] = quadrilateral_4();

/// Three by three Gauss points on \[-1, 1\]^2, exact to degree 5 in each direction.
pub static QUADRILATERAL_9: [QuadraturePoint; 9] = quadrilateral_9();

/// Centroid of the reference triangle (area 1/2), exact to degree 1.
pub static TRIANGLE_1: [QuadraturePoint; 1] = [QuadraturePoint {
    xi: [1.0 / 3.0, 1.0 / 3.0, 0.0],
    weight: 0.5,
}];

/// Six points in the reference triangle (area 1/2), exact to degree 4.
pub static TRIANGLE_6: [QuadraturePoint; 6] = triangle_6();

const fn hexahedron_8() -> [QuadraturePoint; 8] {
    let nodes = &crate::element::hex8::REFERENCE_NODES;
    let mut rule = [ORIGIN; 8];
    let mut q = 0;
    while q < 8 {
        let [x, y, z] = nodes[q];
        rule[q].xi = [x * GAUSS_2, y * GAUSS_2, z * GAUSS_2];
        rule[q].weight = 1.0;
        q += 1;
    }
    rule
}

const fn hexahedron_27() -> [QuadraturePoint; 27] {
    let x = [-GAUSS_3, 0.0, GAUSS_3];
    let w = [5.0 / 9.0, 8.0 / 9.0, 5.0 / 9.0];
    let mut rule = [ORIGIN; 27];
    let mut q = 0;
    while q < 27 {
        let (i, j, k) = (q % 3, q / 3 % 3, q / 9);
        rule[q].xi = [x[i], x[j], x[k]];
        rule[q].weight = w[i] * w[j] * w[k];
        q += 1;
    }
    rule
}

const fn quadrilateral_4() -> [QuadraturePoint; 4] {
    let nodes = &crate::element::quad4::REFERENCE_NODES;
    let mut rule = [ORIGIN; 4];
    let mut q = 0;
    while q < 4 {
        rule[q].xi = [nodes[q][0] * GAUSS_2, nodes[q][1] * GAUSS_2, 0.0];
        rule[q].weight = 1.0;
        q += 1;
    }
    rule
}

const fn quadrilateral_9() -> [QuadraturePoint; 9] {
    let x = [-GAUSS_3, 0.0, GAUSS_3];
    let w = [5.0 / 9.0, 8.0 / 9.0, 5.0 / 9.0];
    let mut rule = [ORIGIN; 9];
    let mut q = 0;
    while q < 9 {
        rule[q].xi = [x[q % 3], x[q / 3], 0.0];
        rule[q].weight = w[q % 3] * w[q / 3];
        q += 1;
    }
    rule
}

/// Two orbits of three points: with `s = sqrt(38 - 44 sqrt(2/5))` at `(8 - sqrt 10 +- s)/18` from two sides.
const fn triangle_6() -> [QuadraturePoint; 6] {
    let side = [0.445_948_490_915_964_9, 0.091_576_213_509_770_74];
    let weight = [0.111_690_794_839_005_73, 0.054_975_871_827_660_93];
    let mut rule = [ORIGIN; 6];
    let mut q = 0;
    while q < 6 {
        let (orbit, corner) = (q / 3, q % 3);
        rule[q].xi = [side[orbit], side[orbit], 0.0];
        if corner < 2 {
            rule[q].xi[corner] = 1.0 - 2.0 * side[orbit];
        }
        rule[q].weight = weight[orbit];
        q += 1;
    }
    rule
}

const fn tetrahedron_4() -> [QuadraturePoint; 4] {
    // (5 - sqrt 5) / 20 and 1 - 3 times that.
    let near = 0.138_196_601_125_010_5;
    let far = 0.585_410_196_624_968_5;
    let mut rule = [ORIGIN; 4];
    let mut q = 0;
    while q < 4 {
        rule[q].xi = [near; 3];
        if q > 0 {
            rule[q].xi[q - 1] = far;
        }
        rule[q].weight = 1.0 / 24.0;
        q += 1;
    }
    rule
}

#[cfg(test)]
mod tests {
    use super::*;

    fn integrate(rule: &[QuadraturePoint], f: impl Fn([f64; 3]) -> f64) -> f64 {
        rule.iter().map(|q| q.weight * f(q.xi)).sum()
    }

    fn on_interval(p: i32) -> f64 {
        if p % 2 == 0 {
            2.0 / f64::from(p + 1)
        } else {
            0.0
        }
    }

    fn factorial(n: i32) -> f64 {
        (1..=n).map(f64::from).product()
    }

    #[test]
    fn gauss_rules_integrate_monomials_of_their_degree() {
        for (rule, degree) in [(&HEXAHEDRON_8[..], 3), (&HEXAHEDRON_27[..], 5)] {
            for p in 0..=degree {
                for q in 0..=degree {
                    for r in 0..=degree {
                        let exact = on_interval(p) * on_interval(q) * on_interval(r);
                        let found = integrate(rule, |x| x[0].powi(p) * x[1].powi(q) * x[2].powi(r));
                        assert!((found - exact).abs() < 1e-14, "degree {p} {q} {r}");
                    }
                }
            }
        }
    }

    #[test]
    fn tetrahedron_rules_integrate_monomials_of_their_degree() {
        for (rule, degree) in [(&TETRAHEDRON_1[..], 1), (&TETRAHEDRON_4[..], 2)] {
            for p in 0..=degree {
                for q in 0..=degree - p {
                    for r in 0..=degree - p - q {
                        let exact =
                            factorial(p) * factorial(q) * factorial(r) / factorial(p + q + r + 3);
                        let found = integrate(rule, |x| x[0].powi(p) * x[1].powi(q) * x[2].powi(r));
                        assert!((found - exact).abs() < 1e-15, "degree {p} {q} {r}");
                    }
                }
            }
        }
    }

    #[test]
    fn plane_rules_integrate_monomials_of_their_degree() {
        for (rule, degree) in [(&QUADRILATERAL_4[..], 3), (&QUADRILATERAL_9[..], 5)] {
            for p in 0..=degree {
                for q in 0..=degree {
                    let exact = on_interval(p) * on_interval(q);
                    let found = integrate(rule, |x| x[0].powi(p) * x[1].powi(q));
                    assert!((found - exact).abs() < 1e-14, "degree {p} {q}");
                }
            }
        }
        for (rule, degree) in [(&TRIANGLE_1[..], 1), (&TRIANGLE_6[..], 4)] {
            for p in 0..=degree {
                for q in 0..=degree - p {
                    let exact = factorial(p) * factorial(q) / factorial(p + q + 2);
                    let found = integrate(rule, |x| x[0].powi(p) * x[1].powi(q));
                    assert!((found - exact).abs() < 1e-15, "degree {p} {q}");
                }
            }
        }
    }
}
