//! Meshes of the bodies of a scene.

use fe_core::{Mesh, MeshError, Symmetry, ValidMesh};

use crate::spec::{self, LoadedScene, SceneError};

/// The meshes of all bodies in one, and where the nodes of each body begin.
pub(super) fn mesh(loaded: &LoadedScene) -> Result<(ValidMesh, Vec<usize>), SceneError> {
    let scene = &loaded.scene;
    let mut all = Mesh::default();
    let mut first_node = vec![0];
    for (name, body) in &scene.bodies {
        let refuse = |e: MeshError| loaded.refuse(&format!("bodies.{name}.mesh"), e.to_string());
        let mut part = body.mesh.generate(scene.refine, name).map_err(refuse)?;
        if part.symmetry != Symmetry::None && scene.symmetry == Some(spec::Symmetry::Axisymmetric) {
            part.symmetry = Symmetry::Axisymmetric;
        }
        all.append(name, part).map_err(refuse)?;
        first_node.push(all.points.len());
    }
    let all = all.validated();
    let all = all.map_err(|e| loaded.refuse("bodies", e.to_string()))?;
    Ok((all, first_node))
}
