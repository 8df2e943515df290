//! The folder `FILE.part`, which contains the chunks of a sweep until they are merged.
//!
//! `sweep.json` is the [`Description`] of the sweep. `K.csv` is chunk K: a first line with the fingerprint of the
//! description and K; the rows of its runs as in the tables, each after the name of its table; a last line
//! with a [`Tally`] and a checksum of all text before. A process writes a chunk under a temporary name, syncs it and
//! renames it. So an existing chunk is complete, for any number of processes.

use crate::place;
use core::num::NonZeroU64;
use core::ops::{AddAssign, Range};
use serde::{Deserialize, Serialize};
use std::fs::{self, File, OpenOptions, TryLockError};
use std::io::{self, Read as _};
use std::path::{Path, PathBuf};
use vi_report::failure::Failure;
use vi_report::input;

const DESCRIPTION: &str = "sweep.json";
const LOCK: &str = "lock";
/// Names of the tables: a row for each run, its crossings of a section, its nodes.
pub(super) const TABLES: [&str; 3] = ["runs", "section", "series"];

/// All inputs of the tables of a sweep.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub(super) struct Description {
    /// Names and values: version, system, method, varied quantities.
    pub(super) facts: Vec<(String, String)>,
    /// The number of runs.
    pub(super) items: u64,
    /// Number of runs in each chunk except the last.
    pub(super) chunk: NonZeroU64,
    /// Names of the columns of each of [`TABLES`], separated by commas; `None` for a table that is not kept.
    pub(super) headings: [Option<String>; TABLES.len()],
}

/// Counts of runs.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Tally {
    /// Runs that did not reach their end.
    pub(super) failed: u64,
    /// Runs with a large error of a step.
    pub(super) inaccurate: u64,
}

/// The chunks of a sweep.
#[derive(Debug)]
pub(super) struct Chunks {
    pub(super) folder: PathBuf,
    pub(super) description: Description,
    fingerprint: u64,
    /// Locked until dropped.
    _lock: Option<File>,
}

/// Receives the name of a table and a row of it, with its line end.
pub(super) type Take<'a> = dyn FnMut(&str, &str) -> Result<(), Failure> + 'a;

impl Description {
    /// The description in a folder.
    ///
    /// # Errors
    /// [`Failure::Input`] if there is none, or it is invalid.
    fn read(folder: &Path) -> Result<Self, Failure> {
        let shown = folder.display();
        let text = input::text(&folder.join(DESCRIPTION));
        let text =
            text.map_err(|failure| Failure::Input(format!("{shown} contains no chunks of a sweep: {failure}")))?;
        serde_json::from_str(&text).map_err(|_| {
            let what = "does not describe a sweep of this version of vi-lab";
            Failure::Input(format!("{shown}/{DESCRIPTION} {what}; remove {shown}, and run `vi-lab sweep` again"))
        })
    }

    /// The difference from another description, in words.
    pub(super) fn difference(&self, wanted: &Self) -> Option<String> {
        let mut pairs = self.facts.iter().zip(&wanted.facts).filter(|(here, wanted)| here != wanted);
        let fact = pairs.next().map(|((name, here), (_, wanted))| format!("its {name} is `{here}`, not `{wanted}`"));
        fact.or_else(|| (self != wanted).then(|| "its tables differ".to_owned()))
    }

    /// Number of chunks.
    pub(super) fn chunks(&self) -> u64 {
        self.items.div_ceil(self.chunk.get())
    }

    /// The runs of a range of chunks.
    pub(super) fn runs(&self, chunks: &Range<u64>) -> Range<u64> {
        let [start, end] =
            [chunks.start, chunks.end].map(|chunk| self.items.min(chunk.saturating_mul(self.chunk.get())));
        start..end
    }

    fn json(&self) -> String {
        // Serialization of names, words and counts cannot fail.
        serde_json::to_string_pretty(self).unwrap_or_default()
    }
}

impl Chunks {
    /// The chunks in a folder, for writing; creates the folder if necessary. `is_alone` locks out all other processes;
    /// otherwise they may add chunks too.
    ///
    /// # Errors
    /// [`Failure::Input`] if the folder belongs to something else, or is locked; [`Failure::File`] if a file cannot be
    /// read or written.
    pub(super) fn resume(folder: &Path, description: Description, is_alone: bool) -> Result<Self, Failure> {
        let shown = folder.display();
        let failed = |error| Failure::file(folder, error);
        match fs::create_dir(folder) {
            Err(error) if error.kind() != io::ErrorKind::AlreadyExists => return Err(failed(error)),
            _ if !folder.is_dir() => {
                return Err(Failure::Input(format!("{shown} is not a folder; remove it, or name another output")));
            }
            _ => {}
        }
        let lock = folder.join(LOCK);
        if lock.exists() {
            input::check_regular(&lock)?;
        }
        let lock = OpenOptions::new().read(true).write(true).create(true).truncate(false).open(lock).map_err(failed)?;
        match if is_alone { lock.try_lock() } else { lock.try_lock_shared() } {
            Ok(()) if is_alone => remove_temporaries(folder).map_err(failed)?,
            Err(TryLockError::WouldBlock) => {
                return Err(Failure::Input(format!("another process uses {shown}; wait for it")));
            }
            // Some cluster file systems have no locks. Two processes then write the same chunks.
            Ok(()) | Err(TryLockError::Error(_)) => {}
        }
        if !folder.join(DESCRIPTION).exists() {
            place::replace(&folder.join(DESCRIPTION), &description.json()).map_err(failed)?;
        } else if let Some(difference) = Description::read(folder)?.difference(&description) {
            let remedy = "remove it, or name another output";
            return Err(Failure::Input(format!("{shown} belongs to another sweep: {difference}; {remedy}")));
        }
        Ok(Self::of(folder, description, Some(lock)))
    }

