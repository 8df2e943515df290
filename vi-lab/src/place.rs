//! Which files can be read, and where one can be written.
//!
//! In: a path. Out: its text, a file to write, or [`Failure::Input`]. A file is read if it is a regular one: a pipe may never end. A file that stands in for
//! another until it is whole is always a new one: what else has its name, as a link to somewhere, stays as it is.

use std::fs::{self, File};
use std::io::{self, Write as _};
use std::path::{Path, PathBuf};
use std::process;
use vi_report::failure::Failure;

/// The text of a file.
///
/// # Errors
/// [`Failure::Input`] if it cannot be read, or is no regular file.
pub(crate) fn text(path: &Path) -> Result<String, Failure> {
    check_regular(path)?;
    fs::read_to_string(path).map_err(|error| Failure::Input(format!("{}: {error}", path.display())))
}

/// Whether a path names a regular file.
///
/// # Errors
/// [`Failure::Input`] if it does not.
pub(crate) fn check_regular(path: &Path) -> Result<(), Failure> {
    let shown = path.display();
    match fs::metadata(path) {
        Err(error) => Err(Failure::Input(format!("{shown}: {error}"))),
        Ok(found) if !found.is_file() => {
            Err(Failure::Input(format!("{shown} is no regular file; give the name of one")))
        }
        Ok(_) => Ok(()),
    }
}

/// A path with one more ending.
pub(crate) fn beside(path: &Path, ending: &str) -> PathBuf {
    let mut name = path.as_os_str().to_owned();
    name.push(".");
    name.push(ending);
    PathBuf::from(name)
}

/// A new file that takes the place of another when it is whole; without that it is removed.
#[derive(Debug)]
pub(crate) struct Temporary {
    path: PathBuf,
    place: PathBuf,
}

/// Names that are tried for a new file: those before may be left by processes that were killed.
const NAMES: u32 = 1000;

impl Temporary {
    /// A new file beside `place`.
    ///
    /// # Errors
    /// Why it cannot be made.
    pub(crate) fn create(place: &Path) -> io::Result<(Self, File)> {
        let mut number = 0;
        loop {
            let path = beside(place, &format!("tmp-{}-{number}", process::id()));
            match File::create_new(&path) {
                Ok(file) => return Ok((Self { path, place: place.to_owned() }, file)),
                Err(error) if error.kind() == io::ErrorKind::AlreadyExists && number < NAMES => number += 1,
                Err(error) => return Err(error),
            }
        }
    }

    /// Gives the file its place.
    ///
    /// # Errors
    /// Why it cannot have it.
    pub(crate) fn finish(self) -> io::Result<()> {
        fs::rename(&self.path, &self.place)
    }
}

impl Drop for Temporary {
    fn drop(&mut self) {
        // After it was given its place there is no such file.
        let _ = fs::remove_file(&self.path);
    }
}

/// Writes a small file whose name follows from that of another.
///
/// # Errors
/// Why it cannot be written.
pub(crate) fn replace(path: &Path, text: &str) -> io::Result<()> {
    let (temporary, mut file) = Temporary::create(path)?;
    file.write_all(text.as_bytes())?;
    file.sync_all()?;
    temporary.finish()
}

/// Waits until the names in a folder are on the disk, on systems that can.
pub(crate) fn sync_folder(folder: &Path) {
    let folder = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
    let _ = File::open(folder).and_then(|folder| folder.sync_all());
}

/// Whether a file can be made at a path, were it not for permissions: its folder is there, and the path is no folder itself. `what` is what the file is.
///
/// # Errors
/// [`Failure::Input`] where it cannot.
pub(crate) fn check(what: &str, path: &Path) -> Result<(), Failure> {
    let shown = path.display();
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty());
    if let Some(folder) = folder.filter(|folder| !folder.is_dir()) {
        let folder = folder.display();
        return Err(Failure::Input(format!("there is no folder `{folder}` for the {what} `{shown}`; make it first")));
    }
    if path.is_dir() {
        return Err(Failure::Input(format!("the {what} `{shown}` is a folder; name a file")));
    }
    Ok(())
}
