//! What a run has come to so far, in a file, so that one that was killed goes on with the same bits.
//! In: a path, what identifies the run, records as they are made. Out: those of an earlier run.
//! Never knows what a record means.
//!
//! One line for each record, that of the run first: 16 hexadecimal digits of a checksum, a space, JSON. The checksum is the
//! SHA-256 of the one before and the JSON, so that no line can be changed, lost or moved. A kill leaves at most a last line
//! without its end, which is cut off; anything else that does not fit is damage. The lock is the system's: it ends with its
//! process, however that ends.

use std::fs::{self, File, OpenOptions, TryLockError};
use std::io::{self, BufRead as _, BufReader, Seek as _, SeekFrom, Write as _};
use std::marker::PhantomData;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use hmac_sha256::Hash;
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};
use thiserror::Error;

use crate::checksum::hexadecimal;
use crate::files::{WriteError, sync_folder};

/// Records are put on the disk this often, so that a power failure costs no more. A kill costs nothing.
const SYNC_EVERY: Duration = Duration::from_secs(1);
/// Bytes of a checksum that are written: chance agrees with them once in 2^64.
const CHECKSUM: usize = 8;

/// What the version of the program is called in what identifies a run.
pub(crate) const VERSION: &str = "the version of linkwear";

/// Why a journal cannot be used.
#[derive(Debug, Error)]
pub enum JournalError {
    /// It cannot be written or read, or its folder is not free.
    #[error(transparent)]
    Write(#[from] WriteError),
    /// A run is to be gone on with in a folder that has other files, and none.
    #[error("`{}` has files, but no run of linkwear to go on with", .0.display())]
    NoRun(PathBuf),
    /// Another process is writing to it.
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
    /// It is whole, but another version or command of the program wrote it.
    #[error("`{}` is of another {}: this one does not write lines such as line {line}", .file.display(), origin(.version.as_deref()))]
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

/// What identifies a run: in words for people, values that decide its numbers.
pub type Identity = Map<String, Value>;

/// The first line.
#[derive(Deserialize, Serialize)]
pub(crate) struct Run<I> {
    pub run: I,
}

/// A journal of records, locked.
#[derive(Debug)]
pub struct Journal<R> {
    path: PathBuf,
    run: Mutex<Option<Identity>>,
    writer: Mutex<Writer>,
    /// Whether an earlier process began it: then it is never removed.
    is_earlier: bool,
    record: PhantomData<fn(R)>,
}

#[derive(Debug)]
struct Writer {
    file: File,
    checksum: [u8; 32],
    length: u64,
    /// Records besides what identifies the run.
    records: u64,
    synced: Instant,
    /// The first thing that went wrong; nothing is written after it.
    failure: Option<JournalError>,
}

impl<R: DeserializeOwned + Serialize> Journal<R> {
    /// A journal of a run that begins, where no file is.
    ///
    /// # Errors
    /// [`JournalError::Write`] if there is a file, or it cannot be written.
    pub fn create(path: PathBuf) -> Result<Self, JournalError> {
        let file = OpenOptions::new().read(true).write(true).create_new(true).open(&path);
        let file = file.map_err(|error| match error.kind() {
            io::ErrorKind::AlreadyExists => WriteError::Exists(path.clone()),
            _ => WriteError::of(&path)(error),
        })?;
        let journal = Self::locked(path, file)?;
        sync_folder(crate::files::folder_of(&journal.path))?;
        Ok(journal)
    }

    /// The journal of an earlier run, to go on with, and its records; nothing if there is no file.
    ///
    /// # Errors
    /// [`JournalError::InUse`], [`JournalError::Damaged`], [`JournalError::OtherVersion`], [`JournalError::Write`].
    pub fn resume(path: &Path) -> Result<Option<(Self, Vec<R>)>, JournalError> {
        let wrong = WriteError::of;
        match fs::metadata(path) {
            Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(None),
            Err(error) => return Err(wrong(path)(error).into()),
            Ok(found) if !found.is_file() => {
                return Err(wrong(path)(io::Error::other("it is no regular file")).into());
            }
            Ok(_) => {}
        }
        let file = OpenOptions::new().read(true).write(true).open(path).map_err(wrong(path))?;
        let mut journal = Self::locked(path.to_path_buf(), file)?;
        journal.is_earlier = true;
        let writer = journal.writer.get_mut().unwrap_or_else(PoisonError::into_inner);
        let Read { run, records, checksum, length } = Read::of(path, &writer.file)?;
        (writer.checksum, writer.length, writer.records) = (checksum, length, records.len() as u64);
        // A line that a kill left without its end.
        writer.file.set_len(writer.length).map_err(wrong(path))?;
        writer.file.seek(SeekFrom::End(0)).map_err(wrong(path))?;
        journal.run = Mutex::new(run);
        Ok(Some((journal, records)))
    }

    fn locked(path: PathBuf, file: File) -> Result<Self, JournalError> {
        match file.try_lock() {
            Err(TryLockError::WouldBlock) => return Err(JournalError::InUse(path)),
            // A file system without locks: the user sees to it.
            Err(TryLockError::Error(error)) if error.kind() == io::ErrorKind::Unsupported => {}
            Err(TryLockError::Error(error)) => return Err(WriteError::of(&path)(error).into()),
            Ok(()) => {}
        }
        let (synced, failure) = (Instant::now(), None);
        let writer = Writer { file, checksum: [0; 32], length: 0, records: 0, synced, failure };
        let (run, writer) = (Mutex::new(None), Mutex::new(writer));
        Ok(Self { path, run, writer, is_earlier: false, record: PhantomData })
    }

    /// Says which run this is.
    ///
    /// # Errors
    /// [`JournalError::OtherRun`] with the first difference; [`JournalError::Write`].
    pub fn begin(&self, run: Identity) -> Result<(), JournalError> {
        let mut known = self.run.lock().unwrap_or_else(PoisonError::into_inner);
        let Some(before) = &*known else {
            self.append(|writer| writer.append([Run { run: &run }]));
            *known = Some(run);
            return self.failure().map_or(Ok(()), Err);
        };
        same_run(&self.path, before, &run)
    }

    /// Keeps records, those of one call together.
    pub fn keep<'a>(&self, records: impl IntoIterator<Item = &'a R>)
    where
        R: 'a,
    {
        self.append(|writer| {
            writer.records += writer.append(records)?;
            Ok(0)
        });
        if self.writer().synced.elapsed() > SYNC_EVERY {
            self.sync();
        }
    }

    /// Puts everything on the disk.
    pub fn sync(&self) {
        let mut writer = self.writer();
        if let Err(error) = writer.file.sync_data() {
            writer.failure.get_or_insert(WriteError::of(&self.path)(error).into());
        }
        writer.synced = Instant::now();
    }
}

impl<R> Journal<R> {
    /// The file.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Whether nothing more can be kept.
    pub fn has_failed(&self) -> bool {
        self.writer().failure.is_some()
    }

