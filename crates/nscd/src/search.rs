//! Where a step looks for contacts.

use contact_bipotential::{Contact, ContactMap, Master};

use crate::contact::filtered;
use crate::error::StepFailure;
use crate::report::Phase;
use crate::stepper::Stepper;
use crate::swept::Swept;
use crate::trial::{StepFrame, Trial};

impl Stepper<'_> {
    /// Contacts whose gap closes in free flight [physics of Moreau-Jean]; they keep their frames
    /// through the step.
    pub(crate) fn predicted_contacts(&mut self, frame: &StepFrame<'_>) -> ContactMap {
        let mut ahead: Vec<f64> = frame
            .now
            .u
            .iter()
            .zip(&frame.now.v)
            .map(|(u, v)| u + frame.dt * v)
            .collect();
        self.model.prescribe(frame.end(), &mut ahead);
        let map = self.detect(frame, &ahead);
        // A contact that was pressed and does not bounce stays in the problem: whether it opens is for
        // the law to say, not for the round-off of a predicted gap or the turn of a normal.
        let touching = 1e-9 * self.reach();
        let at_rest = 1e-6 * self.reach() / frame.dt;
        let now = &frame.now.contacts;
        let pressed = |c: &Contact| {
            let key = (c.interface, c.slave_index);
            let found = now.binary_search_by_key(&key, |k| (k.interface, k.slave_index));
            found.is_ok_and(|k| now[k].force[2] > 0.0 && now[k].normal_velocity <= at_rest)
        };
        filtered(&map, |_, c| c.gap <= touching || pressed(c))
    }

    /// Largest distance at which contacts are looked for \[m\].
    fn reach(&self) -> f64 {
        let interfaces = self.model.interfaces.iter();
        interfaces.map(|i| i.search_distance).fold(0.0, f64::max)
    }

    /// Gaps at the end of a step at the velocity level, where the contacts keep their predicted frames. Returns the deepest
    /// penetration of any slave node \[m\], of those too that no contact was predicted for.
    pub(crate) fn end_gaps(&mut self, frame: &StepFrame<'_>, trial: &mut Trial) -> f64 {
        let end = self.detect(frame, &trial.u);
        for c in &mut trial.map.contacts {
            let key = (c.interface, c.slave_index);
            let found = end
                .contacts
                .binary_search_by_key(&key, |e| (e.interface, e.slave_index));
            if let Ok(k) = found {
                c.gap = end.contacts[k].gap;
            }
        }
        end.contacts.iter().map(|c| -c.gap).fold(0.0, f64::max)
    }

    /// A slave that crosses more than the reach of the search in one step could pass through its
    /// master unseen: such a step is refused when the two come near each other on the way.
    pub(crate) fn refuse_tunnelling(
        &self,
        frame: &StepFrame<'_>,
        trial: &Trial,
    ) -> Result<(), StepFailure> {
        let start = self.model.positions(&frame.now.u);
        let end = self.model.positions(&trial.u);
        let dim = self.model.solid.dim();
        for interface in &self.model.interfaces {
            let Master::Surface(master) = &interface.master else {
                continue;
            };
            let swept = |nodes: &[u32]| Swept::of(nodes, dim, &start, &end);
            let (slave, master) = (swept(&interface.slave), swept(&master.nodes));
            let (travel, reach) = (slave.fastest_against(&master), interface.search_distance);
            if travel > reach && slave.meets(&master, reach) {
                let interface = interface.name.clone();
                return Err(StepFailure::TooFast {
                    interface,
                    travel,
                    reach,
                });
            }
        }
        Ok(())
    }

    pub(crate) fn detect(&mut self, frame: &StepFrame<'_>, u: &[f64]) -> ContactMap {
        let start = self.clock.seconds();
        let positions = self.model.positions(u);
        let map = self
            .detector
            .detect(&positions, frame.now.time, frame.end());
        self.counters.detections += 1;
        self.book(Phase::Detection, start);
        map
    }
}
