//! What a study has come to so far, in a file: rows as they are run. In: a path. Out: the rows of an earlier run.
//! Never knows how rows are run.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use super::result::Row;
use crate::files::WriteError;
use crate::journal::{Identity, Journal, JournalError, Read};

#[derive(Debug, Deserialize, Serialize)]
#[serde(rename_all = "lowercase")]
enum Record {
    Row {
        point: u64,
        row: Row,
    },
    /// All rows are there.
    End,
}

/// The journal of a study, locked.
#[derive(Debug)]
pub struct StudyJournal {
    kept: Journal<Record>,
    rows: BTreeMap<u64, Row>,
    is_finished: bool,
}

impl StudyJournal {
    /// The journal of a study that begins. One that is finished makes room; one that is not is left as it is.
    ///
    /// # Errors
    /// [`JournalError::Write`] if there is something else, or a study that can be gone on with; [`JournalError::InUse`].
    pub fn create(path: PathBuf) -> Result<Self, JournalError> {
        let exists = |path: PathBuf| JournalError::from(WriteError::Exists(path));
        match Read::<Record>::file(&path) {
            Ok(Read { records, .. }) if matches!(records.last(), Some(Record::End)) => {
                // Of a run that still holds it nothing is taken away.
                drop(Journal::<Record>::resume(&path)?);
                fs::remove_file(&path).map_err(WriteError::of(&path))?;
            }
            Err(_) if !path.exists() => {}
            _ => return Err(exists(path)),
        }
        Ok(Self { kept: Journal::create(path)?, rows: BTreeMap::new(), is_finished: false })
    }

    /// The journal of an earlier run, to go on with; a new one if there is none.
    ///
    /// # Errors
    /// [`JournalError::InUse`], [`JournalError::Damaged`], [`JournalError::OtherVersion`], [`JournalError::Write`].
    pub fn resume(path: &Path) -> Result<Self, JournalError> {
        let Some((kept, records)) = Journal::resume(path)? else { return Self::create(path.to_path_buf()) };
        let mut journal = Self { kept, rows: BTreeMap::new(), is_finished: false };
        for record in records {
            match record {
                Record::Row { point, row } => drop(journal.rows.insert(point, row)),
                Record::End => journal.is_finished = true,
            }
        }
        Ok(journal)
    }

    pub(super) fn begin(&self, study: Identity) -> Result<(), JournalError> {
        self.kept.begin(study)
    }

    /// Rows that are known.
    pub(super) fn rows(&self) -> &BTreeMap<u64, Row> {
        &self.rows
    }

    pub(super) fn keep(&self, point: u64, row: &Row) {
        self.kept.keep([&Record::Row { point, row: row.clone() }]);
    }

    /// Says that all rows are there.
    pub(super) fn finish(&self) {
        if !self.is_finished {
            self.kept.keep([&Record::End]);
        }
        self.kept.sync();
    }

    pub(super) fn has_failed(&self) -> bool {
        self.kept.has_failed()
    }

    pub(super) fn failure(&self) -> Option<JournalError> {
        self.kept.failure()
    }
}
