//! What the scenes with adhesion must show, on coarse meshes.

use nalgebra::Vector3;

use crate::common::{Run, Step, scene, try_run};

/// A run that reached its end and closed its audit.
fn audited(name: &str, sets: &[&str]) -> Run {
    let run = try_run(&scene(name, sets));
    assert!(run.end.is_ok(), "{name} {sets:?}: {:?}", run.end);
    let stored = |s: &Step| s.state.kinetic_energy + s.state.strain_energy;
    let scale = run.steps.iter().map(stored).fold(0.0, f64::max);
    run.assert_audited(scale, 1e-9);
    run
}

/// Time and intensity at a slave node of the first interface.
fn intensity(run: &Run, node: u32) -> Vec<(f64, f64)> {
    let slaves = &run.built.model.interfaces[0].slave;
    let at = slaves.iter().position(|slave| *slave == node).unwrap();
    let steps = run.steps.iter();
    steps
        .map(|s| (s.report.time, s.state.bonds[0][at].intensity))
        .collect()
}

fn probe(run: &Run, name: &str, of: &str) -> Vec<(f64, f64)> {
    let probes = scene(of, &[]).scene.output.probes;
    intensity(run, run.built.probes[probes.get_index_of(name).unwrap()])
}

/// Between two steps the curve is a line.
fn at(curve: &[(f64, f64)], t: f64) -> f64 {
    let after = curve.partition_point(|c| c.0 < t * (1.0 - 1e-12));
    let ((t0, y0), (t1, y1)) = (curve[after.max(1) - 1], curve[after.max(1)]);
    y0 + (y1 - y0) * (t - t0) / (t1 - t0)
}

/// When the curve last falls below a level.
fn falls_below(curve: &[(f64, f64)], level: f64) -> Option<f64> {
    let falls = |p: &&[(f64, f64)]| p[0].1 >= level && p[1].1 < level;
    let pair = curve.windows(2).rfind(falls)?;
    let (t0, y0, t1, y1) = (pair[0].0, pair[0].1, pair[1].0, pair[1].1);
    Some(t0 + (t1 - t0) * (level - y0) / (y1 - y0))
}

/// Descent over `down` ms, then 3 ms of sliding at 1 m/s.
fn dragged(down: u32, mu: f64) -> Run {
    let (down, end) = (f64::from(down) * 1e-3, f64::from(down + 3) * 1e-3);
    let path = format!(
        "drive.motion.translation=([({down:?}, 0.0), ({end:?}, 0.003)], [(0.0, 0.0), ({down:?}, -0.001)], 0.0)"
    );
    let (end, mu) = (format!("end={end:?}"), format!("mu={mu:?}"));
    let sets = [
        "cylinder.mesh.cells=12",
        "plate.mesh.cells=(40, 2)",
        "dt=5e-5",
    ];
    audited("plate-cylinder", &[&sets[..], &[&path, &end, &mu]].concat())
}

/// `beta = w t / b` when the descent ends, as in figure 10 of Hu et al. 2022; friction keeps the bonds for longer.
#[test]
fn a_slower_descent_bonds_more_and_a_rougher_plate_debonds_later() {
    let mut debonding = Vec::new();
    for down in [1, 4] {
        for mu in [0.2, 0.6] {
            let run = dragged(down, mu);
            let beta = probe(&run, "cylinder", "plate-cylinder");
            let reached = at(&beta, f64::from(down) * 1e-3);
            let exact = 0.2 * f64::from(down);
            assert!(
                (reached / exact - 1.0).abs() < 0.02,
                "descent {down} ms, mu = {mu}: {reached}"
            );
            // Counted from the start of sliding.
            debonding.push(falls_below(&beta, 0.1).unwrap() - f64::from(down) * 1e-3);
        }
    }
    assert!(
        debonding[0] + 5e-4 < debonding[1] && debonding[2] + 5e-4 < debonding[3],
        "{debonding:?}"
    );
    assert!(
        debonding[0] < debonding[2] && debonding[1] < debonding[3],
        "{debonding:?}"
    );
}

/// Figure 8 of Hu et al. 2022: bonds form at the rate `w / b` whatever the wheel, and a stiffer one breaks them
/// earlier.
#[test]
fn a_stiffer_wheel_bonds_alike_and_debonds_earlier() {
    let dt = 1e-4;
    let (mut starts, mut ends) = (Vec::new(), Vec::new());
    for modulus in ["G=5.0e6", "G=1.0e7", "G=1.5e7"] {
        let run = audited("wheel", &["mesh.cells=16", "dt=1e-4", "end=0.016", modulus]);
        for name in ["a", "b"] {
            let beta = probe(&run, name, "wheel");
            let first = beta.iter().position(|b| b.1 > 0.0).unwrap();
            for (k, b) in beta[first..first + 35].iter().enumerate() {
                let exact = 200.0 * dt * (k + 1) as f64;
                assert!((b.1 - exact).abs() < 1e-9, "{modulus}, node {name}: {b:?}");
            }
            starts.push(beta[first].0);
            ends.push(falls_below(&beta, 0.1).unwrap());
        }
    }
    for node in 0..2 {
        let moved = starts[node + 2] - starts[node];
        assert!(moved.abs() < 1.5 * dt, "{starts:?}");
        assert!(
            ends[node] > ends[node + 2] && ends[node + 2] > ends[node + 4],
            "{ends:?}"
        );
    }
}

