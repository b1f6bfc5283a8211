//! Calls of functions in formulas: which there are, what they take, and the dimension of what they give.

use super::quantity::{Allowed, Here, Origin, Resolved};
use super::resolver::Resolver;
use super::tabled::Tabled;
use crate::diagnostic::Code;
use crate::model::{Function, Piecewise, Term};
use crate::spec::{Dimension, Expression, Form, Relation};

/// A function as a formula calls it.
struct Callable {
    name: &'static str,
    /// How it is written.
    form: &'static str,
    /// Fewest and most arguments.
    count: [usize; 2],
    function: Function,
}

const fn smooth(name: &'static str, form: &'static str, count: usize, function: Function) -> Callable {
    Callable { name, form, count: [count, count], function }
}

const fn pieces(form: &'static str, count: [usize; 2], function: Piecewise) -> Callable {
    Callable { name: function.name(), form, count, function: Function::Piecewise(function) }
}

const FUNCTIONS: &[Callable] = &[
    smooth("sin", "sin(x)", 1, Function::Sin),
    smooth("cos", "cos(x)", 1, Function::Cos),
    smooth("tan", "tan(x)", 1, Function::Tan),
    smooth("asin", "asin(x)", 1, Function::Asin),
    smooth("acos", "acos(x)", 1, Function::Acos),
    smooth("atan", "atan(x)", 1, Function::Atan),
    smooth("atan2", "atan2(y, x)", 2, Function::Atan2),
    smooth("sinh", "sinh(x)", 1, Function::Sinh),
    smooth("cosh", "cosh(x)", 1, Function::Cosh),
    smooth("tanh", "tanh(x)", 1, Function::Tanh),
    smooth("exp", "exp(x)", 1, Function::Exp),
    smooth("ln", "ln(x)", 1, Function::Ln),
    smooth("sqrt", "sqrt(x)", 1, Function::Sqrt),
    pieces("abs(x)", [1, 1], Piecewise::Abs),
    pieces("sign(x)", [1, 1], Piecewise::Sign),
    pieces("min(a, b)", [2, 2], Piecewise::Min),
    pieces("max(a, b)", [2, 2], Piecewise::Max),
    pieces("clamp(x, lowest, highest)", [3, 3], Piecewise::Clamp),
    pieces("step(x)", [1, 1], Piecewise::Step),
    pieces("floor(x)", [1, 1], Piecewise::Floor),
    pieces("mod(x, period)", [2, 2], Piecewise::Mod),
    pieces("smooth_abs(x, width)", [2, 2], Piecewise::SmoothAbs),
    pieces("smooth_sign(x, width)", [2, 2], Piecewise::SmoothSign),
    pieces("smooth_step(x, width)", [2, 2], Piecewise::SmoothStep),
    pieces("trapezoid(phase, ramp)", [1, 3], Piecewise::Trapezoid),
    pieces("s_curve(phase, ramp)", [1, 3], Piecewise::SCurve),
    pieces("cycloidal(phase)", [1, 2], Piecewise::Cycloidal),
    pieces("modified_sine(phase)", [1, 2], Piecewise::ModifiedSine),
    pieces("poly345(phase)", [1, 2], Piecewise::Poly345),
    pieces("poly4567(phase)", [1, 2], Piecewise::Poly4567),
];

/// What an argument must be that shapes a function: fixed, and within bounds.
enum Shape {
    Positive,
    /// Above 0, at most a half.
    Ramp,
    /// At least a whole phase.
    Period,
}

impl Shape {
    fn holds(&self, value: f64) -> bool {
        match self {
            Self::Positive => value > 0.0,
            Self::Ramp => value > 0.0 && value <= 0.5,
            Self::Period => value >= 1.0,
        }
    }

    const fn must(&self) -> &'static str {
        match self {
            Self::Positive => "must be above zero",
            Self::Ramp => "is a part of the phase: above 0, at most 1/2",
            Self::Period => "is at least the whole phase: 1 or more",
        }
    }
}

/// Which arguments shape a function, by their place.
const fn shape(function: Piecewise, place: usize) -> Option<Shape> {
    match (function, place) {
        (Piecewise::Mod | Piecewise::SmoothAbs | Piecewise::SmoothSign | Piecewise::SmoothStep, 1) => {
            Some(Shape::Positive)
        }
        (Piecewise::Trapezoid | Piecewise::SCurve, 1) => Some(Shape::Ramp),
        (Piecewise::Trapezoid | Piecewise::SCurve, 2)
        | (Piecewise::Cycloidal | Piecewise::ModifiedSine | Piecewise::Poly345 | Piecewise::Poly4567, 1) => {
            Some(Shape::Period)
        }
        _ => None,
    }
}

