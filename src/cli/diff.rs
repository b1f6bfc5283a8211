//! `diff`: what two results of one kind, or two mechanism files, have different, and by how much. In: two files. Out: the
//! differences, largest first; what the results are of before them. Never knows what the numbers mean.

mod arguments;
mod compare;
mod read;

use std::fmt::Write as _;

use super::answer::Answer;
use super::answer::diff::{DiffAnswer, DifferenceAnswer, MadeAnswer, PlaceAnswer};
use super::failure::Failure;
use super::table::{count, plural, short_table};
use crate::number::number;
pub use arguments::DiffArguments;
use compare::{Compared, Difference, compare};
use read::{Known, read};

pub fn run(arguments: &DiffArguments) -> Result<Answer, Failure> {
    let DiffArguments { a, b, tolerance } = arguments;
    let (one, other) = (read(a)?, read(b)?);
    if one.kind != other.kind {
        let message = format!(
            "`{}` is {}, `{}` is {}: these cannot be compared",
            a.display(),
            one.kind,
            b.display(),
            other.kind
        );
        return Err(Failure::usage(
            message,
            "give two results of one subcommand, two tables, or two mechanism files",
        ));
    }
    let compared = compare(&one, &other);
    let agrees = tolerance.map(|most| compared.agree(most));
    let mut answer = Answer::new(text(&one, &compared, *tolerance), told(&one, &compared, *tolerance), None);
    answer.disagrees = agrees == Some(false);
    Ok(answer)
}

fn text(one: &Known, compared: &Compared, tolerance: Option<f64>) -> String {
    let Compared { made, differences, only, keys, rows } = compared;
    let mut text = String::new();
    if !made.is_empty() {
        let rows = made.iter().map(|(key, [a, b])| vec![key.clone(), a.clone(), b.clone()]).collect();
        let _ = write!(text, "What they are of\n{}\n", short_table(&["", "A", "B"], rows));
    }
    let what = if one.is_table { "column" } else { "key" };
    let [many, of] = [format!("{what}s"), plural(*keys as u64, what, &format!("{what}s"))];
    let same = differences.is_empty() && only.iter().all(Vec::is_empty) && rows[0] == rows[1];
    if same {
        let in_rows = if one.is_table { format!(", {} rows", count(rows[0] as u64)) } else { String::new() };
        let _ = writeln!(text, "identical: {of}{in_rows}");
    }
    if rows[0] != rows[1] {
        let [a, b] = rows.map(|rows| count(rows as u64));
        let _ = writeln!(text, "A has {a} rows, B {b}: the first ones are compared\n");
    }
    if !differences.is_empty() {
        let _ = writeln!(text, "{} of {of} differ, the largest first", count(differences.len() as u64));
        let rows = differences.iter().map(row).collect();
        text.push_str(&short_table(&[what, "difference", "of its range", "A", "B", "at"], rows));
    }
    for (name, keys) in ["A", "B"].iter().zip(only) {
        if !keys.is_empty() {
            let _ = writeln!(text, "\nonly {name} has these {many}: {}", keys.join(", "));
        }
    }
    if let Some(most) = tolerance {
        let word = if compared.agree(most) { "agree" } else { "do not agree" };
        let _ = writeln!(text, "\nthey {word} within {} of each range", number(most));
    }
    text
}

fn row(difference: &Difference) -> Vec<String> {
    let Difference { key, largest, relative, values: [a, b], place } = difference;
    let shown = |value: &Option<f64>| value.map_or_else(String::new, number);
    let place = place.as_ref().map_or_else(String::new, |(place, at)| match at {
        Some((title, at)) => format!("{place}, {title} = {at}"),
        None => place.clone(),
    });
    vec![key.clone(), shown(largest), shown(relative), a.clone(), b.clone(), place]
}

fn told(one: &Known, compared: &Compared, tolerance: Option<f64>) -> DiffAnswer {
    let Compared { made, differences, only, keys, rows } = compared;
    let [only_in_a, only_in_b] = only.clone();
    DiffAnswer {
        kind: one.kind.clone(),
        identical: compared.agree(0.0) && differences.is_empty(),
        tolerance,
        agree: tolerance.map(|most| compared.agree(most)),
        keys: *keys,
        rows: one.is_table.then_some(*rows),
        made: made
            .iter()
            .map(|(key, [a, b])| MadeAnswer { key: key.clone(), a: a.clone(), b: b.clone() })
            .collect(),
        differences: differences
            .iter()
            .map(|Difference { key, largest, relative, values: [a, b], place }| DifferenceAnswer {
                key: key.clone(),
                largest: *largest,
                relative: *relative,
                a: a.clone(),
                b: b.clone(),
                place: place.as_ref().map(|(place, at)| PlaceAnswer {
                    key: place.clone(),
                    column: at.as_ref().map(|(title, _)| title.clone()),
                    value: at.as_ref().map(|(_, value)| value.clone()),
                }),
            })
            .collect(),
        only_in_a,
        only_in_b,
    }
}
