use std::path::PathBuf;

use contact_bipotential::conformance::check_outcome;
use contact_bipotential::{Method, SolveSettings, solve};

use super::*;

/// `|u|` of the solution where it is unique, to the digits known.
const VELOCITIES: [(&str, f64, f64); 10] = [
    ("Capsules-i97", 17.90098, 1e-6),
    ("Capsules-i125", 7.151374, 1e-6),
    ("Capsules-i100-1090", 8.951457, 1e-6),
    ("Capsules-i103-990", 4.994616, 1e-6),
    ("PerioBox", 0.3119524, 1e-6),
    ("OneObject-i100000-316", 1.837596, 1e-6),
    ("Spheres-i099-356", 2.638962, 1e-6),
    ("Confeti-ex03", 34.19443, 1e-6),
    ("NESpheres_10", 3.528550, 1e-6),
    ("CubeH8", 4.983317e-5, 1e-6),
];

/// The problem files, or nothing, said aloud, where they are not installed.
fn files(test: &str) -> Vec<PathBuf> {
    let beside = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/fclib");
    let folder = std::env::var_os("FCLIB_DIR").map_or(beside, PathBuf::from);
    let Ok(entries) = std::fs::read_dir(&folder) else {
        println!(
            "SKIPPED {test}: no folder {} (set FCLIB_DIR)",
            folder.display()
        );
        return Vec::new();
    };
    let mut files: Vec<PathBuf> = entries.filter_map(|e| Some(e.ok()?.path())).collect();
    files.retain(|p| p.extension().is_some_and(|e| e == "dat" || e == "hdf5"));
    files.sort();
    files
}

#[test]
fn the_normal_moves_to_the_end() {
    assert_eq!(
        turned(&[1.0, 2.0, 3.0, 4.0, 5.0, 6.0], 3),
        [2.0, 3.0, 1.0, 5.0, 6.0, 4.0]
    );
    assert_eq!(turned(&[1.0, 2.0, 3.0, 4.0], 2), [2.0, 1.0, 4.0, 3.0]);
}

#[test]
fn a_missing_file_is_named() {
    let message = read(Path::new("nowhere/at/all.dat"))
        .unwrap_err()
        .to_string();
    assert!(message.starts_with("nowhere/at/all.dat: "), "{message}");
}

#[test]
fn every_problem_is_solved_to_the_last_digits() {
    for path in files("every_problem_is_solved_to_the_last_digits") {
        let problem = read(&path).unwrap();
        let settings = SolveSettings::default().with_tolerance(1e-12);
        let mut r = Vec::new();
        let outcome = solve(&problem, &mut r, &settings);
        let name = path.file_name().unwrap().to_string_lossy().into_owned();
        check_outcome(&problem, &r, &outcome, 1e-12).unwrap_or_else(|e| panic!("{name}: {e}"));
        assert!(
            outcome.is_converged(),
            "{name}: {:e} {:e}",
            outcome.error,
            outcome.error_scale_free
        );
        let norm = outcome.u.iter().map(|x| x * x).sum::<f64>().sqrt();
        for (part, expected, digits) in VELOCITIES {
            let near = (norm - expected).abs() <= digits * expected;
            assert!(
                !name.contains(part) || near,
                "{name}: |u| {norm:.8e}, {expected:.8e} is known"
            );
        }
    }
}

#[test]
fn no_method_claims_what_it_has_not_solved() {
    for path in files("no_method_claims_what_it_has_not_solved") {
        let problem = read(&path).unwrap();
        for method in Method::ALL {
            let settings = SolveSettings::default()
                .with_method(method)
                .with_tolerance(1e-8)
                .with_max_iterations(300);
            let mut r = Vec::new();
            let outcome = solve(&problem, &mut r, &settings);
            check_outcome(&problem, &r, &outcome, 1e-8)
                .unwrap_or_else(|e| panic!("{} {method:?}: {e}", path.display()));
        }
    }
}

#[test]
fn damaged_files_are_refused_with_their_name() {
    let mut state = 88_172_645_463_325_252_u64;
    let mut random = move |below: usize| {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        state as usize % below
    };
    let small = |p: &PathBuf| std::fs::metadata(p).is_ok_and(|m| m.len() < 150_000);
    for path in files("damaged_files_are_refused_with_their_name")
        .iter()
        .filter(|p| small(p))
    {
        let bytes = std::fs::read(path).unwrap();
        for round in 0..60 {
            let mut damaged = bytes.clone();
            match round % 3 {
                0 => damaged.truncate(random(bytes.len())),
                1 => {
                    (0..4).for_each(|_| damaged[random(bytes.len().min(4096))] = random(256) as u8)
                }
                _ => (0..4).for_each(|_| damaged[random(bytes.len())] = random(256) as u8),
            }
            let result = match path.extension().and_then(|e| e.to_str()) {
                Some("hdf5") => hdf5::parse(path, damaged),
                _ => dat::parse(path, &damaged),
            };
            if let Err(error) = result {
                assert!(
                    error.to_string().starts_with(&path.display().to_string()),
                    "{error}"
                );
            }
        }
    }
}
