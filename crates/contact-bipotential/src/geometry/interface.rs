//! What may touch what: slave nodes against a master, with the law's parameters.

use fe_core::Surface;

use crate::error::ParameterError;
use crate::geometry::error::{GeometryError, InterfaceFault};
use crate::geometry::obstacle::Obstacle;
use crate::rcc::Adhesion;

/// What slave nodes may touch.
#[derive(Clone, Debug)]
#[allow(clippy::large_enum_variant)] // one an interface: boxing would buy nothing
pub enum Master {
    /// A rigid body with prescribed motion.
    Obstacle(Obstacle),
    /// A part of the boundary of a deformable body.
    Surface(Surface),
}

/// A set of slave nodes and their master.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Interface {
    /// Name, for reports and errors.
    pub name: String,
    /// Slave nodes, in the order in which their contacts are numbered.
    pub slave: Vec<u32>,
    /// Tributary reference area of each slave node \[m^2\]; in the plane, \[m\] times unit thickness. A node without
    /// area touches the master like the others, but has no bond.
    pub area: Vec<f64>,
    /// What the nodes may touch.
    pub master: Master,
    /// Coulomb friction coefficient \[-\], >= 0.
    pub mu: f64,
    /// Newton restitution coefficient \[-\], in [0, 1].
    pub restitution: f64,
    /// A node closer than this to the master becomes a contact, open or closed \[m\]. A node that lies deeper
    /// than this behind a deformable master is not in contact: it came from the other side.
    pub search_distance: f64,
    /// How far a node may overhang the rim of a deformable master and still rest on it, as a part of the size
    /// of the facet \[-\], >= 0. Enough for bodies with flush sides to stay in contact through round-off;
    /// larger values keep flush sides that bulge differently together, at the price of a ledge that wide.
    pub rim_tolerance: f64,
    /// Adhesion; `None` where the surfaces do not stick together.
    pub adhesion: Option<Adhesion>,
}

/// Default of [`Interface::rim_tolerance`] \[-\]: far above the round-off of a node that lies on the rim itself, far
/// below what a surface bulges. Where flush bodies deform, give a ledge that they may bulge by.
pub const RIM_ROUND_OFF: f64 = 1e-6;

impl Interface {
    /// A frictionless interface without restitution and with the default rim tolerance.
    #[must_use]
    pub fn new(
        name: &str,
        slave: Vec<u32>,
        area: Vec<f64>,
        master: Master,
        search_distance: f64,
    ) -> Self {
        Self {
            name: name.to_owned(),
            slave,
            area,
            master,
            mu: 0.0,
            restitution: 0.0,
            search_distance,
            rim_tolerance: RIM_ROUND_OFF,
            adhesion: None,
        }
    }

    /// The same interface with the Coulomb friction coefficient `mu` \[-\].
    #[must_use]
    pub fn with_friction(self, mu: f64) -> Self {
        Self { mu, ..self }
    }

    /// The same interface with a Newton restitution coefficient \[-\].
    #[must_use]
    pub fn with_restitution(self, restitution: f64) -> Self {
        Self {
            restitution,
            ..self
        }
    }

    /// The same interface with another [`rim_tolerance`](Self::rim_tolerance) \[-\].
    #[must_use]
    pub fn with_rim_tolerance(self, rim_tolerance: f64) -> Self {
        Self {
            rim_tolerance,
            ..self
        }
    }

    /// The same interface with bonds between its surfaces, or without.
    #[must_use]
    pub fn with_adhesion(self, adhesion: impl Into<Option<Adhesion>>) -> Self {
        Self {
            adhesion: adhesion.into(),
            ..self
        }
    }

    /// Checks the interface against a mesh of `nodes` nodes with `dim` unknowns each.
    ///
    /// # Errors
    /// [`GeometryError`] that names the interface and the bound.
    pub fn validate(&self, nodes: usize, dim: usize) -> Result<(), GeometryError> {
        let fault = self.validate_slaves(nodes).and_then(|()| {
            self.validate_parameters()?;
            match &self.master {
                Master::Obstacle(obstacle) if dim == 2 => obstacle.validate_in_plane(),
                Master::Obstacle(_) => Ok(()),
                Master::Surface(surface) => self.validate_surface(surface, nodes, dim),
            }
        });
        fault.map_err(|reason| GeometryError::Interface {
            interface: self.name.clone(),
            reason,
        })
    }

    fn validate_slaves(&self, nodes: usize) -> Result<(), InterfaceFault> {
        let (areas, slaves) = (self.area.len(), self.slave.len());
        if slaves == 0 {
            return Err(InterfaceFault::NoSlave);
        }
        if areas != slaves {
            return Err(InterfaceFault::Areas { areas, slaves });
        }
        validate_nodes("slave", &self.slave, nodes)?;
        match self.area.iter().find(|a| !(**a >= 0.0 && a.is_finite())) {
            Some(&area) => Err(InterfaceFault::Area { area }),
            None => Ok(()),
        }
    }

    fn validate_parameters(&self) -> Result<(), ParameterError> {
        let reach = self.search_distance;
        let bounds = [
            ("mu", self.mu, 0.0, f64::MAX, "must be >= 0 and finite"),
            (
                "restitution",
                self.restitution,
                0.0,
                1.0,
                "must lie in [0, 1]",
            ),
            (
                "search distance [m]",
                reach,
                f64::MIN_POSITIVE,
                f64::MAX,
                "must be > 0 and finite",
            ),
            (
                "rim tolerance",
                self.rim_tolerance,
                0.0,
                1.0,
                "must lie in [0, 1]",
            ),
        ];
        for (name, value, least, most, bound) in bounds {
            if !(value >= least && value <= most) {
                return Err(ParameterError { name, value, bound });
            }
        }
        self.adhesion
            .map_or(Ok(()), |law| law.validated().map(|_| ()))
    }

    fn validate_surface(
        &self,
        surface: &Surface,
        nodes: usize,
        dim: usize,
    ) -> Result<(), InterfaceFault> {
        if surface.dim() != dim {
            let master_dim = surface.dim();
            return Err(InterfaceFault::Dimension { master_dim, dim });
        }
        validate_nodes("master", &surface.nodes, nodes)?;
        match self.slave.iter().find(|n| surface.index_of(**n).is_some()) {
            Some(&node) => Err(InterfaceFault::Both { node }),
            None => Ok(()),
        }
    }
}

fn validate_nodes(side: &'static str, all: &[u32], nodes: usize) -> Result<(), InterfaceFault> {
    match all.iter().find(|n| **n as usize >= nodes) {
        Some(&node) => Err(InterfaceFault::Node { side, node, nodes }),
        None => Ok(()),
    }
}