    /// Why nothing more can be kept.
    pub fn failure(&self) -> Option<JournalError> {
        self.writer().failure.take()
    }

    /// A record, counted from 0, is not what was written.
    pub fn damaged(&self, record: usize) {
        // The line after that of the run.
        let damaged = JournalError::Damaged { file: self.path.clone(), line: record as u64 + 2 };
        self.writer().failure.get_or_insert(damaged);
    }

    fn writer(&self) -> MutexGuard<'_, Writer> {
        self.writer.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn append(&self, append: impl FnOnce(&mut Writer) -> io::Result<u64>) {
        let mut writer = self.writer();
        if let Err(error) = append(&mut writer) {
            // Half a line is not left; the disk may be full, and shorter is always possible.
            let _ = writer.file.set_len(writer.length);
            writer.failure.get_or_insert(WriteError::of(&self.path)(error).into());
        }
    }
}

impl Writer {
    /// Appends lines, and returns how many.
    fn append(&mut self, records: impl IntoIterator<Item = impl Serialize>) -> io::Result<u64> {
        if self.failure.is_some() {
            return Ok(0);
        }
        let (mut lines, mut checksum, mut count) = (Vec::new(), self.checksum, 0);
        for record in records {
            checksum = line(&mut lines, &checksum, &record)?;
            count += 1;
        }
        self.file.write_all(&lines)?;
        (self.checksum, self.length) = (checksum, self.length + lines.len() as u64);
        Ok(count)
    }
}

impl<R> Drop for Journal<R> {
    /// A run that came to nothing leaves nothing, so that its place is free again.
    fn drop(&mut self) {
        if !self.is_earlier && self.writer().records == 0 {
            let _ = fs::remove_file(&self.path);
        }
    }
}

/// What a journal has.
pub struct Read<R> {
    /// What identifies the run.
    pub run: Option<Identity>,
    /// All records.
    pub records: Vec<R>,
    checksum: [u8; 32],
    length: u64,
}

impl<R: DeserializeOwned> Read<R> {
    /// Reads a journal that nobody goes on with.
    ///
    /// # Errors
    /// [`JournalError::Damaged`], [`JournalError::OtherVersion`], [`JournalError::Write`] if it cannot be read.
    pub fn file(path: &Path) -> Result<Self, JournalError> {
        let file = File::open(path).map_err(WriteError::of(path))?;
        Self::of(path, &file)
    }

