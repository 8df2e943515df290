//! The file in which a shard stands while it is made, and until it is put together with the others.
//!
//! In: a [`Heading`] and [`Chunk`]s, in the order in which they are finished. Out: the file: a magic line, the heading, and each chunk, the last two
//! as their length, a checksum (CRC-32) and bytes; numbers are little-endian, those of tables float64. AFTER ANY END of the process, the file holds every
//! chunk that was finished, and perhaps a piece of one more, which is cut off when the file is opened again.
//!
//! A chunk is some runs that follow each other: each begins with its number and how many of its runs failed, then comes for each table the
//! number of its rows, then their numbers.

use super::shape::Shape;
use super::shard::Shard;
use crate::place;
use core::num::NonZeroU64;
use core::ops::Range;
use serde::{Deserialize, Serialize};
use std::fs::{File, OpenOptions, TryLockError};
use std::io::{self, BufReader, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};
use vi_report::failure::Failure;

/// How a part begins.
const MAGIC: &[u8] = b"vi-lab part 1\n";
/// Bytes of a length and a checksum.
const FRAME: usize = 12;

/// What a part is of.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub(super) struct Heading {
    /// The sweep.
    pub(super) study: Description,
    /// Which part of it.
    pub(super) shard: Shard,
    /// Runs in a chunk, but for the last.
    pub(super) chunk: u64,
}

/// A sweep, as far as its tables depend on it.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub(super) struct Description {
    /// Names and what they are: version, system, method, what differs from run to run.
    pub(super) facts: Vec<(String, String)>,
    /// The number of runs.
    pub(super) items: u64,
    /// The tables.
    pub(super) shapes: Vec<Shape>,
}

/// Some runs that follow each other.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Chunk {
    /// Its place among the chunks of the shard.
    pub(super) number: u64,
    /// How many of its runs did not reach their end.
    pub(super) failed: u64,
    /// The numbers of each table, row by row.
    pub(super) tables: Vec<Vec<f64>>,
}

/// What stands before the rows of a chunk.
struct Head {
    number: u64,
    failed: u64,
    /// Rows of each table.
    rows: Vec<u64>,
}

/// What is in the file of a part.
#[derive(Debug)]
pub(super) struct Part {
    path: PathBuf,
    heading: Heading,
    /// Where the frames of the chunks that are there begin, by the numbers of the chunks.
    offsets: Vec<Option<NonZeroU64>>,
    /// How many of the runs that are there did not reach their end.
    failed: u64,
    /// The rows of each table that are there.
    rows: Vec<u64>,
    /// Where the last whole chunk ends.
    end: u64,
}

/// A part that grows.
#[derive(Debug)]
pub(super) struct Growing {
    /// What is in it.
    pub(super) part: Part,
    file: File,
}

impl Heading {
    /// Whether there can be such a part, so that a foreign file is none.
    fn is_possible(&self) -> bool {
        self.chunk > 0 && self.shard.index < self.shard.count
    }

    /// Number of chunks.
    pub(super) fn chunks(&self) -> u64 {
        let items = self.shard.items(self.study.items);
        (items.end - items.start).div_ceil(self.chunk)
    }

    /// The items of a chunk.
    pub(super) fn items(&self, number: u64) -> Range<u64> {
        let items = self.shard.items(self.study.items);
        let start = items.start + number * self.chunk;
        start..items.end.min(start + self.chunk)
    }
}

impl Description {
    /// The first fact that is another one in `other`: its name, and what it is here and there.
    pub(super) fn difference<'a>(&'a self, other: &'a Self) -> Option<(&'a str, &'a str, &'a str)> {
        let mut pairs = self.facts.iter().zip(&other.facts);
        let differs = pairs.find(|(here, there)| here != there);
        let named = differs.map(|((name, here), (_, there))| (name.as_str(), here.as_str(), there.as_str()));
        named.or_else(|| (self != other).then_some(("tables", "its own", "other ones")))
    }
}

