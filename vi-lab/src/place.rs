//! Where a file can be written.

use std::path::Path;
use vi_report::failure::Failure;

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
