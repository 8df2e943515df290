//! Where steps of each order exist: the amplitudes of a pendulum at which the density keeps its sign, and runs.

use super::super::book::Book;
use super::super::unexpected;
use super::{LOOKS, end, largest, released, swing};
use vi_core::StepError;
use vi_erased::plan::ENERGY_STAGES;
use vi_report::chart::{Axis, Chart, Look, Series};
use vi_report::failure::Failure;
use vi_report::page::math::{id, num, op, row, sub, sup};
use vi_report::table::Table;

/// Amplitudes, in radians.
const AMPLITUDES: (f64, f64) = (0.1, 3.1);
/// Amplitudes that are looked at.
const COUNT: u32 = 61;
/// More than a quarter of any of these swings: D_s of the rest is the same.
const QUARTER: f64 = 6.0;
/// How long runs have to last: some quarters.
const LASTING: f64 = 12.0;
/// Short steps of 1, 2 and 3 stages: for shorter ones rounding would dominate the length.
const STEPS: [f64; ENERGY_STAGES.len()] = [0.005, 0.03, 0.1];
/// A libration that almost reaches the top, its first step, and its steps.
const WIDEST: f64 = 3.139;
const WIDEST_STEP: f64 = 0.1;
const WIDEST_STEPS: u32 = 20_000;

/// The section: a figure, and the thresholds.
pub(super) fn section(book: &mut Book) -> Result<(), Failure> {
    book.section("Where steps of each order exist");
    book.prose(
        "Each order has its own domain. The figure shows the least <i>D<sub>s</sub></i> of a pendulum’s oscillation from rest, \
         divided by the largest, along the accurate motion. If it is positive, steps exist. Circles mark runs of short steps that \
         last, crosses those that end. For one stage, with <i>c</i> = cos <i>q</i> and the amplitude <i>A</i>,",
    );
    book.formula(&least());
    book.prose("So the paper’s step exists in every libration.");
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
        let threshold =
            crossing(&points).map_or_else(|| "every amplitude".to_owned(), |angle| format!("{angle:.2} rad"));
        let [widest, narrowest] =
            bounds.map(|angle| if angle.is_nan() { "–".to_owned() } else { format!("{angle:.2} rad") });
        table.row([stages.to_string(), (2 * stages).to_string(), threshold, widest, narrowest]);
        series.push(Series::line(format!("s = {stages}"), LOOKS[index], points));
    }
    series.push(Series::scatter("a run lasts", Look::ENERGY.dots(4.0), lasting));
    series.push(Series::scatter("a run ends", Look::RIVAL.dots(4.0), ending));
    let chart = Chart {
        name: "theory-domains",
        title: "Least over largest step density of an oscillation".to_owned(),
        x: Axis::linear("amplitude, rad"),
        y: Axis::linear("min D_s / max |D_s|"),
        equal_aspect: false,
        series,
    };
    book.figure(
        &chart,
        "A higher order has another domain, here a smaller one. Above the barrier of the double well steps of order 4 exist and \
         those of order 2 do not.",
    );
    let taken = widest().map_err(unexpected("pendulum"))?;
    book.table(
        table,
        &format!(
            "Thresholds of the pendulum. Theory: every amplitude, π/2 and 0.81 rad. A run with one stage, {WIDEST} rad and the first \
             step {WIDEST_STEP} takes all of {taken} steps."
        ),
    );
    Ok(())
}

/// `D_1 = 1 + c² − 2 c cos A = (c − cos A)² + sin² A ≥ sin² A > 0`.
fn least() -> String {
    let cos = || [op("cos"), id("A")].concat();
    let sine = || [sup(&op("sin"), &num("2")), id("A")].concat();
    let first = [num("1"), op("+"), sup(&id("c"), &num("2")), op("−"), num("2"), id("c"), cos()].concat();
    let square = sup(&row(&[op("("), id("c"), op("−"), cos(), op(")")]), &num("2"));
    let parts = [sub(&id("D"), &num("1")), op("="), first, op("="), square, op("+"), sine(), op("≥"), sine()];
    [parts.concat(), op(">"), num("0")].concat()
}

/// The steps that a libration close to the top takes: all of them, or the step that fails is the error.
fn widest() -> Result<u32, StepError> {
    let mut run = released::<1>(WIDEST, WIDEST_STEP)?;
    for _ in 0..WIDEST_STEPS {
        run.step()?;
    }
    Ok(WIDEST_STEPS)
}

/// The least D_s of an oscillation divided by the largest, for each number of stages, over the amplitude.
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

#[cfg(test)]
mod tests {
    use super::super::densities;
    use vi_core::State;

    #[test]
    fn the_density_of_a_libration_is_bounded_below() {
        let amplitude: f64 = 3.0;
        let mut worst = 0.0_f64;
        for k in 0..=20 {
            let q = amplitude * f64::from(k) / 20.0;
            let (c, bottom) = (q.cos(), amplitude.cos());
            let v = (2.0 * (c - bottom)).max(0.0).sqrt();
            let state = State { t: 0.0, q: [q].into(), p: [v].into() };
            let [density, ..] = densities(&state).expect("a density");
            worst = worst.max((density - (1.0 + c * c - 2.0 * c * bottom)).abs());
            assert!(density > amplitude.sin().powi(2) - 1e-14, "{q}: {density}");
        }
        // Measured 8.9e-16.
        assert!(worst < 4e-15, "{worst}");
    }
}
