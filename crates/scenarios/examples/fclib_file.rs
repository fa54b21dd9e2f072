//! A contact problem as a file that other codes read: written as FCLib, read back, solved by every method.
//!
//! ```text
//! cargo run -p scenarios --example fclib_file
//! ```
//!
//! Three contacts stand on one elastic block: pressing one moves the others. The first sticks, the second slips, the
//! third opens. FCLib keeps the normal first, this workspace keeps it last; the writer and the reader turn it.

use std::error::Error;

use contact_bipotential::{Cone, ContactProblem, Delassus, Method, SolveSettings, solve};
use scenarios::fclib;

fn main() -> Result<(), Box<dyn Error>> {
    let problem = three_contacts()?;
    // A name of this process alone, in the folder for temporary files.
    let file = format!("setae-three-contacts-{}.hdf5", std::process::id());
    let path = std::env::temp_dir().join(file);
    std::fs::write(&path, fclib::write::local(&path, &problem)?)?;
    let read = fclib::read(&path);
    std::fs::remove_file(&path)?;
    let read = read?;

    println!("{} contacts written and read back\n", read.contacts());
    println!("method                    status        iterations  error [-]  scale-free error [-]");
    for method in Method::ALL {
        let settings = SolveSettings::default().with_method(method);
        let mut reactions = vec![0.0; read.q.len()];
        let outcome = solve(&read, &mut reactions, &settings);
        println!(
            "{:25} {:13} {:10}  {:9.1e}  {:9.1e}",
            method.name(),
            format!("{:?}", outcome.status),
            outcome.iterations,
            outcome.error,
            outcome.error_scale_free
        );
    }

    let mut r = vec![0.0; read.q.len()];
    let outcome = solve(&read, &mut r, &SolveSettings::default());
    println!("\ncontact    r_t1       r_t2       r_n [N s]      u_n [m/s]");
    for (k, (r, u)) in r.chunks(3).zip(outcome.u.chunks(3)).enumerate() {
        let [r_t1, r_t2, r_n] = [r[0], r[1], r[2]];
        println!("{k:7}  {r_t1:9.6}  {r_t2:9.6}  {r_n:9.6}    {:9.2e}", u[2]);
    }
    Ok(())
}

/// `u = W r + q` with friction .3: `W` \[m/s per N s\] is the compliance of one block, `q` \[m/s\] what happens without
/// contact.
fn three_contacts() -> Result<ContactProblem, Box<dyn Error>> {
    const CONTACTS: usize = 3;
    const SIZE: usize = 3 * CONTACTS;
    let compliance = |row: usize, column: usize| -> f64 {
        let (same_contact, same_axis) = (row / 3 == column / 3, row % 3 == column % 3);
        match (same_contact, same_axis) {
            (true, true) => 1.0,
            // A neighbour moves by a tenth, along the same axis only.
            (false, true) => 0.1,
            _ => 0.0,
        }
    };
    let all = (0..SIZE).flat_map(|i| (0..SIZE).map(move |j| (i, j)));
    let entries = all.map(|(i, j)| (i, j, compliance(i, j)));
    let entries: Vec<_> = entries.filter(|(_, _, value)| *value != 0.0).collect();
    let w = Delassus::from_entries(CONTACTS, 3, &entries)?;
    // (t1, t2, n) of each contact: pressed and hardly moved, pressed and moved fast, lifted.
    let q = vec![0.05, 0.0, -1.0, 1.0, 0.5, -1.0, 0.0, 0.0, 0.4];
    Ok(ContactProblem::new(
        w,
        q,
        vec![0.3; CONTACTS],
        Cone::Spatial,
    )?)
}
