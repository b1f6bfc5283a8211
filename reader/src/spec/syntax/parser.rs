//! From tokens to an expression, by recursive descent; units are read in [`super::units`].

use std::ops::Range;

use super::super::dimension::Dimension;
use super::super::rockwell::{RANGE, pressure};
use super::super::turning::Turning;
use super::super::unit::Unit;
use super::expression::{Expression, Form, Operator, SyntaxError, fault};
use super::lex::{Kind, Token};

/// Deepest nesting: far above any real formula, and safe for the recursion over it.
const DEEPEST: usize = 60;

pub(super) fn parse(
    tokens: &[Token],
    length: usize,
    is_name: &dyn Fn(&str) -> bool,
) -> Result<Expression, SyntaxError> {
    let mut parser = Parser { tokens, next: 0, length, depth: 0, is_name, shadowed: Vec::new() };
    let mut whole = parser.sum()?;
    if let Some(token) = parser.peek() {
        if let Some(number) = parser.decimal_comma() {
            let message = "a comma is no decimal point here";
            return Err(fault(message, token.range.clone()).advise(format!("write `{number}`")));
        }
        let message = match &token.kind {
            Kind::Word(_) | Kind::Number(_) => "an operator is missing here",
            Kind::Mark(_) => "this does not belong here",
            Kind::Relation(_) => {
                return Err(fault("a comparison stands here", token.range.clone())
                    .advise("comparisons choose: `if(a < b, then, else)`, and compare two values only"));
            }
        };
        return Err(fault(message, token.range.clone()).advise("products need a `*`: `2*L1`, `L1*(L2 + L3)`"));
    }
    whole.shadowed = parser.shadowed;
    Ok(whole)
}

/// A unit without a number, if that is all.
pub(super) fn unit(tokens: &[Token], length: usize) -> Option<Unit> {
    let mut parser = Parser { tokens, next: 0, length, depth: 0, is_name: &|_| false, shadowed: Vec::new() };
    let unit = parser.unit().ok()?;
    parser.peek().is_none().then_some(unit)
}

pub(super) struct Parser<'a> {
    pub(super) tokens: &'a [Token],
    pub(super) next: usize,
    pub(super) length: usize,
    pub(super) depth: usize,
    pub(super) is_name: &'a dyn Fn(&str) -> bool,
    pub(super) shadowed: Vec<(String, Range<usize>)>,
}

fn expression(form: Form, range: Range<usize>) -> Expression {
    Expression { form, range, shadowed: Vec::new() }
}

