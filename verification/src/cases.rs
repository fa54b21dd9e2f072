//! The cases. A new one is a file with a function that returns it, and a line in [`all`].

pub mod bar;
pub mod hu2022;

use crate::Case;

/// Every case, in the order of the documents.
pub fn all() -> Vec<Case> {
    vec![
        bar::on_a_wall(),
        hu2022::indentation(),
        hu2022::wheel(),
        hu2022::plate_cylinder(),
        hu2022::plate_cylinder_slow(),
        hu2022::twist(),
    ]
}
