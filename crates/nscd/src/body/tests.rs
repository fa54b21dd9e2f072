use std::hint::black_box;
use std::time::Instant;

use contact_bipotential::{
    Cone, ContactProblem, Delassus, Interface, Master, Obstacle, SequenceSolver, Shape,
    SolveSettings,
};
use fe_core::{BoxMesh, Dirichlet, Motion, Surface, solid_block};
use hyperelastic::{ElasticConstants, NeoHookean};
use nalgebra::Vector3;

use crate::Scheme;

use super::*;

/// Repetitions, of which the shortest counts.
const REPEATS: usize = 20;
/// Elements along a side of the cube: 3630 unknowns, 363 of them candidates.
const CELLS: usize = 10;
/// Coefficient of friction under the cube \[-\].
const MU: f64 = 0.3;
/// Error to which the contact problem is solved \[-\].
const TOLERANCE: f64 = 1e-8;
/// Most that a cost may lie off the others, measured over used: half a decade either way turns no decision of a run
/// round \[-\].
const SPREAD: f64 = 10.0;

/// A cube that is clamped at its top and may touch a plane with its base.
fn cube() -> Model {
    let mesh = BoxMesh::uniform([0.0; 3], [1.0; 3], [CELLS; 3])
        .generate("cube")
        .unwrap();
    let mesh = mesh.validated().unwrap();
    let base = Surface::new(mesh.facet_set("z_min").unwrap().to_vec()).unwrap();
    let area = base.tributary_areas(&mesh);
    let top = Dirichlet::clamped("top", mesh.node_set("z_max").unwrap().to_vec());
    let law = NeoHookean::new(ElasticConstants::from_shear_lame(2.0, 3.0).unwrap()).unwrap();
    let block = solid_block(&mesh, 0, law, 1.0).unwrap();
    let plane = Shape::Plane {
        point: Vector3::zeros(),
        normal: Vector3::z(),
    };
    let floor = Master::Obstacle(Obstacle::new(plane, Motion::still()).unwrap());
    Model::new(Solid::new(mesh, vec![block]).unwrap())
        .with_support(top)
        .with_interface(Interface::new("floor", base.nodes, area, floor, 0.1).with_friction(MU))
        .with_scheme(Scheme::quasi_static())
}

/// Shortest time of some repetitions over `items` \[s\].
fn best(items: f64, mut run: impl FnMut()) -> f64 {
    let times = (0..REPEATS).map(|_| {
        let start = Instant::now();
        run();
        start.elapsed().as_secs_f64()
    });
    times.fold(f64::INFINITY, f64::min) / items
}

/// Name, measured seconds and used seconds of the costs of a body.
fn body_costs(body: &mut BodySystem, elements: &Elements<'_>) -> Vec<(&'static str, f64, f64)> {
    let weights = elements.model().scheme.weights(1.0);
    let mut counters = Counters::default();
    let (entries, first) = (body.values.len() as f64, body.first_candidate);
    let candidates = (body.dofs.len() - first) as f64;
    let gather = best(entries, || body.assemble(elements, weights));
    let factorize = best(body.factor.flops, || body.factorize(&mut counters).unwrap());
    let condense = best(candidates.powi(3), || {
        black_box(body.factor.condense(first));
    });
    let b: Vec<f64> = (0..body.dofs.len()).map(|i| (i as f64).sin()).collect();
    let mut x = b.clone();
    let substitute = best(body.factor.fill() as f64, || {
        x.copy_from_slice(&b);
        body.factor.forward(&mut x);
        body.factor.backward(&mut x);
    });
    let check = best(entries, || {
        let mut left = b.clone();
        lower_of(&body.pattern).subtract_product(&body.values, &x, &mut left);
        black_box(norm(&left));
    });
    let flop = 1.0 / COSTS.factor_rate;
    vec![
        ("1 / factor_rate, factorization", factorize, flop),
        ("1 / factor_rate, condensation", condense, flop),
        ("gathered_entry", gather, COSTS.gathered_entry),
        ("substituted_entry", substitute, COSTS.substituted_entry),
        ("checked_entry", check, COSTS.checked_entry),
    ]
}

/// Seconds an entry of `W` of a contact solve that starts from the reactions of one that differs by a hundredth.
fn contact_cost(body: &BodySystem) -> f64 {
    let (_, w) = body.factor.condense(body.first_candidate);
    let contacts = w.nrows() / Cone::Spatial.dim();
    let pressed = |depth: f64| {
        let q = (0..contacts).flat_map(|k| [0.2 * depth, 0.1 * (k as f64).sin() * depth, -depth]);
        let w = Delassus::Dense(w.clone());
        ContactProblem::new(w, q.collect(), vec![MU; contacts], Cone::Spatial).unwrap()
    };
    let settings = SolveSettings::default().with_tolerance(TOLERANCE);
    let (mut solver, mut start) = (SequenceSolver::default(), Vec::new());
    let solved = solver.solve(&pressed(1.0), &[], &mut start, &settings);
    assert!(solved.is_converged(), "{solved:?}");
    let next = pressed(1.01);
    best((w.nrows() as f64).powi(2), || {
        let mut r = start.clone();
        assert!(solver.solve(&next, &[], &mut r, &settings).is_converged());
    })
}

/// The record of [`COSTS`]: what they are here, on one thread.
#[test]
#[ignore = "a measurement"]
fn costs_on_one_thread() {
    let model = cube();
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build();
    let costs = pool.unwrap().install(|| {
        let mut elements = Elements::new(&model).unwrap();
        let (u, mut f) = (vec![0.0; model.dof_count()], vec![0.0; model.dof_count()]);
        let force = best(model.solid.element_count() as f64, || {
            elements.internal_force(&u, &mut f).unwrap();
        });
        elements.update_tangents(&u).unwrap();
        let mut body = BodySystem::all(&model, &model.prescribed())
            .unwrap()
            .remove(0);
        let mut costs = body_costs(&mut body, &elements);
        costs.push(("element_force", force, COSTS.element_force));
        costs.push(("contact_entry", contact_cost(&body), COSTS.contact_entry));
        costs
    });
    let logarithms = costs
        .iter()
        .map(|(_, measured, used)| (measured / used).ln());
    let mean = (logarithms.sum::<f64>() / costs.len() as f64).exp();
    for (name, measured, used) in costs {
        let [measured, used] = [1e9 * measured, 1e9 * used];
        println!("{name:32} {measured:9.3} ns, in use {used:9.3} ns");
        let off = measured / used / mean;
        assert!(off < SPREAD && 1.0 / off < SPREAD, "{name}: {off}");
    }
}
