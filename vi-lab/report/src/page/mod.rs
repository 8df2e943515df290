//! The page: one self-contained HTML file with figures, formulas, tables and prose.
//!
//! In: sections in order. Out: a page without external references: figures inline as SVG, formulas as MathML, the style
//! in its head. Prose is HTML from the source; computed text is escaped.

mod folder;
mod math;

pub use folder::Report;

use crate::chart::Figure;
use crate::html::escape;
use crate::machine::Machine;
use crate::table::Table;
use core::fmt::Write as _;

/// A page under construction.
#[derive(Clone, Debug)]
pub struct Page {
    title: String,
    body: String,
    contents: String,
    sections: u32,
    figures: u32,
    tables: u32,
}

impl Page {
    /// A page with a title and a subtitle.
    #[must_use]
    pub fn new(title: &str, subtitle: &str) -> Self {
        let body = format!("<header><h1>{}</h1>\n<p class=\"subtitle\">{subtitle}</p></header>\n", escape(title));
        Self { title: title.to_owned(), body, contents: String::new(), sections: 0, figures: 0, tables: 0 }
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
    pub fn figure(&mut self, figure: &Figure, caption: &str) {
        self.figures += 1;
        let number = self.figures;
        let name = figure.name;
        let _ = writeln!(
            self.body,
            "<figure id=\"{name}\">{}\n<figcaption><b>Figure {number}.</b> {caption} \
             <span class=\"files\"><a href=\"{name}.svg\">SVG</a> <a href=\"{name}.csv\">CSV</a></span></figcaption></figure>",
            figure.svg
        );
    }

    /// A table with its caption above.
    pub fn table(&mut self, table: &Table, caption: &str) {
        self.tables += 1;
        let number = self.tables;
        let name = table.name;
        let _ = writeln!(
            self.body,
            "<p class=\"caption\" id=\"{name}\"><b>Table {number}.</b> {caption} \
             <span class=\"files\"><a href=\"{name}.csv\">CSV</a></span></p>\n{}",
            table.html()
        );
    }

    /// The finished page with the machine and the versions in its footer.
    #[must_use]
    pub fn html(&self, machine: &Machine) -> String {
        format!(
            "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
             <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<title>{title}</title>\n\
             <style>\n{style}</style>\n</head>\n<body>\n<main>\n{body}</main>\n<footer>{footer}</footer>\n</body>\n</html>\n",
            title = escape(&self.title),
            style = include_str!("style.css"),
            body =
                self.body.replacen("</header>\n", &format!("</header>\n<nav><ol>\n{}</ol></nav>\n", self.contents), 1),
            footer = escape(&machine.describe()),
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_page_is_self_contained_and_escaped() {
        let mut page = Page::new("a < b", "subtitle");
        page.section("One & two");
        page.formula("h^2");
        let mut table = Table::new("claims", ["x"]);
        table.row(["<script>".to_owned()]);
        page.table(&table, "what it lists");
        let html = page.html(&Machine::here());
        assert!(html.contains("<title>a &lt; b</title>") && html.contains("<td>&lt;script&gt;</td>"));
        assert!(html.contains("<li><a href=\"#section-1\">One &amp; two</a></li>"));
        assert!(html.contains("<msup><mi>h</mi><mn>2</mn></msup>"));
        for outside in ["http://", "https://", "<script", "<link"] {
            let namespaces = html.replace("http://www.w3.org/", "");
            assert!(!namespaces.contains(outside), "the page names {outside}");
        }
    }
}
