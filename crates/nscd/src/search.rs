//! Where a step looks for contacts.

use contact_bipotential::{Contact, ContactMap, Interface, Master, Obstacle, Shape};
use nalgebra::Vector3;

use crate::contact::filtered;
use crate::error::StepFailure;
use crate::law::state_before;
use crate::model::point;
use crate::report::Phase;
use crate::scheme::ContactLevel;
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
        let pressed = |c: &Contact| {
            let before = state_before(frame.now, c.key());
            before.is_some_and(|b| b.force[2] > 0.0 && b.normal_velocity <= at_rest)
        };
        filtered(&map, |_, c| c.gap <= touching || pressed(c))
    }

    /// Largest distance at which contacts are looked for \[m\].
    fn reach(&self) -> f64 {
        let interfaces = self.model.interfaces.iter();
        interfaces.map(|i| i.search_distance).fold(0.0, f64::max)
    }

    /// Gaps at the end of a step: at the velocity level the contacts keep their predicted frames. Returns the deepest
    /// penetration of any slave node \[m\], of those too that no contact was predicted for.
    pub(crate) fn settle_gaps(
        &mut self,
        frame: &StepFrame<'_>,
        trial: &mut Trial,
    ) -> Result<f64, StepFailure> {
        let model = self.model;
        if model.interfaces.is_empty() {
            return Ok(0.0);
        }
        if model.scheme.contact == ContactLevel::Position {
            self.refuse_lost(frame.now, &trial.u, &trial.map.contacts)?;
            return Ok(0.0);
        }
        let end = self.detect(frame, &trial.u);
        self.refuse_lost(frame.now, &trial.u, &end.contacts)?;
        for c in &mut trial.map.contacts {
            if let Some(k) = end.find(c.key()) {
                c.gap = end.contacts[k].gap;
            }
        }
        Ok(end.contacts.iter().map(|c| -c.gap).fold(0.0, f64::max))
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
            let master = match &interface.master {
                Master::Surface(master) => master,
                Master::Obstacle(obstacle) => {
                    refuse_passing(interface, obstacle, [&start, &end], dim, frame)?;
                    continue;
                }
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

/// A node that ends a step on the other side of a ball, a cylinder or a tip, and was inside on its straight way, has jumped
/// through it: gaps at the end of the step do not tell.
fn refuse_passing(
    interface: &Interface,
    obstacle: &Obstacle,
    [start, end]: [&[f64]; 2],
    dim: usize,
    frame: &StepFrame<'_>,
) -> Result<(), StepFailure> {
    if matches!(obstacle.shape(), Shape::Plane { .. }) {
        return Ok(());
    }
    let placed = obstacle.over_step(frame.now.time, frame.end());
    let motion = obstacle.motion();
    for &node in &interface.slave {
        let from = motion.pull_back(point(start, dim, node).into(), frame.now.time);
        let from = motion.position(from, frame.end());
        let to = Vector3::from(point(end, dim, node));
        let (a, b) = (placed.closest(from, 0.0), placed.closest(to, 0.0));
        let turn = a.normal.dot(&b.normal);
        let inside = |k: i32| {
            let s = f64::from(k) / 8.0;
            let at = (1.0 - s) * from + s * to;
            placed.closest(at, 0.0).gap < a.gap.min(b.gap).min(0.0)
        };
        if turn < 0.0 && (1..8).any(inside) {
            return Err(StepFailure::Passed {
                node,
                interface: interface.name.clone(),
                travel: (to - from).norm(),
            });
        }
    }
    Ok(())
}
