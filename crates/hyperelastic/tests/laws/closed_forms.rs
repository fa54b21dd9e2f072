use hyperelastic::Material;
use hyperelastic::conformance::{ClosedForm, check_homogeneous};
use proptest::prelude::*;

use super::*;

fn stretched(l: [f64; 3]) -> Matrix3<f64> {
    Matrix3::from_diagonal(&l.into())
}

fn first_piola(p: [f64; 3]) -> ClosedForm {
    ClosedForm::FirstPiola(stretched(p))
}

fn simple_shear(k: f64) -> Matrix3<f64> {
    Matrix3::new(1.0, k, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0)
}

proptest! {
    #[test]
    fn blatz_ko_uniaxial(g in 0.1..10.0, l in 0.3..3.0_f64) {
        let l2 = l.powf(-0.25);
        let p = g * (l.powf(-0.5) - l.powi(-3));
        check_homogeneous(&blatz_ko(g), &stretched([l, l2, l2]), &first_piola([p, 0.0, 0.0]), 1e-13)?;
    }

    #[test]
    fn blatz_ko_plane_strain(g in 0.1..10.0, l in 0.3..3.0_f64) {
        let l2 = l.powf(-1.0 / 3.0);
        let p = g * (l.powf(-1.0 / 3.0) - l.powi(-3));
        // The stress that keeps the third stretch at one is J - 1.
        let held = g * (l * l2 - 1.0);
        check_homogeneous(&blatz_ko(g), &stretched([l, l2, 1.0]), &first_piola([p, 0.0, held]), 1e-13)?;
    }

    #[test]
    fn blatz_ko_equibiaxial(g in 0.1..10.0, l in 0.3..3.0_f64) {
        let l3 = l.powf(-2.0 / 3.0);
        let p = g * (l.powf(1.0 / 3.0) - l.powi(-3));
        check_homogeneous(&blatz_ko(g), &stretched([l, l, l3]), &first_piola([p, p, 0.0]), 1e-13)?;
    }

    #[test]
    fn blatz_ko_confined(g in 0.1..10.0, l in 0.3..3.0_f64) {
        let (p, side) = (g * (1.0 - l.powi(-3)), g * (l - 1.0));
        check_homogeneous(&blatz_ko(g), &stretched([l, 1.0, 1.0]), &first_piola([p, side, side]), 1e-13)?;
    }

    #[test]
    fn blatz_ko_simple_shear(g in 0.1..10.0_f64, k in -3.0..3.0) {
        let sigma = Symmetric::new(0.0, -g * k * k, 0.0, g * k, 0.0, 0.0);
        check_homogeneous(&blatz_ko(g), &simple_shear(k), &ClosedForm::Cauchy(sigma), 1e-13)?;
    }

    #[test]
    fn saint_venant_kirchhoff_uniaxial_strain(g in 0.1..10.0, bulk in 0.1..10.0, l in 0.3..3.0) {
        let law = saint_venant_kirchhoff(g, bulk);
        let lame = bulk - 2.0 * g / 3.0;
        let strain = (l * l - 1.0) / 2.0;
        let expected = first_piola([(lame + 2.0 * g) * l * strain, lame * strain, lame * strain]);
        check_homogeneous(&law, &stretched([l, 1.0, 1.0]), &expected, 1e-13)?;
    }

    #[test]
    fn neo_hookean_confined(g in 0.1..10.0, lame in 0.0..10.0, l in 0.3..3.0_f64) {
        let side = lame * l.ln();
        let p = g * (l - 1.0 / l) + side / l;
        check_homogeneous(&neo_hookean(g, lame), &stretched([l, 1.0, 1.0]), &first_piola([p, side, side]), 1e-13)?;
    }

    #[test]
    fn neo_hookean_simple_shear(g in 0.1..10.0, lame in 0.0..10.0, k in -3.0..3.0) {
        let sigma = Symmetric::new(g * k * k, 0.0, 0.0, g * k, 0.0, 0.0);
        check_homogeneous(&neo_hookean(g, lame), &simple_shear(k), &ClosedForm::Cauchy(sigma), 1e-13)?;
    }

    #[test]
    fn neo_hookean_dilated(g in 0.1..10.0, lame in 0.0..10.0, l in 0.3..3.0_f64) {
        let p = g * (l - 1.0 / l) + 3.0 * lame * l.ln() / l;
        check_homogeneous(&neo_hookean(g, lame), &stretched([l; 3]), &first_piola([p; 3]), 1e-13)?;
    }

    /// Along the axis of uniaxial strain `e` the invariants are `x = sqrt(2/3) e`, `y = 0`, `z = e/sqrt 3`, and
    /// `S_11 = dW/de`.
    #[test]
    fn three_e_uniaxial_strain(law in any_three_e(), l in 0.3..3.0) {
        let [a1, a2, a3, a4, a5] = law.parameters();
        let moduli = law.small_strain_moduli();
        let e: f64 = (l * l - 1.0) / 2.0;
        let dx = (2.0_f64 / 3.0).sqrt();
        let dz = 1.0 / 3.0_f64.sqrt();
        let s = 2.0 * (moduli.shear_modulus() * dx * dx + 1.5 * moduli.bulk_modulus() * dz * dz) * e
            + (a1 * dx.powi(3) + a2 * dz.powi(3)) * e.powi(2)
            + (a3 * dx * dx * dz * dz + a4 * dz.powi(4) + a5 * dx.powi(4)) * e.powi(3);
        let f = stretched([l, 1.0, 1.0]);
        let response = law.response(&right_cauchy_green(&f)).unwrap();
        // The sides come from z alone and the deviator: compare the axial force, and the sides from
        // tr S = sqrt 3 dW/dz.
        let z = e * dz;
        let trace = 3.0_f64.sqrt() * (z * (3.0 * moduli.bulk_modulus() + a2 * z + a4 * z * z) + 0.5 * a3 * z * (dx * e).powi(2));
        let side = 0.5 * (trace - s);
        check_homogeneous(&law, &f, &first_piola([l * s, side, side]), 1e-13)?;
        prop_assert!(response.energy > 0.0 || e == 0.0);
    }

    /// The energy as printed, with the invariants by their definition: roots, Lode angle and all.
    #[test]
    fn three_e_is_the_printed_energy(law in any_three_e(), l in any_stretches(), q in any_rotation()) {
        let strains = l.map(|l: f64| 0.5 * (l * l - 1.0));
        let mean = strains.iter().sum::<f64>() / 3.0;
        let deviator = strains.map(|e| e - mean);
        let radius = deviator.iter().map(|e| e * e).sum::<f64>().sqrt();
        prop_assume!(radius > 1e-3);
        let cosine = 3.0 * 6.0_f64.sqrt() * deviator.iter().product::<f64>() / radius.powi(3);
        let angle = cosine.clamp(-1.0, 1.0).acos() / 3.0;
        let (x, y, z) = (radius * angle.cos(), radius * angle.sin(), 3.0 * mean / 3.0_f64.sqrt());
        let [a1, a2, a3, a4, a5] = law.parameters();
        let moduli = law.small_strain_moduli();
        let (g, k, q2) = (moduli.shear_modulus(), moduli.bulk_modulus(), x * x + y * y);
        let w = (g + a3 / 4.0 * z * z) * q2 + 1.5 * k * z * z + a1 / 3.0 * (x.powi(3) - 3.0 * x * y * y)
            + a2 / 3.0 * z.powi(3) + a4 / 4.0 * z.powi(4) + a5 / 4.0 * q2 * q2;
        let found = law.energy(&right_cauchy_green(&turned_and_stretched(l, &q))).unwrap();
        prop_assert!((found - w).abs() <= 1e-11 * w.abs().max(1.0), "{found} against {w}");
    }

    #[test]
    fn three_e_without_parameters_is_saint_venant_kirchhoff(
        g in 0.1..10.0, bulk in 0.1..10.0, l in any_stretches(), q in any_rotation(),
    ) {
        let c = right_cauchy_green(&turned_and_stretched(l, &q));
        let one = three_e(g, bulk, [0.0; 5]).response(&c).unwrap();
        let other = saint_venant_kirchhoff(g, bulk).response(&c).unwrap();
        prop_assert!((one.energy - other.energy).abs() <= 1e-12 * other.energy);
        for i in 0..6 {
            prop_assert!((one.stress[i] - other.stress[i]).abs() <= 1e-12 * (1.0 + g + bulk));
            for j in 0..6 {
                prop_assert!((one.tangent[(i, j)] - other.tangent[(i, j)]).abs() <= 1e-14 * (g + bulk));
            }
        }
    }
}

/// `P = (lambda + 2 G) l (l^2 - 1)/2` is largest in compression at `l = 1/sqrt 3`.
#[test]
fn convex_in_e_gives_way_at_the_documented_stretch() {
    fn weakest_stretch(law: &impl Material) -> f64 {
        let force = |l: f64| l * law.stress(&diagonal([l * l, 1.0, 1.0])).unwrap().1[0];
        let stretches = (1..10_000).map(|i| f64::from(i) * 1e-4);
        stretches
            .min_by(|a, b| force(*a).total_cmp(&force(*b)))
            .unwrap()
    }
    let exact = 1.0 / 3.0_f64.sqrt();
    assert!((weakest_stretch(&saint_venant_kirchhoff(1.0, 2.0)) - exact).abs() < 1e-4);
    assert!((weakest_stretch(&three_e(2.0, 3.0, [0.1, 0.1, 0.1, 0.1, 0.1])) - exact).abs() < 0.01);
    // The others resist to the end of the range.
    assert!(weakest_stretch(&blatz_ko(1.0)) < 2e-4);
    assert!(weakest_stretch(&neo_hookean(1.0, 1.0)) < 2e-4);
}
