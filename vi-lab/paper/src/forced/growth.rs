//! Growth of the step with damping, where it ends, and its shrinking with negative damping.

use super::super::book::{Book, Verdict};
use super::super::unexpected;
use super::oscillator::{OMEGA, Sampled, energy_preserving};
use super::{DAMPING, H0};
use vi_report::chart::{Axis, Chart, Look, Series};
use vi_report::failure::Failure;
use vi_report::numbers::scientific;
use vi_report::page::math::{id, num, op, row, sub, sup};
use vi_report::table::Table;

/// Time up to which growth is shown.
const SHOWN: f64 = 100.0;
/// Time up to which negative damping is run.
const NEGATIVE: f64 = 50.0;
/// More steps than any run survives.
const MOST: u32 = 200_000;

/// The section: growth in time, and to the end in iterations.
pub(super) fn section(book: &mut Book) -> Result<(), Failure> {
    book.section("Step growth");
    book.prose("The paper observes that the step of the damped oscillator grows monotonically, and leaves open why. The \
                energy scale of the motion decays as e<sup>−2<i>ζωt</i></sup>, and so does the step density <i>D</i>; for a \
                quadratic Lagrangian <i>h</i><sub><i>k</i></sub>√<i>D</i><sub><i>k</i></sub> is constant exactly. Hence");
    let exponent = row(&[id("ζ"), id("ω"), id("t")]);
    let law = [sub(&id("h"), &id("k")), op("≈"), sub(&id("h"), &num("0")), sup(&id("e"), &exponent)];
    book.formula(&law.concat());
    book.prose(
        "and since <i>t</i> advances by <i>h</i>, after about 1/(<i>ζωh</i><sub>0</sub>) steps the step would be infinite. \
         Near there the discrete energy reaches zero, and no further step exists, or only one many times as long: a property \
         of the method, which the integrator reports as an error with its numbers.",
    );
    let mut runs = Vec::new();
    for zeta in DAMPING {
        runs.push((zeta, energy_preserving(zeta, f64::INFINITY, MOST).map_err(unexpected("step growth"))?));
    }
    in_time(book, &runs, SHOWN, "step-growth", "Step growth with damping")?;
    to_the_end(book, &runs)?;
    table(book, &runs)
}

/// The section on negative damping.
pub(super) fn negative(book: &mut Book) -> Result<(), Failure> {
    book.section("Negative damping");
    book.prose(
        "With <i>ζ</i> &lt; 0 the motion grows, and the same law makes the step shrink: the integrator takes more and more \
         steps for the same time. It never ends, but it slows down for ever.",
    );
    let mut runs = Vec::new();
    for zeta in DAMPING.map(|zeta| -zeta) {
        runs.push((zeta, energy_preserving(zeta, NEGATIVE, MOST).map_err(unexpected("negative damping"))?));
    }
    in_time(book, &runs, NEGATIVE, "negative-damping", "Step length with negative damping")?;
    let shrinks = runs.iter().all(|(_, run)| run.end.is_none() && ratio_at(run, NEGATIVE) < 1.0);
    let deviations: Vec<String> = runs.iter().map(|(zeta, run)| scientific(deviation(*zeta, run, NEGATIVE))).collect();
    book.claim(
        "negative damping: the step shrinks",
        "—",
        format!("by the same law, to {} for ζ = −0.001, −0.005, −0.01", deviations.join(", ")),
        Verdict::reproduced(shrinks),
    );
    Ok(())
}

/// h/h0 of the step that passes a time.
fn ratio_at(run: &Sampled, t: f64) -> f64 {
    run.samples.iter().find(|sample| sample.t >= t).map_or(f64::NAN, |sample| sample.h / H0)
}

/// Largest relative deviation from the law up to a time.
fn deviation(zeta: f64, run: &Sampled, until: f64) -> f64 {
    let relative = |t: f64, h: f64| (h / (H0 * (zeta * OMEGA * t).exp()) - 1.0).abs();
    run.samples
        .iter()
        .take_while(|sample| sample.t <= until)
        .map(|sample| relative(sample.t, sample.h))
        .fold(0.0, f64::max)
}

