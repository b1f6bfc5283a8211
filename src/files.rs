//! Files and stdout: nothing half-written, no result mixed with another, no panic when the reader of a pipe has gone.

use std::fmt::Display;
use std::fs::{self, File};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

use thiserror::Error;

/// A file or folder could not be written.
#[derive(Debug, Error)]
pub enum WriteError {
    /// It exists, or has something in it, and is left as it is.
    #[error("`{}` exists and would be overwritten", .0.display())]
    Exists(PathBuf),
    /// The system refuses.
    #[error("cannot write `{}`: {error}", .file.display())]
    System {
        /// The file or folder; `stdout`.
        file: PathBuf,
        /// Why.
        error: io::Error,
    },
}

impl WriteError {
    /// What the system says of a file.
    pub fn of(file: &Path) -> impl FnOnce(io::Error) -> Self + '_ {
        |error| Self::System { file: file.to_path_buf(), error }
    }
}

/// Writes to stdout and ends the line. A closed pipe (`| head`) is no failure.
///
/// # Errors
/// If stdout cannot be written for another reason.
pub fn print(text: &impl Display) -> Result<(), WriteError> {
    let mut out = BufWriter::new(io::stdout().lock());
    match writeln!(out, "{text:#}").and_then(|()| out.flush()) {
        Err(error) if error.kind() != io::ErrorKind::BrokenPipe => {
            Err(WriteError::of(Path::new("stdout"))(error))
        }
        _ => Ok(()),
    }
}

/// Creates a folder, or takes one that is empty.
///
/// # Errors
/// If there is something in it, so that no result is mixed with another; if it cannot be made or read.
pub fn claim_folder(path: &Path) -> Result<(), WriteError> {
    match fs::read_dir(path) {
        Ok(mut entries) => entries.next().map_or(Ok(()), |_| Err(WriteError::Exists(path.to_path_buf()))),
        Err(error) if error.kind() == io::ErrorKind::NotFound => {
            fs::create_dir_all(path).map_err(WriteError::of(path))
        }
        Err(error) => Err(WriteError::of(path)(error)),
    }
}

/// Puts the names in a folder on the disk, where the system can.
///
/// # Errors
/// If the disk fails.
pub fn sync_folder(path: &Path) -> Result<(), WriteError> {
    if cfg!(unix) {
        File::open(path).and_then(|folder| folder.sync_all()).map_err(WriteError::of(path))?;
    }
    Ok(())
}

/// Writes a file that is there whole or not at all: `fill` writes beside it, then it is renamed.
///
/// # Errors
/// Those of `fill` and of the system. The old file is left as it was.
pub fn write_whole(
    path: &Path,
    fill: impl FnOnce(&mut BufWriter<File>) -> io::Result<()>,
) -> Result<(), WriteError> {
    let beside = beside(path);
    let write = || {
        let mut out = BufWriter::new(File::create(&beside)?);
        fill(&mut out)?;
        out.into_inner()?.sync_all()?;
        fs::rename(&beside, path)
    };
    write().map_err(|error| {
        let _ = fs::remove_file(&beside);
        WriteError::of(path)(error)
    })
}

/// A name in the same folder, so that the rename stays on one file system; of this process alone.
fn beside(path: &Path) -> PathBuf {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    path.with_file_name(format!(".{name}.{}.tmp", std::process::id()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_failed_write_leaves_the_old_file_and_nothing_else() {
        let folder = std::env::temp_dir().join(format!("linkwear-file-{}", std::process::id()));
        fs::create_dir_all(&folder).expect("temporary folder");
        let path = folder.join("rows.csv");
        fs::write(&path, "old").expect("old file");
        let result = write_whole(&path, |out| {
            out.write_all(b"half")?;
            Err(io::Error::other("disk full"))
        });
        assert!(result.is_err());
        assert_eq!(fs::read_to_string(&path).expect("old file"), "old");
        assert_eq!(fs::read_dir(&folder).expect("folder").count(), 1);
        write_whole(&path, |out| out.write_all(b"new")).expect("a file");
        assert_eq!(fs::read_to_string(&path).expect("new file"), "new");
        fs::remove_dir_all(&folder).expect("folder");
    }
}
