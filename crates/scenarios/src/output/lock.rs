//! One run a folder.

use std::fs::{self, File, TryLockError};
use std::io;
use std::path::{Path, PathBuf};

/// Name of the file that is locked.
const NAME: &str = ".setae-lock";
/// Tries when the file is removed by another run that ends just now.
const TRIES: usize = 10;

/// Holds a folder for this process. The system lets go of it when the process ends, however it ends.
#[derive(Debug)]
pub(super) struct Lock {
    path: PathBuf,
    file: File,
}

impl Lock {
    /// The lock of a folder, `None` while another run holds it.
    pub(super) fn take(folder: &Path) -> io::Result<Option<Lock>> {
        let path = folder.join(NAME);
        for _ in 0..TRIES {
            let mut options = File::options();
            let file = options
                .create(true)
                .truncate(false)
                .write(true)
                .open(&path)?;
            match file.try_lock() {
                Ok(()) => {}
                Err(TryLockError::WouldBlock) => return Ok(None),
                // A file system without locks does without.
                Err(TryLockError::Error(error)) if error.kind() == io::ErrorKind::Unsupported => {}
                Err(TryLockError::Error(error)) => return Err(error),
            }
            let lock = Lock {
                path: path.clone(),
                file,
            };
            if lock.is_in_place() {
                return Ok(Some(lock));
            }
        }
        Ok(None)
    }

    /// Whether the file in the folder is the one that is locked, and not that of a run that came after its removal.
    #[cfg(unix)]
    fn is_in_place(&self) -> bool {
        use std::os::unix::fs::MetadataExt as _;
        let place = |data: fs::Metadata| (data.dev(), data.ino());
        let there = fs::metadata(&self.path).map(place);
        let ours = self.file.metadata().map(place);
        matches!((there, ours), (Ok(there), Ok(ours)) if there == ours)
    }

    /// Other systems do not remove a file that is open.
    #[cfg(not(unix))]
    fn is_in_place(&self) -> bool {
        self.file.metadata().is_ok()
    }
}

impl Drop for Lock {
    fn drop(&mut self) {
        // While it is still locked, so that nobody holds a file that is gone and believes in it.
        if self.is_in_place() {
            let _ = fs::remove_file(&self.path);
        }
    }
}
