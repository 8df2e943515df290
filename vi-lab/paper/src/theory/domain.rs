//! Where steps of each order exist: the amplitudes of a pendulum at which the density keeps its sign, and runs.

use super::super::book::Book;
use super::super::unexpected;
use super::{LOOKS, end, largest, swing};
use vi_core::StepError;
use vi_erased::plan::ENERGY_STAGES;
use vi_report::chart::{Axis, Chart, Look, Series};
use vi_report::failure::Failure;
use vi_report::table::Table;

/// Amplitudes, in radians.
const AMPLITUDES: (f64, f64) = (0.1, 3.1);
/// Amplitudes that are looked at.
const COUNT: u32 = 61;
/// More than a quarter of any of these swings: D_s of the rest is the same.
const QUARTER: f64 = 6.0;
/// How long runs have to last: some quarters.
const LASTING: f64 = 12.0;
/// Short steps of 1, 2 and 3 stages: of shorter ones rounding would lose the length.
const STEPS: [f64; ENERGY_STAGES.len()] = [0.005, 0.03, 0.1];

/// The section: a figure, and the thresholds.
pub(super) fn section(book: &mut Book) -> Result<(), Failure> {
    book.section("Where steps of each order exist");
    book.prose(
        "So each order has a domain of its own. Pendulum from rest: drawn is the least <i>D<sub>s</sub></i> of a swing by the \
         largest, along the accurate motion. Where it is positive steps exist; filled circles are runs of short steps that last, \
         crosses those that end.",
    );
    let margins = margins().map_err(unexpected("pendulum"))?;
    let mut series = vec![Series::line("zero", Look::BACKGROUND, vec![(0.0, 0.0), (AMPLITUDES.1, 0.0)]).unlabelled()];
    let mut table = Table::new(
        "theory-domains",
        ["stages", "order", "D_s keeps its sign below", "the widest run that lasts", "the narrowest that ends"],
    );
    let [mut lasting, mut ending] = [Vec::new(), Vec::new()];
    for (index, stages) in ENERGY_STAGES.into_iter().enumerate() {
        let points: Vec<(f64, f64)> = margins.iter().map(|(angle, margins)| (*angle, margins[index])).collect();
        let mut bounds = [f64::NAN; 2];
        for point in points.iter().skip(1).step_by(3) {
            let end = end(stages, point.0, STEPS[index], LASTING).map_err(unexpected("pendulum"))?;
            if end.is_none() {
                bounds[0] = point.0;
                lasting.push(*point);
            } else {
                bounds[1] = bounds[1].min(point.0);
                ending.push(*point);
            }
        }
        let threshold = crossing(&points).map_or_else(|| "–".to_owned(), |angle| format!("{angle:.2} rad"));
        let [widest, narrowest] =
            bounds.map(|angle| if angle.is_nan() { "–".to_owned() } else { format!("{angle:.2} rad") });
        table.row([stages.to_string(), (2 * stages).to_string(), threshold, widest, narrowest]);
        series.push(Series::line(format!("s = {stages}"), LOOKS[index], points));
    }
    series.push(Series::scatter("a run lasts", Look::ENERGY.dots(4.0), lasting));
    series.push(Series::scatter("a run ends", Look::RIVAL.dots(4.0), ending));
    let chart = Chart {
        name: "theory-domains",
        title: "Least step density of a swing, by the largest".to_owned(),
        x: Axis::linear("amplitude, rad"),
        y: Axis::linear("min D_s / max |D_s|"),
        equal_aspect: false,
        series,
    };
    book.figure(&chart, "A higher order has another domain, here a smaller one; above the double well’s barrier steps of order 4 exist and those of order 2 do not.")?;
    book.table(&table, "Thresholds of the pendulum. Theory: 3.09, π/2 and 0.81 rad.")
}

/// The least D_s of a swing by the largest, of each number of stages, over the amplitude.
fn margins() -> Result<Vec<(f64, [f64; ENERGY_STAGES.len()])>, StepError> {
    let (low, high) = AMPLITUDES;
    let amplitudes = (0..COUNT).map(|k| low + (high - low) * f64::from(k) / f64::from(COUNT - 1));
    let margin = |angle: f64| {
        let swing = swing(angle, QUARTER)?;
        let margins = core::array::from_fn(|index| {
            let least = swing.iter().map(|point| point.densities[index]).fold(f64::INFINITY, f64::min);
            least / largest(&swing, index)
        });
        Ok((angle, margins))
    };
    amplitudes.map(margin).collect()
}

/// Where a curve first comes to zero.
fn crossing(points: &[(f64, f64)]) -> Option<f64> {
    let (before, after) =
        points.iter().zip(points.iter().skip(1)).find(|(before, after)| before.1 > 0.0 && after.1 <= 0.0)?;
    Some(before.0 + (after.0 - before.0) * before.1 / (before.1 - after.1))
}
