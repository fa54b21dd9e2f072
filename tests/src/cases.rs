//! The cases. A new one is a file with a function that returns it, and a line in [`all`].

pub mod adhesion;
pub mod bar;
pub mod block;
pub mod contact_patch;
pub mod first_scenes;
pub mod free_body;
pub mod hertz;
pub mod hu2022;
pub mod incompressible;
pub mod indenters;
pub mod mindlin;
pub mod oblique;

use crate::Case;

/// Every case, in the order of the documents.
pub fn all() -> Vec<Case> {
    vec![
        bar::on_a_wall(),
        first_scenes::impact(),
        first_scenes::press_twist(),
        first_scenes::twist_dry(),
        bar::on_a_clamped_bar(),
        bar::exchange(),
        bar::impedances(),
        block::sliding(),
        block::bouncing(),
        free_body::turning(),
        free_body::vibrating(),
        oblique::oblique(),
        hu2022::indentation(),
        hu2022::wheel(),
        hu2022::plate_cylinder(),
        hu2022::plate_cylinder_slow(),
        hu2022::twist(),
        hertz::cylinder(),
        hertz::sphere(),
        hertz::ball(),
        indenters::cone(),
        indenters::punch(),
        incompressible::cone(),
        incompressible::punch(),
        mindlin::cylinder(),
        mindlin::sphere(),
        contact_patch::non_matching(),
        adhesion::pull_off(),
        adhesion::pull_off_small(),
        adhesion::pull_off_large(),
        adhesion::peel(),
        adhesion::plate_pull(),
    ]
}
