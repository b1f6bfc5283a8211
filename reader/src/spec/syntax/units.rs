//! The unit behind a number, by the rules at the top of [`super`].

use std::ops::Range;

use super::super::unit::{Unit, is_hardness, suggestion, unit};
use super::expression::{SyntaxError, fault};
use super::lex::{Kind, Token};
use super::parser::Parser;

impl Parser<'_> {
    /// The unit behind a number, or none.
    pub(super) fn unit(&mut self) -> Result<Unit, SyntaxError> {
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

    /// Whether the token at `offset` continues a unit. `t` after an operator is always the time, and a hardness stands alone.
    fn unit_word(&self, offset: usize, names_win: bool) -> bool {
        let Some(word) = self.word_at(offset) else { return false };
        let goes_on = word != "t" && !is_hardness(word) && !(names_win && (self.is_name)(word));
        let is_used_otherwise = matches!(self.mark_at(offset + 1), Some('(' | '.'));
        unit(word).is_some() && goes_on && !is_used_otherwise
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
            None => "units are m, g, s, N, J, W, Pa, Hz, rad with prefixes, and kg, t, min, h, deg, rpm, %; HB, HV \
                     and HRC for hardness"
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
            Kind::Relation(_) => String::new(),
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
