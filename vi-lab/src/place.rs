//! Checks of files to write.
//!
//! In: a path. Out: a file to write, or [`Failure::Input`]. Output goes to a new temporary file, which replaces the target when it is complete; existing files and links
//! keep their content until then.

use std::fs::{self, File};
use std::io::{self, Write as _};
use std::path::{Path, PathBuf};
use std::process;
use vi_report::failure::Failure;

/// A path with an appended extension.
pub(crate) fn with_extension(path: &Path, ending: &str) -> PathBuf {
    let mut name = path.as_os_str().to_owned();
    name.push(".");
    name.push(ending);
    PathBuf::from(name)
}

/// A new file that replaces another one when complete; dropped earlier, it is removed.
#[derive(Debug)]
pub(crate) struct Temporary {
    path: PathBuf,
    place: PathBuf,
}

/// Number of names to try: killed processes may have left earlier files.
const NAMES: u32 = 1000;

impl Temporary {
    /// Creates a new file beside `place`.
    ///
    /// # Errors
    /// The error of the file system.
    pub(crate) fn create(place: &Path) -> io::Result<(Self, File)> {
        let mut number = 0;
        loop {
            let path = with_extension(place, &format!("tmp-{}-{number}", process::id()));
            match File::create_new(&path) {
                Ok(file) => return Ok((Self { path, place: place.to_owned() }, file)),
                Err(error) if error.kind() == io::ErrorKind::AlreadyExists && number < NAMES => number += 1,
                Err(error) => return Err(error),
            }
        }
    }

    /// Moves the file to its target.
    ///
    /// # Errors
    /// The error of the file system.
    pub(crate) fn finish(self) -> io::Result<()> {
        fs::rename(&self.path, &self.place)
    }
}

impl Drop for Temporary {
    fn drop(&mut self) {
        // After the move there is no such file.
        let _ = fs::remove_file(&self.path);
    }
}

/// Writes a small file whose name derives from another one.
///
/// # Errors
/// The error of the file system.
pub(crate) fn replace(path: &Path, text: &str) -> io::Result<()> {
    let (temporary, mut file) = Temporary::create(path)?;
    file.write_all(text.as_bytes())?;
    file.sync_all()?;
    temporary.finish()
}

/// Waits until the entries of a folder are on disk, on systems that support it.
pub(crate) fn sync_folder(folder: &Path) {
    let folder = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
    let _ = File::open(folder).and_then(|folder| folder.sync_all());
}

/// Checks that a CSV file can be created at a path, as [`check`] does.
///
/// # Errors
/// [`Failure::Input`] if its name does not end in .csv, or no file can be created.
pub(crate) fn check_csv(path: &Path) -> Result<(), Failure> {
    if path.extension().is_none_or(|extension| !extension.eq_ignore_ascii_case("csv")) {
        let shown = path.display();
        let remedy = "pandas reads it with `read_csv(FILE, comment=\"#\")`";
        return Err(Failure::Input(format!("the output `{shown}` must end in .csv; {remedy}")));
    }
    check("output", path)
}

/// Checks that a file can be created at a path, except for permissions: its folder exists and the path is not a folder.
/// `what` names the file.
///
/// # Errors
/// [`Failure::Input`] if it cannot.
pub(crate) fn check(what: &str, path: &Path) -> Result<(), Failure> {
    let shown = path.display();
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty());
    if let Some(folder) = folder.filter(|folder| !folder.is_dir()) {
        let folder = folder.display();
        return Err(Failure::Input(format!("there is no folder `{folder}` for the {what} `{shown}`; create it first")));
    }
    if path.is_dir() {
        return Err(Failure::Input(format!("the {what} `{shown}` is a folder; name a file")));
    }
    Ok(())
}
