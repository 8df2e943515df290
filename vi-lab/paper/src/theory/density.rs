//! The step densities along one motion, and where runs end on them.

use super::super::book::Book;
use super::super::unexpected;
use super::{LOOKS, end, largest, swing};
use vi_erased::plan::ENERGY_STAGES;
use vi_report::chart::{Axis, Chart, Look, Series};
use vi_report::failure::Failure;
use vi_report::page::math::{frac, id, num, op, row, sub, sub_sup, sup};

/// Where the pendulum is released.
const ANGLE: f64 = 2.0;
/// More than half an oscillation.
const UNTIL: f64 = 5.0;
/// Steps of the runs with 1, 2 and 3 stages.
const STEPS: [f64; ENERGY_STAGES.len()] = [0.01, 0.03, 0.08];

/// The section: the statement, and the figure.
pub(super) fn section(book: &mut Book) -> Result<(), Failure> {
    book.section("Beyond the paper: energy-preserving steps of order 2s");
    book.prose(
        "The paper’s step has one stage. The same idea with the <i>s</i> stages of a Gauss step, and its length, as unknowns \
         gives order 2<i>s</i>; see <code>docs/theory.md</code> for derivations and prior work. A step density \
         <i>D<sub>s</sub></i> determines the length of a step. <i>π</i> is the Taylor polynomial of degree <i>s</i> of the motion:",
    );
    book.formula(&statement());
    book.prose(
        "A step exists, for small <i>h</i>, while <i>D<sub>s</sub></i> keeps its sign, and unforced its length obeys",
    );
    book.formula(&law());
    let swing = swing(ANGLE, UNTIL).map_err(unexpected("pendulum"))?;
    let mut series = vec![Series::line("zero", Look::BACKGROUND, vec![(0.0, 0.0), (UNTIL, 0.0)]).unlabelled()];
    let mut marks = Vec::new();
    for (index, stages) in ENERGY_STAGES.into_iter().enumerate() {
        let largest = largest(&swing, index);
        let points: Vec<(f64, f64)> = swing.iter().map(|point| (point.t, point.densities[index] / largest)).collect();
        if let Some(end) = end(stages, ANGLE, STEPS[index], UNTIL).map_err(unexpected("pendulum"))? {
            let near = points.iter().min_by(|(one, _), (other, _)| (one - end).abs().total_cmp(&(other - end).abs()));
            marks.extend(near.map(|(_, density)| (end, *density)));
        }
        series.push(Series::line(format!("s = {stages}"), LOOKS[index], points));
    }
    series.push(Series::scatter("a run ends", Look::RIVAL.dots(5.0), marks));
    let chart = Chart {
        name: "theory-densities",
        title: "Step densities of the pendulum, released at 2 rad".to_owned(),
        x: Axis::linear("t"),
        y: Axis::linear("D_s / max |D_s|"),
        equal_aspect: false,
        series,
    };
    book.figure(
        &chart,
        "Along this motion <i>D</i><sub>1</sub> keeps its sign, <i>D</i><sub>2</sub> and <i>D</i><sub>3</sub> do not: runs of \
         short steps end where the density comes to zero.",
    );
    Ok(())
}

/// `H − E = C_s h^2s D_s + …`, `D_s = (d/dτ)^2s H(t + τ, π(τ))`.
fn statement() -> String {
    let order = || row(&[num("2"), id("s")]);
    let factorial = |of: String| row(&[op("("), of, op("!"), op(")")]);
    let density = || sub(&id("D"), &id("s"));
    let excess =
        [id("H"), op("−"), id("E"), op("="), sub(&id("C"), &id("s")), sup(&id("h"), &order()), density()].concat();
    let constant = frac(&sup(&factorial(id("s")), &num("4")), &sup(&factorial(order()), &num("3")));
    let derivative = frac(&sup(&id("d"), &order()), &row(&[id("d"), sup(&id("τ"), &order())]));
    let along =
        [id("H"), op("("), id("t"), op("+"), id("τ"), op(","), id("π"), op("("), id("τ"), op(")"), op(")")].concat();
    let gap = op("&emsp;");
    let rest = [
        op("+"),
        id("…"),
        gap.clone(),
        sub(&id("C"), &id("s")),
        op("="),
        constant,
        gap,
        density(),
        op("="),
        derivative,
    ];
    [excess, rest.concat(), along].concat()
}

/// `h D_s^{1/(2s+1)} = const + O(h²)`.
fn law() -> String {
    let root = row(&[num("1"), op("/"), op("("), num("2"), id("s"), op("+"), num("1"), op(")")]);
    let square = sup(&id("h"), &num("2"));
    [id("h"), sub_sup(&id("D"), &id("s"), &root), op("="), id("const"), op("+"), id("O"), op("("), square, op(")")]
        .concat()
}
