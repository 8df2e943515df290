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
    rows: Vec<Vec<String>>,
}

impl Table {
    /// An empty table with these columns.
    pub fn new<const N: usize>(name: &'static str, head: [&str; N]) -> Self {
        Self { name, head: head.map(str::to_owned).to_vec(), rows: Vec::new() }
    }

    /// Adds a row.
    pub fn row<const N: usize>(&mut self, cells: [String; N]) {
        self.rows.push(Vec::from(cells));
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
        for row in &self.rows {
            html.push_str("<tr>");
            for cell in row {
                let _ = write!(html, "<td>{}</td>", escape(cell));
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
        for row in core::iter::once(&self.head).chain(&self.rows) {
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
        for row in &self.rows {
            text.add_row(row);
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
}
