//! A mechanism at the points of a study. In: a file, what varies. Out: [`Mechanism`]s. Never knows what is asked of them.
//!
//! Where only tunable parameters vary, the file is compiled once and values are set; parameters that are folded into the equations
//! are compiled for each of their values. What is compiled depends on the point alone, never on the points before it.

use linkwear_codegen::diagnostic::{Code, Diagnostics};
use linkwear_codegen::model::{self, Overrides, Parameter};
use linkwear_codegen::spec::{self, Spec, parse_expression};
use linkwear_codegen::{Options, SourceFile};

use super::points::Points;
use super::quantity::{Quantity, named, quantities};
use super::result::StudyColumn;
use crate::backend::Backend;
use crate::mechanism::{LoadError, Mechanism};

/// Names and values as `--set` takes them.
type Given = Vec<(String, String)>;

/// A mechanism at any point.
#[derive(Debug)]
pub struct Cases {
    source: SourceFile,
    options: Options,
    backend: Backend,
    spec: Spec,
    /// At the values of the file; or at the first point, if the file's own cannot be.
    base: Mechanism,
    parameters: Vec<StudyColumn>,
    /// Of those that vary, which are folded into the equations.
    folded: Vec<String>,
}

/// What was compiled last, and for which values.
pub(crate) type Last = Option<(Given, Mechanism)>;

impl Cases {
    /// Of a file with options, at the values of these points, which `option` of the command line gave.
    ///
    /// # Errors
    /// A wrong file; parameters that it does not have, values of another dimension or without a unit.
    pub fn new(
        source: &SourceFile,
        options: &Options,
        backend: Backend,
        (option, points): (&str, &Points),
    ) -> Result<Self, LoadError> {
        let first = || {
            let mut options = options.clone();
            options.overrides.extend(points.values(0));
            Mechanism::compile(source, &options, backend)
        };
        let spec = spec::parse(source).map_err(LoadError::Mechanism)?;
        let known = resolved(&spec, options, &[]).or_else(|_| resolved(&spec, options, &points.values(0)));
        let known = known.map_err(LoadError::Mechanism)?;
        for axis in points.axes() {
            for value in axis.ends() {
                let value = [(axis.name.clone(), value)];
                unreadable(resolved(&spec, options, &value), (option, source))
                    .map_err(LoadError::Mechanism)?;
            }
        }
        let base =
            Mechanism::compile(source, options, backend).or_else(|error| first().map_err(|_| error))?;
        let of = |name: &str| known.iter().find(|parameter| parameter.name == name);
        let varying = || points.axes().iter().filter_map(|axis| of(&axis.name));
        let is_folded = |parameter: &&Parameter| !parameter.tunable && !parameter.input;
        let parameters = varying()
            .map(|parameter| StudyColumn::parameter(&parameter.name, parameter.dimension.si_unit()))
            .collect();
        let folded = varying().filter(is_folded).map(|parameter| parameter.name.clone()).collect();
        let (source, options) = (source.clone(), options.clone());
        Ok(Self { source, options, backend, spec, base, parameters, folded })
    }

    /// The mechanism that names, units and columns are taken from.
    pub fn base(&self) -> &Mechanism {
        &self.base
    }

    /// All that can be asked: of the file as it is, and, where what is folded into the equations varies, of the first and the last
    /// point, which may have more columns.
    pub fn quantities(&self, points: &Points) -> Vec<Quantity> {
        let mut all = quantities(&self.base.description);
        let ends = [0, points.count().saturating_sub(1)].map(|point| points.values(point));
        for given in ends.iter().filter(|_| !self.folded.is_empty()) {
            let Ok(mechanism) = self.alone(given) else { continue };
            let more = quantities(&mechanism.description);
            let more: Vec<_> = more.into_iter().filter(|one| named(&one.name, &all).is_none()).collect();
            all.extend(more);
        }
        all
    }

    /// Columns of the parameters that vary.
    pub fn parameters(&self) -> &[StudyColumn] {
        &self.parameters
    }

    /// The mechanism at a point; `last` is what the same thread compiled before.
    pub(crate) fn at(&self, given: &[(String, String)], last: &mut Last) -> Result<Mechanism, LoadError> {
        let values = resolved(&self.spec, &self.options, given).map_err(LoadError::Mechanism)?;
        let folded = given.iter().filter(|(name, _)| self.folded.contains(name));
        let mut mechanism = self.compiled(folded.cloned().collect(), last).or_else(|_| self.alone(given))?;
        let Mechanism { description, parameters, .. } = &mut mechanism;
        for (known, value) in description.parameters.iter().zip(parameters) {
            if let Some(parameter) = values.iter().find(|parameter| *parameter.name == *known.name) {
                *value = parameter.value;
            }
        }
        Ok(mechanism)
    }

    /// The mechanism compiled for this point alone, with all that is found out about it then.
    pub(super) fn alone(&self, given: &[(String, String)]) -> Result<Mechanism, LoadError> {
        let mut options = self.options.clone();
        options.overrides.extend_from_slice(given);
        Mechanism::compile(&self.source, &options, self.backend)
    }

    fn compiled(&self, folded: Given, last: &mut Last) -> Result<Mechanism, LoadError> {
        if folded.is_empty() {
            return Ok(self.base.clone());
        }
        match last {
            Some((before, mechanism)) if *before == folded => Ok(mechanism.clone()),
            _ => {
                let made = self.alone(&folded)?;
                *last = Some((folded, made.clone()));
                Ok(made)
            }
        }
    }

    /// Values of the varying parameters in SI; nothing for a value that is out of the question.
    pub(crate) fn in_si(&self, given: &[(String, String)]) -> Vec<Option<f64>> {
        let values = resolved(&self.spec, &self.options, given).ok();
        let value = |(name, text): &(String, String)| match &values {
            Some(values) => values.iter().find(|known| known.name == *name).map(|known| known.value),
            None => parse_expression(text, &|_| false).ok()?.quantity().map(|(value, _)| value),
        };
        given.iter().map(|given| value(given).filter(|value| value.is_finite())).collect()
    }
}

/// Parameters of the file at these values, those that follow from others included.
fn resolved(
    spec: &Spec,
    options: &Options,
    given: &[(String, String)],
) -> Result<Vec<Parameter>, Diagnostics> {
    let overrides = Overrides::from_pairs(&[&options.overrides, given].concat());
    let (mechanism, _) = model::resolve(spec, &overrides, options.reach)?;
    Ok(mechanism.parameters)
}

/// Faults of what is written, which every point would have; those of a value are for its own point to tell.
fn unreadable<T>(
    found: Result<T, Diagnostics>,
    (option, source): (&str, &SourceFile),
) -> Result<(), Diagnostics> {
    use Code::{FormulaSyntax, MissingUnit, NotAllowedHere, UnitMismatch, UnknownOverride, UnknownUnit};
    let Err(diagnostics) = found else { return Ok(()) };
    let of_text = [FormulaSyntax, MissingUnit, NotAllowedHere, UnitMismatch, UnknownOverride, UnknownUnit];
    let found = diagnostics.list().iter().filter(|one| of_text.contains(&one.code)).cloned();
    let varied = |text: &mut String| *text = text.replace("--set ", &format!("{option} "));
    let faults: Vec<_> = found
        .map(|mut one| {
            varied(&mut one.message);
            one.help.iter_mut().for_each(varied);
            one
        })
        .collect();
    if faults.is_empty() { Ok(()) } else { Err(Diagnostics::from_list(faults).located(source)) }
}
