//! What a life has come to so far, in a file, so that a run that was killed goes on with the same bits.
//! In: a folder, what identifies the run, measurements and lives as they are finished. Out: those of an earlier run.
//! Never knows how lives are lived.
//!
//! One line for each record: 16 hexadecimal digits of a checksum, a space, JSON. The checksum is the SHA-256 of the
//! one before and the JSON, so that no line can be changed, lost or moved. A kill leaves at most a last line without
//! its end, which is cut off; anything else that does not fit is damage. The lock is the system's: it ends with its
//! process, however that ends.

use std::collections::BTreeMap;
use std::fs::{self, File, OpenOptions, TryLockError};
use std::io::{self, BufRead as _, BufReader, Seek as _, SeekFrom, Write as _};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use hmac_sha256::Hash;
use linkwear_runtime::life::FailureEvent;
use linkwear_runtime::wear::ContactMeasure;
use linkwear_runtime::{RunWarning, Steadiness, TurnState};
use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};
use thiserror::Error;

use crate::files::{WriteError, claim_folder, sync_folder};
use crate::mechanism::Mechanism;

/// The file in the folder.
const NAME: &str = "life.journal";
/// Lives are put on the disk this often, so that a power failure costs no more. A kill costs nothing.
const SYNC_EVERY: Duration = Duration::from_secs(1);
/// Bytes of a checksum that are written: chance agrees with them once in 2^64.
const CHECKSUM: usize = 8;

/// Why a journal cannot be used.
#[derive(Debug, Error)]
pub enum JournalError {
    /// It cannot be written or read, or its folder is not free.
    #[error(transparent)]
    Write(#[from] WriteError),
    /// Another process is living in the folder.
    #[error("another run is writing to `{}`", .0.display())]
    InUse(PathBuf),
    /// It was changed after it was written.
    #[error("line {line} of `{}` is damaged: it is not what was written", .file.display())]
    Damaged {
        /// The journal.
        file: PathBuf,
        /// The line, from 1.
        line: u64,
    },
    /// It is whole, but another version of the program wrote it.
    #[error("`{}` is of another version of linkwear{}: this one does not write lines such as line {line}", .file.display(), named(.version.as_deref()))]
    OtherVersion {
        /// The journal.
        file: PathBuf,
        /// The line, from 1.
        line: u64,
        /// The version, if a line before says it.
        version: Option<String>,
    },
    /// It is of a run that differs in what decides its numbers.
    #[error("`{}` is of another run: {what} is {is} now, and was {was}", .file.display())]
    OtherRun {
        /// The journal.
        file: PathBuf,
        /// What differs.
        what: String,
        /// Then.
        was: String,
        /// Now.
        is: String,
    },
}

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
    pub state: Option<TurnState>,
    /// All that was doubtful until then.
    pub warnings: Vec<RunWarning>,
}

#[derive(Deserialize, Serialize)]
#[serde(rename_all = "lowercase")]
enum Record {
    /// What identifies the run.
    Run(Map<String, Value>),
    Measurement(Measurement),
    Life {
        batch: Batch,
        number: u64,
        end: FailureEvent,
    },
}

/// The journal of one run, locked.
#[derive(Debug)]
pub struct Journal {
    path: PathBuf,
    run: Mutex<Option<Map<String, Value>>>,
    measurements: Vec<Measurement>,
    lives: BTreeMap<Batch, KnownLives>,
    writer: Mutex<Writer>,
    /// Whether an earlier process began it: then it is never removed.
    is_earlier: bool,
}

#[derive(Debug)]
struct Writer {
    file: File,
    checksum: [u8; 32],
    length: u64,
    /// Records besides what identifies the run.
    records: u64,
    /// Whether no further measurement can be kept.
    is_blind: bool,
    synced: Instant,
    /// The first thing that went wrong; nothing is written after it.
    failure: Option<JournalError>,
}

impl Journal {
    /// The journal of a run that begins, in a folder that is new or empty.
    ///
    /// # Errors
    /// [`JournalError::Write`] if there is something in the folder, or it cannot be written.
    pub fn create(folder: &Path) -> Result<Self, JournalError> {
        claim_folder(folder)?;
        let path = folder.join(NAME);
        let file = OpenOptions::new().read(true).write(true).create_new(true).open(&path);
        let file = file.map_err(WriteError::of(&path))?;
        let journal = Self::locked(path, file)?;
        sync_folder(folder)?;
        Ok(journal)
    }

