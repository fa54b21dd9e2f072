//! The laws against the battery, their closed forms, and the bounds of their parameters.

#![allow(
    clippy::unwrap_used,
    reason = "tests may; Clippy knows only functions marked as one"
)]

mod battery;
mod closed_forms;
mod energies;
mod parameters;
mod refusals;

use hyperelastic::nalgebra::Matrix3;
use hyperelastic::{
    BlatzKo, ElasticConstants, NeoHookean, SaintVenantKirchhoff, Symmetric, ThreeE, conformance,
    right_cauchy_green,
};
use proptest::prelude::*;

fn blatz_ko(shear: f64) -> BlatzKo {
    BlatzKo::new(shear).unwrap()
}

fn neo_hookean(shear: f64, lame: f64) -> NeoHookean {
    NeoHookean::new(ElasticConstants::from_shear_lame(shear, lame).unwrap()).unwrap()
}

fn saint_venant_kirchhoff(shear: f64, bulk: f64) -> SaintVenantKirchhoff {
    SaintVenantKirchhoff::new(ElasticConstants::from_shear_bulk(shear, bulk).unwrap()).unwrap()
}

fn three_e(shear: f64, bulk: f64, a: [f64; 5]) -> ThreeE {
    ThreeE::new(ElasticConstants::from_shear_bulk(shear, bulk).unwrap(), a).unwrap()
}

/// The largest `|a1|` and `|a2|` of [Feng2007, eq. 17], times a fraction in [-1, 1].
fn within_bounds(shear: f64, bulk: f64, [f1, f2, a3, a4, a5]: [f64; 5]) -> [f64; 5] {
    [
        f1 * (2.0 * shear * a5).sqrt(),
        f2 * 3.0 * (bulk * a4).sqrt(),
        a3,
        a4,
        a5,
    ]
}

/// `F = diag(l) Q^T`, a rotation before the stretch.
fn turned_and_stretched(l: [f64; 3], q: &Matrix3<f64>) -> Matrix3<f64> {
    Matrix3::from_diagonal(&l.into()) * q.transpose()
}

/// `C` with these principal values along the axes.
fn diagonal(c: [f64; 3]) -> Symmetric {
    Symmetric::new(c[0], c[1], c[2], 0.0, 0.0, 0.0)
}

fn any_stretches() -> impl Strategy<Value = [f64; 3]> {
    [0.3..3.0, 0.3..3.0, 0.3..3.0]
}

fn any_rotation() -> impl Strategy<Value = Matrix3<f64>> {
    [0.0..1.0, 0.0..1.0, 0.0..1.0].prop_map(conformance::rotation)
}

fn any_three_e() -> impl Strategy<Value = ThreeE> {
    (
        0.1..10.0,
        0.1..10.0,
        [-1.0..1.0, -1.0..1.0, 0.0..5.0, 0.0..5.0, 0.0..5.0],
    )
        .prop_map(|(shear, bulk, fractions): (f64, f64, [f64; 5])| {
            three_e(shear, bulk, within_bounds(shear, bulk, fractions))
        })
}
