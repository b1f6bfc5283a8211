//! Functions given by rows: from the file itself or from a CSV file beside it. In: the file. Out: [`DataTable`]s with the dimensions
//! of argument and value.

use std::path::Path;
use std::sync::Arc;

use super::call::is_function;
use super::quantity::Allowed;
use super::resolver::Resolver;
use super::series::cells;
use super::tabled::{Counted, Tabled};
use crate::diagnostic::{Code, brief};
use crate::input::read_named;
use crate::limits;
use crate::model::DataTable;
use crate::spec::{
    At, Dimension, Literal, Name, Outside, Quantity, Table, TableSpec, Turning, UnitSize, unit_size,
};

/// Columns in SI with what they are of.
type Columns = [(Vec<f64>, Counted); 2];

impl Resolver<'_> {
    pub(super) fn resolve_tables(&mut self, written: &Table<TableSpec>) {
        self.lost_tables = written.0.iter().map(|(name, _)| name.value.clone()).collect();
        for (name, spec) in &written.0 {
            if !self.names.may_be(&name.value) {
                self.report(super::names::bad_name(name));
            } else if is_function(&name.value) {
                let message = format!("the name `{}` is reserved: it is a function of formulas", name.value);
                self.refuse(Code::ReservedName, name.span, message)
                    .help("choose another name for this table");
            }
            let Some(columns) = self.columns(name, spec) else { continue };
            if let Some(table) = self.table(name, spec, columns) {
                self.tables.push(table);
            }
        }
    }

    /// Whether a table of this name is there but was refused, or stands where no table can be called yet.
    pub(super) fn is_lost_table(&self, name: &str) -> bool {
        self.lost_tables.iter().any(|lost| lost == name)
    }

    fn columns(&mut self, name: &Name, spec: &At<TableSpec>) -> Option<Columns> {
        let own = &spec.value;
        match (&own.data, &own.argument, &own.value) {
            (Some(file), None, None) => self.read_columns(name, file),
            (Some(file), ..) => {
                let message = format!("table `{}` has rows of its own and a file of them", name.value);
                self.refuse(Code::ConflictingKeys, file.span, message)
                    .help("leave `data` out, or `argument` and `value`");
                None
            }
            (None, Some(argument), Some(value)) => {
                let argument = self.column(argument, &format!("`argument` of table `{}`", name.value));
                let value = self.column(value, &format!("`value` of table `{}`", name.value));
                Some([argument?, value?])
            }
            (None, ..) => {
                let message = format!("table `{}` has no rows", name.value);
                self.missing(spec.span, name.span, Code::MissingKey, message)
                    .help("add `argument = [..]` and `value = [..]`, or `data = \"rows.csv\"`");
                None
            }
        }
    }

    /// Quantities of one dimension; a bare zero has any.
    fn column(&mut self, list: &At<Vec<Quantity>>, what: &str) -> Option<(Vec<f64>, Counted)> {
        let mut expected: Option<Dimension> = None;
        let mut turning = Turning::default();
        let mut values = Vec::new();
        for quantity in &list.value {
            if matches!(quantity.value, Literal::Number(0.0)) {
                values.push(0.0);
                continue;
            }
            let formula = self.formula(quantity, expected, Allowed::CONSTANTS, what);
            let value = self.value(&formula);
            if !value.is_finite() {
                return None;
            }
            expected = Some(formula.dimension);
            turning = self.warn_turns_among(quantity, turning, what);
            values.push(value);
        }
        Some((values, Counted { dimension: expected.unwrap_or_default(), turning }))
    }

    fn read_columns(&mut self, name: &Name, file: &Name) -> Option<Columns> {
        let found = read_named(Path::new(&self.source.name), &file.value, self.reach, limits::DATA_BYTES);
        let read = found.map_err(|error| error.to_string()).and_then(|(path, text)| {
            self.attached.push(path);
            columns_of(&text)
        });
        read.map_err(|reason| {
            // The reason may quote the file, which need not be meant for who reads the message.
            let message = format!(
                "the rows `{}` of table `{}` cannot be used: {}",
                file.value,
                name.value,
                brief(&reason)
            );
            self.refuse(Code::BadTable, file.span, message).help(
                "a CSV file with the header `angle [deg], torque [N m]` and two columns, the argument first; its path is relative \
                 to this file, and leads out of its folder only with --allow-outside-data",
            );
        })
        .ok()
    }

    fn table(&mut self, name: &Name, spec: &At<TableSpec>, columns: Columns) -> Option<Tabled> {
        let own = &spec.value;
        let [(knots, argument), (values, value)] = columns;
        let outside = own.outside.as_ref().map_or_else(Default::default, |outside| outside.value);
        let how = own.interpolation.as_ref().map_or_else(Default::default, |how| how.value);
        let (first, last) = (values.first(), values.last());
        let fault = if knots.len() != values.len() {
            Some(format!("{} arguments have {} values", knots.len(), values.len()))
        } else if knots.len() < 2 {
            Some("fewer than two rows make no function".to_owned())
        } else if let Some(at) = knots.windows(2).position(|pair| pair[1] <= pair[0]) {
            Some(format!("arguments do not rise from row {} to row {}", at + 1, at + 2))
        } else if outside == Outside::Periodic && first != last {
            Some("a period ends with the value that it begins with".to_owned())
        } else {
            None
        };
        if let Some(reason) = fault {
            let message = format!("table `{}` is no function: {reason}", name.value);
            self.refuse(Code::BadTable, name.span, message)
                .help("give at least two rows with rising arguments, and one value for each");
            return None;
        }
        if let Some(fault) = limits::TABLE_ROWS.broken_by(knots.len()) {
            self.report(fault.at(name.span, ""));
            return None;
        }
        let table = DataTable::new(&name.value, (knots, &values), how, outside);
        if table.pieces.iter().flatten().any(|number| !number.is_finite()) {
            let message = format!("table `{}` rises too steeply for numbers", name.value);
            self.refuse(Code::BadTable, name.span, message).help("check the arguments: two nearly coincide");
            return None;
        }
        Some(Tabled { table: Arc::new(table), argument, value })
    }
}