/// h/h0 against t, with the law over it.
fn in_time(
    book: &mut Book,
    runs: &[(f64, Sampled)],
    until: f64,
    name: &'static str,
    title: &str,
) -> Result<(), Failure> {
    let mut series = Vec::new();
    for ((zeta, run), look) in runs.iter().zip(Look::OTHERS) {
        let points = run.samples.iter().take_while(|sample| sample.t <= until).map(|sample| (sample.t, sample.h / H0));
        series.push(Series::line(format!("ζ = {zeta}"), Look { width: 3.0, ..look.line() }, points.collect()));
    }
    for (index, (zeta, _)) in runs.iter().enumerate() {
        let law = (0..=200).map(|i| until * f64::from(i) / 200.0).map(|t| (t, (zeta * OMEGA * t).exp())).collect();
        let law = Series::line("exp(ζωt)", Look::EXACT, law);
        series.push(if index == 0 { law } else { law.unlabelled() });
    }
    let chart = Chart {
        name,
        title: title.to_owned(),
        x: Axis::linear("t"),
        y: Axis::linear("h / h₀"),
        equal_aspect: false,
        series,
    };
    let worst: Vec<String> = runs.iter().map(|(zeta, run)| scientific(deviation(*zeta, run, until))).collect();
    let caption = format!(
        "Computed, and dashed the law. They differ by at most {} of <i>h</i> for the three damping ratios.",
        worst.join(", ")
    );
    book.figure(&chart, &caption)
}

/// h against the iteration, to the last step.
fn to_the_end(book: &mut Book, runs: &[(f64, Sampled)]) -> Result<(), Failure> {
    let mut series = Vec::new();
    for ((zeta, run), look) in runs.iter().zip(Look::OTHERS) {
        let points = run.samples.iter().zip(1_u32..).map(|(sample, k)| (f64::from(k), sample.h)).collect();
        series.push(Series::line(format!("ζ = {zeta}"), look.line(), points));
    }
    let chart = Chart {
        name: "step-growth-end",
        title: "Step length to the last step".to_owned(),
        x: Axis::linear("iteration k"),
        y: Axis::log10("h"),
        equal_aspect: false,
        series,
    };
    book.figure(
        &chart,
        "Against the iteration the step is <i>h</i><sub>0</sub>/(1 − <i>ζωh</i><sub>0</sub><i>k</i>): each run ends where it \
         would become infinite.",
    )
}

fn table(book: &mut Book, runs: &[(f64, Sampled)]) -> Result<(), Failure> {
    let head = ["ζ", "h/h₀ at t = 100", "exp(ζωt)", "last step", "1/(ζωh₀)", "last h", "how it ends"];
    let mut table = Table::new("step-growth-table", head);
    let mut ends = Vec::new();
    let mut as_predicted = true;
    for (zeta, run) in runs {
        let last = run.samples.len();
        let predicted = 1.0 / (zeta * OMEGA * H0);
        #[allow(clippy::cast_precision_loss)] // at most 200 000
        let near = (last as f64 / predicted - 1.0).abs() < 0.01;
        as_predicted &= near && run.end.is_some();
        ends.push(last.to_string());
        table.row([
            zeta.to_string(),
            format!("{:.3}", ratio_at(run, SHOWN)),
            format!("{:.3}", (zeta * OMEGA * SHOWN).exp()),
            last.to_string(),
            format!("{predicted:.0}"),
            run.samples.last().map_or_else(String::new, |sample| scientific(sample.h)),
            run.end.map_or_else(|| "it does not".to_owned(), |error| error.reason().to_string()),
        ]);
    }
    book.table(&table, "Step growth, the law, and the end of each run.")?;
    let grows = runs.iter().all(|(_, run)| {
        run.samples.iter().zip(run.samples.iter().skip(1)).take(4000).all(|(one, next)| next.h > one.h * (1.0 - 1e-12))
    });
    book.claim(
        "damped oscillator: the step grows monotonically",
        "—",
        format!("h/h₀ at t = 100: {}", join(runs.iter().map(|(_, run)| format!("{:.3}", ratio_at(run, SHOWN))))),
        Verdict::reproduced(grows),
    );
    book.claim(
        "why it grows, and where it ends (open in the paper)",
        "—",
        format!(
            "h = h₀ exp(ζωt); the last step with a solution is number {}, theory {}",
            ends.join(", "),
            join(runs.iter().map(|(zeta, _)| format!("{:.0}", 1.0 / (zeta * OMEGA * H0))))
        ),
        Verdict::Answered.when(as_predicted),
    );
    Ok(())
}

fn join(items: impl Iterator<Item = String>) -> String {
    items.collect::<Vec<_>>().join(", ")
}
