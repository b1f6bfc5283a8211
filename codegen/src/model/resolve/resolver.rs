//! What the steps of the resolver share, and how they report.

use std::path::PathBuf;

use super::known_controllers::Controllers;
use super::modal_start::ModalStart;
use super::names::Names;
use super::tabled::Tabled;
use crate::diagnostic::{Code, Diagnostic, Severity, nearest};
use crate::id::JointId;
use crate::input::Reach;
use crate::model::{Formula, JointModel, Parameter, Point, Term};
use crate::source::{SourceFile, Span};
use crate::spec::{ForceKind, Name, Turning};

/// What the steps of the resolver share.
pub(super) struct Resolver<'a> {
    pub(super) source: &'a SourceFile,
    /// Where the files may lie that it names.
    pub(super) reach: Reach,
    pub(super) skipped: &'a [Span],
    pub(super) diagnostics: Vec<Diagnostic>,
    pub(super) names: Names,
    pub(super) parameters: Vec<Parameter>,
    /// Values of the parameters.
    pub(super) values: Vec<f64>,
    /// Parameters that are not tunable but follow from tunable ones are written out where they are used.
    pub(super) written_out: Vec<Option<Term>>,
    /// Turns and angles of the states that the file declares, and of the sensors so far.
    pub(super) state_turning: Vec<Turning>,
    pub(super) sensor_turning: Vec<Turning>,
    pub(super) used: Vec<bool>,
    pub(super) points: Vec<Point>,
    pub(super) joint_models: Vec<JointModel>,
    pub(super) modal_starts: Vec<ModalStart>,
    /// Coordinates of joints that drives prescribe.
    pub(super) driven: Vec<(JointId, usize)>,
    /// Kinds of the force elements; nothing of one whose kind is wrong.
    pub(super) force_kinds: Vec<Option<&'static ForceKind>>,
    /// Start values of the states; nothing of one whose start is wrong.
    pub(super) states: Vec<Option<Formula>>,
    /// Formulas of sensors so far; nothing of one without.
    pub(super) sensors: Vec<Option<Formula>>,
    /// Controllers so far.
    pub(super) controllers: Controllers,
    /// Whether the last of them is being read.
    pub(super) reading_controller: bool,
    /// Other files that were read.
    pub(super) attached: Vec<PathBuf>,
    /// Functions given by rows.
    pub(super) tables: Vec<Tabled>,
    /// Names of all that are written.
    pub(super) lost_tables: Vec<String>,
}

/// A fault that was reported, unless another explains it; more can be said about it.
pub(super) struct Reported<'a>(Option<&'a mut Diagnostic>);

impl Reported<'_> {
    /// Adds advice.
    pub(super) fn help(self, text: impl Into<String>) -> Self {
        self.then(|diagnostic| diagnostic.help(text))
    }

    /// Says something at the place.
    pub(super) fn label(self, text: impl Into<String>) -> Self {
        self.then(|mut diagnostic| {
            diagnostic.labels[0].text = text.into();
            diagnostic
        })
    }

    /// Adds a related place.
    pub(super) fn also(self, span: Span, text: &str) -> Self {
        self.then(|diagnostic| diagnostic.also(span, text))
    }

    /// Adds "did you mean" if one of `known` is close to `wrong`.
    pub(super) fn did_you_mean<'n>(self, wrong: &str, known: impl IntoIterator<Item = &'n str>) -> Self {
        self.then(|diagnostic| diagnostic.did_you_mean(wrong, known))
    }

    fn then(mut self, add: impl FnOnce(Diagnostic) -> Diagnostic) -> Self {
        if let Some(diagnostic) = &mut self.0 {
            **diagnostic = add(diagnostic.clone());
        }
        self
    }
}

