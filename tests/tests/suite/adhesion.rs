//! Bonds that break, heal and carry again, through the whole chain.

use contact_bipotential::rcc::{Adhesion, Healing, Update};

use crate::common::{Run, scene_text, try_run_built};

/// Two unit cubes of `E = 1 MPa` without lateral strain in one another's way: pressed together for .6 s, pulled apart
/// by .1 m, closed again for .6 s, pulled again. Bonds soften at .01 m and heal at 2 per second.
const PULL: &str = r#"(
    title: "pull, close, pull",
    materials: {"m": (law: SaintVenantKirchhoff(E: 1.0e6, nu: 0.0), density: 1.0)},
    bodies: {
        "low": (mesh: Box(min: (0.0, 0.0, 0.0), max: (1.0, 1.0, 1.0), cells: (2, 2, 1)), material: "m"),
        "high": (mesh: Box(min: (0.0, 0.0, 1.0), max: (1.0, 1.0, 2.0), cells: (2, 2, 1)), material: "m"),
    },
    motions: {
        "bottom": (nodes: "low.z_min", components: "xyz"),
        "top": (nodes: "high.z_max", components: "xyz", motion: Move(translation: (0.0, 0.0,
            [(0.0, 0.0), (0.1, -0.001), (0.6, -0.001), (0.7, 0.0), (1.7, 0.1), (2.7, 0.0), (2.8, -0.001), (3.3, -0.001), (3.4, 0.0), (4.4, 0.1)]))),
    },
    interfaces: {"joint": (slave: "high.z_min", master: Facets("low.z_max"), mu: 0.3)},
    time: (end: 4.4, dt: 0.01, inertia: QuasiStatic),
    output: (fields_every: Never),
)"#;

fn law() -> Adhesion {
    Adhesion::new(1e5, 1e5, 10.0, 5.0)
}

fn rate_independent() -> Adhesion {
    Adhesion::new(1e5, 1e5, 10.0, 0.0)
}

fn pulled(law: Adhesion, sets: &[&str]) -> Run {
    let loaded = scene_text(PULL, sets);
    let mut built = scenarios::build(&loaded).unwrap();
    built.model.interfaces[0].adhesion = Some(law);
    let run = try_run_built(built);
    assert!(run.end.is_ok(), "{:?}", run.end);
    run
}

/// Time, force on the upper block and intensity of every step; all bonds do the same.
fn curve(run: &Run) -> Vec<[f64; 3]> {
    let one = |step: &crate::common::Step| {
        let betas: Vec<f64> = step.state.bonds[0].iter().map(|b| b.intensity).collect();
        assert!(
            betas.iter().all(|b| (b - betas[0]).abs() < 1e-8),
            "{betas:?}"
        );
        [
            step.report.time,
            step.report.interfaces[0].force[2],
            betas[0],
        ]
    };
    run.steps.iter().map(one).collect()
}

fn at(curve: &[[f64; 3]], t: f64) -> [f64; 3] {
    *curve
        .iter()
        .min_by(|a, b| (a[0] - t).abs().total_cmp(&(b[0] - t).abs()))
        .unwrap()
}

/// Deepest pull between two times \[N\].
fn peak(curve: &[[f64; 3]], from: f64, to: f64) -> f64 {
    let within = curve.iter().filter(|c| c[0] >= from && c[0] <= to);
    within.fold(0.0, |m: f64, c| m.max(-c[1]))
}

/// The same history of one spring against one bond, by small explicit steps of its own.
fn peak_by_hand() -> f64 {
    let (mut beta, mut gap, mut peak) = (1.0_f64, 0.0_f64, 0.0_f64);
    let (c, w, b) = (1e5, 10.0, 5.0);
    let steps = 200_000;
    let dt = 1.0 / steps as f64;
    for k in 1..=steps {
        let delta = 0.1 * dt * k as f64;
        // Series of a bond and 2 m of block: E (e + 3/2 e^2 + e^3 / 2) = beta^2 c gap with e = (delta - gap) / 2.
        for _ in 0..3 {
            let e = 0.5 * (delta - gap);
            let residual = 1e6 * e * (1.0 + e * (1.5 + 0.5 * e)) - beta * beta * c * gap;
            gap += residual / (0.5e6 * (1.0 + 3.0 * e) + beta * beta * c);
        }
        beta = (beta + dt / b * (w - c * gap * gap * beta))
            .min(1.0)
            .min(beta);
        peak = peak.max(beta * beta * c * gap);
    }
    peak
}

