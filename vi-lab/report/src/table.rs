//! Tables for the page, the terminal and the CSV file.
//!
//! In: a head and rows of the same length, as text. Out: HTML, CSV, or text in columns.

use crate::html::escape;
use comfy_table::{ContentArrangement, presets};
use core::fmt::Write as _;

/// Width of a text table in characters.
const WIDTH: u16 = 120;

/// A head and rows of text.
#[derive(Clone, Debug)]
pub struct Table {
    /// Stem of the file name.
    pub name: &'static str,
    head: Vec<String>,
    /// The cells of each row, and the part of the page to which the last one links.
    rows: Vec<(Vec<String>, Option<&'static str>)>,
}

impl Table {
    /// An empty table with these columns.
    pub fn new<const N: usize>(name: &'static str, head: [&str; N]) -> Self {
        Self { name, head: head.map(str::to_owned).to_vec(), rows: Vec::new() }
    }

    /// Adds a row.
    pub fn row<const N: usize>(&mut self, cells: [String; N]) {
        self.rows.push((cells.into(), None));
    }

    /// Adds a row whose last cell links to a figure, table or section of the same page.
    pub fn linked_row<const N: usize>(&mut self, cells: [String; N], target: &'static str) {
        self.rows.push((cells.into(), Some(target)));
    }

    /// The table as an HTML element.
    #[must_use]
    pub fn html(&self) -> String {
        let mut html = String::from("<div class=\"table\"><table>\n<thead><tr>");
        // Writing to a string cannot fail.
        for cell in &self.head {
            let _ = write!(html, "<th>{}</th>", escape(cell));
        }
        html.push_str("</tr></thead>\n<tbody>\n");
        for (cells, target) in &self.rows {
            html.push_str("<tr>");
            for (index, cell) in cells.iter().enumerate() {
                let text = escape(cell);
                let _ = match target.filter(|_| index + 1 == cells.len()) {
                    Some(target) => write!(html, "<td><a href=\"#{target}\">{text}</a></td>"),
                    None => write!(html, "<td>{text}</td>"),
                };
            }
            html.push_str("</tr>\n");
        }
        html.push_str("</tbody></table></div>\n");
        html
    }

    /// The table as CSV, head first.
    #[must_use]
    pub fn csv(&self) -> String {
        let mut csv = String::new();
        for row in core::iter::once(&self.head).chain(self.rows.iter().map(|(cells, _)| cells)) {
            csv.push_str(&row.iter().map(|cell| csv_field(cell)).collect::<Vec<_>>().join(","));
            csv.push('\n');
        }
        csv
    }

    /// The table as text in columns.
    #[must_use]
    pub fn text(&self) -> String {
        let mut text = comfy_table::Table::new();
        text.load_style(presets::UTF8_HORIZONTAL_ONLY)
            .set_content_arrangement(ContentArrangement::Dynamic)
            .set_width(WIDTH)
            .set_header(&self.head);
        for (cells, _) in &self.rows {
            text.add_row(cells);
        }
        text.trim_fmt()
    }
}

/// A field of a CSV file, quoted as RFC 4180 requires.
#[must_use]
pub fn csv_field(text: &str) -> String {
    if text.contains(['"', ',', '\n', '\r']) { format!("\"{}\"", text.replace('"', "\"\"")) } else { text.to_owned() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_table_in_three_forms() {
        let mut table = Table::new("test", ["claim", "number"]);
        table.row(["h < h0, \"always\"".to_owned(), "1e-14".to_owned()]);
        assert_eq!(table.csv(), "claim,number\n\"h < h0, \"\"always\"\"\",1e-14\n");
        assert!(table.html().contains("<td>h &lt; h0, &quot;always&quot;</td><td>1e-14</td>"));
        assert!(table.text().contains("1e-14"));
    }

    #[test]
    fn the_last_cell_of_a_linked_row_links() {
        let mut table = Table::new("test", ["what", "where"]);
        table.linked_row(["a < b".to_owned(), "Figure 1".to_owned()], "portrait");
        assert!(table.html().contains("<tr><td>a &lt; b</td><td><a href=\"#portrait\">Figure 1</a></td></tr>"));
        assert_eq!(table.csv(), "what,where\na < b,Figure 1\n");
    }
}
