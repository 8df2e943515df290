//! The folder `FILE.part`, which contains the chunks of a sweep until they are merged.
//!
//! `sweep.json` is the [`Description`] of the sweep. `K.csv` is chunk K: a first line with the fingerprint of the
//! description and K; the rows of its runs as they will stand in the tables, each after the name of its table; a last line
//! with a [`Tally`] and a checksum of all text before. A process writes a chunk under a temporary name, syncs it and
//! renames it. So an existing chunk is complete, for any number of processes.

use crate::place::{self, Temporary};
use core::num::NonZeroU64;
use core::ops::{AddAssign, Range};
use serde::{Deserialize, Serialize};
use std::fs::{self, File, OpenOptions, TryLockError};
use std::io::{self, BufRead as _, BufReader, BufWriter, ErrorKind, Read as _, Write as _};
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
    /// Those that did not reach their end.
    pub(super) failed: u64,
    /// Those with a large error of a step.
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
    pub(super) fn write(&self, number: u64, follow: impl FnMut(u64, &mut String) -> Tally) -> Result<(), Failure> {
        let path = self.path(number);
        self.try_write(&path, number, follow).map_err(|error| {
            let advice = "the other chunks are complete; correct the error, then the same command resumes from them";
            Failure::file(path, io::Error::new(error.kind(), format!("{error}; {advice}")))
        })
    }

    fn try_write(&self, path: &Path, number: u64, mut follow: impl FnMut(u64, &mut String) -> Tally) -> io::Result<()> {
        let (temporary, file) = Temporary::create(path)?;
        let mut file = BufWriter::with_capacity(1 << 16, file);
        let (mut text, mut sum, mut tally) = (self.first_line(number), fingerprint(&[]), Tally::default());
        for item in self.description.runs(&(number..number + 1)) {
            tally += follow(item, &mut text);
            file.write_all(text.as_bytes())?;
            sum = hashed(sum, text.as_bytes());
            text.clear();
        }
        file.write_all(tally.last_line(sum).as_bytes())?;
        file.into_inner()?.sync_all()?;
        temporary.finish()
    }

    /// Reads a chunk and passes every row to `take`, before it is known whether the checksum is right.
    ///
    /// # Errors
    /// [`Failure::Input`] if it is missing, belongs to another sweep, or was changed; [`Failure::File`] if it cannot be
    /// read.
    pub(super) fn read(&self, number: u64, take: &mut Take) -> Result<Tally, Failure> {
        let path = self.path(number);
        input::check_regular(&path)?;
        let failed = |error| Failure::file(&path, error);
        let wrong = |what: &str| {
            let remedy = "remove this file, and run the same `vi-lab sweep` again";
            Failure::Input(format!("{}: {what}; {remedy}", path.display()))
        };
        let changed = || wrong("the checksum does not match: the file was edited or cut off");
        let mut file = BufReader::with_capacity(1 << 16, File::open(&path).map_err(failed)?);
        let first = self.first_line(number);
        let mut found = vec![0; first.len()];
        if file.read_exact(&mut found).is_err() || found != first.as_bytes() {
            return Err(wrong("this is a chunk of another sweep, or another chunk"));
        }
        let (mut line, mut sum) = (String::new(), fingerprint(&[&first]));
        loop {
            line.clear();
            match file.read_line(&mut line) {
                Err(error) if error.kind() == ErrorKind::InvalidData => return Err(changed()),
                Err(error) => return Err(failed(error)),
                Ok(_) => {}
            }
            if let Some((table, row)) = line.split_once(',').filter(|_| !line.starts_with('#')) {
                take(table, row)?;
                sum = hashed(sum, line.as_bytes());
                continue;
            }
            let tally = Tally::of_last_line(&line).filter(|tally| tally.last_line(sum) == line);
            let is_last = file.fill_buf().map_err(failed)?.is_empty();
            return tally.filter(|_| is_last).ok_or_else(changed);
        }
    }
}

impl Tally {
    /// The last line of a chunk with these counts, after text of this checksum.
    fn last_line(self, sum: u64) -> String {
        let counts = format!("# {} failed, {} inaccurate", self.failed, self.inaccurate);
        format!("{counts}, checksum {:016x}\n", hashed(sum, counts.as_bytes()))
    }

