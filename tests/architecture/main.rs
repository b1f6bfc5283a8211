//! Modules know only what the tables of ARCHITECTURE.md allow, files form no circle, `#[must_use]` stands on types.
//! Reads the paths in the source (tests inside modules excepted) and compares.

mod graph;
mod laws;
mod source;

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::Path;

use graph::{Graph, expanded};
use source::{code, heads, must_use_functions, rust_files};

type Arrows = BTreeMap<String, BTreeSet<String>>;

/// The table under a heading: module -> modules it may import.
fn table(heading: &str) -> Arrows {
    let text = fs::read_to_string("ARCHITECTURE.md").expect("ARCHITECTURE.md");
    let section = text.split(&format!("\n## {heading}\n")).nth(1).expect("the heading");
    let section = section.split("\n## ").next().expect("a section");
    let rows = section.lines().filter(|line| line.starts_with("| `"));
    rows.map(|row| {
        let cells: Vec<&str> = row.split('|').collect();
        (backticked(cells[1]).remove(0), backticked(cells[2]).into_iter().collect())
    })
    .collect()
}

fn backticked(cell: &str) -> Vec<String> {
    cell.split('`').skip(1).step_by(2).map(str::to_owned).collect()
}

/// Names that `lib.rs` re-exports, each with the module it comes from. A module of another crate is one of its own.
fn reexports(lib: &str) -> BTreeMap<String, String> {
    let statements = lib.split("pub use ").skip(1).filter_map(|rest| rest.split(';').next());
    let names = statements.flat_map(|statement| expanded(statement.trim()));
    let module = |path: Vec<String>| path.into_iter().find(|segment| segment != "crate").unwrap_or_default();
    let names = names.map(|(path, name)| (name, module(path)));
    names.filter(|(_, module)| !module.starts_with("linkwear_")).collect()
}

/// The module a file belongs to: first folder or file name below the source folder.
fn module_of(file: &Path, root: &Path) -> String {
    let inside = file.strip_prefix(root).expect("inside").components().next().expect("a name");
    inside.as_os_str().to_string_lossy().trim_end_matches(".rs").to_owned()
}

/// Arrows that the table does not have, and modules without a row.
fn violations(root: &str, allowed: &Arrows) -> Vec<String> {
    let root = Path::new(root);
    let names = reexports(&code(&root.join("lib.rs")));
    let mut wrong = Vec::new();
    for file in rust_files(root) {
        let module = module_of(&file, root);
        if module == "lib" || file.ends_with("tests.rs") {
            continue;
        }
        let Some(may) = allowed.get(&module) else {
            wrong.push(format!("{}: module `{module}` has no row", file.display()));
            continue;
        };
        for head in heads(&code(&file), "crate") {
            let target = names.get(&head).unwrap_or(&head);
            if *target != module && !may.contains(target) {
                wrong
                    .push(format!("{}: `{module}` must not know `{target}` (crate::{head})", file.display()));
            }
        }
    }
    wrong
}

fn assert_clean(root: &str, heading: &str) {
    let wrong = violations(root, &table(heading));
    assert!(wrong.is_empty(), "not in ARCHITECTURE.md, \"{heading}\":\n{}", wrong.join("\n"));
}

#[test]
fn the_generator_has_only_the_allowed_arrows() {
    assert_clean("codegen/src", "Allowed arrows: codegen");
    for file in rust_files(Path::new("codegen/src")) {
        let by_module = file.ends_with("lib.rs") || !code(&file).contains("linkwear_reader");
        assert!(by_module, "{}: name modules of the reader as `crate::`", file.display());
    }
}

#[test]
fn the_reader_of_files_has_only_the_allowed_arrows() {
    assert_clean("reader/src", "Allowed arrows: reader");
}

#[test]
fn the_runtime_has_only_the_allowed_arrows() {
    assert_clean("runtime/src", "Allowed arrows: runtime");
}

#[test]
fn the_gamma_process_has_only_the_allowed_arrows() {
    assert_clean("gamma/src", "Allowed arrows: gamma");
}

#[test]
fn tapes_have_only_the_allowed_arrows() {
    assert_clean("tape/src", "Allowed arrows: tape");
}

#[test]
fn units_have_only_the_allowed_arrows() {
    assert_clean("fmu/src", "Allowed arrows: fmu");
}

#[test]
fn machine_code_has_only_the_allowed_arrows() {
    assert_clean("native/src", "Allowed arrows: native");
}

/// The workspace's lints forbid it; only the crates that call machine code and are called from C have lints of their own.
#[test]
fn only_foreign_edges_are_without_the_compilers_guard() {
    let manifests = [
        "",
        "benchmarks/",
        "case-study/",
        "codegen/",
        "gamma/",
        "import/",
        "oracle/",
        "reader/",
        "runtime/",
        "shipped/",
        "tape/",
    ];
    for folder in manifests {
        let manifest = fs::read_to_string(format!("{folder}Cargo.toml")).expect("a manifest");
        assert!(manifest.contains("[lints]\nworkspace = true"), "{folder}Cargo.toml");
    }
    let lifted: Vec<_> =
        ["native/src", "fmu/src"].into_iter().flat_map(|root| rust_files(Path::new(root))).collect();
    let lifted = lifted.iter().filter(|file| !file.components().any(|part| part.as_os_str() == "tests"));
    let lifted = lifted.filter(|file| code(file).contains("expect(unsafe_code"));
    let lifted: BTreeSet<String> = lifted.map(|file| file.display().to_string()).collect();
    assert_eq!(
        lifted,
        [
            "fmu/src/edge/caller.rs",
            "fmu/src/edge/life.rs",
            "fmu/src/edge/motion.rs",
            "fmu/src/edge/registry.rs",
            "fmu/src/edge/states.rs",
            "fmu/src/edge/unsupported.rs",
            "fmu/src/edge/values.rs",
            "native/src/memory/called.rs",
            "native/src/memory/code.rs",
        ]
        .map(str::to_owned)
        .into()
    );
}

