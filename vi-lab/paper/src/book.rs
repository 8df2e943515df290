//! The page under construction, and the list of the paper's figures, equations and numbers.

use std::path::PathBuf;
use vi_report::chart::{Chart, Figure};
use vi_report::failure::Failure;
use vi_report::machine::Machine;
use vi_report::page::{Page, Report};
use vi_report::table::Table;

/// How a figure, an equation, a number or a sentence of the paper compares with this run.
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

/// A figure, equation, number or sentence of the paper.
#[derive(Clone, Debug)]
struct Item {
    paper: String,
    printed: String,
    ours: String,
    verdict: Verdict,
    /// Name of the figure or table that shows our result.
    place: &'static str,
}

/// A part of the page, in order.
#[derive(Clone, Debug)]
enum Part {
    Section(String),
    Prose(String),
    Formula(String),
    Figure(Figure, String),
    Table(Table, String),
    /// The place of the list of items.
    Items,
}

/// The page under construction. It is written at the end, because the list of items at its top is known only then.
#[derive(Debug)]
pub(super) struct Book {
    folder: PathBuf,
    parts: Vec<Part>,
    items: Vec<Item>,
}

impl Book {
    /// An empty page for a folder.
    pub(super) fn new(folder: PathBuf) -> Self {
        Self { folder, parts: Vec::new(), items: Vec::new() }
    }

    /// Starts a section.
    pub(super) fn section(&mut self, heading: &str) {
        self.parts.push(Part::Section(heading.to_owned()));
    }

    /// A paragraph of HTML.
    pub(super) fn prose(&mut self, html: &str) {
        self.parts.push(Part::Prose(html.to_owned()));
    }

    /// As [`Page::formula`].
    pub(super) fn formula(&mut self, formula: &str) {
        self.parts.push(Part::Formula(formula.to_owned()));
    }

    /// A figure with its caption.
    pub(super) fn figure(&mut self, chart: &Chart, caption: &str) {
        self.parts.push(Part::Figure(chart.figure(), caption.to_owned()));
    }

    /// A table with its caption.
    pub(super) fn table(&mut self, table: Table, caption: &str) {
        self.parts.push(Part::Table(table, caption.to_owned()));
    }

    /// The place of the list of items.
    pub(super) fn items(&mut self) {
        self.parts.push(Part::Items);
    }

    /// Adds an item of the paper: what it is, what the paper prints, what this run found, and the figure or table with it.
    pub(super) fn item(&mut self, paper: &str, printed: &str, ours: String, verdict: Verdict, place: &'static str) {
        self.items.push(Item { paper: paper.to_owned(), printed: printed.to_owned(), ours, verdict, place });
    }

    /// Writes the page. Returns the list of items as text, and the path of the page.
    pub(super) fn finish(self, machine: &Machine) -> Result<String, Failure> {
        let items = self.list();
        let page = Page::new(
            "Energy-preserving variational integrators: the paper’s study, run again",
            "After H. Sharma, M. Patil, C. Woolsey, <i>Energy-preserving Variational Integrators for Forced Lagrangian \
             Systems</i>, section 5",
        );
        let mut report = Report::new(&self.folder, page)?;
        for part in self.parts {
            match part {
                Part::Section(heading) => report.section(&heading),
                Part::Prose(html) => report.prose(&html),
                Part::Formula(formula) => report.formula(&formula),
                Part::Figure(figure, caption) => report.figure(&figure, &caption)?,
                Part::Table(table, caption) => report.table(&table, &caption)?,
                Part::Items => report.table(
                    &items,
                    "Every figure, equation and printed number of the paper’s study, what this run found, and where the page \
                     shows it. “—” marks a figure or a sentence without a printed number.",
                )?,
            }
        }
        let path = report.finish(machine)?;
        Ok(format!("{}\n{}", items.text(), path.display()))
    }

    /// The items, each with the number of its figure or table on the page.
    fn list(&self) -> Table {
        let mut places = Vec::new();
        let [mut figures, mut tables] = [0, 0];
        for part in &self.parts {
            match part {
                Part::Figure(figure, _) => {
                    figures += 1;
                    places.push((figure.name, format!("Figure\u{a0}{figures}")));
                }
                Part::Table(table, _) => {
                    tables += 1;
                    places.push((table.name, format!("Table\u{a0}{tables}")));
                }
                Part::Items => tables += 1,
                Part::Section(_) | Part::Prose(_) | Part::Formula(_) => {}
            }
        }
        let mut list = Table::new("paper", ["the paper", "printed", "this run", "agreement", "where"]);
        for item in &self.items {
            let number = places.iter().find(|(name, _)| *name == item.place).map(|(_, number)| number.clone());
            let cells = [
                item.paper.clone(),
                item.printed.clone(),
                item.ours.clone(),
                item.verdict.text().to_owned(),
                number.unwrap_or_default(),
            ];
            list.linked_row(cells, item.place);
        }
        list
    }
}
