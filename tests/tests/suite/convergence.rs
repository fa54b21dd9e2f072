//! Orders in the step.

use crate::common::{Run, run, scene_text};

/// A clamped block swings after a push: no contact, large deformation.
fn swinging(dt: f64, theta: f64) -> Run {
    let text = format!(
        r#"(
    title: "swinging",
    materials: {{"m": (law: NeoHookean(E: 100.0, nu: 0.3), density: 1.0)}},
    bodies: {{"block": (mesh: Box(min: (0.0, 0.0, 0.0), max: (1.0, 1.0, 3.0), cells: (1, 1, 3)), material: "m", velocity: (2.0, 0.5, 0.0))}},
    motions: {{"base": (nodes: "block.z_min")}},
    time: (end: 0.4, dt: {dt:e}, theta: {theta:e}, xi: {theta:e}),
)"#
    );
    run(&scene_text(&text, &[]))
}

fn distance(a: &Run, b: &Run) -> f64 {
    let pairs = a.last().state.u.iter().zip(&b.last().state.u);
    pairs.map(|(a, b)| (a - b).powi(2)).sum::<f64>().sqrt()
}

/// Observed order from three steps in the ratio 4 : 2 : 1.
fn order(theta: f64, dt: f64) -> f64 {
    let [a, b, c] = [4.0, 2.0, 1.0].map(|k| swinging(k * dt, theta));
    (distance(&a, &b) / distance(&b, &c)).log2()
}

#[test]
fn trapezoid_is_of_second_order_and_backward_euler_of_first() {
    let (two, one) = (order(0.5, 0.0025), order(1.0, 0.00125));
    assert!((1.85..2.15).contains(&two), "trapezoid: {two}");
    assert!((0.8..1.2).contains(&one), "backward Euler: {one}");
}

#[test]
fn integration_error_of_the_trapezoid_shrinks_with_the_square_of_the_step() {
    let error = |dt: f64| swinging(dt, 0.5).totals.energy.integration_error().abs();
    let (coarse, fine) = (error(0.01), error(0.005));
    assert!(coarse > 3.0 * fine, "{coarse} J, half the step {fine} J");
}
