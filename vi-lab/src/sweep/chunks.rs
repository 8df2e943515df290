//! The folder `FILE.part`, which contains the chunks of a sweep until they are merged.
//!
//! `sweep.json` is the [`Description`] of the sweep. `K.csv` is chunk K: a first line with the fingerprint of the
//! description and K; the rows, each after the name of its table, with the row of a run after its rows in other tables;
//! a last line with counts of rows and failures, and a checksum of all text before. A process writes a chunk under a
//! temporary name, syncs it and renames it. So an existing chunk is complete, for any number of processes.

use super::schema::{Column, MOST, Schema};
use crate::place::{self, Temporary};
use core::ops::Range;
use serde::{Deserialize, Serialize};
use std::fs::{self, File, OpenOptions, TryLockError};
use std::io::{self, BufRead as _, BufReader, BufWriter, Read as _, Write as _};
use std::path::{Path, PathBuf};
use vi_report::failure::Failure;
use vi_report::input;

const DESCRIPTION: &str = "sweep.json";
const LOCK: &str = "lock";
/// What stands before the checksum in the last line of a chunk.
const CHECKSUM: &str = ", checksum ";
/// Maximum bytes of an entry of a row, with its comma.
const LONGEST_ENTRY: usize = 64;

/// All inputs of the tables of a sweep.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub(super) struct Description {
    /// Names and values: version, system, method, varied quantities.
    pub(super) facts: Vec<(String, String)>,
    /// The number of runs.
    pub(super) items: u64,
    /// Number of runs in each chunk except the last.
    pub(super) chunk: u64,
    /// The tables; the first has a row for each run.
    pub(super) schemas: Vec<Schema>,
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

