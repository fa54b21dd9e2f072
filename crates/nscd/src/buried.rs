//! Nodes of an interface inside the body on its other side, where no contact holds them.

use contact_bipotential::facet::closest_point;
use contact_bipotential::{Contact, Master};
use fe_core::{Facet, Surface};
use nalgebra::Vector3;
use rayon::prelude::*;

use crate::error::{NscdError, StepFailure};
use crate::model::{Model, point};
use crate::report::Phase;
use crate::state::State;
use crate::stepper::Stepper;

/// A node that is asked for its place steps back into its own cell by this part of the cell or, in a slender cell, of its
/// thickness: from a face that two bodies share, or an axis, to where inside and outside differ.
const STEP: f64 = 2e-6;
/// Most that it steps back, as a part of the way to the middle of the cell \[-\].
const MOST: f64 = 1e-2;
/// Depth over the search distance that nodes of a master, which may enter the slave, should not have at the start \[-\].
const DEEP: f64 = 2.0;
/// Slave nodes that a thread takes at once.
const GRAIN: usize = 8;

/// A side of an interface as a body that nodes of the other side should not lie in.
pub(crate) struct Hull {
    interface: usize,
    /// The whole boundary of the bodies.
    boundary: Surface,
    /// What each of its facets is.
    kinds: Vec<Kind>,
    /// Nodes of the other side that are no nodes of these bodies, increasing, each with a cell of its own body.
    guests: Vec<(u32, Vec<u32>)>,
}

/// What a facet of a boundary is to an interface.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Kind {
    /// Part of the side in question.
    Side,
    /// Part of another side, which may push out what came in there.
    Other,
    /// Part of none.
    Bare,
}

/// Slave nodes that no contact holds, inside the bodies of their masters.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Buried {
    /// How many there are.
    pub nodes: usize,
    /// The deepest of them.
    pub node: u32,
    /// Its interface.
    pub interface: usize,
    /// Its distance to the boundary of the master's body \[m\].
    pub depth: f64,
}

/// A node inside a body: distance to the nearest facet of every kind \[m\], but for facets that it lies on.
#[derive(Clone, Copy)]
struct Inside {
    node: u32,
    side: f64,
    other: f64,
    bare: f64,
}

impl Inside {
    /// Whether it came in through the side, as far as one can tell.
    fn is_under_side(&self) -> bool {
        self.side <= self.other.min(self.bare)
    }

    /// Whether no other interface is nearer, that could push it out.
    fn is_stuck(&self) -> bool {
        self.side.min(self.bare) <= self.other
    }

    fn depth(&self) -> f64 {
        self.side.min(self.other).min(self.bare)
    }
}

impl Hull {
    /// The master side of every interface with a deformable master.
    pub(crate) fn masters(model: &Model) -> Result<Vec<Hull>, NscdError> {
        if surfaces(model).next().is_none() {
            return Ok(Vec::new());
        }
        let whole = Whole::of(model);
        let hull = |(k, master): (usize, &Surface)| {
            let side = Side::of_facets(master);
            whole.hull(k, &side, &master.nodes, &model.interfaces[k].slave)
        };
        surfaces(model).map(hull).collect()
    }

    /// The slave side of every interface with a deformable master.
    fn slaves(model: &Model) -> Result<Vec<Hull>, NscdError> {
        let whole = Whole::of(model);
        let hull = |(k, master): (usize, &Surface)| {
            let slave = &model.interfaces[k].slave;
            whole.hull(k, &Side::of_nodes(slave), slave, &master.nodes)
        };
        surfaces(model).map(hull).collect()
    }

    fn cell(&self, node: u32) -> Option<&[u32]> {
        let found = self.guests.binary_search_by_key(&node, |guest| guest.0);
        found.ok().map(|k| self.guests[k].1.as_slice())
    }

    /// Nodes of the other side in the box of the bodies.
    fn near(&self, x: &[f64], dim: usize) -> Vec<u32> {
        let mut bounds = [[f64::INFINITY, f64::NEG_INFINITY]; 3];
        for at in self.boundary.nodes.iter().map(|n| point(x, dim, *n)) {
            for (b, a) in bounds.iter_mut().zip(at) {
                *b = [b[0].min(a), b[1].max(a)];
            }
        }
        let is_within = |n: &u32| {
            let at = point(x, dim, *n);
            (0..dim).all(|c| bounds[c][0] <= at[c] && at[c] <= bounds[c][1])
        };
        let nodes = self.guests.iter().map(|guest| guest.0);
        nodes.filter(is_within).collect()
    }