#[test]
fn bonds_break_heal_and_carry_again() {
    for update in [Update::SecondOrder, Update::EnergyConsistent] {
        let run = pulled(law().with_update(update), &[]);
        run.assert_audited(10.0, 1e-9);
        let curve = curve(&run);
        // Bonds form at w / b from the first contact.
        assert!(
            (at(&curve, 0.3)[2] - 0.6).abs() < 1e-9,
            "{:?}",
            at(&curve, 0.3)
        );
        assert!((at(&curve, 0.65)[2] - 1.0).abs() < 1e-12);
        let (first, second) = (peak(&curve, 0.7, 1.7), peak(&curve, 3.4, 4.4));
        let exact = peak_by_hand();
        assert!(
            (first / exact - 1.0).abs() < 0.01,
            "{update:?} {first} {exact}"
        );
        assert!((second / first - 1.0).abs() < 1e-6, "{first} {second}");
        let broken = at(&curve, 2.69)[2];
        assert!(broken < 0.1, "{broken}");
        assert!(
            (at(&curve, 3.0)[2] - broken - 2.0 * 0.3).abs() < 0.03,
            "{} {broken}",
            at(&curve, 3.0)[2]
        );
        assert!(run.totals.energy.bond > 0.0 && run.counters.bonded_solves > 0);
    }
}

#[test]
fn an_irreversible_bond_never_heals() {
    let glue = law().with_initial(1.0).with_healing(Healing::Irreversible);
    let run = pulled(glue, &[]);
    run.assert_audited(10.0, 1e-9);
    let curve = curve(&run);
    assert!(curve.windows(2).all(|c| c[1][2] <= c[0][2]));
    assert!(peak(&curve, 0.7, 1.7) > 500.0 && peak(&curve, 3.4, 4.4) < 10.0);
}

#[test]
fn the_integration_error_of_bonds_vanishes_with_the_step() {
    let error = |dt: &str| {
        let run = pulled(law(), &[dt]);
        assert!(run.totals.rejections.is_empty());
        run.totals.energy.bond_error.abs()
    };
    let (coarse, fine) = (error("dt=0.01"), error("dt=0.005"));
    assert!(fine < 0.6 * coarse, "{coarse} {fine}");
    let pair = law().with_update(Update::EnergyConsistent);
    assert!(pulled(pair, &[]).totals.energy.bond_error.abs() < 1e-3 * coarse);
}

/// Without bonds that could act, the run does what it does without the law, to the last bit.
#[test]
fn adhesion_that_cannot_act_costs_nothing() {
    let apart = [
        "high.mesh.min=(0.0, 0.0, 1.5)",
        "high.mesh.max=(1.0, 1.0, 2.5)",
        "end=0.5",
    ];
    let with = pulled(law(), &apart);
    let loaded = scene_text(PULL, &apart);
    let without = crate::common::try_run(&loaded);
    assert_eq!(with.counters, without.counters);
    assert_eq!(
        (with.counters.bonded_solves, with.counters.contact_solves),
        (0, 0)
    );
    assert_eq!(with.last().state.u, without.last().state.u);
}

/// Rate-independent bonds on bodies softer than the bonds' softening jump; viscous ones of the same strength do not.
#[test]
fn an_interface_that_snaps_is_cut_and_then_stops_with_that_reason() {
    let soft = [
        "m.law=SaintVenantKirchhoff(E: 4.0e4, nu: 0.0)",
        "time.end=1.7",
        "min_dt=0.001",
    ];
    let snapping = rate_independent().with_initial(1.0);
    let loaded = scene_text(PULL, &soft);
    let mut built = scenarios::build(&loaded).unwrap();
    built.model.interfaces[0].adhesion = Some(snapping);
    let run = try_run_built(built);
    let reason = format!("{}", run.end.as_ref().unwrap_err());
    assert!(reason.contains("snaps at node"), "{reason}");
    assert!(run.counters.rejected_steps >= 3 && run.last().report.time > 0.7);
    run.assert_audited(10.0, 1e-9);
    // The bonds held until the jump: 2 m of E = 4e4 carry s0 = 1000 N when stretched by .05 m.
    assert!(run.last().state.bonds[0].iter().all(|b| b.intensity > 0.9));
}

