//! The page of truth, docs/truth.md: every error that is measured against numbers from outside has its row there, written and
//! checked by the test that measures it.

use std::fs::{self, File};
use std::path::{Path, PathBuf};

/// Set to write the page instead of comparing with it.
const WRITE: &str = "LINKWEAR_WRITE_TRUTH";
/// Errors below this are roundings, which need not repeat on another machine.
const ROUNDING: f64 = 1e-12;

fn page() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/truth.md")
}

/// Asserts that an error is below its bound, and that the page says so: within a factor of 2, or both are roundings. Of
/// several errors under one name the test passes the largest.
#[track_caller]
pub fn reached(case: &str, figure: &str, error: f64, bound: f64) {
    assert!(error < bound, "{case}, {figure}: {error:e}, not below {bound:e}");
    let key = format!("| {case} | {figure} | ");
    if std::env::var_os(WRITE).is_some() {
        let file = std::panic::Location::caller().file();
        let thread = std::thread::current();
        let test = thread.name().unwrap_or_default();
        // Its modules are those of the file, which the row names.
        let test = test.rsplit("::").next().unwrap_or(test);
        return write(&key, &format!("{key}{} | {bound:e} | `{file}` | `{test}` |", rounded_up(error)));
    }
    let text = fs::read_to_string(page()).unwrap_or_default();
    let row = text.lines().find_map(|line| line.strip_prefix(&key));
    let cure = format!("run the command of docs/truth.md ({error:e} was measured)");
    let shown = row.unwrap_or_else(|| panic!("docs/truth.md has no row {key}: {cure}"));
    let shown: f64 = shown.split(" | ").next().and_then(|cell| cell.parse().ok()).expect("a number");
    let agree = (error <= 2.0 * shown && shown <= 2.2 * error) || (error < ROUNDING && shown < ROUNDING);
    assert!(agree, "docs/truth.md says {shown:e} of {case}, {figure}: {cure}");
}

/// Two digits, never less than the error but for the last bit.
fn rounded_up(error: f64) -> String {
    let digit = if error > 0.0 { 10_f64.powf(error.log10().floor() - 1.0) } else { 1.0 };
    format!("{:.1e}", (error / digit).ceil() * digit)
}

/// Puts a row in the place of the one of the same case and figure; rows are sorted. Tests run at the same time.
fn write(key: &str, row: &str) {
    let lock = File::create(page().with_extension("lock")).expect("a lock beside the page");
    lock.lock().expect("the lock");
    let text = fs::read_to_string(page()).expect("docs/truth.md");
    let (head, rows) = text.split_at(text.find("\n|---").map_or(text.len(), |at| at + 1));
    let (rule, rows) = rows.split_once('\n').unwrap_or((rows, ""));
    let mut rows: Vec<&str> = rows.lines().filter(|line| !line.starts_with(key)).chain([row]).collect();
    rows.sort_unstable();
    fs::write(page(), format!("{head}{rule}\n{}\n", rows.join("\n"))).expect("docs/truth.md");
    let _ = fs::remove_file(page().with_extension("lock"));
}
