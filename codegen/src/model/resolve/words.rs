//! Values in the words of the file: in the unit that is written for them, and what the parameters of a formula are.

use super::resolver::Resolver;
use crate::model::{Formula, Parameter};
use crate::source::Span;
use crate::spec::{Dimension, Expression, Form, as_written, parse_expression, unit_size};

/// More parameters than these are not named in a cure.
const MOST: usize = 4;

impl Resolver<'_> {
    /// A value in the unit that the file has at its place.
    pub(super) fn told(&self, formula: &Formula) -> String {
        self.told_at(formula.span, self.value(formula), formula.dimension)
    }

    /// A value in the unit of what is written at a place, or of a parameter there; in SI where there is none.
    pub(super) fn told_at(&self, place: Span, value: f64, dimension: Dimension) -> String {
        let written = self.source.text.get(place.start..place.end).unwrap_or_default();
        let text = written.trim_matches(['"', '\'']);
        let in_unit = || {
            let read = self.read_again(text)?;
            let (size, unit) =
                leaves_of(&read).into_iter().find_map(|leaf| self.unit_of(text, leaf, dimension))?;
            // Without what rounding leaves behind the twelfth digit: 0.24 m is 240 mm.
            let number: f64 = format!("{:.11e}", value / size).parse().ok()?;
            Some(format!("{number} {unit}"))
        };
        in_unit().unwrap_or_else(|| match dimension {
            Dimension::NONE => value.to_string(),
            dimension => format!("{value} {}", dimension.si_unit()),
        })
    }

    /// What the parameters in formulas are, for a cure: what is wrong may be where they are defined.
    pub(super) fn defined_in(&self, formulas: &[&Expression]) -> Option<String> {
        let mut named: Vec<&Parameter> = Vec::new();
        for leaf in formulas.iter().flat_map(|formula| leaves_of(formula)) {
            let parameter = self.parameter_of(leaf);
            named.extend(parameter.filter(|found| named.iter().all(|other| other.name != found.name)));
        }
        let told = |parameter: &&Parameter| {
            format!("`{}` is defined as {}", parameter.name, parameter.dimension.description())
        };
        (1..=MOST).contains(&named.len()).then(|| named.iter().map(told).collect::<Vec<_>>().join(", "))
    }

    /// What to do where two sides are of different dimensions.
    pub(super) fn one_kind(&self, sides: &[&Expression]) -> String {
        let defined = self.defined_in(sides).map(|defined| format!("; {defined}"));
        format!("give both the same kind of unit{}", defined.unwrap_or_default())
    }

    /// A text that was read before, where its faults were told.
    pub(super) fn read_again(&self, text: &str) -> Option<Expression> {
        parse_expression(text, &|word| self.names.is_name(word)).ok()
    }

    fn parameter_of(&self, leaf: &Expression) -> Option<&Parameter> {
        let Form::Name(name) = &leaf.form else { return None };
        self.parameters.iter().find(|parameter| parameter.name == *name)
    }

    /// How much a unit of a dimension is in SI, and the unit, of a number or a parameter that has one.
    fn unit_of(&self, text: &str, leaf: &Expression, dimension: Dimension) -> Option<(f64, String)> {
        let unit = match self.parameter_of(leaf) {
            Some(parameter) => parameter.written.as_ref()?.1.clone(),
            None => as_written(text.get(leaf.range.clone())?)?.1.to_owned(),
        };
        let size = unit_size(&unit).filter(|size| size.dimension == dimension)?.size();
        // Degrees of temperature begin elsewhere.
        let from = self.read_again(&format!("0 {unit}"))?.quantity()?.0;
        (!unit.is_empty() && from == 0.0).then_some((size, unit))
    }
}

/// Numbers and names of a formula, in order.
pub(super) fn leaves_of(formula: &Expression) -> Vec<&Expression> {
    match &formula.form {
        Form::Number { .. } | Form::Name(_) | Form::Member(..) => vec![formula],
        Form::Neg(inner) | Form::Power(inner, _) => leaves_of(inner),
        Form::Binary(_, left, right) => [leaves_of(left), leaves_of(right)].concat(),
        Form::Call(_, arguments) => arguments.iter().flat_map(leaves_of).collect(),
        Form::Compare(_, sides) => sides.iter().flat_map(leaves_of).collect(),
    }
}
