//! `history.csv`.

use std::fs::File;
use std::io::{self, Write as _};
use std::path::PathBuf;

use super::{Folder, OutputError};

/// An open `history.csv`; each row is on disk when [`HistoryFile::push`] returns.
#[derive(Debug)]
pub(super) struct HistoryFile {
    path: PathBuf,
    writer: csv::Writer<File>,
}

impl HistoryFile {
    /// Makes the file and writes the header.
    ///
    /// # Errors
    /// [`OutputError::File`].
    pub(super) fn create(folder: &Folder, header: &[String]) -> Result<HistoryFile, OutputError> {
        let path = folder.file("history.csv");
        let file = File::create(&path).map_err(|source| OutputError::File {
            path: path.clone(),
            source,
        })?;
        let mut history = HistoryFile {
            path,
            writer: csv::Writer::from_writer(file),
        };
        history.record(header)?;
        Ok(history)
    }

    /// Appends a row. Numbers are written so that reading them gives the same bits.
    ///
    /// # Errors
    /// [`OutputError::File`].
    pub(super) fn push(&mut self, numbers: &[f64]) -> Result<(), OutputError> {
        let texts: Vec<String> = numbers.iter().map(|number| format!("{number:?}")).collect();
        self.record(&texts)
    }

    fn record(&mut self, fields: &[String]) -> Result<(), OutputError> {
        let written = self.writer.write_record(fields).map_err(io::Error::from);
        let flushed = written.and_then(|()| self.writer.flush());
        // A crash of the program loses nothing now; a crash of the machine is not guarded against.
        let done = flushed.and_then(|()| self.writer.get_ref().flush());
        done.map_err(|source| OutputError::File {
            path: self.path.clone(),
            source,
        })
    }
}
