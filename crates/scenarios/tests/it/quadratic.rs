//! Quadratic cells in scenes, files and pictures.

use nscd::{NoClock, Stepper};
use scenarios::Fields;
use scenarios::output::{deformed_svg, vtu_bytes};
use scenarios::spec::{LoadedScene, SceneError, parse};
use scenarios::{Built, build};

use crate::vtu_reader::Vtu;

fn one_body(mesh: &str) -> Result<LoadedScene, SceneError> {
    let text = format!(
        r#"(title: "x", materials: {{ "m": (law: BlatzKo(G: 1), density: 1) }},
        bodies: {{ "a": (mesh: {mesh}, material: "m") }}, time: (end: 1, dt: 1))"#
    );
    parse("x.ron", &text, &[])
}

fn built(mesh: &str) -> Built {
    let loaded = one_body(mesh).unwrap_or_else(|e| panic!("{mesh}: {e}"));
    build(&loaded).unwrap()
}

/// The file and the picture of the body at rest.
fn shown(built: &Built) -> (Vtu, String) {
    let mut stepper = Stepper::new(&built.model, Box::new(NoClock)).unwrap();
    let state = stepper.initial_state(built.velocity.clone()).unwrap();
    let fields = Fields::new(built, &state);
    let frame = fields.frame(built, &state);
    assert_eq!(frame.defect(), None);
    let vtu = Vtu::read(&vtu_bytes(&frame).unwrap());
    (vtu, deformed_svg("x", &frame).unwrap())
}

#[test]
fn quadratic_cells_are_written_whole_and_drawn_as_the_finer_linear_ones() {
    let square = "Rectangle(min: (0, 0), max: (2, 1), cells: (X, Y), element: E)";
    let cube = "Box(min: (0, 0, 0), max: (2, 1, 1), cells: (X, Y, Y), element: E)";
    for (mesh, quadratic, linear, vtk, nodes) in [
        (square, "Quad9", "Quad4", 28, 9),
        (square, "Tri6", "Tri3", 22, 6),
        (cube, "Hex27", "Hex8", 29, 27),
        (cube, "Tet10", "Tet4", 24, 10),
    ] {
        let of = |element: &str, n: usize| {
            let mesh = mesh.replace('X', &(2 * n).to_string());
            let mesh = mesh.replace('Y', &n.to_string());
            built(&mesh.replace("element: E", &format!("element: {element}")))
        };
        let whole = of(quadratic, 1);
        let (vtu, picture) = shown(&whole);
        let count = whole.model.solid.element_count();
        assert_eq!(vtu.integers("types"), vec![vtk; count]);
        assert_eq!(vtu.integers("offsets")[0], nodes);
        let cells: Vec<i64> = whole.model.solid.mesh().blocks[0]
            .cells
            .iter()
            .map(|n| i64::from(*n))
            .collect();
        assert_eq!(vtu.integers("connectivity"), cells);
        let polygons = |svg: &str| svg.matches("<polygon").count();
        assert_eq!(polygons(&picture), polygons(&shown(&of(linear, 2)).1));
    }
}

#[test]
fn a_half_ball_takes_hexahedra_only() {
    let ball = |element: &str| {
        one_body(&format!(
            "HalfBall(center: (0, 0, 0), radius: 1, cells: 2, pole: Up, element: {element})"
        ))
    };
    assert!(ball("Hex27").is_ok());
    let refused = ball("Tet10").unwrap_err();
    let fault = &refused.faults()[0];
    assert_eq!(fault.path, "bodies.a.mesh.element");
    assert!(fault.message.contains("Hex27"), "{fault}");
}
