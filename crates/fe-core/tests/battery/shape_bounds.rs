//! Shapes that cannot be meshed.

use fe_core::{
    AnnulusMesh, BoxMesh, CellKind, DiscMesh, HalfBallMesh, HalfDiscMesh, Mesh, MeshError, Pole,
    QuarterDiscMesh, RectangleMesh,
};
use nalgebra::Vector3;

#[test]
fn impossible_shapes_are_refused_with_the_bound() {
    let refuse = |result: Result<Mesh, MeshError>, words: [&str; 2]| {
        let message = result.unwrap_err().to_string();
        assert!(words.iter().all(|w| message.contains(w)), "{message}");
    };
    let disc = DiscMesh {
        center: [0.0; 2],
        radius: 1.0,
        cells: 4,
        kind: CellKind::Quad4,
    };
    refuse(
        DiscMesh {
            radius: -1.0,
            ..disc
        }
        .generate("a"),
        ["radius [m] = -1", "positive"],
    );
    refuse(
        DiscMesh {
            radius: f64::NAN,
            ..disc
        }
        .generate("a"),
        ["disc", "positive"],
    );
    refuse(
        DiscMesh { cells: 0, ..disc }.generate("a"),
        ["cells = 0", "at least 1"],
    );
    refuse(
        DiscMesh {
            cells: usize::MAX,
            ..disc
        }
        .generate("a"),
        ["nodes", "2^32"],
    );
    refuse(
        DiscMesh {
            center: [0.0, f64::NAN],
            ..disc
        }
        .generate("a"),
        ["center on axis 1", "finite"],
    );
    refuse(
        DiscMesh {
            kind: CellKind::Hex8,
            ..disc
        }
        .generate("a"),
        ["Hex8", "dimension 2"],
    );
    let half = HalfDiscMesh {
        center: [0.0; 2],
        radius: 1.0,
        cells: 0,
        pole: Pole::Up,
        kind: CellKind::Quad4,
    };
    refuse(half.generate("a"), ["half disc", "at least 1"]);
    refuse(
        HalfDiscMesh {
            cells: usize::MAX,
            ..half
        }
        .generate("a"),
        ["nodes", "2^32"],
    );
    let quarter = QuarterDiscMesh {
        center: [0.0; 2],
        radius: 0.0,
        cells: 2,
        pole: Pole::Up,
        kind: CellKind::Quad4,
    };
    refuse(quarter.generate("a"), ["quarter disc", "positive"]);
    let ball = HalfBallMesh {
        center: Vector3::zeros(),
        radius: 1.0,
        cells: 0,
        pole: Pole::Up,
        kind: CellKind::Hex8,
    };
    refuse(ball.generate("a"), ["half ball", "at least 1"]);
    refuse(
        HalfBallMesh {
            cells: usize::MAX,
            ..ball
        }
        .generate("a"),
        ["nodes", "2^32"],
    );
    let ring = AnnulusMesh {
        center: [0.0; 2],
        inner: 1.0,
        outer: 2.0,
        cells: [8, 1],
        grading: 1.0,
        kind: CellKind::Quad4,
    };
    refuse(
        AnnulusMesh { outer: 0.5, ..ring }.generate("a"),
        ["outer less inner", "positive"],
    );
    refuse(
        AnnulusMesh {
            cells: [2, 1],
            ..ring
        }
        .generate("a"),
        ["around = 2", "at least 3"],
    );
    refuse(
        AnnulusMesh {
            cells: [8, 0],
            ..ring
        }
        .generate("a"),
        ["through", "at least 1"],
    );
    refuse(
        AnnulusMesh {
            grading: 0.0,
            ..ring
        }
        .generate("a"),
        ["grading", "positive"],
    );
    let plate = RectangleMesh::uniform([0.0; 2], [1.0, 0.0], [1; 2]);
    refuse(plate.generate("a"), ["length [m] on axis 1", "positive"]);
    let plate = RectangleMesh::uniform([0.0; 2], [1.0; 2], [1; 2]).with_kind(CellKind::Tet4);
    refuse(plate.generate("a"), ["Tet4", "dimension 2"]);
    let cube = BoxMesh::uniform([0.0; 3], [1.0; 3], [1; 3]).with_kind(CellKind::Quad4);
    refuse(cube.generate("a"), ["Quad4", "dimension 3"]);
}
