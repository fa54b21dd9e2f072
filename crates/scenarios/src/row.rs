//! The row of a step: what `history.csv` says of it.

use nscd::{Resultant, State, StepReport, Totals};

use crate::build::Built;
use crate::contacts::{self, NodeContact};
use crate::energies::Energies;
use crate::fields::Fields;
use crate::output::{Force, Row};
use crate::spec::{Quantity, Scene};

/// The row of an accepted step.
#[must_use]
pub fn row(
    scene: &Scene,
    built: &Built,
    state: &State,
    report: &StepReport,
    totals: &Totals,
) -> Row {
    let resultants = report.interfaces.iter().chain(&report.supports);
    Row {
        time: state.time,
        energies: energies(state, totals),
        contacts: report.contacts_closed,
        penetration: report.penetration,
        contact_error: report.contact_error,
        forces: resultants
            .map(|r| Force {
                force: r.force.into(),
                moment: r.moment.into(),
            })
            .collect(),
        bonds: contacts::bonds(&built.model, state),
        probes: probes(scene, built, state),
    }
}

/// The row of the initial state, on which no forces act yet.
#[must_use]
pub fn first_row(scene: &Scene, built: &Built, state: &State) -> Row {
    let mut report = StepReport::default();
    report.interfaces = vec![Resultant::default(); built.model.interfaces.len()];
    report.supports = vec![Resultant::default(); built.model.supports.len()];
    row(scene, built, state, &report, &Totals::default())
}

/// Energies of a state and sums since the start.
pub(crate) fn energies(state: &State, totals: &Totals) -> Energies {
    let sums = &totals.energy;
    Energies {
        kinetic: state.kinetic_energy,
        strain: state.strain_energy,
        adhesive: state.adhesive_energy,
        load_work: sums.load_work,
        friction_dissipation: sums.friction,
        bond_dissipation: sums.bond,
        damping_dissipation: sums.damping,
        impact_loss: sums.impact,
        integration_error: sums.integration_error(),
    }
    .without_negative_zeros()
}

fn probes(scene: &Scene, built: &Built, state: &State) -> Vec<f64> {
    let dim = built.model.solid.dim();
    let stress = |node: u32| Fields::nodal_von_mises(built, state, node);
    let vector = |field: &[f64], node: u32| {
        let mut v = vec![0.0; 3];
        v[..dim].copy_from_slice(&field[dim * node as usize..dim * (node as usize + 1)]);
        v
    };
    let probes = scene.output.probes.values().zip(&built.probes);
    let values = probes.flat_map(|(probe, &node)| {
        let contact = NodeContact::of(&built.model, state, node);
        probe.quantities.iter().flat_map(move |q| match q {
            Quantity::Displacement => vector(&state.u, node),
            Quantity::Velocity => vector(&state.v, node),
            Quantity::ContactForce => vector(&state.contact_force, node),
            Quantity::VonMises => vec![stress(node)],
            Quantity::Gap => vec![contact.gap],
            Quantity::Beta => vec![contact.beta],
            Quantity::AdhesionForce => contact.bond_force.as_slice().to_vec(),
            Quantity::AdhesionNormal => vec![contact.bond_normal],
            Quantity::AdhesionTangential => vec![contact.bond_tangential],
            Quantity::NormalForce => vec![contact.normal],
            Quantity::TangentialForce => vec![contact.tangential],
        })
    });
    values.collect()
}
