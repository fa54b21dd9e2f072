//! Steps so long that slave and master could pass through each other unseen.

use contact_bipotential::{Interface, Master, Obstacle, Shape};

use crate::error::StepFailure;
use crate::model::point;
use crate::step_problem::StepProblem;
use crate::swept::Swept;

/// Parts into which the straight way of a node past an obstacle is cut to look whether it goes through.
const LOOKS: i32 = 8;

/// Refuses a step that ends at the displacement `u` \[m\] where contacts may have been missed on the way. A slave that
/// crosses more than the reach of the search in one step could pass through its master unseen: such a step is refused
/// when the two come near each other on the way.
pub(crate) fn refuse_tunnelling(step: &StepProblem<'_>, u: &[f64]) -> Result<(), StepFailure> {
    let model = step.model;
    let (start, end) = (model.positions(&step.now.u), model.positions(u));
    let dim = model.solid.dim();
    for interface in &model.interfaces {
        let master = match &interface.master {
            Master::Surface(master) => master,
            Master::Obstacle(obstacle) => {
                refuse_passing(interface, obstacle, [&start, &end], dim, step)?;
                continue;
            }
        };
        let swept = |nodes: &[u32]| Swept::of(nodes, dim, &start, &end);
        let (slave, master) = (swept(&interface.slave), swept(&master.nodes));
        let (travel, reach) = (slave.fastest_against(&master), interface.search_distance);
        if travel > reach && slave.meets(&master, reach) {
            let interface = interface.name.clone();
            return Err(StepFailure::TooFast {
                interface,
                travel,
                reach,
            });
        }
    }
    Ok(())
}

/// A node that ends a step on the other side of a ball, a cylinder or a tip, and was inside on its straight way, has
/// jumped through it: gaps at the end of the step do not tell.
fn refuse_passing(
    interface: &Interface,
    obstacle: &Obstacle,
    [start, end]: [&[f64]; 2],
    dim: usize,
    step: &StepProblem<'_>,
) -> Result<(), StepFailure> {
    if matches!(obstacle.shape(), Shape::Plane { .. }) {
        return Ok(());
    }
    let placed = obstacle.over_step(step.now.time, step.end());
    let motion = obstacle.motion();
    for &node in &interface.slave {
        let from = motion.pull_back(point(start, dim, node), step.now.time);
        let (from, to) = (motion.position(from, step.end()), point(end, dim, node));
        let (a, b) = (placed.closest(from, 0.0), placed.closest(to, 0.0));
        let turn = a.normal.dot(&b.normal);
        let inside = |k: i32| {
            let s = f64::from(k) / f64::from(LOOKS);
            let at = (1.0 - s) * from + s * to;
            placed.closest(at, 0.0).gap < a.gap.min(b.gap).min(0.0)
        };
        if turn < 0.0 && (1..LOOKS).any(inside) {
            return Err(StepFailure::Passed {
                node,
                interface: interface.name.clone(),
                travel: (to - from).norm(),
            });
        }
    }
    Ok(())
}
