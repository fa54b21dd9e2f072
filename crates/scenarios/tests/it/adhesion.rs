//! Adhesion in a scene: what it means, what is refused.

use contact_bipotential::rcc;
use scenarios::build;
use scenarios::output::{History, Status};
use scenarios::spec::{Adhesion, Healing, Reference, Update, parse};

use crate::fresh_folder;
use crate::refusals::refused;
use crate::scene::{SMALL, changed};
use crate::vtu_reader::Vtu;

const FULL: &str = "adhesion: (C_n: 2.0e9, C_t: (1.0e9, 3.0e9), w: 20.0, b: 0.1, epsilon: 1.0e-3, healing_gap: 1.0e-6, \
                    beta: 0.5, healing: Recoverable, reference: Ageing, update: EnergyConsistent, mu_bonded: 0.7), mu: 0.4";

#[test]
fn every_field_arrives_in_the_law() {
    let loaded = changed("mu: 0.4", FULL).unwrap();
    let built = build(&loaded).unwrap();
    let law = built.model.interfaces[0].adhesion.unwrap();
    assert_eq!(
        law,
        rcc::Adhesion::new(2e9, 1e9, 20.0, 0.1)
            .with_tangential_stiffness([1e9, 3e9])
            .with_threshold(1e-3)
            .with_healing_gap(1e-6)
            .with_initial(0.5)
            .with_healing(rcc::Healing::Recoverable)
            .with_reference(rcc::Reference::Ageing)
            .with_update(rcc::Update::EnergyConsistent)
            .with_bonded_friction(Some(0.7))
    );
}

#[test]
fn defaults_are_those_of_the_paper() {
    let text = "adhesion: (C_n: 2.0e9, C_t: 1.0e9, w: 20, b: 0.1), mu: 0.4";
    let loaded = changed("mu: 0.4", text).unwrap();
    let Adhesion {
        tangential_stiffness,
        threshold,
        healing_gap,
        initial,
        healing,
        reference,
        update,
        bonded_friction,
        ..
    } = loaded.scene.interfaces["ground"].adhesion.unwrap();
    assert_eq!(tangential_stiffness.pair(), [1e9; 2]);
    assert_eq!((threshold, healing_gap, initial), (1e-4, 0.0, 0.0));
    assert_eq!(healing, Healing::Recoverable);
    assert_eq!((reference, update), (Reference::Reset, Update::SecondOrder));
    assert_eq!(bonded_friction, None);
    let set = |set: &str| parse("small.ron", &loaded.source.text, &[set.parse().unwrap()]);
    let bonds = set("C_t=(1, 2)").unwrap().scene.interfaces["ground"].adhesion;
    assert_eq!(bonds.unwrap().tangential_stiffness.pair(), [1.0, 2.0]);
    let off = set("adhesion=None").unwrap();
    assert_eq!(off.scene.interfaces["ground"].adhesion, None);
    assert!(parse("small.ron", SMALL, &["w=1".parse().unwrap()]).is_err());
}

#[test]
fn bonds_are_followed_further_than_facets() {
    let reach = |text: &str| {
        let built = build(&changed("mu: 0.4", text).unwrap()).unwrap();
        built.model.interfaces[0].search_distance
    };
    let dry = reach("mu: 0.4");
    assert!((dry - 0.5_f64.sqrt()).abs() < 1e-15);
    // sqrt(w / C_n) = 0.1 against facets of 0.7, then 1e-4.
    assert!((reach("adhesion: (C_n: 100, C_t: 1, w: 1, b: 1)") - 1.0).abs() < 1e-15);
    assert_eq!(reach("adhesion: (C_n: 2e9, C_t: 1, w: 20, b: 1)"), dry);
    assert_eq!(reach("adhesion: (C_n: 0, C_t: 1, w: 20, b: 1)"), dry);
    let given = "search_distance: 0.25, adhesion: (C_n: 100, C_t: 1, w: 1, b: 1)";
    assert_eq!(reach(given), 0.25);
    for slip in ["1e-12", "1e12"] {
        let given = changed("mu: 0.4", &format!("search_distance: {slip}")).unwrap();
        let told = build(&given).unwrap_err().to_string();
        assert!(
            told.contains("interfaces.ground") && told.contains("out of proportion"),
            "{told}"
        );
    }
}

