//! What finite strain does to the force on a cone, to the first order in how steep it is.
//!
//! The least energy of a pressed body changes, when terms are added to the energy or to the constraint, by those terms
//! at the unchanged solution. Beside Boussinesq and Love's these are the energy of the third order in the displacement
//! gradient, and that a point of the surface meets the cone where it moves to, not where it came from. Both are
//! integrals over the field of small strains. No mesh, no contact solver, no element has a part in it.

use std::f64::consts::{FRAC_PI_2, PI};

use num_complex::Complex64;

/// Points of the quadrature in each direction.
const POINTS: u32 = 160;

/// A displacement gradient \[-\].
pub type Gradient = [[f64; 3]; 3];

/// The part of an energy that is of the third order in the displacement gradient, over the shear modulus; second
/// argument is Lame's first modulus over it.
pub type Cubic = fn(&Gradient, f64) -> f64;

/// Of `lambda/2 (tr E)^2 + G E:E`.
pub fn cubic_of_saint_venant_kirchhoff(h: &Gradient, lambda: f64) -> f64 {
    let mut coupled = 0.0;
    for i in 0..3 {
        for j in 0..3 {
            let square: f64 = (0..3).map(|k| h[k][i] * h[k][j]).sum();
            coupled += 0.5 * (h[i][j] + h[j][i]) * square;
        }
    }
    0.5 * lambda * trace(h) * contract(h, h) + coupled
}

/// Of `G/2 (I_1 - 3 - 2 ln J) + lambda/2 (ln J)^2`.
pub fn cubic_of_neo_hookean(h: &Gradient, lambda: f64) -> f64 {
    let square = product(h, h);
    -trace(&product(&square, h)) / 3.0 - 0.5 * lambda * trace(h) * trace(&square)
}

fn trace(h: &Gradient) -> f64 {
    h[0][0] + h[1][1] + h[2][2]
}

fn product(a: &Gradient, b: &Gradient) -> Gradient {
    std::array::from_fn(|i| std::array::from_fn(|j| (0..3).map(|k| a[i][k] * b[k][j]).sum()))
}

fn contract(a: &Gradient, b: &Gradient) -> f64 {
    a.iter()
        .flatten()
        .zip(b.iter().flatten())
        .map(|(a, b)| a * b)
        .sum()
}

/// `c` of `P = (2/pi) E/(1-nu^2) tan(alpha) d^2 (1 + c cot(alpha))`, without friction \[-\].
pub fn cone_strain_slope(cubic: Cubic, nu: f64) -> f64 {
    let lambda = 2.0 * nu / (1.0 - 2.0 * nu);
    let inside = integral(nu, |h| cubic(h, lambda));
    (inside + moved_surface(nu)) / energy(nu)
}

/// `E*` over the shear modulus.
fn modulus(nu: f64) -> f64 {
    2.0 / (1.0 - nu)
}

/// Energy of small strains where radius of contact, cotangent and shear modulus are 1: a third of force times depth.
fn energy(nu: f64) -> f64 {
    2.0 / PI * modulus(nu) * FRAC_PI_2.powi(3) / 3.0
}

/// Work of the pressure on the depth of the cone between where a point of the surface comes from and where it goes to.
fn moved_surface(nu: f64) -> f64 {
    let ring = |(s, weight): (f64, f64)| {
        let pressure = 0.5 * modulus(nu) * (1.0 / s).acosh();
        // On the surface the field has no bound to its gradient at the tip, but the displacement is plain.
        -weight * 2.0 * PI * s * pressure * Field::at(s, 1e-13, nu).radial
    };
    nodes(1.0).map(ring).sum()
}

/// Of a density of the gradient of small strains over the half-space.
fn integral(nu: f64, density: impl Fn(&Gradient) -> f64) -> f64 {
    let mut sum = 0.0;
    for (angle, across) in nodes(FRAC_PI_2) {
        for (q, along) in nodes(1.0) {
            // Inside of the radius of contact, and outside of it by inversion: the field is rough at the rim.
            for (distance, stretch) in [(q, 1.0), (1.0 / q, 1.0 / (q * q))] {
                let (r, z) = (distance * angle.sin(), distance * angle.cos());
                let volume = 2.0 * PI * r * distance * stretch * across * along;
                sum += volume * density(&Field::at(r, z, nu).gradient);
            }
        }
    }
    sum
}

/// Points and weights over an interval from 0, dense at both ends, so that a logarithm or a root there does no harm.
fn nodes(length: f64) -> impl Iterator<Item = (f64, f64)> {
    (0..POINTS).map(move |k| {
        let s = (f64::from(k) + 0.5) / f64::from(POINTS);
        let (a, b) = (s.powi(4), (1.0 - s).powi(4));
        let slope = 4.0 * (s * (1.0 - s)).powi(3) / (a + b).powi(2);
        (length * a / (a + b), length * slope / f64::from(POINTS))
    })
}

/// Displacement and its gradient under a cone, both small, where radius of contact, cotangent and shear modulus are 1.
/// Axes are radius, depth into the body, hoop.
struct Field {
    radial: f64,
    gradient: Gradient,
}

