//! Runs that reach their end and are not believed.

use scenarios::output::{Status, Summary};
use scenarios::spec::parse;

use crate::fresh_folder;

/// A bar that nothing holds, spinning about its middle.
const SPINNING: &str = r#"(
    title: "spinning bar",
    materials: {"m": (law: SaintVenantKirchhoff(E: 1.0e5, nu: 0.0), density: 1000.0)},
    bodies: {"bar": (mesh: Rectangle(min: (-1.0, -0.1), max: (1.0, 0.1), cells: (8, 1)), material: "m", spin: (0.0, 0.0, 2.0))},
    time: (end: 3.0, dt: 0.01),
    output: (fields_every: Never),
)"#;

/// A block that its prescribed base carries along: no force, no energy.
const CARRIED: &str = r#"(
    title: "carried block",
    materials: {"m": (law: NeoHookean(E: 1.0e6, nu: 0.3), density: 1000.0)},
    bodies: {"block": (mesh: Rectangle(min: (0.0, 0.0), max: (1.0, 1.0), cells: (3, 3)), material: "m")},
    motions: {"base": (nodes: "block.y_min", components: "xy",
        motion: Move(translation: ([(0.0, 0.0), (1.0, 0.7)], [(0.0, 0.0), (1.0, 0.1)], 0.0)))},
    time: (end: 1.0, dt: 0.1, inertia: QuasiStatic),
    output: (fields_every: Never),
)"#;

fn run(name: &str, text: &str, sets: &[&str]) -> Summary {
    let sets: Vec<_> = sets.iter().map(|set| set.parse().unwrap()).collect();
    let loaded = parse(name, text, &sets).unwrap();
    scenarios::run(&loaded, &fresh_folder(name), &mut |_| {}).unwrap()
}

#[test]
fn a_run_whose_steps_make_energy_is_unreliable_unless_the_scene_takes_it() {
    let good = run("spin", SPINNING, &[]);
    assert_eq!((good.status, good.reason), (Status::Completed, None));
    assert!(good.warnings.is_empty(), "{:?}", good.warnings);
    let long = ["time.dt=0.15", "time.end=12"];
    let bad = run("spin-long", SPINNING, &long);
    assert_eq!(bad.status, Status::Unreliable);
    let reason = bad.reason.unwrap();
    for words in ["made", "smaller time.dt", "accept: [EnergyGain]"] {
        assert!(reason.contains(words), "{words} in {reason}");
    }
    let taken = SPINNING.replace("time: (", "accept: [EnergyGain], time: (");
    let taken = run("spin-taken", &taken, &long);
    assert_eq!((taken.status, taken.reason), (Status::Completed, None));
    let told = taken
        .warnings
        .iter()
        .any(|w| w.contains("accepted (EnergyGain)"));
    assert!(told, "{:?}", taken.warnings);
}

#[test]
fn an_audit_that_does_not_close_is_unreliable() {
    let loose = run("loose", SPINNING, &["solver=(newton_tolerance: Some(0.3))"]);
    assert_eq!(loose.status, Status::Unreliable);
    let reason = loose.reason.unwrap();
    assert!(reason.contains("newton_tolerance"), "{reason}");
}

#[test]
fn a_run_without_any_energy_is_completed_and_without_warning() {
    let carried = run("carried", CARRIED, &[]);
    assert!(carried.energy.terms.load_work.abs() < 1e-6);
    assert_eq!((carried.status, carried.reason), (Status::Completed, None));
    assert!(carried.warnings.is_empty(), "{:?}", carried.warnings);
}

#[test]
fn damping_that_hides_all_other_forces_is_refused() {
    for (damping, bound) in [
        (
            "damping: (stiffness: 1e200)",
            "at most 1e12 time.dt = 1e10 [s]",
        ),
        (
            "damping: (mass: 1e15)",
            "at most 1e12 / time.dt = 1e14 [1/s]",
        ),
    ] {
        let text = SPINNING.replace("time: (", &format!("{damping}, time: ("));
        let told = parse("damped", &text, &[]).unwrap_err().to_string();
        assert!(told.contains(bound), "{told}");
    }
}

