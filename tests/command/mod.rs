//! Runs the built program, for the tests of the command line.
#![allow(dead_code, reason = "each test file uses a part")]

use std::path::PathBuf;
use std::process::{Child, Command, Output, Stdio};
use std::sync::atomic::{AtomicU32, Ordering};

use serde_json::Value;

/// What the program said and how it ended.
pub struct Answer {
    pub code: i32,
    pub out: String,
    pub err: String,
}

impl Answer {
    pub fn of(output: Output) -> Self {
        let text = |bytes| String::from_utf8(bytes).expect("UTF-8");
        Self {
            code: output.status.code().expect("an exit code"),
            out: text(output.stdout),
            err: text(output.stderr),
        }
    }

    /// All of stdout as one JSON object, after success.
    pub fn json(&self) -> Value {
        assert_eq!(self.code, 0, "{}{}", self.out, self.err);
        serde_json::from_str(&self.out).expect("one JSON object")
    }

    /// The errors on stdout, after failure.
    pub fn errors(&self) -> Vec<Value> {
        assert_ne!(self.code, 0);
        let object: Value = serde_json::from_str(&self.out).expect("one JSON object");
        object["errors"].as_array().expect("a list").clone()
    }
}

fn command(arguments: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_linkwear"));
    command.args(arguments).stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::piped());
    command
}

/// Runs in the package's folder and waits.
pub fn linkwear(arguments: &[&str]) -> Answer {
    Answer::of(command(arguments).output().expect("the program runs"))
}

/// Runs in the package's folder and does not wait. Signals that the caller ignores, as in the background of a script,
/// have their meaning for the program.
pub fn start(arguments: &[&str]) -> Child {
    let mut command = Command::new("env");
    command.args(["--default-signal=INT,TERM,HUP", env!("CARGO_BIN_EXE_linkwear")]).args(arguments);
    command.stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::piped());
    command.spawn().expect("`env` of the GNU core utilities runs the program")
}

/// How many folders there have been: two tests may choose the same name.
static FOLDERS: AtomicU32 = AtomicU32::new(0);

/// A folder of its own for one test, removed at its end.
pub struct Folder(pub PathBuf);

impl Folder {
    pub fn new(test: &str) -> Self {
        let (process, number) = (std::process::id(), FOLDERS.fetch_add(1, Ordering::Relaxed));
        let path = std::env::temp_dir().join(format!("linkwear-cli-{test}-{process}-{number}"));
        std::fs::create_dir_all(&path).expect("temporary folder");
        Self(path)
    }

    /// Path of a file in it, whether it exists or not.
    pub fn path(&self, name: &str) -> String {
        self.0.join(name).to_str().expect("UTF-8").to_owned()
    }

    pub fn write(&self, name: &str, text: &str) -> String {
        let path = self.path(name);
        std::fs::write(&path, text).expect("a file");
        path
    }

    pub fn read(&self, name: &str) -> String {
        std::fs::read_to_string(self.path(name)).expect("a file")
    }

    /// Names of everything in it, sorted.
    pub fn names(&self) -> Vec<String> {
        let entries = std::fs::read_dir(&self.0).expect("a folder");
        let name = |entry: std::io::Result<std::fs::DirEntry>| {
            entry.expect("an entry").file_name().to_string_lossy().into_owned()
        };
        let mut names: Vec<String> = entries.map(name).collect();
        names.sort();
        names
    }

    /// Runs with this folder as the current one.
    pub fn linkwear(&self, arguments: &[&str]) -> Answer {
        Answer::of(command(arguments).current_dir(&self.0).output().expect("the program runs"))
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(&self.0);
    }
}
