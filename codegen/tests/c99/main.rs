//! C99 of every shipped mechanism: it compiles without a warning and gives the interpreter's bits; its step is that of a run.

mod compiler;
mod rates;
mod run;
mod start;

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};

use compiler::{Numbers, build};
use linkwear_codegen::{Compiled, Options, SourceFile, compile};
use linkwear_runtime::{Entry, System};

fn mechanisms() -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../mechanisms");
    let files = fs::read_dir(folder).unwrap().map(|file| file.unwrap().path());
    let mut files: Vec<_> =
        files.filter(|file| file.extension().is_some_and(|name| name == "toml")).collect();
    files.sort();
    files
}

fn compiled(file: &Path) -> Compiled {
    let source = SourceFile { name: file.display().to_string(), text: fs::read_to_string(file).unwrap() };
    compile(&source, &Options::default()).unwrap()
}

fn shipped(name: &str) -> Compiled {
    compiled(&Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("../mechanisms/{name}.toml")))
}

fn example(name: &str) -> Compiled {
    compiled(&Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("../examples/data/{name}.toml")))
}

/// The driver that answers entry points, for one mechanism.
fn driver(compiled: &Compiled, states: usize) -> String {
    let sizes = compiled.sizes();
    let prefix = compiled.c_prefix();
    let upper = prefix.to_ascii_uppercase();
    let calls: Vec<String> = Entry::ALL
        .iter()
        .map(|entry| {
            let (name, upper_name) = (entry.name(), entry.name().to_ascii_uppercase());
            format!("if (!answer({prefix}_{name}, {upper}_{upper_name}_IN, {upper}_{upper_name}_OUT, {states})) return 1;")
        })
        .collect();
    let most = |length: &dyn Fn(Entry) -> usize| Entry::ALL.iter().map(|entry| length(*entry)).max().unwrap();
    include_str!("entries.c")
        .replace("CALLS", &calls.join("\n    "))
        .replace("INPUTS", &(most(&|entry| sizes.input(entry)) + 1).to_string())
        .replace("OUTPUTS", &(most(&|entry| sizes.output(entry)) + 1).to_string())
        .replace("WORKSPACE", &format!("{upper}_WORKSPACE + 1"))
}

#[test]
fn every_entry_point_of_every_shipped_mechanism_gives_the_interpreter_s_bits() {
    let (files, next) = (mechanisms(), AtomicUsize::new(0));
    let work = || {
        while let Some(file) = files.get(next.fetch_add(1, Ordering::Relaxed)) {
            gives_the_interpreter_s_bits(file);
        }
    };
    // A compiler at a time for each of two cores.
    std::thread::scope(|scope| {
        [scope.spawn(work), scope.spawn(work)].map(|thread| thread.join().expect("the same bits"))
    });
}

fn gives_the_interpreter_s_bits(file: &Path) {
    const STATES: usize = 40;
    let compiled = compiled(file);
    let name = &compiled.mechanism.name;
    let (sizes, system) = (compiled.sizes(), compiled.interpreter());
    let mut numbers = Numbers::default();
    let (mut input, mut expected) = (Vec::new(), Vec::new());
    let mut workspace = vec![0.0; System::<f64>::sizes(&system).workspace];
    for entry in Entry::ALL {
        for _ in 0..STATES {
            let x: Vec<f64> = (0..sizes.input(entry)).map(|_| numbers.next()).collect();
            let mut y = vec![0.0; sizes.output(entry)];
            system.evaluate(entry, &x, &mut y, &mut workspace);
            input.extend(x);
            expected.extend(y);
        }
    }
    // Compilers take their time for forty loops in a row; their bits are the same without it.
    let level = if name == "n_four_bar_40" { "-O0" } else { "-O2" };
    for built in build(&format!("entries_{name}"), &compiled, &driver(&compiled, STATES), &[level]) {
        let found = built.run(&input);
        assert_eq!(found.len(), expected.len(), "{name}: {}", built.compiler);
        let same = |(a, b): (&f64, &f64)| a.to_bits() == b.to_bits() || (a.is_nan() && b.is_nan());
        let differs = found.iter().zip(&expected).position(|pair| !same(pair));
        assert_eq!(differs, None, "{name}: {}", built.compiler);
    }
}

#[test]
fn cpp_includes_the_header_and_links_with_the_source() {
    let compiled = shipped("rssr");
    let Some(found) = compiler::cpp("cpp", &compiled, include_str!("include.cpp")) else { return };
    assert_eq!(String::from_utf8(found).unwrap(), "rssr R1 speed 1/s\n");
}

#[test]
fn sanitizers_find_nothing_in_entries_and_steps() {
    let compiled = shipped("rssr");
    let flags = ["-O1", "-g", "-fsanitize=address,undefined", "-fno-sanitize-recover=all"];
    let input: Vec<f64> = {
        let mut numbers = Numbers::default();
        let length: usize = Entry::ALL.iter().map(|entry| compiled.sizes().input(*entry)).sum();
        (0..length).map(|_| numbers.next()).collect()
    };
    for built in build("sanitized_entries", &compiled, &driver(&compiled, 1), &flags) {
        built.run(&input);
    }
    for built in build("sanitized_steps", &compiled, &run::driver(&compiled), &flags) {
        run::steps(&built, &compiled, 1e-4, 200);
    }
}

#[test]
fn files_hold_no_library_call_but_the_root() {
    for name in ["bricard", "rssr", "rssr_ball_wear", "slider_crank_clearance"] {
        let compiled = shipped(name);
        let name = format!("symbols_{name}");
        let Some(symbols) = compiler::undefined(&name, &compiled) else { return };
        let own: Vec<&String> = symbols.iter().filter(|symbol| *symbol != "sqrt").collect();
        assert!(own.is_empty(), "{name}: {own:?}");
    }
}
