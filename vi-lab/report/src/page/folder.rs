//! A page and the files beside it.

use super::Page;
use crate::chart::Figure;
use crate::failure::Failure;
use crate::machine::Machine;
use crate::table::Table;
use std::fs;
use std::path::{Path, PathBuf};

/// The page under construction, and its folder.
#[derive(Debug)]
pub struct Report {
    folder: PathBuf,
    page: Page,
}

impl Report {
    /// An empty page in a folder, which is created if necessary.
    ///
    /// # Errors
    /// [`Failure::File`] if the folder cannot be created; the same for all files below.
    pub fn new(folder: &Path, page: Page) -> Result<Self, Failure> {
        fs::create_dir_all(folder).map_err(|error| Failure::file(folder, error))?;
        Ok(Self { folder: folder.to_owned(), page })
    }

    /// Starts a section.
    pub fn section(&mut self, heading: &str) {
        self.page.section(heading);
    }

    /// A paragraph of HTML.
    pub fn prose(&mut self, html: &str) {
        self.page.prose(html);
    }

    /// As [`Page::formula`].
    pub fn formula(&mut self, formula: &str) {
        self.page.formula(formula);
    }

    /// Adds a figure with its caption and writes its files.
    ///
    /// # Errors
    /// [`Failure::File`].
    pub fn figure(&mut self, figure: &Figure, caption: &str) -> Result<(), Failure> {
        self.page.figure(figure, caption);
        self.write(&format!("{}.svg", figure.name), &figure.svg)?;
        self.write(&format!("{}.csv", figure.name), &figure.csv)
    }

    /// Adds a table with its caption and writes its file.
    ///
    /// # Errors
    /// [`Failure::File`].
    pub fn table(&mut self, table: &Table, caption: &str) -> Result<(), Failure> {
        self.page.table(table, caption);
        self.write(&format!("{}.csv", table.name), &table.csv())
    }

    /// Writes the page and returns its path.
    ///
    /// # Errors
    /// [`Failure::File`].
    pub fn finish(self, machine: &Machine) -> Result<PathBuf, Failure> {
        self.write("index.html", &self.page.html(machine))?;
        Ok(self.folder.join("index.html"))
    }

    fn write(&self, name: &str, text: &str) -> Result<(), Failure> {
        let path = self.folder.join(name);
        fs::write(&path, text).map_err(|error| Failure::file(&path, error))
    }
}
