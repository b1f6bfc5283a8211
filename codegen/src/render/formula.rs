//! One formula with as few parentheses as its reading needs.
//! In: a node and the names of steps. Out: text.

use std::collections::HashMap;

use crate::expr::{Binary, ExprId, Graph, Node, Unary};

use super::format::TextFormat;

/// Writes nodes of a graph.
pub struct Formula<'a> {
    /// The graph.
    pub graph: &'a Graph,
    /// Names of nodes that are steps of their own.
    pub names: &'a HashMap<ExprId, String>,
    /// Notation.
    pub format: TextFormat,
}

/// How tightly a formula holds together.
#[derive(Clone, Copy, PartialEq, PartialOrd)]
enum Strength {
    Sum,
    Product,
    Atom,
}

impl Formula<'_> {
    /// The formula, named steps by name.
    pub fn write(&self, id: ExprId) -> String {
        self.node(id).0
    }

    /// The right side of a step: its operation, its operands by name.
    pub fn without_name(&self, id: ExprId) -> String {
        self.operation(id).0
    }

    fn node(&self, id: ExprId) -> (String, Strength) {
        match self.names.get(&id) {
            Some(name) => (self.name(name), Strength::Atom),
            None => self.operation(id),
        }
    }

    fn at_least(&self, id: ExprId, strength: Strength) -> String {
        let (text, own) = self.node(id);
        if own >= strength { text } else { self.enclosed(&text) }
    }

    fn enclosed(&self, text: &str) -> String {
        if self.format == TextFormat::Latex { format!("\\left({text}\\right)") } else { format!("({text})") }
    }

    fn operation(&self, id: ExprId) -> (String, Strength) {
        match self.graph.node(id) {
            Node::Constant(bits) => {
                let number = f64::from_bits(bits);
                (self.number(number), if number < 0.0 { Strength::Sum } else { Strength::Atom })
            }
            Node::Symbol(symbol) => (self.name(self.graph.symbol_name(symbol)), Strength::Atom),
            Node::Unary(Unary::Neg, a) => {
                (format!("-{}", self.at_least(a, Strength::Product)), Strength::Sum)
            }
            Node::Unary(Unary::Sqrt, a) if self.format == TextFormat::Latex => {
                (format!("\\sqrt{{{}}}", self.write(a)), Strength::Atom)
            }
            Node::Unary(function, a) => (self.call(&unary_name(function), &[self.write(a)]), Strength::Atom),
            Node::Select(a, yes, no) => {
                let condition = format!("{} < 0", self.write(a));
                (self.call("if", &[condition, self.write(yes), self.write(no)]), Strength::Atom)
            }
            Node::Binary(operation, a, b) => self.binary(operation, a, b),
        }
    }

    fn binary(&self, operation: Binary, a: ExprId, b: ExprId) -> (String, Strength) {
        let latex = self.format == TextFormat::Latex;
        match operation {
            Binary::Add => {
                (format!("{} + {}", self.write(a), self.at_least(b, Strength::Product)), Strength::Sum)
            }
            Binary::Sub => {
                (format!("{} - {}", self.write(a), self.at_least(b, Strength::Product)), Strength::Sum)
            }
            Binary::Mul => {
                let sign = if latex { " \\, " } else { "*" };
                let (left, right) =
                    (self.at_least(a, Strength::Product), self.at_least(b, Strength::Product));
                (format!("{left}{sign}{right}"), Strength::Product)
            }
            Binary::Div if latex => {
                (format!("\\frac{{{}}}{{{}}}", self.write(a), self.write(b)), Strength::Atom)
            }
            Binary::Div => {
                let (top, bottom) = (self.at_least(a, Strength::Product), self.at_least(b, Strength::Atom));
                (format!("{top}/{bottom}"), Strength::Product)
            }
            Binary::Atan2 => (self.call("atan2", &[self.write(a), self.write(b)]), Strength::Atom),
            Binary::AngleOverSine => {
                (self.call("angle_over_sine", &[self.write(a), self.write(b)]), Strength::Atom)
            }
        }
    }

    fn call(&self, name: &str, arguments: &[String]) -> String {
        let list = arguments.join(", ");
        match (self.format, name) {
            (TextFormat::Latex, "sin" | "cos" | "exp" | "ln") => format!("\\{name}\\left({list}\\right)"),
            (TextFormat::Latex, _) => {
                format!("\\operatorname{{{}}}\\left({list}\\right)", self.plain(name))
            }
            _ => format!("{name}({list})"),
        }
    }

    fn number(&self, number: f64) -> String {
        let text = format!("{number:?}");
        let text = text.strip_suffix(".0").unwrap_or(&text).to_owned();
        match (self.format, text.split_once('e')) {
            (TextFormat::Latex, Some((mantissa, exponent))) => format!("{mantissa}\\cdot 10^{{{exponent}}}"),
            _ => text,
        }
    }

    /// A name in this notation.
    pub fn name(&self, name: &str) -> String {
        if self.format == TextFormat::Latex {
            format!("\\mathit{{{}}}", self.plain(name))
        } else {
            name.to_owned()
        }
    }

    /// An entry of an output.
    pub fn entry(&self, output: &str, entry: &str) -> String {
        match self.format {
            TextFormat::Latex => format!("{}_{{\\mathit{{{}}}}}", self.name(output), self.plain(entry)),
            _ => format!("{output}[{entry}]"),
        }
    }

    /// User text, escaped for the notation. Letters of our own texts that LaTeX does not set by itself are written as it does.
    pub fn plain(&self, text: &str) -> String {
        let special = match self.format {
            TextFormat::Text => return text.to_owned(),
            TextFormat::Markdown => "\\`*_{}[]<>#|",
            TextFormat::Latex => "\\{}_^#$%&~",
        };
        let mut escaped = String::new();
        let mut letters = text.chars().peekable();
        while let Some(c) = letters.next() {
            if self.format == TextFormat::Latex && letters.next_if_eq(&'\u{307}').is_some() {
                escaped.extend(['\\', '.', '{', c, '}']);
                continue;
            }
            match (self.format, c) {
                (TextFormat::Latex, 'ᵀ') => escaped.push_str("\\textsuperscript{T}"),
                (TextFormat::Latex, '\\') => escaped.push_str("\\textbackslash{}"),
                (TextFormat::Latex, '^') => escaped.push_str("\\textasciicircum{}"),
                (TextFormat::Latex, '~') => escaped.push_str("\\textasciitilde{}"),
                (_, c) if special.contains(c) => escaped.extend(['\\', c]),
                (_, c) => escaped.push(c),
            }
        }
        escaped
    }
}

fn unary_name(function: Unary) -> String {
    match function {
        Unary::Neg => "neg".to_owned(),
        Unary::Sqrt => "sqrt".to_owned(),
        Unary::Sin => "sin".to_owned(),
        Unary::Cos => "cos".to_owned(),
        Unary::Exp => "exp".to_owned(),
        Unary::Ln => "ln".to_owned(),
        Unary::Floor => "floor".to_owned(),
        Unary::LogCoefficient(rank) => format!("log_coefficient_{rank}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::expr::Scope;

    fn text(format: TextFormat) -> String {
        let g = Scope::new();
        let (a, b) = (g.symbol("a_1"), g.symbol("b"));
        let sum = a + b;
        let quotient = ((a * sum).sin() / sum).id();
        Formula { graph: &g.into_graph(), names: &HashMap::new(), format }.write(quotient)
    }

    #[test]
    fn parentheses_stand_only_where_reading_needs_them() {
        assert_eq!(text(TextFormat::Text), "sin(a_1*(a_1 + b))/(a_1 + b)");
    }

    #[test]
    fn latex_escapes_names() {
        assert!(text(TextFormat::Latex).contains("\\mathit{a\\_1}"));
    }
}
