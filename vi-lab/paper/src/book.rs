//! The page as it grows, and the list of claims.

use std::path::Path;
use vi_report::chart::Chart;
use vi_report::failure::Failure;
use vi_report::machine::Machine;
use vi_report::page::{Page, Report};
use vi_report::table::Table;

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

/// The page under construction, with the list of claims.
#[derive(Debug)]
pub(super) struct Book {
    report: Report,
    claims: Table,
}

impl Book {
    /// An empty page in a folder, which is made if need be.
    pub(super) fn new(folder: &Path) -> Result<Self, Failure> {
        let page = Page::new(
            "Energy-preserving variational integrators: the paper’s study, run again",
            "After H. Sharma, M. Patil, C. Woolsey, <i>Energy-preserving Variational Integrators for Forced Lagrangian \
             Systems</i>, section 5",
        );
        let claims = Table::new("claims", ["the paper", "its number", "ours", "verdict"]);
        Ok(Self { report: Report::new(folder, page)?, claims })
    }

    /// Starts a section.
    pub(super) fn section(&mut self, heading: &str) {
        self.report.section(heading);
    }

    /// A paragraph of HTML.
    pub(super) fn prose(&mut self, html: &str) {
        self.report.prose(html);
    }

    /// A formula of `MathML` elements.
    pub(super) fn formula(&mut self, mathml: &str) {
        self.report.formula(mathml);
    }

    /// A figure with its caption.
    pub(super) fn figure(&mut self, chart: &Chart, caption: &str) -> Result<(), Failure> {
        self.report.figure(&chart.figure(), caption)
    }

    /// A table with its caption.
    pub(super) fn table(&mut self, table: &Table, caption: &str) -> Result<(), Failure> {
        self.report.table(table, caption)
    }

    /// A claim of the paper, its number, ours, and what became of it.
    pub(super) fn claim(&mut self, claim: &str, number: &str, ours: String, verdict: Verdict) {
        self.claims.row([claim.to_owned(), number.to_owned(), ours, verdict.text().to_owned()]);
    }

    /// Ends the page with the claims and writes it; returns the claims as text, and where the page is.
    pub(super) fn finish(mut self, machine: &Machine) -> Result<String, Failure> {
        self.section("The paper’s claims, one by one");
        self.report.table(
            &self.claims,
            "Each claim of section 5, the paper’s number where it gives one, and what this run found.",
        )?;
        let page = self.report.finish(machine)?;
        Ok(format!("{}\n{}", self.claims.text(), page.display()))
    }
}