impl<'a> Parser<'a> {
    pub(super) fn peek(&self) -> Option<&'a Token> {
        self.tokens.get(self.next)
    }

    pub(super) fn mark_at(&self, offset: usize) -> Option<char> {
        match self.tokens.get(self.next + offset)?.kind {
            Kind::Mark(mark) => Some(mark),
            _ => None,
        }
    }

    pub(super) fn word_at(&self, offset: usize) -> Option<&'a str> {
        match &self.tokens.get(self.next + offset)?.kind {
            Kind::Word(word) => Some(word),
            _ => None,
        }
    }

    pub(super) fn take(&mut self, mark: char) -> bool {
        let found = self.mark_at(0) == Some(mark);
        self.next += usize::from(found);
        found
    }

    /// The number that was meant, if the next token is the comma of `160,5`.
    fn decimal_comma(&self) -> Option<String> {
        let number = |at: Option<usize>| match self.tokens.get(at?)?.kind {
            Kind::Number(value) => Some(value),
            _ => None,
        };
        let (whole, part) = (number(self.next.checked_sub(1))?, number(Some(self.next + 1))?);
        let is_comma = self.mark_at(0) == Some(',') && whole.fract() == 0.0 && part.fract() == 0.0;
        is_comma.then(|| {
            // The digits behind the comma as written: `1,05` is not 1.5.
            let digits = self.tokens[self.next + 1].range.len();
            format!("{whole}.{part:0digits$}")
        })
    }

    /// Where the next token is, or the end of the text.
    pub(super) fn here(&self) -> Range<usize> {
        self.peek().map_or(self.length..self.length, |token| token.range.clone())
    }

    fn expect(&mut self, mark: char) -> Result<(), SyntaxError> {
        if self.take(mark) {
            Ok(())
        } else {
            Err(fault(format!("`{mark}` is missing here"), self.here()).advise(format!("add the `{mark}`")))
        }
    }

    /// Reads something that may hold all of the grammar again.
    fn deeper(
        &mut self,
        read: impl FnOnce(&mut Self) -> Result<Expression, SyntaxError>,
    ) -> Result<Expression, SyntaxError> {
        self.depth += 1;
        if self.depth > DEEPEST {
            return Err(
                fault("the formula is nested too deep", self.here()).advise("split it into parameters")
            );
        }
        let expression = read(self)?;
        self.depth -= 1;
        Ok(expression)
    }

    fn sum(&mut self) -> Result<Expression, SyntaxError> {
        self.deeper(Self::terms)
    }

    fn terms(&mut self) -> Result<Expression, SyntaxError> {
        let mut left = self.product()?;
        loop {
            let operator = match self.mark_at(0) {
                Some('+') => Operator::Add,
                Some('-') => Operator::Sub,
                _ => return Ok(left),
            };
            self.next += 1;
            let right = self.product()?;
            left = binary(operator, left, right);
        }
    }

    fn product(&mut self) -> Result<Expression, SyntaxError> {
        let mut left = self.factor()?;
        loop {
            let operator = match self.mark_at(0) {
                Some('*') => Operator::Mul,
                Some('/') => Operator::Div,
                _ => return Ok(left),
            };
            self.next += 1;
            let right = self.factor()?;
            left = binary(operator, left, right);
        }
    }

    fn factor(&mut self) -> Result<Expression, SyntaxError> {
        let start = self.here().start;
        if self.take('+') {
            return self.deeper(Self::factor);
        }
        if self.take('-') {
            let inner = self.deeper(Self::factor)?;
            let range = start..inner.range.end;
            return Ok(expression(Form::Neg(Box::new(inner)), range));
        }
        self.power()
    }

    fn power(&mut self) -> Result<Expression, SyntaxError> {
        let base = self.atom()?;
        if !self.take('^') {
            return Ok(base);
        }
        let (exponent, end) = self.exponent()?;
        if self.mark_at(0) == Some('^') {
            return Err(fault("a power of a power", self.here()).advise("use brackets: `(a^2)^3`"));
        }
        let range = base.range.start..end;
        Ok(expression(Form::Power(Box::new(base), exponent), range))
    }

    pub(super) fn exponent(&mut self) -> Result<(i32, usize), SyntaxError> {
        let bracket = self.take('(');
        let negative = self.take('-');
        let range = self.here();
        let whole = match self.peek().map(|token| &token.kind) {
            // Up to 99: no formula of mechanics needs more, and every such power of a double is exact to write.
            Some(Kind::Number(value)) if value.fract() == 0.0 && *value <= 99.0 => *value as i32,
            _ => {
                return Err(fault("exponents are whole numbers from -99 to 99", range)
                    .advise("write `sqrt(a)` for a root, `exp(b*ln(a))` for other powers"));
            }
        };
        self.next += 1;
        if bracket {
            self.expect(')')?;
        }
        Ok((if negative { -whole } else { whole }, range.end))
    }

    fn atom(&mut self) -> Result<Expression, SyntaxError> {
        let range = self.here();
        let Some(token) = self.peek() else {
            return Err(no_value(range));
        };
        self.next += 1;
        match &token.kind {
            Kind::Number(value) => self.quantity(*value, range),
            Kind::Word(word) => self.named(word, range),
            Kind::Mark('(') => {
                let inner = self.sum()?;
                self.expect(')')?;
                let end = self.tokens[self.next - 1].range.end;
                Ok(Expression { range: range.start..end, ..inner })
            }
            Kind::Mark(_) | Kind::Relation(_) => Err(no_value(range)),
        }
    }

    fn named(&mut self, word: &str, range: Range<usize>) -> Result<Expression, SyntaxError> {
        let (word, range) = self.of_parts(word, range);
        let word = &*word;
        if self.take('(') {
            let mut arguments = vec![self.argument()?];
            while self.take(',') {
                arguments.push(self.argument()?);
            }
            self.expect(')')?;
            let end = self.tokens[self.next - 1].range.end;
            return Ok(expression(Form::Call(word.to_owned(), arguments), range.start..end));
        }
        if self.take('.') {
            let member = self.here();
            let Some(name) = self.word_at(0) else {
                return Err(
                    fault("a member is missing here", member).advise("for example `R1.q`, `R1.v` or `B.x`")
                );
            };
            self.next += 1;
            return Ok(expression(Form::Member(word.to_owned(), name.to_owned()), range.start..member.end));
        }
        Ok(expression(Form::Name(word.to_owned()), range))
    }

    /// The name of a thing in a part has that of the part before it: `left.R1`.
    fn of_parts(&mut self, word: &str, range: Range<usize>) -> (String, Range<usize>) {
        let (mut whole, mut range) = (word.to_owned(), range);
        while let (Some('.'), Some(next)) = (self.mark_at(0), self.word_at(1)) {
            let joined = format!("{whole}.{next}");
            let end = self.tokens[self.next + 1].range.end;
            let is_close = end - range.start == joined.len();
            // Two points or a call can be nothing else, even of what does not exist.
            let goes_on =
                self.mark_at(2) == Some('(') || (self.mark_at(2) == Some('.') && self.word_at(3).is_some());
            if !is_close || !((self.is_name)(&joined) || goes_on) {
                break;
            }
            self.next += 2;
            (whole, range) = (joined, range.start..end);
        }
        (whole, range)
    }

    /// A value, or a comparison of two.
    fn argument(&mut self) -> Result<Expression, SyntaxError> {
        let left = self.sum()?;
        let Some(Kind::Relation(relation)) = self.peek().map(|token| &token.kind) else { return Ok(left) };
        self.next += 1;
        let right = self.sum()?;
        let range = left.range.start..right.range.end;
        Ok(expression(Form::Compare(*relation, Box::new([left, right])), range))
    }

    /// The pressure of a Rockwell number, if one is written.
    fn rockwell(&mut self, number: f64) -> Result<Option<f64>, SyntaxError> {
        let word = self.word_at(0).filter(|word| *word == "HRC");
        let Some(word) = word.filter(|word| !(self.is_name)(word)) else { return Ok(None) };
        let range = self.here();
        self.next += 1;
        let value = pressure(number).ok_or_else(|| {
            let [lowest, highest] = RANGE;
            let message =
                format!("{number} {word} is outside {lowest} to {highest} HRC, where steels are compared");
            SyntaxError { unit: true, ..fault(message, range) }.advise("write the hardness in HV, HB or GPa")
        })?;
        Ok(Some(value))
    }

    fn quantity(&mut self, number: f64, range: Range<usize>) -> Result<Expression, SyntaxError> {
        let first = self.next;
        if let Some(value) = self.rockwell(number)? {
            let end = self.tokens[first].range.end;
            let (dimension, turning) = (Dimension::of(-1, 1, -2), Turning::default());
            let form = Form::Number { value, dimension, turning, bare: false, hardness: true };
            return Ok(expression(form, range.start..end));
        }
        let unit = self.unit()?;
        let end = self.tokens[self.next - 1].range.end;
        let value = unit.to_si(number);
        if !value.is_finite() {
            return Err(fault("this is not a number that a computer can hold", range.start..end));
        }
        let form = Form::Number {
            value,
            dimension: unit.dimension,
            turning: unit.turning,
            bare: self.next == first,
            hardness: unit.hardness,
        };
        Ok(expression(form, range.start..end))
    }
}

fn binary(operator: Operator, left: Expression, right: Expression) -> Expression {
    let range = left.range.start..right.range.end;
    expression(Form::Binary(operator, Box::new(left), Box::new(right)), range)
}

fn no_value(range: Range<usize>) -> SyntaxError {
    fault("a value is missing here", range).advise("write a number, a quantity such as \"40 mm\", or a name")
}
