//! The page: one self-contained HTML file with figures, formulas, tables and prose.
//!
//! In: sections in order. Out: a folder with the page and the files of its figures and tables. The page has no external
//! references: figures are inline as SVG, formulas as MathML, the style is in its head. Prose is HTML from the source;
//! computed text is escaped.

mod math;

use crate::chart::Figure;
use crate::failure::Failure;
use crate::html::escape;
use crate::machine::origin;
use crate::table::Table;
use core::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};
use std::time::Instant;

/// A page under construction, and its files.
#[derive(Debug)]
pub struct Report {
    folder: PathBuf,
    started: Instant,
    title: String,
    subtitle: String,
    contents: String,
    body: String,
    sections: u32,
    figures: Vec<&'static str>,
    tables: Vec<&'static str>,
    /// Names and texts.
    files: Vec<(String, String)>,
}

impl Report {
    /// An empty page in a folder, which is created if necessary.
    ///
    /// # Errors
    /// [`Failure::File`] if the folder cannot be created.
    pub fn new(folder: &Path, title: &str, subtitle: &str) -> Result<Self, Failure> {
        fs::create_dir_all(folder).map_err(|error| Failure::file(folder, error))?;
        Ok(Self {
            folder: folder.to_owned(),
            started: Instant::now(),
            title: escape(title),
            subtitle: subtitle.to_owned(),
            contents: String::new(),
            body: String::new(),
            sections: 0,
            figures: Vec::new(),
            tables: Vec::new(),
            files: Vec::new(),
        })
    }

    /// Starts a section and adds it to the table of contents.
    pub fn section(&mut self, heading: &str) {
        self.sections += 1;
        let number = self.sections;
        let heading = escape(heading);
        let _ = writeln!(self.contents, "<li><a href=\"#section-{number}\">{heading}</a></li>");
        let _ = writeln!(self.body, "<h2 id=\"section-{number}\">{number}. {heading}</h2>");
    }

    /// A paragraph of HTML.
    pub fn prose(&mut self, html: &str) {
        let _ = writeln!(self.body, "<p>{html}</p>");
    }

    /// A displayed formula in a notation like that of TeX: `h_k ≈ h_0 e^{ζωt}`, `\frac{…}{…}`, `\sqrt{…}`, `~` for a gap.
    pub fn formula(&mut self, formula: &str) {
        let _ = writeln!(self.body, "<div class=\"formula\">{}</div>", math::display(formula));
    }

    /// A figure with its caption below.
    pub fn figure(&mut self, Figure { name, svg, csv }: Figure, caption: &str) {
        self.figures.push(name);
        let number = self.figures.len();
        let _ = writeln!(
            self.body,
            "<figure id=\"{name}\">{svg}\n<figcaption><b>Figure {number}.</b> {caption} \
             <span class=\"files\"><a href=\"{name}.svg\">SVG</a> <a href=\"{name}.csv\">CSV</a></span></figcaption></figure>"
        );
        self.files.extend([(format!("{name}.svg"), svg), (format!("{name}.csv"), csv)]);
    }

    /// A table with its caption above.
    pub fn table(&mut self, table: &Table, caption: &str) {
        self.reserve(table.name);
        self.fill(table, caption);
    }

    /// The place and the number of a table whose rows are known later.
    pub fn reserve(&mut self, table: &'static str) {
        self.tables.push(table);
        self.body.push_str(&place(table));
    }

    /// Adds a table with its caption at its reserved place.
    pub fn fill(&mut self, table: &Table, caption: &str) {
        let name = table.name;
        let number = 1 + self.tables.iter().take_while(|reserved| **reserved != name).count();
        let html = format!(
            "<p class=\"caption\" id=\"{name}\"><b>Table {number}.</b> {caption} \
             <span class=\"files\"><a href=\"{name}.csv\">CSV</a></span></p>\n{}\n",
            table.html()
        );
        self.body = self.body.replacen(&place(name), &html, 1);
        self.files.push((format!("{name}.csv"), table.csv()));
    }

    /// The name of a figure or a table on the page: `Figure 3`.
    #[must_use]
    pub fn label(&self, name: &str) -> Option<String> {
        let kinds = [("Figure", &self.figures), ("Table", &self.tables)];
        kinds.into_iter().find_map(|(kind, names)| {
            let index = names.iter().position(|known| *known == name)?;
            Some(format!("{kind}\u{a0}{}", index + 1))
        })
    }

    /// Writes the page and its files, and returns the path of the page.
    ///
    /// # Errors
    /// [`Failure::File`] if a file cannot be written.
    pub fn finish(mut self) -> Result<PathBuf, Failure> {
        self.files.push(("index.html".to_owned(), self.html()));
        for (name, text) in &self.files {
            let path = self.folder.join(name);
            fs::write(&path, text).map_err(|error| Failure::file(&path, error))?;
        }
        Ok(self.folder.join("index.html"))
    }

    /// The page with its origin in the footer.
    fn html(&self) -> String {
        let Self { title, subtitle, contents, body, .. } = self;
        format!(
            "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
             <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<title>{title}</title>\n\
             <style>\n{style}</style>\n</head>\n<body>\n<main>\n\
             <header><h1>{title}</h1>\n<p class=\"subtitle\">{subtitle}</p></header>\n<nav><ol>\n{contents}</ol></nav>\n\
             {body}</main>\n<footer>{footer}</footer>\n</body>\n</html>\n",
            style = include_str!("style.css"),
            footer = escape(&origin(self.started)),
        )
    }
}

/// Marks the place of a table in the text.
fn place(table: &str) -> String {
    format!("<!-- {table} -->")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_page_is_self_contained_and_escaped() {
        let mut page = Report::new(&std::env::temp_dir(), "a < b", "subtitle").expect("a folder");
        page.section("One & two");
        page.reserve("first");
        page.formula("h^2");
        let mut table = Table::new("claims", ["x"]);
        table.row(["<script>".to_owned()]);
        page.table(&table, "what it lists");
        page.fill(&Table::new("first", ["y"]), "what is known at the end");
        assert_eq!(
            ["first", "claims", "none"].map(|name| page.label(name)).map(|label| label.is_some()),
            [true, true, false]
        );
        let html = page.html();
        assert!(html.contains("<title>a &lt; b</title>") && html.contains("<td>&lt;script&gt;</td>"));
        assert!(html.contains("<li><a href=\"#section-1\">One &amp; two</a></li>"));
        assert!(html.contains("<msup><mi>h</mi><mn>2</mn></msup>"));
        let order =
            ["id=\"section-1\"", "<b>Table 1.</b> what is known at the end", "<math", "<b>Table 2.</b> what it lists"];
        assert!(order.map(|part| html.find(part).expect(part)).is_sorted(), "{html}");
        for outside in ["http://", "https://", "<script", "<link"] {
            let namespaces = html.replace("http://www.w3.org/", "");
            assert!(!namespaces.contains(outside), "the page names {outside}");
        }
    }
}
