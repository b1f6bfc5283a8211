//! The book is whole: what is generated is new, every mechanism of it passes `check`, every link leads somewhere.
//!
//! `LINKWEAR_WRITE_BOOK=1 cargo test --test book --test printed` writes the generated pages and the pictures.

#[path = "../command/mod.rs"]
mod command;
mod gallery;
#[path = "../support/labels.rs"]
mod labels;
mod links;
mod mechanisms;
#[path = "../outputs/schema.rs"]
mod schema;

use std::fs;

/// Compares a generated page with the one that is kept, or writes it if it is asked to.
fn compare_page(path: &str, new: &str) {
    if std::env::var_os("LINKWEAR_WRITE_BOOK").is_some() {
        fs::write(path, new).expect("the page is written");
    }
    let shown = fs::read_to_string(path).unwrap_or_default();
    assert!(shown == new, "{path} is stale: LINKWEAR_WRITE_BOOK=1 cargo test --test book");
}

/// Names of the files with this extension in a folder, without it, sorted.
fn stems(folder: &str, extension: &str) -> Vec<String> {
    let files = fs::read_dir(folder).expect("a folder").map(|entry| entry.expect("an entry").file_name());
    let names = files.map(|name| name.to_str().expect("UTF-8").to_owned());
    let mut stems: Vec<String> =
        names.filter_map(|name| Some(name.strip_suffix(extension)?.strip_suffix('.')?.to_owned())).collect();
    stems.sort();
    stems
}
