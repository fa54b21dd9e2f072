//! What acts on a solid from outside: prescribed motion, dead tractions, gravity.
//!
//! Vectors are flat, `dim * node + component`. Nodes must exist; `check` says if they do.

use nalgebra::Vector3;

use crate::element::Facet;
use crate::error::FeError;
use crate::mass::MassMatrix;
use crate::mesh::Mesh;
use crate::motion::{Motion, Table};
use crate::surface::Surface;

/// Nodes whose displacement is prescribed, in some or all components.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Dirichlet {
    /// Nodes, sorted.
    pub nodes: Vec<u32>,
    /// Components that are prescribed; the others are free.
    pub components: [bool; 3],
    /// Motion of the material points.
    pub motion: Motion,
    /// Name, for errors and output.
    pub name: String,
}

impl Dirichlet {
    /// Nodes held in place in all components.
    #[must_use]
    pub fn clamped(name: &str, nodes: Vec<u32>) -> Dirichlet {
        Dirichlet {
            nodes,
            components: [true; 3],
            motion: Motion::still(),
            name: name.to_owned(),
        }
    }

    /// With only these components prescribed.
    #[must_use]
    pub fn with_components(mut self, components: [bool; 3]) -> Dirichlet {
        self.components = components;
        self
    }

    /// With nodes that are moved.
    #[must_use]
    pub fn with_motion(mut self, motion: Motion) -> Dirichlet {
        self.motion = motion;
        self
    }

    /// Checks that all nodes exist.
    ///
    /// # Errors
    /// [`FeError::Index`] for the first that does not.
    pub fn check(&self, mesh: &Mesh) -> Result<(), FeError> {
        check_nodes(self.nodes.iter(), mesh)
    }

    /// Prescribed degrees of freedom, in the order of the nodes.
    pub fn dofs(&self, dim: usize) -> impl Iterator<Item = usize> + '_ {
        let components = (0..dim).filter(|&i| self.components[i]);
        let components: Vec<usize> = components.collect();
        let of_node = move |&node: &u32| {
            let start = dim * node as usize;
            components.clone().into_iter().map(move |i| start + i)
        };
        self.nodes.iter().flat_map(of_node)
    }

    /// Writes the displacement at time `t` \[s\] into `u` \[m\], prescribed entries only.
    pub fn set_displacement(&self, mesh: &Mesh, t: f64, u: &mut [f64]) {
        self.set(mesh, u, |x| self.motion.displacement(x, t));
    }

    /// Writes the velocity at time `t` \[s\] into `v` \[m/s\], prescribed entries only.
    pub fn set_velocity(&self, mesh: &Mesh, t: f64, v: &mut [f64]) {
        self.set(mesh, v, |x| self.motion.velocity(x, t));
    }

    fn set(&self, mesh: &Mesh, target: &mut [f64], value: impl Fn(Vector3<f64>) -> Vector3<f64>) {
        for &node in &self.nodes {
            let value = value(mesh.points[node as usize]);
            for i in (0..mesh.dim).filter(|&i| self.components[i]) {
                target[mesh.dim * node as usize + i] = value[i];
            }
        }
    }
}

/// A traction that keeps its direction and acts on the reference area.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct DeadTraction {
    /// Facets it acts on.
    pub facets: Vec<Facet>,
    /// Force per reference area \[Pa\].
    pub traction: Vector3<f64>,
    /// Factor over time \[-\].
    pub factor: Table,
}

impl DeadTraction {
    /// A traction \[Pa\] on these facets, times a factor \[-\] over time.
    #[must_use]
    pub fn new(
        facets: Vec<Facet>,
        traction: impl Into<Vector3<f64>>,
        factor: Table,
    ) -> DeadTraction {
        DeadTraction {
            facets,
            traction: traction.into(),
            factor,
        }
    }

    /// Nodal forces \[N\] for a factor of one.
    ///
    /// # Errors
    /// [`FeError::Surface`] if there are no facets, [`FeError::Index`] if a node does not exist,
    /// [`FeError::Parameter`] if the traction is not finite.
    pub fn nodal_forces(&self, mesh: &Mesh) -> Result<Vec<f64>, FeError> {
        check_finite("dead traction", "traction [Pa]", &self.traction)?;
        let surface = Surface::new(self.facets.clone())?;
        check_nodes(surface.nodes.iter(), mesh)?;
        let mut forces = vec![0.0; mesh.dim * mesh.points.len()];
        let areas = surface.shape_integrals(mesh);
        for (&node, area) in surface.nodes.iter().zip(areas) {
            for i in 0..mesh.dim {
                forces[mesh.dim * node as usize + i] = area * self.traction[i];
            }
        }
        Ok(forces)
    }
}

/// Weight: a uniform acceleration that acts on all mass.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Gravity {
    /// Acceleration \[m/s^2\].
    pub acceleration: Vector3<f64>,
    /// Factor over time \[-\].
    pub factor: Table,
}

impl Gravity {
    /// An acceleration \[m/s^2\], times a factor \[-\] over time.
    #[must_use]
    pub fn new(acceleration: impl Into<Vector3<f64>>, factor: Table) -> Gravity {
        Gravity {
            acceleration: acceleration.into(),
            factor,
        }
    }

    /// Nodal forces \[N\] for a factor of one: `M` times the uniform acceleration.
    ///
    /// # Errors
    /// [`FeError::Parameter`] if the acceleration is not finite.
    pub fn nodal_forces(&self, mass: &MassMatrix) -> Result<Vec<f64>, FeError> {
        check_finite("gravity", "acceleration [m/s^2]", &self.acceleration)?;
        let components = &self.acceleration.as_slice()[..mass.dim()];
        let weight = |m: f64| components.iter().map(move |g| m * g);
        Ok(mass.row_sums().into_iter().flat_map(weight).collect())
    }
}

fn check_nodes<'a>(mut nodes: impl Iterator<Item = &'a u32>, mesh: &Mesh) -> Result<(), FeError> {
    let count = mesh.points.len();
    match nodes.find(|&&node| node as usize >= count) {
        None => Ok(()),
        Some(&node) => Err(FeError::Index {
            what: "node",
            index: node as usize,
            count,
        }),
    }
}

fn check_finite(place: &str, what: &'static str, values: &Vector3<f64>) -> Result<(), FeError> {
    match values.iter().find(|value| !value.is_finite()) {
        None => Ok(()),
        Some(&value) => Err(FeError::Parameter {
            place: place.to_owned(),
            what,
            value,
            bound: "must be finite",
        }),
    }
}
