//! From tokens to an expression, by recursive descent; units by the rules at the top of [`super`].

use std::ops::Range;

use super::super::unit::{Unit, suggestion, unit};
use super::lex::{Kind, Token};
use super::{DEEPEST, Expression, Form, Operator, SyntaxError};

pub(super) fn parse(
    tokens: &[Token],
    length: usize,
    is_name: &dyn Fn(&str) -> bool,
) -> Result<Expression, SyntaxError> {
    let mut parser = Parser { tokens, next: 0, length, depth: 0, is_name, shadowed: Vec::new() };
    let mut whole = parser.sum()?;
    if let Some(token) = parser.peek() {
        let message = match &token.kind {
            Kind::Word(_) | Kind::Number(_) => "an operator is missing here",
            Kind::Mark(_) => "this does not belong here",
        };
        return Err(fault(message, token.range.clone()).advise("products need a `*`: `2*L1`, `L1*(L2 + L3)`"));
    }
    whole.shadowed = parser.shadowed;
    Ok(whole)
}

struct Parser<'a> {
    tokens: &'a [Token],
    next: usize,
    length: usize,
    depth: usize,
    is_name: &'a dyn Fn(&str) -> bool,
    shadowed: Vec<(String, Range<usize>)>,
}

fn fault(message: impl Into<String>, range: Range<usize>) -> SyntaxError {
    SyntaxError { message: message.into(), help: None, range, unit: false }
}

impl SyntaxError {
    fn advise(mut self, help: impl Into<String>) -> Self {
        self.help = Some(help.into());
        self
    }
}

fn expression(form: Form, range: Range<usize>) -> Expression {
    Expression { form, range, shadowed: Vec::new() }
}