/// Both columns of a CSV file.
fn columns_of(text: &str) -> Result<Columns, String> {
    let lines = text.lines().enumerate().map(|(at, line)| (at + 1, line.trim()));
    let mut lines = lines.filter(|(_, line)| !line.is_empty() && !line.starts_with('#'));
    let (_, header) = lines.next().ok_or("it is empty")?;
    let titles: Vec<&str> = cells(header).collect();
    let [argument, value] = titles[..] else {
        return Err(format!("it has {} columns, not two", titles.len()));
    };
    let units = [argument, value].map(|title| {
        let (_, unit) =
            title.strip_suffix(']').and_then(|rest| rest.rsplit_once('[')).unwrap_or((title, "1"));
        unit_size(unit.trim()).ok_or_else(|| format!("`{}` of column `{title}` is no unit", unit.trim()))
    });
    let [argument, value] = units;
    let units = [argument?, value?];
    let mut columns =
        units.map(|UnitSize { dimension, turning, .. }| (Vec::new(), Counted { dimension, turning }));
    for (line, row) in lines {
        let cells: Vec<&str> = cells(row).collect();
        if cells.len() != 2 {
            return Err(format!("line {line} has {} cells, not two", cells.len()));
        }
        for ((column, unit), cell) in columns.iter_mut().zip(units).zip(cells) {
            let number = cell.parse::<f64>().ok().map(|number| unit.to_si(number));
            let number = number.filter(|number| number.is_finite());
            column.0.push(number.ok_or_else(|| format!("line {line} has a cell that is no number"))?);
        }
        if columns[0].0.len() > limits::TABLE_ROWS.most {
            return Err(format!("it has more than {} rows", limits::TABLE_ROWS.most));
        }
    }
    Ok(columns)
}
