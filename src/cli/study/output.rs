//! What `study` says. In: rows. Out: one JSON object, or a page of text.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::path::Path;

use crate::number::number;
use crate::shard::Shard;
use crate::study::{Kind, PointError, Row, StudyResult};

use super::super::answer::Answer;
use super::super::answer::life::ShardAnswer;
use super::super::answer::study::StudyAnswer;
use super::super::failure::Failure;
use super::super::table::{plural, table};

/// Rows that are printed before long studies are thinned out.
const SHOWN: usize = 24;

/// The answer; none where nothing became of any point.
pub fn answer(result: &StudyResult, file: Option<&Path>) -> Result<Answer, Failure> {
    let failed = result.failed().count();
    if let Some((_, PointError { code, message, help })) = result.failed().next()
        && failed == result.rows.len()
    {
        let message = format!("nothing became of any of {failed} points; at the first: {message} [{code}]");
        return Err(Failure::empty_study(file, message, help));
    }
    Ok(Answer::new(to_text(result), StudyAnswer::new(result, None), Some(&result.facts.provenance)))
}

/// What is said of a shard.
pub fn of_shard(result: &StudyResult, shard: Shard, out: &Path) -> Answer {
    let rows = plural(result.rows.len() as u64, "point", "points");
    let failed = result.failed().count();
    let text = format!(
        "shard {shard} of {}: {rows}, {failed} failed, in {}; `linkwear merge` puts the parts of all shards together",
        result.facts.name,
        out.display()
    );
    let told = StudyAnswer::new(result, Some(ShardAnswer { index: shard.index, of: shard.of }));
    Answer::new(text, told, Some(&result.facts.provenance))
}

/// Where the rows are.
pub fn written(result: &StudyResult, out: &Path) -> String {
    let rows = plural(result.rows.len() as u64, "row", "rows");
    format!("\n{rows} of {} columns in {}", result.facts.columns.len(), out.display())
}

fn to_text(result: &StudyResult) -> String {
    let StudyResult { facts, rows } = result;
    let failed = result.failed().count();
    let points = plural(rows.len() as u64, "point", "points");
    let mut text = format!("{}: {points}", facts.name);
    if failed > 0 {
        let _ = write!(text, ", {failed} failed");
    }
    text.push_str("\n\n");
    let shown = |column: &Kind| *column != Kind::Error || failed > 0;
    let titles = facts.columns.iter().filter(|column| shown(&column.kind));
    let titles: Vec<String> = titles.map(|column| column.title()).collect();
    let cells = |row: &Row| {
        let numbers = row.numbers().map(cell);
        numbers.chain((failed > 0).then(|| row.code().to_owned())).collect::<Vec<_>>()
    };
    // The first and the last, and rows at equal distances.
    let kept = rows.len().min(SHOWN);
    let places = (0..kept).map(|at| at * (rows.len() - 1) / (kept - 1).max(1));
    let thinned: Vec<Vec<String>> = places.filter_map(|at| rows.get(at)).map(cells).collect();
    text.push_str(&table(&titles, &thinned));
    if rows.len() > kept {
        let _ = writeln!(text, "  {kept} of {} rows; --out FILE and --format json have all", rows.len());
    }
    let _ = write!(text, "\n{}", extremes(result));
    let remarks = remarks(result);
    if !remarks.is_empty() {
        let _ = write!(text, "\n{remarks}");
    }
    text
}

/// What failed and what is doubtful, a line each; nothing where all is well.
pub fn remarks(result: &StudyResult) -> String {
    let mut text = String::new();
    for (code, (count, message)) in faults(result) {
        let _ = writeln!(text, "failed at {}: {message} [{code}]", plural(count, "point", "points"));
    }
    let mut places: Vec<usize> = result.warnings().map(|(at, _)| at).collect();
    places.dedup();
    if let Some((at, first)) = result.warnings().next() {
        let points = plural(places.len() as u64, "point", "points");
        let _ = writeln!(text, "warning at {points}: row {}: {first}; --format json lists all", at + 1);
    }
    text
}

/// A number for people; a whole one without decimals.
fn cell(value: Option<f64>) -> String {
    match value {
        None => String::new(),
        Some(value) if value.fract() == 0.0 && value.abs() < 1e6 => value.to_string(),
        Some(value) => number(value),
    }
}

/// The smallest and the largest value of every result, and where.
fn extremes(result: &StudyResult) -> String {
    let columns = result.facts.columns.iter().filter(|column| column.kind != Kind::Error).enumerate();
    let of_kind = |kind: Kind| columns.clone().filter(move |(_, column)| column.kind == kind);
    let place = |row: &Row| {
        let named = of_kind(Kind::Parameter)
            .map(|(at, column)| format!("{} {}", column.name, cell(row.numbers().nth(at).flatten())));
        named.collect::<Vec<_>>().join(", ")
    };
    let line = |(at, column): (usize, &crate::study::StudyColumn)| {
        let values = || result.rows.iter().filter_map(|row| Some((row.numbers().nth(at)??, row)));
        let least = values().reduce(|a, b| if b.0 < a.0 { b } else { a })?;
        let most = values().reduce(|a, b| if b.0 > a.0 { b } else { a })?;
        let cells = [column.title(), cell(Some(least.0)), place(least.1), cell(Some(most.0)), place(most.1)];
        Some(cells.to_vec())
    };
    let lines: Vec<Vec<String>> = of_kind(Kind::Result).filter_map(line).collect();
    table(&["", "least", "at", "most", "at"], &lines)
}

/// Codes of the points that failed, how often, and what the first of each says.
fn faults(result: &StudyResult) -> BTreeMap<&str, (u64, &str)> {
    let mut faults: BTreeMap<&str, (u64, &str)> = BTreeMap::new();
    for (_, error) in result.failed() {
        faults.entry(&error.code).or_insert((0, &error.message)).0 += 1;
    }
    faults
}