impl Growing {
    /// The part at a path, to go on with; a new one where there is none.
    ///
    /// # Errors
    /// [`Failure::Input`] where the file is something else, of another sweep, or another process works on it; [`Failure::File`] where
    /// it cannot be read or written.
    pub(super) fn resume(path: &Path, heading: &Heading) -> Result<Self, Failure> {
        let failed = |error| Failure::file(path, error);
        if path.exists() {
            place::check_regular(path)?;
        }
        let file = OpenOptions::new().read(true).write(true).create(true).truncate(false).open(path).map_err(failed)?;
        match file.try_lock() {
            Err(TryLockError::WouldBlock) => {
                return Err(Failure::Input(format!("another process works on {}; wait for it", path.display())));
            }
            // Some file systems of clusters know no locks.
            Ok(()) | Err(TryLockError::Error(_)) => {}
        }
        let begun = beginning(heading);
        let mut start = Vec::new();
        (&file).take(begun.len() as u64).read_to_end(&mut start).map_err(failed)?;
        if start.len() < begun.len() && begun.starts_with(&start) {
            // New, or ended before its heading was whole.
            write_at(&file, 0, &begun).map_err(failed)?;
        }
        let part = Part::read(path)?;
        if let Some((name, there, here)) = part.heading.study.difference(&heading.study) {
            return Err(Failure::Input(format!(
                "{} is of another sweep, by its {name}: {there} there, {here} here; remove it, or name another output",
                path.display()
            )));
        }
        if part.heading != *heading {
            return Err(Failure::Input(format!("{} is another shard; remove it", path.display())));
        }
        file.set_len(part.end).map_err(failed)?;
        Ok(Self { part, file })
    }

    /// Adds a chunk.
    ///
    /// # Errors
    /// [`Failure::File`] where it cannot be written; the file is then what it was.
    pub(super) fn append(&mut self, chunk: &Chunk) -> Result<(), Failure> {
        let Self { part, file } = self;
        let shapes = &part.heading.study.shapes;
        let bytes = frame(&chunk.bytes(shapes));
        if let Err(error) = write_at(file, part.end, &bytes) {
            let _ = file.set_len(part.end);
            return Err(Failure::file(&part.path, error));
        }
        if let Some(head) = Head::of(&bytes[FRAME..], shapes) {
            part.add(&head);
        }
        part.end += bytes.len() as u64;
        Ok(())
    }

    /// Waits until the file is on the disk.
    ///
    /// # Errors
    /// [`Failure::File`] where it is not.
    pub(super) fn settle(&self) -> Result<(), Failure> {
        self.file.sync_all().map_err(|error| Failure::file(&self.part.path, error))
    }
}

impl Part {
    /// What is in the file at a path: its heading, and the chunks up to the first that is not whole.
    ///
    /// # Errors
    /// [`Failure::Input`] where the file is no part, [`Failure::File`] where it cannot be read.
    pub(super) fn read(path: &Path) -> Result<Self, Failure> {
        let failed = |error| Failure::file(path, error);
        if path.exists() {
            place::check_regular(path)?;
        }
        let file = File::open(path).map_err(failed)?;
        let length = file.metadata().map_err(failed)?.len();
        let mut reader = BufReader::with_capacity(1 << 16, file);
        let mut magic = Vec::new();
        let mut end = MAGIC.len() as u64;
        (&mut reader).take(end).read_to_end(&mut magic).map_err(failed)?;
        let bytes = if magic == MAGIC { framed(&mut reader, length - end).map_err(failed)? } else { None };
        let heading = bytes.and_then(|bytes| Some((bytes.len(), serde_json::from_slice::<Heading>(&bytes).ok()?)));
        let Some((size, heading)) = heading.filter(|(_, heading)| heading.is_possible()) else {
            return Err(Failure::Input(format!("{} is no part of a sweep", path.display())));
        };
        end += (FRAME + size) as u64;
        let offsets = vec![None; usize::try_from(heading.chunks()).unwrap_or_default()];
        let rows = vec![0; heading.study.shapes.len()];
        let mut part = Self { path: path.to_owned(), heading, offsets, failed: 0, rows, end };
        while let Some(bytes) = framed(&mut reader, length - part.end).map_err(failed)? {
            let head = Head::of(&bytes, &part.heading.study.shapes).filter(|head| head.number < part.heading.chunks());
            let Some(head) = head else { break };
            part.add(&head);
            part.end += (FRAME + bytes.len()) as u64;
        }
        Ok(part)
    }

