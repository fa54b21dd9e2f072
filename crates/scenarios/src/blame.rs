//! Errors of the stepper in the words of a scene: with the bodies of the nodes that they name.

use fe_core::Mesh;
use nscd::{NscdError, StepFailure};

/// The error with the body of its node.
pub(crate) fn error(error: &NscdError, mesh: &Mesh) -> String {
    let node = match error {
        NscdError::Unsupported { node } => Some(*node),
        NscdError::Overlap { node, .. } => Some(*node as usize),
        NscdError::Stopped { failure, .. } => node_of(failure),
        _ => None,
    };
    with_body(error.to_string(), node, mesh)
}

/// The reason of a rejected step with the body of its node.
pub(crate) fn failure(failure: &StepFailure, mesh: &Mesh) -> String {
    with_body(failure.to_string(), node_of(failure), mesh)
}

fn node_of(failure: &StepFailure) -> Option<usize> {
    match failure {
        StepFailure::Newton { node, .. }
        | StepFailure::Indefinite { node, .. }
        | StepFailure::Adrift { node }
        | StepFailure::NotFinite { node } => Some(*node),
        StepFailure::Passed { node, .. } | StepFailure::Lost { node, .. } => Some(*node as usize),
        StepFailure::Rim { contact } | StepFailure::Immovable { contact, .. } => {
            Some(contact.node as usize)
        }
        StepFailure::Snap { contact, .. } => Some(contact.node as usize),
        StepFailure::Contact { contact, .. } => contact.as_ref().map(|c| c.node as usize),
        _ => None,
    }
}

fn with_body(text: String, node: Option<usize>, mesh: &Mesh) -> String {
    let Some(node) = node else { return text };
    let index = node as u32;
    let mut blocks = mesh.blocks.iter();
    match blocks.find(|block| block.cells.contains(&index)) {
        Some(block) => format!("{text} (node {node} is of body `{}`)", block.name),
        None => text,
    }
}
