//! Two blocks pressed together: is the stress uniform?

use fe_core::ElementState;

use crate::{Case, Found, Ladder, Ran};

/// Stress where the meshes of two blocks do not match.
pub fn non_matching() -> Case {
    let with = |name: &str, element: &str| {
        let rung = |ladder: Ladder, (low, high): &(usize, usize)| {
            let sets = [
                format!("low.mesh.cells=({low}, {low})"),
                format!("high.mesh.cells=({high}, {high})"),
                format!("low.mesh.element={element}"),
                format!("high.mesh.element={element}"),
            ];
            let sets = sets.each_ref().map(String::as_str);
            ladder.rung(
                format!("{high} slave on {low} master cells"),
                *low as f64 / *high as f64,
                &sets,
            )
        };
        RATIOS.iter().fold(Ladder::new(name), rung)
    };
    Case {
        name: "contact-patch",
        about: "Two blocks under uniform pressure: largest and root mean square deviation of the normal stress of an element, and the force. \
                Nodes of the slave on facets of the master, one pass. `size` is the size of a cell of the slave over that of the master.",
        scene: "contact-patch",
        sets: Vec::new(),
        ladders: vec![
            with("quadrilaterals", "Quad4"),
            with("triangles", "Tri3"),
            with("quadratic quadrilaterals", "Quad9"),
        ],
        measure: |ran| measure(ran, 1, 1.0),
    }
}

/// Cells of master and slave.
const RATIOS: [(usize, usize); 10] = [
    (12, 4),
    (8, 4),
    (6, 4),
    (10, 8),
    (40, 32),
    (8, 8),
    (32, 40),
    (8, 10),
    (4, 6),
    (4, 8),
];

/// Deviation of the stress along `axis` from `pressure` \[Pa\] on blocks of a unit cross-section.
///
/// # Errors
/// The end state has no stress.
pub fn measure(ran: &Ran, axis: usize, pressure: f64) -> Result<Vec<Found>, String> {
    let empty = ElementState::default();
    let mut errors = Vec::new();
    for block in ran.built.model.solid.blocks() {
        let mut states = vec![empty; block.element_count()];
        block
            .stress_state(&ran.last.u, &mut states)
            .map_err(|e| e.to_string())?;
        errors.extend(states.iter().map(|s| -s.cauchy[axis] - pressure));
    }
    let largest = errors.iter().fold(0.0_f64, |m, e| m.max(e.abs()));
    let square = errors.iter().map(|e| e * e).sum::<f64>() / errors.len() as f64;
    let force = ran.end(["force.joint.x", "force.joint.y", "force.joint.z"][axis])?;
    Ok(vec![
        Found::zero("largest deviation", "Pa", largest, pressure),
        Found::zero("root mean square", "Pa", square.sqrt(), pressure),
        Found::exact("force", "N", force.abs(), pressure),
    ])
}
