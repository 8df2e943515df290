//! Sheets: charts in rows and columns of one SVG.
//!
//! In: a title, and rows of [`Panel`]s, each a chart of a given size. Out: [`Sheet::svg`], as wide as the widest row,
//! with the SVG of every chart as a nested element.

use super::Chart;
use super::draw::{Area, Margins};
use crate::html::escape;
use core::fmt::Write as _;

/// Height of the text above the charts, in pixels.
const HEAD: f64 = 64.0;
/// Characters of the text per pixel of width; longer text would overflow.
const LETTERS_PER_PIXEL: f64 = 0.12;
/// Space on the right of a chart without a legend, and with one.
const RIGHT: [f64; 2] = [16.0, 96.0];
/// Space above a chart without a title, and with one.
const TOP: [f64; 2] = [12.0, 40.0];

/// Charts on one sheet.
#[derive(Clone, Debug)]
pub struct Sheet {
    /// The subject.
    pub title: String,
    /// The line below the title; truncated if too long.
    pub subtitle: String,
    /// The origin of the file.
    pub description: String,
    /// The charts.
    pub rows: Vec<Vec<Panel>>,
}

/// A chart of a given size.
#[derive(Clone, Debug)]
pub struct Panel {
    /// The chart; its name is not used.
    pub chart: Chart,
    /// Width in pixels, including margins.
    pub width: f64,
    /// Height in pixels, including margins.
    pub height: f64,
}

impl Sheet {
    /// The sheet as an SVG file.
    pub fn svg(&self) -> String {
        let width_of = |row: &Vec<Panel>| row.iter().map(|panel| panel.width).sum::<f64>();
        let height_of = |row: &Vec<Panel>| row.iter().map(|panel| panel.height).fold(0.0, f64::max);
        let width = self.rows.iter().map(width_of).fold(0.0, f64::max);
        let height = HEAD + self.rows.iter().map(height_of).sum::<f64>();
        let mut svg = format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" viewBox=\"0 0 {width} {height}\" \
             font-family=\"DejaVu Sans, Verdana, Liberation Sans, Arial, sans-serif\">\n\
             <desc>{}</desc>\n<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n\
             <text x=\"20\" y=\"28\" font-size=\"17\">{}</text>\n<text x=\"20\" y=\"50\" font-size=\"12\" fill=\"#5b6475\">{}</text>\n",
            escape(&self.description),
            escape(&cut(&self.title, 0.7 * width)),
            escape(&cut(&self.subtitle, width)),
        );
        let mut y = HEAD;
        for (number, row) in self.rows.iter().enumerate() {
            let mut x = 0.0;
            for (column, panel) in row.iter().enumerate() {
                // Clip names are global in the file.
                let clip = format!("panel-{number}-{column}-clip-");
                let chart = panel.svg().replace(&format!("{}-clip-", panel.chart.name), &clip);
                let _ = writeln!(svg, "{}", chart.replacen("<svg ", &format!("<svg x=\"{x}\" y=\"{y}\" "), 1));
                x += panel.width;
            }
            y += height_of(row);
        }
        svg.push_str("</svg>\n");
        svg
    }
}

impl Panel {
    fn svg(&self) -> String {
        let has_legend = self.chart.series.iter().any(|series| series.label.is_some());
        let has_title = !self.chart.title.is_empty();
        let [right, top] = [RIGHT[usize::from(has_legend)], TOP[usize::from(has_title)]];
        let margins = Margins { left: 88.0, right, top, bottom: 56.0 };
        let area = Area {
            width: self.width - margins.left - margins.right,
            height: self.height - margins.top - margins.bottom,
        };
        self.chart.svg_in(area, margins)
    }
}

/// A line truncated to this width in pixels.
fn cut(line: &str, width: f64) -> String {
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // some hundred letters
    let most = (width * LETTERS_PER_PIXEL) as usize;
    if line.chars().count() <= most {
        return line.to_owned();
    }
    line.chars().take(most.saturating_sub(1)).chain(['…']).collect()
}

#[cfg(test)]
mod tests {
    use super::super::{Axis, Look, Series};
    use super::*;

    fn panel(width: f64, points: Vec<(f64, f64)>) -> Panel {
        let line = Series::curve("line", Look::FIXED.line(), points).unlabelled();
        let [x, y] = ["x", "y"].map(Axis::linear);
        let chart = Chart { equal_aspect: true, ..Chart::new("panel", String::new(), [x, y], vec![line]) };
        Panel { chart, width, height: 200.0 }
    }

    #[test]
    fn charts_stand_side_by_side_with_names_of_their_own() {
        let circle = |_| (0..=360).map(|i| f64::from(i).to_radians()).map(|a| (a.cos(), a.sin())).collect();
        let [one, two, three] = [0, 1, 2].map(circle);
        let rows = vec![vec![panel(400.0, one), panel(300.0, two)], vec![panel(500.0, three)]];
        let sheet = Sheet { title: "a < b".into(), subtitle: "x".repeat(500), description: "a\"b".into(), rows };
        let svg = sheet.svg();
        assert!(svg.contains("width=\"700\" height=\"464\""), "{svg}");
        for place in ["<svg x=\"0\" y=\"64\" ", "<svg x=\"400\" y=\"64\" ", "<svg x=\"0\" y=\"264\" "] {
            assert!(svg.contains(place), "{place}");
        }
        assert!(svg.contains("a &lt; b") && svg.contains("a&quot;b") && svg.contains("x…</text>"));
        let mut names: Vec<&str> =
            svg.split("clipPath id=\"").skip(1).filter_map(|rest| rest.split('"').next()).collect();
        let count = names.len();
        names.sort_unstable();
        names.dedup();
        assert_eq!((names.len(), count), (3, 3));
    }
}
