//! The discrete energy error of both integrators.

use super::super::book::{Book, Verdict};
use super::runs::{Pair, Track};
use vi_report::chart::{Axis, Chart, Look, Series};
use vi_report::failure::Failure;
use vi_report::numbers::scientific;
use vi_report::table::Table;

/// What the paper reports for the energy-preserving integrator.
const PUBLISHED: f64 = 1e-14;

/// The section: the error over some oscillations, its growth over the long run, and a table.
pub(super) fn section(book: &mut Book, runs: &[Pair]) -> Result<(), Failure> {
    book.section("Discrete energy");
    book.prose(
        "The discrete energy <i>E<sub>k</sub></i> = −<i>D</i><sub>3</sub><i>L<sub>d</sub></i> is what the integrator \
         preserves. With the midpoint rule it is the energy at the middle of the step, and it is evaluated there, from the \
         step’s own velocity: recomputed from stored nodes it would show the cancellation of \
         (<i>q</i><sub><i>k</i>+1</sub> − <i>q<sub>k</sub></i>)/<i>h</i>, 10⁻¹⁴ to 10⁻¹², whatever the solver.",
    );
    oscillation(book, runs)?;
    growth(book, runs)?;
    let mut table = Table::new(
        "energy-error",
        ["case", "fixed step, largest |Eₖ − E₁|", "energy-preserving", "Newton iterations per step", "h_max/h₀"],
    );
    for run in runs {
        table.row([
            run.case.label(),
            format!("{:.3e}", run.fixed.error),
            format!("{:.1e}", run.energy.error),
            format!("{:.2}", run.energy.mean_iterations()),
            format!("{:.4}", run.energy.steps.1 / run.case.h0),
        ]);
    }
    book.table(&table, "Largest deviation of the discrete energy over the long runs, and what it costs.")?;
    for run in runs.iter().filter(|run| run.case.h0 < 0.05) {
        book.claim(
            &format!("{}: energy-preserving integrator, energy error over the run", run.case.label()),
            "1·10⁻¹⁴",
            scientific(run.energy.error),
            Verdict::Surpassed.when(run.energy.error < PUBLISHED),
        );
    }
    fixed_claim(book, runs);
    Ok(())
}

/// The fixed step's error is bounded, and of second order.
fn fixed_claim(book: &mut Book, runs: &[Pair]) {
    let ratios: Vec<String> = runs
        .chunks(2)
        .filter_map(|pair| match pair {
            [fine, coarse] => Some(format!("{:.1}", coarse.fixed.error / fine.fixed.error)),
            _ => None,
        })
        .collect();
    let bounded = runs.iter().all(|run| {
        // The largest error of the first thousandth part of the run is that of the whole run but for a per cent.
        let early = run.fixed.samples.iter().map(|sample| sample.error.abs()).fold(0.0, f64::max);
        run.fixed.error < 1.01 * early
    });
    book.claim(
        "fixed step: the energy error oscillates, without drift",
        "—",
        format!("bounded; ten times the step makes it {} times as large", ratios.join(" and ")),
        Verdict::reproduced(bounded),
    );
}

/// The error over the first oscillations on a linear axis.
fn oscillation(book: &mut Book, runs: &[Pair]) -> Result<(), Failure> {
    for run in runs.iter().filter(|run| run.case.h0 > 0.05) {
        let name = if run.case.q0 < 0.9 { "energy-0.74" } else { "energy-0.995" };
        let points = |track: &Track| track.samples.iter().map(|sample| (sample.t, sample.error)).collect();
        let chart = Chart {
            name,
            title: format!("Discrete energy error, {}", run.case.label()),
            x: Axis::linear("t"),
            y: Axis::linear("Eₖ − E₁"),
            equal_aspect: false,
            series: vec![
                Series::line("fixed step", Look::FIXED.line(), points(&run.fixed)),
                Series::line("energy-preserving", Look::ENERGY.line(), points(&run.energy)),
            ],
        };
        let caption = format!(
            "Over some oscillations the fixed step’s energy swings by {}, and returns; the energy-preserving one is flat: \
             at most {} over the whole run.",
            scientific(run.fixed.error),
            scientific(run.energy.error)
        );
        book.figure(&chart, &caption)?;
    }
    Ok(())
}

/// The largest error so far against the iteration, both logarithmic.
fn growth(book: &mut Book, runs: &[Pair]) -> Result<(), Failure> {
    for (pair, name) in runs.chunks(2).zip(["energy-growth-0.74", "energy-growth-0.995"]) {
        let mut series = Vec::new();
        for run in pair {
            let dashed = run.case.h0 > 0.05;
            let look = |look: Look| if dashed { look.dashed() } else { look.line() };
            let h0 = run.case.h0;
            series.push(Series::line(format!("fixed, h₀ = {h0}"), look(Look::FIXED), run.fixed.growth.clone()));
            series.push(Series::line(format!("energy, h₀ = {h0}"), look(Look::ENERGY), run.energy.growth.clone()));
        }
        let end = pair.iter().filter_map(|run| run.energy.growth.last()).map(|(steps, _)| *steps).fold(1.0, f64::max);
        series.push(Series::line("the paper, h₀ = 0.01", Look::PUBLISHED, vec![(1.0, PUBLISHED), (end, PUBLISHED)]));
        let q0 = pair.first().map_or(0.0, |run| run.case.q0);
        let chart = Chart {
            name,
            title: format!("Largest energy error so far, q₀ = {q0}"),
            x: Axis::log10("iteration k"),
            y: Axis::log10("max |Eₖ − E₁|").over(1e-17, 1e-2),
            equal_aspect: false,
            series,
        };
        book.figure(
            &chart,
            "Neither integrator drifts. The energy-preserving one stays at a few units in the last place of \
             <i>E</i>, below the value that the paper reports.",
        )?;
    }
    Ok(())
}
