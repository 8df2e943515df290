//! The folder of a shard while its sweep is under way: a heading, and one CSV file for each chunk of runs.
//!
//! `sweep.json` is the [`Heading`]. `K.csv` is chunk K. Its first line has the fingerprint of the heading and K, and its last line counts rows and
//! failures. Between them are the rows, each behind the name of its table; the row of a run follows its rows in other tables. A process writes
//! a chunk under a temporary name, syncs it and renames it. So every chunk that is there is whole, even if two processes wrote it.

use super::schema::{Column, MOST, Schema};
use super::shard::Shard;
use crate::place::{self, Temporary};
use core::ops::Range;
use serde::{Deserialize, Serialize};
use std::fs::{self, File, OpenOptions, TryLockError};
use std::io::{self, BufRead as _, BufReader, BufWriter, Read as _, Write as _};
use std::path::{Path, PathBuf};
use vi_report::failure::Failure;

/// The file of the heading.
const HEADING: &str = "sweep.json";
/// The file that a process locks while it works on the part.
const LOCK: &str = "lock";
/// Bytes of an entry of a row at most, with its comma.
const LONGEST_ENTRY: usize = 64;

/// Which runs a part holds.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub(super) struct Heading {
    pub(super) sweep: Description,
    pub(super) shard: Shard,
    /// Runs in each chunk but the last.
    pub(super) chunk: u64,
}

/// Everything that the tables of a sweep depend on.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub(super) struct Description {
    /// Names and values: version, system, method, what differs from run to run.
    pub(super) facts: Vec<(String, String)>,
    /// The number of runs.
    pub(super) items: u64,
    /// The tables; the first has a row for each run.
    pub(super) schemas: Vec<Schema>,
}

/// The part of one shard.
#[derive(Debug)]
pub(super) struct Part {
    pub(super) folder: PathBuf,
    pub(super) heading: Heading,
    fingerprint: u64,
    /// Locked until the part is dropped.
    _lock: Option<File>,
}

/// Gets a row, and the index of its table.
pub(super) type Take<'a> = dyn FnMut(usize, &[f64]) -> Result<(), Failure> + 'a;

/// A chunk that is being written.
pub(super) struct Chunk<'a> {
    schemas: &'a [Schema],
    file: BufWriter<File>,
    temporary: Temporary,
    text: String,
    rows: u64,
    failed: u64,
}

impl Heading {
    /// The heading of the part in a folder.
    ///
    /// # Errors
    /// [`Failure::Input`] if there is none, or no sweep has it.
    fn read(folder: &Path) -> Result<Self, Failure> {
        let shown = folder.display();
        let text = place::text(&folder.join(HEADING));
        let text = text.map_err(|failure| Failure::Input(format!("{shown} is not a part of a sweep: {failure}")))?;
        serde_json::from_str(&text).ok().filter(Self::is_possible).ok_or_else(|| {
            let what = "is not the heading of a sweep of this version of vi-lab; remove this part, and make it again";
            Failure::Input(format!("{shown}/{HEADING} {what}"))
        })
    }

    /// Whether a sweep can have this heading. Names of tables become names of files.
    fn is_possible(&self) -> bool {
        let Self { sweep: Description { items, schemas, .. }, shard, chunk } = self;
        let is_table = |schema: &Schema| {
            ["runs", "section", "series"].contains(&schema.table.as_str())
                && schema.columns.first() == Some(&Column::count("item"))
        };
        (1..MOST).contains(chunk)
            && *items < MOST
            && shard.index < shard.count
            && schemas.first().is_some_and(|first| first.table == "runs")
            && schemas.iter().all(is_table)
            && schemas.windows(2).all(|pair| pair[0].table < pair[1].table)
    }

    /// Number of chunks.
    pub(super) fn chunks(&self) -> u64 {
        self.runs().div_ceil(self.chunk)
    }

    /// Number of runs.
    pub(super) fn runs(&self) -> u64 {
        let items = self.shard.items(self.sweep.items);
        items.end - items.start
    }

    /// The runs of a chunk.
    pub(super) fn items(&self, chunk: u64) -> Range<u64> {
        let items = self.shard.items(self.sweep.items);
        let start = items.start + chunk * self.chunk;
        start..items.end.min(start + self.chunk)
    }

