//! Indenters in nearly incompressible matter: does anything but `E/(1 - nu^2)` change, and is the pressure smooth?

use fe_core::{CellBlock, ElementState};
use scenarios::spec::{ElasticPair, Law};

use super::indenters::cone_at;
use crate::closed_form::{cone_force, punch_force};
use crate::{Case, Found, Ladder, Ran};

/// Ratios of Poisson, from compressible to hardly so \[-\].
const RATIOS: [f64; 4] = [0.3, 0.45, 0.495, 0.4999];
/// Of both scenes \[Pa\].
const E: f64 = 1.0e7;

/// Force on the cone of 85 degrees and alternating part of the pressure.
pub fn cone() -> Case {
    Case {
        name: "cone-incompressible",
        about: "Cone of 85 degrees over Poisson's ratio, neo-Hookean: force against (2/pi) E/(1-nu^2) tan(alpha) d^2, and the part of the \
                pressure that alternates from cell to cell, root mean squares. Sizes are 1 - 2 nu; the block is finite, which is an \
                error that does not go.",
        scene: "cone",
        sets: [
            &cone_at(85.0)[..],
            &["refine=1".to_owned(), "time.dt=0.05".to_owned()],
        ]
        .concat(),
        ladders: ladders(),
        measure: |ran| {
            measure(ran, |e_star| {
                let alpha = 85_f64.to_radians();
                let radius = crate::closed_form::cone_radius(alpha, 1.0);
                cone_force(e_star, alpha, 1.0e-3 / radius)
            })
        },
    }
}

/// The same of the flat punch.
pub fn punch() -> Case {
    Case {
        name: "punch-incompressible",
        about: "Flat punch over Poisson's ratio, neo-Hookean: force against 2 a E/(1-nu^2) d, and the part of the pressure that alternates \
                from cell to cell. Sizes are 1 - 2 nu.",
        scene: "flat-punch",
        sets: Vec::new(),
        ladders: ladders(),
        measure: |ran| measure(ran, |e_star| punch_force(e_star, 1e-3, 1e-6)),
    }
}

/// The law with this ratio of Poisson, as a value of a scene.
pub fn law(nu: f64) -> String {
    format!("materials.block.law=NeoHookean(E: {E:e}, nu: {nu})")
}

fn ladders() -> Vec<Ladder> {
    let with = |element: &str, dilatation: &str| {
        let rung = |ladder: Ladder, nu: &f64| {
            let sets = [
                law(*nu),
                format!("bodies.block.dilatation={dilatation}"),
                format!("bodies.block.mesh.element={element}"),
            ];
            let sets = sets.each_ref().map(String::as_str);
            ladder.rung(format!("nu = {nu}"), 1.0 - 2.0 * nu, &sets)
        };
        let name = format!("{element}, {}", dilatation.to_lowercase());
        RATIOS.iter().fold(Ladder::new(name), rung)
    };
    vec![
        with("Quad4", "Pointwise"),
        with("Quad4", "Projected"),
        with("Quad9", "Projected"),
    ]
}

fn measure(ran: &Ran, theory: impl Fn(f64) -> f64) -> Result<Vec<Found>, String> {
    let material = ran.scene.materials.get("block").ok_or("no block")?;
    let Law::NeoHookean(ElasticPair { nu: Some(nu), .. }) = material.law else {
        return Err("the block is not neo-Hookean with nu".to_owned());
    };
    let force = ran.end("force.contact.y")?.abs();
    let [alternating, pressure] = checkerboard(ran)?;
    Ok(vec![
        Found::exact("force", "N", force, theory(E / (1.0 - nu * nu))),
        Found::zero("alternating pressure", "Pa", alternating, pressure),
    ])
}

/// Root mean squares, over the nodes where four cells meet, of the part of the pressure that alternates around the node
/// and of the mean of the four \[Pa\]. The part is 1/4 of the sum of opposite cells minus that of the others: the
/// pressure itself for a checkerboard, of the order of the square of the size for a smooth field.
///
/// # Errors
/// The end state has no stress.
fn checkerboard(ran: &Ran) -> Result<[f64; 2], String> {
    let solid = &ran.built.model.solid;
    let (block, cells) = (&solid.blocks()[0], &solid.mesh().blocks[0]);
    let mut states = vec![ElementState::default(); block.element_count()];
    let states_of = block.stress_state(&ran.last.u, &mut states);
    states_of.map_err(|e| e.to_string())?;
    let pressure = |cell: usize| {
        let s = &states[cell].cauchy;
        -(s[0] + s[1] + s[2]) / 3.0
    };
    let (mut part, mut mean, mut count) = (0.0, 0.0, 0.0);
    for [a, opposite, b, c] in patches(cells, solid.node_count()) {
        let (along, across) = (pressure(a) + pressure(opposite), pressure(b) + pressure(c));
        part += (0.25 * (along - across)).powi(2);
        mean += (0.25 * (along + across)).powi(2);
        count += 1.0;
    }
    Ok([part, mean].map(|sum: f64| (sum / count).sqrt()))
}

/// Cells around each node where four meet, opposite ones first.
fn patches(cells: &CellBlock, nodes: usize) -> Vec<[usize; 4]> {
    let mut around = vec![Vec::new(); nodes];
    for (cell, corners) in cells.iter().enumerate() {
        corners[..4]
            .iter()
            .for_each(|&n| around[n as usize].push(cell));
    }
    let corners: Vec<&[u32]> = cells.iter().map(|cell| &cell[..4]).collect();
    let shared = |a: usize, b: usize| {
        let both = corners[a].iter().filter(|n| corners[b].contains(n));
        both.count()
    };
    let patch = |found: &Vec<usize>| {
        let &[a, b, c, d] = found.as_slice() else {
            return None;
        };
        [[a, b, c, d], [a, c, b, d], [a, d, b, c]]
            .into_iter()
            .find(|p| shared(p[0], p[1]) == 1)
    };
    around.iter().filter_map(patch).collect()
}
