//! Inputs: signals from outside, each with a unit and a default. They stand behind the parameters, as parameters that may
//! change with time.

use super::names::Thing;
use super::overrides::Overrides;
use super::quantity::Allowed;
use super::resolver::Resolver;
use crate::diagnostic::Code;
use crate::id::ParameterId;
use crate::model;
use crate::source::Span;
use crate::spec::{At, Dimension, Input, InputTable, Literal, Name, Quantity, Table};

impl Resolver<'_> {
    pub(super) fn resolve_inputs(&mut self, table: &Table<Input>, overrides: &Overrides) {
        let first = self.parameters.len();
        self.names.declare_table(
            table,
            |at| Thing::Input(ParameterId::new(first + at)),
            &mut self.diagnostics,
        );
        for (name, input) in &table.0 {
            self.parameters.push(model::Parameter { input: true, ..self.no_parameter(name) });
            self.make_room(self.parameters.len());
            let Some(quantity) = self.default_of(name, input) else { continue };
            let position = self.parameters.len() - 1;
            self.settle_value(position, name, &quantity, Allowed::CONSTANTS, overrides);
        }
    }

    /// The default of an input with its unit; nothing where that is wrong, which is reported.
    fn default_of(&mut self, name: &Name, input: &At<Input>) -> Option<Quantity> {
        let table = match &input.value {
            Input::Plain(quantity) => return Some(quantity.clone()),
            Input::Table(table) => table,
        };
        let InputTable { unit, default, .. } = table;
        match (unit, default) {
            (None, None) => {
                let message = format!("the input `{}` has neither unit nor default", name.value);
                let forms = format!(
                    "write `{0} = \"0 N\"` or `{0} = {{ unit = \"N\", default = 0 }}`, in its own unit",
                    name.value
                );
                self.missing(input.span, name.span, Code::MissingKey, message).help(forms);
                None
            }
            (None, Some(default)) => Some(default.clone()),
            (Some(unit), None) => Some(in_unit(0.0, unit, unit.span)),
            (Some(unit), Some(default)) => match default.value {
                Literal::Number(number) => Some(in_unit(number, unit, default.span)),
                Literal::Text(_) => {
                    let expected = self.dimension_of(name, unit)?;
                    let what = format!("the default of `{}`", name.value);
                    let formula = self.formula(default, Some(expected), Allowed::CONSTANTS, &what);
                    self.value(&formula).is_finite().then(|| default.clone())
                }
            },
        }
    }

    fn dimension_of(&mut self, name: &Name, unit: &Name) -> Option<Dimension> {
        let (one, what) = (in_unit(1.0, unit, unit.span), format!("the unit of `{}`", name.value));
        let formula = self.formula(&one, None, Allowed::CONSTANTS, &what);
        self.value(&formula).is_finite().then_some(formula.dimension)
    }
}

/// A number in a unit, as if it had been written so.
fn in_unit(number: f64, unit: &Name, span: Span) -> Quantity {
    Quantity { span, value: Literal::Text(format!("{number} {}", unit.value)) }
}
