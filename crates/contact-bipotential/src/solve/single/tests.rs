use super::*;
use nalgebra::{Matrix1, Matrix2, Matrix3, Vector1, Vector2, Vector3};
use proptest::prelude::*;

/// Scale-free residual of one contact \[-\].
fn single_residual<const D: usize>(w: &Matrix<D>, b: &Vector<D>, mu: f64, r: &Vector<D>) -> f64 {
    SingleContact::new(w).residual_of(b, r, mu)
}

fn by_rows(rows: [[f64; 3]; 3]) -> Matrix3<f64> {
    Matrix3::from(rows).transpose()
}

/// A small generator of our own: a million cases need neither shrinking nor strategies.
struct Random(u64);

impl Random {
    fn unit(&mut self) -> f64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }

    fn sign(&mut self) -> f64 {
        2.0 * self.unit() - 1.0
    }

    fn direction(&mut self) -> Vector3<f64> {
        loop {
            let v = Vector3::new(self.sign(), self.sign(), self.sign());
            let n = v.norm();
            if n > 1e-2 && n <= 1.0 {
                return v / n;
            }
        }
    }

    /// Positive definite, largest eigenvalue 1, condition up to `10^decades`, axes anywhere.
    fn compliance(&mut self, decades: f64) -> Matrix<3> {
        let a = self.direction();
        let mut b = self.direction();
        b -= a * a.dot(&b);
        let length = b.norm();
        if length < 1e-3 {
            return self.compliance(decades);
        }
        let b = b / length;
        let c = a.cross(&b);
        let e = [
            1.0,
            10f64.powf(-decades * self.unit()),
            10f64.powf(-decades * self.unit()),
        ];
        e[0] * a * a.transpose() + e[1] * b * b.transpose() + e[2] * c * c.transpose()
    }
}

#[test]
fn a_million_contacts_of_any_scale_are_solved() {
    let mut random = Random(88_172_645_463_325_252);
    let mut seen = [0usize; 3];
    for k in 0..1_000_000 {
        let mut w = random.compliance(8.0);
        let mu = if k % 20 == 0 {
            0.0
        } else {
            5.0 * random.unit()
        };
        let (size_w, size_b) = (
            10f64.powf(100.0 * random.sign()),
            10f64.powf(150.0 * random.sign()),
        );
        w *= size_w;
        let mut b = random.direction() * size_b;
        if k % 4 != 0 {
            b[2] = -b[2].abs();
        }
        let s = solve_single(&w, &b, mu);
        let error = single_residual(&w, &b, mu, &s.r);
        assert!(
            s.solved && error <= 1e-12,
            "{w:?} {b:?} {mu} {s:?} {error:e}"
        );
        seen[s.status as usize] += 1;
    }
    assert!(seen.iter().all(|n| *n > 100_000), "{seen:?}");
}

#[test]
fn odd_compliances_are_solved_or_reported() {
    let mut random = Random(7);
    let mut solved = 0;
    for k in 0..50_000 {
        let mut w = random.compliance(6.0);
        let v = random.direction();
        for i in 0..3 {
            for j in 0..3 {
                match k % 3 {
                    0 => w[(i, j)] += 1e-2 * random.sign(),
                    1 => w[(i, j)] = v[i] * v[j],
                    _ => w[(i, j)] = random.sign(),
                }
            }
        }
        let (b, mu) = (random.direction(), 5.0 * random.unit());
        let s = solve_single(&w, &b, mu);
        assert!(s.r.iter().all(|x| x.is_finite()));
        if s.solved {
            solved += 1;
            let error = single_residual(&w, &b, mu, &s.r);
            assert!(error <= 1e-12, "{w:?} {b:?} {mu} {s:?} {error:e}");
        }
    }
    assert!(solved > 25_000, "{solved}");
}

#[test]
fn a_slipping_contact_matches_a_scan_of_all_directions() {
    // Independent of the quartic: for a given sliding direction u_n = 0 fixes r_n, and friction must oppose the
    // velocity.
    let mut random = Random(99);
    let mut compared = 0;
    for _ in 0..400 {
        let w = random.compliance(1.0);
        let (b, mu) = (random.direction(), 0.2 + 0.5 * random.unit());
        let s = solve_single(&w, &b, mu);
        if s.status != Status::Slip {
            continue;
        }
        let mut best = (f64::MAX, Vector3::zeros());
        for k in 0..20_000 {
            let phi = k as f64 / 20_000.0 * std::f64::consts::TAU;
            let d = [phi.cos(), phi.sin()];
            let compliance = w[(2, 2)] - mu * (w[(2, 0)] * d[0] + w[(2, 1)] * d[1]);
            let n = -b[2] / compliance;
            let r = Vector3::new(-mu * n * d[0], -mu * n * d[1], n);
            let u = w * r + b;
            let along = u[0] * d[0] + u[1] * d[1];
            let across = (u[0] * d[1] - u[1] * d[0]).abs();
            if n > 0.0 && along > 0.0 && across / along < best.0 {
                best = (across / along, r);
            }
        }
        if best.0 > 1e-2 {
            continue;
        }
        compared += 1;
        let distance = (best.1 - s.r).amax();
        assert!(
            distance < 1e-2 * (1.0 + s.r.amax()),
            "{w:?} {b:?} {mu} {s:?} {best:?}"
        );
    }
    assert!(compared > 80, "{compared}");
}