/// A soft block that turns and falls onto the ground `y = 0`.
fn falling(bottom: f64, time: &str, interface: &str) -> String {
    format!(
        r#"(
    title: "soft block on the ground",
    materials: {{"m": (law: NeoHookean(E: 8.0e6, nu: 0.4), density: 2000.0)}},
    bodies: {{"block": (mesh: Rectangle(min: (0.0, {bottom:e}), max: (0.5, {top:e}), cells: (2, 2), element: Quad9), material: "m",
        velocity: (0.5, -1.0, 0.0), spin: (0.0, 0.0, 1.5))}},
    loads: {{"weight": Gravity((0.0, -9.81, 0.0))}},
    interfaces: {{"ground": (slave: "block.y_min", master: Plane(point: (0.0, 0.0, 0.0), normal: (0.0, 1.0, 0.0)), {interface})}},
    time: (end: 0.4, dt: 0.004, {time}),
    output: (fields_every: Never),
)"#,
        top = bottom + 0.5
    )
}

/// Falls of a column over the largest energy of a run.
fn deepest_fall(name: &str, column: &str) -> f64 {
    let folder = std::path::PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join(name);
    let text = std::fs::read_to_string(folder.join("history.csv")).unwrap();
    let mut lines = text.lines();
    let header: Vec<&str> = lines.next().unwrap().split(',').collect();
    let at = |name: &str| header.iter().position(|h| *h == name).unwrap();
    let (column, kinetic) = (at(column), at("energy.kinetic"));
    let (mut highest, mut fall, mut most) = (0.0_f64, 0.0_f64, 0.0_f64);
    for line in lines {
        let row: Vec<f64> = line.split(',').map(|v| v.parse().unwrap()).collect();
        highest = highest.max(row[column]);
        fall = fall.max(highest - row[column]);
        most = most.max(row[kinetic]);
    }
    fall / most
}

#[test]
fn a_soft_body_never_bounces_higher_than_it_falls() {
    for (k, interface) in [
        "restitution: 0.8",
        "restitution: 1.0, mu: 0.3",
        "restitution: 0.0, mu: 0.1",
    ]
    .into_iter()
    .enumerate()
    {
        let name = format!("bounce-{k}");
        let done = run(&name, &falling(0.05, "contact: Velocity", interface), &[]);
        assert_eq!((done.status, &done.reason), (Status::Completed, &None));
        for column in ["dissipation.impact", "dissipation.friction"] {
            let fall = deepest_fall(&name, column);
            assert!(fall < 1e-5, "{interface}: {column} falls by {fall:e}");
        }
    }
}

#[test]
fn a_motion_that_starts_inside_its_master_is_refused_and_a_press_fit_is_not() {
    for time in [
        "contact: Position",
        "contact: Velocity",
        "theta: 1.0, xi: 1.0",
    ] {
        for bottom in [-0.01, -7.0] {
            let loaded = parse("inside", &falling(bottom, time, "mu: 0.0"), &[]).unwrap();
            let told = scenarios::run(&loaded, &fresh_folder("inside"), &mut |_| {});
            let told = told.unwrap_err().to_string();
            for words in ["interfaces.ground", "start inside their master", "nothing"] {
                assert!(told.contains(words), "{words} in {told}");
            }
        }
        let touching = parse("touching", &falling(-1e-12, time, "mu: 0.0"), &[]).unwrap();
        let done = scenarios::run(&touching, &fresh_folder("touching"), &mut |_| {}).unwrap();
        assert_eq!(done.status, Status::Completed, "{:?}", done.reason);
    }
    let pressed = CARRIED.replace(
        "time: (",
        r#"interfaces: {"wall": (slave: "block.y_max", master: Plane(point: (0.0, 0.95, 0.0), normal: (0.0, -1.0, 0.0)))}, time: ("#,
    );
    let pressed = run("pressed", &pressed, &[]);
    assert_eq!((pressed.status, pressed.reason), (Status::Completed, None));
}