/// The rate-independent limit on a stiff body needs no cutting: peak s0 at x0, work of separation w.
#[test]
fn without_viscosity_the_peak_is_the_strength_of_the_bond() {
    let run = pulled(rate_independent(), &["dt=0.0025", "time.end=1.7"]);
    assert!(run.totals.rejections.is_empty());
    run.assert_audited(10.0, 1e-9);
    let strength = (10.0_f64 * 1e5).sqrt();
    let reached = peak(&curve(&run), 0.7, 1.7);
    assert!(
        reached <= strength * (1.0 + 1e-9) && reached > 0.99 * strength,
        "{reached}"
    );
    assert_eq!(run.totals.energy.bond, 0.0);
}

/// A stretched bond whose body and master turn together by a right angle: nothing happens to it.
#[test]
fn a_bond_that_turns_with_its_bodies_notices_nothing() {
    const TURN: &str = r#"(
    title: "open bond turned by 90 degrees",
    materials: {"m": (law: BlatzKo(G: 1.0e8), density: 1.0)},
    bodies: {"b": (mesh: Rectangle(min: (-0.5, 0.0), max: (0.5, 0.5), cells: (2, 1)), material: "m")},
    motions: {
        "lift": (nodes: "b.y_max", components: "xy", motion: Move(
            translation: (TX, TY, 0.0),
            rotation: Some((point: (0.0, 0.0, 0.0), axis: (0.0, 0.0, 1.0), angle: [(1.0, 0.0), (2.0, 1.5707963267948966)])))),
    },
    interfaces: {"g": (
        slave: "b.y_min", master: Plane(point: (0.0, 0.0, 0.0), normal: (0.0, 1.0, 0.0)), mu: 0.0, search_distance: Some(0.001),
        motion: Move(translation: (0.0, 0.0, 0.0),
            rotation: Some((point: (0.0, 0.0, 0.0), axis: (0.0, 0.0, 1.0), angle: [(1.0, 0.0), (2.0, 1.5707963267948966)]))),
    )},
    time: (end: 2.0, dt: 0.02, inertia: QuasiStatic),
    output: (fields_every: Never),
)"#;
    // Lifted by 4 mm, then about the origin: the lift turns too.
    let path = |f: &dyn Fn(f64) -> f64| {
        let turn = (0..=50).map(|k| f64::from(k) / 50.0);
        let points: Vec<String> = turn
            .map(|s| format!("({:?}, {:?})", 1.0 + s, f(s * std::f64::consts::FRAC_PI_2)))
            .collect();
        format!("[(0.0, 0.0), {}]", points.join(", "))
    };
    let text = TURN
        .replace("TX", &path(&|a| -0.004 * a.sin()))
        .replace("TY", &path(&|a| 0.004 * a.cos()));
    let mut built = scenarios::build(&scene_text(&text, &[])).unwrap();
    built.model.interfaces[0].adhesion = Some(law().with_initial(1.0));
    let run = try_run_built(built);
    assert!(run.end.is_ok(), "{:?}", run.end);
    run.assert_audited(10.0, 1e-9);
    let lifted = run.steps.iter().find(|s| s.report.time > 0.999).unwrap();
    let change = run.last().state.adhesive_energy - lifted.state.adhesive_energy;
    assert!(change.abs() < 1e-6 * 10.0, "{change}");
    let (before, after) = (
        lifted.report.interfaces[0].force,
        run.last().report.interfaces[0].force,
    );
    let pull = before[1];
    // The pull against the plane has turned with it: from -y to +x.
    assert!(
        pull < -300.0
            && (after[0] + pull).abs() < 1e-3 * pull.abs()
            && after[1].abs() < 1e-3 * pull.abs(),
        "{before:?} {after:?}"
    );
    // The gap is four times the distance that is searched without bonds.
    assert_eq!(run.counters.lost_bonds, 0);
    assert!(
        run.last().state.bonds[0]
            .iter()
            .all(|b| b.intensity > 0.99 && b.gap > 0.0039)
    );
}
