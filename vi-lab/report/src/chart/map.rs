//! Maps: a coloured cell per pair of values, under the curves of a chart.
//!
//! In: a [`Chart`] whose axes have ranges, and a [`Class`] per cell. Out: [`Map::figure`], in which adjacent cells of a
//! class in a row form one rectangle, and a CSV matrix: the ordinates in the first column, the abscissas in the first
//! line, classes by number. The curves of the chart, such as a theoretical boundary, are drawn over the cells and
//! listed in comments of the CSV.

use super::draw::MARGINS;
use super::{Axis, Chart, Figure, Look, Series};
use core::fmt::Write as _;
use kuva::prelude::{LegendEntry, LegendShape};
use std::collections::BTreeSet;

/// The result in a cell.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Class {
    /// Position in the legend, and number in the CSV.
    pub number: u8,
    /// Entry in the legend.
    pub label: &'static str,
    /// Colour as hexadecimal RGB.
    pub colour: &'static str,
}

/// A chart over coloured cells.
#[derive(Clone, Debug)]
pub struct Map {
    /// Name, title, axes with ranges, and curves.
    pub chart: Chart,
    /// Cells in a row.
    pub columns: usize,
    /// The cells, row by row, from the lowest ordinate upwards.
    pub cells: Vec<Class>,
}

/// The midpoints of `count` equal parts of an axis.
pub fn middles(axis: &Axis, count: usize) -> impl Iterator<Item = f64> + '_ {
    #[allow(clippy::cast_precision_loss)] // some hundred cells
    let part = move |index: usize| (index as f64 + 0.5) / count as f64;
    (0..count).map(move |index| axis.at(part(index)))
}

/// A theoretical boundary: curves that contrast with every cell colour, and one entry in the legend.
#[must_use]
pub fn boundary(label: &str, curves: Vec<Vec<(f64, f64)>>) -> Vec<Series> {
    let lines = curves.clone().into_iter().enumerate().map(|(index, points)| {
        let line = Series::curve(label, Look::EXACT, points);
        if index == 0 { line } else { line.unlabelled() }
    });
    curves.into_iter().map(|points| Series::curve("", Look::HALO, points).unlabelled()).chain(lines).collect()
}

impl Map {
    /// The map as an SVG figure, and its cells as a CSV matrix.
    #[must_use]
    pub fn figure(&self) -> Figure {
        let classes: BTreeSet<Class> = self.cells.iter().copied().collect();
        let legend = classes.iter().map(|class| LegendEntry {
            label: class.label.to_owned(),
            color: class.colour.to_owned(),
            shape: LegendShape::Rect,
            dasharray: None,
        });
        let Figure { name, svg, .. } = self.chart.figure_over(Some(legend.collect()));
        // The axes are the first lines of the figure: cells come below them and above the white background.
        let svg = svg.replacen("<line ", &format!("{}<line ", self.rectangles(&classes)), 1);
        Figure { name, svg, csv: self.csv(&classes) }
    }

    fn rows(&self) -> usize {
        self.cells.len() / self.columns.max(1)
    }

    /// A path per class with one rectangle per run of cells. Adjacent rectangles share their edges to the last digit,
    /// so that the background stays hidden.
    fn rectangles(&self, classes: &BTreeSet<Class>) -> String {
        let area = self.chart.fixed_area();
        #[allow(clippy::cast_precision_loss)] // some hundred cells
        let part = |index: usize, count: usize| index as f64 / count as f64;
        let x = |column: usize| MARGINS.left + area.width * part(column, self.columns);
        let y = |row: usize| MARGINS.top + area.height * (1.0 - part(row, self.rows()));
        let mut group = String::from("<g shape-rendering=\"crispEdges\">");
        // Writing to a string cannot fail.
        for class in classes {
            let _ = write!(group, "<path fill=\"{}\" d=\"", class.colour);
            for (row, cells) in self.cells.chunks(self.columns.max(1)).enumerate() {
                let bottom = y(row);
                let top = y(row + 1);
                let mut column = 0;
                for run in cells.chunk_by(PartialEq::eq) {
                    let left = x(column);
                    let right = x(column + run.len());
                    if run.first() == Some(class) {
                        let _ = write!(group, "M{left:.2} {top:.2}H{right:.2}V{bottom:.2}H{left:.2}z");
                    }
                    column += run.len();
                }
            }
            group.push_str("\"/>");
        }
        group.push_str("</g>");
        group
    }