    /// Whether and how a node lies inside.
    fn inside(&self, x: &[f64], dim: usize, node: u32) -> Option<Inside> {
        let at = point(x, dim, node);
        let back = step_back(x, dim, at, self.cell(node)?);
        let probe = Vector3::from_fn(|c, _| at[c] + back[c]);
        if self.boundary.winding(x, probe) < 0.5 {
            return None;
        }
        let on = 4.0 * back.iter().map(|b| b * b).sum::<f64>();
        let [mut side, mut other, mut bare] = [f64::INFINITY; 3];
        for (facet, kind) in self.boundary.facets.iter().zip(&self.kinds) {
            let mut corners = [Vector3::zeros(); 4];
            let nodes = facet.nodes();
            for (corner, n) in corners.iter_mut().zip(nodes) {
                *corner = point(x, dim, *n).into();
            }
            let d = closest_point(&corners[..nodes.len()], at.into()).distance_squared;
            match kind {
                Kind::Side => side = side.min(d),
                Kind::Other if d > on => other = other.min(d),
                Kind::Bare if d > on => bare = bare.min(d),
                Kind::Other | Kind::Bare => {}
            }
        }
        Some(Inside {
            node,
            side: side.sqrt(),
            other: other.sqrt(),
            bare: bare.sqrt(),
        })
    }

    /// Those of the given nodes that lie inside, in their order.
    fn insides(&self, x: &[f64], dim: usize, nodes: &[u32]) -> Vec<Inside> {
        let all = nodes.par_iter().with_min_len(GRAIN);
        all.filter_map(|n| self.inside(x, dim, *n)).collect()
    }

    fn is_same_body(&self, other: &Hull) -> bool {
        self.boundary.nodes.first() == other.boundary.nodes.first()
    }
}

/// Facets by their nodes.
enum Side {
    Facets(Vec<[u32; 9]>),
    Nodes(Vec<u32>),
}

impl Side {
    fn of_facets(surface: &Surface) -> Self {
        Side::Facets(sorted(surface.facets.iter().map(key).collect()))
    }

    fn of_nodes(nodes: &[u32]) -> Self {
        Side::Nodes(sorted(nodes.to_vec()))
    }

    fn has(&self, facet: &Facet) -> bool {
        match self {
            Side::Facets(keys) => keys.binary_search(&key(facet)).is_ok(),
            Side::Nodes(nodes) => {
                let mut all = facet.nodes().iter();
                all.all(|n| nodes.binary_search(n).is_ok())
            }
        }
    }
}

/// The boundary of all bodies, a cell at each node, and the sides of all interfaces.
struct Whole<'m> {
    model: &'m Model,
    facets: Vec<Facet>,
    cells: Vec<&'m [u32]>,
    sides: Vec<Side>,
}

impl<'m> Whole<'m> {
    fn of(model: &'m Model) -> Self {
        let mesh = model.solid.mesh();
        let mut cells: Vec<&[u32]> = vec![&[]; mesh.points.len()];
        for cell in mesh.blocks.iter().flat_map(|block| block.iter()) {
            for n in cell {
                cells[*n as usize] = cell;
            }
        }
        let slaves = model.interfaces.iter().map(|i| Side::of_nodes(&i.slave));
        let masters = surfaces(model).map(|(_, master)| Side::of_facets(master));
        Whole {
            model,
            facets: mesh.boundary_facets(),
            cells,
            sides: slaves.chain(masters).collect(),
        }
    }

    /// The bodies of the nodes of a side, with `guests` on the other.
    fn hull(
        &self,
        interface: usize,
        side: &Side,
        nodes: &[u32],
        guests: &[u32],
    ) -> Result<Hull, NscdError> {
        let bodies = self.model.solid.bodies().iter();
        let owns = |body: &&Vec<u32>| nodes.iter().any(|n| body.binary_search(n).is_ok());
        let all = sorted(bodies.filter(owns).flatten().copied().collect());
        let own = |n: &u32| all.binary_search(n).is_ok();
        let facets = self.facets.iter().filter(|f| own(&f.nodes()[0]));
        let boundary = Surface::new(facets.copied().collect())?;
        let kind = |facet: &Facet| match side.has(facet) {
            true => Kind::Side,
            false if self.sides.iter().any(|s| s.has(facet)) => Kind::Other,
            false => Kind::Bare,
        };
        let others = sorted(guests.iter().filter(|n| !own(n)).copied().collect());
        let with_cell = |n: u32| (n, self.cells[n as usize].to_vec());
        Ok(Hull {
            interface,
            kinds: boundary.facets.iter().map(kind).collect(),
            boundary,
            guests: others.into_iter().map(with_cell).collect(),
        })
    }
}

fn surfaces(model: &Model) -> impl Iterator<Item = (usize, &Surface)> {
    let all = model.interfaces.iter().enumerate();
    all.filter_map(|(k, interface)| match &interface.master {
        Master::Surface(master) => Some((k, master)),
        Master::Obstacle(_) => None,
    })
}

fn key(facet: &Facet) -> [u32; 9] {
    let mut nodes = facet.nodes;
    nodes.sort_unstable();
    nodes
}

fn sorted<T: Ord>(mut items: Vec<T>) -> Vec<T> {
    items.sort_unstable();
    items
}

