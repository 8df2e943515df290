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
/// Steps that a figure shows.
const SHOWN: usize = 2_000;

/// The section: figures for the smaller step, a table of medians for all cases.
pub(super) fn section(book: &mut Book) -> Result<(), Failure> {
    book.section("Condition numbers");
    book.prose(
        "The paper explains its trade-off by the condition of the equations, which grows as the step shrinks. In the \
         unknowns (<i>q</i><sub>1</sub>, <i>t</i><sub>1</sub>) it grows as 1/<i>h</i><sup>2</sup>, in \
         (<i>v</i>, <i>h</i>) as 1/<i>h</i>. Subtracting <i>v</i> times the momentum row from the energy row, and dividing \
         rows and columns by powers of <i>h</i>, leaves a determinant of −<i>D</i>/4 and a condition number that does not \
         depend on <i>h</i>: what remains is the orbit’s own.",
    );
    let head = ["case", "(q₁, t₁), median", "(v, h), median", "scaled, median", "scaled, largest"];
    let mut table = Table::new("condition-numbers", head);
    let mut medians = Vec::new();
    for case in CASES {
        let numbers = along(case, LENGTH).map_err(unexpected("condition numbers"))?;
        if case.h0 < 0.05 {
            figure(book, case, &numbers)?;
        }
        let middle = |pick: fn(&Condition) -> f64| median(numbers.iter().map(pick)).unwrap_or(f64::NAN);
        let row = [middle(|n| n.position_time), middle(|n| n.velocity_step), middle(|n| n.scaled)];
        let largest = numbers.iter().map(|number| number.scaled).fold(0.0, f64::max);
        let [raw, unknowns, scaled] = row.map(scientific);
        table.row([case.label(), raw, unknowns, scaled, scientific(largest)]);
        medians.push((case.h0, row));
    }
    book.table(&table, "Condition numbers in the 2-norm, over ten thousand steps.")?;
    let orders = orders(&medians);
    let [raw, unknowns, scaled] = orders.map(|order| format!("{order:.2}"));
    book.claim(
        "the equations become more ill-conditioned as the step shrinks",
        "—",
        format!("as h to the power {raw} in (q₁, t₁), {unknowns} in (v, h), {scaled} scaled"),
        Verdict::Cured.when(orders.iter().zip([-2.0, -1.0, 0.0]).all(|(order, theory)| (order - theory).abs() < 0.1)),
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
fn along(case: Case, length: u32) -> Result<Vec<Condition>, StepError> {
    let mut integrator = case.start()?;
    let system = *integrator.system();
    let mut numbers = Vec::new();
    for _ in 0..length {
        let node = *integrator.node();
        let before = integrator.h();
        let step = integrator.detailed_step()?;
        let (_, _, v) = step.midpoint;
        let equations = system.extended_system(&node, step.h, &v);
        numbers.push(Condition::of(&equations, step.h, &v, before));
    }
    Ok(numbers)
}

fn figure(book: &mut Book, case: Case, numbers: &[Condition]) -> Result<(), Failure> {
    let points = |pick: fn(&Condition) -> f64| {
        numbers.iter().take(SHOWN).zip(1_u32..).map(|(number, k)| (f64::from(k), pick(number))).collect::<Vec<_>>()
    };
    let [green, pink, ..] = Look::OTHERS;
    let chart = Chart {
        name: if case.q0 < 0.9 { "condition-0.74" } else { "condition-0.995" },
        title: format!("Condition numbers along the orbit, {}", case.label()),
        x: Axis::linear("iteration k"),
        y: Axis::log10("condition number"),
        equal_aspect: false,
        series: vec![
            Series::line("(q₁, t₁), as written", pink.line(), points(|number| number.position_time)),
            Series::line("(v, h), as written", green.line(), points(|number| number.velocity_step)),
            Series::line("scaled: this project", Look::ENERGY.line(), points(|number| number.scaled)),
        ],
    };
    book.figure(&chart, "The same equations, in three forms, at the same solutions.")
}
