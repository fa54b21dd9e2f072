//! Contact search: a block over a rigid plane, then over another block. Prints gaps, frames, and rows of `H`.

use std::error::Error;

use contact_bipotential::nalgebra::Vector3;
use contact_bipotential::{Cone, ContactMap, Detector, Interface, Master, Obstacle, Shape};
use fe_core::{BoxMesh, Interpolation, Mesh, Motion, Surface, Table};

/// How far contacts are looked for \[m\].
const REACH: f64 = 0.2;

fn main() -> Result<(), Box<dyn Error>> {
    // Two blocks, one 0.05 m above the other and set off by a third of a facet, so that nodes do not meet nodes.
    let lower = BoxMesh::uniform([0.0; 3], [1.0, 1.0, 0.5], [2, 2, 1]);
    let upper = BoxMesh::uniform([0.15, 0.15, 0.55], [0.9, 0.9, 1.0], [1, 1, 1]);
    let mut mesh = Mesh::default();
    mesh.append("lower", lower.generate("lower")?)?;
    mesh.append("upper", upper.generate("upper")?)?;
    let positions: Vec<f64> = mesh.points.iter().flatten().copied().collect();

    let slave = Surface::new(mesh.facet_set("upper.z_min")?.to_vec())?;
    let area = slave.tributary_areas(&mesh);
    let search = |master| {
        let pair = Interface::new("pair", slave.nodes.clone(), area.clone(), master, REACH);
        Detector::new(vec![pair], &positions, 3, Cone::Spatial)
    };

    println!("Over the plane z = 0.5 m, which moves along x by 0.1 m in the step:");
    let (point, normal) = (Vector3::new(0.0, 0.0, 0.5), Vector3::z());
    let belt = Table::new(vec![(0.0, 0.0), (1.0, 0.1)], Interpolation::Linear)?;
    let motion = Motion::translation([belt, Table::zero(), Table::zero()]);
    let plane = Obstacle::new(Shape::Plane { point, normal }, motion)?;
    let map = search(Master::Obstacle(plane))?.detect(&positions, 0.0, 1.0);
    print_contacts(&map);
    let mut slip = vec![0.0; map.row_count()];
    map.slip_offsets(&mut slip);
    let slip = &slip[Cone::Spatial.range(0)];
    println!("  slip of the first node at rest (t1, t2, n): {slip:?} m");

    println!("Over the top of the lower block:");
    let top = Surface::new(mesh.facet_set("lower.z_max")?.to_vec())?;
    let mut detector = search(Master::Surface(top))?;
    let map = detector.detect(&positions, 0.0, 1.0);
    print_contacts(&map);

    // H takes nodal vectors to contacts: everything moves along z, which is no relative motion; then the slaves alone.
    let mut up = vec![0.0; positions.len()];
    let mut x = vec![0.0; map.row_count()];
    up.iter_mut().skip(2).step_by(3).for_each(|z| *z = 1.0);
    map.apply(&up, &mut x);
    let largest = x.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
    println!("  H u of a common translation, largest: {largest:e}");
    up.fill(0.0);
    for node in &slave.nodes {
        up[3 * *node as usize + 2] = 1.0;
    }
    map.apply(&up, &mut x);
    let first = &x[Cone::Spatial.range(0)];
    println!("  H u of lifting the slaves by 1, first contact: {first:?}");

    // H^T takes reactions to nodal forces, which balance.
    let mut force = vec![0.0; positions.len()];
    let pressed: Vec<f64> = map.contacts.iter().flat_map(|_| [0.0, 0.0, 1.0]).collect();
    map.apply_transpose(&pressed, &mut force);
    let z = |node: &u32| force[3 * *node as usize + 2];
    let (slaves, all): (f64, f64) = (
        slave.nodes.iter().map(z).sum(),
        force.iter().skip(2).step_by(3).sum(),
    );
    println!("  H^T r of 1 N on each slave along n: {slaves} N on the slaves, {all:e} N in all");
    println!("  searched: {:?}", detector.counters());
    Ok(())
}

fn print_contacts(map: &ContactMap) {
    for c in &map.contacts {
        let (node, gap, facet) = (c.slave, c.gap, c.facet);
        println!("  node {node} gap {gap:.3} m, facet {facet:?}");
        println!("    t1, t2, n = {:?}", c.frame.as_slice());
        let term = |(node, weight): (u32, f64)| format!(" {weight:+.3} u{node}");
        let sum: String = c.stencil.iter().map(term).collect();
        println!("    relative motion ={sum}");
    }
}