    fn json(&self) -> String {
        // Names, words and counts are always JSON.
        serde_json::to_string_pretty(self).unwrap_or_default()
    }
}

impl Description {
    /// The first fact that differs in `other`: its name, and its values here and there.
    pub(super) fn difference<'a>(&'a self, other: &'a Self) -> Option<(&'a str, &'a str, &'a str)> {
        let mut pairs = self.facts.iter().zip(&other.facts);
        let differs = pairs.find(|(here, there)| here != there);
        let named = differs.map(|((name, here), (_, there))| (name.as_str(), here.as_str(), there.as_str()));
        named.or_else(|| (self != other).then_some(("tables", "its own", "other ones")))
    }
}

impl Part {
    /// The part in a folder, to add chunks to it; makes it if there is none.
    ///
    /// # Errors
    /// [`Failure::Input`] if the folder is something else or of another sweep, or another process works on it; [`Failure::File`] if
    /// a file cannot be read or written.
    pub(super) fn resume(folder: &Path, heading: Heading) -> Result<Self, Failure> {
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
            place::check_regular(&lock)?;
        }
        let lock = OpenOptions::new().read(true).write(true).create(true).truncate(false).open(lock).map_err(failed)?;
        match lock.try_lock() {
            Ok(()) => remove_temporaries(folder).map_err(failed)?,
            Err(TryLockError::WouldBlock) => {
                return Err(Failure::Input(format!("another process works on {shown}; wait for it")));
            }
            // Some file systems of clusters have no locks. Two processes then write the same chunks.
            Err(TryLockError::Error(_)) => {}
        }
        if folder.join(HEADING).exists() {
            let there = Heading::read(folder)?;
            if let Some((name, there, here)) = there.sweep.difference(&heading.sweep) {
                return Err(Failure::Input(format!(
                    "{shown} is of another sweep, by its {name}: {there} there, {here} here; remove it, or name another output"
                )));
            }
            if there != heading {
                return Err(Failure::Input(format!("{shown} is another shard; remove it")));
            }
        } else {
            place::replace(&folder.join(HEADING), &heading.json()).map_err(failed)?;
        }
        Ok(Self::of(folder, heading, Some(lock)))
    }

    /// The part in a folder, to read it.
    ///
    /// # Errors
    /// [`Failure::Input`] if there is none.
    pub(super) fn open(folder: &Path) -> Result<Self, Failure> {
        Ok(Self::of(folder, Heading::read(folder)?, None))
    }

    fn of(folder: &Path, heading: Heading, lock: Option<File>) -> Self {
        let fingerprint = fingerprint(&[heading.json().as_str()]);
        Self { folder: folder.to_owned(), heading, fingerprint, _lock: lock }
    }

    /// The file of a chunk.
    fn path(&self, chunk: u64) -> PathBuf {
        self.folder.join(format!("{chunk}.csv"))
    }

    /// The first line of a chunk.
    fn first_line(&self, chunk: u64) -> String {
        format!("# vi-lab sweep {:016x}, chunk {chunk}\n", self.fingerprint)
    }

    /// Whether a chunk is there.
    pub(super) fn has(&self, chunk: u64) -> bool {
        self.path(chunk).exists()
    }

    /// Number of chunks that are there.
    ///
    /// # Errors
    /// [`Failure::File`] if the folder cannot be read.
    pub(super) fn present(&self) -> Result<u64, Failure> {
        let mut present = 0;
        let failed = |error| Failure::file(&self.folder, error);
        for entry in fs::read_dir(&self.folder).map_err(failed)? {
            let name = entry.map_err(failed)?.file_name();
            let number = name.to_str().and_then(|name| name.strip_suffix(".csv")?.parse::<u64>().ok());
            let is_chunk =
                number.is_some_and(|number| number < self.heading.chunks() && self.path(number).ends_with(&name));
            present += u64::from(is_chunk);
        }
        Ok(present)
    }

    /// Writes a chunk: `fill` adds its runs.
    ///
    /// # Errors
    /// [`Failure::File`] if it cannot be written; the chunk is then not there.
    pub(super) fn write(
        &self,
        number: u64,
        fill: impl FnOnce(&mut Chunk<'_>) -> io::Result<()>,
    ) -> Result<(), Failure> {
        let path = self.path(number);
        let written = Temporary::create(&path).and_then(|(temporary, file)| {
            let file = BufWriter::with_capacity(1 << 16, file);
            let text = self.first_line(number);
            let mut chunk = Chunk { schemas: &self.heading.sweep.schemas, file, temporary, text, rows: 0, failed: 0 };
            fill(&mut chunk)?;
            chunk.finish()
        });
        written.map_err(|error| {
            let advice = "the other chunks are whole; once this is mended, the same command goes on from them";
            Failure::file(path, io::Error::new(error.kind(), format!("{error}; {advice}")))
        })
    }

    /// Reads all chunks: `take` gets every row with the index of its table. Returns how many runs did not reach their end.
    ///
    /// # Errors
    /// [`Failure::Input`] if a chunk is not there, is of another sweep, or was changed; [`Failure::File`] if it cannot be read.
    pub(super) fn read(&self, take: &mut Take) -> Result<u64, Failure> {
        (0..self.heading.chunks()).try_fold(0, |failed, number| Ok(failed + self.read_chunk(number, take)?))
    }

    #[allow(clippy::cast_precision_loss, clippy::float_cmp)] // items below 2^53, which are exact
    fn read_chunk(&self, number: u64, take: &mut Take) -> Result<u64, Failure> {
        let schemas = &self.heading.sweep.schemas;
        let path = self.path(number);
        place::check_regular(&path)?;
        let failed = |error| Failure::file(&path, error);
        let shown = path.display();
        let longest = LONGEST_ENTRY * schemas.iter().map(|schema| schema.columns.len() + 1).max().unwrap_or(1);
        let mut file = BufReader::with_capacity(1 << 16, File::open(&path).map_err(failed)?);
        let mut items = self.heading.items(number);
        let (mut row, mut line, mut rows) = (Vec::new(), Vec::new(), 0_u64);
        for place in 1_u64.. {
            let wrong = |what: &str| {
                let remedy = "remove this file, and run the same `vi-lab sweep` again";
                Failure::Input(format!("{shown}, line {place}: {what}; {remedy}"))
            };
            line.clear();
            (&mut file).take(longest as u64).read_until(b'\n', &mut line).map_err(failed)?;
            let text = str::from_utf8(&line).ok().and_then(|line| line.strip_suffix('\n'));
            let text = text.ok_or_else(|| wrong("the line is cut off or no text"))?;
            if place == 1 {
                if text != self.first_line(number).trim_end() {
                    return Err(wrong("this is a chunk of another sweep, or another chunk"));
                }
            } else if let Some(counts) = text.strip_prefix('#') {
                let failures =
                    counts.strip_prefix(&format!(" {rows} rows, ")).and_then(|end| end.strip_suffix(" failed"));
                let failures = failures.and_then(|failures| failures.parse().ok()).filter(|failures| *failures <= rows);
                let failures = failures.filter(|_| items.is_empty());
                let failures = failures.ok_or_else(|| wrong("rows above are missing or added"))?;
                return match file.fill_buf().map_err(failed)? {
                    [] => Ok(failures),
                    _ => Err(wrong("there is more after the last line")),
                };
            } else {
                let (table, text) = text.split_once(',').unwrap_or_default();
                let table = schemas.iter().position(|schema| schema.table == table);
                let table = table.ok_or_else(|| wrong("the line begins with no table of this sweep"))?;
                schemas[table].read(text, &mut row).map_err(|what| wrong(&what))?;
                if items.is_empty() || row[0] != items.start as f64 {
                    return Err(wrong(&format!("a row of run {} cannot be here: rows are missing or added", row[0])));
                }
                take(table, &row)?;
                rows += 1;
                items.start += u64::from(table == 0);
            }
        }
        Ok(0)
    }

    /// Removes the folder.
    ///
    /// # Errors
    /// [`Failure::File`] if it cannot be removed.
    pub(super) fn remove(&self) -> Result<(), Failure> {
        fs::remove_dir_all(&self.folder).map_err(|error| Failure::file(&self.folder, error))
    }
}