    /// The journal of an earlier run, to go on with; a new one if the folder has none.
    ///
    /// # Errors
    /// [`JournalError::InUse`], [`JournalError::Damaged`], [`JournalError::Write`].
    pub fn resume(folder: &Path) -> Result<Self, JournalError> {
        let path = folder.join(NAME);
        let wrong = WriteError::of;
        match fs::metadata(&path) {
            Err(error) if error.kind() == io::ErrorKind::NotFound => return Self::create(folder),
            Err(error) => return Err(wrong(&path)(error).into()),
            Ok(found) if !found.is_file() => {
                return Err(wrong(&path)(io::Error::other("it is no regular file")).into());
            }
            Ok(_) => {}
        }
        let file = OpenOptions::new().read(true).write(true).open(&path).map_err(wrong(&path))?;
        let mut journal = Self::locked(path, file)?;
        journal.is_earlier = true;
        journal.read()?;
        Ok(journal)
    }

    fn locked(path: PathBuf, file: File) -> Result<Self, JournalError> {
        match file.try_lock() {
            Err(TryLockError::WouldBlock) => return Err(JournalError::InUse(path)),
            // A file system without locks: the user sees to it.
            Err(TryLockError::Error(error)) if error.kind() == io::ErrorKind::Unsupported => {}
            Err(TryLockError::Error(error)) => return Err(WriteError::of(&path)(error).into()),
            Ok(()) => {}
        }
        let writer = Writer {
            file,
            checksum: [0; 32],
            length: 0,
            records: 0,
            is_blind: false,
            synced: Instant::now(),
            failure: None,
        };
        Ok(Self {
            path,
            run: Mutex::new(None),
            measurements: Vec::new(),
            lives: BTreeMap::new(),
            writer: Mutex::new(writer),
            is_earlier: false,
        })
    }

    /// Takes what is there, and cuts off a line that a kill left without its end.
    fn read(&mut self) -> Result<(), JournalError> {
        let path = self.path.clone();
        let wrong = || WriteError::of(&path);
        let writer = self.writer.get_mut().unwrap_or_else(PoisonError::into_inner);
        let mut input = BufReader::new(&writer.file);
        let (mut line, mut bytes) = (0, Vec::new());
        while input.read_until(b'\n', &mut bytes).map_err(wrong())? > 0 && bytes.last() == Some(&b'\n') {
            line += 1;
            let damaged = || JournalError::Damaged { file: path.clone(), line };
            let text = &bytes[..bytes.len() - 1];
            let (digits, json) = text.split_at_checked(2 * CHECKSUM).ok_or_else(damaged)?;
            let json = json.strip_prefix(b" ").ok_or_else(damaged)?;
            let checksum = chained(&writer.checksum, json);
            if digits != hexadecimal(&checksum[..CHECKSUM]).as_bytes() {
                return Err(damaged());
            }
            // Damage does not pass the checksum.
            let other_version = |_| {
                let run = self.run.lock().unwrap_or_else(PoisonError::into_inner);
                let version = run.as_ref().and_then(|run| run.get(Mechanism::VERSION_KEY)).map(said);
                JournalError::OtherVersion { file: path.clone(), line, version }
            };
            match serde_json::from_slice(json).map_err(other_version)? {
                Record::Run(run) => *self.run.get_mut().unwrap_or_else(PoisonError::into_inner) = Some(run),
                Record::Measurement(measurement) => self.measurements.push(measurement),
                Record::Life { batch, number, end } => {
                    self.lives.entry(batch).or_default().insert(number, end);
                }
            }
            (writer.checksum, writer.length) = (checksum, writer.length + bytes.len() as u64);
            bytes.clear();
        }
        writer.records = line;
        writer.file.set_len(writer.length).map_err(wrong())?;
        writer.file.seek(SeekFrom::End(0)).map_err(wrong())?;
        Ok(())
    }

    /// Says which run this is, in words for people and values that decide its numbers.
    ///
    /// # Errors
    /// [`JournalError::OtherRun`] with the first difference; [`JournalError::Write`].
    pub(super) fn begin(&self, run: Map<String, Value>) -> Result<(), JournalError> {
        let mut known = self.run.lock().unwrap_or_else(PoisonError::into_inner);
        let Some(before) = &*known else {
            self.write([Record::Run(run.clone())]);
            *known = Some(run);
            return self.failure().map_or(Ok(()), Err);
        };
        let other = |(what, is): (&String, &Value)| {
            let was = before.get(what).unwrap_or(&Value::Null);
            (was != is).then(|| JournalError::OtherRun {
                file: self.path.clone(),
                what: what.clone(),
                was: said(was),
                is: said(is),
            })
        };
        let gone = before.keys().filter(|what| !run.contains_key(*what)).map(|what| (what, &Value::Null));
        run.iter().chain(gone).find_map(other).map_or(Ok(()), Err)
    }

