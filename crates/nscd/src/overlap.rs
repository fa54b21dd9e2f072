//! Nodes of an interface inside the body on its other side, where no contact holds them.

mod hull;

use contact_bipotential::Contact;

use crate::error::{NscdError, Side, StepFailure};
use crate::model::Model;
use crate::report::{Overlap, Phase};
use crate::scheme::Inertia;
use crate::search::ContactSearch;
use crate::state::State;
use crate::tally::Tally;

use hull::{Hull, Inside, sorted};

/// Depth over the search distance that nodes of a master, which may enter the slave, must not have at first \[-\].
const DEEP: f64 = 2.0;

/// Depth over the shortest edge of the elements around it at which a node may start inside its master in a motion
/// \[-\]: what facets are off a curved surface at an angle of five degrees an element.
const START_DEPTH: f64 = 1e-2;

/// Knows the bodies behind the deformable masters, and looks for slave nodes in them.
#[derive(Debug)]
pub(crate) struct OverlapCheck<'m> {
    model: &'m Model,
    hulls: Vec<Hull>,
}

impl<'m> OverlapCheck<'m> {
    /// # Errors
    /// A boundary that is no surface.
    pub(crate) fn new(model: &'m Model) -> Result<Self, NscdError> {
        let hulls = Hull::masters(model)?;
        Ok(Self { model, hulls })
    }

    /// Refuses to start where a slave node lies in the body of its master and no contact is found for it, or a node of
    /// a master so deep in that of the slave that no contact could be; but not where another interface is nearer.
    pub(crate) fn refuse_start(
        &self,
        search: &mut ContactSearch<'_>,
        tally: &mut Tally,
    ) -> Result<(), NscdError> {
        if self.hulls.is_empty() {
            return Ok(());
        }
        let (model, dim) = (self.model, self.model.solid.dim());
        let mut u = vec![0.0; model.dof_count()];
        model.prescribe(0.0, &mut u);
        let x = model.positions(&u);
        let mut slaves = self.without_contact(&x, 0.0, search, tally).into_iter();
        if let Some((k, inside)) = slaves.find(|(_, i)| i.is_stuck()) {
            return Err(self.refusal(k, inside, Side::Master));
        }
        for hull in Hull::slaves(model)? {
            let reach = model.interfaces[hull.interface].search_distance;
            let masters = hull.insides(&x, dim, &hull.near(&x, dim)).into_iter();
            let mut deep = masters.filter(|i| i.is_stuck() && i.depth() > DEEP * reach);
            if let Some(inside) = deep.next() {
                return Err(self.refusal(hull.interface, inside, Side::Slave));
            }
        }
        Ok(())
    }

    /// Refuses a motion that starts with nodes inside their master that contacts would push out, making energy from
    /// nothing: deeper than a part of the elements around them, of the shortest edges `element_size` \[m\].
    pub(crate) fn refuse_kick(
        &self,
        search: &mut ContactSearch<'_>,
        element_size: &[f64],
    ) -> Result<(), NscdError> {
        let model = self.model;
        if model.scheme.inertia == Inertia::QuasiStatic || model.interfaces.is_empty() {
            return Ok(());
        }
        let mut u = vec![0.0; model.dof_count()];
        model.prescribe(0.0, &mut u);
        let contacts = search.contacts_at(&model.positions(&u), 0.0);
        let allowed = |c: &Contact| START_DEPTH * element_size[c.slave as usize];
        let deep = contacts.iter().filter(|c| -c.gap > allowed(c));
        let Some(deepest) = deep.clone().min_by(|a, b| a.gap.total_cmp(&b.gap)) else {
            return Ok(());
        };
        Err(NscdError::StartsInside {
            nodes: deep.filter(|c| c.interface == deepest.interface).count(),
            node: deepest.slave,
            interface: model.interfaces[deepest.interface].name.clone(),
            depth: -deepest.gap,
            allowed: allowed(deepest),
        })
    }

