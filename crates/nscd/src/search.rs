//! The contact search of a step.

use contact_bipotential::{Contact, ContactMap, Detector};
use fe_core::Symmetry;

use crate::bonds::reaches;
use crate::error::NscdError;
use crate::memory::filtered;
use crate::model::Model;
use crate::report::Phase;
use crate::state::State;
use crate::step_problem::StepProblem;
use crate::tally::Tally;

/// Gap over the search distance that counts as touching where velocities are predicted \[-\].
const TOUCHING: f64 = 1e-9;
/// Way of a step over the search distance below which a contact counts as at rest \[-\].
const AT_REST: f64 = 1e-6;

/// Finds the contacts of a model.
#[derive(Debug)]
pub(crate) struct ContactSearch<'m> {
    model: &'m Model,
    detector: Detector,
}

impl<'m> ContactSearch<'m> {
    /// # Errors
    /// An interface that does not fit the mesh.
    pub(crate) fn new(model: &'m Model) -> Result<Self, NscdError> {
        let reference = model.positions(&vec![0.0; model.dof_count()]);
        let interfaces = model.interfaces.clone();
        let detector = Detector::new(interfaces, &reference, model.solid.dim(), model.cone())?;
        let detector = match model.solid.mesh().symmetry {
            Symmetry::Axisymmetric => detector.axisymmetric(&reference),
            _ => detector,
        };
        Ok(Self { model, detector })
    }

    /// Lets the search reach as far as bonds hold.
    pub(crate) fn reach_for_bonds(&mut self, now: &State) {
        for (interface, reach) in reaches(self.model, now) {
            self.detector.extend(interface, reach);
        }
    }

    /// Contacts at the positions `x` \[m\], in a state without step at the time `t` \[s\].
    pub(crate) fn contacts_at(&mut self, x: &[f64], t: f64) -> Vec<Contact> {
        self.detector.detect(x, t, t).contacts
    }

    /// Contacts at the displacement `u` \[m\] at the end of a step.
    pub(crate) fn contacts_after(
        &mut self,
        step: &StepProblem<'_>,
        u: &[f64],
        tally: &mut Tally,
    ) -> ContactMap {
        let start = tally.seconds();
        let x = self.model.positions(u);
        let map = self.detector.detect(&x, step.now.time, step.end());
        tally.counters.detections += 1;
        tally.book(Phase::Detection, start);
        map
    }

    /// Contacts whose gap closes in free flight \[physics of Moreau-Jean\]; they keep their frames through the step.
    /// `reach` is the largest search distance \[m\].
    pub(crate) fn predicted_contacts(
        &mut self,
        step: &StepProblem<'_>,
        reach: f64,
        tally: &mut Tally,
    ) -> ContactMap {
        let now = step.now;
        let nodes = now.u.iter().zip(&now.v);
        let mut ahead: Vec<f64> = nodes.map(|(u, v)| u + step.dt * v).collect();
        self.model.prescribe(step.end(), &mut ahead);
        let map = self.contacts_after(step, &ahead, tally);
        // A contact that was pressed and does not bounce stays in the problem: whether it opens is for the law to say,
        // not for the round-off of a predicted gap or the turn of a normal.
        let touching = TOUCHING * reach;
        let at_rest = AT_REST * reach / step.dt;
        let pressed = |c: &Contact| {
            let before = now.contact(c.key());
            before.is_some_and(|b| b.force[2] > 0.0 && b.normal_velocity <= at_rest)
        };
        filtered(&map, |_, c| c.gap <= touching || pressed(c))
    }
}