impl<'a> Parser<'a> {
    fn peek(&self) -> Option<&'a Token> {
        self.tokens.get(self.next)
    }

    fn mark_at(&self, offset: usize) -> Option<char> {
        match self.tokens.get(self.next + offset)?.kind {
            Kind::Mark(mark) => Some(mark),
            _ => None,
        }
    }

    fn word_at(&self, offset: usize) -> Option<&'a str> {
        match &self.tokens.get(self.next + offset)?.kind {
            Kind::Word(word) => Some(word),
            _ => None,
        }
    }

    fn take(&mut self, mark: char) -> bool {
        let found = self.mark_at(0) == Some(mark);
        self.next += usize::from(found);
        found
    }

    /// Where the next token is, or the end of the text.
    fn here(&self) -> Range<usize> {
        self.peek().map_or(self.length..self.length, |token| token.range.clone())
    }

    fn expect(&mut self, mark: char) -> Result<(), SyntaxError> {
        if self.take(mark) { Ok(()) } else { Err(fault(format!("`{mark}` is missing here"), self.here())) }
    }

    fn deeper(&mut self) -> Result<(), SyntaxError> {
        self.depth += 1;
        if self.depth > DEEPEST {
            return Err(
                fault("the formula is nested too deep", self.here()).advise("split it into parameters")
            );
        }
        Ok(())
    }

    fn sum(&mut self) -> Result<Expression, SyntaxError> {
        self.deeper()?;
        let mut left = self.product()?;
        loop {
            let operator = match self.mark_at(0) {
                Some('+') => Operator::Add,
                Some('-') => Operator::Sub,
                _ => break,
            };
            self.next += 1;
            let right = self.product()?;
            left = binary(operator, left, right);
        }
        self.depth -= 1;
        Ok(left)
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
            self.deeper()?;
            let inner = self.factor();
            self.depth -= 1;
            return inner;
        }
        if self.take('-') {
            self.deeper()?;
            let inner = self.factor()?;
            self.depth -= 1;
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

    fn exponent(&mut self) -> Result<(i32, usize), SyntaxError> {
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
            return Err(fault("a value is missing here", range));
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
            Kind::Mark(_) => Err(fault("a value is missing here", range)),
        }
    }

    fn named(&mut self, word: &str, range: Range<usize>) -> Result<Expression, SyntaxError> {
        if self.take('(') {
            let mut arguments = vec![self.sum()?];
            while self.take(',') {
                arguments.push(self.sum()?);
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

    fn quantity(&mut self, number: f64, range: Range<usize>) -> Result<Expression, SyntaxError> {
        let first = self.next;
        let unit = self.unit()?;
        let end = self.tokens[self.next - 1].range.end;
        let value = unit.to_si(number);
        if !value.is_finite() {
            return Err(fault("this is not a number that a computer can hold", range.start..end));
        }
        let form = Form::Number { value, dimension: unit.dimension, bare: self.next == first };
        Ok(expression(form, range.start..end))
    }

    /// The unit behind a number, or none.
    fn unit(&mut self) -> Result<Unit, SyntaxError> {
        let start = self.next;
        let mut total = Unit::ONE;
        let mut below = false;
        // `10 1/s`: a 1 before a slash and a unit can be nothing else here.
        if matches!(self.peek().map(|token| &token.kind), Some(Kind::Number(one)) if *one == 1.0)
            && self.mark_at(1) == Some('/')
        {
            self.next += 1;
        } else if let Some(word) = self.word_at(0) {
            total = self.unit_symbol(word)?;
        } else if !(self.mark_at(0) == Some('/') && self.unit_word(1, true)) {
            return Ok(total);
        }
        loop {
            let factor = if self.word_at(0).is_some() {
                if below {
                    return Err(self.ambiguous(start));
                }
                let word = self.word_at(0).unwrap_or_default();
                self.unit_symbol(word)?
            } else if self.mark_at(0) == Some('*') && self.unit_word(1, true) {
                self.next += 1;
                let word = self.word_at(0).unwrap_or_default();
                below = false;
                self.unit_symbol(word)?
            } else if self.mark_at(0) == Some('/') && self.unit_word(1, false) {
                self.next += 1;
                below = true;
                let word = self.word_at(0).unwrap_or_default();
                if (self.is_name)(word) {
                    self.shadowed.push((word.to_owned(), self.here()));
                }
                let symbol = self.unit_symbol(word)?;
                self.raise(symbol, -1)?
            } else if let Some(denominator) = self.bracketed_units()? {
                below = true;
                self.raise(denominator, -1)?
            } else {
                return Ok(total);
            };
            total = total.times(factor).ok_or_else(|| self.overflow())?;
        }
    }

    /// Whether the token at `offset` continues a unit. `t` after an operator is always the time.
    fn unit_word(&self, offset: usize, names_win: bool) -> bool {
        let Some(word) = self.word_at(offset) else { return false };
        let is_used_otherwise = matches!(self.mark_at(offset + 1), Some('(' | '.'));
        unit(word).is_some() && word != "t" && !is_used_otherwise && !(names_win && (self.is_name)(word))
    }

    /// `/(m s)` behind a unit, if the bracket holds nothing but units.
    fn bracketed_units(&mut self) -> Result<Option<Unit>, SyntaxError> {
        // Two words in a row can be nothing but units; a single one may be a name.
        let two_words = self.word_at(3).is_some();
        if self.mark_at(0) != Some('/')
            || self.mark_at(1) != Some('(')
            || !(self.unit_word(2, true) || two_words && self.unit_word(2, false))
        {
            return Ok(None);
        }
        let start = self.next;
        self.next += 2;
        let mut total = Unit::ONE;
        while self.unit_word(0, false) {
            let word = self.word_at(0).unwrap_or_default();
            let factor = self.unit_symbol(word)?;
            total = total.times(factor).ok_or_else(|| self.overflow())?;
            if self.mark_at(0) == Some('*') {
                self.next += 1;
            }
        }
        if self.take(')') {
            return Ok(Some(total));
        }
        self.next = start;
        Ok(None)
    }

    /// The unit `word`, which is the next token, with its power.
    fn unit_symbol(&mut self, word: &str) -> Result<Unit, SyntaxError> {
        let range = self.here();
        let Some(symbol) = unit(word) else {
            return Err(self.unknown_unit(word, range));
        };
        self.next += 1;
        if self.take('^') {
            let (exponent, _) = self.exponent()?;
            return self.raise(symbol, exponent);
        }
        Ok(symbol)
    }

    fn raise(&self, unit: Unit, exponent: i32) -> Result<Unit, SyntaxError> {
        unit.to_power(exponent).ok_or_else(|| self.overflow())
    }

    fn overflow(&self) -> SyntaxError {
        let range = self.tokens.get(self.next - 1).map_or(0..0, |token| token.range.clone());
        SyntaxError { unit: true, ..fault("no quantity has such a power of a unit", range) }
    }

    fn unknown_unit(&self, word: &str, range: Range<usize>) -> SyntaxError {
        let after = matches!(self.mark_at(1), Some('(' | '.'));
        if (self.is_name)(word) || after {
            return fault(format!("an operator is missing before `{word}`"), range)
                .advise(format!("write `*{word}` for a product"));
        }
        let help = match suggestion(word) {
            Some(symbol) => format!("did you mean `{symbol}`?"),
            None => "units are m, g, s, N, J, W, Pa, Hz, rad with prefixes, and kg, t, min, h, deg, rpm, %"
                .to_owned(),
        };
        SyntaxError { unit: true, ..fault(format!("`{word}` is not a unit"), range) }.advise(help)
    }

    /// `kg/m s` from token `start` on: says both readings.
    fn ambiguous(&self, start: usize) -> SyntaxError {
        let text = |token: &Token| match &token.kind {
            Kind::Word(word) => word.clone(),
            Kind::Number(value) => value.to_string(),
            Kind::Mark(mark) => mark.to_string(),
        };
        let join = |tokens: &[Token]| {
            let mut joined = String::new();
            for token in tokens {
                let blank = matches!(token.kind, Kind::Word(_)) && joined.ends_with(char::is_alphanumeric);
                joined.push_str(if blank { " " } else { "" });
                joined.push_str(&text(token));
            }
            joined
        };
        let slash =
            (start..self.next).rev().find(|at| self.tokens[*at].kind == Kind::Mark('/')).unwrap_or(start);
        let above = join(&self.tokens[start..slash]);
        let below = join(&self.tokens[slash + 1..self.next]).replace(['(', ')'], "");
        let more = self.word_at(0).unwrap_or_default();
        let range = self.tokens[start].range.start..self.here().end;
        SyntaxError { unit: true, ..fault("a blank behind a `/` can be read in two ways", range) }
            .advise(format!("write `{above}/({below} {more})` or `{above} {more}/{below}`"))
    }
}

fn binary(operator: Operator, left: Expression, right: Expression) -> Expression {
    let range = left.range.start..right.range.end;
    expression(Form::Binary(operator, Box::new(left), Box::new(right)), range)
}
