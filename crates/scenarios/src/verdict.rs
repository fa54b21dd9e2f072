//! Whether a run that reached its end can be believed, judged by its energies.

use nscd::{EnergyAudit, Inertia};

use crate::spec::{Acceptance, Scene};

/// Part of the energy in play that the audit may leave open \[-\]: a thousand times what tolerances of 1e-6 would.
const OPEN: f64 = 1e-3;
/// Part of the energy in play that the integration of a motion may make \[-\].
const MADE: f64 = 0.1;
/// Part of the energy in play by which a dissipation may fall from its highest value \[-\].
const RETURNED: f64 = 1e-4;
/// Part of the energy in play beyond which what the integration made deserves a word \[-\]: the scenes of this program
/// stay below .017.
const NOTABLE_GAIN: f64 = 0.02;
/// Part of the energy in play beyond which what the integration lost deserves a word \[-\]: schemes with theta or xi
/// above 1/2 lose by intention.
const NOTABLE_LOSS: f64 = 0.1;

/// What the energies say against a run.
#[derive(Debug, Default)]
pub(crate) struct Verdict {
    /// Why it cannot be believed, each with its size, its bound and what to try; empty where it can.
    pub(crate) objections: Vec<String>,
    /// The same, but accepted by the scene.
    pub(crate) accepted: Vec<String>,
}

/// Judges the energies of a run.
pub(crate) fn verdict(scene: &Scene, audit: &EnergyAudit) -> Verdict {
    let all = [
        (Acceptance::OpenAudit, open_audit(audit)),
        (Acceptance::EnergyGain, energy_gain(scene, audit)),
        (
            Acceptance::NegativeDissipation,
            negative_dissipation(scene, audit),
        ),
    ];
    let mut verdict = Verdict::default();
    for (kind, objection) in all {
        let Some(text) = objection else {
            continue;
        };
        if scene.accept.contains(&kind) {
            verdict
                .accepted
                .push(format!("accepted ({kind:?}): {text}"));
        } else {
            let text = format!("{text} (`accept: [{kind:?}]` in the scene takes the run as it is)");
            verdict.objections.push(text);
        }
    }
    verdict
}

fn open_audit(audit: &EnergyAudit) -> Option<String> {
    let share = audit.share(audit.open);
    (share > OPEN).then(|| {
        format!(
            "the energy audit leaves {:e} J unexplained of {:e} J in play, more than the {OPEN:e} of it that are allowed: loose \
             tolerances, or values so large or small that forces drown in round-off; try a smaller solver.newton_tolerance and look \
             at the sizes of materials, loads and damping",
            audit.open, audit.in_play
        )
    })
}

fn energy_gain(scene: &Scene, audit: &EnergyAudit) -> Option<String> {
    let share = audit.share(audit.made);
    let moves = scene.time.inertia == Inertia::Dynamic;
    (moves && share > MADE).then(|| {
        format!(
            "the time integration made {:e} J of {:e} J in play out of nothing, more than the {MADE} of it that are allowed: steps are \
             too long for the motion; try a smaller time.dt, or theta and xi nearer to 1",
            audit.made, audit.in_play
        )
    })
}

fn negative_dissipation(scene: &Scene, audit: &EnergyAudit) -> Option<String> {
    let kinds = [
        ("friction", audit.friction_made),
        ("bonds", audit.bonds_made),
        ("damping", audit.damping_made),
        ("closing contacts", audit.impact_made),
    ];
    let (name, made) = kinds.into_iter().max_by(|a, b| a.1.total_cmp(&b.1))?;
    let advice = if name == "damping" && scene.time.theta != scene.time.xi {
        "equal theta and xi keep damping from giving energy"
    } else {
        "try a smaller time.dt, or contact: Position"
    };
    (audit.share(made) > RETURNED).then(|| {
        format!(
            "{name} gave {made:e} J of {:e} J in play, where they can only take: more than the {RETURNED:e} of it that are allowed; \
             {advice}",
            audit.in_play
        )
    })
}

/// What a reader of the energies should know, where the integration lost `error` \[J\] in sum.
pub(crate) fn energy_warning(inertia: Inertia, audit: &EnergyAudit, error: f64) -> Option<String> {
    let (made, lost) = (audit.share(audit.made), audit.share(error));
    let percent = |share: f64| format!("{:.0} %", 100.0 * share);
    match inertia {
        Inertia::Dynamic if made > NOTABLE_GAIN => Some(format!(
            "the time integration made {} of the energy out of nothing: take smaller steps before you believe the numbers",
            percent(made)
        )),
        Inertia::Dynamic if lost > NOTABLE_LOSS => Some(format!(
            "the time integration took away {} of the energy: take smaller steps before you believe the numbers",
            percent(lost)
        )),
        Inertia::QuasiStatic if lost > NOTABLE_LOSS => Some(format!(
            "the works in the energy audit are off by {} of the energy, since each takes the force at the end of its step for the \
             whole step: take smaller steps if you need works; forces and displacements without friction and bonds do not depend on it",
            percent(lost)
        )),
        _ => None,
    }
}
