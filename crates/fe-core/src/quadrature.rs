//! Quadrature rules on the reference elements.

/// A point of a rule.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct QuadraturePoint {
    /// Position in the reference element \[-\]; the third coordinate is zero in the plane.
    pub xi: [f64; 3],
    /// Weight \[-\]; the weights of a rule sum to the volume (area) of the reference element.
    pub weight: f64,
}

impl QuadraturePoint {
    /// A point at `xi` \[-\] with a weight \[-\].
    #[must_use]
    pub const fn new(xi: [f64; 3], weight: f64) -> QuadraturePoint {
        QuadraturePoint { xi, weight }
    }
}

/// `1 / sqrt(3)`: the two-point Gauss rule on \[-1, 1\].
pub(crate) const GAUSS_2: f64 = 0.577_350_269_189_625_8;
/// `sqrt(3 / 5)`: the outer points of the three-point Gauss rule on \[-1, 1\].
pub(crate) const GAUSS_3: f64 = 0.774_596_669_241_483_4;

const ORIGIN: QuadraturePoint = QuadraturePoint::new([0.0; 3], 0.0);

/// Two by two by two Gauss points on \[-1, 1\]^3, exact to degree 3 in each direction; point `q` lies next
/// to node `q` of the hexahedron.
pub(crate) static HEXAHEDRON_8: [QuadraturePoint; 8] = hexahedron_8();

/// Three by three by three Gauss points on \[-1, 1\]^3, exact to degree 5 in each direction.
pub(crate) static HEXAHEDRON_27: [QuadraturePoint; 27] = hexahedron_27();

/// Four by four by four Gauss points on \[-1, 1\]^3, exact to degree 7 in each direction.
pub(crate) static HEXAHEDRON_64: [QuadraturePoint; 64] = hexahedron_64();

/// Centroid of the reference tetrahedron (volume 1/6), exact to degree 1.
pub(crate) static TETRAHEDRON_1: [QuadraturePoint; 1] =
    [QuadraturePoint::new([0.25; 3], 1.0 / 6.0)];

/// Four points in the reference tetrahedron (volume 1/6), exact to degree 2.
pub(crate) static TETRAHEDRON_4: [QuadraturePoint; 4] = tetrahedron_4();

/// Eight points in the reference tetrahedron (volume 1/6), exact to degree 3.
pub(crate) static TETRAHEDRON_8: [QuadraturePoint; 8] = tetrahedron_8();

/// Fourteen points in the reference tetrahedron (volume 1/6), exact to degree 5.
pub(crate) static TETRAHEDRON_14: [QuadraturePoint; 14] = tetrahedron_14();

/// Two by two Gauss points on \[-1, 1\]^2, exact to degree 3 in each direction; point `q` lies next to node
/// `q` of the quadrilateral.
pub(crate) static QUADRILATERAL_4: [QuadraturePoint; 4] = quadrilateral_4();

/// Three by three Gauss points on \[-1, 1\]^2, exact to degree 5 in each direction.
pub(crate) static QUADRILATERAL_9: [QuadraturePoint; 9] = quadrilateral_9();

/// Four by four Gauss points on \[-1, 1\]^2, exact to degree 7 in each direction.
pub(crate) static QUADRILATERAL_16: [QuadraturePoint; 16] = quadrilateral_16();

/// Centroid of the reference triangle (area 1/2), exact to degree 1.
pub(crate) static TRIANGLE_1: [QuadraturePoint; 1] =
    [QuadraturePoint::new([1.0 / 3.0, 1.0 / 3.0, 0.0], 0.5)];

/// Six points in the reference triangle (area 1/2), exact to degree 4.
pub(crate) static TRIANGLE_6: [QuadraturePoint; 6] = triangle_6();

/// Seven points in the reference triangle (area 1/2), exact to degree 5.
pub(crate) static TRIANGLE_7: [QuadraturePoint; 7] = triangle_7();

/// Points and weights of the four-point Gauss rule on \[-1, 1\].
const GAUSS_4: [[f64; 4]; 2] = [
    [
        -0.861_136_311_594_052_6,
        -0.339_981_043_584_856_3,
        0.339_981_043_584_856_3,
        0.861_136_311_594_052_6,
    ],
    [
        0.347_854_845_137_453_85,
        0.652_145_154_862_546_1,
        0.652_145_154_862_546_1,
        0.347_854_845_137_453_85,
    ],
];

/// Corners of the square, counter-clockwise as the nodes of VTK.
const SQUARE: [[f64; 2]; 4] = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];

