//! The step length along the orbit, and the law that it follows.

use super::super::super::chart::{Axis, Chart, Look, Series};
use super::super::super::failure::Failure;
use super::super::super::report::math::{frac, id, num, op, row, sub, sup};
use super::super::book::{Book, Verdict};
use super::super::unexpected;
use super::runs::Run;
use vi_core::{Lagrangian, SVector};
use vi_systems::DoubleWell;

/// The section: h/h0 against the iteration, with the step law over it.
pub(super) fn section(book: &mut Book, runs: &[Run]) -> Result<(), Failure> {
    book.section("Step length");
    book.prose(
        "The step length is a function of the place on the orbit. The paper observes that it oscillates with the motion; \
         it does so by a law. With the acceleration <i>a</i> and derivatives along the motion, define the step density",
    );
    let power = [id("a"), op("·"), sub(&id("L"), &id("q"))].concat();
    let density = [
        id("D"),
        op("="),
        power,
        op("−"),
        id("v"),
        op("·"),
        frac(&id("d"), &row(&[id("d"), id("t")])),
        sub(&id("L"), &id("q")),
        op("−"),
        frac(&id("d"), &row(&[id("d"), id("t")])),
        sub(&id("L"), &id("t")),
    ];
    book.formula(&density.concat());
    book.prose("without forces (with a force, <i>L<sub>q</sub></i> + <i>f</i> stands for <i>L<sub>q</sub></i>). Then");
    let third = row(&[num("1"), op("/"), num("3")]);
    let law = [
        sub(&id("h"), &id("k")),
        op("="),
        sub(&id("h"), &num("0")),
        sup(&row(&[op("("), frac(&sub(&id("D"), &num("0")), &sub(&id("D"), &id("k"))), op(")")]), &third),
        op("("),
        num("1"),
        op("+"),
        id("O"),
        op("("),
        sup(&id("h"), &num("2")),
        op(")"),
        op(")"),
    ];
    book.formula(&law.concat());
    for run in runs.iter().filter(|run| run.case.h0 < 0.05) {
        let name = if run.case.q0 < 0.9 { "step-length-0.74" } else { "step-length-0.995" };
        let mut series = vec![Series::line("computed", Look::ENERGY.line(), computed(run))];
        series.push(Series::line("step law", Look::EXACT, predicted(run)?));
        let chart = Chart {
            name,
            title: format!("Step length, {}", run.case.label()),
            x: Axis::linear("iteration k"),
            y: Axis::linear("h / h₀"),
            equal_aspect: false,
            series,
        };
        let caption = format!(
            "The step varies between {:.4} and {:.4} times <i>h</i><sub>0</sub> over the whole run. Dashed: the law, from \
             <i>D</i> at the midpoints.",
            run.energy.steps.0 / run.case.h0,
            run.energy.steps.1 / run.case.h0
        );
        book.figure(&chart, &caption)?;
    }
    let ratios: Vec<String> = runs.iter().map(|run| format!("{:.4}", run.energy.steps.1 / run.case.h0)).collect();
    book.claim(
        "the step adapts to the motion: it oscillates along the orbit, and more the nearer to the saddle",
        "—",
        format!("h_max/h₀ = {}", ratios.join(", ")),
        Verdict::reproduced(runs.iter().all(|run| run.energy.steps.1 > run.case.h0)),
    );
    Ok(())
}

fn computed(run: &Run) -> Vec<(f64, f64)> {
    run.energy.samples.iter().zip(1_u32..).map(|(sample, k)| (f64::from(k), sample.h / run.case.h0)).collect()
}

/// `(D_1/D_k)^{1/3}`, scaled to the first step.
fn predicted(run: &Run) -> Result<Vec<(f64, f64)>, Failure> {
    let system = DoubleWell::default();
    let mut first = None;
    let mut points = Vec::new();
    for (sample, k) in run.energy.samples.iter().zip(1_u32..) {
        let (q, v) = (SVector::from([sample.q]), SVector::from([sample.v]));
        let density = system.step_density(sample.t, &q, &v).map_err(unexpected("step law"))?;
        let (d0, h0) = *first.get_or_insert((density, sample.h));
        points.push((f64::from(k), h0 / run.case.h0 * (d0 / density).cbrt()));
    }
    Ok(points)
}
