//! What a life has come to so far, in its folder: measurements and lives as they are finished. In: a folder. Out: those of an
//! earlier run. Never knows how lives are lived.

use std::collections::BTreeMap;
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};

use linkwear_runtime::life::FailureEvent;
use linkwear_runtime::wear::ContactMeasure;
use linkwear_runtime::{Orbit, RunWarning, Steadiness};
use serde::{Deserialize, Serialize};

use super::paths::LifePath;
use crate::files::{WriteError, claim_folder};
use crate::journal::{Identity, Journal, JournalError};

/// The file in the folder.
pub(crate) const NAME: &str = "life.journal";

/// The draws that a life belongs to: 0 for the life asked for, then those with shifted parameters.
pub(super) type Batch = u64;

/// Lives by their numbers.
pub(super) type KnownLives = BTreeMap<u64, FailureEvent>;

/// A measurement of the one source that makes the table or the mean path.
#[derive(Clone, Debug, Deserialize, PartialEq, Serialize)]
pub(super) struct Measurement {
    /// Wear of the joints it was asked for [m].
    pub wear: Vec<f64>,
    pub measured: Vec<ContactMeasure>,
    /// How steady the turns were, joint by joint.
    pub steadiness: Vec<Steadiness>,
    pub state: Option<Orbit>,
    /// All that was doubtful until then.
    pub warnings: Vec<RunWarning>,
}

#[derive(Debug, Deserialize, Serialize)]
#[serde(rename_all = "lowercase")]
enum Record {
    Measurement(Measurement),
    Life {
        batch: Batch,
        number: u64,
        end: FailureEvent,
    },
    /// Wear of a life asked for, before its end.
    Path {
        number: u64,
        path: LifePath,
    },
}

/// The journal of one life, locked.
#[derive(Debug)]
pub struct LifeJournal {
    kept: Journal<Record>,
    measurements: Vec<Measurement>,
    lives: BTreeMap<Batch, KnownLives>,
    paths: BTreeMap<u64, LifePath>,
    /// Whether no further measurement can be kept.
    is_blind: AtomicBool,
}

impl LifeJournal {
    /// The journal of a run that begins, in a folder that is new or empty.
    ///
    /// # Errors
    /// [`JournalError::Write`] if there is something in the folder, or it cannot be written.
    pub fn create(folder: &Path) -> Result<Self, JournalError> {
        claim_folder(folder)?;
        Ok(Self::with(Journal::create(folder.join(NAME))?, Vec::new()))
    }

    /// The journal of an earlier run, to go on with; a new one if the folder has none.
    ///
    /// # Errors
    /// [`JournalError::NoRun`], [`JournalError::InUse`], [`JournalError::Damaged`], [`JournalError::OtherVersion`],
    /// [`JournalError::Write`].
    pub fn resume(folder: &Path) -> Result<Self, JournalError> {
        match Journal::resume(&folder.join(NAME))? {
            Some((kept, records)) => Ok(Self::with(kept, records)),
            None => Self::create(folder).map_err(|error| match error {
                JournalError::Write(WriteError::Exists(folder)) => JournalError::NoRun(folder),
                error => error,
            }),
        }
    }

    fn with(kept: Journal<Record>, records: Vec<Record>) -> Self {
        let is_blind = AtomicBool::new(false);
        let (measurements, lives, paths) = Default::default();
        let mut journal = Self { kept, measurements, lives, paths, is_blind };
        for record in records {
            match record {
                Record::Measurement(measurement) => journal.measurements.push(measurement),
                Record::Life { batch, number, end } => {
                    journal.lives.entry(batch).or_default().insert(number, end);
                }
                Record::Path { number, path } => drop(journal.paths.insert(number, path)),
            }
        }
        journal
    }

    /// Says which run this is, in words for people and values that decide its numbers.
    ///
    /// # Errors
    /// [`JournalError::OtherRun`] with the first difference; [`JournalError::Write`].
    pub(super) fn begin(&self, run: Identity) -> Result<(), JournalError> {
        self.kept.begin(run)
    }

    /// The measurement that was made at this place, of these wears.
    pub(super) fn measurement(&self, index: usize, wear: &[f64]) -> Option<&Measurement> {
        let known = self.measurements.get(index)?;
        if known.wear == wear {
            return Some(known);
        }
        // A journal that is whole has never come here.
        self.kept.damaged(index);
        None
    }

    /// Random lives of the run before, up to the last one that it finished.
    pub fn random_lives(&self) -> u64 {
        self.lives(0).and_then(KnownLives::last_key_value).map_or(0, |(number, _)| number + 1)
    }

    /// Lives of a batch that are known.
    pub(super) fn lives(&self, batch: Batch) -> Option<&KnownLives> {
        self.lives.get(&batch)
    }

    /// Keeps a measurement. JSON has no infinities: one that does not come back as it is ends what is kept of its
    /// kind, for what follows could not be told apart.
    pub(super) fn keep_measurement(&self, measurement: Measurement) {
        let json = serde_json::to_vec(&measurement);
        let back = json.and_then(|json| serde_json::from_slice::<Measurement>(&json));
        if self.is_blind.load(Ordering::Relaxed) || !back.is_ok_and(|back| back == measurement) {
            self.is_blind.store(true, Ordering::Relaxed);
            return;
        }
        self.kept.keep([&Record::Measurement(measurement)]);
        self.kept.sync();
    }

    /// Wear of the lives that are known, by their numbers: of those only whose end is known too.
    pub(super) fn paths(&self) -> BTreeMap<u64, LifePath> {
        let has_ended = |number: &u64| self.lives(0).is_some_and(|lives| lives.contains_key(number));
        let known = self.paths.iter().filter(|(number, _)| has_ended(number));
        known.map(|(number, path)| (*number, path.clone())).collect()
    }

    /// Keeps lives that are finished, those of one call together on the disk, with their wear where it is followed.
    pub(super) fn keep_lives(&self, batch: Batch, paths: &[(u64, LifePath)], ends: &[(u64, FailureEvent)]) {
        let path = |(number, path): &(u64, LifePath)| Record::Path { number: *number, path: path.clone() };
        let life = |(number, end): &(u64, FailureEvent)| Record::Life { batch, number: *number, end: *end };
        self.kept.keep(&paths.iter().map(path).chain(ends.iter().map(life)).collect::<Vec<_>>());
    }

    /// Whether nothing more can be kept.
    pub(super) fn has_failed(&self) -> bool {
        self.kept.has_failed()
    }

    /// Why nothing more can be kept.
    pub(super) fn failure(&self) -> Option<JournalError> {
        self.kept.failure()
    }
}
