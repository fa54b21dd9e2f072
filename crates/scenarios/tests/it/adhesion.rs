//! Adhesion in a scene: what it means, what is refused.

use contact_bipotential::rcc;
use scenarios::build::build;
use scenarios::spec::{Adhesion, Healing, Reference, Update, parse};

use crate::refusals::refused;
use crate::scene::{SMALL, changed};

const FULL: &str = "adhesion: (C_n: 2.0e9, C_t: (1.0e9, 3.0e9), w: 20.0, b: 0.1, epsilon: 1.0e-3, healing_gap: 1.0e-6, \
                    beta: 0.5, healing: Recoverable, reference: Ageing, update: EnergyConsistent, mu_bonded: 0.7), mu: 0.4";

#[test]
fn every_field_arrives_in_the_law() {
    let loaded = changed("mu: 0.4", FULL).unwrap();
    let built = build(&loaded).unwrap();
    let law = built.model.interfaces[0].adhesion.unwrap();
    assert_eq!(
        law,
        contact_bipotential::Adhesion {
            normal_stiffness: 2e9,
            tangential_stiffness: [1e9, 3e9],
            energy: 20.0,
            viscosity: 0.1,
            threshold: 1e-3,
            healing_gap: 1e-6,
            initial: 0.5,
            healing: rcc::Healing::Recoverable,
            reference: rcc::Reference::Ageing,
            update: rcc::Update::EnergyConsistent,
            bonded_friction: Some(0.7),
        }
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
