//! The folder of `life --out`: `life.json`, `cycles.csv`, `lives.csv`, each whole or absent, the tables with what they are of; the
//! mechanism, so that the folder says all that it is of.

use std::fs::{create_dir_all, remove_file};
use std::io::{ErrorKind, Write as _};
use std::path::{Path, PathBuf};

use crate::files::{WriteError, folder_of, write_whole};
use crate::life::{LifeFacts, LifePart, LifeResult, LifeStudy};
use crate::mechanism::is_below;
use crate::provenance::Provenance;
use crate::table::{beside, write_table};
use linkwear_runtime::life::{CycleJoint, CycleRecord, FailureEvent};
use linkwear_runtime::{Cells, Table};
use serde_json::Value;

/// What is told.
pub const LIFE: &str = "life.json";
/// The mean path.
const CYCLES: &str = "cycles.csv";
/// The random lives.
pub const LIVES: &str = "lives.csv";
/// The column of their lengths, as it is titled.
pub const LIFE_OF_LIVES: &str = "life [cycles]";
/// The folder of the mechanism's file and of those that it names.
pub const SOURCES: &str = "mechanism";

/// Everything.
pub fn write(folder: &Path, facts: &LifeFacts, life: &LifeResult, answer: &Value) -> Result<(), WriteError> {
    let lives: Vec<_> = (0..).zip(life.lives.iter().copied()).collect();
    if lives.is_empty() {
        remove(folder, &[LIVES])?;
    }
    write_parts(folder, &life.names(), (&life.cycles, &lives), &facts.provenance)?;
    for (name, text) in facts.sources.iter().filter(|(name, _)| is_below(Path::new(name))) {
        let path = folder.join(SOURCES).join(name);
        let place = folder_of(&path);
        create_dir_all(place).map_err(WriteError::of(place))?;
        write_whole(&path, |file| file.write_all(text.as_bytes()))?;
    }
    write_whole(&folder.join(LIFE), |file| writeln!(file, "{answer:#}"))
}

/// A shard, which is told when all are together: what a run that stopped had left of its tables goes.
pub fn write_shard(folder: &Path, part: &LifePart, study: &LifeStudy<'_>) -> Result<(), WriteError> {
    remove(folder, &[CYCLES, LIVES])?;
    part.write(folder, study)
}

/// Tables that were told of fewer lives, where the finished run has none.
fn remove(folder: &Path, tables: &[&str]) -> Result<(), WriteError> {
    for table in tables.iter().map(|name| folder.join(name)) {
        for file in [beside(&table), table] {
            match remove_file(&file) {
                Err(error) if error.kind() != ErrorKind::NotFound => {
                    return Err(WriteError::of(&file)(error));
                }
                _ => {}
            }
        }
    }
    Ok(())
}

/// The cycles of the mean path, and the random lives by their numbers. Returns the file of the cycles.
pub fn write_parts(
    folder: &Path,
    names: &[String],
    (cycles, lives): (&[CycleRecord], &[(u64, FailureEvent)]),
    provenance: &Provenance,
) -> Result<PathBuf, WriteError> {
    let path = folder.join(CYCLES);
    write_table(&path, &cycles_table(names, cycles), Some(provenance))?;
    if !lives.is_empty() {
        let table = Table { exponents: false, ..Table::new(lives.len()) }
            .column("trajectory", "", Cells::counts(|row| lives[row].0))
            .column("life", "cycles", Cells::numbers(|row| lives[row].1.cycles))
            .column("whole cycles", "", Cells::counts(|row| lives[row].1.whole_cycles))
            .column("failed joint", "", Cells::names(|row| &names[lives[row].1.joint]));
        write_table(&folder.join(LIVES), &table, Some(provenance))?;
    }
    Ok(path)
}

/// The cycles of the mean path.
fn cycles_table<'a>(joints: &[String], cycles: &'a [CycleRecord]) -> Table<'a> {
    let mut table = Table { exponents: false, ..Table::new(cycles.len()) }
        .column("cycle", "", Cells::counts(|row| cycles[row].cycle))
        .column("used", "1", Cells::numbers(|row| cycles[row].used));
    for (joint, name) in joints.iter().enumerate() {
        for (at, column) in CycleJoint::columns().enumerate() {
            let value = move |row: usize| cycles[row].joints[joint].values().nth(at).unwrap_or(f64::NAN);
            table = table.column(format!("{name}.{}", column.symbol), column.unit, Cells::numbers(value));
        }
    }
    table
}
