//! Inputs of a mechanism from a CSV file: a column of time, a column with its unit for every input that is connected.
//! In: a table, the description. Out: [`SampledSignals`] in SI. Never knows how they are used.

use linkwear_codegen::diagnostic::nearest;
use linkwear_codegen::spec::{UnitSize, unit_size};
use linkwear_runtime::{Description, InputRole, ParameterInfo, SampledSignals, SetupError};

use crate::csv_table::{CsvError, CsvTable};

/// Reads the inputs; columns are called as in the output of `simulate`, `torque [N m]`, that of the time `t [s]`.
///
/// # Errors
/// [`CsvError`]: the file is no table, a column has no unit or one of another kind, or nothing has its name.
pub fn read_inputs(table: &CsvTable<'_>, description: &Description) -> Result<SampledSignals, CsvError> {
    let mut times = None;
    let mut columns = Vec::new();
    for (place, title) in table.header().iter().enumerate() {
        let (name, unit) = parts(title);
        let fault = |message: String, help: String| table.fault_in_header(message, &help);
        let in_si = |example: &str| {
            let unit = unit.ok_or_else(|| {
                let help = format!("write its unit into the header: `{name} [{example}]`");
                fault(format!("column `{title}` has no unit"), help)
            })?;
            // The SI unit of an input is written by the generator, so it reads back.
            let own = unit_size(example).unwrap_or(UnitSize::ONE);
            let given =
                unit_size(unit).filter(|given| given.dimension == own.dimension).ok_or_else(|| {
                    let help = format!("a unit of the same kind as {example} is needed");
                    fault(format!("column `{title}`: `{unit}` is no unit of `{name}`"), help)
                })?;
            let column = format!("column `{title}`");
            if let Some([message, help]) = own.turning.told_apart(given.turning, &column, (name, example)) {
                return Err(fault(message, help));
            }
            let values = table.numbers_at(place)?;
            Ok::<Vec<f64>, CsvError>(values.into_iter().map(|value| given.to_si(value)).collect())
        };
        if matches!(name, "t" | "time") {
            if times.replace(in_si("s")?).is_some() {
                return Err(fault("two columns give the time".to_owned(), "delete one of them".to_owned()));
            }
            continue;
        }
        let Some(input) = values(description).find(|input| matches_name(input, name)) else {
            let known: Vec<&str> = values(description).map(|input| &*input.name).collect();
            let help = match (nearest(name, known.iter().copied()), known.is_empty()) {
                (Some(near), _) => format!("did you mean `{near}`?"),
                (None, true) => "declare it in [inputs] of the mechanism's file".to_owned(),
                (None, false) => format!("the inputs are {}; delete other columns", known.join(", ")),
            };
            return Err(fault(format!("the mechanism has no input `{name}`"), help));
        };
        if columns.iter().any(|(known, _)| *known == *input.name) {
            let message = format!("two columns give the input `{}`", input.name);
            return Err(fault(message, "delete one of them".to_owned()));
        }
        columns.push((input.name.to_string(), in_si(&input.unit)?));
    }
    let Some(times) = times else {
        let help = "begin the header with `t [s]`".to_owned();
        return Err(table.fault_in_header("no column gives the time".to_owned(), &help));
    };
    let lines: Vec<usize> = table.lines().collect();
    SampledSignals::new(description, times, &columns).map_err(|error| {
        let line = match error {
            SetupError::Signals { row, .. } => lines.get(row - 1).copied(),
            _ => None,
        };
        table.fault_at(line, error.to_string(), "one row per instant, times rising")
    })
}

/// The inputs that a file can give; their rates follow.
fn values(description: &Description) -> impl Iterator<Item = &ParameterInfo> {
    description.input_infos().filter(|(_, role)| *role == InputRole::Value).map(|(info, _)| info)
}

/// `torque`, or `torque.u` as in the output of a run.
fn matches_name(input: &ParameterInfo, name: &str) -> bool {
    name.strip_suffix(".u").unwrap_or(name) == input.name
}

/// Name and unit of `torque [N m]`.
pub(crate) fn parts(title: &str) -> (&str, Option<&str>) {
    match title.strip_suffix(']').and_then(|rest| rest.rsplit_once('[')) {
        Some((name, unit)) => (name.trim(), Some(unit.trim())),
        None => (title.trim(), None),
    }
}