impl Chunk<'_> {
    /// Adds the rows of one run, and empties the tables.
    ///
    /// # Errors
    /// Why they cannot be written.
    pub(super) fn add(&mut self, tables: &mut [Vec<f64>], is_failed: bool) -> io::Result<()> {
        for (schema, numbers) in self.schemas.iter().zip(tables).rev() {
            for row in numbers.chunks_exact(schema.columns.len()) {
                self.text.clear();
                schema.write(row, &mut self.text);
                write!(self.file, "{},{}", schema.table, self.text)?;
                self.rows += 1;
            }
            numbers.clear();
        }
        self.failed += u64::from(is_failed);
        Ok(())
    }

    /// Puts the file in its place.
    fn finish(mut self) -> io::Result<()> {
        writeln!(self.file, "# {} rows, {} failed", self.rows, self.failed)?;
        self.file.into_inner()?.sync_all()?;
        self.temporary.finish()
    }
}

/// Removes what processes that were killed left of chunks.
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
    let bytes = texts.iter().flat_map(|text| text.bytes());
    bytes.fold(0xcbf2_9ce4_8422_2325, |hash, byte| (hash ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A folder for one test, which goes with the value.
    struct Place(PathBuf);

    impl Place {
        fn new(name: &str) -> Self {
            let place = Self(std::env::temp_dir().join(format!("vi-lab-{name}-{}", std::process::id())));
            let _ = fs::remove_dir_all(&place.0);
            place
        }

        fn resume(&self, heading: &Heading) -> Result<Part, String> {
            let part = Part::resume(&self.0, heading.clone());
            part.map_err(|failure| failure.to_string().replace(&self.0.display().to_string(), "PART"))
        }

        fn part(&self) -> Part {
            self.resume(&heading()).unwrap_or_else(|message| panic!("{message}"))
        }
    }

    impl Drop for Place {
        fn drop(&mut self) {
            let _ = fs::remove_dir_all(&self.0);
        }
    }

    /// The second half of ten runs, in chunks of two.
    fn heading() -> Heading {
        let columns = vec![Column::count("item"), Column::number("x")];
        let schemas =
            ["runs", "series"].map(|table| Schema { table: table.to_owned(), columns: columns.clone() }).to_vec();
        let facts = vec![("system".to_owned(), "Kepler".to_owned())];
        Heading { sweep: Description { facts, items: 10, schemas }, shard: Shard { index: 1, count: 2 }, chunk: 2 }
    }

    /// Run k with k - 4 rows of series, of which run 6 fails.
    #[allow(clippy::cast_precision_loss)] // a few
    fn fill(heading: &Heading, number: u64, chunk: &mut Chunk<'_>) -> io::Result<()> {
        heading.items(number).try_for_each(|item| {
            let series = (4..item).flat_map(|x| [item as f64, 1.0 / x as f64]).collect();
            chunk.add(&mut [vec![item as f64, -0.5], series], item == 6)
        })
    }

    fn write(part: &Part, number: u64) {
        let written = part.write(number, |chunk| fill(&part.heading, number, chunk));
        written.unwrap_or_else(|failure| panic!("{failure}"));
    }

    fn message(part: &Part) -> Option<String> {
        let read = part.read(&mut |_, _| Ok(()));
        read.err().map(|failure| failure.to_string().replace(&format!("{}/", part.folder.display()), ""))
    }

    const REMEDY: &str = "; remove this file, and run the same `vi-lab sweep` again";

    #[test]
    fn chunks_are_there_once_they_are_whole() {
        let place = Place::new("chunks");
        let part = place.part();
        assert_eq!((part.heading.chunks(), part.heading.items(2)), (3, 9..10));
        for number in [2, 0] {
            write(&part, number);
        }
        let failed = part.write(1, |chunk| {
            fill(&part.heading, 1, chunk)?;
            Err(io::Error::from(io::ErrorKind::StorageFull))
        });
        let message = failed.map_err(|failure| (failure.exit_status(), failure.to_string()));
        let advice =
            "no storage space; the other chunks are whole; once this is mended, the same command goes on from them";
        assert_eq!(message, Err((1, format!("{}: {advice}", part.path(1).display()))));
        for other in ["01.csv", "3.csv", "+1.csv", "1.csv.tmp-1-0", "a.csv"] {
            fs::write(part.folder.join(other), "").expect("a file");
        }
        assert_eq!((part.present().ok(), [0, 1, 2].map(|number| part.has(number))), (Some(2), [true, false, true]));
        drop(part);
        let part = place.part();
        assert!(!part.folder.join("1.csv.tmp-1-0").exists(), "what a killed process left is removed");
        write(&part, 1);
        let mut rows = Vec::new();
        let read = part.read(&mut |table, row| {
            rows.push((table, row.to_vec()));
            Ok(())
        });
        assert_eq!(read.ok(), Some(1));
        let runs: Vec<f64> = rows.iter().filter(|(table, _)| *table == 0).map(|(_, row)| row[0]).collect();
        assert_eq!((runs, rows.len()), (vec![5.0, 6.0, 7.0, 8.0, 9.0], 20));
        assert_eq!(rows[..2], [(1, vec![5.0, 0.25]), (0, vec![5.0, -0.5])]);
    }

    #[test]
    fn two_processes_that_write_one_chunk_leave_it_whole() {
        let place = Place::new("two");
        let part = place.part();
        write(&part, 0);
        let alone = fs::read(part.path(0)).expect("the chunk");
        // A file system without locks: the second begins and ends while the first writes.
        let other = Part::open(&place.0).unwrap_or_else(|failure| panic!("{failure}"));
        let both = part.write(0, |chunk| {
            write(&other, 0);
            assert_eq!(fs::read(part.path(0)).expect("the chunk"), alone);
            fill(&part.heading, 0, chunk)
        });
        assert!(both.is_ok());
        assert_eq!(fs::read(part.path(0)).expect("the chunk"), alone);
    }

    #[test]
    fn a_chunk_that_was_changed_is_refused() {
        let place = Place::new("changed");
        let part = place.part();
        (0..3).for_each(|number| write(&part, number));
        let whole = fs::read_to_string(part.path(0)).expect("the chunk");
        let lines: Vec<&str> = whole.lines().collect();
        assert_eq!(lines[1..5], ["series,5,0.25", "runs,5,-0.5", "series,6,0.25", "series,6,0.2"]);
        let without = |line: usize| [&lines[..line], &lines[line + 1..]].concat().join("\n") + "\n";
        let changed = |line: usize, text: &str| whole.replacen(lines[line], text, 1);
        let counts = "rows above are missing or added";
        for (text, line, what) in [
            (String::new(), 1, "the line is cut off or no text"),
            (without(0), 1, "this is a chunk of another sweep, or another chunk"),
            (without(1), 6, counts),
            (without(2), 3, "a row of run 6 cannot be here: rows are missing or added"),
            (without(5), 6, counts),
            (without(6), 7, "the line is cut off or no text"),
            (changed(3, "series,6,0.25\nseries,6,0.25"), 8, counts),
            (changed(2, "runs,5,-0.5\nruns,5,-0.5"), 4, "a row of run 5 cannot be here: rows are missing or added"),
            (changed(5, "runs,6,-0.5\nruns,7,-0.5"), 7, "a row of run 7 cannot be here: rows are missing or added"),
            (changed(1, "series,6,0.25"), 2, "a row of run 6 cannot be here: rows are missing or added"),
            (changed(2, "runs,5"), 3, "the row of `runs` has 1 columns instead of 2"),
            (changed(2, "runs,5,-0.5,1.0"), 3, "the row of `runs` has 3 columns instead of 2"),
            (changed(2, "runs,5,half"), 3, "`half` cannot be an entry of the column `x`"),
            (changed(2, "runs,-5,0.5"), 3, "`-5` cannot be an entry of the column `item`"),
            (changed(2, "section,5,0.5"), 3, "the line begins with no table of this sweep"),
            (changed(2, ""), 3, "the line begins with no table of this sweep"),
            (changed(2, &"9".repeat(1000)), 3, "the line is cut off or no text"),
            (changed(6, "# 5 rows, 18446744073709551615 failed"), 7, counts),
            (changed(6, "# 5 rows, 1 failed\nruns,7,-0.5"), 7, "there is more after the last line"),
        ] {
            fs::write(part.path(0), &text).expect("the chunk is written");
            assert_eq!(message(&part), Some(format!("0.csv, line {line}: {what}{REMEDY}")), "{text}");
        }
        // A file that is cut anywhere.
        for length in 0..whole.len() {
            fs::write(part.path(0), &whole[..length]).expect("the chunk is written");
            let found = message(&part).unwrap_or_default();
            assert!(found.ends_with(&format!("the line is cut off or no text{REMEDY}")), "{length}: {found}");
        }
        fs::write(part.path(0), b"\xff\n").expect("the chunk is written");
        assert_eq!(message(&part), Some(format!("0.csv, line 1: the line is cut off or no text{REMEDY}")));
        fs::copy(part.path(1), part.path(0)).expect("a copy");
        let another = "this is a chunk of another sweep, or another chunk";
        assert_eq!(message(&part), Some(format!("0.csv, line 1: {another}{REMEDY}")));
        fs::write(part.path(0), &whole).expect("the chunk is written");
        assert_eq!(message(&part), None);
    }

    #[test]
    fn another_sweep_another_shard_and_a_second_process_are_refused() {
        let place = Place::new("other");
        let message = |heading: &Heading| place.resume(heading).err();
        let part = place.part();
        assert_eq!(message(&heading()).as_deref(), Some("another process works on PART; wait for it"));
        drop(part);
        assert_eq!(message(&heading()), None);
        let mut other = heading();
        other.shard.index = 0;
        assert_eq!(message(&other).as_deref(), Some("PART is another shard; remove it"));
        other.sweep.facts[0].1 = "Pendulum".to_owned();
        let expected =
            "PART is of another sweep, by its system: Kepler there, Pendulum here; remove it, or name another output";
        assert_eq!(message(&other).as_deref(), Some(expected));
    }

    #[test]
    fn headings_that_no_sweep_has_are_refused() {
        let place = Place::new("headings");
        drop(place.part());
        let path = place.0.join(HEADING);
        let good = fs::read_to_string(&path).expect("the heading");
        let good: serde_json::Value = serde_json::from_str(&good).expect("JSON");
        assert!(Part::open(&place.0).is_ok());
        for (pointer, value) in [
            ("/sweep/items", "1e18"),
            ("/sweep/items", "1000000000000000000"),
            ("/sweep/items", "-1"),
            ("/chunk", "0"),
            ("/chunk", "18446744073709551615"),
            ("/shard/index", "2"),
            ("/shard/count", "0"),
            ("/sweep/schemas", "[]"),
            ("/sweep/schemas/0/columns", "[]"),
            ("/sweep/schemas/1/columns", "[]"),
            ("/sweep/schemas/1/columns/0/name", "\"x\""),
            ("/sweep/schemas/0/table", "\"series\""),
            ("/sweep/schemas/1/table", "\"runs\""),
            ("/sweep/schemas/1/table", "\"../series\""),
            ("/sweep/schemas/1/table", "\"\""),
        ] {
            let mut heading = good.clone();
            *heading.pointer_mut(pointer).expect("an entry") = serde_json::from_str(value).expect("JSON");
            fs::write(&path, heading.to_string()).expect("the heading is written");
            let message = Part::open(&place.0).err().map(|failure| failure.to_string()).unwrap_or_default();
            let what = "is not the heading of a sweep of this version of vi-lab; remove this part, and make it again";
            assert_eq!(message, format!("{} {what}", path.display()), "{pointer} {value}");
        }
        // The most that a heading can claim takes neither memory nor time.
        let mut heading = good.clone();
        *heading.pointer_mut("/sweep/items").expect("an entry") = (MOST - 1).into();
        fs::write(&path, heading.to_string()).expect("the heading is written");
        let part = Part::open(&place.0).unwrap_or_else(|failure| panic!("{failure}"));
        let last = part.heading.chunks() - 1;
        assert_eq!((part.present().ok(), part.heading.items(last).end), (Some(0), MOST - 1));
    }

    #[test]
    fn fingerprints_are_those_of_fnv_1a() {
        // Published with the function.
        assert_eq!([fingerprint(&[]), fingerprint(&["foo", "bar"])], [0xcbf2_9ce4_8422_2325, 0x8594_4171_f739_67e8]);
    }
}
