use proptest::prelude::*;

use super::*;

/// The law of the examples of [Hu2022].
fn law() -> Adhesion {
    Adhesion::new(2e9, 1.5e9, 20.0, 0.1)
}

fn bond(intensity: f64, gap: f64, separation: [f64; 2]) -> Bond {
    Bond {
        intensity,
        gap,
        separation,
    }
}

/// Pulls a bond along `path(t)` = (u_t1, u_t2, x_n) in `steps` equal steps to `end`; returns the bond and the sums of
/// energies.
fn follow(
    law: &Adhesion,
    mut at: Bond,
    end: f64,
    steps: usize,
    path: impl Fn(f64) -> [f64; 3],
) -> (Bond, BondEnergy) {
    let dt = end / steps as f64;
    let mut sum = BondEnergy::default();
    for k in 0..steps {
        let (from, to) = (path(k as f64 * dt), path((k + 1) as f64 * dt));
        let x = Vector3::new(to[0] - from[0], to[1] - from[1], to[2]);
        let step = BondStep::new(law, 1.0, dt, at, 0.0);
        let energy = step.energy(&x);
        sum.work += energy.work;
        sum.stored += energy.stored;
        sum.dissipated += energy.dissipated;
        at = step.finish(&x);
    }
    (at, sum)
}

#[test]
fn a_constant_gap_is_exact_for_any_step() {
    let law = law();
    let (gap, start, end) = (1.3e-4, 0.9, 4e-3);
    let k = 2e9 * gap * gap;
    let exact = (start - 20.0 / k) * (-k * end / 0.1_f64).exp() + 20.0 / k;
    for steps in [1, 2, 7, 1000] {
        let (at, _) = follow(&law, bond(start, gap, [0.0; 2]), end, steps, |_| {
            [0.0, 0.0, gap]
        });
        assert!(
            (at.intensity - exact).abs() < 1e-12,
            "{steps}: {}",
            at.intensity - exact
        );
    }
    // Healing in contact rises at w / b until the bond is intact.
    for (end, exact) in [(1e-3, 0.2), (4e-3, 0.8), (9e-3, 1.0)] {
        let (at, _) = follow(&law, bond(0.0, 0.0, [0.0; 2]), end, 3, |_| [0.0; 3]);
        assert!((at.intensity - exact).abs() < 1e-12);
    }
}

/// The closed form of the ramp `x = v t` from `beta = 1`, De = 1, at `x = 2 x0`.
#[test]
fn a_ramp_is_second_order() {
    const EXACT: f64 = 0.404_831_811_977_178;
    for update in [Update::SecondOrder, Update::EnergyConsistent] {
        let law = Adhesion { update, ..law() };
        let x0 = law.damage_gap();
        let speed = 20.0 * x0 / 0.1;
        let error = |steps: usize| {
            // Damage starts at x0: the steps start there.
            let (at, _) = follow(&law, bond(1.0, x0, [0.0; 2]), x0 / speed, steps, |t| {
                [0.0, 0.0, x0 + speed * t]
            });
            (at.intensity - EXACT).abs()
        };
        let slope = (error(200) / error(400)).log2();
        assert!((slope - 2.0).abs() < 0.1, "{update:?} {slope}");
        assert!(error(400) < 1e-5, "{update:?} {}", error(400));
    }
}

#[test]
fn the_work_of_separation_tends_to_w() {
    let far = 200.0_f64;
    let mut last = f64::MAX;
    for b in [1e-2, 1e-4, 1e-6, 0.0] {
        let law = Adhesion {
            viscosity: b,
            ..law()
        };
        let x0 = law.damage_gap();
        for path in [[0.0, 0.0, 1.0], [1.0, 0.0, 0.0]] {
            let reach = x0
                * if path[2] > 0.0 {
                    1.0
                } else {
                    (2e9_f64 / 1.5e9).sqrt()
                };
            // Geometric steps beyond the peak, by a path that slows down on its way.
            let along = |t: f64| reach * ((1.0 + far).powf(t) - 1.0);
            let (_, energy) = follow(&law, bond(1.0, 0.0, [0.0; 2]), 1.0, 20_000, |t| {
                path.map(|p| p * along(t))
            });
            let error = (energy.work - 20.0).abs() / 20.0;
            assert!(error <= last * 1.5, "b = {b}: {error}");
            if b <= 1e-6 {
                // What is left in the tail beyond 200 x0 is (x0 / x)^2 / 2.
                assert!(error < 1e-3, "b = {b}: {error}");
            }
            last = last.min(error.max(1e-3));
        }
    }
}

