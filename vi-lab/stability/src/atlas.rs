//! The maps of the page as they are made: cells in parallel, files at once.
//!
//! In: axes with ranges, and what a cell shows. Out: maps and charts in the report. A cell depends on its place alone, so
//! the same columns give the same map on any number of threads.

use super::contour;
use rayon::prelude::*;
use vi_report::chart::{Axis, Chart, Class, Map, Series, middles};
use vi_report::failure::Failure;
use vi_report::page::Report;
use vi_report::progress::Progress;
use vi_report::table::Table;

/// Rows of a map for every [`COLUMNS`] of them: cells are then nearly square.
const ROWS: usize = 11;
/// Columns of a map for every [`ROWS`].
const COLUMNS: usize = 20;

/// The report, and how fine its maps are.
#[derive(Debug)]
pub(super) struct Atlas {
    report: Report,
    progress: Progress,
    columns: usize,
}

/// The two axes of a map, with their ranges.
#[derive(Clone, Debug)]
pub(super) struct Axes {
    /// Horizontal axis.
    pub(super) x: Axis,
    /// Vertical axis.
    pub(super) y: Axis,
}

/// What is written about a map.
#[derive(Clone, Copy, Debug)]
pub(super) struct Labels<'a> {
    /// Stem of the file names.
    pub(super) name: &'static str,
    /// Line above the map, as text.
    pub(super) title: &'a str,
    /// What the map shows, as HTML.
    pub(super) caption: &'a str,
}

/// Axes of a map, and its cells in a row and in a column.
#[derive(Clone, Debug)]
pub(super) struct Grid {
    /// The axes.
    pub(super) axes: Axes,
    columns: usize,
    rows: usize,
    equal_aspect: bool,
}

/// Rows of a map, from the number of its columns.
fn rows(columns: usize) -> usize {
    (columns * ROWS).div_ceil(COLUMNS)
}

impl Grid {
    /// A grid of the given number of columns over two axes with ranges.
    pub(super) fn new(axes: Axes, columns: usize) -> Self {
        Self { axes, columns, rows: rows(columns), equal_aspect: false }
    }

    /// The same with as many rows as columns, a unit having the same length on both axes.
    pub(super) fn square(self) -> Self {
        Self { rows: self.columns, equal_aspect: true, ..self }
    }

    /// The class of every cell, row by row; `done` gets the number of cells after every row. A cell is a call: one copy of the loop serves all maps.
    pub(super) fn cells(&self, class: &(dyn Fn(f64, f64) -> Class + Sync), mut done: impl FnMut(usize)) -> Vec<Class> {
        let abscissas: Vec<f64> = middles(&self.axes.x, self.columns).collect();
        let mut cells = Vec::with_capacity(self.columns * self.rows);
        for y in middles(&self.axes.y, self.rows) {
            cells.par_extend(abscissas.par_iter().map(|&x| class(x, y)));
            done(self.columns);
        }
        cells
    }

    /// The curves on which `quantity` vanishes, in the values of the axes.
    pub(super) fn zeros(&self, quantity: &(dyn Fn(f64, f64) -> f64 + Sync)) -> Vec<Vec<(f64, f64)>> {
        let part = |index: f64, count: usize| {
            #[allow(clippy::cast_precision_loss)] // some hundred cells
            let count = count as f64;
            index / count
        };
        let place = |(column, row): (f64, f64)| {
            (self.axes.x.at(part(column, self.columns)), self.axes.y.at(part(row, self.rows)))
        };
        let width = self.columns + 1;
        let values: Vec<f64> = (0..width * (self.rows + 1))
            .into_par_iter()
            .map(|index| {
                #[allow(clippy::cast_precision_loss)]
                let (x, y) = place(((index % width) as f64, (index / width) as f64));
                quantity(x, y)
            })
            .collect();
        let curves = contour::zeros(&values, width);
        curves.into_iter().map(|curve| curve.into_iter().map(place).collect()).collect()
    }
}

impl Atlas {
    /// An empty atlas for `maps` maps with the given number of columns.
    pub(super) fn new(report: Report, columns: u16, maps: u32) -> Self {
        let columns = usize::from(columns);
        let cells = columns * rows(columns);
        let progress = Progress::new(u64::from(maps) * u64::try_from(cells).unwrap_or(u64::MAX));
        Self { report, progress, columns }
    }

