//! The page under construction, and the list of the paper's figures, equations and numbers.

use std::path::Path;
use vi_report::failure::Failure;
use vi_report::page::Report;
use vi_report::table::Table;

/// The result of comparing a figure, an equation, a number or a sentence of the paper with this run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Verdict {
    /// The same result.
    Agrees,
    /// The same result, with a smaller error.
    Smaller,
    /// A printed formula that differs from the derived one.
    Misprint,
    /// A statement that is corrected here.
    Corrected,
    /// One part of the sentence holds, another does not.
    InPart,
    /// An open question of the paper, answered on this page.
    Answered,
    /// A different result.
    Differs,
}

impl Verdict {
    /// This verdict if the numbers of the run support it.
    pub(super) fn when(self, holds: bool) -> Self {
        if holds { self } else { Self::Differs }
    }

    fn text(self) -> &'static str {
        match self {
            Self::Agrees => "agrees",
            Self::Smaller => "agrees; our error is smaller",
            Self::Misprint => "misprint",
            Self::Corrected => "corrected",
            Self::InPart => "agrees in part",
            Self::Answered => "answered",
            Self::Differs => "does not agree",
        }
    }
}

/// The page under construction, and the list of items at its top.
#[derive(Debug)]
pub(super) struct Book {
    pub(super) page: Report,
    /// The cells of each item but the last, and the name of the figure or table that shows our result.
    items: Vec<([String; 4], &'static str)>,
}

/// Name of the list of items.
const LIST: &str = "paper";

impl Book {
    /// An empty page in a folder.
    pub(super) fn new(folder: &Path) -> Result<Self, Failure> {
        let page = Report::new(
            folder,
            "Energy-preserving variational integrators: the paper’s study, run again",
            "After H. Sharma, M. Patil, C. Woolsey, <i>Energy-preserving Variational Integrators for Forced Lagrangian \
             Systems</i>, section 5",
        )?;
        Ok(Self { page, items: Vec::new() })
    }

    /// Reserves the place of the list of items, which is known at the end.
    pub(super) fn items(&mut self) {
        self.page.reserve(LIST);
    }

    /// Adds an item of the paper: its name, the printed result, the result of this run, and the figure or table with
    /// it.
    pub(super) fn item(&mut self, paper: &str, printed: &str, ours: String, verdict: Verdict, place: &'static str) {
        self.items.push(([paper.to_owned(), printed.to_owned(), ours, verdict.text().to_owned()], place));
    }

    /// Writes the page. Returns the list of items as text, and the path of the page.
    pub(super) fn finish(mut self) -> Result<String, Failure> {
        let mut list = Table::new(LIST, ["the paper", "printed", "this run", "agreement", "where"]);
        for ([paper, printed, ours, verdict], place) in self.items {
            let label = self.page.label(place).unwrap_or_default();
            list.linked_row([paper, printed, ours, verdict, label], place);
        }
        self.page.fill(
            &list,
            "Every figure, equation and printed number of the paper’s study, what this run found, and where the page \
             shows it. “—” marks a figure or a sentence without a printed number.",
        );
        Ok(format!("{}\n{}", list.text(), self.page.finish()?.display()))
    }
}
