//! Contact search: a block over a rigid plane, then over another block. Prints gaps, frames, and rows of `H`.

use std::error::Error;

use contact_bipotential::{
    Cone, ContactMap, Detector, Interface, Master, Obstacle, Shape, nalgebra::Vector3,
};
use fe_core::{BoxMesh, Interpolation, Mesh, Motion, Surface, Table};

/// How far contacts are looked for \[m\].
const REACH: f64 = 0.2;

fn main() -> Result<(), Box<dyn Error>> {
    // Two blocks, one 0.05 m above the other and set off by a third of a facet, so that nodes do not meet nodes.
    let mut mesh = Mesh::default();
    mesh.append(
        "lower",
        BoxMesh::uniform([0.0; 3], [1.0, 1.0, 0.5], [2, 2, 1]).generate("lower")?,
    )?;
    let (from, to) = ([0.15, 0.15, 0.55], [0.9, 0.9, 1.0]);
    mesh.append(
        "upper",
        BoxMesh::uniform(from, to, [1, 1, 1]).generate("upper")?,
    )?;
    let positions: Vec<f64> = mesh.points.iter().flatten().copied().collect();

    let slave = Surface::new(mesh.facet_set("upper.z_min")?.to_vec())?;
    let area = slave.tributary_areas(&mesh);
    let pair = |master| Interface::new("pair", slave.nodes.clone(), area.clone(), master, REACH);

    println!("Over the plane z = 0.5 m, which moves along x by 0.1 m in the step:");
    let plane = Shape::Plane {
        point: Vector3::new(0.0, 0.0, 0.5),
        normal: Vector3::z(),
    };
    let belt = Table::new(vec![(0.0, 0.0), (1.0, 0.1)], Interpolation::Linear)?;
    let motion = Motion::translation([belt, Table::zero(), Table::zero()]);
    let master = Master::Obstacle(Obstacle::new(plane, motion)?);
    let mut detector = Detector::new(vec![pair(master)], &positions, 3, Cone::Spatial)?;
    let map = detector.detect(&positions, 0.0, 1.0);
    print_contacts(&map);
    let mut slip = vec![0.0; map.row_count()];
    map.slip_offsets(&mut slip);
    println!(
        "  slip of the first node at rest (t1, t2, n): {:?} m\n",
        &slip[Cone::Spatial.range(0)]
    );

    println!("Over the top of the lower block:");
    let master = Master::Surface(Surface::new(mesh.facet_set("lower.z_max")?.to_vec())?);
    let mut detector = Detector::new(vec![pair(master)], &positions, 3, Cone::Spatial)?;
    let map = detector.detect(&positions, 0.0, 1.0);
    print_contacts(&map);

    // H takes nodal vectors to contacts: everything moves along z, which is no relative motion; then the slaves alone.
    let mut x = vec![0.0; map.row_count()];
    let up = |only: &dyn Fn(u32) -> bool| -> Vec<f64> {
        let nodes = 0..mesh.points.len() as u32;
        nodes
            .flat_map(|n| [0.0, 0.0, f64::from(u8::from(only(n)))])
            .collect()
    };
    map.apply(&up(&|_| true), &mut x);
    println!(
        "  H u of a common translation, largest: {:e}",
        x.iter().fold(0.0, |m: f64, x| m.max(x.abs()))
    );
    map.apply(&up(&|n| slave.nodes.contains(&n)), &mut x);
    println!(
        "  H u of lifting the slaves by 1, first contact: {:?}",
        &x[Cone::Spatial.range(0)]
    );
    // H^T takes reactions to nodal forces, which balance.
    let mut force = vec![0.0; positions.len()];
    let pressed: Vec<f64> = map.contacts.iter().flat_map(|_| [0.0, 0.0, 1.0]).collect();
    map.apply_transpose(&pressed, &mut force);
    let of = |nodes: &[u32]| {
        nodes
            .iter()
            .map(|n| force[3 * *n as usize + 2])
            .sum::<f64>()
    };
    let all: Vec<u32> = (0..mesh.points.len() as u32).collect();
    println!(
        "  H^T r of 1 N on each slave along n: {} N on the slaves, {:e} N in all",
        of(&slave.nodes),
        of(&all)
    );
    println!("  searched: {:?}", detector.counters());
    Ok(())
}

fn print_contacts(map: &ContactMap) {
    for c in &map.contacts {
        let [t1, t2, n] = [0, 1, 2].map(|i| c.frame.column(i).into_owned());
        println!(
            "  node {} gap {:.3} m, facet {:?}, t1 {:?} t2 {:?} n {:?}",
            c.slave,
            c.gap,
            c.facet,
            t1.as_slice(),
            t2.as_slice(),
            n.as_slice()
        );
        let stencil: Vec<String> = c
            .stencil
            .iter()
            .map(|(node, w)| format!("{w:+.3} u{node}"))
            .collect();
        println!("    relative motion = {}", stencil.join(" "));
    }
}
