//! `[repeat.<name>]`: copies of a group with `{i}`, `{i+1}` replaced in names and texts.
//! In: [`File`] and the number of cells of each group. Out: a [`File`] without groups. Places stay those of the
//! one text that all copies come from.

use std::collections::HashMap;

use super::file::{CellValues, File, RepeatSpec};
use super::syntax::{Form, Operator, parse_expression};
use super::texts::Texts as _;
use super::written::{At, Literal, Name, Quantity, Table};
use crate::diagnostic::{Code, Diagnostic};
use crate::limits;
use crate::source::Span;

/// Makes the cells of every group; `count_of` evaluates `count` and reports if it cannot.
pub fn expand(file: &File, count_of: &mut dyn FnMut(&Quantity) -> Option<f64>) -> (File, Vec<Diagnostic>) {
    let mut whole = file.clone();
    let mut problems = Vec::new();
    for (name, group) in std::mem::take(&mut whole.repeat).0 {
        let Some(count) = count(&name, &group.value, count_of, &mut problems) else { continue };
        let copies = [
            (limits::BODIES, group.value.bodies.0.len()),
            (limits::ELEMENTS, group.value.points.0.len()),
            (limits::ELEMENTS, group.value.joints.0.len()),
            (limits::ELEMENTS, group.value.couplings.0.len()),
            (limits::ELEMENTS, group.value.stops.0.len()),
            (limits::ELEMENTS, group.value.forces.0.len()),
            (limits::ELEMENTS, group.value.states.0.len()),
            (limits::ELEMENTS, group.value.sensors.0.len()),
            (limits::ELEMENTS, group.value.controllers.0.len()),
        ];
        let times = usize::try_from(count).unwrap_or(usize::MAX);
        let broken = copies.iter().find_map(|(limit, own)| limit.broken_by(times.saturating_mul(*own)));
        if let Some(fault) = broken {
            problems.push(fault.at(name.span, format!("{count} cells of this group")));
            continue;
        }
        let index = group.value.index.clone().map_or("i".to_owned(), |index| index.value);
        if !values_fit(&name.value, &group.value.values, &index, times, &mut problems) {
            continue;
        }
        let first = group.value.first.as_ref().map_or(1, |first| first.value);
        let mut made = Made { group: &name.value, by_name: HashMap::new(), problems: &mut problems };
        for cell in first..first.saturating_add(count) {
            let before = made.problems.len();
            let mut copy = group.value.clone();
            let at = usize::try_from(cell - first).unwrap_or_default();
            let mut at = Cell { index: &index, number: cell, values: Vec::new(), at };
            at.take_values(std::mem::take(&mut copy.values), made.problems);
            copy.each(Span::default(), &mut |text, span| at.substitute(text, span, made.problems));
            if made.problems.len() > before {
                break;
            }
            made.append(&mut whole.points, copy.points, cell, "point");
            made.append(&mut whole.bodies, copy.bodies, cell, "body");
            made.append(&mut whole.joints, copy.joints, cell, "joint");
            made.append(&mut whole.couplings, copy.couplings, cell, "coupling");
            made.append(&mut whole.stops, copy.stops, cell, "stop");
            made.append(&mut whole.forces, copy.forces, cell, "force");
            made.append(&mut whole.states, copy.states, cell, "state");
            made.append(&mut whole.sensors, copy.sensors, cell, "sensor");
            made.append(&mut whole.controllers, copy.controllers, cell, "controller");
            made.append(&mut whole.assembly, copy.assembly, cell, "guess");
            made.append(&mut whole.initial, copy.initial, cell, "start value");
        }
    }
    (whole, problems)
}

/// The places of all texts of all groups: faults there come once per cell.
pub fn group_spans(file: &File) -> Vec<Span> {
    let spans = file.repeat.0.iter().map(|(_, group)| {
        let mut whole: Option<Span> = None;
        group.value.clone().each(Span::default(), &mut |_, span| {
            whole = Some(
                whole.map_or(span, |w| Span { start: w.start.min(span.start), end: w.end.max(span.end) }),
            );
        });
        whole.unwrap_or_default()
    });
    spans.collect()
}