    fn of(path: &Path, file: &File) -> Result<Self, JournalError> {
        let mut input = BufReader::new(file);
        let mut found = Self { run: None, records: Vec::new(), checksum: [0; 32], length: 0 };
        let (mut line, mut bytes) = (0, Vec::new());
        while input.read_until(b'\n', &mut bytes).map_err(WriteError::of(path))? > 0
            && bytes.last() == Some(&b'\n')
        {
            line += 1;
            let damaged = || JournalError::Damaged { file: path.to_path_buf(), line };
            let text = &bytes[..bytes.len() - 1];
            let (digits, json) = text.split_at_checked(2 * CHECKSUM).ok_or_else(damaged)?;
            let json = json.strip_prefix(b" ").ok_or_else(damaged)?;
            found.checksum = chained(&found.checksum, json);
            if digits != hexadecimal(&found.checksum[..CHECKSUM]).as_bytes() {
                return Err(damaged());
            }
            found.take(line, json).map_err(|_| {
                // Damage does not pass the checksum.
                let version = found.run.as_ref().and_then(|run| run.get(VERSION)).map(said);
                JournalError::OtherVersion { file: path.to_path_buf(), line, version }
            })?;
            found.length += bytes.len() as u64;
            bytes.clear();
        }
        Ok(found)
    }

