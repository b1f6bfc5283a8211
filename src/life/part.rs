//! A shard's lives in its folder, and the lives of all shards as one. In: what became of each shard. Out: what would have become of
//! the study undivided, to the bit. Never knows how lives are lived.

use std::collections::BTreeMap;
use std::io;
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};
use thiserror::Error;

use super::facts::LifeFacts;
use super::result::LifeResult;
use super::shard::Shard;
use super::study::LifeStudy;
use crate::files::{WriteError, write_whole};
use crate::journal::{Identity, JournalError, Read, line, same_run};

/// The file in the folder.
const NAME: &str = "life.shard";

/// What became of one shard, with all that the result of the study is told with.
#[derive(Clone, Debug, Deserialize, PartialEq, Serialize)]
pub struct LifePart {
    /// Which one.
    pub shard: Shard,
    /// Random lives of all shards.
    pub trajectories: u64,
    /// The command that makes a shard of this study, `{shard}` and `{out}` in the place of what differs; empty where none is known.
    pub command: String,
    /// What no life changes.
    pub facts: LifeFacts,
    /// What became of its lives.
    pub result: LifeResult,
}

/// Why shards cannot be put together.
#[derive(Debug, Error)]
pub enum MergeError {
    /// There is no shard in a folder.
    #[error("`{}` holds no shard of a life: there is no {NAME} in it", .0.display())]
    NoShard(PathBuf),
    /// The file of a shard cannot be used.
    #[error(transparent)]
    Journal(#[from] JournalError),
    /// Shards are missing.
    #[error("{} of {of} shards {} missing: {}", .missing.len(), if .missing.len() == 1 { "is" } else { "are" }, listed(.missing))]
    Missing {
        /// Their numbers.
        missing: Vec<u64>,
        /// How many there are.
        of: u64,
        /// The command that makes the first of them, if it is known.
        command: Option<String>,
    },
    /// Two folders have the same shard, or shards of the same study, that say different things.
    #[error("`{}` and `{}` are of one study and differ in {what}", .first.display(), .second.display())]
    Differ {
        /// One file.
        first: PathBuf,
        /// The other file.
        second: PathBuf,
        /// Where.
        what: String,
    },
    /// Nothing is given.
    #[error("there are no shards to merge")]
    Nothing,
}

impl LifePart {
    /// Of a study that was lived; nothing if it has no shard. `command` is that of [`Self::command`].
    pub fn new(study: &LifeStudy<'_>, command: String, result: LifeResult) -> Option<Self> {
        let trajectories = study.trajectories.count(result.coupling)?;
        Some(Self {
            shard: study.shard?,
            trajectories,
            command,
            facts: LifeFacts::new(study, result.coupling),
            result,
        })
    }

    /// Writes it into a folder, whole or not at all, with what identifies its study.
    ///
    /// # Errors
    /// [`WriteError`]; also if there is a number in it that does not come back as it is.
    pub fn write(&self, folder: &Path, study: &LifeStudy<'_>) -> Result<(), WriteError> {
        let whole = LifeStudy { shard: None, ..study.clone() };
        let mut study = whole.identity(self.result.coupling);
        study.insert("the number of random lives".to_owned(), self.trajectories.into());
        study.insert("the number of shards".to_owned(), self.shard.of.into());
        let path = folder.join(NAME);
        let wrong = |error| WriteError::of(&path)(io::Error::other(error));
        let json = serde_json::to_vec(self).map_err(wrong)?;
        if serde_json::from_slice::<Self>(&json).ok().as_ref() != Some(self) {
            return Err(WriteError::of(&path)(io::Error::other("a number in it is not finite")));
        }
        write_whole(&path, |file| {
            let run = line(file, &[0; 32], &crate::journal::Run { run: study })?;
            line(file, &run, self).map(drop)
        })
    }

    /// Reads what [`Self::write`] wrote, with what identifies the study.
    fn read(folder: &Path) -> Result<(PathBuf, Identity, Self), MergeError> {
        let path = folder.join(NAME);
        if !path.exists() {
            return Err(MergeError::NoShard(folder.to_path_buf()));
        }
        let Read { run, mut records, .. } = Read::<Self>::file(&path)?;
        match (run, records.pop()) {
            (Some(run), Some(part)) if records.is_empty() => Ok((path, run, part)),
            _ => Err(JournalError::Damaged { file: path, line: 2 }.into()),
        }
    }
}

/// The facts and the result of a study, from the folders of all its shards, in any order; one may be given twice.
///
/// # Errors
/// [`MergeError`].
pub fn merge(folders: &[PathBuf]) -> Result<(LifeFacts, LifeResult), MergeError> {
    let mut parts: BTreeMap<u64, (PathBuf, LifePart)> = BTreeMap::new();
    let mut known: Option<(PathBuf, Identity)> = None;
    for folder in folders {
        let (path, run, part) = LifePart::read(folder)?;
        match &known {
            Some((_, known)) => same_run(&path, &run, known)?,
            None => known = Some((path.clone(), run)),
        }
        match parts.get(&part.shard.index) {
            Some((first, before)) if before.result != part.result => {
                let what = format!("shard {}", part.shard);
                return Err(MergeError::Differ { first: first.clone(), second: path, what });
            }
            Some(_) => {}
            None => drop(parts.insert(part.shard.index, (path, part))),
        }
    }
    let (_, (first, base)) = parts.first_key_value().ok_or(MergeError::Nothing)?;
    let missing: Vec<u64> = (1..=base.shard.of).filter(|index| !parts.contains_key(index)).collect();
    if let Some(index) = missing.first() {
        let shard = Shard { index: *index, of: base.shard.of };
        let command = base.command.replace("{shard}", &shard.to_string());
        let command = command.replace("{out}", &format!("shard{index}"));
        let command = Some(command).filter(|command| !command.is_empty());
        return Err(MergeError::Missing { missing, of: base.shard.of, command });
    }
    for (path, part) in parts.values() {
        if let Some(what) = base.result.differs(&part.result) {
            return Err(MergeError::Differ {
                first: first.clone(),
                second: path.clone(),
                what: what.to_owned(),
            });
        }
    }
    let facts = base.facts.clone();
    let mut parts = parts.into_values().map(|(_, part)| part.result);
    let first = parts.next().ok_or(MergeError::Nothing)?;
    Ok((facts, parts.fold(first, LifeResult::joined)))
}

/// Numbers, those that follow each other as a range, the first of many.
fn listed(numbers: &[u64]) -> String {
    const SHOWN: usize = 10;
    let mut ranges: Vec<(u64, u64)> = Vec::new();
    for number in numbers {
        match ranges.last_mut() {
            Some((_, last)) if *last + 1 == *number => *last = *number,
            _ => ranges.push((*number, *number)),
        }
    }
    let said = |(first, last): &(u64, u64)| match last - first {
        0 => first.to_string(),
        _ => format!("{first} to {last}"),
    };
    let mut text = ranges.iter().take(SHOWN).map(said).collect::<Vec<_>>().join(", ");
    if ranges.len() > SHOWN {
        text.push_str(", ..");
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_listed_as_ranges() {
        assert_eq!(listed(&[3]), "3");
        assert_eq!(listed(&[1, 2, 3, 5, 7, 8]), "1 to 3, 5, 7 to 8");
        let odd: Vec<u64> = (0..20).map(|at| 2 * at + 1).collect();
        assert!(listed(&odd).ends_with("17, 19, .."), "{}", listed(&odd));
    }
}
