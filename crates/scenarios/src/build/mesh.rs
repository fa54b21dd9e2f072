//! Meshes of the bodies of a scene.

use fe_core::{
    AnnulusMesh, BoxMesh, CellKind, DiscMesh, GridMesh, HalfBallMesh, HalfDiscMesh, Mesh,
    MeshError, QuarterDiscMesh, RectangleMesh, Symmetry,
};

use crate::spec::{self, LoadedScene, SceneError};

/// The meshes of all bodies in one, and where the nodes of each body begin.
pub(super) fn mesh(loaded: &LoadedScene) -> Result<(Mesh, Vec<usize>), SceneError> {
    let scene = &loaded.scene;
    let mut all = Mesh::default();
    let mut first_node = vec![0];
    for (name, body) in &scene.bodies {
        let refuse = |e: MeshError| loaded.refuse(&format!("bodies.{name}.mesh"), e.to_string());
        let mut part = generate(&body.mesh, scene.refine, name).map_err(refuse)?;
        if part.symmetry != Symmetry::None && scene.symmetry == Some(spec::Symmetry::Axisymmetric) {
            part.symmetry = Symmetry::Axisymmetric;
        }
        all.append(name, part).map_err(refuse)?;
        first_node.push(all.points.len());
    }
    Ok((all, first_node))
}

fn generate(mesh: &spec::Mesh, refine: usize, name: &str) -> Result<Mesh, MeshError> {
    let fine = |cells: usize| cells * refine;
    match *mesh {
        spec::Mesh::Grid {
            ref x,
            ref y,
            element,
            crown,
        } => {
            let grid = GridMesh {
                axes: vec![x.clone(), y.clone()],
                refine,
                kind: plane_kind(element),
            };
            match crown {
                Some(radius) => grid.generate_crowned(name, radius),
                None => grid.generate(name),
            }
        }
        spec::Mesh::SolidGrid {
            ref x,
            ref y,
            ref z,
            element,
            crown,
        } => {
            let grid = GridMesh {
                axes: vec![x.clone(), y.clone(), z.clone()],
                refine,
                kind: solid_kind(element),
            };
            match crown {
                Some(radius) => grid.generate_crowned(name, radius),
                None => grid.generate(name),
            }
        }
        spec::Mesh::Box {
            min,
            max,
            cells,
            grading,
            element,
        } => BoxMesh {
            min: min.into(),
            max: max.into(),
            cells: cells.map(fine),
            grading,
            kind: solid_kind(element),
        }
        .generate(name),
        spec::Mesh::HalfBall {
            center,
            radius,
            cells,
            pole,
            element,
        } => HalfBallMesh {
            center: center.into(),
            radius,
            cells: fine(cells),
            pole,
            kind: solid_kind(element),
        }
        .generate(name),
        spec::Mesh::Rectangle {
            min,
            max,
            cells,
            grading,
            element,
        } => RectangleMesh {
            min,
            max,
            cells: cells.map(fine),
            grading,
            kind: plane_kind(element),
        }
        .generate(name),
        spec::Mesh::Disc {
            center,
            radius,
            cells,
            element,
        } => DiscMesh {
            center,
            radius,
            cells: fine(cells),
            kind: plane_kind(element),
        }
        .generate(name),
        spec::Mesh::HalfDisc {
            center,
            radius,
            cells,
            pole,
            element,
        } => HalfDiscMesh {
            center,
            radius,
            cells: fine(cells),
            pole,
            kind: plane_kind(element),
        }
        .generate(name),
        spec::Mesh::QuarterDisc {
            center,
            radius,
            cells,
            pole,
            element,
        } => QuarterDiscMesh {
            center,
            radius,
            cells: fine(cells),
            pole,
            kind: plane_kind(element),
        }
        .generate(name),
        spec::Mesh::Annulus {
            center,
            inner,
            outer,
            cells,
            grading,
            element,
        } => AnnulusMesh {
            center,
            inner,
            outer,
            cells: cells.map(fine),
            grading,
            kind: plane_kind(element),
        }
        .generate(name),
    }
}

fn solid_kind(element: spec::Element) -> CellKind {
    match element {
        spec::Element::Hex8 => CellKind::Hex8,
        spec::Element::Tet4 => CellKind::Tet4,
        spec::Element::Hex27 => CellKind::Hex27,
        spec::Element::Tet10 => CellKind::Tet10,
    }
}

fn plane_kind(element: spec::PlaneElement) -> CellKind {
    match element {
        spec::PlaneElement::Quad4 => CellKind::Quad4,
        spec::PlaneElement::Tri3 => CellKind::Tri3,
        spec::PlaneElement::Quad9 => CellKind::Quad9,
        spec::PlaneElement::Tri6 => CellKind::Tri6,
    }
}
