//! The page and its files as they grow, and the list of claims.

use super::super::chart::Chart;
use super::super::failure::Failure;
use super::super::machine::Machine;
use super::super::report::Page;
use super::super::table::Table;
use std::fs;
use std::path::{Path, PathBuf};

/// What became of a claim of the paper.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Verdict {
    /// Found again.
    Reproduced,
    /// Found again, and by some orders of magnitude better.
    Surpassed,
    /// True of the paper's way to solve the equations, not of the method.
    Artefact,
    /// True, and cured by another form of the equations.
    Cured,
    /// Left open by the paper, answered here.
    Answered,
    /// Not found again.
    NotReproduced,
}

impl Verdict {
    /// Reproduced or not.
    pub(super) fn reproduced(holds: bool) -> Self {
        if holds { Self::Reproduced } else { Self::NotReproduced }
    }

    /// The given verdict where the numbers bear it out.
    pub(super) fn when(self, holds: bool) -> Self {
        if holds { self } else { Self::NotReproduced }
    }

    fn text(self) -> &'static str {
        match self {
            Self::Reproduced => "reproduced",
            Self::Surpassed => "surpassed",
            Self::Artefact => "artefact of the solver",
            Self::Cured => "reproduced, and cured",
            Self::Answered => "answered",
            Self::NotReproduced => "not reproduced",
        }
    }
}

/// The page under construction, and the folder of its files.
#[derive(Debug)]
pub(super) struct Book {
    folder: PathBuf,
    page: Page,
    claims: Table,
}

impl Book {
    /// An empty page in a folder, which is made if need be.
    pub(super) fn new(folder: &Path) -> Result<Self, Failure> {
        fs::create_dir_all(folder).map_err(|error| Failure::file(folder, error))?;
        let page = Page::new(
            "Energy-preserving variational integrators: the paper’s study, run again",
            "After H. Sharma, M. Patil, C. Woolsey, <i>Energy-preserving Variational Integrators for Forced Lagrangian \
             Systems</i>, section 5",
        );
        let claims = Table::new("claims", ["the paper", "its number", "ours", "verdict"]);
        Ok(Self { folder: folder.to_owned(), page, claims })
    }

    /// Starts a section.
    pub(super) fn section(&mut self, heading: &str) {
        self.page.section(heading);
    }

    /// A paragraph of HTML.
    pub(super) fn prose(&mut self, html: &str) {
        self.page.prose(html);
    }

    /// A formula of `MathML` elements.
    pub(super) fn formula(&mut self, mathml: &str) {
        self.page.formula(mathml);
    }

    /// A figure with its caption; its files are written at once.
    pub(super) fn figure(&mut self, chart: &Chart, caption: &str) -> Result<(), Failure> {
        let figure = chart.figure();
        self.page.figure(&figure, caption);
        self.write(&format!("{}.svg", figure.name), &figure.svg)?;
        self.write(&format!("{}.csv", figure.name), &figure.csv)
    }

    /// A table with its caption; its file is written at once.
    pub(super) fn table(&mut self, table: &Table, caption: &str) -> Result<(), Failure> {
        self.page.table(table, caption);
        self.write(&format!("{}.csv", table.name), &table.csv())
    }

    /// A claim of the paper, its number, ours, and what became of it.
    pub(super) fn claim(&mut self, claim: &str, number: &str, ours: String, verdict: Verdict) {
        self.claims.row([claim.to_owned(), number.to_owned(), ours, verdict.text().to_owned()]);
    }

    /// Ends the page with the claims and writes it; returns the claims as text, and where the page is.
    pub(super) fn finish(mut self, machine: &Machine) -> Result<String, Failure> {
        self.section("The paper’s claims, one by one");
        let claims = self.claims.clone();
        self.table(
            &claims,
            "Each claim of section 5, the paper’s number where it gives one, and what this run found.",
        )?;
        self.write("index.html", &self.page.html(machine))?;
        Ok(format!("{}\n{}", claims.text(), self.folder.join("index.html").display()))
    }

    fn write(&self, name: &str, text: &str) -> Result<(), Failure> {
        let path = self.folder.join(name);
        fs::write(&path, text).map_err(|error| Failure::file(&path, error))
    }
}
