use crate::common::*;
#[test]
#[ignore]
fn probe_crush() {
    let run = crate::control::crushed(
        "NeoHookean(E: 100.0, nu: 0.3)",
        r#""bottom": (nodes: "block.z_min")"#,
        &crate::control::pushed(),
    );
    for s in &run.steps {
        println!(
            "t {} closed {} pen {:e} F {:?} cand {}",
            s.report.time,
            s.report.contacts_closed,
            s.report.penetration,
            s.report.interfaces[0].force,
            s.state.contacts.len()
        );
    }
    for r in &run.totals.rejections {
        println!("{r:?}");
    }
}
#[test]
#[ignore]
fn probe_press() {
    for mu in [0.0, 0.5] {
        for law in [
            "NeoHookean(E: 100.0, nu: 0.3)",
            "BlatzKo(G: 40.0)",
            "SaintVenantKirchhoff(E: 100.0, nu: 0.3)",
        ] {
            let run = crate::patch::pressed(law, mu);
            for s in &run.steps {
                println!(
                    "mu {mu} {law} t {} closed {} pen {:e} F {:?} cand {} newton {}",
                    s.report.time,
                    s.report.contacts_closed,
                    s.report.penetration,
                    s.report.interfaces[0].force,
                    s.state.contacts.len(),
                    s.report.newton_iterations
                );
            }
            for r in &run.totals.rejections {
                println!("{r:?}");
            }
        }
    }
}
