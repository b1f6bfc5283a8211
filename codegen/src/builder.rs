//! The entry point for build scripts: TOML files in, one Rust file each in `OUT_DIR`.
//! In: paths and options. Out: files, and the lines that tell cargo when to run the script again.
//! Never knows how a stage works: everything goes through [`crate::compile`].

use std::env;
use std::fmt::Write as _;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use crate::input::{Reach, read_text};
use crate::{Closure, Diagnostics, Options, SourceFile, compile, limits};

/// Environment variable with a folder that gets a copy of everything generated, for reading.
pub const EMIT_DIR_VARIABLE: &str = "LINKWEAR_EMIT_DIR";

/// What generated code calls the runtime unless [`Builder::runtime_path`] says otherwise.
const DEFAULT_RUNTIME: &str = "::linkwear_runtime";

/// Compiles mechanisms from a build script.
///
/// ```no_run
/// // build.rs
/// linkwear_codegen::Builder::new().mechanism("mechanisms/rssr.toml").write_or_exit();
/// ```
/// and in the crate: `mod rssr { linkwear_runtime::include_mechanism!("rssr"); }`.
/// Elsewhere than in a build script it is told where to write:
/// ```
/// # let folder = std::env::temp_dir().join(format!("linkwear-builder-{}", std::process::id()));
/// # std::fs::create_dir_all(&folder)?;
/// # let file = folder.join("swing.toml");
/// std::fs::write(&file, r#"
/// spec = 1
/// name = "swing"
/// [points]
/// O = ["0 m", "0 m", "0 m"]
/// E = ["1 m", "0 m", "0 m"]
/// [bodies]
/// bar = { rod = ["O", "E"], radius = "10 mm", density = "7850 kg/m^3" }
/// [joints]
/// R1 = { revolute = ["ground", "bar"], at = "O", axis = [0, -1, 0] }
/// "#)?;
/// let written = linkwear_codegen::Builder::new().mechanism(&file).with_start().out_dir(&folder).try_write()?;
/// assert!(std::fs::read_to_string(&written.files[0])?.contains("pub static START"));
/// # std::fs::remove_dir_all(&folder)?;
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
/// The name is the file's, without `.toml`. Options hold for every mechanism of one builder; use a
/// second builder for other options.
#[derive(Clone, Debug, Default)]
#[must_use]
pub struct Builder {
    mechanisms: Vec<PathBuf>,
    options: Options,
    runtime_path: Option<String>,
    with_start: bool,
    out_dir: Option<PathBuf>,
    emit_dir: Option<PathBuf>,
}

/// What [`Builder::try_write`] did.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Written {
    /// Every file that was read and can change the result.
    pub read: Vec<PathBuf>,
    /// The generated files, in the order of the mechanisms.
    pub files: Vec<PathBuf>,
    /// Those of `files` whose contents are new; the others were left untouched, time stamp and all.
    pub changed: Vec<PathBuf>,
    /// Warnings, rendered for people.
    pub warnings: Vec<String>,
}

/// Why one mechanism could not be written.
#[derive(Debug, thiserror::Error)]
pub enum BuildError {
    /// The file cannot be read, or is not UTF-8.
    #[error("error: cannot read mechanism `{}`: {reason}", .path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// What the system says.
        reason: io::Error,
    },
    /// The file is wrong; rendered with places and cures.
    #[error("{0}")]
    Mechanism(Diagnostics),
    /// Two mechanisms would be written to the same file.
    #[error(
        "error: two mechanisms are called `{name}`: rename one file, or give one builder another out_dir"
    )]
    SameName {
        /// Name without `.toml`.
        name: String,
    },
    /// The result cannot be written.
    #[error("error: cannot write `{}`: {reason}", .path.display())]
    Write {
        /// The file.
        path: PathBuf,
        /// What the system says.
        reason: io::Error,
    },
    /// No output folder.
    #[error("error: OUT_DIR is not set: call this from a build script, or give Builder::out_dir")]
    NoOutDir,
}

/// All that went wrong, over all mechanisms.
#[derive(Debug, thiserror::Error)]
#[error("{}", .0.iter().map(ToString::to_string).collect::<Vec<_>>().join("\n"))]
pub struct BuildErrors(pub Vec<BuildError>);

impl Builder {
    /// A builder without mechanisms.
    pub fn new() -> Self {
        Self::default()
    }

    /// Adds a mechanism; the path is relative to the package, as a build script sees it.
    pub fn mechanism(mut self, path: impl Into<PathBuf>) -> Self {
        self.mechanisms.push(path.into());
        self
    }

    /// How loops are closed, whatever the files say.
    pub fn closure(mut self, closure: Closure) -> Self {
        self.options.closure = Some(closure);
        self
    }

    /// Sets a parameter to a value with a unit, as in a file: `.parameter("L1", "130 mm")`.
    pub fn parameter(mut self, name: impl Into<String>, value: impl Into<String>) -> Self {
        self.options.overrides.push((name.into(), value.into()));
        self
    }

