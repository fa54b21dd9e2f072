//! Contact search: from positions to a [`ContactMap`].

mod rims;
mod surface_search;

use nalgebra::Vector3;
use rayon::prelude::*;

use crate::cone::Cone;
use crate::geometry::contact::{Contact, ContactKey, Stencil};
use crate::geometry::error::GeometryError;
use crate::geometry::interface::{Interface, Master};
use crate::geometry::kinematics::{ContactMap, FrameRule};
use crate::geometry::obstacle::{Obstacle, PlacedObstacle, Shape};
use crate::geometry::vector::{at_node, unit};

use surface_search::{SurfaceContact, SurfaceSearch};

/// A node this close to a cone's apex or an axis of symmetry, as a part of the search distance, lies on it.
const CORE: f64 = 1e-6;
/// Least mean of the vertex normals of a surface with a typical normal \[-\]: those of a closed one cancel to
/// round-off.
const CANCELLED: f64 = 1e-6;
/// Slave nodes a thread takes at once: a projection is far cheaper than handing it over.
const GRAIN: usize = 64;

/// What the search has done since it was made: proof of what was skipped.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct DetectionCounters {
    /// Searches that ended with the box test: no slave node near the master.
    pub box_rejections: u64,
    /// Trees built or refitted because the master had moved out of its padded boxes.
    pub bvh_refits: u64,
    /// Projections of a node on a facet.
    pub facet_projections: u64,
}

/// Finds contacts. Holds the interfaces and caches; the caches only speed up, they decide nothing.
///
/// ```
/// use contact_bipotential::nalgebra::Vector3;
/// use contact_bipotential::{Cone, Detector, Interface, Master, Obstacle, Shape};
/// use fe_core::Motion;
///
/// let plane = Shape::Plane { point: Vector3::zeros(), normal: Vector3::z() };
/// let floor = Master::Obstacle(Obstacle::new(plane, Motion::still())?);
/// // The second of two nodes, with an area of 1 m^2, searched up to 0.5 m.
/// let interface = Interface::new("floor", vec![1], vec![1.0], floor, 0.5);
/// let positions = [0.0, 0.0, 2.0, 1.0, 0.0, 0.25];
/// let mut detector = Detector::new(vec![interface], &positions, 3, Cone::Spatial)?;
/// let map = detector.detect(&positions, 0.0, 1.0);
/// assert_eq!(map.gaps(), [0.25]);
/// assert_eq!(map.contacts[0].normal(), Vector3::z());
/// # Ok::<(), contact_bipotential::GeometryError>(())
/// ```
#[derive(Debug)]
pub struct Detector {
    interfaces: Vec<Interface>,
    searches: Vec<Option<SurfaceSearch>>,
    frames: Vec<FrameRule>,
    /// How far each interface is searched \[m\].
    reaches: Vec<f64>,
    dim: usize,
    cone: Cone,
    counters: DetectionCounters,
}

impl Detector {
    /// A detector for a mesh with `dim` unknowns a node and reference positions `reference` \[m\], flat,
    /// `dim * node + component`. `cone` says how many components a contact has: frictionless, or `dim`.
    ///
    /// # Errors
    /// [`GeometryError`] if an interface does not fit the mesh or a parameter lies outside of its bound.
    pub fn new(
        interfaces: Vec<Interface>,
        reference: &[f64],
        dim: usize,
        cone: Cone,
    ) -> Result<Self, GeometryError> {
        if !(dim == 2 || dim == 3) || !reference.len().is_multiple_of(dim) {
            return Err(GeometryError::Positions {
                dim,
                length: reference.len(),
            });
        }
        if cone != Cone::Frictionless && cone.dim() != dim {
            return Err(GeometryError::Cone { cone, dim });
        }
        for interface in &interfaces {
            interface.validate(reference.len() / dim, dim)?;
        }
        let searches = interfaces
            .iter()
            .map(|interface| match &interface.master {
                Master::Obstacle(_) => None,
                Master::Surface(surface) => {
                    let (reach, rim) = (interface.search_distance, interface.rim_tolerance);
                    Some(SurfaceSearch::new(surface, reach, rim))
                }
            })
            .collect();
        let frames = interfaces
            .iter()
            .map(|interface| frame_rule(interface, reference, dim))
            .collect();
        let counters = DetectionCounters::default();
        Ok(Self {
            reaches: interfaces.iter().map(|i| i.search_distance).collect(),
            interfaces,
            searches,
            frames,
            dim,
            cone,
            counters,
        })
    }

    /// The detector of an axisymmetric problem: x is the radius, y runs along the axis.
    ///
    /// A deformable master that ends on the axis is continued by its mirror image. Without that, a node over the
    /// pole of a dome would overhang the end of the last facet, which slopes. `reference` are the positions \[m\]
    /// given to [`new`](Self::new); problems with 3 unknowns a node stay as they are.
    #[must_use]
    pub fn axisymmetric(mut self, reference: &[f64]) -> Self {
        if self.dim == 2 {
            for (interface, search) in self.interfaces.iter().zip(&mut self.searches) {
                let core = CORE * interface.search_distance;
                let is_on_axis = |node| at_node(reference, 2, node)[0].abs() <= core;
                if let Some(search) = search {
                    search.mirror_at_axis(is_on_axis);
                }
            }
        }
        self
    }

    /// Searches an interface farther than its search distance, as far as `reach` \[m\]: bonds may hold beyond it. A
    /// smaller `reach` means the search distance again.
    pub fn extend(&mut self, interface: usize, reach: f64) {
        let reach = reach.max(self.interfaces[interface].search_distance);
        self.reaches[interface] = reach;
        if let Some(search) = &mut self.searches[interface] {
            search.set_reach(reach);
        }
    }