/// Node of the lower face at `(x, y)` \[mm\].
fn lower_node(run: &Run, x: f64, y: f64) -> usize {
    let points = &run.built.model.solid.mesh().points;
    let distance = |p: &Vector3<f64>| (p[0] - 1e-3 * x).hypot(p[1] - 1e-3 * y) + p[2].abs();
    points.iter().position(|p| distance(p) < 1e-9).unwrap()
}

/// How far the corner of the lower face has moved sideways \[m\].
fn corner_moved(run: &Run) -> Vec<(f64, f64)> {
    let corner = lower_node(run, 5.0, 5.0);
    let moved = |u: &[f64]| u[3 * corner].hypot(u[3 * corner + 1]);
    let steps = run.steps.iter();
    steps.map(|s| (s.report.time, moved(&s.state.u))).collect()
}

const BLOCK: [&str; 2] = ["mesh.cells=(8, 8, 3)", "dt=2e-4"];

/// From 7 to 8 ms the corner of the top goes 20 rad/s * 7.07 mm * 1 ms = .141 mm.
#[test]
fn a_bonded_block_holds_where_a_dry_one_turns() {
    let share = |run: &Run| {
        let moved = corner_moved(run);
        (at(&moved, 0.008) - at(&moved, 0.007)) / (20.0 * 0.005 * 2.0_f64.sqrt() * 1e-3)
    };
    let dry = share(&audited("twist-dry", &BLOCK));
    assert!(dry > 0.9, "the dry corner turns with {dry} of the top");
    let bonded = audited("twist", &BLOCK);
    let follows = share(&bonded);
    assert!(follows < 0.25, "the bonded corner turns with {follows}");
    assert!(at(&probe(&bonded, "corner", "twist"), 0.008) > 0.99);
}

/// Figures 14 and 15 of Hu et al. 2022.
#[test]
fn a_bonded_block_debonds_from_the_rim_inwards_and_later_if_rough() {
    let longer = [
        "angle=[(0.005, 0.0), (0.012, -0.14)]",
        "end=0.012",
        "mu=0.2",
    ];
    let smooth = audited("twist", &[&BLOCK[..], &longer].concat());
    let bond = |run: &Run, x, y| intensity(run, lower_node(run, x, y) as u32);
    let fall = |run: &Run, x, y| falls_below(&bond(run, x, y), 0.5).unwrap();
    let inwards = [(5.0, 5.0), (5.0, 0.0), (3.75, 0.0), (2.5, 0.0)];
    let times = inwards.map(|(x, y)| fall(&smooth, x, y));
    assert!(times.is_sorted_by(|a, b| a + 1e-4 < *b), "{times:?}");
    // Nothing shears the bond on the axis.
    let center = bond(&smooth, 0.0, 0.0).pop().unwrap().1;
    assert!(center > 0.9, "{center}");
    let [middle, rough] = ["mu=0.4", "mu=0.6"].map(|mu| {
        let run = audited("twist", &[&BLOCK[..], &[mu]].concat());
        fall(&run, 5.0, 5.0)
    });
    let corner = times[0];
    assert!(
        corner + 3e-4 < middle && middle + 3e-4 < rough,
        "{corner} {middle} {rough}"
    );
}

/// Largest pull of the bond at a slave node of the first interface \[N\].
fn strongest_pull(run: &Run, node: u32) -> f64 {
    let contacts = run.steps.iter().flat_map(|s| &s.state.contacts);
    let bonds = contacts.filter(|c| c.node == node).filter_map(|c| c.bond);
    bonds.map(|b| -b.force[2]).fold(0.0, f64::max)
}

/// Bonds that reach far compared to the dent (Derjaguin, Muller and Toporov) pull off at `2 pi R w`, however stiff they
/// are.
#[test]
fn an_indented_block_debonds_inwards_at_the_force_of_its_energy() {
    let mut results = Vec::new();
    for (set, energy) in [("C_n=2e9", 20.0), ("C_n=4e9", 20.0), ("w=40.0", 40.0)] {
        let run = audited("indentation", &["cells=(60, 10)", "dt=0.02", set]);
        let force = run.contact_force(1).into_iter().fold(0.0, f64::max);
        let exact = 2.0 * std::f64::consts::PI * 0.01 * energy;
        assert!(
            (1.0..1.05).contains(&(force / exact)),
            "{set}: {force} {exact}"
        );
        let fall = |name| falls_below(&probe(&run, name, "indentation"), 0.5).unwrap();
        let times = ["n6", "n4", "n2", "n0"].map(fall);
        assert!(times.is_sorted(), "{set}: {times:?}");
        results.push((times[3], strongest_pull(&run, run.built.probes[4])));
    }
    let [given, stiff, strong] = results[..] else {
        panic!("{results:?}")
    };
    // A stiffer bond pulls more and over a shorter way, one of more energy more and over a longer.
    assert!(
        stiff.1 > 1.2 * given.1 && strong.1 > 1.2 * given.1,
        "{results:?}"
    );
    assert!(stiff.0 < given.0 && given.0 < strong.0, "{results:?}");
}
