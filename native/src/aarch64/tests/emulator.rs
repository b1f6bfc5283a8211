//! Runs machine code under an emulator, by a program in C (`harness.c`). In: functions, inputs, answers to their calls.
//! Out: what they give.

use std::path::PathBuf;
use std::process::Command;
use std::{env, fs, process};

use crate::straight::graph::Function;
use crate::straight::tests::calls::Call;
use crate::straight::write::Written;

/// Where the harness puts jumps to the functions that code calls, of 16 bytes each.
const FUNCTIONS: u64 = 0x1234_5678_9000;

/// Where code finds a function.
pub(super) fn function(function: Function) -> usize {
    FUNCTIONS as usize + 16 * function as usize
}

/// A folder that is gone when the test ends.
pub(super) struct Folder(PathBuf);

impl Folder {
    pub(super) fn new(name: &str) -> Self {
        let path = env::temp_dir().join(format!("linkwear-{name}-{}", process::id()));
        fs::create_dir(&path).expect("a fresh folder");
        Self(path)
    }

    pub(super) fn file(&self, name: &str) -> PathBuf {
        self.0.join(name)
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        // What is left of it is the system's to clear away.
        let _ = fs::remove_dir_all(&self.0);
    }
}

/// Runs a program to its end.
pub(super) fn program(command: &mut Command) {
    let output = command.output().unwrap_or_else(|error| panic!("{command:?}: {error}"));
    assert!(output.status.success(), "{command:?}: {}", String::from_utf8_lossy(&output.stderr));
}

/// A function and what it is called with.
pub(super) struct Case {
    pub(super) written: Written,
    /// Numbers by their bits, those of all lanes, value by value.
    pub(super) input: Vec<u64>,
    pub(super) calls: Vec<Call>,
}

impl Case {
    fn words(&self) -> Vec<u64> {
        let Written { code, pool, inputs, outputs, workspace, passes, advance, .. } = &self.written;
        assert_eq!(self.input.len(), *inputs);
        let mut code = code.clone();
        code.resize(code.len().next_multiple_of(8), 0);
        let (code, _) = code.as_chunks::<8>();
        let lengths = [code.len(), pool.len(), *inputs, *outputs, *workspace, *passes, *advance];
        let mut words: Vec<u64> = lengths.map(|length| length as u64).into();
        words.extend([self.calls.len() as u64, *advance as u64]);
        words.extend(code.iter().map(|word| u64::from_le_bytes(*word)));
        words.extend(pool);
        words.extend(&self.input);
        for Call { function, arguments, result } in &self.calls {
            words.push(*function as u64);
            words.extend(arguments);
            words.push(*result);
        }
        words
    }
}

/// The outputs of every case.
pub(super) fn run(name: &str, cases: &[Case]) -> Vec<Vec<u64>> {
    let folder = Folder::new(name);
    let [harness, into, out] = ["harness", "cases", "results"].map(|name| folder.file(name));
    let source = concat!(env!("CARGO_MANIFEST_DIR"), "/src/aarch64/tests/harness.c");
    program(Command::new("aarch64-linux-gnu-gcc").args(["-O1", "-static", "-o"]).arg(&harness).arg(source));
    let bytes = |case: &Case| case.words().into_iter().flat_map(u64::to_le_bytes).collect::<Vec<u8>>();
    fs::write(&into, cases.iter().flat_map(bytes).collect::<Vec<u8>>()).expect("a file");
    program(Command::new("qemu-aarch64").args([&harness, &into, &out]).arg(format!("{FUNCTIONS:x}")));
    let results = fs::read(&out).expect("results");
    let (results, _) = results.as_chunks::<8>();
    let mut results = results.iter().map(|word| u64::from_le_bytes(*word));
    let given = cases.iter().map(|case| results.by_ref().take(case.written.outputs).collect());
    let given: Vec<Vec<u64>> = given.collect();
    assert!(cases.iter().zip(&given).all(|(case, given)| case.written.outputs == given.len()));
    given
}