/// Whether formulas have a function of this name.
pub(super) fn is_function(name: &str) -> bool {
    name == "if" || FUNCTIONS.iter().any(|known| known.name == name)
}

/// The dimension of the result, if the arguments have dimensions that go together.
fn dimension(function: Function, of: &[Dimension]) -> Option<Dimension> {
    let none = |fits: bool| fits.then_some(Dimension::NONE);
    let alike = of.iter().all(|one| *one == of[0]);
    match function {
        Function::Sqrt => of[0].root(),
        Function::Atan2 => none(alike),
        Function::Piecewise(function) => match function {
            Piecewise::Abs
            | Piecewise::Min
            | Piecewise::Max
            | Piecewise::Clamp
            | Piecewise::Mod
            | Piecewise::SmoothAbs => alike.then_some(of[0]),
            Piecewise::Sign | Piecewise::Step | Piecewise::SmoothSign | Piecewise::SmoothStep => none(alike),
            _ => none(of.iter().all(|one| *one == Dimension::NONE)),
        },
        _ => none(of[0] == Dimension::NONE),
    }
}

/// A bare zero goes with any dimension.
fn is_zero(expression: &Expression) -> bool {
    matches!(expression.form, Form::Number { value, bare: true, .. } if value == 0.0)
}

/// Bare zeros take the dimension of the first argument that is none.
fn take_over(arguments: &[Expression], of: &mut [Dimension]) {
    let known = arguments.iter().zip(&*of).find(|(argument, _)| !is_zero(argument)).map(|(_, of)| *of);
    let zeros = arguments.iter().zip(of).filter(|(argument, _)| is_zero(argument));
    if let Some(known) = known {
        zeros.for_each(|(_, of)| *of = known);
    }
}