/// Receives a row with the index of its table.
pub(super) type Take<'a> = dyn FnMut(usize, &[f64]) -> Result<(), Failure> + 'a;

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
        serde_json::from_str(&text).ok().filter(Self::is_possible).ok_or_else(|| {
            let what = "does not describe a sweep of this version of vi-lab";
            Failure::Input(format!("{shown}/{DESCRIPTION} {what}; remove {shown}, and run `vi-lab sweep` again"))
        })
    }

    /// Whether a sweep can have this description. Names of tables become file names.
    fn is_possible(&self) -> bool {
        let is_table = |schema: &Schema| {
            ["runs", "section", "series"].contains(&schema.table.as_str())
                && schema.columns.first() == Some(&Column::count("item"))
        };
        self.items < MOST
            && (1..MOST).contains(&self.chunk)
            && self.schemas.first().is_some_and(|first| first.table == "runs")
            && self.schemas.iter().all(is_table)
            && self.schemas.windows(2).all(|pair| pair[0].table < pair[1].table)
    }

    /// The difference from another description, in words.
    pub(super) fn difference(&self, wanted: &Self) -> Option<String> {
        let mut pairs = self.facts.iter().zip(&wanted.facts).filter(|(here, wanted)| here != wanted);
        let fact = pairs.next().map(|((name, here), (_, wanted))| format!("its {name} is `{here}`, not `{wanted}`"));
        fact.or_else(|| (self != wanted).then(|| "its tables differ".to_owned()))
    }

    /// Number of chunks.
    pub(super) fn chunks(&self) -> u64 {
        self.items.div_ceil(self.chunk)
    }

    /// The runs of a range of chunks.
    pub(super) fn runs(&self, chunks: &Range<u64>) -> Range<u64> {
        let [start, end] = [chunks.start, chunks.end].map(|chunk| self.items.min(chunk * self.chunk));
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

    /// Writes a chunk. `follow` adds the rows of a run to the tables, and returns whether it failed.
    ///
    /// # Errors
    /// [`Failure::File`] if it cannot be written; the chunk then does not exist.
    pub(super) fn write(&self, number: u64, follow: impl FnMut(u64, &mut [Vec<f64>]) -> bool) -> Result<(), Failure> {
        let path = self.path(number);
        self.try_write(&path, number, follow).map_err(|error| {
            let advice = "the other chunks are complete; correct the error, then the same command resumes from them";
            Failure::file(path, io::Error::new(error.kind(), format!("{error}; {advice}")))
        })
    }

    fn try_write(
        &self,
        path: &Path,
        number: u64,
        mut follow: impl FnMut(u64, &mut [Vec<f64>]) -> bool,
    ) -> io::Result<()> {
        let (temporary, file) = Temporary::create(path)?;
        let mut file = BufWriter::with_capacity(1 << 16, file);
        let first = self.first_line(number);
        file.write_all(first.as_bytes())?;
        let mut sum = fingerprint(&[first.as_str()]);
        let schemas = &self.description.schemas;
        let mut tables = vec![Vec::new(); schemas.len()];
        let (mut text, mut rows, mut failed) = (String::new(), 0_u64, 0_u64);
        for item in self.description.runs(&(number..number + 1)) {
            failed += u64::from(follow(item, &mut tables));
            for (schema, numbers) in schemas.iter().zip(&mut tables).rev() {
                for row in numbers.chunks_exact(schema.columns.len()) {
                    text.clear();
                    text.push_str(&schema.table);
                    text.push(',');
                    schema.write(row, &mut text);
                    file.write_all(text.as_bytes())?;
                    sum = hashed(sum, text.as_bytes());
                    rows += 1;
                }
                numbers.clear();
            }
        }
        let counts = format!("# {rows} rows, {failed} failed");
        writeln!(file, "{counts}{CHECKSUM}{:016x}", hashed(sum, counts.as_bytes()))?;
        file.into_inner()?.sync_all()?;
        temporary.finish()
    }

    /// Reads a chunk and passes every row to `take`. Returns the number of failed runs.
    ///
    /// # Errors
    /// [`Failure::Input`] if it is missing, belongs to another sweep, or was changed; [`Failure::File`] if it cannot be
    /// read.
    #[allow(clippy::cast_precision_loss, clippy::float_cmp)] // items below 2^53, which are exact
    pub(super) fn read(&self, number: u64, take: &mut Take) -> Result<u64, Failure> {
        let schemas = &self.description.schemas;
        let path = self.path(number);
        input::check_regular(&path)?;
        let failed = |error| Failure::file(&path, error);
        let longest = LONGEST_ENTRY * schemas.iter().map(|schema| schema.columns.len() + 1).max().unwrap_or(1);
        let mut file = BufReader::with_capacity(1 << 16, File::open(&path).map_err(failed)?);
        let mut items = self.description.runs(&(number..number + 1));
        let (mut row, mut line, mut lines) = (Vec::new(), Vec::new(), 0_u64);
        let mut sum = fingerprint(&[]);
        loop {
            line.clear();
            (&mut file).take(longest as u64).read_until(b'\n', &mut line).map_err(failed)?;
            let wrong = |what: &str| {
                let remedy = "remove this file, and run the same `vi-lab sweep` again";
                Failure::Input(format!("{}, line {}: {what}; {remedy}", path.display(), lines + 1))
            };
            let text = str::from_utf8(&line).ok().and_then(|line| line.strip_suffix('\n'));
            let text = text.ok_or_else(|| wrong("the line is truncated or not text"))?;
            if lines == 0 {
                if text != self.first_line(number).trim_end() {
                    return Err(wrong("this is a chunk of another sweep, or another chunk"));
                }
            } else if text.starts_with('#') {
                let (counts, checksum) = text.split_once(CHECKSUM).unwrap_or((text, ""));
                let rows = lines - 1;
                let failures =
                    counts.strip_prefix(&format!("# {rows} rows, ")).and_then(|end| end.strip_suffix(" failed"));
                let failures = failures.and_then(|failures| failures.parse().ok()).filter(|failures| *failures <= rows);
                let failures = failures.filter(|_| items.is_empty());
                let failures = failures.ok_or_else(|| wrong("rows above are missing or added"))?;
                if checksum != format!("{:016x}", hashed(sum, counts.as_bytes())) {
                    return Err(wrong("the checksum does not match: the file was edited"));
                }
                let is_last = file.fill_buf().map_err(failed)?.is_empty();
                return if is_last { Ok(failures) } else { Err(wrong("there is text after the last line")) };
            } else {
                let (table, text) = text.split_once(',').unwrap_or_default();
                let table = schemas.iter().position(|schema| schema.table == table);
                let table = table.ok_or_else(|| wrong("the line does not start with a table of this sweep"))?;
                schemas[table].read(text, &mut row).map_err(|what| wrong(&what))?;
                if items.is_empty() || row[0] != items.start as f64 {
                    return Err(wrong(&format!("a row of run {} cannot be here: rows are missing or added", row[0])));
                }
                take(table, &row)?;
                items.start += u64::from(table == 0);
            }
            sum = hashed(sum, &line);
            lines += 1;
        }
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
        let columns = vec![Column::count("item"), Column::number("x")];
        let schemas =
            ["runs", "series"].map(|table| Schema { table: table.to_owned(), columns: columns.clone() }).to_vec();
        Description { facts: vec![("system".to_owned(), "Kepler".to_owned())], items: 5, chunk: 2, schemas }
    }

    /// Run k with k rows of series. Run 3 fails.
    #[allow(clippy::cast_precision_loss)] // a few
    fn follow(item: u64, tables: &mut [Vec<f64>]) -> bool {
        tables[0].extend([item as f64, -0.5]);
        tables[1].extend((0..item).flat_map(|place| [item as f64, 0.5 * place as f64]));
        item == 3
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
        let mut rows = Vec::new();
        let mut take = |table: usize, row: &[f64]| {
            rows.push((table, row.to_vec()));
            Ok(())
        };
        assert_eq!([1, 2].map(|number| chunks.read(number, &mut take).ok()), [Some(1), Some(0)]);
        let runs: Vec<f64> = rows.iter().filter(|(table, _)| *table == 0).map(|(_, row)| row[0]).collect();
        assert_eq!((runs, rows.len()), (vec![2.0, 3.0, 4.0], 12));
        assert_eq!(rows[..3], [(1, vec![2.0, 0.0]), (1, vec![2.0, 0.5]), (0, vec![2.0, -0.5])]);
    }

    #[test]
    fn two_processes_that_write_one_chunk_leave_it_whole() {
        let place = TestFolder::new("two");
        let chunks = place.chunks();
        write(&chunks, 1);
        let alone = fs::read(chunks.path(1)).expect("the chunk");
        // The second process starts and ends while the first one writes.
        let other = Chunks::open(&place.0).unwrap_or_else(|failure| panic!("{failure}"));
        let both = chunks.write(1, |item, tables| {
            write(&other, 1);
            assert_eq!(fs::read(chunks.path(1)).expect("the chunk"), alone);
            follow(item, tables)
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
        let whole = fs::read_to_string(&path).expect("the chunk");
        let lines: Vec<&str> = whole.lines().collect();
        let rows = ["series,2,0.0", "series,2,0.5", "runs,2,-0.5", "series,3,0.0", "series,3,0.5", "series,3,1.0"];
        assert_eq!((&lines[1..7], lines[7]), (rows.as_slice(), "runs,3,-0.5"));
        let (last, sum) = lines[8].split_once(CHECKSUM).expect("a checksum");
        let before = &whole[..whole.len() - CHECKSUM.len() - 17];
        assert_eq!((last, sum), ("# 7 rows, 1 failed", format!("{:016x}", fingerprint(&[before])).as_str()));
        let without = |line: usize| [&lines[..line], &lines[line + 1..]].concat().join("\n") + "\n";
        let changed = |line: usize, text: &str| whole.replacen(lines[line], text, 1);
        let (counts, cut) = ("rows above are missing or added", "the line is truncated or not text");
        let edited = "the checksum does not match: the file was edited";
        let misplaced = |run: u64| format!("a row of run {run} cannot be here: rows are missing or added");
        for (text, line, what) in [
            (without(0), 1, "this is a chunk of another sweep, or another chunk"),
            (without(1), 8, counts),
            (without(3), 4, misplaced(3).as_str()),
            (without(7), 8, counts),
            (without(8), 9, cut),
            (changed(1, "series,2,0.0\nseries,2,0.0"), 10, counts),
            (changed(1, "series,3,0.0"), 2, &misplaced(3)),
            (changed(3, "runs,2,-0.5\nruns,2,-0.5"), 5, &misplaced(2)),
            (changed(7, "runs,3,-0.5\nruns,4,-0.5"), 9, &misplaced(4)),
            (changed(3, "runs,2"), 4, "the row of `runs` has 1 columns instead of 2"),
            (changed(3, "runs,2,-0.5,1.0"), 4, "the row of `runs` has 3 columns instead of 2"),
            (changed(3, "runs,2,half"), 4, "`half` cannot be an entry of the column `x`"),
            (changed(3, "runs,-2,0.5"), 4, "`-2` cannot be an entry of the column `item`"),
            (changed(3, "section,2,0.5"), 4, "the line does not start with a table of this sweep"),
            (changed(3, ""), 4, "the line does not start with a table of this sweep"),
            (changed(3, &"9".repeat(1000)), 4, cut),
            (changed(8, "# 6 rows, 1 failed"), 9, counts),
            (changed(8, "# 7 rows, 18446744073709551615 failed"), 9, counts),
            (changed(8, &format!("{}\nruns,4,-0.5", lines[8])), 9, "there is text after the last line"),
            // Rows that could be those of a chunk.
            (changed(3, "runs,2,-0.25"), 9, edited),
            (changed(3, "runs,2,"), 9, edited),
            (changed(1, "series,2,-0.0"), 9, edited),
            (without(1).replacen("# 7 rows", "# 6 rows", 1), 8, edited),
            (changed(8, &lines[8].replacen("1 failed", "0 failed", 1)), 9, edited),
            (changed(8, "# 7 rows, 1 failed"), 9, edited),
            (changed(8, "# 7 rows, 1 failed, checksum "), 9, edited),
            (changed(8, &format!("{} ", lines[8])), 9, edited),
        ] {
            assert!(text != whole);
            fs::write(&path, &text).expect("the chunk is written");
            assert_eq!(refusal(&chunks, 1), Some(format!("1.csv, line {line}: {what}{REMEDY}")), "{text}");
        }
        for length in 0..whole.len() {
            fs::write(&path, &whole[..length]).expect("the chunk is written");
            let found = refusal(&chunks, 1).unwrap_or_default();
            assert!(found.ends_with(&format!("{cut}{REMEDY}")), "{length} bytes: {found}");
        }
        fs::write(&path, b"\xff\n").expect("the chunk is written");
        assert_eq!(refusal(&chunks, 1), Some(format!("1.csv, line 1: {cut}{REMEDY}")));
        // Files that are not chunks of this sweep are rejected and rewritten.
        fs::copy(chunks.path(0), &path).expect("a copy");
        let another = format!("1.csv, line 1: this is a chunk of another sweep, or another chunk{REMEDY}");
        assert_eq!((refusal(&chunks, 1), chunks.has(1), chunks.is_made(1)), (Some(another), true, false));
        write(&chunks, 1);
        assert_eq!((refusal(&chunks, 1), chunks.is_made(1)), (None, true));
        assert_eq!(fs::read_to_string(&path).expect("the chunk"), whole);
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
            ("/items", "1000000000000000000"),
            ("/items", "-1"),
            ("/chunk", "0"),
            ("/chunk", "18446744073709551615"),
            ("/schemas", "[]"),
            ("/schemas/0/columns", "[]"),
            ("/schemas/1/columns", "[]"),
            ("/schemas/1/columns/0/name", "\"x\""),
            ("/schemas/0/table", "\"series\""),
            ("/schemas/1/table", "\"runs\""),
            ("/schemas/1/table", "\"../series\""),
            ("/schemas/1/table", "\"\""),
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
        *most.pointer_mut("/items").expect("an entry") = (MOST - 1).into();
        fs::write(&path, most.to_string()).expect("the description is written");
        let chunks = Chunks::open(&place.0).unwrap_or_else(|failure| panic!("{failure}"));
        let all = chunks.description.chunks();
        assert_eq!((chunks.is_made(all - 1), chunks.description.runs(&(all - 1..all)).end), (false, MOST - 1));
    }

    #[test]
    fn fingerprints_are_those_of_fnv_1a() {
        // Published test values of the function.
        assert_eq!([fingerprint(&[]), fingerprint(&["foo", "bar"])], [0xcbf2_9ce4_8422_2325, 0x8594_4171_f739_67e8]);
    }
}
