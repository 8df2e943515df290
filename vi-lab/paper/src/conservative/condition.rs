//! Condition numbers of the equations along the orbit, in three forms.

use super::super::book::{Book, Verdict};
use super::super::unexpected;
use super::CASES;
use super::runs::Case;
use vi_core::StepError;
use vi_core::condition::Condition;
use vi_core::stepping::EnergyStepping;
use vi_report::chart::{Axis, Chart, Look, Series};
use vi_report::failure::Failure;
use vi_report::numbers::{median, order, scientific};
use vi_report::table::Table;

/// Steps along which condition numbers are taken: some oscillations.
const LENGTH: u32 = 10_000;
/// Time that a figure shows: two oscillations of the slower orbit.
const SHOWN: f64 = 15.0;
/// Names of the figures of both amplitudes.
const FIGURES: [&str; 2] = ["condition-0.74", "condition-0.995"];

/// Condition numbers at the midpoints of a run, with their times.
type Along = Vec<(f64, Condition)>;

/// One of the three forms.
type Pick = fn(&Condition) -> f64;

/// The section: a figure for each amplitude with both initial steps, and a table of medians.
pub(super) fn section(book: &mut Book) -> Result<(), Failure> {
    book.page.section("Condition numbers");
    book.page.prose(
        "The paper explains its trade-off by the condition of the equations, which grows as the step shrinks. In the \
         unknowns (<i>q</i><sub>1</sub>, <i>t</i><sub>1</sub>) it grows as 1/<i>h</i><sup>2</sup>, in \
         (<i>v</i>, <i>h</i>) as 1/<i>h</i>, because the determinant is −(<i>h</i>/4) <i>m</i> <i>D</i>: exactly so for one \
         coordinate with a constant mass and without force, with <i>D</i> at the midpoint. This project subtracts <i>v</i> times \
         the momentum row from the energy row and divides rows and columns by powers of <i>h</i>. The determinant becomes \
         −<i>m</i> <i>D</i>/4, and the condition number does not depend on <i>h</i>. The rounding error of <i>h</i> remains: the \
         scaled unknown is δ<i>h</i>/<i>h</i>, and the scaled energy row is divided by <i>h</i>².",
    );
    let head = ["case", "(q₁, t₁), median", "(v, h), median", "scaled, median", "scaled, largest"];
    let mut table = Table::new("condition-numbers", head);
    let mut medians = Vec::new();
    for (pair, name) in CASES.chunks(2).zip(FIGURES) {
        let runs = pair.iter().map(|case| Ok((*case, along(*case, LENGTH)?))).collect::<Result<Vec<_>, _>>();
        let runs = runs.map_err(unexpected("condition numbers"))?;
        figure(book, &runs, name);
        for (case, numbers) in runs {
            let middle = |pick: fn(&Condition) -> f64| median(numbers.iter().map(|(_, n)| pick(n))).unwrap_or(f64::NAN);
            let row = [middle(|n| n.position_time), middle(|n| n.velocity_step), middle(|n| n.scaled)];
            let largest = numbers.iter().map(|(_, number)| number.scaled).fold(0.0, f64::max);
            let [raw, unknowns, scaled] = row.map(scientific);
            table.row([case.label(), raw, unknowns, scaled, scientific(largest)]);
            medians.push((case.h0, row));
        }
    }
    book.page.table(&table, "Condition numbers in the 2-norm, over ten thousand steps.");
    let orders = orders(&medians);
    let [raw, unknowns, scaled] = orders.map(|order| format!("{order:.2}"));
    let holds = orders.iter().zip([-2.0, -1.0, 0.0]).all(|(order, theory)| (order - theory).abs() < 0.1);
    let smaller = medians.chunks(2).zip(FIGURES).zip([0.74, 0.995]);
    for ((pair, name), q0) in smaller {
        let numbers: Vec<String> =
            pair.iter().map(|(h0, [_, unknowns, _])| format!("{} at h₀ = {h0}", scientific(*unknowns))).collect();
        book.item(
            &format!("figure: condition number, q₀ = {q0}: larger for the smaller initial step"),
            "—",
            format!("(v, h), median {}", numbers.join(", ")),
            Verdict::Agrees.when(holds),
            name,
        );
    }
    book.item(
        "the equations become more ill-conditioned as the step shrinks",
        "—",
        format!("as h to the power {raw} in (q₁, t₁), {unknowns} in (v, h), {scaled} with scaled rows"),
        Verdict::Agrees.when(holds),
        "condition-numbers",
    );
    Ok(())
}

/// Powers of h, each from the smaller amplitude's medians at the two initial steps.
fn orders(medians: &[(f64, [f64; 3])]) -> [f64; 3] {
    let first: Vec<&(f64, [f64; 3])> = medians.iter().take(2).collect();
    let along = |pick: fn(&[f64; 3]) -> f64| order(&first.iter().map(|(h0, row)| (*h0, pick(row))).collect::<Vec<_>>());
    [along(|[raw, ..]| *raw), along(|[_, unknowns, _]| *unknowns), along(|[.., scaled]| *scaled)]
}

/// Condition numbers at the solutions along the run.
fn along(case: Case, length: u32) -> Result<Along, StepError> {
    let mut integrator = case.start()?;
    let system = *integrator.system();
    let mut numbers = Vec::new();
    for _ in 0..length {
        let node = *integrator.node();
        let before = integrator.h();
        let step = integrator.detailed_step()?;
        let (t, _, v) = step.midpoint;
        let equations = system.extended_system(&node, step.h, &v);
        numbers.push((t, Condition::of(&equations, step.h, &v, before)));
    }
    Ok(numbers)
}

fn figure(book: &mut Book, runs: &[(Case, Along)], name: &'static str) {
    let [green, pink, ..] = Look::OTHERS;
    let forms: [(&str, Look, Pick); 3] = [
        ("(q₁, t₁)", pink, |number| number.position_time),
        ("(v, h)", green, |number| number.velocity_step),
        ("scaled", Look::ENERGY, |number| number.scaled),
    ];
    let mut series = Vec::new();
    for (form, look, pick) in forms {
        for (case, numbers) in runs {
            let look = if case.h0 > 0.05 { look.dashed() } else { look.line() };
            let shown = numbers.iter().take_while(|(t, _)| *t < SHOWN).map(|(t, number)| (*t, pick(number)));
            series.push(Series::line(format!("{form}, h₀ = {}", case.h0), look, shown.collect()));
        }
    }
    let q0 = runs.first().map_or(0.0, |(case, _)| case.q0);
    let chart = Chart::new(
        name,
        format!("Condition numbers along the orbit, q₀ = {q0}"),
        [Axis::linear("t"), Axis::log10("condition number")],
        series,
    );
    book.page.figure(
        chart.figure(),
        "The same equations in three forms, at the same solutions. Lines: <i>h</i><sub>0</sub> = 0.01, dashes: \
         <i>h</i><sub>0</sub> = 0.1. Scaled, the two are close.",
    );
}
