//! The boundary of the bodies on one side of an interface, and the nodes of the other side that may lie inside.

use contact_bipotential::{Master, closest_point};
use fe_core::{Facet, FacetKind, Surface};
use nalgebra::Vector3;
use rayon::prelude::*;

use crate::error::NscdError;
use crate::model::{Model, point};

/// A node that is asked for its place steps back into its own cell by this part of the cell or, in a slender cell, of
/// its thickness: from a face that two bodies share, or an axis, to where inside and outside differ \[-\].
const STEP: f64 = 2e-6;
/// Most that it steps back, as a part of the way to the middle of the cell \[-\].
const MOST: f64 = 1e-2;
/// Components of the way to the middle of a cell below this part of its length are no thickness \[-\].
const FLAT: f64 = 1e-6;
/// Winding number of a boundary around a point above which the point lies inside \[-\]: 1 inside, 0 outside.
const INSIDE: f64 = 0.5;
/// A facet nearer than this many times the step back is one that the node lies on \[-\].
const ON: f64 = 2.0;
/// Slave nodes that a thread takes at once.
const GRAIN: usize = 8;

/// Corners of the largest facet of a [`Surface`], which cuts quadratic ones into linear pieces.
const CORNERS: usize = FacetKind::Quad4.node_count();

/// Nodes of a facet, increasing, as many as the largest has.
type FacetKey = [u32; FacetKind::Quad9.node_count()];

/// A side of an interface as a body that nodes of the other side should not lie in.
#[derive(Debug)]
pub(super) struct Hull {
    pub(super) interface: usize,
    /// The whole boundary of the bodies.
    boundary: Surface,
    /// What each of its facets is.
    kinds: Vec<Kind>,
    /// Nodes of the other side that are no nodes of these bodies, increasing, each with a cell of its own body.
    guests: Vec<(u32, Vec<u32>)>,
}

/// What a facet of a boundary is to an interface.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Kind {
    /// Part of the side in question.
    Side,
    /// Part of another side, which may push out what came in there.
    Other,
    /// Part of none.
    Bare,
}

/// A node inside a body: distance to the nearest facet of every kind \[m\], but for facets that it lies on.
#[derive(Clone, Copy)]
pub(super) struct Inside {
    pub(super) node: u32,
    pub(super) side: f64,
    other: f64,
    bare: f64,
}

impl Inside {
    /// Whether it came in through the side, as far as one can tell.
    pub(super) fn is_under_side(&self) -> bool {
        self.side <= self.other.min(self.bare)
    }

    /// Whether no other interface is nearer, that could push it out.
    pub(super) fn is_stuck(&self) -> bool {
        self.side.min(self.bare) <= self.other
    }

    pub(super) fn depth(&self) -> f64 {
        self.side.min(self.other).min(self.bare)
    }
}

impl Hull {
    /// The master side of every interface with a deformable master.
    pub(super) fn masters(model: &Model) -> Result<Vec<Hull>, NscdError> {
        if surfaces(model).next().is_none() {
            return Ok(Vec::new());
        }
        let whole = Whole::of(model);
        let hull = |(k, master): (usize, &Surface)| {
            let side = FacetSet::of_facets(master);
            whole.hull(k, &side, &master.nodes, &model.interfaces[k].slave)
        };
        surfaces(model).map(hull).collect()
    }

    /// The slave side of every interface with a deformable master.
    pub(super) fn slaves(model: &Model) -> Result<Vec<Hull>, NscdError> {
        let whole = Whole::of(model);
        let hull = |(k, master): (usize, &Surface)| {
            let slave = &model.interfaces[k].slave;
            whole.hull(k, &FacetSet::of_nodes(slave), slave, &master.nodes)
        };
        surfaces(model).map(hull).collect()
    }

    fn cell(&self, node: u32) -> Option<&[u32]> {
        let found = self.guests.binary_search_by_key(&node, |guest| guest.0);
        found.ok().map(|k| self.guests[k].1.as_slice())
    }

