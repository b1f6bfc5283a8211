//! Files and stdout: nothing half-written, and no panic when the reader of a pipe has gone.

use std::fmt::Display;
use std::fs::{self, File};
use std::io::{self, BufWriter, Write};
use std::path::Path;

use super::failure::Failure;

/// Writes to stdout and ends the line. A closed pipe (`| head`) is no failure.
pub fn print(text: &impl Display) -> Result<(), Failure> {
    let mut out = BufWriter::new(io::stdout().lock());
    match writeln!(out, "{text:#}").and_then(|()| out.flush()) {
        Err(error) if error.kind() != io::ErrorKind::BrokenPipe => {
            Err(Failure::Write("stdout".into(), error))
        }
        _ => Ok(()),
    }
}

/// Writes a file that is there whole or not at all: `fill` writes beside it, then it is renamed.
pub fn write_whole(
    path: &Path,
    fill: impl FnOnce(&mut BufWriter<File>) -> io::Result<()>,
) -> Result<(), Failure> {
    let beside = beside(path);
    let write = || {
        let mut out = BufWriter::new(File::create(&beside)?);
        fill(&mut out)?;
        out.into_inner()?.sync_all()?;
        fs::rename(&beside, path)
    };
    write().map_err(|error| {
        let _ = fs::remove_file(&beside);
        Failure::Write(path.to_path_buf(), error)
    })
}

/// A name in the same folder, so that the rename stays on one file system; of this process alone.
fn beside(path: &Path) -> std::path::PathBuf {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    path.with_file_name(format!(".{name}.{}.tmp", std::process::id()))
}

/// Refuses to write over the input.
pub fn refuse_same(input: &Path, output: &Path) -> Result<(), Failure> {
    match (input.canonicalize(), output.canonicalize()) {
        (Ok(a), Ok(b)) if a == b => Err(Failure::Exists(output.to_path_buf())),
        _ => Ok(()),
    }
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
        assert!(matches!(result, Err(Failure::Write(..))));
        assert_eq!(fs::read_to_string(&path).expect("old file"), "old");
        assert_eq!(fs::read_dir(&folder).expect("folder").count(), 1);
        write_whole(&path, |out| out.write_all(b"new")).expect("a file");
        assert_eq!(fs::read_to_string(&path).expect("new file"), "new");
        fs::remove_dir_all(&folder).expect("folder");
    }
}
