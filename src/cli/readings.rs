//! Reads inspections from a CSV file. In: file, names of two columns. Out: readings, and the line of each, for messages.
//! Never knows what readings are for.

use std::fs;
use std::path::Path;

use linkwear_codegen::diagnostic::nearest;
use linkwear_gamma::inspection::Reading;

use super::failure::Failure;

/// Readings and the line of the file each stands on.
pub struct Readings {
    pub readings: Vec<Reading>,
    pub lines: Vec<usize>,
}

/// Reads the columns `time` and `wear`. The first line that is not empty and no comment (`#`) has the names.
pub fn read(file: &Path, time: &str, wear: &str) -> Result<Readings, Failure> {
    let text = fs::read_to_string(file).map_err(|error| Failure::Read(file.to_path_buf(), error))?;
    let wrong = |line: Option<usize>, message: String, help: &str| Failure::Data {
        file: file.to_path_buf(),
        line,
        message,
        help: help.to_owned(),
    };
    // A byte order mark would hide in the first name.
    let text = text.trim_start_matches('\u{feff}');
    let mut rows = text
        .lines()
        .enumerate()
        .map(|(at, line)| (at + 1, line.trim()))
        .filter(|(_, line)| !line.is_empty() && !line.starts_with('#'));
    let Some((head, names)) = rows.next() else {
        return Err(wrong(
            None,
            "the file is empty".to_owned(),
            "write a line of column names, then one reading a line",
        ));
    };
    let names = cells(names);
    let place = |name: &str| {
        names.iter().position(|known| known == name).ok_or_else(|| {
            let help = match nearest(name, names.iter().map(String::as_str)) {
                Some(near) => format!("did you mean `{near}`?"),
                None => format!("there are: {}", names.join(", ")),
            };
            wrong(Some(head), format!("there is no column `{name}`"), &help)
        })
    };
    let columns = [(time, place(time)?), (wear, place(wear)?)];
    let (mut readings, mut lines) = (Vec::new(), Vec::new());
    for (line, row) in rows {
        let cells = cells(row);
        let mut values = [0.0; 2];
        for (value, (name, at)) in values.iter_mut().zip(columns) {
            let cell = cells.get(at).map_or("", String::as_str);
            *value = cell.parse().map_err(|_| {
                let message = format!("column `{name}` has `{cell}`, which is no number");
                wrong(Some(line), message, "write numbers with a decimal point, or leave the line out")
            })?;
        }
        readings.push(Reading { time: values[0], wear: values[1] });
        lines.push(line);
    }
    Ok(Readings { readings, lines })
}

/// Cells of a line: between commas, spaces and surrounding quotes taken off.
fn cells(line: &str) -> Vec<String> {
    line.split(',').map(|cell| cell.trim().trim_matches('"').to_owned()).collect()
}
