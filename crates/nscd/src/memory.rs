//! What the contact solve remembers of every slave node, from iteration to iteration and from step to step.

use contact_bipotential::{Cone, Contact, ContactKey, ContactMap};

use crate::error::StepFailure;
use crate::model::Model;
use crate::state::State;

/// How often the search may lose a pressed slave node in a step before its contact counts as chattering.
const LOSSES: u8 = 2;
/// Depth over the search distance that a contact on a rim may have although it is left out for the step \[-\].
const RIM_DEPTH: f64 = 1e-6;

/// Forces and stiffnesses of the slave nodes. Nothing here decides a result: forces are a warm start, stiffnesses only
/// weigh an error.
#[derive(Debug)]
pub(crate) struct ContactMemory {
    cone: Cone,
    /// Force of each slave node of each interface, `cone` entries each \[N\].
    forces: Vec<Vec<f64>>,
    /// `1 / trace W_cc` of each slave node of each interface \[N/m\]; zero where it never entered a contact problem.
    stiffness: Vec<Vec<f64>>,
    /// How often in this step the search lost a pressed slave node.
    losses: Vec<Vec<u8>>,
}

impl ContactMemory {
    pub(crate) fn new(model: &Model) -> Self {
        let cone = model.cone();
        let slaves = || model.interfaces.iter().map(|i| i.slave.len());
        let sized = |entries: usize| slaves().map(|n| vec![0.0; entries * n]).collect();
        Self {
            cone,
            forces: sized(cone.dim()),
            stiffness: sized(1),
            losses: slaves().map(|n| vec![0; n]).collect(),
        }
    }

    /// Starts a step from the forces of the last accepted one.
    pub(crate) fn restore(&mut self, now: &State) {
        let cone = self.cone;
        self.clear();
        self.losses.iter_mut().for_each(|l| l.fill(0));
        for c in &now.contacts {
            let rows = &mut self.forces[c.interface][cone.range(c.slave_index)];
            for (r, &axis) in rows.iter_mut().zip(cone.axes()) {
                *r = c.force[axis];
            }
        }
    }

    /// The remembered force of every contact of a map.
    pub(crate) fn recall(&self, map: &ContactMap) -> Vec<f64> {
        let cone = self.cone.dim();
        let force = |c: &Contact| &self.forces[c.interface][cone * c.slave_index..][..cone];
        let contacts = map.contacts.iter();
        contacts.flat_map(|c| force(c).iter().copied()).collect()
    }

    /// Remembers the forces of the given contacts; all others have none.
    pub(crate) fn store(&mut self, map: &ContactMap, r: &[f64]) {
        let cone = self.cone.dim();
        self.clear();
        for (c, force) in map.contacts.iter().zip(r.chunks_exact(cone)) {
            self.forces[c.interface][cone * c.slave_index..][..cone].copy_from_slice(force);
        }
    }

    /// No contact has a force.
    pub(crate) fn clear(&mut self) {
        self.forces.iter_mut().for_each(|f| f.fill(0.0));
    }

    /// All remembered forces, one after the other.
    pub(crate) fn flat_forces(&self) -> impl Iterator<Item = f64> + '_ {
        self.forces.iter().flatten().copied()
    }

    /// Overwrites the forces in the order of [`Self::flat_forces`].
    pub(crate) fn set_flat_forces(&mut self, values: &[f64]) {
        let forces = self.forces.iter_mut().flatten();
        forces.zip(values).for_each(|(f, v)| *f = *v);
    }

    /// Rows of the contacts that have a force.
    pub(crate) fn rows(&self) -> usize {
        let cone = self.cone.dim();
        let pressed = |f: &Vec<f64>| {
            let forces = f.chunks_exact(cone);
            forces.filter(|r| r[cone - 1] > 0.0).count()
        };
        cone * self.forces.iter().map(pressed).sum::<usize>()
    }

    /// Leaves out the contacts that chatter. A node on the rim of a master can be lost by the search in one iteration
    /// and found in the next, for ever: one that was lost twice while pressed stays lost for the step. The deepest of
    /// those that are back is returned, for a step must not end with it.
    pub(crate) fn leave_out_chattering(
        &mut self,
        map: ContactMap,
    ) -> (ContactMap, Option<Contact>) {
        let cone = self.cone.dim();
        for (interface, forces) in self.forces.iter().enumerate() {
            for (slave_index, r) in forces.chunks_exact(cone).enumerate() {
                let key = ContactKey::new(interface, slave_index);
                if r[cone - 1] > 0.0 && map.find(key).is_none() {
                    let losses = &mut self.losses[interface][slave_index];
                    *losses = losses.saturating_add(1);
                }
            }
        }
        let stays = |c: &Contact| self.losses[c.interface][c.slave_index] < LOSSES;
        let back = map.contacts.iter().filter(|c| !stays(c));
        let deepest = back.min_by(|a, b| a.gap.total_cmp(&b.gap)).copied();
        (filtered(&map, |_, c| stays(c)), deepest)
    }

    /// Takes note of `1 / trace W_cc` of the contacts of a map; `trace` gives the trace of contact `k` \[m/N\].
    pub(crate) fn remember_stiffness(&mut self, map: &ContactMap, trace: impl Fn(usize) -> f64) {
        for (k, c) in map.contacts.iter().enumerate() {
            let trace = trace(k);
            if trace > 0.0 {
                self.stiffness[c.interface][c.slave_index] = 1.0 / trace;
            }
        }
    }

    /// `1 / trace W_cc` of a contact \[N/m\]; `None` if it never entered a contact problem.
    pub(crate) fn projection_stiffness(&self, contact: &Contact) -> Option<f64> {
        let known = self.stiffness[contact.interface][contact.slave_index];
        (known != 0.0).then_some(known)
    }

    /// Mean of `1 / W_ii` of a contact that entered a contact problem, else infinite \[N/m\].
    pub(crate) fn local_stiffness(&self, contact: &Contact) -> f64 {
        let inverse_trace = self.projection_stiffness(contact);
        inverse_trace.map_or(f64::INFINITY, |k| self.cone.dim() as f64 * k)
    }
}

/// Refuses the end of a step at which a contact that chatters, and is left out therefore, lies in its master.
pub(crate) fn refuse_chattering(
    model: &Model,
    chattering: Option<&Contact>,
) -> Result<(), StepFailure> {
    let Some(contact) = chattering else {
        return Ok(());
    };
    let reach = model.interfaces[contact.interface].search_distance;
    if contact.gap >= -RIM_DEPTH * reach {
        return Ok(());
    }
    Err(StepFailure::Rim {
        contact: model.place(contact),
    })
}

/// The contacts of a map that are kept.
pub(crate) fn filtered(map: &ContactMap, keep: impl Fn(usize, &Contact) -> bool) -> ContactMap {
    let all = map.contacts.iter().enumerate();
    let kept = all.filter(|(k, c)| keep(*k, c)).map(|(_, c)| *c);
    ContactMap::new(kept.collect(), map.dim(), map.cone())
}
