use fe_core::{BoxMesh, Solid, solid_block};
use hyperelastic::{ElasticConstants, NeoHookean};
use proptest::prelude::*;

use crate::{NoClock, Rayleigh, Scheme};

use super::*;

fn model(theta: f64, xi: f64, damping: Rayleigh) -> Model {
    let mesh = BoxMesh::uniform([0.0; 3], [1.0, 1.0, 2.0], [1, 1, 2])
        .generate("block")
        .unwrap();
    let mesh = mesh.validated().unwrap();
    let law = NeoHookean::new(ElasticConstants::from_shear_lame(2.0, 3.0).unwrap()).unwrap();
    let block = solid_block(&mesh, 0, law, 1.5).unwrap();
    let held = mesh.node_sets["z_min"].clone();
    let solid = Solid::new(mesh, vec![block]).unwrap();
    Model::new(solid)
        .with_damping(damping)
        .with_support(fe_core::Dirichlet::clamped("base", held))
        .with_scheme(Scheme::dynamic(theta, xi))
}

/// Balance of a step at `u`.
fn balance(
    step: &StepProblem<'_>,
    elements: &mut Elements<'_>,
    fixed: &[bool],
    u: &[f64],
) -> Vec<f64> {
    let mut iterate = NewtonIterate::at(step.model, u.to_vec(), None);
    elements
        .internal_force(u, &mut iterate.internal_force)
        .unwrap();
    step.end_velocity(u, fixed, &mut iterate.v);
    iterate.damping_force = elements.damping_force(&iterate.v);
    iterate.balance_forces(step);
    iterate.balance
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]
    /// The factorized matrix is minus the derivative of the whole residual, contact excluded:
    /// `A^-1 (b(u) - b(u + z))` gives `z` back.
    #[test]
    fn the_matrix_of_a_step_is_the_derivative_of_its_residual(
        theta in 0.5..1.0_f64, xi in 0.5..1.0_f64, dt in 0.01..0.5_f64,
        alpha in 0.0..0.5_f64, beta in 0.0..0.1_f64,
        shape in prop::collection::vec(-0.1..0.1_f64, 36), direction in prop::collection::vec(-1.0..1.0_f64, 36),
    ) {
        let model = model(theta, xi, Rayleigh { mass: alpha, stiffness: beta });
        let fixed = model.prescribed();
        let free = |x: &[f64]| -> Vec<f64> { x.iter().zip(&fixed).map(|(x, f)| if *f { 0.0 } else { *x }).collect() };
        let (u, z) = (free(&shape), free(&direction));
        let now = Stepper::new(&model, Box::new(NoClock)).unwrap().initial_state(vec![0.1; 36]).unwrap();
        let mut elements = Elements::new(&model).unwrap();
        let step = StepProblem::new(&elements, &now, dt);
        elements.update_tangents(&u).unwrap();
        let mut body = BodySystem::all(&model, &fixed).unwrap().remove(0);
        let mut counters = Counters::default();
        body.refactor(&elements, step.weights, &[], &mut counters).unwrap();
        prop_assume!(counters.indefinite_tangents == 0);
        let h = 1e-6;
        let moved = |s: f64| -> Vec<f64> { u.iter().zip(&z).map(|(u, z)| u + s * h * z).collect() };
        let (ahead, behind) = (balance(&step, &mut elements, &fixed, &moved(1.0)), balance(&step, &mut elements, &fixed, &moved(-1.0)));
        let slope: Vec<f64> = ahead.iter().zip(&behind).map(|(a, b)| (b - a) / (2.0 * h)).collect();
        body.forward(&slope);
        let mut back = vec![0.0; 36];
        body.backward(None, &mut back, &mut counters).unwrap();
        for (back, z) in back.iter().zip(&z) {
            prop_assert!((back - z).abs() < 1e-5, "{back} {z}");
        }
    }
}
