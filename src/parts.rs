//! What is left of each shard in a file of its own, and all of them together again. In: files of shards. Out: what is in them, in
//! their order. Never knows what a shard is of.

use std::collections::BTreeMap;
use std::io;
use std::path::{Path, PathBuf};

use serde::Serialize;
use serde::de::DeserializeOwned;
use thiserror::Error;

use crate::files::{WriteError, write_whole};
use crate::journal::{Identity, JournalError, Read, Run, line, same_run};
use crate::shard::Shard;

/// What one shard leaves, with all that the whole is told with.
pub(crate) trait Part: DeserializeOwned + PartialEq + Serialize {
    /// What is cut into shards, as a sentence names it.
    const OF: &'static str;

    /// Which one.
    fn shard(&self) -> Shard;

    /// The command that makes a shard, `{shard}` and `{out}` in the place of what differs; empty where none is known.
    fn command(&self) -> &str;

    /// Whether another part of the same number has come to the same.
    fn is_same(&self, other: &Self) -> bool;

    /// In what another part of the same whole differs although it may not; nothing if it is as it must be.
    fn differs(&self, other: &Self) -> Option<&'static str>;
}

/// Why shards cannot be put together.
#[derive(Debug, Error)]
pub enum MergeError {
    /// There is no shard in a folder or file.
    #[error("`{}` holds no shard of {of}: there is no {what} in it", .place.display())]
    NoShard {
        /// The folder or file.
        place: PathBuf,
        /// What it should be a shard of.
        of: &'static str,
        /// What is missing in it.
        what: &'static str,
    },
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
    /// Two places have the same shard, or shards of the same study, that say different things.
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

/// Writes a part, whole or not at all, with what identifies the whole; the number of shards is added to that.
///
/// # Errors
/// [`WriteError`]; also if there is a number in it that does not come back as it is.
pub(crate) fn write_part<P: Part>(path: &Path, mut whole: Identity, part: &P) -> Result<(), WriteError> {
    whole.insert("the number of shards".to_owned(), part.shard().of.into());
    let wrong = |error| WriteError::of(path)(io::Error::other(error));
    let json = serde_json::to_vec(part).map_err(wrong)?;
    if serde_json::from_slice::<P>(&json).ok().as_ref() != Some(part) {
        return Err(WriteError::of(path)(io::Error::other("a number in it is not finite")));
    }
    write_whole(path, |file| {
        let run = line(file, &[0; 32], &Run { run: whole })?;
        line(file, &run, part).map(drop)
    })
}

/// Reads what [`write_part`] wrote, with what identifies the whole.
fn read_part<P: Part>(path: &Path) -> Result<(Identity, P), JournalError> {
    let Read { run, mut records, .. } = Read::<P>::file(path)?;
    match (run, records.pop()) {
        (Some(run), Some(part)) if records.is_empty() => Ok((run, part)),
        _ => Err(JournalError::Damaged { file: path.to_path_buf(), line: 2 }),
    }
}

/// The parts in these files, which must be all of one whole, in any order; one may be given twice. In the order of the shards.
///
/// # Errors
/// [`MergeError`].
pub(crate) fn gather<P: Part>(files: &[PathBuf]) -> Result<Vec<P>, MergeError> {
    let mut parts: BTreeMap<u64, (&PathBuf, P)> = BTreeMap::new();
    let mut known: Option<Identity> = None;
    for path in files {
        let (run, part) = read_part::<P>(path)?;
        match &known {
            Some(known) => same_run(path, &run, known)?,
            None => known = Some(run),
        }
        let shard = part.shard();
        match parts.get(&shard.index) {
            Some((first, before)) if !before.is_same(&part) => {
                let what = format!("shard {shard}");
                return Err(MergeError::Differ { first: (*first).clone(), second: path.clone(), what });
            }
            Some(_) => {}
            None => drop(parts.insert(shard.index, (path, part))),
        }
    }
    let (_, (first, base)) = parts.first_key_value().ok_or(MergeError::Nothing)?;
    let of = base.shard().of;
    let missing: Vec<u64> = (1..=of).filter(|index| !parts.contains_key(index)).collect();
    if let Some(index) = missing.first() {
        let command = base.command().replace("{shard}", &Shard { index: *index, of }.to_string());
        let command = command.replace("{out}", &format!("shard{index}"));
        let command = Some(command).filter(|command| !command.is_empty());
        return Err(MergeError::Missing { missing, of, command });
    }
    for (path, part) in parts.values() {
        if let Some(what) = base.differs(part) {
            let (first, second) = ((*first).clone(), (*path).clone());
            return Err(MergeError::Differ { first, second, what: what.to_owned() });
        }
    }
    Ok(parts.into_values().map(|(_, part)| part).collect())
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
