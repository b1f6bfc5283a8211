//! Files and stdout: nothing half-written, no result mixed with another, no panic when the reader of a pipe has gone.

use std::fmt::Display;
use std::fs::{self, File, Metadata, OpenOptions};
use std::io::{self, BufWriter, ErrorKind, Write};
use std::path::{Path, PathBuf};

use tempfile::NamedTempFile;
use thiserror::Error;

/// What stands for a file where stdout could not be written.
pub(crate) const STDOUT: &str = "stdout";

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
        Err(error) if error.kind() != ErrorKind::BrokenPipe => Err(WriteError::of(Path::new(STDOUT))(error)),
        _ => Ok(()),
    }
}

/// Hands stdout to what writes rows. A closed pipe is no failure.
///
/// # Errors
/// As [`print`].
pub fn write_stdout(
    fill: impl FnOnce(&mut BufWriter<io::Stdout>) -> io::Result<()>,
) -> Result<(), WriteError> {
    let mut out = BufWriter::new(io::stdout());
    match fill(&mut out).and_then(|()| out.flush()) {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => Err(WriteError::of(Path::new(STDOUT))(error)),
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
        Err(error) if error.kind() == ErrorKind::NotFound => {
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
    sync(path).map_err(WriteError::of(path))
}

fn sync(folder: &Path) -> io::Result<()> {
    if cfg!(not(unix)) {
        return Ok(());
    }
    match File::open(folder).and_then(|folder| folder.sync_all()) {
        // A file system that keeps no folders on a disk.
        Err(error) if matches!(error.kind(), ErrorKind::InvalidInput | ErrorKind::Unsupported) => Ok(()),
        done => done,
    }
}

/// Writes a file that is there whole or not at all: `fill` writes beside it, then it is renamed. A file that was there
/// hands its permissions on; of a symbolic link the file that it names is replaced. Stdout by a name, a terminal,
/// another character device or a pipe is written to as it is.
///
/// # Errors
/// Those of `fill` and of the system; [`check_target`]. The old file is left as it was.
pub fn write_whole(
    path: &Path,
    fill: impl FnOnce(&mut BufWriter<&File>) -> io::Result<()>,
) -> Result<(), WriteError> {
    let write = || match Target::of(path)? {
        Target::Stdout => write_through(&stdout()?, fill),
        Target::Stream => write_through(&OpenOptions::new().write(true).open(path)?, fill),
        Target::Regular(path, old) => {
            // Until the file has its name, a signal that ends the program waits.
            #[cfg(feature = "cli")]
            let _held = crate::progress::Held::new();
            let beside = beside(&path)?;
            let mut out = BufWriter::new(beside.as_file());
            fill(&mut out)?;
            out.flush()?;
            drop(out);
            if let Some(old) = old {
                hand_on(&old, beside.as_file())?;
            }
            beside.as_file().sync_all()?;
            beside.persist(&path)?;
            sync(folder_of(&path))
        }
    };
    write().map_err(WriteError::of(path))
}

/// A reader that has seen enough and gone is no failure.
fn write_through(
    stream: &File,
    fill: impl FnOnce(&mut BufWriter<&File>) -> io::Result<()>,
) -> io::Result<()> {
    let mut out = BufWriter::new(stream);
    match fill(&mut out).and_then(|()| out.flush()) {
        Err(error) if error.kind() == ErrorKind::BrokenPipe => Ok(()),
        done => done,
    }
}

/// Whether [`write_whole`] can write here, before the work that is to fill the file. True for a stream.
///
/// # Errors
/// If there is a folder, a block device, a socket, or a symbolic link to nothing; a file that may not be written; no
/// folder to write it in.
pub fn check_target(path: &Path) -> Result<bool, WriteError> {
    let check = || match Target::of(path)? {
        Target::Stdout | Target::Stream => Ok(true),
        Target::Regular(path, _) => beside(&path).map(|_| false),
    };
    check().map_err(WriteError::of(path))
}

/// What is at a path, links followed.
enum Target {
    /// What stdout writes to, as `/dev/stdout` is.
    Stdout,
    /// What bytes can only be handed to.
    Stream,
    /// A file, which may be there already.
    Regular(PathBuf, Option<Metadata>),
}

impl Target {
    fn of(path: &Path) -> io::Result<Self> {
        let found = match fs::metadata(path) {
            Err(error) if error.kind() == ErrorKind::NotFound => {
                return match fs::symlink_metadata(path) {
                    Ok(_) => Err(io::Error::other("it is a symbolic link to nothing")),
                    Err(_) => Ok(Self::Regular(path.to_path_buf(), None)),
                };
            }
            found => found?,
        };
        if found.is_dir() {
            return Err(io::Error::other("it is a folder"));
        }
        if is_stdout(&found) {
            return Ok(Self::Stdout);
        }
        if is_stream(&found) {
            return Ok(Self::Stream);
        }
        if !found.is_file() {
            return Err(io::Error::other("it is neither a file nor a stream"));
        }
        // Renaming would replace even a file that may not be written.
        OpenOptions::new().write(true).open(path)?;
        Ok(Self::Regular(path.canonicalize()?, Some(found)))
    }
}

/// The folder that a file lies in.
pub(crate) fn folder_of(path: &Path) -> &Path {
    path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."))
}

/// A file of an unpredictable name in the same folder, so that the rename stays on one file system; it goes with the
/// value. Errors do not name it: nobody asked for it.
fn beside(path: &Path) -> io::Result<NamedTempFile> {
    // With the permissions that the umask leaves, as any new file.
    let create = |path: &Path| OpenOptions::new().read(true).write(true).create_new(true).open(path);
    tempfile::Builder::new().prefix(".linkwear-").suffix(".tmp").make_in(folder_of(path), create)
}

/// Permissions, and owner as far as the system allows.
fn hand_on(old: &Metadata, new: &File) -> io::Result<()> {
    #[cfg(unix)]
    {
        use std::os::unix::fs::{MetadataExt, fchown};
        let made = new.metadata()?;
        if (made.uid(), made.gid()) != (old.uid(), old.gid()) {
            // Only root may give files away.
            let _ = fchown(new, Some(old.uid()), Some(old.gid()));
        }
    }
    new.set_permissions(old.permissions())
}

/// Whether it is what stdout writes to, as `/dev/stdout` is.
#[cfg(unix)]
fn is_stdout(found: &Metadata) -> bool {
    use std::os::unix::fs::MetadataExt;
    let own = stdout().and_then(|own| own.metadata());
    own.is_ok_and(|own| (own.dev(), own.ino()) == (found.dev(), found.ino()))
}

#[cfg(unix)]
fn stdout() -> io::Result<File> {
    use std::os::fd::AsFd;
    Ok(io::stdout().as_fd().try_clone_to_owned()?.into())
}

/// Whether bytes can only be handed to it: a character device, a pipe.
#[cfg(unix)]
fn is_stream(found: &Metadata) -> bool {
    use std::os::unix::fs::FileTypeExt;
    let kind = found.file_type();
    kind.is_char_device() || kind.is_fifo()
}

#[cfg(not(unix))]
fn is_stdout(_: &Metadata) -> bool {
    false
}

#[cfg(not(unix))]
fn stdout() -> io::Result<File> {
    Err(ErrorKind::Unsupported.into())
}

#[cfg(not(unix))]
fn is_stream(_: &Metadata) -> bool {
    false
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_failed_write_leaves_the_old_file_and_nothing_else() {
        let folder = tempfile::tempdir().expect("temporary folder");
        let path = folder.path().join("rows.csv");
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
    }

    /// A folder in which not even root makes a file. It is told before the work, and by the name that was given.
    #[cfg(target_os = "linux")]
    #[test]
    fn a_folder_that_takes_no_file_is_told_before_the_work_and_by_the_name_that_was_given() {
        let path = Path::new("/proc/self/rows.csv");
        for error in [check_target(path).err(), write_whole(path, |_| Ok(())).err()] {
            let told = error.expect("no file there").to_string();
            assert!(told.contains("`/proc/self/rows.csv`") && !told.contains(".tmp"), "{told}");
        }
    }
}