/// A little way from a node at `at` to the middle of its cell.
fn step_back(x: &[f64], dim: usize, at: [f64; 3], cell: &[u32]) -> [f64; 3] {
    let mut way = [0.0; 3];
    for corner in cell.iter().map(|n| point(x, dim, *n)) {
        (0..3).for_each(|c| way[c] += (corner[c] - at[c]) / cell.len() as f64);
    }
    let size = way.iter().map(|w| w * w).sum::<f64>().sqrt();
    let sizes = way.iter().map(|w| w.abs()).filter(|w| *w > 1e-6 * size);
    let thickness = sizes.fold(size, f64::min);
    way.map(|w| w * (STEP * size / thickness).min(MOST))
}

/// Nodes that contacts with the bodies of a hull hold, increasing. `contacts` belong to any interface.
fn held(hulls: &[Hull], hull: &Hull, contacts: &[Contact]) -> Vec<u32> {
    let same: Vec<usize> = hulls
        .iter()
        .filter(|other| other.is_same_body(hull))
        .map(|other| other.interface)
        .collect();
    let of_body = contacts.iter().filter(|c| same.contains(&c.interface));
    sorted(of_body.map(|c| c.slave).collect())
}

impl Stepper<'_> {
    /// Slave nodes without contact inside the bodies of their masters, with their interfaces, at the positions `x` \[m\].
    fn unheld(&mut self, x: &[f64], time: f64) -> Vec<(usize, Inside)> {
        let start = self.clock.seconds();
        let dim = self.model.solid.dim();
        let near: Vec<Vec<u32>> = self.hulls.iter().map(|hull| hull.near(x, dim)).collect();
        if near.iter().all(Vec::is_empty) {
            self.book(Phase::Detection, start);
            return Vec::new();
        }
        let contacts = self.detector.detect(x, time, time).contacts;
        let mut all = Vec::new();
        for (hull, mut near) in self.hulls.iter().zip(near) {
            let held = held(&self.hulls, hull, &contacts);
            near.retain(|n| held.binary_search(n).is_err());
            let found = hull.insides(x, dim, &near).into_iter();
            all.extend(found.map(|inside| (hull.interface, inside)));
        }
        self.book(Phase::Detection, start);
        all
    }

    /// Refuses to start where a slave node lies in the body of its master and no contact is found for it, or a node of a master
    /// so deep in that of the slave that no contact could be; but not where another interface is nearer.
    pub(crate) fn refuse_overlap(&mut self) -> Result<(), NscdError> {
        if self.hulls.is_empty() {
            return Ok(());
        }
        let model = self.model;
        let dim = model.solid.dim();
        let mut u = vec![0.0; model.dof_count()];
        model.prescribe(0.0, &mut u);
        let x = model.positions(&u);
        let refused = |interface: usize, inside: Inside, of: &'static str| {
            Err(NscdError::Buried {
                of,
                node: inside.node,
                interface: model.interfaces[interface].name.clone(),
                depth: inside.depth(),
                under: inside.side,
                reach: model.interfaces[interface].search_distance,
            })
        };
        let mut slaves = self.unheld(&x, 0.0).into_iter();
        if let Some((k, inside)) = slaves.find(|(_, i)| i.is_stuck()) {
            return refused(k, inside, "master");
        }
        for hull in Hull::slaves(model)? {
            let reach = model.interfaces[hull.interface].search_distance;
            let masters = hull.insides(&x, dim, &hull.near(&x, dim)).into_iter();
            let mut deep = masters.filter(|i| i.is_stuck() && i.depth() > DEEP * reach);
            if let Some(inside) = deep.next() {
                return refused(hull.interface, inside, "slave");
            }
        }
        Ok(())
    }

    /// Refuses the end of a step at which a slave node lies under its master although the contact that it had is no longer found:
    /// deeper than the search reaches, or in a fold. One that came in through a side that is no master is for [`Self::buried`].
    pub(crate) fn refuse_lost(
        &self,
        now: &State,
        u: &[f64],
        contacts: &[Contact],
    ) -> Result<(), StepFailure> {
        let dim = self.model.solid.dim();
        let mut x = Vec::new();
        for hull in &self.hulls {
            let held = held(&self.hulls, hull, contacts);
            let had = now
                .contacts
                .iter()
                .filter(|c| c.interface == hull.interface);
            let lost = had
                .map(|c| c.node)
                .filter(|n| held.binary_search(n).is_err());
            let lost: Vec<u32> = lost.collect();
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

    /// Slave nodes inside the bodies of their masters that no contact holds, wherever they came in, but for those that another
    /// interface is nearer to.
    pub fn buried(&mut self, state: &State) -> Option<Buried> {
        if self.hulls.is_empty() {
            return None;
        }
        let mut all = self.unheld(&self.model.positions(&state.u), state.time);
        all.retain(|(_, inside)| inside.is_stuck());
        let deepest = all
            .iter()
            .max_by(|a, b| a.1.depth().total_cmp(&b.1.depth()))?;
        Some(Buried {
            nodes: all.len(),
            node: deepest.1.node,
            interface: deepest.0,
            depth: deepest.1.depth(),
        })
    }
}