    /// The interfaces, in the order that [`Contact::interface`] counts.
    #[must_use]
    pub fn interfaces(&self) -> &[Interface] {
        &self.interfaces
    }

    /// What has been done so far.
    #[must_use]
    pub fn counters(&self) -> DetectionCounters {
        self.counters
    }

    /// All slave nodes within the search distance of their master, open or closed, at the positions of the
    /// end of a step from `t0` to `t1` \[s\].
    ///
    /// `positions` are current \[m\], flat, `dim * node + component`. The order is that of the interfaces, then of
    /// their slave nodes; the result depends on the arguments only, not on earlier searches or on threads.
    pub fn detect(&mut self, positions: &[f64], t0: f64, t1: f64) -> ContactMap {
        let mut contacts = Vec::new();
        for k in 0..self.interfaces.len() {
            let seeker = Seeker {
                index: k,
                interface: &self.interfaces[k],
                rule: self.frames[k],
                reach: self.reaches[k],
                positions,
                dim: self.dim,
            };
            match (&self.interfaces[k].master, &mut self.searches[k]) {
                (Master::Obstacle(obstacle), _) => {
                    seeker.against_obstacle(obstacle, t0, t1, &mut contacts)
                }
                (_, Some(search)) => {
                    seeker.against_surface(search, &mut self.counters, &mut contacts)
                }
                // A surface always has its search.
                (Master::Surface(_), None) => {}
            }
        }
        ContactMap::new(contacts, self.dim, self.cone)
    }
}

/// Frames are anchored at the typical normal of the master: exactly constant for a flat one.
fn frame_rule(interface: &Interface, reference: &[f64], dim: usize) -> FrameRule {
    if dim == 2 {
        return FrameRule::planar();
    }
    let mut sum = Vector3::zeros();
    match &interface.master {
        Master::Obstacle(obstacle) => {
            let placed = obstacle.over_step(0.0, 0.0);
            for (node, area) in interface.slave.iter().zip(&interface.area) {
                let at = placed.closest(at_node(reference, dim, *node), 0.0);
                sum += *area * at.normal;
            }
            if let Shape::Plane { normal, .. } = placed.shape() {
                sum = *normal;
            }
        }
        Master::Surface(surface) => {
            for n in surface.vertex_normals(reference) {
                sum += n;
            }
            // The normals of a closed surface cancel but for round-off, which is no direction.
            sum = significant(sum, surface.nodes.len() as f64);
        }
    }
    FrameRule::spatial(sum)
}

fn significant(sum: Vector3<f64>, terms: f64) -> Vector3<f64> {
    if sum.iter().all(|c| c.abs() < CANCELLED * terms) {
        Vector3::zeros()
    } else {
        sum
    }
}

/// The search of one interface at one configuration.
struct Seeker<'a> {
    index: usize,
    interface: &'a Interface,
    rule: FrameRule,
    reach: f64,
    positions: &'a [f64],
    dim: usize,
}

impl Seeker<'_> {
    fn slave_position(&self, slave_index: usize) -> Vector3<f64> {
        at_node(self.positions, self.dim, self.interface.slave[slave_index])
    }

    fn against_obstacle(&self, obstacle: &Obstacle, t0: f64, t1: f64, contacts: &mut Vec<Contact>) {
        let placed = obstacle.over_step(t0, t1);
        let found = (0..self.interface.slave.len()).filter_map(|k| self.touch_obstacle(&placed, k));
        contacts.extend(found);
    }

    fn key(&self, slave_index: usize) -> ContactKey {
        ContactKey::new(self.index, slave_index)
    }

    /// However deep: a rigid solid has no other side to come from.
    fn touch_obstacle(&self, placed: &PlacedObstacle, slave_index: usize) -> Option<Contact> {
        let slave = self.interface.slave[slave_index];
        let reach = self.reach;
        let at = placed.closest(self.slave_position(slave_index), CORE * reach);
        (at.gap <= reach).then(|| {
            let frame = self.rule.at(at.normal);
            Contact::new(self.key(slave_index), Stencil::rigid(slave), frame, at.gap)
                .on_moving_obstacle(placed.displacement(at.point))
        })
    }

    fn against_surface(
        &self,
        search: &mut SurfaceSearch,
        counters: &mut DetectionCounters,
        contacts: &mut Vec<Contact>,
    ) {
        search.gather(self.positions);
        let slaves = 0..self.interface.slave.len();
        if search.is_out_of_reach(slaves.clone().map(|k| self.slave_position(k))) {
            counters.box_rejections += 1;
            return;
        }
        let Master::Surface(surface) = &self.interface.master else {
            return;
        };
        counters.bvh_refits += u64::from(search.refit());
        search.set_normals(surface.vertex_normals(self.positions));
        let search = &*search;
        let found: Vec<(Option<Contact>, u64)> = slaves
            .into_par_iter()
            .with_min_len(GRAIN)
            .map_init(Vec::new, |candidates, k| {
                let touch = search.touch(self.slave_position(k), candidates);
                (
                    touch.contact.map(|at| self.surface_contact(&at, k)),
                    touch.projections,
                )
            })
            .collect();
        counters.facet_projections += found
            .iter()
            .map(|(_, projections)| projections)
            .sum::<u64>();
        contacts.extend(found.into_iter().filter_map(|(contact, _)| contact));
    }

    fn surface_contact(&self, at: &SurfaceContact, slave_index: usize) -> Contact {
        let slave = self.interface.slave[slave_index];
        let stencil = Stencil::deformable(slave, at.nodes.indices(), &at.weights);
        let frame = self.rule.at(unit(at.normal).unwrap_or(at.normal));
        Contact::new(self.key(slave_index), stencil, frame, at.gap).on_facet(at.facet)
    }
}

#[cfg(test)]
mod tests;