impl Field {
    /// Boussinesq's potentials `V = int p/rho dA` and `X` with `dX/dz = V`. The pressure of a cone is that of flat
    /// punches of all radii up to its own, whose potential is that of sources `i t` above the surface: with `R^2 = r^2
    /// + s^2`, `f = R - s ln(s + R)`, `V` is twice the real part of `f` at `s = z + i` less `f` at `s = z`, times
    /// `pi/(1 - nu)`.
    fn at(r: f64, z: f64, nu: f64) -> Field {
        let source = |s: Complex64| (s, (s * s + r * r).sqrt());
        let (far, near) = (
            source(Complex64::new(z, 1.0)),
            source(Complex64::new(z, 0.0)),
        );
        let scale = 2.0 * PI / (1.0 - nu) / (4.0 * PI);
        let both = |f: &dyn Fn(Complex64, Complex64) -> Complex64| {
            scale * (f(far.0, far.1) - f(near.0, near.1)).re
        };
        let v_z = both(&|s, root| -(s + root).ln());
        let v_zz = both(&|_, root| -root.inv());
        let v_r = both(&|s, root| r / (s + root));
        let v_rz = both(&|s, root| -r / (root * (s + root)));
        let x_r = both(&|s, root| 0.5 * r * (s / (s + root) + (s + root).ln()));
        // Both potentials are harmonic.
        let (v_rr, x_rr) = (-v_r / r - v_zz, -x_r / r - v_z);
        let part = 1.0 - 2.0 * nu;
        let radial = -(part * x_r + z * v_r);
        Field {
            radial,
            gradient: [
                [
                    -(part * x_rr + z * v_rr),
                    -((part + 1.0) * v_r + z * v_rz),
                    0.0,
                ],
                [(part + 1.0) * v_r - z * v_rz, part * v_z - z * v_zz, 0.0],
                [0.0, 0.0, radial / r],
            ],
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use hyperelastic::{
        ElasticConstants, Material, NeoHookean, SaintVenantKirchhoff, Symmetric, right_cauchy_green,
    };
    use nalgebra::Matrix3;

    type Energy = Box<dyn Fn(&Symmetric) -> f64>;

    /// `C` of `F = I + s h`.
    fn stretch(h: &Gradient, s: f64) -> Symmetric {
        right_cauchy_green(&(Matrix3::identity() + Matrix3::from_fn(|i, j| s * h[i][j])))
    }

    #[test]
    fn cubic_parts_are_those_of_the_laws() {
        let (shear, lambda) = (2.0, 3.0);
        let elastic = ElasticConstants::from_shear_bulk(shear, lambda + 2.0 * shear / 3.0).unwrap();
        let laws: [(Energy, Cubic); 2] = [
            {
                let law = SaintVenantKirchhoff::new(elastic).unwrap();
                (
                    Box::new(move |c| law.energy(c).unwrap()),
                    cubic_of_saint_venant_kirchhoff,
                )
            },
            {
                let law = NeoHookean::new(elastic).unwrap();
                (
                    Box::new(move |c| law.energy(c).unwrap()),
                    cubic_of_neo_hookean,
                )
            },
        ];
        let gradients: [Gradient; 2] = [
            [[0.3, -0.7, 0.2], [0.5, 0.4, -0.1], [0.6, -0.2, 0.8]],
            [[-0.9, 0.1, 0.4], [0.3, 0.2, 0.7], [-0.5, 0.6, 0.1]],
        ];
        for (energy, cubic) in laws {
            for h in &gradients {
                // What is odd and of the fifth order goes with a second step.
                let odd =
                    |s: f64| (energy(&stretch(h, s)) - energy(&stretch(h, -s))) / (2.0 * s.powi(3));
                let third = (4.0 * odd(0.005) - odd(0.01)) / 3.0;
                let expected = shear * cubic(h, lambda / shear);
                assert!((third - expected).abs() < 1e-6, "{third} {expected}");
            }
        }
    }

    #[test]
    fn the_field_of_small_strains_has_the_energy_of_the_force() {
        for nu in [0.0, 0.3, 0.495] {
            let lambda = 2.0 * nu / (1.0 - 2.0 * nu);
            let quadratic = |h: &Gradient| {
                let mut strain = 0.0;
                for i in 0..3 {
                    for j in 0..3 {
                        strain += (0.5 * (h[i][j] + h[j][i])).powi(2);
                    }
                }
                0.5 * lambda * trace(h).powi(2) + strain
            };
            let found = integral(nu, quadratic) / energy(nu);
            assert!((found - 1.0).abs() < 1e-6, "{nu} {found}");
        }
    }

    #[test]
    fn nearly_incompressible_matter_of_the_paper_softens_nine_times_as_much_as_neo_hookean() {
        let soft = cone_strain_slope(cubic_of_saint_venant_kirchhoff, 0.495);
        let mild = cone_strain_slope(cubic_of_neo_hookean, 0.495);
        assert!((soft + 0.693_346).abs() < 1e-5, "{soft}");
        assert!((mild + 0.078_122).abs() < 1e-5, "{mild}");
    }
}
