//! Three contacts of one rigid block, solved from `W`, `q` and `mu`:
//! `cargo run -p contact-bipotential --example three_contacts`.
//!
//! A block of mass 1 and side 2 stands on three feet and is pushed sideways. What a unit reaction at one foot does to
//! the velocity of another is `W = H M^-1 H^T`; what the feet would do without reactions is `q`.

use contact_bipotential::nalgebra::{Matrix3, Matrix3x6, Matrix6, Vector3, Vector6};
use contact_bipotential::{
    Cone, ContactError, ContactProblem, Delassus, Method, SolveSettings, errors, solve,
};

/// The feet, from the centre of mass \[m\].
const FEET: [Vector3<f64>; 3] = [
    Vector3::new(-0.8, -0.8, -1.0),
    Vector3::new(0.8, -0.8, -1.0),
    Vector3::new(0.0, 0.8, -1.0),
];
/// Coefficients of friction \[-\]: the third foot stands on ice.
const MU: [f64; 3] = [0.4, 0.4, 0.02];

fn main() -> Result<(), ContactError> {
    let inverse_mass = Matrix6::from_diagonal(&Vector6::new(1.0, 1.0, 1.0, 1.5, 1.5, 1.5));
    // Velocity of a foot from that of the block: translation and rotation x arm. Axes (t1, t2, n) are (x, y, z).
    let rows = FEET.map(|arm| {
        let mut h = Matrix3x6::zeros();
        h.fixed_view_mut::<3, 3>(0, 0)
            .copy_from(&Matrix3::identity());
        h.fixed_view_mut::<3, 3>(0, 3)
            .copy_from(&-arm.cross_matrix());
        h
    });
    let mut entries = Vec::new();
    for (c, a) in rows.iter().enumerate() {
        for (d, b) in rows.iter().enumerate() {
            let block = a * inverse_mass * b.transpose();
            for i in 0..3 {
                entries.extend((0..3).map(|j| (3 * c + i, 3 * d + j, block[(i, j)])));
            }
        }
    }
    // A tenth of a second of gravity, and a push of 3 N s at the centre.
    let free = Vector6::new(0.3, 0.0, -0.981, 0.0, 0.0, 0.0);
    let q = rows
        .iter()
        .flat_map(|h| <[f64; 3]>::from(h * free))
        .collect();
    let w = Delassus::from_entries(3, 3, &entries)?;
    let problem = ContactProblem::new(w, q, MU.to_vec(), Cone::Spatial)?;

    for method in [Method::Auto, Method::GaussSeidel, Method::UzawaAnderson] {
        let mut r = Vec::new();
        let outcome = solve(
            &problem,
            &mut r,
            &SolveSettings::default().with_method(method),
        );
        let measured = errors(&problem, &r);
        println!(
            "{}: {:?} after {} iterations, errors {:.1e} (Siconos) and {:.1e} (scale-free)",
            method.name(),
            outcome.status,
            outcome.iterations,
            measured.siconos,
            measured.scale_free
        );
        for c in 0..3 {
            let rows = Cone::Spatial.range(c);
            let (r, u) = (&r[rows.clone()], &outcome.u[rows]);
            println!("  foot {c}: r = {r:+.4?} N s, u = {u:+.4?} m/s");
        }
    }
    Ok(())
}