    fn csv(&self, classes: &BTreeSet<Class>) -> String {
        let Chart { name, title, x, y, series, .. } = &self.chart;
        let mut csv = format!("# {name}: {title}\n# columns: {}\n# rows: {}\n", x.label, y.label);
        for Class { number, label, .. } in classes {
            let _ = writeln!(csv, "# {number}: {label}");
        }
        for series in series.iter().filter(|series| series.look.colour != Look::HALO.colour) {
            let label = series.label.as_deref().unwrap_or("continued");
            let points: Vec<String> = series.points.iter().map(|(x, y)| format!("({x:.5e}, {y:.5e})")).collect();
            let _ = writeln!(csv, "# curve, {label}: {}", points.join(" "));
        }
        for value in middles(x, self.columns) {
            let _ = write!(csv, ",{value:.5e}");
        }
        csv.push('\n');
        for (value, cells) in middles(y, self.rows()).zip(self.cells.chunks(self.columns.max(1))) {
            let _ = write!(csv, "{value:.5e}");
            for cell in cells {
                let _ = write!(csv, ",{}", cell.number);
            }
            csv.push('\n');
        }
        csv
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const ONE: Class = Class { number: 1, label: "one", colour: "#111111" };
    const TWO: Class = Class { number: 2, label: "two", colour: "#222222" };

    fn map(cells: Vec<Class>) -> Map {
        let chart = Chart::new(
            "test",
            "test",
            [Axis::linear("x").over(0.0, 2.0), Axis::log10("y").over(0.01, 100.0)],
            boundary("theory", vec![vec![(0.0, 1.0), (2.0, 1.0)]]),
        );
        Map { chart, columns: 2, cells }
    }

    #[test]
    fn cells_fill_the_plot_area() {
        let svg = map(vec![ONE, TWO, ONE, ONE]).figure().svg;
        // The area of 596 by 330 pixels in four parts; the lower row has two classes, the upper one is one rectangle.
        assert!(
            svg.contains("<path fill=\"#111111\" d=\"M88.00 209.00H386.00V374.00H88.00zM88.00 44.00H684.00V209.00H"),
            "{svg}"
        );
        assert!(svg.contains("<path fill=\"#222222\" d=\"M386.00 209.00H684.00V374.00H386.00z\"/>"), "{svg}");
        let cells = svg.find("<g shape-rendering");
        let axis = svg.find("<line ");
        assert!(cells.is_some() && cells < axis, "the axes are drawn over the cells");
        assert!(svg.contains(">one</text>") && svg.contains(">theory</text>"));
    }

    #[test]
    fn no_ground_shows_between_cells() {
        // Neither 7 columns nor 9 rows divide the area of 596 by 330 pixels into hundredths of a pixel.
        let cells: Vec<Class> = (0..63).map(|cell| if cell % 3 == 0 { ONE } else { TWO }).collect();
        let Figure { svg, .. } = Map { columns: 7, ..map(cells) }.figure();
        let cells =
            svg.split("<g shape-rendering").nth(1).and_then(|rest| rest.split("</g>").next()).expect("the cells");
        let rectangles: Vec<[f64; 4]> = cells
            .split('M')
            .skip(1)
            .map(|path| {
                let text = path.split('z').next().unwrap_or_default();
                let numbers: Vec<f64> = text.split(['H', 'V', ' ']).filter_map(|number| number.parse().ok()).collect();
                [numbers[0], numbers[1], numbers[2], numbers[3]]
            })
            .collect();
        let area: f64 = rectangles.iter().map(|[left, top, right, bottom]| (right - left) * (bottom - top)).sum();
        assert!((area - 596.0 * 330.0).abs() < 1e-6, "the cells cover {area} square pixels");
        // Neighbours share their edges to the last digit: there are no more of them than lines of the grid.
        let edges = |sides: [usize; 2]| -> BTreeSet<u64> {
            rectangles.iter().flat_map(|rectangle| sides.map(|side| rectangle[side].to_bits())).collect()
        };
        assert_eq!([edges([0, 2]).len(), edges([1, 3]).len()], [8, 10]);
    }

    #[test]
    fn the_table_is_a_matrix_with_its_key() {
        let csv = map(vec![ONE, TWO, ONE, ONE]).figure().csv;
        let expected = "# test: test\n# columns: x\n# rows: y\n# 1: one\n# 2: two\n\
                        # curve, theory: (0.00000e0, 1.00000e0) (2.00000e0, 1.00000e0)\n\
                        ,5.00000e-1,1.50000e0\n1.00000e-1,1,2\n1.00000e1,1,1\n";
        assert_eq!(csv, expected);
    }
}