    fn take(&mut self, line: u64, json: &[u8]) -> serde_json::Result<()> {
        if line == 1 {
            self.run = Some(serde_json::from_slice::<Run<Identity>>(json)?.run);
        } else {
            self.records.push(serde_json::from_slice(json)?);
        }
        Ok(())
    }
}

/// Writes the line of a record after one of this checksum, zeros before the first; returns its own.
///
/// # Errors
/// Those of the writer.
pub(crate) fn line(
    out: &mut impl io::Write,
    before: &[u8; 32],
    record: &impl Serialize,
) -> io::Result<[u8; 32]> {
    let json = serde_json::to_vec(record)?;
    let checksum = chained(before, &json);
    write!(out, "{} ", hexadecimal(&checksum[..CHECKSUM]))?;
    out.write_all(&json)?;
    out.write_all(b"\n")?;
    Ok(checksum)
}

/// Compares what was with what is.
///
/// # Errors
/// [`JournalError::OtherRun`] with the first difference.
pub fn same_run(file: &Path, before: &Identity, now: &Identity) -> Result<(), JournalError> {
    let other = |(what, is): (&String, &Value)| {
        let was = before.get(what).unwrap_or(&Value::Null);
        let (file, what) = (file.to_path_buf(), what.clone());
        (was != is).then(|| JournalError::OtherRun { file, what, was: said(was), is: said(is) })
    };
    let gone = before.keys().filter(|what| !now.contains_key(*what)).map(|what| (what, &Value::Null));
    now.iter().chain(gone).find_map(other).map_or(Ok(()), Err)
}

fn chained(before: &[u8; 32], json: &[u8]) -> [u8; 32] {
    let mut hash = Hash::new();
    hash.update(before);
    hash.update(json);
    hash.finalize()
}

/// What else wrote a journal: another version, which is named where it is known, or another command of this one.
fn origin(version: Option<&str>) -> String {
    match version {
        // The journal of a life in the place of a study's, or the other way round.
        Some(env!("CARGO_PKG_VERSION")) => "command or build of linkwear".to_owned(),
        Some(version) => format!("version of linkwear ({version})"),
        None => "version of linkwear".to_owned(),
    }
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

    /// A record of these tests.
    #[derive(Clone, Debug, Deserialize, PartialEq, Serialize)]
    struct Life {
        number: u64,
        cycles: f64,
    }

    fn life(number: u64) -> Life {
        Life { number, cycles: 20.0 + (number as f64).sin() }
    }

    fn path(test: &str) -> PathBuf {
        std::env::temp_dir().join(format!("linkwear-journal-{test}-{}", std::process::id()))
    }

    fn run(seed: u64) -> Identity {
        json!({ "the seed": seed }).as_object().cloned().expect("an object")
    }

    /// A finished journal of six lives.
    fn written(path: &Path) -> Vec<u8> {
        let journal = Journal::create(path.to_path_buf()).expect("a free place");
        journal.begin(run(7)).expect("a new run");
        (0..6).for_each(|number| journal.keep([&life(number)]));
        drop(journal);
        fs::read(path).expect("a journal")
    }

    #[test]
    fn every_flipped_bit_is_refused_or_costs_the_last_line() {
        let path = path("flip");
        let whole = written(&path);
        for at in 0..whole.len() {
            let mut bytes = whole.clone();
            bytes[at] ^= 1 << (at % 8);
            fs::write(&path, &bytes).expect("a file");
            match Journal::<Life>::resume(&path) {
                Err(JournalError::Damaged { .. }) => {
                    assert_eq!(fs::read(&path).expect("a file"), bytes, "byte {at}");
                }
                Ok(Some((_, lives))) if at + 1 == whole.len() => assert_eq!(lives.len(), 5),
                other => panic!("byte {at}: {other:?}"),
            }
        }
        fs::remove_file(&path).expect("a file");
    }

    #[test]
    fn wherever_it_is_cut_it_goes_on_to_the_same_bytes() {
        let path = path("cut");
        let whole = written(&path);
        for length in 0..=whole.len() {
            fs::write(&path, &whole[..length]).expect("a file");
            let (journal, known) =
                Journal::resume(&path).expect("a torn tail is no damage").expect("a journal");
            journal.begin(run(7)).expect("the same run");
            let left = (0..6).map(life).filter(|life| !known.contains(life)).collect::<Vec<_>>();
            journal.keep(&left);
            assert!(known.iter().all(|found| *found == life(found.number)));
            drop(journal);
            assert_eq!(fs::read(&path).expect("a file"), whole, "{length}");
        }
        fs::remove_file(&path).expect("a file");
    }

    #[test]
    fn another_run_a_second_one_and_a_used_place_are_refused() {
        let path = path("other");
        written(&path);
        let (journal, _) = Journal::<Life>::resume(&path).expect("it is whole").expect("a journal");
        let error = journal.begin(run(8)).expect_err("another seed");
        assert!(error.to_string().ends_with("the seed is 8 now, and was 7"), "{error}");
        assert!(matches!(Journal::<Life>::resume(&path), Err(JournalError::InUse(_))));
        let used = Journal::<Life>::create(path.clone());
        assert!(matches!(used, Err(JournalError::Write(WriteError::Exists(_)))));
        drop(journal);
        assert!(Journal::<Life>::resume(&path).is_ok_and(|found| found.is_some()));
        fs::remove_file(&path).expect("a file");
    }

    #[test]
    fn a_whole_line_that_this_version_does_not_write_is_of_another_one_and_no_damage() {
        let path = path("version");
        let known = json!({ "run": { (VERSION): "0.0.9" } });
        // A life without its end, a kind of record that is not there any more.
        for record in [json!({ "number": 1 }), json!({ "turn": 3 })] {
            let (mut checksum, mut text) = ([0; 32], Vec::new());
            for record in [&known, &record] {
                let json = record.to_string().into_bytes();
                checksum = chained(&checksum, &json);
                text.extend([hexadecimal(&checksum[..CHECKSUM]).as_bytes(), b" ", &json, b"\n"].concat());
            }
            fs::write(&path, &text).expect("a file");
            let error = Journal::<Life>::resume(&path).expect_err("not of this version");
            let JournalError::OtherVersion { line: 2, version: Some(version), .. } = &error else {
                panic!("{error}")
            };
            assert_eq!(version, "0.0.9");
            assert!(error.to_string().contains("another version of linkwear (0.0.9)"), "{error}");
            assert_eq!(fs::read(&path).expect("a file"), text);
        }
        fs::remove_file(&path).expect("a file");
        let of = |version: &str| JournalError::OtherVersion {
            file: path.clone(),
            line: 2,
            version: Some(version.to_owned()),
        };
        let own = of(env!("CARGO_PKG_VERSION")).to_string();
        assert!(own.contains("another command") && !own.contains("another version"), "{own}");
    }

    #[test]
    fn a_run_that_came_to_nothing_leaves_its_place_free() {
        let path = path("nothing");
        let journal = Journal::<Life>::create(path.clone()).expect("a free place");
        journal.begin(run(7)).expect("a new run");
        drop(journal);
        drop(Journal::<Life>::create(path).expect("a free place"));
    }
}