    /// Counts a chunk that begins at the end.
    fn add(&mut self, head: &Head) {
        let free = usize::try_from(head.number).ok().and_then(|number| self.offsets.get_mut(number));
        if let Some(free) = free.filter(|free| free.is_none()) {
            *free = NonZeroU64::new(self.end);
            self.failed += head.failed;
            self.rows.iter_mut().zip(&head.rows).for_each(|(sum, rows)| *sum += rows);
        }
    }

    /// Where it is.
    pub(super) fn path(&self) -> &Path {
        &self.path
    }

    /// What it is of.
    pub(super) fn heading(&self) -> &Heading {
        &self.heading
    }

    /// The numbers of the chunks that are not there.
    pub(super) fn missing(&self) -> Vec<u64> {
        (0..).zip(&self.offsets).filter(|(_, offset)| offset.is_none()).map(|(number, _)| number).collect()
    }

    /// How many of the runs that are there did not reach their end.
    pub(super) fn failed(&self) -> u64 {
        self.failed
    }

    /// Rows of a table that are there.
    pub(super) fn rows(&self, table: usize) -> u64 {
        self.rows.get(table).copied().unwrap_or(0)
    }

    /// The numbers of one table, chunk after chunk.
    ///
    /// # Errors
    /// [`Failure::File`] where a chunk cannot be read, or is not there.
    pub(super) fn table(&self, table: usize) -> impl Iterator<Item = Result<Vec<f64>, Failure>> + '_ {
        let numbers = move |offset: &Option<NonZeroU64>| {
            let offset = offset.ok_or_else(|| io::Error::from(io::ErrorKind::UnexpectedEof));
            let numbers = offset.and_then(|offset| self.numbers(offset.get(), table));
            numbers.map_err(|error| Failure::file(&self.path, error))
        };
        self.offsets.iter().map(numbers)
    }

    /// The numbers of one table in the chunk whose frame begins at a place.
    fn numbers(&self, offset: u64, table: usize) -> io::Result<Vec<f64>> {
        let shapes = &self.heading.study.shapes;
        // Opened for each chunk: there may be more parts than a process may have open files.
        let mut file = File::open(&self.path)?;
        file.seek(SeekFrom::Start(offset + FRAME as u64))?;
        let mut head = vec![0; Head::size(shapes)];
        file.read_exact(&mut head)?;
        let Head { rows, .. } = Head::read(&head, shapes).ok_or(io::ErrorKind::UnexpectedEof)?;
        let mut sizes = rows.iter().zip(shapes).map(|(rows, shape)| 8 * rows * wide(shape));
        let before: u64 = sizes.by_ref().take(table).sum();
        let size = sizes.next().unwrap_or(0);
        file.seek(SeekFrom::Start(offset + (FRAME + head.len()) as u64 + before))?;
        let mut bytes = Vec::new();
        file.take(size).read_to_end(&mut bytes)?;
        if bytes.len() as u64 != size {
            return Err(io::Error::from(io::ErrorKind::UnexpectedEof));
        }
        Ok(bytes.chunks_exact(8).map(|bytes| f64::from_bits(number_of(bytes))).collect())
    }
}

impl Head {
    /// Bytes that it takes.
    fn size(shapes: &[Shape]) -> usize {
        8 * (2 + shapes.len())
    }

