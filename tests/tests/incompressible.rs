//! Indenters in nearly incompressible matter.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

use tests::cases::incompressible;
use tests::{Case, Measured};

/// Force and alternating part of the pressure with elements of projected dilatation.
fn projected(case: &Case, nu: f64, element: &str) -> Measured {
    let law = incompressible::law(nu);
    let element = format!("bodies.block.mesh.element={element}");
    let sets = [&law, "bodies.block.dilatation=Projected", &element];
    case.run(&sets).unwrap()
}

fn both() -> [Case; 2] {
    [incompressible::punch(), incompressible::cone()]
}

/// Nothing but `E/(1 - nu^2)` changes from .495 to .4999.
#[test]
fn forces_scale_as_matter_becomes_incompressible() {
    for case in both() {
        let [mild, hard] = [0.495, 0.4999].map(|nu| projected(&case, nu, "Quad4"));
        let scaled = (1.0 + hard.error("force")) / (1.0 + mild.error("force"));
        assert!((scaled - 1.0).abs() < 5e-3, "{} {scaled}", case.name);
        // A mode that only the compressibility holds would grow without bound.
        let part = |measured: &Measured| measured.error("alternating pressure");
        assert!(part(&hard) < 1.1 * part(&mild), "{}", case.name);
    }
}

/// The stable element: the pressure alternates as much as in compressible matter, which is what the singular field does
/// itself on this mesh.
#[test]
fn the_pressure_of_quad9_does_not_alternate() {
    let case = incompressible::punch();
    let [soft, hard] = [0.3, 0.4999].map(|nu| projected(&case, nu, "Quad9"));
    let part = |measured: &Measured| measured.error("alternating pressure");
    assert!(part(&hard) < 1.03 * part(&soft), "{soft:?} {hard:?}");
}
