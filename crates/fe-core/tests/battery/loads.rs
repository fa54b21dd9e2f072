//! Prescribed motion, tractions and weight.

use fe_core::{
    CellKind, DeadTraction, Dirichlet, FeError, Gravity, Interpolation, Motion, Rotation, Table,
};
use nalgebra::Vector3;

use crate::common::{self, KINDS, blatz_ko, distorted_box};

fn ramp(v: f64) -> Table {
    Table::new(vec![(0.0, 0.0), (2.0, v)], Interpolation::Linear).unwrap()
}

#[test]
fn prescribed_nodes_follow_the_motion_in_their_components_only() {
    let mesh = distorted_box([2, 2, 2], CellKind::Hex8, 0.0, false);
    let motion = Motion::translation([ramp(0.1), Table::zero(), ramp(-0.2)])
        .with_rotation(Rotation::new([0.5, 0.6, 0.0], [0.0, 0.0, 1.0], ramp(1.0)).unwrap());
    let driven = Dirichlet::clamped("top", mesh.node_sets["z_max"].clone())
        .with_components([true, false, true])
        .with_motion(motion.clone());
    driven.check(&mesh).unwrap();
    let dofs: Vec<usize> = driven.dofs(3).collect();
    assert_eq!(dofs.len(), 18);
    let n = 3 * mesh.points.len();
    let (mut u, mut v) = (vec![7.0; n], vec![7.0; n]);
    driven.set_displacement(&mesh, 1.5, &mut u);
    driven.set_velocity(&mesh, 1.5, &mut v);
    for dof in 0..n {
        if dofs.contains(&dof) {
            let x = mesh.points[dof / 3];
            assert_eq!(u[dof], motion.displacement(x, 1.5)[dof % 3]);
            assert_eq!(v[dof], motion.velocity(x, 1.5)[dof % 3]);
        } else {
            assert!(u[dof] == 7.0 && v[dof] == 7.0);
        }
    }
    let missing = Dirichlet::clamped("far", vec![0, 27]);
    assert!(matches!(
        missing.check(&mesh),
        Err(FeError::Index { index: 27, .. })
    ));
}

#[test]
fn tractions_have_their_resultant_and_moment() {
    for kind in KINDS {
        let mesh = distorted_box([3, 2, 2], kind, 0.2, false);
        let side = mesh.facet_sets["x_max"].clone();
        let pull = DeadTraction::new(side, [2.0, 0.0, -3.0], Table::constant(1.0));
        let f = pull.nodal_forces(&mesh).unwrap();
        let area = 1.2 * 0.8;
        for i in 0..3 {
            let total: f64 = f.iter().skip(i).step_by(3).sum();
            assert!((total - area * pull.traction[i]).abs() < 1e-14);
        }
        // The resultant acts at the centre of the face.
        let arm: f64 = mesh
            .points
            .iter()
            .zip(f.chunks(3))
            .map(|(x, f)| x[1] * f[0])
            .sum();
        assert!((arm - 0.6 * area * 2.0).abs() < 1e-14);
    }
}

#[test]
fn weight_is_mass_times_gravity_for_both_masses() {
    let mesh = distorted_box([2, 3, 2], CellKind::Tet4, 0.2, true);
    let solid = common::solid(mesh, blatz_ko(), 40.0);
    let gravity = Gravity::new([0.0, 1.0, -9.81], Table::constant(1.0));
    let consistent = gravity.nodal_forces(&solid.consistent_mass()).unwrap();
    let lumped = gravity.nodal_forces(&solid.lumped_mass()).unwrap();
    let uniform: Vec<f64> = (0..solid.dof_count())
        .map(|dof| gravity.acceleration[dof % 3])
        .collect();
    let mut expected = vec![0.0; solid.dof_count()];
    solid.consistent_mass().times(&uniform, &mut expected);
    for dof in 0..solid.dof_count() {
        assert!((consistent[dof] - expected[dof]).abs() < 1e-12);
        assert!((lumped[dof] - expected[dof]).abs() < 1e-12);
    }
}

#[test]
fn impossible_loads_are_refused() {
    let mesh = distorted_box([1, 1, 1], CellKind::Hex8, 0.0, false);
    let load = |traction: Vector3<f64>| {
        DeadTraction::new(mesh.facet_sets["x_max"].clone(), traction, Table::zero())
    };
    assert!(matches!(
        load(Vector3::repeat(f64::NAN)).nodal_forces(&mesh),
        Err(FeError::Parameter { .. })
    ));
    let mut empty = load(Vector3::repeat(1.0));
    empty.facets.clear();
    assert!(matches!(
        empty.nodal_forces(&mesh),
        Err(FeError::Surface { .. })
    ));
    let mut far = load(Vector3::repeat(1.0));
    far.facets[0].nodes[0] = 1000;
    assert!(matches!(
        far.nodal_forces(&mesh),
        Err(FeError::Index { .. })
    ));
    let gravity = Gravity::new([f64::INFINITY, 0.0, 0.0], Table::zero());
    let solid = common::solid(mesh, blatz_ko(), 1.0);
    assert!(gravity.nodal_forces(&solid.lumped_mass()).is_err());
}
