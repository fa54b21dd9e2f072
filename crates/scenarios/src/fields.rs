//! Fields of a state for files and pictures.

use fe_core::ElementState;
use nscd::{ContactStatus, State};

use crate::build::Built;
use crate::contacts::NodeContact;
use crate::output::{Array, Cells, Frame, Values};

/// Fields of one state in the layout of the files.
#[derive(Debug)]
pub struct Fields {
    displacement: Vec<f64>,
    velocity: Vec<f64>,
    contact_force: Vec<f64>,
    contact_status: Vec<i32>,
    gap: Vec<f64>,
    beta: Vec<f64>,
    adhesion_force: Vec<f64>,
    normal_force: Vec<f64>,
    tangential_force: Vec<f64>,
    von_mises: Vec<f64>,
    cauchy: Vec<f64>,
    body: Vec<i32>,
}

impl Fields {
    /// Fields of `state`. Contact status of a node: 0 none or open, 1 stick, 2 slip. The gap of a node without a
    /// contact near is NaN.
    #[must_use]
    pub fn new(built: &Built, state: &State) -> Fields {
        let dim = built.model.solid.dim();
        let stress = stresses(built, state);
        let mut contact_status = vec![0; built.model.solid.node_count()];
        let nodes = NodeContact::all(&built.model, state);
        for c in &state.contacts {
            contact_status[c.node as usize] = match c.status {
                ContactStatus::Open => 0,
                ContactStatus::Stick => 1,
                ContactStatus::Slip => 2,
            };
        }
        let blocks = built.model.solid.blocks().iter().zip(&built.body_of_block);
        Fields {
            displacement: spatial(&state.u, dim),
            velocity: spatial(&state.v, dim),
            contact_force: spatial(&state.contact_force, dim),
            contact_status,
            gap: nodes.iter().map(|n| n.gap).collect(),
            beta: nodes.iter().map(|n| n.beta).collect(),
            adhesion_force: nodes
                .iter()
                .flat_map(|n| <[f64; 3]>::from(n.bond_force))
                .collect(),
            normal_force: nodes.iter().map(|n| n.normal).collect(),
            tangential_force: nodes.iter().map(|n| n.tangential).collect(),
            von_mises: stress.iter().map(|s| s.von_mises).collect(),
            cauchy: stress
                .iter()
                .flat_map(|s| s.cauchy.iter().copied())
                .collect(),
            body: blocks
                .flat_map(|(b, &body)| vec![body; b.element_count()])
                .collect(),
        }
    }

    /// The fields with the mesh, ready to be written.
    #[must_use]
    pub fn frame<'a>(&'a self, built: &'a Built, state: &State) -> Frame<'a> {
        let mesh = built.model.solid.mesh();
        let array = |name, values| Array { name, values };
        Frame {
            time: state.time,
            points: &mesh.points,
            cells: mesh
                .blocks
                .iter()
                .map(|b| Cells {
                    kind: b.kind,
                    connectivity: &b.cells,
                })
                .collect(),
            point_data: vec![
                array("displacement", Values::Vector(&self.displacement)),
                array("velocity", Values::Vector(&self.velocity)),
                array("contact_force", Values::Vector(&self.contact_force)),
                array("contact_status", Values::Integer(&self.contact_status)),
                array("gap", Values::Scalar(&self.gap)),
                array("beta", Values::Scalar(&self.beta)),
                array("adhesion_force", Values::Vector(&self.adhesion_force)),
                array("contact_normal_force", Values::Scalar(&self.normal_force)),
                array(
                    "contact_tangential_force",
                    Values::Scalar(&self.tangential_force),
                ),
            ],
            cell_data: vec![
                array("von_mises", Values::Scalar(&self.von_mises)),
                array("cauchy_stress", Values::SymmetricTensor(&self.cauchy)),
                array("body", Values::Integer(&self.body)),
            ],
        }
    }

    /// Von Mises stress at a node \[Pa\]: mean over the elements around it.
    pub(crate) fn nodal_von_mises(built: &Built, state: &State, node: u32) -> f64 {
        let blocks = built.model.solid.blocks().iter();
        let cells = blocks.flat_map(|b| b.connectivity().chunks_exact(b.nodes_per_element()));
        let stress = stresses(built, state);
        let around = cells.zip(&stress).filter(|(cell, _)| cell.contains(&node));
        let (sum, count) = around.fold((0.0, 0), |(sum, count), (_, s)| {
            (sum + s.von_mises, count + 1)
        });
        sum / f64::from(count.max(1))
    }
}

/// Stress of every element; an accepted state has no inverted element, so the call cannot fail there.
fn stresses(built: &Built, state: &State) -> Vec<ElementState> {
    let mut all = Vec::new();
    for block in built.model.solid.blocks() {
        let mut states = vec![ElementState::default(); block.element_count()];
        if block.stress_state(&state.u, &mut states).is_err() {
            let mut unknown = ElementState::default();
            unknown.cauchy.fill(f64::NAN);
            unknown.von_mises = f64::NAN;
            states.fill(unknown);
        }
        all.extend(states);
    }
    all
}

/// Three components a node whatever the dimension.
fn spatial(field: &[f64], dim: usize) -> Vec<f64> {
    let full = |v: &[f64]| std::array::from_fn::<f64, 3, _>(|i| v.get(i).copied().unwrap_or(0.0));
    field.chunks_exact(dim).flat_map(full).collect()
}