#[test]
fn shrunk_cases_are_solved_or_reported() {
    let zero = [0.0; 3];
    let cases: [([[f64; 3]; 3], [f64; 3], f64); 5] = [
        // The reaction underflows.
        (
            [zero, zero, [0.0, 0.0, 3.224520935977679e210]],
            [0.0, 0.0, -1.8547187506717686e-206],
            0.0,
        ),
        // Indefinite, 250 decades between the entries.
        (
            [
                [-1257.3419868243782, 0.0, 0.0],
                [0.0, 5.624606992742704e-173, 0.0],
                [1.5326957495881328e249, 0.0, -3.616458022300388e145],
            ],
            [7.133405677725269e153, 0.0, -5.1810319435615666e-135],
            1.481806286339588e-58,
        ),
        // W over its scale overflows, and nothing touches.
        (
            [
                zero,
                zero,
                [0.0, 4.192966197290615e168, 1.7215259157381725e-175],
            ],
            [0.0, 0.0, 5.041945149682456e-92],
            0.0,
        ),
        // Singular, coupled one way only.
        (
            [zero, zero, [5.0980616997966634e290, 0.0, 0.0]],
            [3.40591653867447e-81, 0.0, -2.1050305133398648e-50],
            3.701101894506237e-70,
        ),
        ([[1.0; 3]; 3], [1e-320, 0.0, -1e-320], 0.3),
    ];
    for (rows, b, mu) in cases {
        let (w, b) = (by_rows(rows), Vector3::from(b));
        let s = solve_single(&w, &b, mu);
        assert!(s.r.iter().all(|x| x.is_finite()), "{s:?}");
        assert!(
            !s.solved || single_residual(&w, &b, mu, &s.r) <= 1e-12,
            "{s:?}"
        );
    }
}

#[test]
fn plane_and_frictionless_contacts_by_hand() {
    let w = Matrix2::new(2.0, 0.5, 0.5, 1.0);
    // Slides towards +t: r_t = -mu r_n, u_n = r_n (1 - .5 mu) - 1 = 0.
    let s = solve_single(&w, &Vector2::new(10.0, -1.0), 0.4);
    assert_eq!(s.status, Status::Slip);
    assert!((s.r[1] - 1.25).abs() < 1e-14 && (s.r[0] + 0.5).abs() < 1e-14);
    let s = solve_single(&w, &Vector2::new(-0.4, -1.0), 0.9);
    assert_eq!(s.status, Status::Stick);
    assert!((w * s.r + Vector2::new(-0.4, -1.0)).amax() < 1e-15);
    assert_eq!(
        solve_single(&w, &Vector2::new(3.0, 0.0), 0.9).r,
        Vector2::zeros()
    );
    let one = |b| solve_single(&Matrix1::new(4.0), &Vector1::new(b), 0.0);
    assert_eq!(one(-2.0).r, Vector1::new(0.5));
    assert_eq!(one(2.0).status, Status::Separate);
    assert_eq!(
        solve_single(
            &Matrix3::from_diagonal(&Vector3::new(1.0, 1.0, 2.0)),
            &Vector3::new(1.0, 1.0, -4.0),
            0.0
        )
        .r,
        Vector3::new(0.0, 0.0, 2.0)
    );
}

proptest! {
    #[test]
    fn plane_contacts_are_solved(
        a in 0.1..3.0_f64, c in 0.1..3.0_f64, k in -0.95..0.95_f64, b in prop::array::uniform2(-1.0..1.0_f64), mu in 0.0..5.0_f64
    ) {
        let off = k * (a * c).sqrt();
        let (w, b) = (Matrix2::new(a, off, off, c), Vector2::from(b));
        let s = solve_single(&w, &b, mu);
        prop_assert!(s.solved && single_residual(&w, &b, mu, &s.r) <= 1e-13);
    }

    #[test]
    fn nothing_makes_a_number_that_is_none(
        w in prop::array::uniform3(prop::array::uniform3(any::<f64>())), b in prop::array::uniform3(any::<f64>()), mu in prop_oneof![0.0..1e3_f64, Just(f64::NAN), Just(-1.0)]
    ) {
        let (w, b) = (by_rows(w), Vector3::from(b));
        let s = solve_single(&w, &b, mu);
        prop_assert!(s.r.iter().all(|x| x.is_finite()));
        if s.solved {
            let error = single_residual(&w, &b, mu, &s.r);
            prop_assert!(error <= 1e-12, "{s:?} {error:e}");
        }
    }

    #[test]
    fn powers_of_two_change_nothing_but_the_scale(
        b in prop::array::uniform3(-1.0..1.0_f64), mu in 0.0..2.0_f64, i in -40..40_i32, j in -40..40_i32
    ) {
        let (w, b) = (Matrix3::new(1.0, 0.2, -0.1, 0.2, 1.4, 0.3, -0.1, 0.3, 0.8), Vector3::from(b));
        let (fw, fb) = (2f64.powi(i), 2f64.powi(j));
        let plain = solve_single(&w, &b, mu);
        let scaled = solve_single(&(w * fw), &(b * fb), mu);
        prop_assert_eq!(scaled.status, plain.status);
        prop_assert_eq!(scaled.r, plain.r.map(|x| x * fb / fw));
    }
}