    /// The head with which these bytes begin.
    fn read(bytes: &[u8], shapes: &[Shape]) -> Option<Self> {
        let mut numbers = bytes.get(..Self::size(shapes))?.chunks_exact(8).map(number_of);
        Some(Self { number: numbers.next()?, failed: numbers.next()?, rows: numbers.collect() })
    }

    /// The head of these bytes; none where they are no chunk of these tables.
    fn of(bytes: &[u8], shapes: &[Shape]) -> Option<Self> {
        let head = Self::read(bytes, shapes)?;
        let mut entries = head.rows.iter().zip(shapes).map(|(rows, shape)| rows.checked_mul(wide(shape)));
        let entries = entries.try_fold(0_u64, |sum, entries| sum.checked_add(entries?))?;
        let size = entries.checked_mul(8)?.checked_add(Self::size(shapes) as u64)?;
        (size == bytes.len() as u64).then_some(head)
    }
}

impl Chunk {
    fn bytes(&self, shapes: &[Shape]) -> Vec<u8> {
        let rows = self.tables.iter().zip(shapes).map(|(numbers, shape)| numbers.len() as u64 / wide(shape).max(1));
        let head = [self.number, self.failed].into_iter().chain(rows);
        let numbers = self.tables.iter().flatten().map(|number| number.to_bits());
        head.chain(numbers).flat_map(u64::to_le_bytes).collect()
    }
}

/// Columns of a table.
fn wide(shape: &Shape) -> u64 {
    shape.columns.len() as u64
}

/// Eight bytes as a number.
fn number_of(bytes: &[u8]) -> u64 {
    bytes.try_into().map_or(0, u64::from_le_bytes)
}

/// Magic line and heading.
fn beginning(heading: &Heading) -> Vec<u8> {
    // Names, words and counts are always JSON.
    let text = serde_json::to_vec(heading).unwrap_or_default();
    [MAGIC, &frame(&text)].concat()
}

/// Bytes behind their length and checksum.
fn frame(bytes: &[u8]) -> Vec<u8> {
    let length = (bytes.len() as u64).to_le_bytes();
    let checksum = checksum(&length, bytes).to_le_bytes();
    [length.as_slice(), checksum.as_slice(), bytes].concat()
}

/// The next framed bytes, of which at most `left` are left; none at the end, and where they are not whole.
fn framed(reader: &mut impl Read, left: u64) -> io::Result<Option<Vec<u8>>> {
    if left < FRAME as u64 {
        return Ok(None);
    }
    let mut head = [0; FRAME];
    reader.read_exact(&mut head)?;
    let (length, sum) = head.split_at(8);
    let size = number_of(length);
    let Some(size) = usize::try_from(size).ok().filter(|_| size <= left - FRAME as u64) else { return Ok(None) };
    let mut bytes = vec![0; size];
    reader.read_exact(&mut bytes)?;
    Ok((sum == checksum(length, &bytes).to_le_bytes()).then_some(bytes))
}

/// CRC-32 of bytes and what stands before them.
fn checksum(before: &[u8], bytes: &[u8]) -> u32 {
    let mut hasher = crc32fast::Hasher::new();
    hasher.update(before);
    hasher.update(bytes);
    hasher.finalize()
}

/// Writes bytes at a place of a file.
fn write_at(mut file: &File, place: u64, bytes: &[u8]) -> io::Result<()> {
    file.seek(SeekFrom::Start(place))?;
    file.write_all(bytes)
}

#[cfg(test)]
mod tests {
    use super::super::shape::Column;
    use super::*;
    use std::fs;

    fn heading() -> Heading {
        let columns = vec![Column::count("item"), Column::number("x")];
        let shapes =
            ["", "series"].map(|suffix| Shape { suffix: suffix.to_owned(), columns: columns.clone() }).to_vec();
        let facts = vec![("system".to_owned(), "Kepler".to_owned())];
        Heading { study: Description { facts, items: 10, shapes }, shard: Shard { index: 1, count: 2 }, chunk: 2 }
    }

