//! How far an iterate is from obeying the contact law.

use contact_bipotential::law_residual;

use crate::flat::largest;
use crate::memory::ContactMemory;
use crate::model::Model;
use crate::newton_iterate::NewtonIterate;

/// Error of the contact law at an iterate.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct LawError {
    /// Largest [`law_residual`] with `rho = 1/trace W_cc`, relative to the largest contact force or to the round-off of
    /// this contact that stands for it \[-\]: a penetration counts whatever the friction coefficient is.
    pub(crate) largest: f64,
    /// Index of that contact in the map.
    pub(crate) worst: usize,
}

impl LawError {
    /// Error of the contact law with exact gaps; `fallback` is the stiffness \[N/m\] of contacts that never entered a
    /// contact problem, `blur` the gap \[m\] that cannot be told from round-off over the tolerance.
    pub(crate) fn of(
        model: &Model,
        memory: &ContactMemory,
        iterate: &NewtonIterate,
        fallback: f64,
        blur: f64,
    ) -> Self {
        let cone = iterate.map.cone();
        let force = largest(&iterate.r);
        let mut error = LawError::default();
        for (k, c) in iterate.map.contacts.iter().enumerate() {
            let rows = cone.range(k);
            let (r, x) = (&iterate.r[rows.clone()], &iterate.x[rows]);
            let rho = memory.projection_stiffness(c).unwrap_or(fallback);
            let mu = model.interfaces[c.interface].mu;
            let scale = force.max(rho * blur).max(f64::MIN_POSITIVE);
            let size = law_residual(cone, iterate.bonds.get(k), mu, rho, x, r) / scale;
            if size > error.largest {
                error = LawError {
                    largest: size,
                    worst: k,
                };
            }
        }
        error
    }
}
