//! The sections and the maps of the page, as data; their cells are made in parallel.
//!
//! In: texts, axes with ranges, the class of each cell, and a quantity of theory that vanishes on the boundary. Out:
//! figures in a report. A cell depends on its place alone, so the same columns give the same map on any number of
//! threads.

use super::contour;
use rayon::prelude::*;
use vi_report::chart::{Axis, Chart, Class, Figure, Series, boundary, middles};
use vi_report::page::Report;
use vi_report::progress::Progress;
use vi_report::table::Table;

/// Rows of a map for every [`COLUMNS`] of them: cells are then nearly square.
const ROWS: usize = 11;
/// Columns of a map for every [`ROWS`].
const COLUMNS: usize = 20;

/// A section of the page.
pub(super) struct Section<'a> {
    pub(super) heading: &'static str,
    /// HTML; may be empty.
    pub(super) prose: String,
    pub(super) parts: Vec<Part<'a>>,
    /// Advice, as HTML; may be empty.
    pub(super) advice: &'static str,
}

/// A figure or a table, with its caption as HTML.
pub(super) enum Part<'a> {
    Map(Map<'a>),
    Chart(Chart, &'static str),
    Table(Table, &'static str),
}

/// The class of a cell.
type Cell<'a> = dyn Fn(f64, f64) -> Class + Sync + 'a;
/// A quantity at a place.
type Quantity<'a> = dyn Fn(f64, f64) -> f64 + Sync + 'a;

/// A map: a coloured cell for each pair of values.
pub(super) struct Map<'a> {
    /// Stem of the file names.
    name: &'static str,
    title: String,
    caption: &'static str,
    axes: [Axis; 2],
    /// Ratio of the columns of the page to those of this map: above 1 for long runs.
    times: usize,
    /// Whether it has as many rows as columns, and a unit has the same length on both axes.
    is_square: bool,
    class: Box<Cell<'a>>,
    /// A quantity that vanishes on the boundary of theory, with its entry in the legend. If it is not finite, no
    /// boundary is drawn.
    theory: Option<(&'static str, Box<Quantity<'a>>)>,
    marks: Vec<Series>,
}

/// Columns and rows.
type Size = [usize; 2];

impl<'a> Map<'a> {
    /// A map over two axes with ranges. `name` is the stem of its file names, `caption` is HTML.
    pub(super) fn new(
        name: &'static str,
        title: impl Into<String>,
        caption: &'static str,
        axes: [Axis; 2],
        class: impl Fn(f64, f64) -> Class + Sync + 'a,
    ) -> Self {
        let class = Box::new(class);
        Self {
            name,
            title: title.into(),
            caption,
            axes,
            times: 1,
            is_square: false,
            class,
            theory: None,
            marks: vec![],
        }
    }

    /// This map with the boundary on which a quantity vanishes.
    pub(super) fn with_theory(self, label: &'static str, quantity: impl Fn(f64, f64) -> f64 + Sync + 'a) -> Self {
        Self { theory: Some((label, Box::new(quantity))), ..self }
    }

    /// This map with points over the cells.
    pub(super) fn with_marks(self, marks: Vec<Series>) -> Self {
        Self { marks, ..self }
    }

    /// This map with fewer columns, by this factor.
    pub(super) fn coarser(self, times: usize) -> Self {
        Self { times: times.max(1), ..self }
    }

    /// This map with as many rows as columns, so that units have the same length on both axes.
    pub(super) fn square(self) -> Self {
        Self { is_square: true, ..self }
    }

    /// Its size on a page of this many columns.
    fn size(&self, columns: usize) -> Size {
        let columns = columns.div_ceil(self.times);
        [columns, if self.is_square { columns } else { (columns * ROWS).div_ceil(COLUMNS) }]
    }

    /// The class of every cell, row by row; `done` gets the number of cells after every row.
    fn cells(&self, [columns, rows]: Size, mut done: impl FnMut(usize)) -> Vec<Class> {
        let [x, y] = &self.axes;
        let abscissas: Vec<f64> = middles(x, columns).collect();
        let mut cells = Vec::with_capacity(columns * rows);
        for y in middles(y, rows) {
            cells.par_extend(abscissas.par_iter().map(|&x| (self.class)(x, y)));
            done(columns);
        }
        cells
    }

    /// The curves on which a quantity vanishes, in the values of the axes.
    #[allow(clippy::cast_precision_loss)] // some hundred cells
    fn zeros(&self, [columns, rows]: Size, quantity: &Quantity) -> Vec<Vec<(f64, f64)>> {
        let [x, y] = &self.axes;
        let place = |(column, row): (f64, f64)| (x.at(column / columns as f64), y.at(row / rows as f64));
        let width = columns + 1;
        let value = |index: usize| {
            let (x, y) = place(((index % width) as f64, (index / width) as f64));
            quantity(x, y)
        };
        let values: Vec<f64> = (0..width * (rows + 1)).into_par_iter().map(value).collect();
        let curves = contour::zeros(&values, width);
        curves.into_iter().map(|curve| curve.into_iter().map(place).collect()).collect()
    }

    /// The figure on a page of this many columns.
    fn figure(self, columns: usize, done: impl FnMut(usize)) -> Figure {
        let size = self.size(columns);
        let cells = self.cells(size, done);
        let theory = self.theory.as_ref();
        let mut series = theory.map_or_else(Vec::new, |(label, of)| boundary(label, self.zeros(size, of.as_ref())));
        series.extend(self.marks);
        let [x, y] = self.axes;
        let chart = Chart { name: self.name, title: self.title, x, y, equal_aspect: self.is_square, series };
        vi_report::chart::Map { chart, columns: size[0], cells }.figure()
    }
}

/// Adds sections to a report, with maps of this many columns.
pub(super) fn write(report: &mut Report, columns: u16, sections: Vec<Section>) {
    let columns = usize::from(columns);
    let cells = sections.iter().flat_map(|section| &section.parts).map(|part| match part {
        Part::Map(map) => map.size(columns).iter().product::<usize>(),
        Part::Chart(..) | Part::Table(..) => 0,
    });
    let count = |cells: usize| u64::try_from(cells).unwrap_or(u64::MAX);
    let mut progress = Progress::new(count(cells.sum()));
    for Section { heading, prose, parts, advice } in sections {
        progress.message(heading.to_owned());
        report.section(heading);
        if !prose.is_empty() {
            report.prose(&prose);
        }
        for part in parts {
            match part {
                Part::Map(map) => {
                    let caption = map.caption;
                    report.figure(map.figure(columns, |cells| progress.advance_by(count(cells))), caption);
                }
                Part::Chart(chart, caption) => report.figure(chart.figure(), caption),
                Part::Table(table, caption) => report.table(&table, caption),
            }
        }
        if !advice.is_empty() {
            report.prose(&format!("<b>What to do.</b> {advice}"));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::ending::{LASTING, NOT_CONVERGED, UNBOUNDED};
    use super::super::fixed::SEVERAL;
    use super::super::tests::catalogue;
    use super::super::{energy, sections};
    use super::*;

    impl Map<'_> {
        /// Makes the map finer, with ordinates in this range.
        fn narrow(&mut self, ordinates: Option<(f64, f64)>) {
            self.times = 1;
            if let Some((low, high)) = ordinates {
                self.axes[1] = self.axes[1].clone().over(low, high);
            }
        }

        /// The number of cells that contradict theory by more than a pixel: `marked` or not, they differ from the sign
        /// of theory in the cell itself and in the eight cells around. Refuses a uniform map, which proves nothing.
        fn strays(&self, columns: usize, marked: Class, is_below: bool) -> usize {
            let size @ [columns, rows] = self.size(columns);
            let cells = self.cells(size, |_| ());
            let (_, theory) = self.theory.as_ref().expect("a boundary");
            let abscissas: Vec<f64> = middles(&self.axes[0], columns).collect();
            let expected: Vec<bool> = middles(&self.axes[1], rows)
                .flat_map(|y| abscissas.iter().map(move |&x| (theory(x, y) < 0.0) == is_below))
                .collect();
            let share = expected.iter().filter(|inside| **inside).count();
            let [cells_of_one, all] = [share.min(cells.len() - share), cells.len()];
            assert!(cells_of_one * 20 > all, "{}: {share} of {all} cells", self.name);
            let around = |index: usize| {
                let (row, column) = (index / columns, index % columns);
                let near = (row.saturating_sub(1)..=(row + 1).min(rows - 1)).flat_map(move |row| {
                    (column.saturating_sub(1)..=(column + 1).min(columns - 1)).map(move |column| (row, column))
                });
                near.map(|(row, column)| expected[row * columns + column]).collect::<Vec<_>>()
            };
            (0..all).filter(|&index| !around(index).contains(&(cells[index] == marked))).count()
        }
    }

    /// A map of the page; the class of the cells at which its theory is negative or, if not `is_below`, positive; the
    /// number of columns, and the range of the ordinates.
    type Claim = (&'static str, Class, bool, usize, Option<(f64, f64)>);

    fn assert_theory(claims: &[Claim]) {
        let [well, pendulum] = ["double-well", "pendulum"].map(|name| catalogue().find(name).expect("a system"));
        let mut maps = maps(sections(&well, &pendulum).expect("sections"));
        for (name, marked, is_below, columns, ordinates) in claims {
            let map = maps.iter_mut().find(|map| map.name == *name).expect("a map");
            map.narrow(*ordinates);
            assert_eq!(map.strays(*columns, *marked, *is_below), 0, "{name}");
        }
    }

    fn maps(sections: Vec<Section>) -> Vec<Map> {
        let parts = sections.into_iter().flat_map(|section| section.parts);
        parts.filter_map(|part| if let Part::Map(map) = part { Some(map) } else { None }).collect()
    }

    /// With a shift every motion runs.
    fn assert_shifted(columns: usize) {
        let pendulum = catalogue().find("pendulum").expect("a system");
        let mut maps = maps(vec![energy::orders(pendulum.system.as_ref())]);
        let map = maps.last_mut().expect("a map");
        map.narrow(Some((0.03, 0.06)));
        assert_eq!((map.name, map.times), ("orders-2-shifted", 1));
        assert!(map.cells(map.size(columns), |_| ()).iter().all(|class| class.number == LASTING.number));
    }

    #[test]
    fn runs_end_where_theory_says() {
        assert_theory(&[
            ("linear-trapezoidal", UNBOUNDED, false, 30, None),
            ("roots-well", SEVERAL, true, 60, None),
            ("roots-kepler", NOT_CONVERGED, true, 50, None),
            ("kepler-energy", LASTING, true, 25, Some((0.01, 0.02))),
            ("orders-2", LASTING, true, 8, Some((0.03, 0.06))),
            ("orders-3", LASTING, true, 8, Some((0.1, 0.15))),
        ]);
        assert_shifted(6);
    }

    #[test]
    fn librations_run_and_rotations_end() {
        let [well, pendulum] = ["double-well", "pendulum"].map(|name| catalogue().find(name).expect("a system"));
        let mut maps = maps(vec![energy::separatrix(&well, &pendulum).expect("a section")]);
        let map = maps.last_mut().expect("a map");
        map.theory = Some(("separatrix", Box::new(|angle: f64, v: f64| v * v / 2.0 - angle.cos() - 1.0)));
        assert_eq!((map.name, map.strays(20, LASTING, true)), ("plane-pendulum", 0));
    }

    #[test]
    #[ignore = "many steps: `.ci/run nightly`"]
    fn runs_of_high_orders_end_where_theory_says_in_detail() {
        assert_theory(&[
            ("orders-2", LASTING, true, 20, Some((0.03, 0.06))),
            ("orders-3", LASTING, true, 20, Some((0.1, 0.15))),
        ]);
        assert_shifted(20);
    }

    #[test]
    fn a_shifted_boundary_is_noticed() {
        let class = |number| Class { number, label: "", colour: "" };
        let map = |edge: f64| {
            let axes = [Axis::linear("x").over(0.0, 1.0), Axis::linear("y").over(0.0, 1.0)];
            let map = Map::new("test", "", "", axes, move |x, _| class(u8::from(x > 0.5)));
            map.with_theory("edge", move |x, _| x - edge)
        };
        assert_eq!(map(0.52).strays(40, class(1), false), 0);
        assert!(map(0.56).strays(40, class(1), false) > 0);
    }

    #[test]
    fn the_curve_drawn_is_that_of_the_formula() {
        let system = vi_systems::DoubleWell::default();
        let density = |q: f64, v: f64| {
            vi_core::stepping::EnergyStepping::step_density(&system, 0.0, &[q].into(), &[v].into()).unwrap_or(f64::NAN)
        };
        let axes = [Axis::linear("q").over(-1.5, 1.5), Axis::linear("v").over(-1.2, 1.2)];
        let map = Map::new("test", "", "", axes, |_, _| LASTING);
        let curve = map.zeros([60, 33], &density).concat();
        // D = (2q³ − q)² + (6q² − 1) v² vanishes at v = ±|2q³ − q|/√(1 − 6q²).
        let exact = |q: f64| (2.0 * q.powi(3) - q).abs() / (1.0 - 6.0 * q * q).sqrt();
        let worst = curve.iter().map(|(q, v)| (v.abs() - exact(*q)).abs()).filter(|gap| gap.is_finite());
        let far = worst.fold(0.0, f64::max);
        assert!(curve.len() > 80 && far < 0.05, "{} points, off by {far}", curve.len());
    }
}
