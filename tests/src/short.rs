//! Every built-in scene in a form that takes a second or two: what `cargo xtask regress` runs.

use crate::Plan;
use crate::cases::{mindlin, oblique};

/// Scene and changed values; a coarser mesh where there is need, and an end after the things that matter have begun.
const FORMS: &[(&str, &[&str])] = &[
    ("bar-impact", &["time.end=2.2", "dt=0.02"]),
    (
        "bar-on-bar",
        &[
            "striker.mesh.cells=(50, 1)",
            "struck.mesh.cells=(50, 1)",
            "time.dt=0.02",
        ],
    ),
    ("bouncing-block", &["time.dt=0.002"]),
    ("free-body", &["time.dt=0.02"]),
    ("sliding-block", &["time.dt=0.004"]),
    (
        "cone",
        &[
            "refine=1",
            "semi_apex_angle=85.0",
            "translation=(0, [(0, 0), (1, -1.37428e-4)], 0)",
            "dt=0.1",
        ],
    ),
    ("debonding", &["mesh.cells=10", "time.dt=1.6e-4"]),
    ("impact", &["time.end=0.5", "mu=0.5"]),
    ("flat-punch", &[]),
    (
        "indentation-elastic",
        &["block.mesh.cells=(40, 8)", "time.dt=0.1"],
    ),
    ("indentation", &["cells=(59, 10)", "time.dt=0.05"]),
    (
        "plate-cylinder",
        &[
            "cylinder.mesh.cells=10",
            "plate.mesh.cells=(38, 2)",
            "time.dt=1.6e-4",
        ],
    ),
    ("press-twist", &["cells=(6, 6, 2)"]),
    ("twist-dry", &["cells=(6, 6, 2)"]),
    ("twist", &["cells=(6, 6, 2)"]),
    ("contact-patch", &[]),
    ("hertz-ball", &["refine=1"]),
    ("hertz-cylinder", &["refine=1", "dt=0.25"]),
    ("hertz-sphere", &["refine=1", "dt=0.25"]),
    ("mindlin-cylinder", &["refine=1", "time.dt=0.5"]),
    ("mindlin-sphere", &mindlin::FIVE),
    ("oblique-impact", &oblique::COARSE),
    ("pull-off", &["time.dt=0.1"]),
    ("peel", &["time.end=3"]),
    ("plate-pull", &["time.dt=0.01"]),
    ("wheel", &["mesh.cells=8", "time.end=0.03"]),
];

/// The other elements, the projected dilatation and the position level of an impact: name, scene and changed values.
const VARIANTS: &[(&str, &str, &[&str])] = &[
    (
        "bar-impact-position",
        "bar-impact",
        &["contact=Position", "time.end=2.2", "dt=0.02"],
    ),
    (
        "contact-patch-quad9",
        "contact-patch",
        &["low.mesh.element=Quad9", "high.mesh.element=Quad9"],
    ),
    (
        "flat-punch-projected",
        "flat-punch",
        &[
            "block.mesh.element=Quad4",
            "block.dilatation=Projected",
            "nu=0.4999",
        ],
    ),
    (
        "hertz-ball-tet4",
        "hertz-ball",
        &["refine=1", "mesh.element=Tet4"],
    ),
    (
        "hertz-cylinder-quad9",
        "hertz-cylinder",
        &["refine=1", "dt=0.25", "mesh.element=Quad9"],
    ),
    (
        "hertz-cylinder-tri3",
        "hertz-cylinder",
        &["refine=1", "dt=0.25", "mesh.element=Tri3"],
    ),
    (
        "hertz-sphere-tri6",
        "hertz-sphere",
        &["refine=1", "dt=0.25", "mesh.element=Tri6"],
    ),
    (
        "press-twist-tet10",
        "press-twist",
        &["cells=(6, 6, 2)", "mesh.element=Tet10"],
    ),
    (
        "twist-hex27",
        "twist",
        &["cells=(4, 4, 2)", "mesh.element=Hex27"],
    ),
];

/// One plan a scene, and some more.
pub fn short_forms() -> Vec<Plan> {
    let plan = |(scene, sets): &(&str, &[&str])| Plan::new(*scene, *scene, sets.iter().copied());
    let variant = |(name, scene, sets): &(&str, &str, &[&str])| {
        Plan::new(*name, *scene, sets.iter().copied())
    };
    let forms = FORMS.iter().map(plan);
    forms.chain(VARIANTS.iter().map(variant)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_scene_has_a_short_form() {
        let mut forms: Vec<&str> = FORMS.iter().map(|form| form.0).collect();
        let mut scenes: Vec<&str> = scenarios::catalog::SCENES.iter().map(|s| s.name).collect();
        forms.sort_unstable();
        scenes.sort_unstable();
        assert_eq!(forms, scenes);
    }
}
