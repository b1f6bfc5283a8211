//! A shard's lives in its folder, and the lives of all shards as one. In: what became of each shard. Out: what would have become of
//! the study undivided, to the bit. Never knows how lives are lived.

use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use super::facts::LifeFacts;
use super::result::LifeResult;
use super::study::LifeStudy;
use crate::files::WriteError;
use crate::parts::{MergeError, Part, gather, write_part};
use crate::shard::Shard;

/// The file in the folder.
pub(crate) const NAME: &str = "life.shard";

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

impl Part for LifePart {
    const OF: &'static str = "a life";

    fn shard(&self) -> Shard {
        self.shard
    }

    fn command(&self) -> &str {
        &self.command
    }

    fn is_same(&self, other: &Self) -> bool {
        self.result == other.result
    }

    fn differs(&self, other: &Self) -> Option<&'static str> {
        self.result.differs(&other.result)
    }
}

impl LifePart {
    /// Of a study that was lived; nothing if it has no shard. `command` is that of the field.
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
        write_part(&folder.join(NAME), study, self)
    }
}

/// The facts and the result of a study, from the folders of all its shards, in any order; one may be given twice.
///
/// # Errors
/// [`MergeError`].
pub fn merge(folders: &[PathBuf]) -> Result<(LifeFacts, LifeResult), MergeError> {
    let file = |folder: &PathBuf| {
        let file = folder.join(NAME);
        let none = || MergeError::NoShard { place: folder.clone(), of: LifePart::OF, what: NAME };
        if file.exists() { Ok(file) } else { Err(none()) }
    };
    let files = folders.iter().map(file).collect::<Result<Vec<_>, _>>()?;
    let mut parts = gather::<LifePart>(&files)?.into_iter();
    let LifePart { facts, result, .. } = parts.next().ok_or(MergeError::Nothing)?;
    Ok((facts, parts.map(|part| part.result).fold(result, LifeResult::joined)))
}
