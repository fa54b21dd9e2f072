//! Slave nodes inside a deformable body without a contact that could hold them.

use contact_bipotential::facet::closest_point;
use contact_bipotential::{Contact, Detector, Master};
use fe_core::{Facet, Surface, Symmetry};

use crate::error::{NscdError, StepFailure};
use crate::model::{Model, point};

/// Depth up to which a node lies on the boundary of a body, as a part of the search distance \[-\].
const SKIN: f64 = 1e-6;

/// The whole boundary of the bodies that a deformable master belongs to, and the slave nodes of other bodies.
pub(crate) struct Hull {
    interface: usize,
    boundary: Surface,
    /// Which facets of the boundary are the master.
    is_master: Vec<bool>,
    slave: Vec<u32>,
    skin: f64,
}

impl Hull {
    /// One for every interface with a deformable master.
    pub(crate) fn of(model: &Model) -> Result<Vec<Hull>, NscdError> {
        let facets = model.solid.mesh().boundary_facets();
        let mut hulls = Vec::new();
        for (k, interface) in model.interfaces.iter().enumerate() {
            if let Master::Surface(master) = &interface.master {
                let body = body_of(model, master);
                let own = |n: &u32| body.binary_search(n).is_ok();
                let of_body = facets.iter().filter(|f| own(&f.nodes()[0]));
                let boundary = Surface::new(of_body.copied().collect())?;
                let others = interface.slave.iter().filter(|n| !own(n));
                hulls.push(Hull {
                    interface: k,
                    is_master: is_master(&boundary, master),
                    boundary,
                    slave: others.copied().collect(),
                    skin: SKIN * interface.search_distance,
                });
            }
        }
        Ok(hulls)
    }

    /// Slave nodes in the box of the body, but for its skin.
    fn near(&self, x: &[f64], dim: usize) -> Vec<u32> {
        let mut bounds = [[f64::INFINITY, f64::NEG_INFINITY]; 3];
        for at in self.boundary.nodes.iter().map(|n| point(x, dim, *n)) {
            for (b, a) in bounds.iter_mut().zip(at) {
                *b = [b[0].min(a), b[1].max(a)];
            }
        }
        let is_within = |n: &&u32| {
            let at = point(x, dim, **n);
            (0..dim).all(|c| bounds[c][0] + self.skin < at[c] && at[c] < bounds[c][1] - self.skin)
        };
        self.slave.iter().filter(is_within).copied().collect()
    }

    fn holds(&self, x: &[f64], dim: usize, at: [f64; 3]) -> bool {
        let beside = |c: usize, step: f64| {
            let mut point = at;
            point[c] += step;
            self.boundary.winding(x, point) > 0.5
        };
        (0..dim).all(|c| beside(c, self.skin) && beside(c, -self.skin))
    }

    /// Distance to the nearest facet of the boundary \[m\], and whether that is the master's.
    fn nearest(&self, x: &[f64], dim: usize, at: [f64; 3]) -> (f64, bool) {
        let distance = |facet: &Facet| {
            let corners: Vec<_> = facet.nodes().iter().map(|n| point(x, dim, *n)).collect();
            closest_point(&corners, at).distance_squared
        };
        let all = self.boundary.facets.iter().map(distance);
        let nearest = all.zip(&self.is_master).min_by(|a, b| a.0.total_cmp(&b.0));
        nearest.map_or((0.0, false), |(d, is_master)| (d.sqrt(), *is_master))
    }
}

/// Nodes of the bodies that a master belongs to, sorted.
fn body_of(model: &Model, master: &Surface) -> Vec<u32> {
    let bodies = model.solid.bodies().iter();
    let owns = |body: &&Vec<u32>| master.nodes.iter().any(|n| body.binary_search(n).is_ok());
    let mut nodes: Vec<u32> = bodies.filter(owns).flatten().copied().collect();
    nodes.sort_unstable();
    nodes
}

fn is_master(boundary: &Surface, master: &Surface) -> Vec<bool> {
    let key = |facet: &Facet| {
        let mut nodes = facet.nodes;
        nodes.sort_unstable();
        nodes
    };
    let mut keys: Vec<_> = master.facets.iter().map(key).collect();
    keys.sort_unstable();
    let facets = boundary.facets.iter();
    facets
        .map(|f| keys.binary_search(&key(f)).is_ok())
        .collect()
}

/// A slave node without contact inside the body of its master.
struct Buried {
    node: u32,
    interface: usize,
    depth: f64,
    /// The master is the nearest part of the body's boundary.
    under_master: bool,
}

/// The first for which `counts`, at positions `x` \[m\] at which the search found `contacts`.
fn first_buried(
    model: &Model,
    hulls: &[Hull],
    x: &[f64],
    contacts: &[Contact],
    counts: impl Fn(&Buried) -> bool,
) -> Option<Buried> {
    let dim = model.solid.dim();
    let mut held: Vec<u32> = Vec::new();
    for hull in hulls {
        let near = hull.near(x, dim);
        if !near.is_empty() && held.is_empty() {
            held.extend(contacts.iter().map(|c| c.slave));
            held.sort_unstable();
        }
        let unheld = near.into_iter().filter(|n| held.binary_search(n).is_err());
        for node in unheld {
            let mut at = point(x, dim, node);
            if model.solid.mesh().symmetry == Symmetry::Axisymmetric {
                // The body goes on behind the axis.
                at[0] = at[0].max(2.0 * hull.skin);
            }
            if !hull.holds(x, dim, at) {
                continue;
            }
            let (depth, under_master) = hull.nearest(x, dim, at);
            let interface = hull.interface;
            let found = Buried {
                node,
                interface,
                depth,
                under_master,
            };
            if counts(&found) {
                return Some(found);
            }
        }
    }
    None
}

/// Refuses to start where a slave node lies in the body of its master and no contact is found for it.
pub(crate) fn refuse_overlap(
    model: &Model,
    hulls: &[Hull],
    detector: &mut Detector,
) -> Result<(), NscdError> {
    if hulls.is_empty() {
        return Ok(());
    }
    let mut u = vec![0.0; model.dof_count()];
    model.prescribe(0.0, &mut u);
    let x = model.positions(&u);
    let found = detector.detect(&x, 0.0, 0.0);
    match first_buried(model, hulls, &x, &found.contacts, |_| true) {
        Some(b) => Err(NscdError::Buried {
            node: b.node,
            interface: model.interfaces[b.interface].name.clone(),
            depth: b.depth,
            reach: model.interfaces[b.interface].search_distance,
        }),
        None => Ok(()),
    }
}

/// Refuses the end of a step at which a slave node lies under its master without a contact: the search has lost it, deeper than
/// it reaches or in a fold. One that came in through a side that is no master is the scene's affair.
pub(crate) fn refuse_lost(
    model: &Model,
    hulls: &[Hull],
    u: &[f64],
    contacts: &[Contact],
) -> Result<(), StepFailure> {
    if hulls.is_empty() {
        return Ok(());
    }
    let x = model.positions(u);
    match first_buried(model, hulls, &x, contacts, |b| b.under_master) {
        Some(b) => Err(StepFailure::Lost {
            node: b.node,
            interface: model.interfaces[b.interface].name.clone(),
            depth: b.depth,
        }),
        None => Ok(()),
    }
}
