//! The shift: what it keeps, and by how much H and E oscillate.

use super::super::book::Book;
use super::super::unexpected;
use super::{densities, released};
use vi_core::StepError;
use vi_report::chart::{Axis, Chart, Look, Series};
use vi_report::failure::Failure;
use vi_report::numbers::{extremes, scientific};
use vi_report::page::math::{id, num, op, row, sub, sup};

const ANGLE: f64 = 2.0;
const H: f64 = 0.05;
/// Two periods.
const UNTIL: f64 = 16.5;
/// `C_2`.
const CONSTANT: f64 = 1.0 / 864.0;

/// A node of the run.
struct Node {
    t: f64,
    total: f64,
    discrete: f64,
    shifted: f64,
    h: f64,
    /// `D_2 + D_*`.
    density: f64,
    /// `D_*`.
    shift: f64,
}

/// The section: the statement, and what is kept.
pub(super) fn section(book: &mut Book) -> Result<(), Failure> {
    book.section("A shift makes steps that exist everywhere");
    book.prose(
        "Adding a constant times <i>h</i><sup>2<i>s</i>+1</sup> to <i>L<sub>d</sub></i> changes neither the momentum equations nor the \
         order nor the symplecticity; the step density becomes <i>D<sub>s</sub></i> + <i>D</i><sub>∗</sub>, and what is kept to \
         rounding is",
    );
    let order = row(&[num("2"), id("s")]);
    let [c, d] = [sub(&id("C"), &id("s")), sub(&id("D"), &op("∗"))];
    book.formula(&[sup(&id("E"), &op("′")), op("="), id("E"), op("−"), c, sup(&id("h"), &order), d].concat());
    let nodes = run().map_err(unexpected("pendulum with a shift"))?;
    let Some(first) = nodes.first() else { return Ok(()) };
    let shift = first.shift;
    let line = |label: &str, look: Look, pick: fn(&Node) -> f64| {
        Series::line(label, look, nodes.iter().map(|node| (node.t, pick(node) - pick(first))).collect())
    };
    // H − E' = C h^2s (D + D*) = C K/h by the law, K = h^(2s+1) (D + D*).
    let (least, most) = extremes(nodes.iter().map(|node| node.h));
    let constant = CONSTANT * first.h.powi(5) * first.density;
    let predicted = [least, most].map(|h| constant * (1.0 / h - 1.0 / first.h));
    let band = predicted.map(|at| vec![(0.0, at), (UNTIL, at)]);
    let [upper, lower] = band.map(|points| Series::line("H, predicted", Look::EXACT, points));
    let series = vec![
        upper,
        lower.unlabelled(),
        line("E", Look::OTHERS[0].line(), |node| node.discrete),
        line("H", Look::FIXED.line(), |node| node.total),
        line("E′, kept", Look::ENERGY.line(), |node| node.shifted),
    ];
    let (low, high) = extremes(nodes.iter().map(|node| node.shifted));
    let (bottom, top) = extremes(nodes.iter().map(|node| node.total));
    let chart = Chart {
        name: "theory-shift",
        title: format!("Pendulum from 2 rad, order 4, shift {shift:.1}"),
        x: Axis::linear("t"),
        y: Axis::linear("energy, less its first value"),
        equal_aspect: false,
        series,
    };
    let caption = format!(
        "Without a shift this run ends at <i>t</i> = 0.45. With <i>D</i><sub>∗</sub> = {shift:.1}, twice the largest \
         |<i>D</i><sub>2</sub>|, it goes on: <i>E</i>′ stays within {}, <i>H</i> oscillates by {}, as the law predicts (dashed: {}), and \
         <i>E</i> by four times as much.",
        scientific(high - low),
        scientific(top - bottom),
        scientific(predicted[0] - predicted[1])
    );
    book.figure(&chart, &caption);
    Ok(())
}

/// The nodes of the run, its shift measured.
fn run() -> Result<Vec<Node>, StepError> {
    let mut run = released::<2>(ANGLE, H)?.with_shift_from(UNTIL)?;
    let mut nodes = Vec::new();
    while run.t() < UNTIL {
        let state = run.step()?;
        let [_, density, _] = densities(&state)?;
        let Some(discrete) = run.discrete_energy() else { break };
        let (shifted, shift) = (run.shifted_energy(), run.shift());
        let total = run.energy()?;
        nodes.push(Node { t: state.t, total, discrete, shifted, h: run.h(), density: density + shift, shift });
    }
    Ok(nodes)
}
