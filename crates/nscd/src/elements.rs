//! Element forces and tangents of all bodies, and the damping that is made of them.

use fe_core::{ElementWorkspace, FeError};

use crate::model::Model;

/// The elements with their buffers, and the stiffness of the undeformed bodies where damping needs it.
#[derive(Debug)]
pub(crate) struct Elements<'m> {
    model: &'m Model,
    work: ElementWorkspace,
    initial_stiffness: Option<ElementWorkspace>,
}

impl<'m> Elements<'m> {
    /// # Errors
    /// An element that is inverted from the start.
    pub(crate) fn new(model: &'m Model) -> Result<Self, FeError> {
        let mut initial_stiffness = None;
        if model.damping.stiffness > 0.0 {
            let mut work = model.solid.workspace();
            let zero = vec![0.0; model.dof_count()];
            model.solid.tangent(&zero, &mut work, &mut zero.clone())?;
            initial_stiffness = Some(work);
        }
        Ok(Self {
            model,
            work: model.solid.workspace(),
            initial_stiffness,
        })
    }

    pub(crate) fn model(&self) -> &'m Model {
        self.model
    }

    /// Overwrites `f` with the internal force at the displacement `u` \[N\] and returns the strain energy \[J\].
    pub(crate) fn internal_force(&mut self, u: &[f64], f: &mut [f64]) -> Result<f64, FeError> {
        self.model.solid.internal_force(u, &mut self.work, f)
    }

    /// Computes the element tangents at the displacement `u`; they stay in the buffers.
    pub(crate) fn update_tangents(&mut self, u: &[f64]) -> Result<(), FeError> {
        let mut force = vec![0.0; u.len()];
        self.model.solid.tangent(u, &mut self.work, &mut force)?;
        Ok(())
    }

    /// The last element tangents.
    pub(crate) fn tangents(&self) -> &ElementWorkspace {
        &self.work
    }

    /// The last tangent times the displacements `x` \[N\].
    pub(crate) fn tangent_times(&self, x: &[f64]) -> Vec<f64> {
        let mut product = vec![0.0; x.len()];
        let solid = &self.model.solid;
        solid.tangent_times(&self.work, x, &mut product);
        product
    }

    /// Element tangents of the undeformed bodies and their part in the damping matrix \[s\], if they have one.
    pub(crate) fn damping_stiffness(&self) -> Option<(&ElementWorkspace, f64)> {
        let initial = self.initial_stiffness.as_ref();
        initial.map(|work| (work, self.model.damping.stiffness))
    }

    /// Damping force `A v` \[N\], `A = mass M + stiffness K_0`.
    pub(crate) fn damping_force(&self, v: &[f64]) -> Vec<f64> {
        let model = self.model;
        let mut force = vec![0.0; v.len()];
        if model.damping.mass != 0.0 {
            model.mass.times(v, &mut force);
            force.iter_mut().for_each(|f| *f *= model.damping.mass);
        }
        if let Some((work, stiffness)) = self.damping_stiffness() {
            let mut elastic = vec![0.0; v.len()];
            model.solid.tangent_times(work, v, &mut elastic);
            let both = force.iter_mut().zip(&elastic);
            both.for_each(|(f, e)| *f += stiffness * e);
        }
        force
    }
}
