//! The scenes that come with the program, and the way from a name or a file to a scene.

use std::path::{Path, PathBuf};

use crate::spec::{LoadedScene, Override, SceneError, near_names, parse};

/// A built-in scene.
#[derive(Clone, Copy, Debug)]
#[non_exhaustive]
pub struct Entry {
    /// Name on the command line.
    pub name: &'static str,
    /// RON text with comments.
    pub text: &'static str,
}

/// All built-in scenes, in the order of the list. A new scene is one file in `scenes/` and one line here.
pub const SCENES: &[Entry] = &[
    Entry {
        name: "impact",
        text: include_str!("../scenes/impact.ron"),
    },
    Entry {
        name: "bar-impact",
        text: include_str!("../scenes/bar-impact.ron"),
    },
    Entry {
        name: "bar-on-bar",
        text: include_str!("../scenes/bar-on-bar.ron"),
    },
    Entry {
        name: "sliding-block",
        text: include_str!("../scenes/sliding-block.ron"),
    },
    Entry {
        name: "bouncing-block",
        text: include_str!("../scenes/bouncing-block.ron"),
    },
    Entry {
        name: "free-body",
        text: include_str!("../scenes/free-body.ron"),
    },
    Entry {
        name: "oblique-impact",
        text: include_str!("../scenes/oblique-impact.ron"),
    },
    Entry {
        name: "press-twist",
        text: include_str!("../scenes/press-twist.ron"),
    },
    Entry {
        name: "twist-dry",
        text: include_str!("../scenes/twist-dry.ron"),
    },
    Entry {
        name: "twist",
        text: include_str!("../scenes/twist.ron"),
    },
    Entry {
        name: "plate-cylinder",
        text: include_str!("../scenes/plate-cylinder.ron"),
    },
    Entry {
        name: "wheel",
        text: include_str!("../scenes/wheel.ron"),
    },
    Entry {
        name: "indentation",
        text: include_str!("../scenes/indentation.ron"),
    },
    Entry {
        name: "indentation-elastic",
        text: include_str!("../scenes/indentation-elastic.ron"),
    },
    Entry {
        name: "debonding",
        text: include_str!("../scenes/debonding.ron"),
    },
    Entry {
        name: "peel",
        text: include_str!("../scenes/peel.ron"),
    },
    Entry {
        name: "pull-off",
        text: include_str!("../scenes/pull-off.ron"),
    },
    Entry {
        name: "plate-pull",
        text: include_str!("../scenes/plate-pull.ron"),
    },
    Entry {
        name: "cone",
        text: include_str!("../scenes/cone.ron"),
    },
    Entry {
        name: "flat-punch",
        text: include_str!("../scenes/flat-punch.ron"),
    },
    Entry {
        name: "hertz-sphere",
        text: include_str!("../scenes/hertz-sphere.ron"),
    },
    Entry {
        name: "hertz-cylinder",
        text: include_str!("../scenes/hertz-cylinder.ron"),
    },
    Entry {
        name: "hertz-ball",
        text: include_str!("../scenes/hertz-ball.ron"),
    },
    Entry {
        name: "contact-patch",
        text: include_str!("../scenes/contact-patch.ron"),
    },
    Entry {
        name: "mindlin-cylinder",
        text: include_str!("../scenes/mindlin-cylinder.ron"),
    },
    Entry {
        name: "mindlin-sphere",
        text: include_str!("../scenes/mindlin-sphere.ron"),
    },
];

/// Text of a built-in scene or of a file, with the name that errors use.
///
/// # Errors
/// [`SceneError::Unknown`] for a word that is neither, [`SceneError::Read`] for a file that cannot be read.
pub fn text(name_or_file: &str) -> Result<(String, String), SceneError> {
    if let Some(entry) = SCENES.iter().find(|entry| entry.name == name_or_file) {
        return Ok((format!("{}.ron", entry.name), entry.text.to_owned()));
    }
    let path = Path::new(name_or_file);
    let meant_as_file =
        path.extension().is_some() || path.components().count() > 1 || path.is_file();
    if !meant_as_file {
        let names = SCENES.iter().map(|entry| entry.name);
        let near = near_names(name_or_file, names.clone());
        return Err(SceneError::Unknown {
            name: name_or_file.to_owned(),
            near: near
                .first()
                .map(|name| format!("; did you mean `{name}`?"))
                .unwrap_or_default(),
            known: names.collect::<Vec<_>>().join(", "),
        });
    }
    let read = std::fs::read_to_string(path);
    let text = read.map_err(|source| SceneError::Read {
        path: path.to_owned(),
        source,
    })?;
    Ok((name_or_file.to_owned(), text))
}

/// Reads and checks a built-in scene or a file.
///
/// # Errors
/// See [`SceneError`].
pub fn load(name_or_file: &str, sets: &[Override]) -> Result<LoadedScene, SceneError> {
    let (name, text) = text(name_or_file)?;
    parse(&name, &text, sets)
}

/// Folder for the results when none is given: `out/<scene>`.
#[must_use]
pub fn default_folder(name_or_file: &str) -> PathBuf {
    Path::new("out").join(stem(name_or_file))
}

/// Folder for the results of a sweep when none is given: `out/<scene>-sweep`.
#[must_use]
pub fn default_sweep_folder(name_or_file: &str) -> PathBuf {
    let mut name = stem(name_or_file).to_owned();
    name.push("-sweep");
    Path::new("out").join(name)
}

fn stem(name_or_file: &str) -> &std::ffi::OsStr {
    Path::new(name_or_file)
        .file_stem()
        .unwrap_or(name_or_file.as_ref())
}
