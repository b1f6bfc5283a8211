//! A shard's rows in a file, and the rows of all shards as one study. In: what became of each shard. Out: what would have become of
//! the study undivided, to the bit. Never knows how rows are run.

use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use super::result::{Row, StudyFacts, StudyResult};
use super::run::Study;
use crate::files::WriteError;
use crate::parts::{MergeError, Part, gather, write_part};
use crate::shard::Shard;

/// What became of one shard, with all that the result of the study is told with.
#[derive(Clone, Debug, Deserialize, PartialEq, Serialize)]
pub struct StudyPart {
    /// Which one.
    pub shard: Shard,
    /// The command that makes a shard of this study, `{shard}` and `{out}` in the place of what differs; empty where none is known.
    pub command: String,
    /// What is told with the rows.
    pub facts: StudyFacts,
    /// The rows of its points.
    pub rows: Vec<Row>,
}

impl Part for StudyPart {
    const OF: &'static str = "a study";

    fn shard(&self) -> Shard {
        self.shard
    }

    fn command(&self) -> &str {
        &self.command
    }

    fn is_same(&self, other: &Self) -> bool {
        self.rows == other.rows
    }

    fn differs(&self, other: &Self) -> Option<&'static str> {
        (self.facts != other.facts).then_some("what is told of the study")
    }
}

impl StudyPart {
    /// Of a study that was run; nothing if it has no shard. `command` is that of the field.
    pub fn new(study: &Study<'_>, command: String, result: StudyResult) -> Option<Self> {
        let StudyResult { facts, rows } = result;
        study.shard.map(|shard| Self { shard, command, facts, rows })
    }

    /// Writes it to a file, whole or not at all, with what identifies its study.
    ///
    /// # Errors
    /// [`WriteError`].
    pub fn write(&self, file: &Path, study: &Study<'_>) -> Result<(), WriteError> {
        write_part(file, study.identity(None), self)
    }
}

/// A study from the files of all its shards, in any order; one may be given twice.
///
/// # Errors
/// [`MergeError`].
pub fn merge(files: &[PathBuf]) -> Result<StudyResult, MergeError> {
    let mut parts = gather::<StudyPart>(files)?.into_iter();
    let StudyPart { facts, mut rows, .. } = parts.next().ok_or(MergeError::Nothing)?;
    rows.extend(parts.flat_map(|part| part.rows));
    Ok(StudyResult { facts, rows })
}