/// The adhesion of the paper with one more or another field is refused at that field.
fn bad(fields: &str, place: &str, path: &str, words: &[&str]) {
    let to = format!("adhesion: ({fields})");
    let path = format!("interfaces.ground.adhesion{path}");
    refused("mu: 0.4", &to, place, &path, words);
}

#[test]
fn values_without_meaning_are_refused_at_their_field() {
    let rest = "C_t: 1, b: 1";
    bad(
        &format!("C_n: 1, w: -3, {rest}"),
        "-3",
        ".w",
        &["0 or more", "J/m^2"],
    );
    bad(&format!("C_n: -7, w: 1, {rest}"), "-7", ".C_n", &["N/m^3"]);
    bad("C_n: 1, C_t: -4, w: 1, b: 1", "-4", ".C_t", &["N/m^3"]);
    bad(
        "C_n: 1, C_t: (1, -4), w: 1, b: 1",
        "-4",
        ".C_t.1",
        &["N/m^3"],
    );
    bad(
        "C_n: 1, C_t: 1, w: 1, b: -5",
        "-5",
        ".b",
        &["0 or more", "N s/m"],
    );
    bad(
        "C_n: 0.0, C_t: 0, w: 1, b: 1",
        "0.0",
        ".C_n",
        &["no stiffness", "never breaks"],
    );
    let good = "C_n: 1, C_t: 1, w: 1, b: 1";
    bad(
        &format!("{good}, beta: 1.5"),
        "1.5",
        ".beta",
        &["from 0 to 1"],
    );
    bad(
        &format!("{good}, epsilon: 0.0"),
        "0.0",
        ".epsilon",
        &["between 0 and 1"],
    );
    bad(
        &format!("{good}, epsilon: 1.25"),
        "1.25",
        ".epsilon",
        &["between 0 and 1"],
    );
    bad(
        &format!("{good}, mu_bonded: -2"),
        "-2",
        ".mu_bonded",
        &["0 or more"],
    );
    bad(
        &format!("{good}, healing_gap: -9"),
        "-9",
        ".healing_gap",
        &["0 or more [m]"],
    );
    bad(
        &format!("{good}, healing: Irreversible, healing_gap: 1e-3"),
        "1e-3",
        ".healing_gap",
        &["Recoverable"],
    );
    bad(
        "C_n: 1, C_t: 1, w: 1, update: EnergyConsistent, b: 0.0",
        "0.0",
        ".b",
        &["EnergyConsistent"],
    );
    bad(
        "C_n: 1, C_t: \"x\", w: 1, b: 1",
        "\"x\"",
        ".C_t",
        &["a number or a pair"],
    );
    refused(
        "mu: 0.4",
        "search_distance: 0.0",
        "0.0",
        "interfaces.ground.search_distance",
        &["greater than 0 [m]"],
    );
}

#[test]
fn bonds_need_positions() {
    let text = SMALL
        .replace("mu: 0.4", "adhesion: (C_n: 1, C_t: 1, w: 1, b: 1)")
        .replace("dt: 0.1", "dt: 0.1, contact: Velocity");
    let error = parse("small.ron", &text, &[]).unwrap_err().to_string();
    assert!(
        error.contains("interfaces.ground.adhesion") && error.contains("contact: Position"),
        "{error}"
    );
}

#[test]
fn what_bonds_do_not_need_may_vanish() {
    for fields in ["C_n: 0, C_t: 1, w: 1, b: 0", "C_n: 1, C_t: 0, w: 0, b: 0"] {
        let loaded = changed("mu: 0.4", &format!("adhesion: ({fields})")).unwrap();
        build(&loaded).unwrap();
    }
}

/// A block of the size 1 that is pressed on a plane for 0.5 s and then pulled, with bonds softer than the block.
const PULLED: &str = r#"(
    title: "pulled block",
    materials: { "rubber": (law: NeoHookean(E: 1.0e7, nu: 0.0), density: 1000) },
    bodies: { "block": (mesh: Box(min: (0, 0, 0), max: (1, 1, 1), cells: (2, 2, 1)), material: "rubber") },
    motions: { "top": (nodes: "block.z_max", motion: Move(translation: (0, 0, [(0, 0), (0.1, -0.01), (0.5, -0.01), (1, 0.02)]))) },
    interfaces: {
        "ground": (slave: "block.z_min", master: Plane(point: (0, 0, 0), normal: (0, 0, 1)), mu: 0.4,
            adhesion: (C_n: 1.0e6, C_t: 1.0e6, w: 100, b: 200)),
    },
    time: (end: 1, dt: 0.05, inertia: QuasiStatic),
    output: (
        fields_every: Steps(100),
        plots: [History(["probe.corner.beta", "bond.ground.beta_mean"])],
        probes: {
            "corner": (body: "block", node: (0, 0, 0), quantities: [contact_force, gap, beta, adhesion_force, adhesion_normal, adhesion_tangential, normal_force, tangential_force]),
            "top": (body: "block", node: (0, 0, 1), quantities: [gap, beta, normal_force]),
        },
    ),
)"#;