fn count(
    name: &Name,
    group: &RepeatSpec,
    count_of: &mut dyn FnMut(&Quantity) -> Option<f64>,
    problems: &mut Vec<Diagnostic>,
) -> Option<i64> {
    let Some(written) = &group.count else {
        problems.push(
            Diagnostic::new(
                Code::MissingKey,
                format!("the group `{}` does not say how many cells it has", name.value),
            )
            .at(name.span, "")
            .help("add `count = 3`"),
        );
        return None;
    };
    let count = count_of(written)?;
    let most = limits::CELLS.most;
    if count.fract() != 0.0 || !(1.0..=most as f64).contains(&count) {
        problems.push(
            Diagnostic::new(Code::BadRepeat, format!("`count` of group `{}` is {count}", name.value))
                .at(written.span, format!("a whole number from 1 to {most} is needed")),
        );
        return None;
    }
    #[allow(clippy::cast_possible_truncation, reason = "a whole number up to limits::CELLS")]
    Some(count as i64)
}

struct Made<'a> {
    group: &'a str,
    by_name: HashMap<(&'static str, String), i64>,
    problems: &'a mut Vec<Diagnostic>,
}

impl Made<'_> {
    fn append<T>(&mut self, table: &mut Table<T>, cells: Table<T>, cell: i64, what: &'static str) {
        for (name, value) in cells.0 {
            let earlier = self.by_name.insert((what, name.value.clone()), cell);
            match earlier {
                Some(earlier) if earlier != cell => {
                    let reported =
                        |d: &Diagnostic| d.code == Code::RepeatCollision && d.span() == Some(name.span);
                    if !self.problems.iter().any(reported) {
                        self.problems.push(collision(self.group, what, &name, earlier, cell));
                    }
                }
                _ => table.0.push((name, value)),
            }
        }
    }
}

fn collision(group: &str, what: &str, name: &Name, earlier: i64, cell: i64) -> Diagnostic {
    let message =
        format!("cells {earlier} and {cell} of group `{group}` both make the {what} `{}`", name.value);
    Diagnostic::new(Code::RepeatCollision, message).at(name.span, "").help(
        "put the index into the name, for example `\"bar{i}\"`, or move what is common out of the group",
    )
}

/// What braces stand for in one cell.
struct Cell<'a> {
    index: &'a str,
    number: i64,
    /// Names and texts of the cell's own quantities.
    values: Vec<(String, String)>,
    /// Which cell it is, from 0.
    at: usize,
}

impl Cell<'_> {
    /// The cell's own quantities; in a formula for all cells braces hold the index.
    fn take_values(&mut self, values: Table<CellValues>, problems: &mut Vec<Diagnostic>) {
        for (name, At { value, .. }) in values.0 {
            let mut found = match value {
                CellValues::Shared(quantity) => quantity,
                CellValues::Each(list) => list.value[self.at].clone(),
            };
            found.value.each(found.span, &mut |text, span| self.substitute(text, span, problems));
            let text = match found.value {
                Literal::Number(value) => format!("{value:?}"),
                Literal::Text(text) => text,
            };
            self.values.push((name.value, text));
        }
    }

    /// Replaces `{...}` in `text` by numbers and by the cell's own quantities.
    fn substitute(&self, text: &mut String, span: Span, problems: &mut Vec<Diagnostic>) {
        let mut result = String::with_capacity(text.len());
        let mut rest = text.as_str();
        while let Some((before, after)) = rest.split_once('{') {
            let found = after.split_once('}').and_then(|(inner, after)| Some((self.meaning(inner)?, after)));
            let Some((value, after)) = found else {
                let message =
                    format!("the braces in \"{text}\" hold no whole number and no value of the group");
                let known = self.values.iter().map(|(name, _)| format!("`{{{name}}}`"));
                let known: Vec<String> =
                    [format!("`{{{0}}}` or `{{{0}+1}}`", self.index)].into_iter().chain(known).collect();
                problems.push(Diagnostic::new(Code::BadRepeat, message).at(span, "").help(format!(
                    "braces hold the index and whole numbers, or one of `values`; for example {}",
                    known.join(", ")
                )));
                return;
            };
            // Alone it is the quantity itself, within a formula a factor or a summand.
            let is_alone = before.is_empty() && after.is_empty() && result.is_empty();
            result.push_str(before);
            match value {
                Ok(number) => result.push_str(&number.to_string()),
                Err(quantity) if is_alone => result.push_str(quantity),
                Err(quantity) => result.push_str(&format!("({quantity})")),
            }
            rest = after;
        }
        result.push_str(rest);
        *text = result;
    }

    /// A whole number, or the text of a quantity.
    fn meaning(&self, inner: &str) -> Option<Result<i64, &str>> {
        let own = self.values.iter().find(|(name, _)| name == inner.trim());
        own.map(|(_, text)| Err(text.as_str())).or_else(|| number(inner, self.index, self.number).map(Ok))
    }
}

