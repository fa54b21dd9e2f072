//! What the scenes with adhesion must show, on coarse meshes.

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
    let coarse = ["cylinder.mesh.cells=12", "plate.mesh.cells=(40, 2)", "dt=5e-5"];
    let sets = [&path, &end, &mu].map(String::as_str);
    audited("plate-cylinder", &[&coarse[..], &sets].concat())
}

/// Hu et al. 2022, figure 10: `beta = w t / b` when the descent ends; friction keeps the bonds.
#[test]
fn a_slower_descent_and_a_rougher_plate_bond_for_longer() {
    for down in [1, 4] {
        let mut debonding = Vec::new();
        for mu in [0.2, 0.6] {
            let run = dragged(down, mu);
            let beta = probe(&run, "cylinder", "plate-cylinder");
            let (end, exact) = (f64::from(down) * 1e-3, 0.2 * f64::from(down));
            let reached = at(&beta, end);
            eprintln!("descent {down} mu {mu}: {reached}, falls {:?} {:?}", falls_below(&beta, 0.1), falls_below(&beta, 1e-4));
            assert!((reached / exact - 1.0).abs() < 0.02, "descent {down} ms, mu = {mu}: {reached}");
            debonding.push(falls_below(&beta, 0.1));
        }
        eprintln!("descent {down} ms: {debonding:?}");
        assert!(debonding[0].unwrap() + 2e-4 < debonding[1].unwrap(), "descent {down} ms: {debonding:?}");
    }
}

/// Hu et al. 2022, figure 8: bonds form at a rate of their own and break earlier on a stiffer wheel.
#[test]
fn a_stiffer_wheel_debonds_earlier() {
    let mut curves = Vec::new();
    for modulus in ["G=5.0e6", "G=1.0e7", "G=1.5e7"] {
        let run = audited("wheel", &["mesh.cells=16", "dt=2e-4", "end=0.016", modulus]);
        // The lowest node at the start of the bonding is touched from the start.
        let beta = probe(&run, "a", "wheel");
        let start = beta.iter().find(|b| b.1 > 0.0).unwrap().0;
        eprintln!("{modulus}: start {start}, .5 at {:?}, falls {:?}; b {:?}", beta.iter().find(|b| b.1 > 0.5), falls_below(&beta, 0.1), falls_below(&probe(&run, "b", "wheel"), 0.1));
        curves.push(beta);
    }
}

/// Hu et al. 2022, figures 12 to 15.
#[test]
fn a_bonded_block_holds_and_debonds_from_the_rim_inwards() {
    let coarse = ["mesh.cells=(8, 8, 3)", "dt=2e-4"];
    let dry = audited("twist-dry", &coarse);
    let corner = |run: &Run| run.built.probes.get(2).copied();
    eprintln!("{:?}", corner(&dry));
    for mu in ["mu=0.2", "mu=0.4", "mu=0.6"] {
        let run = audited("twist", &[&coarse[..], &[mu]].concat());
        let fall = |name| falls_below(&probe(&run, name, "twist"), 0.5);
        eprintln!("{mu}: {:?} {:?} {:?}", fall("corner"), fall("edge"), fall("center"));
        let node = corner(&run).unwrap() as usize;
        for (b, d) in run.steps.iter().zip(&dry.steps) {
            let u = |s: &Step| s.state.u[3 * node].hypot(s.state.u[3 * node + 1]);
            eprintln!("  {} {} {:e} {:e}", b.report.time, d.report.time, u(b), u(d));
        }
    }
}

/// Hu et al. 2022, figure 6.
#[test]
fn an_indented_block_debonds_inwards_and_pulls_more_with_stronger_bonds() {
    let mut forces = Vec::new();
    for sets in ["C_n=2e9", "C_n=4e9", "w=40.0"].map(|s| vec![s]) {
        let run = audited("indentation", &[&["cells=(60, 10)", "dt=0.02"][..], &sets].concat());
        let pull = run.contact_force(1).into_iter().fold(0.0, f64::max);
        let times: Vec<_> = ["n6", "n4", "n2", "n0"].map(|n| falls_below(&probe(&run, n, "indentation"), 0.5)).into();
        eprintln!("{sets:?} {pull} {times:?}");
        forces.push(pull);
    }
}