    /// A grid over two axes with ranges, as fine as the page's maps are.
    pub(super) fn grid(&self, axes: Axes) -> Grid {
        Grid::new(axes, self.columns)
    }

    /// A grid with fewer columns, by this factor, for long runs.
    pub(super) fn coarse_grid(&self, axes: Axes, times: usize) -> Grid {
        Grid::new(axes, self.columns.div_ceil(times.max(1)))
    }

    /// Starts a section.
    pub(super) fn section(&mut self, heading: &str) {
        self.progress.message(heading.to_owned());
        self.report.section(heading);
    }

    /// A paragraph of HTML.
    pub(super) fn prose(&mut self, html: &str) {
        self.report.prose(html);
    }

    /// What to do, after a chart.
    pub(super) fn advice(&mut self, html: &str) {
        self.report.prose(&format!("<b>What to do.</b> {html}"));
    }

    /// A map with the curves over it, and its caption; returns its cells.
    pub(super) fn map(
        &mut self,
        labels: Labels<'_>,
        grid: &Grid,
        curves: Vec<Series>,
        class: impl Fn(f64, f64) -> Class + Sync,
    ) -> Result<Vec<Class>, Failure> {
        let cells = grid.cells(&class, |count| self.progress.advance_by(u64::try_from(count).unwrap_or(0)));
        let Axes { x, y } = grid.axes.clone();
        let title = labels.title.to_owned();
        let chart = Chart { name: labels.name, title, x, y, equal_aspect: grid.equal_aspect, series: curves };
        let map = Map { chart, columns: grid.columns, cells };
        self.report.figure(&map.figure(), labels.caption)?;
        Ok(map.cells)
    }

    /// A chart and its caption.
    pub(super) fn chart(&mut self, chart: &Chart, caption: &str) -> Result<(), Failure> {
        self.report.figure(&chart.figure(), caption)
    }

    /// A table and its caption.
    pub(super) fn table(&mut self, table: &Table, caption: &str) -> Result<(), Failure> {
        self.report.table(table, caption)
    }

    /// The report with all that is in it.
    pub(super) fn into_report(self) -> Report {
        self.report
    }
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;

    /// Cells that contradict theory by more than a pixel: those whose being `marked` is neither what theory says there
    /// nor what it says of one of the eight cells around. Zero of a map that is all alike proves nothing, and is refused.
    pub(in super::super) fn strays(
        grid: &Grid,
        cells: &[Class],
        marked: Class,
        theory: impl Fn(f64, f64) -> bool,
    ) -> usize {
        let columns = grid.columns;
        let rows = grid.rows;
        assert_eq!(cells.len(), columns * rows);
        let abscissas: Vec<f64> = middles(&grid.axes.x, columns).collect();
        let expected: Vec<bool> = middles(&grid.axes.y, rows)
            .flat_map(|y| abscissas.iter().map(move |&x| (x, y)))
            .map(|(x, y)| theory(x, y))
            .collect();
        let share = expected.iter().filter(|inside| **inside).count();
        assert!(share * 20 > cells.len() && share * 20 < 19 * cells.len(), "{share} of {} cells", cells.len());
        let around = |index: usize| {
            let row = index / columns;
            let column = index % columns;
            let near = (row.saturating_sub(1)..=(row + 1).min(rows - 1)).flat_map(move |row| {
                (column.saturating_sub(1)..=(column + 1).min(columns - 1)).map(move |column| (row, column))
            });
            near.map(|(row, column)| expected[row * columns + column]).collect::<Vec<_>>()
        };
        (0..cells.len()).filter(|&index| !around(index).contains(&(cells[index] == marked))).count()
    }

    #[test]
    fn a_shifted_boundary_is_noticed() {
        let class = |number| Class { number, label: "", colour: "" };
        let grid = Grid::new(Axes { x: Axis::linear("x").over(0.0, 1.0), y: Axis::linear("y").over(0.0, 1.0) }, 40);
        let cells = grid.cells(&|x, _| class(u8::from(x > 0.5)), |_| ());
        assert_eq!(strays(&grid, &cells, class(1), |x, _| x > 0.52), 0);
        assert!(strays(&grid, &cells, class(1), |x, _| x > 0.56) > 0);
    }
}
