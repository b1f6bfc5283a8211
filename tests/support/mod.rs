//! Shared by the cross-stage tests: compile a shipped mechanism, run it, read columns by name.
#![allow(dead_code, reason = "every test file uses its own part")]

pub mod machine_code;
pub mod random;

pub use machine_code::system;

use std::path::PathBuf;

use linkwear_codegen::backend::interp::Interpreted;
use linkwear_codegen::compile::{Compiled, Options, compile};
use linkwear_codegen::model::Closure;
use linkwear_codegen::source::SourceFile;
use linkwear_runtime::{
    Description, Entry, Integrator, Run, Scalar, Settings, Span, System, Watch, simulate,
};

/// Text of a shipped mechanism.
pub fn shipped(name: &str) -> SourceFile {
    let path = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("mechanisms").join(format!("{name}.toml"));
    let text = std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    SourceFile { name: format!("mechanisms/{name}.toml"), text }
}

/// A mechanism of tests/data.
pub fn in_data(name: &str) -> SourceFile {
    let name = format!("tests/data/{name}.toml");
    let path = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join(&name);
    let text = std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    SourceFile { name, text }
}

/// Compiles a shipped mechanism with overrides like `("speed", "10 Hz")`.
pub fn compiled(name: &str, overrides: &[(&str, &str)], closure: Option<Closure>) -> Compiled {
    compile_source(&shipped(name), overrides, closure)
}

/// Compiles a source, showing its diagnostics if it fails.
pub fn compile_source(source: &SourceFile, overrides: &[(&str, &str)], closure: Option<Closure>) -> Compiled {
    let overrides = overrides.iter().map(|(a, b)| ((*a).to_owned(), (*b).to_owned())).collect();
    compile(source, &Options { closure, overrides, ..Options::default() })
        .unwrap_or_else(|error| panic!("{error}"))
}

/// Adaptive integration of a compiled mechanism.
pub fn run(compiled: &Compiled, span: Span, settle: Span, samples: usize, tolerance: f64) -> Recorded {
    let integrator = Integrator::Dopri5 { tolerance, max_step: None };
    let settings = Settings { settle, ..Settings::new(integrator, span, samples) };
    run_with(compiled, &settings)
}

/// Any integration.
pub fn run_with(compiled: &Compiled, settings: &Settings) -> Recorded {
    let system = system(compiled);
    let run = simulate(&*system, compiled.description(), &compiled.parameters(), settings, Watch::NONE)
        .unwrap_or_else(|error| panic!("{error}"));
    if let Some(stopped) = &run.stopped {
        panic!("the run stopped early: {stopped}");
    }
    Recorded { run, description: compiled.description().clone() }
}

/// The answer of an entry point, on scalars of any kind.
pub fn evaluate<T: Scalar>(system: &Interpreted, entry: Entry, input: &[T]) -> Vec<T> {
    let sizes = System::<T>::sizes(system);
    assert_eq!(input.len(), sizes.input(entry));
    let mut output = vec![T::constant(0.0); sizes.output(entry)];
    let mut workspace = vec![T::constant(0.0); sizes.workspace];
    system.evaluate(entry, input, &mut output, &mut workspace);
    output
}

/// A run with named columns.
pub struct Recorded {
    /// The run.
    pub run: Run,
    /// Column names.
    pub description: Description,
}

impl Recorded {
    /// All samples of a column, those of contacts included.
    pub fn column(&self, name: &str) -> Vec<f64> {
        self.run.column(name).unwrap_or_else(|error| panic!("{error}"))
    }

    /// Last sample of a column.
    pub fn last(&self, name: &str) -> f64 {
        *self.column(name).last().expect("a run has samples")
    }
}

/// Largest difference as a share of the largest value of `expected` (its range for coordinates).
pub fn relative_error(values: &[f64], expected: &[f64]) -> f64 {
    assert_eq!(values.len(), expected.len());
    let scale = expected.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
    largest_difference(values, expected) / scale
}

/// Largest difference.
pub fn largest_difference(values: &[f64], expected: &[f64]) -> f64 {
    values.iter().zip(expected).fold(0.0, |m: f64, (a, b)| m.max((a - b).abs()))
}

/// A table of numbers with named columns.
pub struct Table {
    names: Vec<String>,
    rows: Vec<Vec<f64>>,
}

impl Table {
    /// Reads `tests/reference/<name>`.
    pub fn reference(name: &str) -> Self {
        let path = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("tests/reference").join(name);
        let text =
            std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
        let mut lines = text.lines().filter(|line| !line.starts_with('#') && !line.trim().is_empty());
        let names = lines.next().expect("a header").split(',').map(|name| name.trim().to_owned()).collect();
        let rows = lines
            .map(|line| line.split(',').map(|cell| cell.trim().parse().unwrap_or(f64::NAN)).collect())
            .collect();
        Self { names, rows }
    }

    /// A column by name.
    pub fn column(&self, name: &str) -> Vec<f64> {
        let index =
            self.names.iter().position(|known| known == name).unwrap_or_else(|| panic!("no column {name}"));
        self.rows.iter().map(|row| row[index]).collect()
    }

    /// Number of rows.
    pub fn len(&self) -> usize {
        self.rows.len()
    }
}

/// A balanced rotor of 5 kg under its weight, driven at a speed [Hz] in a bearing with a play of 50 um; `more`: of that bearing, and
/// behind it.
pub fn loose_rotor(speed: f64, more: &str) -> String {
    format!(
        r#"
spec = 1
name = "rotor"
gravity = [0, "-9.81 m/s^2", 0]
[points]
O = [0, 0, 0]
[bodies]
b = {{ mass = "5 kg", centre = "O", inertia = ["0.01 kg m^2", "0.01 kg m^2", "0.01 kg m^2"] }}
[joints]
J = {{ revolute = ["ground", "b"], at = "O", axis = [0, 0, 1], drive = "2*pi*{speed}*t/(1 s)" }}
[clearance.J]
radial = "50 um"
journal_radius = "10 mm"
length = "20 mm"
modulus = "100 GPa"
restitution = 0.5
{more}
"#
    )
}
