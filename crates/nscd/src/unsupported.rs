//! Bodies without inertia that nothing holds.

use crate::error::NscdError;
use crate::floating::is_floating;
use crate::model::Model;
use crate::scheme::Inertia;

/// Without mass, a body that nothing holds has no equilibrium: neither supports nor, where it can touch something,
/// contacts together with some support.
pub(crate) fn refuse_unsupported(model: &Model, fixed: &[bool]) -> Result<(), NscdError> {
    if model.scheme.inertia == Inertia::Dynamic {
        return Ok(());
    }
    let dim = model.solid.dim();
    let candidate = model.candidates();
    let free = |n: u32| (0..dim).all(|c| !fixed[dim * n as usize + c]);
    let unsupported = |body: &&Vec<u32>| {
        let cannot_touch = body.iter().all(|&n| !candidate[n as usize]);
        body.iter().all(|&n| free(n)) || cannot_touch && is_floating(model, body, fixed)
    };
    match model.solid.bodies().iter().find(unsupported) {
        Some(body) => Err(NscdError::Unsupported {
            node: body[0] as usize,
        }),
        None => Ok(()),
    }
}
