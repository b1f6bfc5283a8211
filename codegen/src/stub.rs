//! STUB, to be deleted at merge: `compile` for one hand-written pendulum, whatever the file says.
#![allow(missing_docs, clippy::all)]

use std::fmt;

use crate::model::{Closure, Mechanism, Parameter, Topology, Formula};
use crate::source::{SourceFile, Span};
use crate::spec::Dimension;
use linkwear_runtime::Description;

#[rustfmt::skip]
#[path = "stub_pendulum.rs"]
mod pendulum;
pub use pendulum::Mechanism as Interpreted;

#[derive(Clone, Debug, Default)]
pub struct Options {
    pub closure: Option<Closure>,
    pub overrides: Vec<(String, String)>,
}

#[derive(Clone, Debug)]
pub struct Entry {
    pub code: &'static str,
    pub file: String,
    pub line: usize,
    pub column: usize,
    pub message: String,
    pub help: String,
}

#[derive(Clone, Debug)]
pub struct Diagnostic {
    pub code: &'static str,
    pub message: String,
    pub span: Span,
}

#[derive(Clone, Debug)]
pub struct Diagnostics {
    source: Option<SourceFile>,
    list: Vec<Diagnostic>,
}

impl Diagnostics {
    pub fn from_list(list: Vec<Diagnostic>) -> Self {
        Self { source: None, list }
    }
    pub fn located(mut self, source: &SourceFile) -> Self {
        self.source = Some(source.clone());
        self
    }
    pub fn is_empty(&self) -> bool {
        self.list.is_empty()
    }
    pub fn entries(&self) -> Vec<Entry> {
        let source = self.source.as_ref().unwrap();
        self.list.iter().map(|d| {
            let (line, column) = source.line_column(d.span.start);
            Entry { code: d.code, file: source.name.clone(), line, column, message: d.message.clone(), help: String::new() }
        }).collect()
    }
}

impl fmt::Display for Diagnostics {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for e in self.entries() {
            write!(f, "error[{}]: {}\n --> {}:{}:{}", e.code, e.message, e.file, e.line, e.column)?;
        }
        Ok(())
    }
}

pub fn nearest<'a>(wrong: &str, known: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    known.into_iter().find(|name| strsim::osa_distance(wrong, name) <= 2)
}

#[derive(Clone, Debug)]
pub struct Redundant { pub joint: String, pub row: String, pub reason: String }

#[derive(Clone, Debug)]
pub struct Analysis {
    pub coordinates: usize, pub speeds: usize, pub constraint_rows: usize, pub independent_rows: usize,
    pub mobility: i32, pub grubler: i32,
    pub drivers: Vec<String>, pub idle: Vec<String>, pub redundant: Vec<Redundant>, pub non_unique: Vec<String>,
}

#[derive(Clone, Copy, Debug, Default)]
pub struct Operations { pub mul: usize, pub add: usize, pub div: usize, pub sqrt: usize, pub sincos: usize }
impl Operations { pub fn total(&self) -> usize { self.mul + self.add + self.div + self.sqrt + self.sincos } }

#[derive(Clone, Debug)]
pub struct FunctionCount { pub name: String, pub operations: Operations, pub statements: usize, pub parts: usize }

#[derive(Clone, Debug)]
pub struct OutputInfo { pub function: String, pub name: String, pub rows: usize, pub cols: usize, pub operations: Operations, pub operations_unshared: Operations }

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TextFormat { Text, Markdown, Latex }

#[derive(Clone, Debug)]
pub struct Compiled {
    pub mechanism: Mechanism, pub topology: Topology, pub analysis: Analysis, pub warnings: Vec<Diagnostic>,
    sha: String, damping: f64,
}

impl Compiled {
    pub fn description(&self) -> &Description { pendulum::description() }
    pub fn interpreter(&self) -> Interpreted { Interpreted::default() }
    pub fn parameters(&self) -> Vec<f64> { vec![self.damping] }
    pub fn rust_source(&self) -> String { include_str!("stub_pendulum.rs").replace("@SHA@", &self.sha) }
    pub fn operations(&self) -> Vec<FunctionCount> {
        vec![FunctionCount { name: "forward_dynamics".into(), operations: Operations { mul: 2, add: 1, sincos: 1, ..Default::default() }, statements: 4, parts: 1 }]
    }
    pub fn outputs(&self) -> Vec<OutputInfo> {
        let operations = Operations { mul: 2, add: 1, sincos: 1, ..Default::default() };
        vec![OutputInfo { function: "forward_dynamics".into(), name: "accelerations".into(), rows: 1, cols: 1, operations, operations_unshared: operations }]
    }
    pub fn equations_text(&self, _only: &[String], _format: TextFormat) -> String { "a = -g cos q\n".into() }
}

pub fn compile(source: &SourceFile, options: &Options) -> Result<Compiled, Diagnostics> {
    use sha2::Digest;
    let bad = |code: &'static str, message: String, span: Span| Diagnostics::from_list(vec![Diagnostic { code, message, span }]).located(source);
    if let Err(e) = source.text.parse::<toml::Table>() {
        return Err(bad("E0001", e.message().into(), e.span().map(Span::from).unwrap_or_default()));
    }
    let mut damping = 0.0;
    for (name, value) in &options.overrides {
        if name == "damping" {
            damping = value.split(' ').next().unwrap().parse().map_err(|_| bad("E0002", format!("{value} is not a number"), Span::default()))?;
        } else if name != "length" {
            return Err(bad("E0003", format!("there is no parameter `{name}`"), Span::default()));
        }
    }
    let sha = sha2::Sha256::digest(source.text.as_bytes()).iter().map(|b| format!("{b:02x}")).collect();
    let zero = || Formula::number(0.0, Dimension::default());
    let parameter = |name: &str, tunable, value| Parameter { name: name.into(), value, dimension: Dimension::default(), tunable, assumed: false, span: Span::default() };
    Ok(Compiled {
        mechanism: Mechanism { name: "pendulum".into(), parameters: vec![parameter("damping", true, 0.0), parameter("length", false, 1.0)], gravity: [zero(), zero(), zero()],
            bodies: vec![], points: vec![], joints: vec![], forces: vec![], closure: options.closure.unwrap_or_default(), starts: vec![] },
        topology: Topology { tree: vec![], cuts: vec![] },
        analysis: Analysis { coordinates: 1, speeds: 1, constraint_rows: 0, independent_rows: 0, mobility: 1, grubler: 1, drivers: vec![], idle: vec![], redundant: vec![], non_unique: vec![] },
        warnings: vec![], sha, damping,
    })
}
