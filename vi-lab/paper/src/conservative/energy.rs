//! The discrete energy error of both integrators.

use super::super::book::{Book, Verdict};
use super::runs::{Pair, Track};
use vi_report::chart::{Axis, Chart, Look, Series};
use vi_report::numbers::{extremes, scientific};
use vi_report::table::Table;

/// The energy errors that the paper reports for h0 = 0.01: energy-preserving, and fixed step at both amplitudes.
const PUBLISHED: f64 = 1e-14;
const PUBLISHED_FIXED: [f64; 2] = [1e-8, 1e-6];
/// Names of the figures of the four cases.
const FIGURES: [&str; 4] = ["energy-0.74-0.01", "energy-0.74-0.1", "energy-0.995-0.01", "energy-0.995-0.1"];

/// The section: the error over some oscillations, its growth over the long run, and a table.
pub(super) fn section(book: &mut Book, runs: &[Pair]) {
    book.page.section("Discrete energy");
    let (least, most) = extremes(runs.iter().map(|run| run.stored));
    book.page.prose(&format!(
        "The integrator preserves the discrete energy <i>E<sub>k</sub></i> = −<i>D</i><sub>3</sub><i>L<sub>d</sub></i>. With \
         the midpoint rule <i>E<sub>k</sub></i> is the energy at the middle of the step. Every figure evaluates it there, with the \
         velocity of the step. Recomputed from stored nodes, the quotient \
         (<i>q</i><sub><i>k</i>+1</sub> − <i>q<sub>k</sub></i>)/(<i>t</i><sub><i>k</i>+1</sub> − <i>t<sub>k</sub></i>) cancels. This \
         alone adds errors of {} to {} over the runs below, with any solver.",
        scientific(least),
        scientific(most)
    ));
    for (run, name) in runs.iter().zip(FIGURES) {
        oscillation(book, run, name);
    }
    growth(book, runs);
    table(book, runs);
    items(book, runs);
}

fn table(book: &mut Book, runs: &[Pair]) {
    let mut table = Table::new(
        "energy-error",
        [
            "case",
            "energy-preserving, largest |Eₖ − E₁|",
            "fixed step h₀",
            "as many fixed steps",
            "their length",
            "Newton iterations per step",
        ],
    );
    for run in runs {
        table.row([
            run.case.label(),
            format!("{:.1e}", run.energy.error),
            format!("{:.3e}", run.fixed.error),
            format!("{:.3e}", run.as_many.0),
            format!("{:.4}", run.as_many.1),
            format!("{:.2}", run.energy.mean_iterations()),
        ]);
    }
    book.page.table(
        &table,
        "Largest deviation of the discrete energy. The fixed step of the third column has the length <i>h</i><sub>0</sub>. In the \
         fourth column both integrators take the same number of steps in the same time, as in the revised text of the paper.",
    );
}

fn items(book: &mut Book, runs: &[Pair]) {
    let mut published = PUBLISHED_FIXED.into_iter();
    for (run, name) in runs.iter().zip(FIGURES) {
        let what = format!("figure: energy error, {}", run.case.label());
        if run.case.h0 < 0.05 {
            book.item(
                &format!("{what}: energy-preserving"),
                "10⁻¹⁴",
                scientific(run.energy.error),
                Verdict::Smaller.when(run.energy.error < PUBLISHED),
                name,
            );
            let printed = published.next().unwrap_or(f64::NAN);
            // The paper prints powers of ten: a factor of ten counts as agreement.
            let is_near = (0.1..10.0).contains(&(run.fixed.error / printed));
            book.item(
                &format!("{what}: fixed step"),
                if printed < 1e-7 { "10⁻⁸" } else { "10⁻⁶" },
                format!("{}; {} with as many steps", scientific(run.fixed.error), scientific(run.as_many.0)),
                Verdict::Agrees.when(is_near),
                name,
            );
        } else {
            book.item(
                &format!("{what}: larger for the fixed step, not for the energy-preserving one"),
                "—",
                format!("{} and {}", scientific(run.fixed.error), scientific(run.energy.error)),
                Verdict::Agrees.when(run.fixed.error > 1e-7 && run.energy.error < 1e-15),
                name,
            );
        }
    }
    let ratios: Vec<String> = runs
        .chunks(2)
        .filter_map(|pair| match pair {
            [fine, coarse] => Some(format!("{:.1}", coarse.fixed.error / fine.fixed.error)),
            _ => None,
        })
        .collect();
    let is_bounded = runs.iter().all(|run| {
        // The largest error of the first oscillations is within a per cent of that of the run.
        let early = run.fixed.samples.iter().map(|sample| sample.error.abs()).fold(0.0, f64::max);
        run.fixed.error < 1.01 * early
    });
    book.item(
        "fixed step: the energy error oscillates and is bounded",
        "—",
        format!("bounded; ten times the step makes it {} times as large", ratios.join(" and ")),
        Verdict::Agrees.when(is_bounded),
        "energy-growth-0.74",
    );
}

/// The error over the first oscillations on a linear axis.
fn oscillation(book: &mut Book, run: &Pair, name: &'static str) {
    let points = |track: &Track| track.samples.iter().map(|sample| (sample.t, sample.error)).collect();
    let chart = Chart::new(
        name,
        format!("Discrete energy error, {}", run.case.label()),
        [Axis::linear("t"), Axis::linear("Eₖ − E₁")],
        vec![
            Series::line("fixed step", Look::FIXED.line(), points(&run.fixed)),
            Series::line("energy-preserving", Look::ENERGY.line(), points(&run.energy)),
        ],
    );
    let caption = format!(
        "The energy of the fixed step oscillates by {} and returns. The energy-preserving one deviates by at most {} over the \
         whole run.",
        scientific(run.fixed.error),
        scientific(run.energy.error)
    );
    book.page.figure(chart.figure(), &caption);
}

/// The largest error so far against the iteration, both logarithmic.
fn growth(book: &mut Book, runs: &[Pair]) {
    for (pair, name) in runs.chunks(2).zip(["energy-growth-0.74", "energy-growth-0.995"]) {
        let mut series = Vec::new();
        for run in pair {
            let is_dashed = run.case.h0 > 0.05;
            let look = |look: Look| if is_dashed { look.dashed() } else { look.line() };
            let h0 = run.case.h0;
            series.push(Series::line(format!("fixed, h₀ = {h0}"), look(Look::FIXED), run.fixed.growth.clone()));
            series.push(Series::line(format!("energy, h₀ = {h0}"), look(Look::ENERGY), run.energy.growth.clone()));
        }
        let end = pair.iter().filter_map(|run| run.energy.growth.last()).map(|(steps, _)| *steps).fold(1.0, f64::max);
        let q0 = pair.first().map_or(0.0, |run| run.case.q0);
        let fixed = PUBLISHED_FIXED[usize::from(q0 > 0.9)];
        for (label, value) in [("the paper, energy", PUBLISHED), ("the paper, fixed", fixed)] {
            series.push(Series::line(format!("{label}, h₀ = 0.01"), Look::PUBLISHED, vec![(1.0, value), (end, value)]));
        }
        let chart = Chart::new(
            name,
            format!("Largest energy error so far, q₀ = {q0}"),
            [Axis::log10("iteration k"), Axis::log10("max |Eₖ − E₁|").over(1e-17, 1e-2)],
            series,
        );
        book.page.figure(
            chart.figure(),
            "Neither integrator drifts. The energy-preserving one stays at a few units in the last place of <i>E</i>. Dotted: the \
             magnitudes that the paper prints.",
        );
    }
}