impl Resolver<'_> {
    pub(super) fn call(&mut self, name: &str, arguments: &[Expression], here: Here<'_>) -> Resolved {
        if name == "if" {
            return self.choice(arguments, here);
        }
        if let Some(at) = self.tables.iter().position(|known| known.table.name == name) {
            return self.table_value(at, arguments, here);
        }
        let Some(callable) = FUNCTIONS.iter().find(|known| known.name == name) else {
            if self.is_lost_table(name) {
                return None;
            }
            let known: Vec<&str> = FUNCTIONS.iter().map(|known| known.name).chain(["if"]).collect();
            let list = known.join(", ");
            let tables: Vec<String> = self.tables.iter().map(|known| known.table.name.clone()).collect();
            let known: Vec<&str> = known.into_iter().chain(tables.iter().map(String::as_str)).collect();
            self.refuse_in(here, Code::UnknownFunction, &format!("there is no function `{name}`"))
                .did_you_mean(name, known)
                .help(format!("functions are {list}"));
            return None;
        };
        let pieces = match callable.function {
            Function::Piecewise(function) => Some(function),
            _ => None,
        };
        let resolved: Vec<Resolved> = arguments
            .iter()
            .enumerate()
            .map(|(place, argument)| match pieces.and_then(|function| shape(function, place)) {
                Some(shape) => self.shaping(argument, &shape, (name, here)),
                None => self.term(argument, here.origin),
            })
            .collect();
        let ([fewest, most], found) = (callable.count, arguments.len());
        if !(fewest..=most).contains(&found) {
            let needed = if fewest == most { fewest.to_string() } else { format!("{fewest} to {most}") };
            let plural = if most == 1 { "" } else { "s" };
            let message = format!("`{name}` takes {needed} argument{plural}, not {found}");
            self.refuse_in(here, Code::UnknownFunction, &message).help(format!("write `{}`", callable.form));
            return None;
        }
        let (terms, mut dimensions): (Vec<Term>, Vec<Dimension>) =
            resolved.into_iter().collect::<Option<Vec<_>>>()?.into_iter().unzip();
        if pieces.is_some() {
            take_over(arguments, &mut dimensions);
        }
        let Some(dimension) = dimension(callable.function, &dimensions) else {
            self.refuse_dimensions(callable, &dimensions, here);
            return None;
        };
        Some((Term::Call(callable.function, terms), dimension))
    }

    fn refuse_dimensions(&mut self, callable: &Callable, dimensions: &[Dimension], here: Here<'_>) {
        let found = dimensions.iter().map(|d| d.description()).collect::<Vec<_>>().join(" and ");
        let several = dimensions.len() > 1 && dimension(callable.function, &[dimensions[0]; 3]).is_some();
        let need = match callable.function {
            Function::Sqrt => "needs even powers of the units",
            Function::Atan2 => "needs two quantities of one dimension",
            Function::Piecewise(_) if several => "needs quantities of one dimension",
            _ => "needs a pure number or an angle",
        };
        let message = format!("`{}` {need}, not {found}", callable.name);
        self.refuse_in(here, Code::UnitMismatch, &message)
            .help("divide by a quantity of the same kind, or check the units");
    }

    /// An argument that shapes a function.
    fn shaping(&mut self, argument: &Expression, shape: &Shape, (name, here): (&str, Here<'_>)) -> Resolved {
        let Origin { quantity, what, .. } = *here.origin;
        let (term, dimension) =
            self.term(argument, &Origin { quantity, what, allowed: Allowed::CONSTANTS })?;
        let value = term.value_at(&self.values, None).unwrap_or(f64::NAN);
        if shape.holds(value) && value.is_finite() {
            return Some((term, dimension));
        }
        let own = Here { range: &argument.range, ..here };
        let message = format!("{value} cannot shape `{name}`: it {}", shape.must());
        self.refuse_in(own, Code::BadArgument, &message).help("check the number and its unit");
        None
    }

    /// The value of a table.
    fn table_value(&mut self, at: usize, arguments: &[Expression], here: Here<'_>) -> Resolved {
        let Tabled { table, argument, value } = &self.tables[at];
        let (table, needed, value) = (table.clone(), argument.dimension, value.dimension);
        let [argument] = arguments else {
            let message = format!("the table `{}` takes 1 argument, not {}", table.name, arguments.len());
            self.refuse_in(here, Code::UnknownFunction, &message).help(format!("write `{}(x)`", table.name));
            return None;
        };
        let (term, found) = self.term(argument, here.origin)?;
        if found != needed && !is_zero(argument) {
            let (needed, found) = (needed.description(), found.description());
            let message = format!("the table `{}` is over {needed}, not {found}", table.name);
            self.refuse_in(here, Code::UnitMismatch, &message)
                .help("divide by a quantity of the same kind, or check the units of its columns");
            return None;
        }
        Some((Term::Table(table, Box::new(term)), value))
    }

    /// `if(condition, then, else)`.
    fn choice(&mut self, arguments: &[Expression], here: Here<'_>) -> Resolved {
        let [condition, sides @ ..] = arguments else { return None };
        let (Form::Compare(relation, compared), [_, _]) = (&condition.form, sides) else {
            let message = if sides.len() == 2 {
                "`if` needs a comparison first".to_owned()
            } else {
                format!("`if` takes 3 arguments, not {}", arguments.len())
            };
            self.refuse_in(here, Code::UnknownFunction, &message)
                .help("write `if(a < b, then, else)`, with `<`, `<=`, `>` or `>=`");
            return None;
        };
        let compared = self.alike(&**compared, "compared", here);
        let sides = self.alike(sides, "chosen between", here);
        let ([a, b], _) = compared?;
        let ([yes, no], dimension) = sides?;
        // Whether the first is below the second, or not.
        let below = |a: Term, b: Term| Term::Sub(Box::new(a), Box::new(b));
        let parts = match relation {
            Relation::Less => [below(a, b), yes, no],
            Relation::Greater => [below(b, a), yes, no],
            Relation::AtMost => [below(b, a), no, yes],
            Relation::AtLeast => [below(a, b), no, yes],
        };
        Some((Term::Choice(Box::new(parts)), dimension))
    }

    /// Two terms of one dimension.
    fn alike(&mut self, both: &[Expression], verb: &str, here: Here<'_>) -> Option<([Term; 2], Dimension)> {
        let [left, right] = both else { return None };
        let resolved = [left, right].map(|one| self.term(one, here.origin));
        let [(a, of_a), (b, of_b)] = resolved.into_iter().collect::<Option<Vec<_>>>()?.try_into().ok()?;
        let mut of = [of_a, of_b];
        take_over(both, &mut of);
        if of[0] != of[1] {
            let message = format!("{} and {} cannot be {verb}", of[0].description(), of[1].description());
            let help = self.one_kind(&[left, right]);
            self.refuse_in(here, Code::UnitMismatch, &message).help(help);
            return None;
        }
        Some(([a, b], of[0]))
    }
}
