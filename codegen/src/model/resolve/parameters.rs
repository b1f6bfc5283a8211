//! Parameters: in which order they follow from each other, their values, and `--set`.

use super::names::Thing;
use super::overrides::Overrides;
use super::quantity::{Allowed, Origin};
use super::resolver::Resolver;
use super::words::leaves_of;
use crate::diagnostic::{Code, Diagnostic};
use crate::id::ParameterId;
use crate::model;
use crate::spec::{
    At, Dimension, Expression, File, Form, Literal, Name, Parameter, Quantity, Table, Turning, as_written,
    parse_expression,
};

/// Largest formula that a parameter may be written out to. Parameters made of each other could double in size
/// at every step; a real one has ten terms.
const LARGEST: usize = 2000;

impl Resolver<'_> {
    pub(super) fn resolve_parameters(&mut self, table: &Table<Parameter>, overrides: &Overrides) {
        self.names.declare_table(table, |at| Thing::Parameter(ParameterId::new(at)), &mut self.diagnostics);
        self.make_room(table.0.len());
        self.parameters = table
            .0
            .iter()
            .map(|(name, parameter)| {
                let (tunable, assumed) = parameter.value.marks();
                model::Parameter { tunable, assumed, ..self.no_parameter(name) }
            })
            .collect();
        for position in self.order(table) {
            let (name, parameter) = &table.0[position];
            self.resolve_parameter(position, name, parameter, overrides);
        }
    }

    /// A parameter of which only the name is known.
    pub(super) fn no_parameter(&self, name: &Name) -> model::Parameter {
        model::Parameter {
            name: name.value.clone(),
            value: f64::NAN,
            dimension: Dimension::NONE,
            turning: Turning::default(),
            written: None,
            tunable: false,
            input: false,
            assumed: false,
            span: name.span,
        }
    }

    /// Makes room for what is kept of every parameter.
    pub(super) fn make_room(&mut self, parameters: usize) {
        self.values.resize(parameters, f64::NAN);
        self.written_out.resize(parameters, None);
        self.used.resize(parameters, false);
    }

    /// Reports overrides of what is neither a parameter nor an input.
    pub(super) fn check_overrides(&mut self, file: &File, overrides: &Overrides) {
        let parameters = || file.parameters.0.iter().map(|(name, _)| name);
        let known =
            || parameters().chain(file.inputs.0.iter().map(|(name, _)| name)).map(|name| &*name.value);
        for name in overrides.names() {
            if !known().any(|known| known == name) {
                let message = format!("`--set {name}=...`: there is no parameter `{name}`");
                let mut fault = Diagnostic::new(Code::UnknownOverride, message).did_you_mean(name, known());
                if fault.help.is_empty() {
                    let list = known().collect::<Vec<_>>().join(", ");
                    fault = fault.help(match list.as_str() {
                        "" => "this file has no parameters".to_owned(),
                        list => format!("parameters of this file: {list}"),
                    });
                }
                self.report(fault);
            }
        }
    }

    fn resolve_parameter(
        &mut self,
        position: usize,
        name: &Name,
        parameter: &At<Parameter>,
        overrides: &Overrides,
    ) {
        let Some(quantity) = parameter.value.value() else {
            let message = format!("the parameter `{}` has no value", name.value);
            self.missing(parameter.span, name.span, Code::MissingKey, message)
                .help(format!("write `{0} = \"120 mm\"` or `{0} = {{ value = \"120 mm\" }}`", name.value));
            return;
        };
        let formula = self.settle_value(position, name, quantity, Allowed::PARAMETERS, overrides);
        if self.is_tunable(&formula) && !self.parameters[position].tunable {
            if formula.term.size() > LARGEST {
                let message =
                    format!("`{}` grows too large when written out in tunable parameters", name.value);
                self.refuse(Code::FormulaSyntax, quantity.span, message);
                return;
            }
            self.written_out[position] = Some(formula.term);
        }
    }

    /// Finds the value that is written, or the one that is given in its place.
    pub(super) fn settle_value(
        &mut self,
        position: usize,
        name: &Name,
        quantity: &Quantity,
        allowed: Allowed,
        overrides: &Overrides,
    ) -> model::Formula {
        let mut formula = self.formula(quantity, None, allowed, &format!("`{}`", name.value));
        self.parameters[position].turning = self.turns_of(quantity).of;
        self.parameters[position].written = written(quantity);
        let given = overrides.0.iter().rev().find(|(given, _)| *given == name.value);
        if let Some((_, text)) = given {
            formula = self.overridden(name, text, position, formula);
        }
        let value = self.value(&formula);
        self.values[position] = value;
        self.parameters[position].value = value;
        self.parameters[position].dimension = formula.dimension;
        formula
    }

    /// The value of `--set name=text`: a quantity of the dimension that the parameter has in the file.
    fn overridden(
        &mut self,
        name: &Name,
        text: &str,
        position: usize,
        in_file: model::Formula,
    ) -> model::Formula {
        let what = format!("`--set {}={text}`", name.value);
        let (span, dimension) = (in_file.span, in_file.dimension);
        let quantity = Quantity { span, value: Literal::Text(text.to_owned()) };
        let expression = parse_expression(text, &|word| self.names.is_name(word)).ok();
        let mut names = Vec::new();
        expression.iter().for_each(|expression| names_in(expression, &mut names));
        if let Some(used) = names.first() {
            let message = format!("{what} uses the name `{used}`");
            self.refuse(Code::NotAllowedHere, span, message)
                .help("on the command line give a quantity, for example speed=\"2 Hz\"");
            return model::Formula::number(f64::NAN, dimension);
        }
        let unit = self.parameters[position].written.as_ref().map(|(_, unit)| unit.clone());
        let unit = unit.filter(|unit| !unit.is_empty()).unwrap_or_else(|| dimension.si_unit());
        let (own, given) = (self.parameters[position].turning, self.turns_of(&quantity).of);
        if let Some([message, help]) = self.other_turning(position, given, &what) {
            self.refuse(Code::UnitMismatch, span, message).help(help);
            return model::Formula::number(f64::NAN, dimension);
        }
        if let (Some((number, "")), true) = (as_written(text), dimension != Dimension::NONE && text != "0") {
            let message = format!("{what} needs a unit: it is {}", dimension.description());
            self.refuse(Code::MissingUnit, span, message).help(format!(
                "write `--set {}=\"{number} {unit}\"`, in the unit of the file, or another that says what is meant",
                name.value
            ));
            return model::Formula::number(f64::NAN, dimension);
        }
        if let Some(expression) = &expression {
            let origin = Origin { quantity: &quantity, allowed: Allowed::CONSTANTS, what: &what };
            let Some((_, found)) = self.term(expression, &origin) else {
                return model::Formula::number(f64::NAN, dimension);
            };
            if found != dimension && !matches!(expression.form, Form::Number { value: 0.0, .. }) {
                let example = match &self.parameters[position].written {
                    Some((number, unit)) => format!("{number} {unit}").trim_end().to_owned(),
                    None if own.turns > 0 => "2 Hz".to_owned(),
                    None => dimension.example(),
                };
                let (is, needed) = (found.description(), dimension.description());
                self.refuse(Code::UnitMismatch, span, format!("{what} is {is}, but {needed} is needed"))
                    .help(format!("write it as the file does, `--set {}=\"{example}\"`", name.value));
                return model::Formula::number(f64::NAN, dimension);
            }
        }
        self.parameters[position].turning = if given == Turning::default() { own } else { given };
        self.parameters[position].written = written(&quantity);
        self.formula(&quantity, Some(dimension), Allowed::GIVEN, &what)
    }

    /// Positions so that every parameter comes after those it uses; cycles are reported and left out.
    fn order(&mut self, table: &Table<Parameter>) -> Vec<usize> {
        let uses: Vec<Vec<usize>> =
            table.0.iter().map(|(_, parameter)| self.uses(&parameter.value)).collect();
        let mut waiting: Vec<usize> = uses.iter().map(Vec::len).collect();
        let mut users = vec![Vec::new(); uses.len()];
        for (user, used) in uses.iter().enumerate() {
            used.iter().for_each(|at| users[*at].push(user));
        }
        let mut order: Vec<usize> = (0..uses.len()).filter(|at| waiting[*at] == 0).collect();
        let mut next = 0;
        while let Some(&done) = order.get(next) {
            next += 1;
            for &user in &users[done] {
                waiting[user] -= 1;
                if waiting[user] == 0 {
                    order.push(user);
                }
            }
        }
        if order.len() < uses.len() {
            self.report_cycles(table, &uses, &waiting);
        }
        order
    }

    fn uses(&self, parameter: &Parameter) -> Vec<usize> {
        let Some(At { value: Literal::Text(text), .. }) = parameter.value() else { return Vec::new() };
        let Ok(expression) = parse_expression(text, &|word| self.names.is_name(word)) else {
            return Vec::new();
        };
        let mut names = Vec::new();
        names_in(&expression, &mut names);
        let found = names.iter().filter_map(|name| match self.names.find(name) {
            Some((Thing::Parameter(id), _)) => Some(id.index()),
            _ => None,
        });
        found.collect()
    }

    /// Walks from each waiting parameter along waiting ones until one repeats: that is a cycle.
    fn report_cycles(&mut self, table: &Table<Parameter>, uses: &[Vec<usize>], waiting: &[usize]) {
        let mut seen = vec![false; uses.len()];
        for start in (0..uses.len()).filter(|at| waiting[*at] > 0) {
            let mut path: Vec<usize> = Vec::new();
            let mut at = start;
            while !seen[at] {
                seen[at] = true;
                path.push(at);
                // A waiting parameter uses at least one waiting parameter.
                at = uses[at].iter().copied().find(|used| waiting[*used] > 0).unwrap_or(at);
            }
            // Otherwise the walk ran into parameters that are reported already.
            if let Some(first) = path.iter().position(|known| *known == at) {
                self.report_cycle(table, &path[first..]);
            }
        }
    }

    fn report_cycle(&mut self, table: &Table<Parameter>, cycle: &[usize]) {
        let names: Vec<_> = cycle.iter().map(|at| format!("`{}`", table.0[*at].0.value)).collect();
        let message = match names.as_slice() {
            [only] => format!("the parameter {only} is defined by itself"),
            _ => format!("the parameters {} are defined by each other", names.join(", ")),
        };
        self.refuse(Code::ParameterCycle, table.0[cycle[0]].0.span, message).help("give one of them a value");
    }
}

/// Number and unit, if they are all that is written.
fn written(quantity: &Quantity) -> Option<(f64, String)> {
    match &quantity.value {
        Literal::Number(number) => Some((*number, String::new())),
        Literal::Text(text) => as_written(text).map(|(number, unit)| (number, unit.to_owned())),
    }
}

/// Names of the file that occur in an expression.
fn names_in<'a>(expression: &'a Expression, names: &mut Vec<&'a str>) {
    names.extend(leaves_of(expression).into_iter().filter_map(|leaf| match &leaf.form {
        Form::Name(name) if name == "pi" => None,
        Form::Name(name) | Form::Member(name, _) => Some(name.as_str()),
        _ => None,
    }));
}
