//! What does not change during a run.

use contact_bipotential::{Cone, Contact, Interface, Master};
use fe_core::{Dirichlet, MassMatrix, Solid, Table};
use nalgebra::Vector3;

use crate::error::ContactPlace;
use crate::scheme::{Inertia, Scheme};
use crate::settings::Settings;

/// A dead load: a fixed nodal force vector times a function of time.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct Load {
    /// Nodal forces at factor 1 \[N\], flat.
    pub forces: Vec<f64>,
    /// Factor over time \[-\].
    pub factor: Table,
}

impl Load {
    /// The nodal forces \[N\], flat, times a factor over time.
    #[must_use]
    pub fn new(forces: Vec<f64>, factor: Table) -> Self {
        Self { forces, factor }
    }
}

/// Rayleigh damping `A = mass M + stiffness K_0`, with the stiffness of the undeformed bodies.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(default, deny_unknown_fields)
)]
#[non_exhaustive]
pub struct Rayleigh {
    /// Factor of the mass matrix \[1/s\].
    pub mass: f64,
    /// Factor of the initial stiffness \[s\].
    pub stiffness: f64,
}

impl Rayleigh {
    /// Damping `mass M + stiffness K_0`: factors \[1/s\] and \[s\].
    #[must_use]
    pub const fn new(mass: f64, stiffness: f64) -> Self {
        Self { mass, stiffness }
    }

    /// No damping at all.
    pub(crate) fn is_none(&self) -> bool {
        self.mass == 0.0 && self.stiffness == 0.0
    }
}

/// Bodies, supports, loads, interfaces and the scheme: everything that never changes in a run.
///
/// ```
/// use fe_core::{BoxMesh, Dirichlet, Solid, solid_block};
/// use hyperelastic::{ElasticConstants, NeoHookean};
/// use nscd::{Model, Scheme};
///
/// let mesh = BoxMesh::uniform([0.0; 3], [1.0, 1.0, 2.0], [2, 2, 4]).generate("bar")?.validated()?;
/// let base = Dirichlet::clamped("base", mesh.node_set("z_min")?.to_vec());
/// let law = NeoHookean::new(ElasticConstants::from_shear_lame(2e5, 3e5)?)?;
/// let block = solid_block(&mesh, 0, law, 1000.0)?;
/// let model = Model::new(Solid::new(mesh, vec![block])?)
///     .with_support(base)
///     .with_scheme(Scheme::quasi_static());
/// assert_eq!(model.dof_count(), 3 * 45);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug)]
#[non_exhaustive]
pub struct Model {
    /// Deformable bodies.
    pub solid: Solid,
    /// Mass (kept in a quasi-static run too, for the kinetic energy that it neglects).
    pub mass: MassMatrix,
    /// Damping.
    pub damping: Rayleigh,
    /// Supports and driven boundaries; on a node named twice the later one wins.
    pub supports: Vec<Dirichlet>,
    /// Loads.
    pub loads: Vec<Load>,
    /// Contact interfaces.
    pub interfaces: Vec<Interface>,
    /// Time scheme.
    pub scheme: Scheme,
    /// Tolerances and limits.
    pub settings: Settings,
}

impl Model {
    /// Bodies with their consistent mass that nothing holds, loads or damps, under the default scheme and settings.
    #[must_use]
    pub fn new(solid: Solid) -> Self {
        Self {
            mass: solid.consistent_mass(),
            solid,
            damping: Rayleigh::default(),
            supports: Vec::new(),
            loads: Vec::new(),
            interfaces: Vec::new(),
            scheme: Scheme::default(),
            settings: Settings::default(),
        }
    }

    /// The same model with another mass, e.g. a lumped one.
    #[must_use]
    pub fn with_mass(self, mass: MassMatrix) -> Self {
        Self { mass, ..self }
    }

    /// The same model with damping.
    #[must_use]
    pub fn with_damping(self, damping: Rayleigh) -> Self {
        Self { damping, ..self }
    }

    /// The same model with one support or driven boundary more.
    #[must_use]
    pub fn with_support(mut self, support: Dirichlet) -> Self {
        self.supports.push(support);
        self
    }

    /// The same model with one load more.
    #[must_use]
    pub fn with_load(mut self, load: Load) -> Self {
        self.loads.push(load);
        self
    }

    /// The same model with one contact interface more.
    #[must_use]
    pub fn with_interface(mut self, interface: Interface) -> Self {
        self.interfaces.push(interface);
        self
    }

    /// The same model with another time scheme.
    #[must_use]
    pub fn with_scheme(self, scheme: Scheme) -> Self {
        Self { scheme, ..self }
    }