    /// The measurement that was made at this place, of these wears.
    pub(super) fn measurement(&self, index: usize, wear: &[f64]) -> Option<&Measurement> {
        let known = self.measurements.get(index)?;
        if known.wear == wear {
            return Some(known);
        }
        // The line after that of the run; a journal that is whole has never come here.
        let damaged = JournalError::Damaged { file: self.path.clone(), line: index as u64 + 2 };
        self.writer().failure.get_or_insert(damaged);
        None
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
        if self.writer().is_blind || !back.is_ok_and(|back| back == measurement) {
            self.writer().is_blind = true;
            return;
        }
        self.write([Record::Measurement(measurement)]);
        self.sync();
    }

    /// Keeps lives that are finished, those of one call together on the disk.
    pub(super) fn keep_lives(&self, batch: Batch, ends: &[(u64, FailureEvent)]) {
        let records = ends.iter().map(|(number, end)| Record::Life { batch, number: *number, end: *end });
        self.write(records);
        if self.writer().synced.elapsed() > SYNC_EVERY {
            self.sync();
        }
    }

    /// Whether nothing more can be kept.
    pub(super) fn has_failed(&self) -> bool {
        self.writer().failure.is_some()
    }

    /// Why nothing more can be kept.
    pub(super) fn failure(&self) -> Option<JournalError> {
        self.writer().failure.take()
    }

    fn writer(&self) -> MutexGuard<'_, Writer> {
        self.writer.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn write(&self, records: impl IntoIterator<Item = Record>) {
        let mut writer = self.writer();
        if let Err(error) = writer.append(records) {
            // Half a line is not left; the disk may be full, and shorter is always possible.
            let _ = writer.file.set_len(writer.length);
            writer.failure.get_or_insert(WriteError::of(&self.path)(error).into());
        }
    }

    fn sync(&self) {
        let mut writer = self.writer();
        if let Err(error) = writer.file.sync_data() {
            writer.failure.get_or_insert(WriteError::of(&self.path)(error).into());
        }
        writer.synced = Instant::now();
    }
}

impl Writer {
    fn append(&mut self, records: impl IntoIterator<Item = Record>) -> io::Result<()> {
        if self.failure.is_some() {
            return Ok(());
        }
        let (mut lines, mut checksum, mut count) = (Vec::new(), self.checksum, 0);
        for record in records {
            let json = serde_json::to_vec(&record)?;
            checksum = chained(&checksum, &json);
            lines.extend_from_slice(hexadecimal(&checksum[..CHECKSUM]).as_bytes());
            lines.push(b' ');
            lines.extend_from_slice(&json);
            lines.push(b'\n');
            count += u64::from(!matches!(record, Record::Run(_)));
        }
        self.file.write_all(&lines)?;
        (self.checksum, self.length) = (checksum, self.length + lines.len() as u64);
        self.records += count;
        Ok(())
    }
}

impl Drop for Journal {
    /// A run that came to nothing leaves nothing, so that its folder is free again.
    fn drop(&mut self) {
        if !self.is_earlier && self.writer().records == 0 {
            let _ = fs::remove_file(&self.path);
        }
    }
}

fn chained(before: &[u8; 32], json: &[u8]) -> [u8; 32] {
    let mut hash = Hash::new();
    hash.update(before);
    hash.update(json);
    hash.finalize()
}

fn hexadecimal(bytes: &[u8]) -> String {
    bytes.iter().map(|byte| format!("{byte:02x}")).collect()
}

/// In brackets, where it is known.
fn named(version: Option<&str>) -> String {
    version.map(|version| format!(" ({version})")).unwrap_or_default()
}