#[test]
fn the_energy_pair_closes() {
    let law = Adhesion {
        update: Update::EnergyConsistent,
        ..law()
    };
    let x0 = law.damage_gap();
    let wave = |t: f64| {
        let s = (2000.0 * t).sin();
        [
            x0 * s,
            0.4 * x0 * (1.0 - (900.0 * t).cos()),
            (1.5 * x0 * (1300.0 * t).sin()).max(0.0),
        ]
    };
    for steps in [10, 100, 1000] {
        let (_, energy) = follow(&law, bond(0.3, 0.0, [0.0; 2]), 8e-3, steps, wave);
        let error = energy.work - energy.stored - energy.dissipated;
        assert!(error.abs() < 1e-14 * 20.0 * steps as f64, "{steps} {error}");
    }
}

#[test]
fn healing_needs_contact_and_a_law_that_heals() {
    let law = law();
    let parted = |law: &Adhesion, gap| {
        BondStep::new(law, 1.0, 1e-3, bond(0.2, gap, [0.0; 2]), 0.0)
            .intensity(&Vector3::new(0.0, 0.0, gap))
            .0
    };
    assert!(parted(&law, 0.0) > 0.3);
    assert_eq!(parted(&law, 1e-6), 0.2);
    let near = Adhesion {
        healing_gap: 2e-6,
        ..law
    };
    assert!(parted(&near, 1e-6) > 0.3);
    let never = Adhesion {
        healing: Healing::Irreversible,
        ..law
    };
    assert_eq!(parted(&never, 0.0), 0.2);
    assert!(parted(&never, 1e-3) < 0.2);
}

#[test]
fn a_parted_broken_bond_forgets_and_an_ageing_one_relaxes() {
    let law = law();
    let far = Vector3::new(0.0, 0.0, 0.1);
    let step = BondStep::new(&law, 1.0, 1.0, bond(0.5, 1e-3, [1e-4, 0.0]), 0.0);
    assert_eq!(step.finish(&far), bond(0.0, 0.1, [0.0; 2]));
    let ageing = Adhesion {
        reference: Reference::Ageing,
        ..law
    };
    let (at, _) = follow(&ageing, bond(1.0, 0.0, [1e-5, -2e-5]), 5e-3, 4000, |_| {
        [0.0; 3]
    });
    let exact = (-20.0 / 0.1 * 5e-3_f64).exp();
    assert!(
        (at.separation[0] / 1e-5 - exact).abs() < 1e-3
            && (at.separation[1] / -2e-5 - exact).abs() < 1e-3
    );
    // New bonds are unstressed.
    let new = BondStep::new(&ageing, 1.0, 1e-3, Bond::default(), 0.0);
    assert_eq!(
        new.finish(&Vector3::new(1e-5, 0.0, 0.0)).separation,
        [0.0; 2]
    );
}

#[test]
fn a_bond_that_never_formed_takes_any_slip() {
    let law = Adhesion {
        healing: Healing::Irreversible,
        reference: Reference::Ageing,
        update: Update::EnergyConsistent,
        ..law()
    };
    let step = BondStep::new(&law, 1.0, 1e-3, bond(0.0, 0.0, [0.0; 2]), 0.0);
    let slip = Vector3::new(45.0, -1e9, 0.0);
    let energy = step.energy(&slip);
    assert_eq!([energy.work, energy.stored, energy.dissipated], [0.0; 3]);
    assert_eq!(step.at(&slip).force.abs(), Vector3::zeros());
}

#[test]
fn parameters_out_of_bounds_are_refused_with_the_bound() {
    let bad = [
        Adhesion {
            energy: -1.0,
            ..law()
        },
        Adhesion {
            viscosity: -0.1,
            ..law()
        },
        Adhesion {
            normal_stiffness: f64::NAN,
            ..law()
        },
        Adhesion {
            normal_stiffness: 0.0,
            tangential_stiffness: [0.0; 2],
            ..law()
        },
        Adhesion {
            initial: 1.1,
            ..law()
        },
        Adhesion {
            threshold: 0.0,
            ..law()
        },
        Adhesion {
            healing: Healing::Irreversible,
            healing_gap: 1e-6,
            ..law()
        },
        Adhesion {
            update: Update::EnergyConsistent,
            viscosity: 0.0,
            ..law()
        },
        Adhesion {
            bonded_friction: Some(-0.1),
            ..law()
        },
    ];
    for law in bad {
        assert!(law.validated().is_err(), "{law:?}");
    }
    assert!(law().validated().is_ok());
}