    /// Lets a mechanism name files of data outside its folder.
    pub fn allow_outside_data(mut self) -> Self {
        self.options.reach = Reach::Anywhere;
        self
    }

    /// Path by which generated code finds the runtime, e.g. `crate::vendored::linkwear_runtime`.
    pub fn runtime_path(mut self, path: impl Into<String>) -> Self {
        self.runtime_path = Some(path.into());
        self
    }

    /// Adds a consistent start at t = 0 as a static, `START`: for programs without std, which cannot assemble one.
    pub fn with_start(mut self) -> Self {
        self.with_start = true;
        self
    }

    /// Folder to write to instead of `OUT_DIR`.
    pub fn out_dir(mut self, folder: impl Into<PathBuf>) -> Self {
        self.out_dir = Some(folder.into());
        self
    }

    /// Folder for readable copies, instead of the one in the variable `LINKWEAR_EMIT_DIR`.
    pub fn emit_dir(mut self, folder: impl Into<PathBuf>) -> Self {
        self.emit_dir = Some(folder.into());
        self
    }

    /// Writes every mechanism, tells cargo what was read, and on any error prints it for people and
    /// ends the process with code 1. For build scripts: one that returns an error shows its `Debug` form.
    pub fn write_or_exit(self) {
        match self.try_write() {
            Ok(written) => print!("{}", written.cargo_lines()),
            Err(errors) => {
                eprintln!("{errors}");
                std::process::exit(1);
            }
        }
    }

    /// Writes every mechanism and prints nothing. A build script that uses this prints
    /// [`Written::cargo_lines`] itself.
    ///
    /// # Errors
    /// Every mechanism that could not be read, compiled or written. Nothing is written then.
    pub fn try_write(self) -> Result<Written, BuildErrors> {
        let out_dir = match self.out_dir.clone().or_else(|| env::var_os("OUT_DIR").map(PathBuf::from)) {
            Some(folder) => folder,
            None => return Err(BuildErrors(vec![BuildError::NoOutDir])),
        };
        let mut written = Written::default();
        let mut errors = Vec::new();
        let mut results: Vec<(String, String)> = Vec::new();
        for path in &self.mechanisms {
            match self.generate(path, &mut written) {
                Ok((name, _)) if results.iter().any(|(known, _)| *known == name) => {
                    errors.push(BuildError::SameName { name });
                }
                Ok(result) => results.push(result),
                Err(error) => errors.push(error),
            }
        }
        if errors.is_empty() {
            let emit_dir = self.emit_dir.or_else(emit_dir_from_environment);
            for (name, text) in &results {
                if let Err(error) = store(&out_dir, emit_dir.as_deref(), name, text, &mut written) {
                    errors.push(error);
                }
            }
        }
        if errors.is_empty() { Ok(written) } else { Err(BuildErrors(errors)) }
    }

    /// Name and source of one mechanism.
    fn generate(&self, path: &Path, written: &mut Written) -> Result<(String, String), BuildError> {
        let text = read_text(path, limits::FILE_BYTES)
            .map_err(|reason| BuildError::Read { path: path.to_path_buf(), reason })?;
        written.read.push(path.to_path_buf());
        let source = SourceFile { name: shown_name(path), text };
        let compiled = compile(&source, &self.options).map_err(BuildError::Mechanism)?;
        let warnings = compiled.located_warnings();
        for warning in warnings.entries() {
            let place = format!("{}:{}:{}", warning.file, warning.line, warning.column);
            written.warnings.push(format!("{place}: {} ({})", warning.message, warning.code));
        }
        written.read.extend(compiled.mechanism.attached.iter().cloned());
        let runtime = self.runtime_path.as_deref().unwrap_or(DEFAULT_RUNTIME);
        let generated = if self.with_start {
            compiled.rust_source_with_start(runtime).map_err(BuildError::Mechanism)?
        } else {
            compiled.rust_source_for(runtime)
        };
        let name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        Ok((name, generated))
    }
}

impl Written {
    /// Lines for cargo: rerun when a file that was read, or the dump variable, changes; and the
    /// warnings. Names no folder and no output, which would rerun the script for nothing.
    pub fn cargo_lines(&self) -> String {
        let mut lines = String::new();
        for path in &self.read {
            let _ = writeln!(lines, "cargo::rerun-if-changed={}", path.display());
        }
        let _ = writeln!(lines, "cargo::rerun-if-env-changed={EMIT_DIR_VARIABLE}");
        for line in self.warnings.iter().flat_map(|warning| warning.lines()) {
            let _ = writeln!(lines, "cargo::warning={line}");
        }
        lines
    }
}

fn emit_dir_from_environment() -> Option<PathBuf> {
    env::var_os(EMIT_DIR_VARIABLE).filter(|value| !value.is_empty()).map(PathBuf::from)
}

/// The path as generated headers and diagnostics show it: inside the package if possible, with `/`,
/// so that the result does not depend on where the package lies.
fn shown_name(path: &Path) -> String {
    let inside =
        env::var_os("CARGO_MANIFEST_DIR").and_then(|root| path.strip_prefix(root).ok()).unwrap_or(path);
    inside.to_string_lossy().replace('\\', "/")
}

