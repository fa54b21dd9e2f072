//! How far an iterate is from obeying the contact law.

use contact_bipotential::BondStep;
use contact_bipotential::cone::project;
use contact_bipotential::local::local_axes;

use crate::flat::largest;
use crate::iterate::Iterate;
use crate::local::spatial;
use crate::memory::ContactMemory;
use crate::model::Model;

/// Error of the contact law at an iterate.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct LawError {
    /// Largest `|r - Proj_K(r - rho (x + mu |x_t| n))|`, `rho = 1/trace W_cc`, relative to the largest contact force or
    /// to the round-off of this contact that stands for it \[-\].
    pub(crate) largest: f64,
    /// Index of that contact in the map.
    pub(crate) worst: usize,
}

impl LawError {
    /// Error of the contact law with exact gaps; `fallback` is the stiffness \[N/m\] of contacts that never entered a contact
    /// problem, `blur` the gap \[m\] that cannot be told from round-off over the tolerance.
    pub(crate) fn of(
        model: &Model,
        memory: &ContactMemory,
        iterate: &Iterate,
        fallback: f64,
        blur: f64,
    ) -> Self {
        let cone = iterate.map.cone().dim();
        let force = largest(&iterate.r);
        let mut error = LawError::default();
        for (k, c) in iterate.map.contacts.iter().enumerate() {
            let rows = cone * k..cone * (k + 1);
            let (r, x) = (&iterate.r[rows.clone()], &iterate.x[rows]);
            let rho = memory.projection_stiffness(c).unwrap_or(fallback);
            let mu = model.interfaces[c.interface].mu;
            let (mu, r) = without_bond(iterate.bonds.get(k), mu, r, x);
            let scale = force.max(rho * blur).max(f64::MIN_POSITIVE);
            let size = natural_map(mu, rho, &r[3 - cone..], x) / scale;
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

/// Friction coefficient and the part of a force that the contact law governs; missing tangents stand in front.
fn without_bond(bond: Option<&BondStep>, mu: f64, r: &[f64], x: &[f64]) -> (f64, [f64; 3]) {
    let mut dry = [0.0; 3];
    dry[3 - r.len()..].copy_from_slice(r);
    let Some(bond) = bond else { return (mu, dry) };
    let at = bond.at(&spatial(x));
    let axes = local_axes(r.len());
    for (i, axis) in axes.iter().enumerate() {
        dry[3 - r.len() + i] -= at.force[*axis];
    }
    (bond.friction(mu, at.intensity), dry)
}

/// Norm of `r - Proj_K(r - rho (x + mu |x_t| n))`, normal last.
fn natural_map(mu: f64, rho: f64, r: &[f64], x: &[f64]) -> f64 {
    let last = r.len() - 1;
    let slip = x[..last].iter().map(|t| t * t).sum::<f64>().sqrt();
    // A missing tangent is a zero one.
    let place = 2 - last;
    let (mut force, mut trial) = ([0.0; 3], [0.0; 3]);
    for i in 0..=last {
        force[place + i] = r[i];
        trial[place + i] = r[i] - rho * x[i];
    }
    trial[2] -= rho * mu * slip;
    let projected = project::<3>(mu, &trial);
    (0..3)
        .map(|i| (force[i] - projected[i]).powi(2))
        .sum::<f64>()
        .sqrt()
}