const fn hexahedron_8() -> [QuadraturePoint; 8] {
    let mut rule = [ORIGIN; 8];
    let mut q = 0;
    while q < 8 {
        let [x, y] = SQUARE[q % 4];
        let z = if q < 4 { -1.0 } else { 1.0 };
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

const fn hexahedron_64() -> [QuadraturePoint; 64] {
    let [x, w] = GAUSS_4;
    let mut rule = [ORIGIN; 64];
    let mut q = 0;
    while q < 64 {
        let (i, j, k) = (q % 4, q / 4 % 4, q / 16);
        rule[q].xi = [x[i], x[j], x[k]];
        rule[q].weight = w[i] * w[j] * w[k];
        q += 1;
    }
    rule
}

const fn quadrilateral_4() -> [QuadraturePoint; 4] {
    let mut rule = [ORIGIN; 4];
    let mut q = 0;
    while q < 4 {
        rule[q].xi = [SQUARE[q][0] * GAUSS_2, SQUARE[q][1] * GAUSS_2, 0.0];
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

const fn quadrilateral_16() -> [QuadraturePoint; 16] {
    let [x, w] = GAUSS_4;
    let mut rule = [ORIGIN; 16];
    let mut q = 0;
    while q < 16 {
        rule[q].xi = [x[q % 4], x[q / 4], 0.0];
        rule[q].weight = w[q % 4] * w[q / 4];
        q += 1;
    }
    rule
}

/// Two orbits of three points: with `s = sqrt(38 - 44 sqrt(2/5))` at `(8 - sqrt 10 +- s)/18` from two sides.
const fn triangle_6() -> [QuadraturePoint; 6] {
    let side = [0.445_948_490_915_964_9, 0.091_576_213_509_770_74];
    let weight = [0.111_690_794_839_005_73, 0.054_975_871_827_660_93];
    two_orbits(side, weight)
}

/// The centroid and two orbits of three points: `(6 -+ sqrt 15)/21` from two sides, weights `(155 -+ sqrt 15)/2400`.
const fn triangle_7() -> [QuadraturePoint; 7] {
    let side = [0.101_286_507_323_456_34, 0.470_142_064_105_115_1];
    let weight = [0.062_969_590_272_413_58, 0.066_197_076_394_253_1];
    let mut rule: [QuadraturePoint; 7] = two_orbits(side, weight);
    rule[6].xi = [1.0 / 3.0, 1.0 / 3.0, 0.0];
    rule[6].weight = 9.0 / 80.0;
    rule
}

/// Two orbits of three points at these distances from two sides; points beyond the sixth are left to the caller.
const fn two_orbits<const N: usize>(side: [f64; 2], weight: [f64; 2]) -> [QuadraturePoint; N] {
    let mut rule = [ORIGIN; N];
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

/// Two orbits of four points at `side` from three faces. One number is free in the rules of this kind; this choice
/// is nearly right for fourth powers too.
const fn tetrahedron_8() -> [QuadraturePoint; 8] {
    let side = [0.328, 0.106_338_096_890_885_49];
    let weight = [0.559_181_480_406_989_8, 0.440_818_519_593_010_2];
    let mut rule = [ORIGIN; 8];
    let mut q = 0;
    while q < 8 {
        let (orbit, corner) = (q / 4, q % 4);
        rule[q].xi = [side[orbit]; 3];
        if corner < 3 {
            rule[q].xi[corner] = 1.0 - 3.0 * side[orbit];
        }
        rule[q].weight = weight[orbit] / 24.0;
        q += 1;
    }
    rule
}

/// Two orbits of four points, `near` from three faces, and one of six, `pair` from two faces.
const fn tetrahedron_14() -> [QuadraturePoint; 14] {
    let near = [0.310_885_919_263_300_6, 0.092_735_250_310_891_23];
    let near_weight = [0.018_781_320_953_002_642, 0.012_248_840_519_393_658];
    let pair = 0.045_503_704_125_649_65;
    let pairs = [[0, 1], [0, 2], [1, 2]];
    let mut rule = [ORIGIN; 14];
    let mut q = 0;
    while q < 14 {
        if q < 8 {
            let (orbit, corner) = (q / 4, q % 4);
            rule[q].xi = [near[orbit]; 3];
            if corner < 3 {
                rule[q].xi[corner] = 1.0 - 3.0 * near[orbit];
            }
            rule[q].weight = near_weight[orbit];
        } else {
            let (k, inner) = ((q - 8) % 3, q >= 11);
            let (of_pair, other) = if inner {
                (0.5 - pair, pair)
            } else {
                (pair, 0.5 - pair)
            };
            rule[q].xi = [other; 3];
            rule[q].xi[pairs[k][0]] = of_pair;
            rule[q].xi[pairs[k][1]] = of_pair;
            rule[q].weight = 0.007_091_003_462_846_911;
        }
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
        for (rule, degree) in [
            (&HEXAHEDRON_8[..], 3),
            (&HEXAHEDRON_27[..], 5),
            (&HEXAHEDRON_64[..], 7),
        ] {
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
        for (rule, degree) in [
            (&TETRAHEDRON_1[..], 1),
            (&TETRAHEDRON_4[..], 2),
            (&TETRAHEDRON_14[..], 5),
        ] {
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
        for (rule, degree) in [
            (&QUADRILATERAL_4[..], 3),
            (&QUADRILATERAL_9[..], 5),
            (&QUADRILATERAL_16[..], 7),
        ] {
            for p in 0..=degree {
                for q in 0..=degree {
                    let exact = on_interval(p) * on_interval(q);
                    let found = integrate(rule, |x| x[0].powi(p) * x[1].powi(q));
                    assert!((found - exact).abs() < 1e-14, "degree {p} {q}");
                }
            }
        }
        for (rule, degree) in [
            (&TRIANGLE_1[..], 1),
            (&TRIANGLE_6[..], 4),
            (&TRIANGLE_7[..], 5),
        ] {
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