    fn chunk(number: u64) -> Chunk {
        let row = vec![5.0, 1.5, 6.0, f64::MIN_POSITIVE];
        Chunk { number, failed: 1, tables: vec![row.clone(), [row.as_slice(), &[6.0, -0.0]].concat()] }
    }

    fn resumed(path: &Path) -> Growing {
        Growing::resume(path, &heading()).unwrap_or_else(|failure| panic!("{failure}"))
    }

    #[test]
    fn a_part_that_is_cut_anywhere_or_spoiled_keeps_the_chunks_before() {
        let path = std::env::temp_dir().join(format!("vi-lab-part-{}", std::process::id()));
        let _ = fs::remove_file(&path);
        let mut growing = resumed(&path);
        assert_eq!((growing.part.missing(), growing.part.heading().items(2)), (vec![0, 1, 2], 9..10));
        let empty = growing.part.end;
        for number in [2, 0] {
            growing.append(&chunk(number)).unwrap_or_else(|failure| panic!("{failure}"));
        }
        let Growing { part, file } = growing;
        drop(file);
        assert_eq!((part.missing(), part.failed(), part.rows(0), part.rows(1)), (vec![1], 2, 4, 6));
        for table in 0..2 {
            let numbers: Vec<_> = part.table(table).map(Result::ok).collect();
            let expected = chunk(0).tables[table].clone();
            assert_eq!(numbers, [Some(expected.clone()), None, Some(expected)], "the one between is not there");
        }
        let first = empty + (part.end - empty) / 2;
        let whole = fs::read(&path).expect("the part");
        for length in 0..=whole.len() as u64 {
            fs::write(&path, &whole[..usize::try_from(length).expect("a length")]).expect("the file is written");
            let expected = if length < first { vec![0, 1, 2] } else { vec![0, 1] };
            let expected = if length == whole.len() as u64 { vec![1] } else { expected };
            let part = resumed(&path).part;
            let end = fs::metadata(&path).expect("the file").len();
            assert_eq!((part.missing(), part.end), (expected, end), "{length} bytes");
        }
        // A bit anywhere: the heading is refused, a chunk is done again.
        for place in 0..whole.len() {
            let mut spoiled = whole.clone();
            spoiled[place] ^= 4;
            fs::write(&path, spoiled).expect("the file is written");
            let part = Growing::resume(&path, &heading());
            if (place as u64) < empty {
                assert!(part.is_err(), "byte {place}");
            } else {
                let expected = if (place as u64) < first { vec![0, 1, 2] } else { vec![0, 1] };
                assert_eq!(
                    part.map(|growing| growing.part.missing()).map_err(|failure| failure.to_string()),
                    Ok(expected),
                    "byte {place}"
                );
            }
        }
        fs::remove_file(&path).expect("the file can be removed");
    }

    #[test]
    fn another_sweep_another_shard_and_a_second_process_are_refused() {
        let path = std::env::temp_dir().join(format!("vi-lab-other-part-{}", std::process::id()));
        let _ = fs::remove_file(&path);
        let shown = path.display().to_string();
        let message = |heading: &Heading| Growing::resume(&path, heading).err().map(|failure| failure.to_string());
        let part = resumed(&path);
        assert_eq!(message(&heading()), Some(format!("another process works on {shown}; wait for it")));
        drop(part);
        let mut other = heading();
        other.shard.index = 0;
        assert_eq!(message(&other), Some(format!("{shown} is another shard; remove it")));
        other.study.facts[0].1 = "Pendulum".to_owned();
        let expected = format!(
            "{shown} is of another sweep, by its system: Kepler there, Pendulum here; remove it, or name another output"
        );
        assert_eq!(message(&other), Some(expected));
        fs::write(&path, "item,x\n1,2\n").expect("the file is written");
        assert_eq!(message(&heading()), Some(format!("{shown} is no part of a sweep")));
        assert_eq!(fs::read_to_string(&path).expect("the file"), "item,x\n1,2\n", "what is no part stays as it is");
        fs::remove_file(&path).expect("the file can be removed");
    }
}