    /// The chunks in a folder, for reading.
    ///
    /// # Errors
    /// [`Failure::Input`] if it has none.
    pub(super) fn open(folder: &Path) -> Result<Self, Failure> {
        Ok(Self::of(folder, Description::read(folder)?, None))
    }

    fn of(folder: &Path, description: Description, lock: Option<File>) -> Self {
        let fingerprint = fingerprint(&[description.json().as_str()]);
        Self { folder: folder.to_owned(), description, fingerprint, _lock: lock }
    }

    /// The file of a chunk.
    fn path(&self, chunk: u64) -> PathBuf {
        self.folder.join(format!("{chunk}.csv"))
    }

    fn first_line(&self, chunk: u64) -> String {
        format!("# vi-lab sweep {:016x}, chunk {chunk}\n", self.fingerprint)
    }

    /// Whether there is a file of a chunk.
    pub(super) fn has(&self, chunk: u64) -> bool {
        self.path(chunk).exists()
    }

    /// Whether a chunk of this sweep exists. A file of an earlier sweep does not count.
    pub(super) fn is_made(&self, chunk: u64) -> bool {
        let first = self.first_line(chunk);
        let mut found = vec![0; first.len()];
        let path = self.path(chunk);
        // A pipe would wait for a writer.
        path.is_file()
            && File::open(path).and_then(|mut file| file.read_exact(&mut found)).is_ok()
            && found == first.as_bytes()
    }

    /// Writes a chunk. `follow` adds the rows of a run to a text, each after the name of its table and a comma.
    ///
    /// # Errors
    /// [`Failure::File`] if it cannot be written; the chunk then does not exist.
    pub(super) fn write(&self, number: u64, mut follow: impl FnMut(u64, &mut String) -> Tally) -> Result<(), Failure> {
        let (mut text, mut tally) = (self.first_line(number), Tally::default());
        for item in self.description.runs(&(number..number + 1)) {
            tally += follow(item, &mut text);
        }
        text += &tally.last_line(&text);
        let path = self.path(number);
        place::replace(&path, &text).map_err(|error| {
            let advice = "the other chunks are complete; correct the error, then the same command resumes from them";
            Failure::file(path, io::Error::new(error.kind(), format!("{error}; {advice}")))
        })
    }

    /// Reads a chunk and passes every row to `take`.
    ///
    /// # Errors
    /// [`Failure::Input`] if it is missing, belongs to another sweep, or was changed; [`Failure::File`] if it cannot be
    /// read.
    pub(super) fn read(&self, number: u64, take: &mut Take) -> Result<Tally, Failure> {
        let path = self.path(number);
        input::check_regular(&path)?;
        let text = fs::read(&path).map_err(|error| Failure::file(&path, error))?;
        let wrong = |what: &str| {
            let remedy = "remove this file, and run the same `vi-lab sweep` again";
            Failure::Input(format!("{}: {what}; {remedy}", path.display()))
        };
        let first = self.first_line(number);
        if !text.starts_with(first.as_bytes()) {
            return Err(wrong("this is a chunk of another sweep, or another chunk"));
        }
        let (rows, tally) = str::from_utf8(&text)
            .ok()
            .and_then(Tally::checked)
            .ok_or_else(|| wrong("the checksum does not match: the file was edited or cut off"))?;
        for line in rows[first.len()..].split_inclusive('\n') {
            let (table, row) = line.split_once(',').unwrap_or((line, ""));
            take(table, row)?;
        }
        Ok(tally)
    }
}

impl Tally {
    /// The last line of a chunk with these counts, after this text.
    fn last_line(self, text: &str) -> String {
        let counts = format!("# {} failed, {} inaccurate", self.failed, self.inaccurate);
        format!("{counts}, checksum {:016x}\n", fingerprint(&[text, &counts]))
    }

    /// The text of a chunk before its last line, and the counts of this line; `None` if its checksum is wrong.
    fn checked(chunk: &str) -> Option<(&str, Self)> {
        let (text, last) = chunk.split_at(chunk.strip_suffix('\n')?.rfind('\n')? + 1);
        let mut words = last.split(' ').skip(1).step_by(2).map_while(|word| word.parse().ok());
        let tally = Self { failed: words.next()?, inaccurate: words.next()? };
        (tally.last_line(text) == last).then_some((text, tally))
    }
}

impl AddAssign for Tally {
    fn add_assign(&mut self, other: Self) {
        self.failed += other.failed;
        self.inaccurate += other.inaccurate;
    }
}

/// Removes temporary files of killed processes.
fn remove_temporaries(folder: &Path) -> io::Result<()> {
    for entry in fs::read_dir(folder)? {
        let entry = entry?;
        if entry.file_name().to_string_lossy().contains(".csv.tmp-") {
            fs::remove_file(entry.path())?;
        }
    }
    Ok(())
}

/// FNV-1a of texts, 64 bits.
pub(super) fn fingerprint(texts: &[&str]) -> u64 {
    let bytes = texts.iter().flat_map(|text| text.bytes());
    bytes.fold(0xcbf2_9ce4_8422_2325, |hash, byte| (hash ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3))
}