fn store(
    out_dir: &Path,
    emit_dir: Option<&Path>,
    name: &str,
    text: &str,
    written: &mut Written,
) -> Result<(), BuildError> {
    let file = out_dir.join(format!("{name}.rs"));
    if write_if_changed(&file, text)? {
        written.changed.push(file.clone());
    }
    written.files.push(file);
    if let Some(folder) = emit_dir {
        write_if_changed(&folder.join(format!("{name}.rs")), text)?;
    }
    Ok(())
}

/// Leaves the file alone if it has this text, so that what depends on it is not built again.
fn write_if_changed(path: &Path, text: &str) -> Result<bool, BuildError> {
    if fs::read(path).is_ok_and(|old| old == text.as_bytes()) {
        return Ok(false);
    }
    let write = || {
        if let Some(folder) = path.parent() {
            fs::create_dir_all(folder)?;
        }
        fs::write(path, text)
    };
    write().map_err(|reason| BuildError::Write { path: path.to_path_buf(), reason })?;
    Ok(true)
}

#[cfg(test)]
mod tests {
    use super::*;

    const PENDULUM: &str = include_str!("../../mechanisms/pendulum.toml");

    /// A folder of its own, with `pendulum.toml` in it; removed at the end of the test.
    struct Folder(PathBuf);

    impl Folder {
        fn new(test: &str) -> Self {
            let path = env::temp_dir().join(format!("linkwear-builder-{test}-{}", std::process::id()));
            fs::create_dir_all(&path).expect("temporary folder");
            fs::write(path.join("pendulum.toml"), PENDULUM).expect("pendulum file");
            Self(path)
        }

        fn builder(&self) -> Builder {
            Builder::new().mechanism(self.0.join("pendulum.toml")).out_dir(self.0.join("out"))
        }
    }

    impl Drop for Folder {
        fn drop(&mut self) {
            let _ = fs::remove_dir_all(&self.0);
        }
    }

    #[test]
    fn cargo_is_told_exactly_the_files_that_were_read() {
        let folder = Folder::new("lines");
        let written = folder.builder().try_write().expect("a good file");
        let expected = format!(
            "cargo::rerun-if-changed={}\ncargo::rerun-if-env-changed=LINKWEAR_EMIT_DIR\n",
            folder.0.join("pendulum.toml").display()
        );
        assert_eq!(written.cargo_lines(), expected);
        assert_eq!(written.files, [folder.0.join("out/pendulum.rs")]);
    }

    #[test]
    fn an_unchanged_result_is_not_written_again() {
        let folder = Folder::new("unchanged");
        let first = folder.builder().try_write().expect("a good file");
        assert_eq!(first.changed, first.files);
        let stamp = fs::metadata(&first.files[0]).and_then(|data| data.modified()).expect("time stamp");
        let second = folder.builder().try_write().expect("a good file");
        assert!(second.changed.is_empty());
        let again = fs::metadata(&first.files[0]).and_then(|data| data.modified()).expect("time stamp");
        assert_eq!(stamp, again);
    }

    #[test]
    fn the_dump_folder_gets_the_same_text() {
        let folder = Folder::new("dump");
        let written = folder.builder().emit_dir(folder.0.join("dump")).try_write().expect("a good file");
        let read = |path: &Path| fs::read_to_string(path).expect("a generated file");
        assert_eq!(read(&written.files[0]), read(&folder.0.join("dump/pendulum.rs")));
        assert!(read(&written.files[0]).contains(DEFAULT_RUNTIME));
    }

    #[test]
    fn the_runtime_can_live_elsewhere() {
        let folder = Folder::new("runtime");
        let written = folder.builder().runtime_path("crate::vendored").try_write().expect("a good file");
        let text = fs::read_to_string(&written.files[0]).expect("a generated file");
        assert!(text.contains("crate::vendored::System"));
        assert!(!text.contains(DEFAULT_RUNTIME));
    }

    #[test]
    fn a_bad_mechanism_leaves_nothing_behind_and_all_errors_are_reported() {
        let folder = Folder::new("bad");
        fs::write(folder.0.join("bad.toml"), "spec = = 1").expect("bad file");
        let errors = folder
            .builder()
            .mechanism(folder.0.join("bad.toml"))
            .mechanism(folder.0.join("missing.toml"))
            .try_write()
            .expect_err("a bad file");
        assert!(matches!(errors.0[..], [BuildError::Mechanism(_), BuildError::Read { .. }]), "{errors}");
        assert!(errors.to_string().contains("missing.toml"));
        assert!(!folder.0.join("out").exists());
    }

    #[test]
    fn two_mechanisms_of_one_name_are_refused() {
        let folder = Folder::new("same");
        let errors = folder.builder().mechanism(folder.0.join("pendulum.toml")).try_write();
        let errors = errors.expect_err("the same name twice");
        assert!(matches!(errors.0[..], [BuildError::SameName { .. }]), "{errors}");
    }
}