#[test]
fn allowed_arrows_form_no_circle() {
    let headings = ["codegen", "reader", "runtime", "gamma", "native", "tape", "fmu"]
        .map(|name| format!("Allowed arrows: {name}"));
    for heading in &headings {
        let mut left = table(heading);
        while !left.is_empty() {
            let free: Vec<String> = left
                .iter()
                .filter(|(_, may)| !may.iter().any(|target| left.contains_key(target)))
                .map(|(module, _)| module.clone())
                .collect();
            assert!(!free.is_empty(), "{heading}: a circle among {:?}", left.keys());
            for module in free {
                left.remove(&module);
            }
        }
    }
}

/// Sources of all crates.
const CRATES: [&str; 12] = [
    "import/src",
    "codegen/src",
    "reader/src",
    "runtime/src",
    "gamma/src",
    "native/src",
    "oracle/src",
    "src",
    "case-study/src",
    "shipped/src",
    "tape/src",
    "fmu/src",
];

#[test]
fn files_form_no_circle() {
    let wrong: Vec<String> =
        CRATES.iter().flat_map(|root| Graph::read(Path::new(root)).arrows_on_circles()).collect();
    assert!(wrong.is_empty(), "arrows on circles of files:\n{}", wrong.join("\n"));
}

#[test]
fn what_runs_does_not_know_that_a_generator_exists() {
    for root in ["runtime/src", "gamma/src", "shipped/src", "tape/src", "fmu/src"] {
        for file in rust_files(Path::new(root)) {
            assert!(!code(&file).contains("linkwear_codegen"), "{}", file.display());
        }
    }
}

#[test]
fn the_command_line_knows_results_and_no_stages_between() {
    let allowed = &table("Allowed arrows: command line")["cli"];
    let names = reexports(&code(Path::new("codegen/src/lib.rs")));
    for file in rust_files(Path::new("src")) {
        for head in heads(&code(&file), "linkwear_codegen") {
            let target = names.get(&head).unwrap_or(&head);
            assert!(allowed.contains(target), "{} uses linkwear_codegen::{head}", file.display());
        }
    }
}

#[test]
fn the_command_line_asks_and_prints_and_does_not_compute() {
    for file in rust_files(Path::new("src/cli")) {
        for computed in ["MonteCarlo", "FirstPassage", "Posterior", "Particles", "run_life", "DynamicsSource"]
        {
            assert!(!code(&file).contains(computed), "{} uses {computed}", file.display());
        }
    }
}

/// Generated code has its own dialect: its users lint it by theirs.
#[test]
fn must_use_stands_on_types() {
    for root in CRATES {
        for file in rust_files(Path::new(root)) {
            if !file.starts_with("codegen/src/backend") {
                let code = code(&file);
                let wrong = must_use_functions(&code);
                assert!(wrong.is_empty(), "{}: `#[must_use]` on `{}`", file.display(), wrong.join("`, `"));
            }
        }
    }
}

/// Exceptions are an `expect` with its reason, at the smallest scope. `clippy.toml` frees tests inside modules; other
/// tests, examples and build scripts are crates of their own. The oracle is a test.
#[test]
fn libraries_and_programs_deny_what_panics() {
    let lints = ["unwrap_used", "expect_used", "panic", "todo", "unimplemented", "unreachable"];
    for folder in
        ["codegen", "fmu", "gamma", "import", "native", "reader", "runtime", "tape", ".", "case-study"]
            .map(|folder| Path::new(folder).join("src"))
    {
        for root in
            ["lib.rs", "main.rs"].map(|root| folder.join(root)).into_iter().filter(|root| root.exists())
        {
            let code = code(&root);
            let denied = code.split("#![deny(").nth(1).and_then(|rest| rest.split(")]").next());
            let denied: BTreeSet<&str> = denied.unwrap_or_default().split(',').map(str::trim).collect();
            for lint in lints {
                assert!(denied.contains(&*format!("clippy::{lint}")), "{}: {lint}", root.display());
            }
        }
        for file in rust_files(&folder) {
            for lint in lints {
                assert!(
                    !code(&file).contains(&format!("allow(clippy::{lint}")),
                    "{}: {lint}",
                    file.display()
                );
            }
        }
    }
}

#[test]
fn a_format_of_tables_is_its_file_and_its_entry_in_the_list() {
    let files = ["src", "runtime/src"].into_iter().flat_map(|root| rust_files(Path::new(root)));
    let named = files.filter(|file| file.ends_with("npy.rs") || code(file).contains("npy"));
    let named: Vec<String> = named.map(|file| file.display().to_string()).collect();
    assert_eq!(named, ["src/table/npy.rs", "src/table.rs"]);
}

#[test]
fn the_reader_of_paths_sees_groups_and_skips_longer_names() {
    let code = "use crate::{a::{x, y}, b};\nlet v = crate::c::d();\nmy_crate::e(); $crate::f!();";
    assert_eq!(heads(code, "crate").into_iter().collect::<Vec<_>>(), ["a", "b", "c"]);
    let names =
        reexports("pub use linkwear_reader::spec;\npub use model::Closure;\npub use stub::{A, b::C as D};");
    let expected = [("A", "stub"), ("Closure", "model"), ("D", "stub")];
    assert_eq!(names.iter().map(|(a, b)| (a.as_str(), b.as_str())).collect::<Vec<_>>(), expected);
}