    fn refusal(&self, interface: usize, inside: Inside, side: Side) -> NscdError {
        let interface = &self.model.interfaces[interface];
        NscdError::Overlap {
            side,
            node: inside.node,
            interface: interface.name.clone(),
            depth: inside.depth(),
            under: inside.side,
            reach: interface.search_distance,
        }
    }

    /// Refuses the end of a step at which a slave node lies under its master although the contact that it had is no
    /// longer found: deeper than the search reaches, or in a fold. One that came in through a side that is no master is
    /// for [`Self::find`].
    pub(crate) fn refuse_lost(
        &self,
        now: &State,
        u: &[f64],
        contacts: &[Contact],
    ) -> Result<(), StepFailure> {
        let dim = self.model.solid.dim();
        let mut x = Vec::new();
        for hull in &self.hulls {
            let in_contact = self.nodes_in_contact(hull, contacts);
            let had = now.contacts.iter();
            let had = had
                .filter(|c| c.interface == hull.interface)
                .map(|c| c.node);
            let lost: Vec<u32> = had
                .filter(|n| in_contact.binary_search(n).is_err())
                .collect();
            if lost.is_empty() {
                continue;
            }
            if x.is_empty() {
                x = self.model.positions(u);
            }
            let mut found = hull.insides(&x, dim, &lost).into_iter();
            if let Some(inside) = found.find(Inside::is_under_side) {
                return Err(StepFailure::Lost {
                    node: inside.node,
                    interface: self.model.interfaces[hull.interface].name.clone(),
                    depth: inside.side,
                });
            }
        }
        Ok(())
    }

    /// Slave nodes inside the bodies of their masters that no contact holds, wherever they came in, but for those that
    /// another interface is nearer to.
    pub(crate) fn find(
        &self,
        state: &State,
        search: &mut ContactSearch<'_>,
        tally: &mut Tally,
    ) -> Option<Overlap> {
        if self.hulls.is_empty() {
            return None;
        }
        let x = self.model.positions(&state.u);
        let mut all = self.without_contact(&x, state.time, search, tally);
        all.retain(|(_, inside)| inside.is_stuck());
        let by_depth =
            |a: &&(usize, Inside), b: &&(usize, Inside)| a.1.depth().total_cmp(&b.1.depth());
        let (interface, deepest) = all.iter().max_by(by_depth)?;
        Some(Overlap {
            nodes: all.len(),
            node: deepest.node,
            interface: *interface,
            depth: deepest.depth(),
        })
    }

    /// Slave nodes without contact inside the bodies of their masters, with their interfaces, at positions `x` \[m\].
    fn without_contact(
        &self,
        x: &[f64],
        time: f64,
        search: &mut ContactSearch<'_>,
        tally: &mut Tally,
    ) -> Vec<(usize, Inside)> {
        let start = tally.seconds();
        let dim = self.model.solid.dim();
        let near: Vec<Vec<u32>> = self.hulls.iter().map(|hull| hull.near(x, dim)).collect();
        let mut all = Vec::new();
        if near.iter().any(|nodes| !nodes.is_empty()) {
            let contacts = search.contacts_at(x, time);
            for (hull, mut near) in self.hulls.iter().zip(near) {
                let in_contact = self.nodes_in_contact(hull, &contacts);
                near.retain(|n| in_contact.binary_search(n).is_err());
                let found = hull.insides(x, dim, &near).into_iter();
                all.extend(found.map(|inside| (hull.interface, inside)));
            }
        }
        tally.book(Phase::Detection, start);
        all
    }

    /// Nodes in contact with the bodies of a hull, increasing. `contacts` belong to any interface.
    fn nodes_in_contact(&self, hull: &Hull, contacts: &[Contact]) -> Vec<u32> {
        let same = self.hulls.iter().filter(|other| other.is_same_body(hull));
        let interfaces: Vec<usize> = same.map(|other| other.interface).collect();
        let of_body = contacts
            .iter()
            .filter(|c| interfaces.contains(&c.interface));
        sorted(of_body.map(|c| c.slave).collect())
    }
}
