//! The folder of a run.

use std::fs;
use std::io::{self, Write as _};
use std::path::{Path, PathBuf};
use std::sync::Arc;

use thiserror::Error;

use super::lock::Lock;

/// Why results cannot be written.
#[derive(Debug, Error)]
pub enum OutputError {
    /// The folder cannot be made or written to.
    #[error("cannot write into the output folder {}: {source}; choose another one with --out", path.display())]
    Folder {
        /// The folder.
        path: PathBuf,
        /// Why.
        source: io::Error,
    },
    /// Another run is writing into the folder.
    #[error("another run is writing into the output folder {}; wait for its end, or choose another one with --out", path.display())]
    Busy {
        /// The folder.
        path: PathBuf,
    },
    /// A file cannot be written.
    #[error("cannot write {}: {source}", path.display())]
    File {
        /// The file.
        path: PathBuf,
        /// Why.
        source: io::Error,
    },
    /// A file of results cannot be read back.
    #[error("cannot read {}: {source}", path.display())]
    Unread {
        /// The file.
        path: PathBuf,
        /// Why.
        source: io::Error,
    },
    /// The fields given by the solver do not fit together.
    #[error("fields at t = {time} s are not written: {defect}")]
    Frame {
        /// Time of the fields \[s\].
        time: f64,
        /// What does not fit.
        defect: String,
    },
    /// A plot cannot be drawn.
    #[error("cannot draw {name}: {reason}")]
    Plot {
        /// File name of the plot.
        name: String,
        /// Why.
        reason: String,
    },
}

/// An existing folder that can be written to, by nobody else as long as this lives.
#[derive(Clone, Debug)]
pub struct Folder {
    path: PathBuf,
    /// Kept, not used.
    _lock: Arc<Lock>,
}

/// How the names of the pictures begin.
const PICTURES: [&str; 6] = [
    "energy", "deformed", "force_", "moment_", "probe_", "history_",
];

impl Folder {
    /// Makes the folder with its parents and writes a file on trial, before anything is computed. Results of an
    /// earlier run are removed, so that a run that is broken off cannot be taken for the earlier one.
    ///
    /// # Errors
    /// [`OutputError::Folder`] when it cannot be made or written to, [`OutputError::Busy`] when another run does.
    pub fn create(path: &Path) -> Result<Folder, OutputError> {
        let refuse = |source| OutputError::Folder {
            path: path.to_owned(),
            source,
        };
        fs::create_dir_all(path).map_err(refuse)?;
        let lock = Lock::take(path).map_err(refuse)?;
        let Some(lock) = lock else {
            return Err(OutputError::Busy {
                path: path.to_owned(),
            });
        };
        let folder = Folder {
            path: path.to_owned(),
            _lock: Arc::new(lock),
        };
        folder.prepare().map_err(refuse)?;
        Ok(folder)
    }

    fn prepare(&self) -> io::Result<()> {
        let trial = self.file(".setae-trial");
        fs::write(&trial, b"trial")?;
        fs::remove_file(&trial)?;
        if self.file("summary.json").is_dir() || self.file("history.csv").is_dir() {
            return Err(io::Error::other(
                "summary.json or history.csv there is a folder",
            ));
        }
        // Only beside an earlier history are pictures ours, and only those with our names.
        let drawn = self.file("history.csv").is_file();
        let svg = |name: &str| {
            drawn && name.ends_with(".svg") && PICTURES.iter().any(|p| name.starts_with(p))
        };
        let problem =
            |name: &str| drawn && name.starts_with("contact_step_") && name.ends_with(".hdf5");
        self.remove(&self.path, |name| {
            matches!(
                name,
                "summary.json" | "history.csv" | "fields.pvd" | "sweep.csv"
            ) || svg(name)
                || problem(name)
        })?;
        let fields = self.file("fields");
        if fields.exists() && !fields.is_dir() {
            return Err(io::Error::other("fields there is no folder"));
        }
        if fields.is_dir() {
            self.remove(&fields, |name| {
                name.starts_with("step_") && name.ends_with(".vtu")
            })?;
        }
        Ok(())
    }

    fn remove(&self, folder: &Path, ours: impl Fn(&str) -> bool) -> io::Result<()> {
        for entry in fs::read_dir(folder)? {
            let entry = entry?;
            if entry.file_name().to_str().is_some_and(&ours) && entry.file_type()?.is_file() {
                fs::remove_file(entry.path())?;
            }
        }
        Ok(())
    }

    /// The folder itself.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Path of a file in it.
    #[must_use]
    pub fn file(&self, name: &str) -> PathBuf {
        self.path.join(name)
    }

    /// Writes a whole file: under another name first, then moved, so that a reader sees all of it or nothing.
    ///
    /// # Errors
    /// [`OutputError::File`].
    pub fn write(&self, name: &str, bytes: &[u8]) -> Result<(), OutputError> {
        let path = self.file(name);
        let mut temporary = path.clone().into_os_string();
        temporary.push(".part");
        let write = || -> io::Result<()> {
            if let Some(parent) = path.parent() {
                fs::create_dir_all(parent)?;
            }
            let mut file = fs::File::create(&temporary)?;
            file.write_all(bytes)?;
            file.flush()?;
            drop(file);
            fs::rename(&temporary, &path)
        };
        write().map_err(|source| {
            // The part is of no use to anyone; if even this fails there is nothing more to do.
            let _ = fs::remove_file(&temporary);
            OutputError::File {
                path: path.clone(),
                source,
            }
        })
    }
}
