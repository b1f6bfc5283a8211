//! Product files in which a text stands.

use std::fs;
use std::path::{Path, PathBuf};

fn rust_files(folder: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder).expect("a folder").map(|entry| entry.expect("an entry").path());
    let (folders, files): (Vec<_>, Vec<_>) = entries.partition(|path| path.is_dir());
    let inner = folders.iter().filter(|path| !path.ends_with("tests")).flat_map(|path| rust_files(path));
    files.into_iter().filter(|path| path.extension().is_some_and(|end| end == "rs")).chain(inner).collect()
}

/// Files of the generator, of its reader and of the command line with a line of code, outside comments and tests, that fits.
pub fn files_with(fits: impl Fn(&str) -> bool) -> Vec<String> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let folders = ["codegen/src", "reader/src", "src"].map(|folder| root.join(folder));
    let files = folders.iter().flat_map(|folder| rust_files(folder));
    let found = files.filter(|path| {
        let text = fs::read_to_string(path).expect("a source file");
        let code = text.split("#[cfg(test)]\nmod tests").next().unwrap_or_default();
        let mut lines = code.lines().map(|line| line.split("//").next().unwrap_or_default());
        !path.ends_with("derive/tests.rs") && lines.any(&fits)
    });
    let mut names: Vec<String> =
        found.map(|path| path.strip_prefix(&root).expect("below the root").display().to_string()).collect();
    names.sort();
    names
}