/// Whether every list of values has one for each cell, under a name of its own.
fn values_fit(
    group: &str,
    values: &Table<CellValues>,
    index: &str,
    count: usize,
    problems: &mut Vec<Diagnostic>,
) -> bool {
    let before = problems.len();
    for (name, value) in &values.0 {
        if name.value == index {
            let message = format!("the value `{index}` of group `{group}` has the name of the index");
            let fault = Diagnostic::new(Code::BadRepeat, message).at(name.span, "");
            problems.push(fault.help("give it another name, or the index: `index = \"k\"`"));
        }
        let CellValues::Each(list) = &value.value else { continue };
        if list.value.len() != count {
            let found = list.value.len();
            let message = format!("`{}` of group `{group}` has {found} values for {count} cells", name.value);
            let fault = Diagnostic::new(Code::BadRepeat, message).at(list.span, "");
            problems.push(
                fault.help("give one for each cell, or one formula with the index, such as \"{i}*10 mm\""),
            );
        }
    }
    problems.len() == before
}

fn number(inner: &str, index: &str, cell: i64) -> Option<i64> {
    fn value(form: &Form, index: &str, cell: i64) -> Option<i64> {
        match form {
            #[allow(clippy::cast_possible_truncation, reason = "checked to be a small whole number")]
            Form::Number { value, bare: true, .. } if value.fract() == 0.0 && value.abs() < 1e9 => {
                Some(*value as i64)
            }
            Form::Name(name) if name == index => Some(cell),
            Form::Neg(a) => Some(-value(&a.form, index, cell)?),
            Form::Binary(operator, a, b) => {
                let (a, b) = (value(&a.form, index, cell)?, value(&b.form, index, cell)?);
                match operator {
                    Operator::Add => a.checked_add(b),
                    Operator::Sub => a.checked_sub(b),
                    Operator::Mul => a.checked_mul(b),
                    Operator::Div => None,
                }
            }
            _ => None,
        }
    }
    value(&parse_expression(inner, &|name| name == index).ok()?.form, index, cell)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn braces_hold_whole_number_arithmetic_on_the_index() {
        assert_eq!(number("i", "i", 7), Some(7));
        assert_eq!(number("2*i - 1", "i", 7), Some(13));
        assert_eq!(number("i+1", "i", -1), Some(0));
        for wrong in ["", "j", "i/2", "0.5", "i+", "2 mm"] {
            assert_eq!(number(wrong, "i", 1), None, "{wrong}");
        }
    }

    #[test]
    fn several_braces_in_one_text_are_all_replaced() {
        let values = vec![("L".to_owned(), "2 m - d".to_owned())];
        let cell = Cell { index: "i", number: 3, values, at: 0 };
        for (text, made) in
            [("B{i}.x - B{i-1}.x", "B3.x - B2.x"), ("{L}", "2 m - d"), ("2*{L}", "2*(2 m - d)")]
        {
            let mut found = text.to_owned();
            cell.substitute(&mut found, Span::default(), &mut Vec::new());
            assert_eq!(found, made);
        }
    }
}