#[test]
fn bonds_are_written_to_history_fields_and_pictures() {
    let folder = fresh_folder("adhesion");
    let loaded = parse("pulled.ron", PULLED, &[]).unwrap();
    let summary = scenarios::run(&loaded, &folder, &mut |_| ()).unwrap();
    assert_eq!(summary.status, Status::Completed, "{:?}", summary.reason);
    let history = History::read(&folder.join("history.csv")).unwrap();
    let column = |name: &str| history.column(name).unwrap_or_else(|| panic!("{name}"));
    let probe = |name: &str| column(&format!("probe.corner.{name}"));
    let time = column("t");
    let beta = probe("beta");
    // In contact bonds form at the rate w/b.
    for (t, beta) in time.iter().zip(&beta).take_while(|(t, _)| **t <= 0.5) {
        assert!((beta - 0.5 * t).abs() < 1e-9, "{t}: {beta}");
    }
    let last = time.len() - 1;
    let pull = probe("adhesion_normal");
    assert!(pull[last] > 0.0 && probe("gap")[last] > 1e-3);
    assert_eq!(probe("normal_force")[last], 0.0);
    for i in 0..=last {
        let force = probe("normal_force")[i] - pull[i];
        let scale = 1.0 + probe("normal_force")[i];
        assert!((force - probe("contact_force.z")[i]).abs() <= 1e-9 * scale);
        assert_eq!(probe("adhesion_force.z")[i], -pull[i]);
        assert!(pull[i] * probe("gap")[i] >= 0.0 && probe("tangential_force")[i] <= 0.5 * scale);
        assert!(column("bond.ground.beta_max")[i] >= beta[i] - 1e-15);
        // The pull is area beta^2 C_n gap.
        let traction = beta[i] * beta[i] * 1e6 * probe("gap")[i].max(0.0);
        assert!((pull[i] - traction / 16.0).abs() < 1e-6 * scale, "{i}");
    }
    // No sideways strain, so all nodes are alike.
    assert!((column("bond.ground.beta_mean")[last] - beta[last]).abs() < 1e-9);
    assert_eq!(column("bond.ground.bonded")[last], 9.0);
    assert_eq!(column("probe.top.beta")[last], 0.0);
    assert!(column("probe.top.gap")[last].is_nan());
    assert!(summary.energy.unexplained().abs() < 1e-9 * summary.energy.terms.load_work.abs());
    assert!(summary.energy.terms.adhesive < 0.0 && summary.energy.terms.bond_dissipation > 0.0);

    let vtu = Vtu::read(&std::fs::read(folder.join("fields/step_000020.vtu")).unwrap());
    assert_eq!(vtu.floats("beta")[0].to_bits(), beta[last].to_bits());
    assert_eq!(vtu.floats("gap")[0].to_bits(), probe("gap")[last].to_bits());
    assert_eq!(vtu.floats("adhesion_force")[2], -pull[last]);
    assert_eq!(vtu.floats("contact_normal_force")[0], 0.0);
    let top = vtu
        .floats("Points")
        .chunks(3)
        .position(|x| x[2] == 1.0)
        .unwrap();
    assert!(vtu.floats("gap")[top].is_nan() && vtu.floats("beta")[top] == 0.0);
    let svg = std::fs::read_to_string(folder.join("history_1.svg")).unwrap();
    assert!(svg.contains("Intensity of adhesion [-]") && svg.contains("bond ground beta_mean"));
}

#[test]
fn a_picture_of_columns_needs_columns_that_there_are() {
    let refuse = |plot: &str| {
        let text = PULLED.replace("History([\"probe.corner.beta\"", plot);
        parse("pulled.ron", &text, &[]).unwrap_err().to_string()
    };
    let error = refuse("History([\"probe.corner.bet\"");
    assert!(error.contains("output.plots.0.0"), "{error}");
    assert!(
        error.contains("did you mean `probe.corner.beta`"),
        "{error}"
    );
}
