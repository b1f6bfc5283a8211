//! Files that a robot's file names. Never knows where they lie.

use std::io;

/// Where included files and meshes come from.
pub trait Files {
    /// Bytes of a file, by its path from the folder of the robot's file.
    ///
    /// # Errors
    /// Those of the system; a file that is too long or out of reach.
    fn bytes(&self, name: &str) -> io::Result<Vec<u8>>;
}

/// None at all.
#[derive(Clone, Copy, Debug, Default)]
pub struct NoFiles;

impl Files for NoFiles {
    fn bytes(&self, _: &str) -> io::Result<Vec<u8>> {
        Err(io::Error::other("no other files are read here"))
    }
}