    /// The same model with other tolerances and limits.
    #[must_use]
    pub fn with_settings(self, settings: Settings) -> Self {
        Self { settings, ..self }
    }

    /// Number of unknowns before supports, `dim * nodes`.
    #[must_use]
    pub fn dof_count(&self) -> usize {
        self.solid.dof_count()
    }

    /// Times at which a motion or load changes its form: no step crosses one.
    pub(crate) fn breakpoints(&self) -> Vec<f64> {
        let mut times: Vec<f64> = Vec::new();
        for support in &self.supports {
            times.extend(support.motion.breakpoints());
        }
        for load in &self.loads {
            times.extend(load.factor.breakpoints());
        }
        for interface in &self.interfaces {
            if let Master::Obstacle(obstacle) = &interface.master {
                times.extend(obstacle.motion().breakpoints());
            }
        }
        times.sort_by(f64::total_cmp);
        times.dedup();
        times
    }

    /// Positions of the nodes at displacement `u`, flat \[m\].
    #[must_use]
    pub fn positions(&self, u: &[f64]) -> Vec<f64> {
        let dim = self.solid.dim();
        let points = self.solid.mesh().points.iter();
        points
            .zip(u.chunks_exact(dim))
            .flat_map(|(x, u)| (0..dim).map(move |c| x[c] + u[c]))
            .collect()
    }

    /// Kinetic energy \[J\]; an equilibrium path has none.
    #[must_use]
    pub fn kinetic_energy(&self, v: &[f64]) -> f64 {
        match self.scheme.inertia {
            Inertia::Dynamic => 0.5 * self.mass.quadratic(v),
            Inertia::QuasiStatic => 0.0,
        }
    }

    /// Overwrites `f` with the external forces at time `t` \[N\].
    pub(crate) fn external_force(&self, t: f64, f: &mut [f64]) {
        f.fill(0.0);
        for load in &self.loads {
            let factor = load.factor.value(t);
            for (fi, li) in f.iter_mut().zip(&load.forces) {
                *fi += factor * li;
            }
        }
    }

    /// Overwrites the prescribed entries of `u` with their values at time `t` \[m\].
    pub(crate) fn prescribe(&self, t: f64, u: &mut [f64]) {
        let dim = self.solid.dim();
        for support in &self.supports {
            for &node in &support.nodes {
                let at = support
                    .motion
                    .displacement(self.solid.mesh().points[node as usize], t);
                for c in (0..dim).filter(|&c| support.components[c]) {
                    u[dim * node as usize + c] = at[c];
                }
            }
        }
    }

    /// The local law: one row a contact where nothing rubs.
    pub(crate) fn cone(&self) -> Cone {
        let rubs = |i: &Interface| {
            let bonds = i.adhesion.as_ref();
            i.mu > 0.0 || bonds.is_some_and(|a| a.is_tangential() || a.bonded_friction > Some(0.0))
        };
        if !self.interfaces.iter().any(rubs) {
            Cone::Frictionless
        } else if self.solid.dim() == 2 {
            Cone::Planar
        } else {
            Cone::Spatial
        }
    }

    /// A contact as an error names it.
    pub(crate) fn place(&self, contact: &Contact) -> ContactPlace {
        ContactPlace {
            interface: self.interfaces[contact.interface].name.clone(),
            node: contact.slave,
            gap: contact.gap,
        }
    }

    /// Which nodes may come into contact.
    pub(crate) fn candidates(&self) -> Vec<bool> {
        let mut candidate = vec![false; self.solid.node_count()];
        for interface in &self.interfaces {
            interface
                .slave
                .iter()
                .for_each(|&n| candidate[n as usize] = true);
            if let Master::Surface(surface) = &interface.master {
                surface
                    .nodes
                    .iter()
                    .for_each(|&n| candidate[n as usize] = true);
            }
        }
        candidate
    }

    /// Which dofs are prescribed.
    pub(crate) fn prescribed(&self) -> Vec<bool> {
        let dim = self.solid.dim();
        let mut fixed = vec![false; self.dof_count()];
        for support in &self.supports {
            for &node in &support.nodes {
                for c in (0..dim).filter(|&c| support.components[c]) {
                    fixed[dim * node as usize + c] = true;
                }
            }
        }
        fixed
    }
}

/// The place of a node in a flat array of `dim` components a node; the third is 0 in the plane.
pub(crate) fn point(x: &[f64], dim: usize, node: u32) -> Vector3<f64> {
    let at = &x[dim * node as usize..dim * (node as usize + 1)];
    Vector3::from_fn(|c, _| at.get(c).copied().unwrap_or(0.0))
}