    /// Nodes of the other side in the box of the bodies.
    pub(super) fn near(&self, x: &[f64], dim: usize) -> Vec<u32> {
        let mut low = Vector3::repeat(f64::INFINITY);
        let mut high = -low;
        for at in self.boundary.nodes.iter().map(|n| point(x, dim, *n)) {
            (low, high) = (low.inf(&at), high.sup(&at));
        }
        let is_within = |n: &u32| {
            let at = point(x, dim, *n);
            (0..dim).all(|c| low[c] <= at[c] && at[c] <= high[c])
        };
        let nodes = self.guests.iter().map(|guest| guest.0);
        nodes.filter(is_within).collect()
    }

    /// Whether and how a node lies inside.
    fn inside(&self, x: &[f64], dim: usize, node: u32) -> Option<Inside> {
        let at = point(x, dim, node);
        let back = step_back(x, dim, at, self.cell(node)?);
        if self.boundary.winding(x, at + back) < INSIDE {
            return None;
        }
        let on = ON * ON * back.norm_squared();
        let [mut side, mut other, mut bare] = [f64::INFINITY; 3];
        for (facet, kind) in self.boundary.facets.iter().zip(&self.kinds) {
            let mut corners = [Vector3::zeros(); CORNERS];
            let nodes = facet.nodes();
            for (corner, n) in corners.iter_mut().zip(nodes) {
                *corner = point(x, dim, *n);
            }
            let d = closest_point(&corners[..nodes.len()], at).distance_squared;
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
    pub(super) fn insides(&self, x: &[f64], dim: usize, nodes: &[u32]) -> Vec<Inside> {
        let all = nodes.par_iter().with_min_len(GRAIN);
        all.filter_map(|n| self.inside(x, dim, *n)).collect()
    }

    pub(super) fn is_same_body(&self, other: &Hull) -> bool {
        self.boundary.nodes.first() == other.boundary.nodes.first()
    }
}

/// Facets by their nodes.
enum FacetSet {
    Facets(Vec<FacetKey>),
    Nodes(Vec<u32>),
}

impl FacetSet {
    fn of_facets(surface: &Surface) -> Self {
        FacetSet::Facets(sorted(surface.facets.iter().map(key).collect()))
    }

    fn of_nodes(nodes: &[u32]) -> Self {
        FacetSet::Nodes(sorted(nodes.to_vec()))
    }

    fn has(&self, facet: &Facet) -> bool {
        match self {
            FacetSet::Facets(keys) => keys.binary_search(&key(facet)).is_ok(),
            FacetSet::Nodes(nodes) => {
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
    sides: Vec<FacetSet>,
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
        let slaves = model
            .interfaces
            .iter()
            .map(|i| FacetSet::of_nodes(&i.slave));
        let masters = surfaces(model).map(|(_, master)| FacetSet::of_facets(master));
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
        side: &FacetSet,
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

fn key(facet: &Facet) -> FacetKey {
    let mut nodes = facet.nodes;
    nodes.sort_unstable();
    nodes
}

pub(super) fn sorted<T: Ord>(mut items: Vec<T>) -> Vec<T> {
    items.sort_unstable();
    items
}

/// A little way from a node at `at` to the middle of its cell.
fn step_back(x: &[f64], dim: usize, at: Vector3<f64>, cell: &[u32]) -> Vector3<f64> {
    let corners = cell.iter().map(|n| point(x, dim, *n));
    let way: Vector3<f64> = corners
        .map(|corner| (corner - at) / cell.len() as f64)
        .sum();
    let size = way.norm();
    let sizes = way.iter().map(|w| w.abs()).filter(|w| *w > FLAT * size);
    let thickness = sizes.fold(size, f64::min);
    way.map(|w| w * (STEP * size / thickness).min(MOST))
}
