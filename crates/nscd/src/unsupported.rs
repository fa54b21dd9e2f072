//! Bodies without inertia that nothing holds.

use crate::error::NscdError;
use crate::floating::is_floating;
use crate::model::Model;
use crate::scheme::Inertia;

/// Without mass, a body that nothing holds has no equilibrium: neither supports nor anything that it can touch.
pub(crate) fn refuse_unsupported(model: &Model, fixed: &[bool]) -> Result<(), NscdError> {
    if model.scheme.inertia == Inertia::Dynamic {
        return Ok(());
    }
    let candidate = model.candidates();
    let unsupported = |body: &&Vec<u32>| {
        let cannot_touch = body.iter().all(|&n| !candidate[n as usize]);
        cannot_touch && is_floating(model, body, fixed)
    };
    match model.solid.bodies().iter().find(unsupported) {
        Some(body) => Err(NscdError::Unsupported {
            node: body[0] as usize,
        }),
        None => Ok(()),
    }
}