fn laws() -> impl Strategy<Value = Adhesion> {
    let numbers = (
        0.0..1.0_f64,
        0.0..1.0_f64,
        0.0..1.0_f64,
        -4.0..1.0_f64,
        0.0..1e-5_f64,
    );
    (numbers, any::<[bool; 3]>()).prop_map(|((n, t1, t2, b, healing_gap), [pair, never, ages])| {
        Adhesion {
            normal_stiffness: 2e9 * n,
            tangential_stiffness: [2e9 * t1, 2e9 * t2],
            viscosity: 10.0_f64.powf(b),
            healing_gap: if never { 0.0 } else { healing_gap },
            healing: if never {
                Healing::Irreversible
            } else {
                Healing::Recoverable
            },
            reference: if ages {
                Reference::Ageing
            } else {
                Reference::Reset
            },
            update: if pair {
                Update::EnergyConsistent
            } else {
                Update::SecondOrder
            },
            ..law()
        }
    })
}

fn bonds() -> impl Strategy<Value = Bond> {
    let length = || prop_oneof![Just(0.0), -3e-4..3e-4_f64];
    (
        prop_oneof![Just(0.0), Just(1.0), 0.0..1.0_f64],
        length(),
        length(),
        length(),
    )
        .prop_map(|(intensity, gap, a, b)| bond(intensity, gap.abs(), [a, b]))
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    #[test]
    fn intensity_stays_in_bounds_and_dissipation_is_never_negative(
        law in laws(), start in bonds(), logdt in -9.0..0.0_f64, x in prop::array::uniform3(-3e-4..3e-4_f64), closed in any::<bool>(),
    ) {
        let x = Vector3::new(x[0], x[1], if closed { 0.0 } else { x[2] });
        let step = BondStep::new(&law, 1e-7, 10.0_f64.powf(logdt), start, 0.0);
        let (beta, _) = step.intensity(&x);
        prop_assert!((0.0..=1.0).contains(&beta), "{beta}");
        let energy = step.energy(&x);
        prop_assert!(energy.dissipated >= 0.0);
        if law.update == Update::EnergyConsistent && law.reference == Reference::Reset && x[2] >= 0.0 {
            let scale = 1e-7 * (law.energy + law.strain(&start.separation, start.gap)) + energy.work.abs();
            prop_assert!((energy.work - energy.stored - energy.dissipated).abs() <= 1e-13 * scale);
        }
        let never = law.healing == Healing::Irreversible;
        prop_assert!(!never || beta <= start.intensity);
    }

    #[test]
    fn stiffness_is_the_derivative_of_the_force(
        law in laws(), start in bonds(), logdt in -6.0..-1.0_f64, x in prop::array::uniform3(-3e-4..3e-4_f64),
    ) {
        let x = Vector3::from(x);
        let step = BondStep::new(&law, 1e-7, 10.0_f64.powf(logdt), start, 0.0);
        let at = step.at(&x);
        let h = 1e-9;
        let smooth = |f: &dyn Fn(&Vector3<f64>) -> f64, j: usize| {
            let moved = |s: f64| { let mut y = x; y[j] += s * h; f(&y) };
            ((moved(1.0) - moved(-1.0)) / (2.0 * h), (moved(1.0) - 2.0 * f(&x) + moved(-1.0)).abs() / h)
        };
        let size = 1e-7 * 2e9 * (1.0 + step.law.strain(&start.separation, start.gap) * step.dt / step.law.viscosity).min(10.0);
        for j in 0..3 {
            // A kink (a bond that becomes intact, contact) is no place for a difference.
            let (_, kink) = smooth(&|y| step.intensity(y).0, j);
            prop_assume!(kink < 1e-2 / 3e-4 * 10.0 && (x[2].abs() > 2.0 * h) && (x[2] - law.healing_gap).abs() > 2.0 * h);
            for i in 0..3 {
                let (slope, bend) = smooth(&|y| step.at(y).force[i], j);
                prop_assume!(bend < 1e-4 * size);
                prop_assert!((slope + at.stiffness[(i, j)]).abs() < 1e-4 * size, "{i}{j}: {slope} {}", -at.stiffness[(i, j)]);
            }
        }
    }
}
