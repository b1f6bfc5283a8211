//! Operations of every entry point of the shipped mechanisms and the benchmarks, and of some that only tests have, which may only
//! fall.
//! `operations.txt` has the least so far; `LINKWEAR_WRITE_OPERATIONS=1` writes what has fallen.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use linkwear_codegen::compile::{Options, compile};
use linkwear_codegen::source::SourceFile;

/// Set to write the file where counts have fallen.
const WRITE: &str = "LINKWEAR_WRITE_OPERATIONS";

fn folder(place: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(place)
}

/// By mechanism and entry point.
type Counts = BTreeMap<(String, String), u64>;

/// Not shipped: many loops that meet at one body, modes from a file of data, two bodies that bend.
const FURTHER: [&str; 4] = [
    "tests/data/delta",
    "tests/data/flexible_slider_crank",
    "tests/data/stewart",
    "benches/peers/two_flexible",
];

fn measured() -> Counts {
    let entries = std::fs::read_dir(folder("../mechanisms")).expect("a folder of mechanisms");
    let further = FURTHER.map(|name| folder(&format!("../{name}.toml")));
    let files = entries.map(|entry| entry.expect("an entry").path()).chain(further);
    let mut counts = Counts::new();
    for path in files.filter(|path| path.extension().is_some_and(|extension| extension == "toml")) {
        let name = path.file_stem().expect("a name").to_string_lossy().into_owned();
        let text = std::fs::read_to_string(&path).expect("a mechanism file");
        // Files of data are looked for beside it.
        let source = SourceFile { name: path.display().to_string(), text };
        let compiled = compile(&source, &Options::default()).unwrap_or_else(|errors| panic!("{errors}"));
        for function in compiled.operations() {
            counts.insert((name.clone(), function.name), function.operations.total);
        }
    }
    counts
}

fn recorded(text: &str) -> Counts {
    let words = text.lines().map(|line| line.split_whitespace().collect::<Vec<_>>());
    let entry = |words: Vec<&str>| {
        let [mechanism, function, count] = words[..] else { panic!("three words a line: {words:?}") };
        ((mechanism.to_owned(), function.to_owned()), count.parse().expect("a count"))
    };
    words.map(entry).collect()
}

#[test]
fn operations_of_every_entry_point_only_fall() {
    let file = folder("tests/operations.txt");
    let before = recorded(&std::fs::read_to_string(&file).unwrap_or_default());
    let now = measured();
    let risen: Vec<_> =
        now.iter().filter(|(key, count)| before.get(*key).is_some_and(|least| least < *count)).collect();
    assert!(risen.is_empty(), "risen against operations.txt: {risen:?}");
    if std::env::var_os(WRITE).is_some() {
        let text = now.iter().fold(String::new(), |mut text, ((mechanism, function), count)| {
            let _ = writeln!(text, "{mechanism:<24} {function:<20} {count:>6}");
            text
        });
        std::fs::write(&file, text).expect("the file of counts");
        return;
    }
    assert_eq!(now, before, "fallen or new: run this test with {WRITE}=1");
}