impl Resolver<'_> {
    pub(super) fn has_errors(&self) -> bool {
        self.diagnostics.iter().any(|diagnostic| diagnostic.severity == Severity::Error)
    }

    pub(super) fn whole_file(&self) -> Span {
        Span { start: 0, end: self.source.text.len() }
    }

    pub(super) fn report(&mut self, diagnostic: Diagnostic) {
        self.diagnostics.push(diagnostic);
    }

    /// Reports a fault in one place.
    pub(super) fn refuse(&mut self, code: Code, span: Span, message: impl Into<String>) -> Reported<'_> {
        self.diagnostics.push(Diagnostic::new(code, message).at(span, ""));
        Reported(self.diagnostics.last_mut())
    }

    /// Reports what is missing within `whole`, unless something there was left out because it was wrong:
    /// then that is the reason. The fault is shown at `at`.
    pub(super) fn missing(
        &mut self,
        whole: Span,
        at: Span,
        code: Code,
        message: impl Into<String>,
    ) -> Reported<'_> {
        let explained = |skipped: &Span| whole.start <= skipped.start && skipped.end <= whole.end;
        if self.skipped.iter().any(explained) { Reported(None) } else { self.refuse(code, at, message) }
    }

    /// A key that a table lacks; nothing if it is there, wrong or misspelt, which is told already.
    pub(super) fn lacking(
        &mut self,
        whole: Span,
        at: Span,
        key: &str,
        message: impl Into<String>,
    ) -> Reported<'_> {
        let is_meant = |skipped: &Span| {
            let before = self.source.text.get(whole.start..skipped.start)?;
            let name = before.trim_end().strip_suffix('=')?.trim_end();
            let name = name.rsplit(|c: char| !c.is_alphanumeric() && c != '_').next()?;
            nearest(name, [key]).or((name == key).then_some(key))
        };
        let is_told =
            self.skipped.iter().any(|skipped| skipped.end <= whole.end && is_meant(skipped).is_some());
        if is_told { Reported(None) } else { self.refuse(Code::MissingKey, at, message) }
    }

    pub(super) fn wrong_count(&mut self, span: Span, found: usize, needed: &str, what: &str) {
        let entries = if found == 1 { "entry" } else { "entries" };
        let message = format!("{what} has {found} {entries}, not {needed}");
        self.refuse(Code::WrongCount, span, message).label(format!("write {needed}"));
    }

    /// Value with the parameters of the file; NaN if it is not known before the motion.
    pub(super) fn value(&self, formula: &Formula) -> f64 {
        formula.value(&self.values).unwrap_or(f64::NAN)
    }

    /// Whether it changes with a parameter of the generated code.
    pub(super) fn is_tunable(&self, formula: &Formula) -> bool {
        formula.depends_on(&|id| self.parameters[id.index()].tunable)
    }

    pub(super) fn values_of<const N: usize>(&self, formulas: &[Formula; N]) -> [f64; N] {
        std::array::from_fn(|at| self.value(&formulas[at]))
    }

    /// Reports unless `formula` is positive (or zero, if allowed).
    pub(super) fn check_positive(&mut self, formula: &Formula, zero_allowed: bool, what: &str) {
        let value = self.value(formula);
        if value < 0.0 || (value == 0.0 && !zero_allowed) {
            let message = format!("{what} is {}", self.told(formula));
            let need = if zero_allowed { "it must not be negative" } else { "it must be positive" };
            self.refuse(Code::NotPositive, formula.span, message).label(need);
        }
    }

    /// Tells of a spring whose stiffness is below zero: it can be, and is seldom meant.
    pub(super) fn warn_pushing(&mut self, stiffness: &Formula, what: &str) {
        if self.value(stiffness) < 0.0 {
            let message = format!(
                "{what} is {}: the spring pushes away from where it is unloaded",
                self.told(stiffness)
            );
            self.refuse(Code::NegativeStiffness, stiffness.span, message).help(
                "take the sign away; of a mechanism that snaps over, where it is meant, `allow = [\"W0128\"]` in [check] says so",
            );
        }
    }
}

/// `key` of `what` `name`, as messages call a place.
pub(super) fn place(key: &str, what: &str, name: &Name) -> String {
    format!("`{key}` of {what} `{}`", name.value)
}
