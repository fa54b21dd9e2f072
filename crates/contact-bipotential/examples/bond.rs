//! One bond that breaks and heals over a cycle: `cargo run -p contact-bipotential --example bond`.
//!
//! A pair of points is pulled apart, pushed together and held: the law of Raous, Cangemi and Cocou with healing. The
//! work that the cycle takes is what the bond dissipates.

use contact_bipotential::nalgebra::Vector3;
use contact_bipotential::{Adhesion, Bond, BondStep, ParameterError};

/// Steps of the cycle and its length \[s\].
const STEPS: usize = 600;
const PERIOD: f64 = 3.0;

fn main() -> Result<(), ParameterError> {
    // C_n = 2 GN/m^3, C_t = 1.5 GN/m^3, w = 20 J/m^2, b = 20 N s/m.
    let law = Adhesion::new(2e9, 1.5e9, 20.0, 20.0).validated()?;
    let (area, dt) = (1e-4, PERIOD / STEPS as f64);
    let reach = 3.0 * law.damage_gap();
    // Up and down again in the first second, closed for the rest.
    let gap =
        |t: f64| reach * (std::f64::consts::PI * t).sin().max(0.0) * f64::from(u8::from(t < 1.0));

    let mut bond = Bond::new(1.0, 0.0, [0.0; 2]);
    let (mut work, mut dissipated) = (0.0, 0.0);
    println!("     t [s]   gap [um]   beta [-]   pull [N]");
    for k in 1..=STEPS {
        let t = k as f64 * dt;
        let step = BondStep::new(&law, area, dt, bond, 0.0);
        // No slip in the step, and the gap at its end.
        let end = Vector3::new(0.0, 0.0, gap(t));
        let energy = step.energy(&end);
        work += energy.work;
        dissipated += energy.dissipated;
        if k % 30 == 0 {
            let at = step.at(&end);
            println!(
                "{t:10.3} {:10.2} {:10.4} {:10.4}",
                1e6 * end.z,
                at.intensity,
                -at.force.z
            );
        }
        bond = step.finish(&end);
    }
    let stored = bond.energy(&law, area) - Bond::new(1.0, 0.0, [0.0; 2]).energy(&law, area);
    println!(
        "work {work:.3e} J = stored {stored:.3e} J + dissipated {dissipated:.3e} J + integration"
    );
    Ok(())
}
