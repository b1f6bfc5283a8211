//! The C compilers there are, and programs that they make of a mechanism's files. One that is missing is said to be.

use std::collections::HashMap;
use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::sync::{Arc, Mutex, OnceLock};

use linkwear_codegen::Compiled;

/// Warnings that are errors, whatever the optimisation.
const STRICT: [&str; 6] = ["-std=c99", "-Wall", "-Wextra", "-Werror", "-pedantic", "-ffp-contract=off"];

/// Numbers in (-1, 1), the same in every run.
pub struct Numbers(u64);

impl Default for Numbers {
    fn default() -> Self {
        Self(1)
    }
}

impl Numbers {
    pub fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / 4_503_599_627_370_496.0 - 1.0
    }
}

/// A program.
pub struct Built {
    pub compiler: &'static str,
    program: PathBuf,
}

impl Built {
    /// What it writes, of what it reads, both as doubles of this machine.
    pub fn run(&self, input: &[f64]) -> Vec<f64> {
        let bytes: Vec<u8> = input.iter().flat_map(|number| number.to_ne_bytes()).collect();
        let output = output_of(&self.program, &bytes);
        output.as_chunks::<8>().0.iter().map(|bytes| f64::from_ne_bytes(*bytes)).collect()
    }
}

fn output_of(program: &Path, input: &[u8]) -> Vec<u8> {
    let mut child = Command::new(program).stdin(Stdio::piped()).stdout(Stdio::piped()).spawn().unwrap();
    let mut stdin = child.stdin.take().unwrap();
    let input = input.to_vec();
    let writer = std::thread::spawn(move || stdin.write_all(&input));
    let output = child.wait_with_output().unwrap();
    writer.join().unwrap().unwrap();
    assert!(output.status.success(), "{}: {}", program.display(), output.status);
    output.stdout
}

/// A folder of this test, empty at first.
pub fn folder(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("c99").join(name);
    let _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(&folder).unwrap();
    folder
}

fn is_there(program: &str) -> bool {
    let found = Command::new(program).arg("--version").output().is_ok_and(|output| output.status.success());
    if !found {
        println!("skipped: there is no {program}");
    }
    found
}

fn write_files(folder: &Path, compiled: &Compiled) {
    let files = compiled.c_files("mechanism.h");
    fs::write(folder.join("mechanism.h"), files.header).unwrap();
    fs::write(folder.join("mechanism.c"), files.source).unwrap();
}

fn call(program: &str, folder: &Path, arguments: &[&str]) -> Vec<u8> {
    let output = Command::new(program).current_dir(folder).args(arguments).output().unwrap();
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{program} {arguments:?} in {}:\n{said}", folder.display());
    output.stdout
}

/// Programs of a mechanism's files and a driver, by every compiler there is.
pub fn build(name: &str, compiled: &Compiled, driver: &str, flags: &[&str]) -> Vec<Built> {
    let folder = folder(name);
    write_files(&folder, compiled);
    fs::write(folder.join("main.c"), driver).unwrap();
    ["gcc", "clang"]
        .into_iter()
        .filter(|compiler| is_there(compiler))
        .map(|compiler| {
            let object = object(compiler, &folder, flags);
            let files = ["main.c", &object, "-o", compiler, "-lm"];
            call(compiler, &folder, &[&STRICT, flags, &files].concat());
            Built { compiler, program: folder.join(compiler) }
        })
        .collect()
}

/// The object of the mechanism in a folder: several tests want the same one, which is compiled once.
fn object(compiler: &str, folder: &Path, flags: &[&str]) -> String {
    type Known = Mutex<HashMap<String, Arc<OnceLock<String>>>>;
    static KNOWN: OnceLock<Known> = OnceLock::new();
    let [source, header] =
        ["mechanism.c", "mechanism.h"].map(|file| fs::read_to_string(folder.join(file)).unwrap());
    let key = format!("{compiler} {flags:?}\n{header}{source}");
    let slot = Arc::clone(KNOWN.get_or_init(Known::default).lock().unwrap().entry(key).or_default());
    let compile = || {
        let object = folder.join(format!("{compiler}.o"));
        let path = object.to_str().expect("UTF-8").to_owned();
        call(compiler, folder, &[&STRICT, flags, &["-c", "mechanism.c", "-o", &path]].concat());
        path
    };
    slot.get_or_init(compile).clone()
}

/// What a program of C++ writes that includes the header; nothing without a compiler.
pub fn cpp(name: &str, compiled: &Compiled, driver: &str) -> Option<Vec<u8>> {
    if !is_there("g++") {
        return None;
    }
    let folder = folder(name);
    write_files(&folder, compiled);
    fs::write(folder.join("main.cpp"), driver).unwrap();
    call("gcc", &folder, &[&STRICT[..], &["-O1", "-c", "mechanism.c"]].concat());
    call(
        "g++",
        &folder,
        &["-Wall", "-Wextra", "-Werror", "-pedantic", "main.cpp", "mechanism.o", "-lm", "-o", "main"],
    );
    Some(output_of(&folder.join("main"), &[]))
}

/// Symbols that a mechanism's source wants from elsewhere; nothing without a compiler.
pub fn undefined(name: &str, compiled: &Compiled) -> Option<Vec<String>> {
    if !is_there("gcc") || !is_there("nm") {
        return None;
    }
    let folder = folder(name);
    write_files(&folder, compiled);
    call("gcc", &folder, &[&STRICT[..], &["-O1", "-c", "mechanism.c"]].concat());
    let listed = String::from_utf8(call("nm", &folder, &["-u", "mechanism.o"])).unwrap();
    Some(listed.lines().filter_map(|line| line.split_whitespace().last()).map(str::to_owned).collect())
}