    /// The counts of such a line.
    fn of_last_line(line: &str) -> Option<Self> {
        let mut words = line.split(' ').skip(1).step_by(2).map_while(|word| word.parse().ok());
        Some(Self { failed: words.next()?, inaccurate: words.next()? })
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

/// FNV-1a of texts, 64 bits: the same in every version of this program.
pub(super) fn fingerprint(texts: &[&str]) -> u64 {
    texts.iter().fold(0xcbf2_9ce4_8422_2325, |hash, text| hashed(hash, text.as_bytes()))
}

/// FNV-1a, continued over further bytes.
fn hashed(hash: u64, bytes: &[u8]) -> u64 {
    bytes.iter().fold(hash, |hash, byte| (hash ^ u64::from(*byte)).wrapping_mul(0x0000_0100_0000_01b3))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A folder for one test, removed on drop.
    struct TestFolder(PathBuf);

    impl TestFolder {
        fn new(name: &str) -> Self {
            let place = Self(std::env::temp_dir().join(format!("vi-lab-{name}-{}", std::process::id())));
            let _ = fs::remove_dir_all(&place.0);
            place
        }

        fn resume(&self, description: &Description, is_alone: bool) -> Result<Chunks, String> {
            let chunks = Chunks::resume(&self.0, description.clone(), is_alone);
            chunks.map_err(|failure| failure.to_string().replace(&self.0.display().to_string(), "FOLDER"))
        }

        fn chunks(&self) -> Chunks {
            self.resume(&description(), true).unwrap_or_else(|message| panic!("{message}"))
        }
    }

    impl Drop for TestFolder {
        fn drop(&mut self) {
            let _ = fs::remove_dir_all(&self.0);
        }
    }

    /// Five runs in chunks of two.
    fn description() -> Description {
        let headings = [Some("item,x".to_owned()), None, Some("item,x".to_owned())];
        let chunk = NonZeroU64::MIN.saturating_add(1);
        Description { facts: vec![("system".to_owned(), "Kepler".to_owned())], items: 5, chunk, headings }
    }

    /// Run k with k rows of series. Run 3 fails.
    fn follow(item: u64, text: &mut String) -> Tally {
        for place in 0..item {
            text.extend([format!("series,{item},{place}.5\n")]);
        }
        text.extend([format!("runs,{item},-0.5\n")]);
        Tally { failed: u64::from(item == 3), inaccurate: u64::from(item < 3) }
    }

    fn write(chunks: &Chunks, number: u64) {
        chunks.write(number, follow).unwrap_or_else(|failure| panic!("{failure}"));
    }

    /// The reason why a chunk is rejected.
    fn refusal(chunks: &Chunks, number: u64) -> Option<String> {
        let read = chunks.read(number, &mut |_, _| Ok(()));
        read.err().map(|failure| {
            assert_eq!(failure.exit_status(), 2, "{failure}");
            failure.to_string().replace(&format!("{}/", chunks.folder.display()), "")
        })
    }

    const REMEDY: &str = "; remove this file, and run the same `vi-lab sweep` again";

    #[test]
    fn chunks_are_there_once_they_are_whole() {
        let place = TestFolder::new("chunks");
        let chunks = place.chunks();
        assert_eq!((chunks.description.chunks(), chunks.description.runs(&(1..3))), (3, 2..5));
        write(&chunks, 2);
        // A folder occupies its name, so the file cannot be created.
        fs::create_dir(chunks.path(1)).expect("a folder");
        let failure = chunks.write(1, follow).expect_err("no file");
        let (status, message) = (failure.exit_status(), failure.to_string());
        let advice = "; the other chunks are complete; correct the error, then the same command resumes from them";
        let start = format!("{}: ", chunks.path(1).display());
        assert!(status == 1 && message.starts_with(&start) && message.ends_with(advice), "{message}");
        assert_eq!([0, 1, 2].map(|number| chunks.is_made(number)), [false, false, true]);
        fs::remove_dir(chunks.path(1)).expect("the folder goes");
        let names = fs::read_dir(&place.0).expect("the folder").flatten().map(|file| file.file_name());
        let names: std::collections::BTreeSet<_> = names.collect();
        assert_eq!(names, ["2.csv", LOCK, DESCRIPTION].map(Into::into).into(), "no piece is left");
        fs::write(place.0.join("1.csv.tmp-1-0"), "# vi-").expect("a file");
        drop(chunks);
        let chunks = place.chunks();
        assert!(!place.0.join("1.csv.tmp-1-0").exists(), "what a killed process left is removed");
        write(&chunks, 1);
        let mut rows = String::new();
        let mut take = |table: &str, row: &str| {
            rows.extend([format!("{table}: {row}")]);
            Ok(())
        };
        let tallies = [1, 2].map(|number| chunks.read(number, &mut take).ok());
        let tally = |failed, inaccurate| Some(Tally { failed, inaccurate });
        assert_eq!(tallies, [tally(1, 1), tally(0, 0)]);
        assert!(rows.starts_with("series: 2,0.5\nseries: 2,1.5\nruns: 2,-0.5\nseries: 3,0.5\n"), "{rows}");
        assert_eq!((rows.lines().count(), rows.matches("runs: ").count()), (12, 3));
    }

    #[test]
    fn two_processes_that_write_one_chunk_leave_it_whole() {
        let place = TestFolder::new("two");
        let chunks = place.chunks();
        write(&chunks, 1);
        let alone = fs::read(chunks.path(1)).expect("the chunk");
        // The second process starts and ends while the first one writes.
        let other = Chunks::open(&place.0).unwrap_or_else(|failure| panic!("{failure}"));
        let both = chunks.write(1, |item, text| {
            write(&other, 1);
            assert_eq!(fs::read(chunks.path(1)).expect("the chunk"), alone);
            follow(item, text)
        });
        assert!(both.is_ok());
        assert_eq!(fs::read(chunks.path(1)).expect("the chunk"), alone);
    }

    #[test]
    fn a_chunk_that_was_changed_is_refused() {
        let place = TestFolder::new("changed");
        let chunks = place.chunks();
        write(&chunks, 0);
        write(&chunks, 1);
        let path = chunks.path(1);
        let whole = fs::read(&path).expect("the chunk");
        let lines: Vec<&str> = str::from_utf8(&whole).expect("text").split_inclusive('\n').collect();
        let [rows, last] = [lines[..8].concat(), lines[8].to_owned()];
        let counts = "# 1 failed, 1 inaccurate";
        assert_eq!(last, format!("{counts}, checksum {:016x}\n", fingerprint(&[&rows, counts])));
        let another = Some(format!("1.csv: this is a chunk of another sweep, or another chunk{REMEDY}"));
        let changed = Some(format!("1.csv: the checksum does not match: the file was edited or cut off{REMEDY}"));
        let assert_refused = |bytes: &[u8], is_first: bool| {
            fs::write(&path, bytes).expect("the chunk is written");
            let shown = String::from_utf8_lossy(bytes);
            assert_eq!(refusal(&chunks, 1), *if is_first { &another } else { &changed }, "{shown}");
        };
        for length in 0..whole.len() {
            assert_refused(&whole[..length], length < lines[0].len());
        }
        for place in 0..whole.len() {
            for bit in [1, 0x80] {
                let mut flipped = whole.clone();
                flipped[place] ^= bit;
                assert_refused(&flipped, place < lines[0].len());
            }
        }
        for line in 0..lines.len() {
            assert_refused(&[&lines[..line], &lines[line + 1..]].concat().concat().into_bytes(), line == 0);
            assert_refused(&[&lines[..=line], &lines[line..]].concat().concat().into_bytes(), false);
        }
        // Files that are not chunks of this sweep are rejected and rewritten.
        fs::copy(chunks.path(0), &path).expect("a copy");
        assert_eq!((refusal(&chunks, 1), chunks.has(1), chunks.is_made(1)), (another, true, false));
        write(&chunks, 1);
        assert_eq!((refusal(&chunks, 1), chunks.is_made(1)), (None, true));
        assert_eq!(fs::read(&path).expect("the chunk"), whole);
    }

    #[test]
    fn another_sweep_and_a_process_that_must_be_alone_are_refused() {
        let place = TestFolder::new("other");
        let refusal = |description: &Description, is_alone| place.resume(description, is_alone).err();
        let locked = Some("another process uses FOLDER; wait for it".to_owned());
        let chunks = place.chunks();
        assert_eq!([true, false].map(|is_alone| refusal(&description(), is_alone)), [locked.clone(), locked.clone()]);
        drop(chunks);
        let shard = place.resume(&description(), false);
        assert_eq!([false, true].map(|is_alone| refusal(&description(), is_alone)), [None, locked]);
        drop(shard);
        let mut other = description();
        other.items = 6;
        let message = |difference: &str| {
            Some(format!("FOLDER belongs to another sweep: {difference}; remove it, or name another output"))
        };
        assert_eq!(refusal(&other, true), message("its tables differ"));
        other.facts[0].1 = "Pendulum".to_owned();
        assert_eq!(refusal(&other, false), message("its system is `Kepler`, not `Pendulum`"));
    }

    #[test]
    fn descriptions_that_no_sweep_has_are_refused() {
        let place = TestFolder::new("descriptions");
        drop(place.chunks());
        let path = place.0.join(DESCRIPTION);
        let good = fs::read_to_string(&path).expect("the description");
        let good: serde_json::Value = serde_json::from_str(&good).expect("JSON");
        let folder = place.0.display();
        let what = "does not describe a sweep of this version of vi-lab";
        for (pointer, value) in [
            ("/items", "1e18"),
            ("/items", "-1"),
            ("/chunk", "0"),
            ("/headings", "[]"),
            ("/headings", "[null, null, null, null]"),
        ] {
            let mut bad = good.clone();
            *bad.pointer_mut(pointer).expect("an entry") = serde_json::from_str(value).expect("JSON");
            fs::write(&path, bad.to_string()).expect("the description is written");
            let message = Chunks::open(&place.0).err().map(|failure| failure.to_string()).unwrap_or_default();
            let remedy = format!("remove {folder}, and run `vi-lab sweep` again");
            assert_eq!(message, format!("{folder}/{DESCRIPTION} {what}; {remedy}"), "{pointer} {value}");
        }
        // The largest claim needs neither memory nor time.
        let mut most = good;
        *most.pointer_mut("/items").expect("an entry") = u64::MAX.into();
        fs::write(&path, most.to_string()).expect("the description is written");
        let chunks = Chunks::open(&place.0).unwrap_or_else(|failure| panic!("{failure}"));
        let all = chunks.description.chunks();
        assert_eq!((chunks.is_made(all - 1), chunks.description.runs(&(all - 1..all)).end), (false, u64::MAX));
    }

    #[test]
    fn fingerprints_are_those_of_fnv_1a() {
        // Published test values of the function.
        assert_eq!([fingerprint(&[]), fingerprint(&["foo", "bar"])], [0xcbf2_9ce4_8422_2325, 0x8594_4171_f739_67e8]);
    }
}