/// A value for people: text without quotes, nothing as a word.
fn said(value: &Value) -> String {
    match value {
        Value::Null => "not given".to_owned(),
        Value::String(text) => text.clone(),
        value => value.to_string(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    fn folder(test: &str) -> PathBuf {
        std::env::temp_dir().join(format!("linkwear-journal-{test}-{}", std::process::id()))
    }

    fn run(seed: u64) -> Map<String, Value> {
        json!({ "the seed": seed }).as_object().cloned().expect("an object")
    }

    fn end(number: u64) -> FailureEvent {
        FailureEvent { joint: 0, cycles: 20.0 + (number as f64).sin(), whole_cycles: 21 }
    }

    /// A finished journal of six lives.
    fn written(folder: &Path) -> Vec<u8> {
        let journal = Journal::create(folder).expect("a free folder");
        journal.begin(run(7)).expect("a new run");
        (0..6).for_each(|number| journal.keep_lives(0, &[(number, end(number))]));
        drop(journal);
        fs::read(folder.join(NAME)).expect("a journal")
    }

    #[test]
    fn every_flipped_bit_is_refused_or_costs_the_last_line() {
        let folder = folder("flip");
        let whole = written(&folder);
        for at in 0..whole.len() {
            let mut bytes = whole.clone();
            bytes[at] ^= 1 << (at % 8);
            fs::write(folder.join(NAME), &bytes).expect("a file");
            match Journal::resume(&folder) {
                Err(JournalError::Damaged { .. }) => {
                    assert_eq!(fs::read(folder.join(NAME)).expect("a file"), bytes, "byte {at}");
                }
                Ok(journal) if at + 1 == whole.len() => {
                    assert_eq!(journal.lives(0).map(BTreeMap::len), Some(5));
                }
                other => panic!("byte {at}: {other:?}"),
            }
        }
        fs::remove_dir_all(&folder).expect("folder");
    }

    #[test]
    fn wherever_it_is_cut_it_goes_on_to_the_same_bytes() {
        let folder = folder("cut");
        let whole = written(&folder);
        for length in 0..=whole.len() {
            fs::write(folder.join(NAME), &whole[..length]).expect("a file");
            let journal = Journal::resume(&folder).expect("a torn tail is no damage");
            journal.begin(run(7)).expect("the same run");
            let known = journal.lives(0).cloned().unwrap_or_default();
            (0..6).filter(|number| !known.contains_key(number)).for_each(|number| {
                journal.keep_lives(0, &[(number, end(number))]);
            });
            assert!(known.iter().all(|(number, found)| *found == end(*number)));
            drop(journal);
            assert_eq!(fs::read(folder.join(NAME)).expect("a file"), whole, "{length}");
        }
        fs::remove_dir_all(&folder).expect("folder");
    }

    #[test]
    fn another_run_a_second_one_and_a_used_folder_are_refused() {
        let folder = folder("other");
        written(&folder);
        let journal = Journal::resume(&folder).expect("a journal");
        let error = journal.begin(run(8)).expect_err("another seed");
        assert!(error.to_string().ends_with("the seed is 8 now, and was 7"), "{error}");
        assert!(matches!(Journal::resume(&folder), Err(JournalError::InUse(_))));
        let used = Journal::create(&folder);
        assert!(matches!(used, Err(JournalError::Write(WriteError::Exists(_)))));
        drop(journal);
        assert!(Journal::resume(&folder).is_ok());
        fs::remove_dir_all(&folder).expect("folder");
    }

    #[test]
    fn a_whole_line_that_this_version_does_not_write_is_of_another_one_and_no_damage() {
        let folder = folder("version");
        let known = json!({ "run": { (Mechanism::VERSION_KEY): "0.0.9" } });
        // A life without its end, a kind of record that is not there any more.
        for record in [json!({ "life": { "batch": 0, "number": 1 } }), json!({ "turn": 3 })] {
            let (mut checksum, mut text) = ([0; 32], Vec::new());
            for record in [&known, &record] {
                let json = record.to_string().into_bytes();
                checksum = chained(&checksum, &json);
                text.extend([hexadecimal(&checksum[..CHECKSUM]).as_bytes(), b" ", &json, b"\n"].concat());
            }
            fs::create_dir_all(&folder).expect("a folder");
            fs::write(folder.join(NAME), &text).expect("a file");
            let error = Journal::resume(&folder).expect_err("not of this version");
            let JournalError::OtherVersion { line: 2, version: Some(version), .. } = &error else {
                panic!("{error}")
            };
            assert_eq!(version, "0.0.9");
            assert!(error.to_string().contains("another version of linkwear (0.0.9)"), "{error}");
            assert_eq!(fs::read(folder.join(NAME)).expect("a file"), text);
        }
        fs::remove_dir_all(&folder).expect("folder");
    }

    #[test]
    fn a_run_that_came_to_nothing_leaves_its_folder_free() {
        let folder = folder("nothing");
        let journal = Journal::create(&folder).expect("a free folder");
        journal.begin(run(7)).expect("a new run");
        drop(journal);
        drop(Journal::create(&folder).expect("a free folder"));
        fs::remove_dir_all(&folder).expect("folder");
    }
}
